# SPDX-License-Identifier: Apache-2.0
"""Single lines and arcs on the chip: every visited point, every interval, the end."""

import math

import pytest
from hypothesis import given, settings
from simulated.processes import on_a_new_chip

from motion.reference import Arc, Line, Move, arc_between, arc_through
from motion.rig import Rig
from motion.strategies import arcs, lines, rates, repeatable
from motion.trace import Judgement, Trace, feed_errors, judge_all

LINE_BOUND = 0.5 + 1e-9
# Radius from which on, and bound.
ARC_BOUNDS = ((5.0, 0.51), (0.0, 1.0))
FEED_BOUND_PCT = 1.0
FEED_RADIUS = 20.0
REPEATABLE = repeatable(40)

# Shrunk failures of earlier firmware.
ONCE_WRONG = (
    Line(98, -37, 19_000),
    Line(1, 1, 9_000),
    # one entry with the longest stretch where the path passes an extremum
    Arc(-1, 300, -37854.460860934174, 23.820130463552772, True, 12_000),
    # the last, diagonal step too soon
    Arc(-36, 16, 0.885590491301528, 50.492578605428434, False, 8_000),
    # over the end of the table at the border of an octant
    Arc(84, 3, 40.615162669787814, 40.27544524594117, False, 8_000),
    Arc(28, 19, 20.495121613124127, -0.07175816670923751, False, 8_000),
    # almost a full circle: complete at once
    Arc(0, 1, 5.544368675776885, 0.5, True, 8_000),
    Arc(0, 1, -5.544368675776885, 0.5, False, 8_000),
    Arc(1, 0, 0.5, 4.9749371855331, False, 8_000),
    # an end at the border of an octant, overshot
    Arc(35, 0, 17.5, 17.853571071357123, False, 8_000),
    Arc(15, -15, 7.5, -7.5, False, 8_000),
    Arc(11, 0, 5.5, -5.751317826461585, True, 8_000),
    # never started: the flat top waited for room that was not to come
    Arc(63, 172, 7.805516551681592, 94.67879335607012, False, 8_000),
    Arc(-295, 212, -126.5605342817999, 135.13746408900485, False, 8_000),
    # away from the circle at the border of an octant
    Arc(0, 7, 3.9655809566353004, 3.5, True, 8_000),
    Arc(-6, -7, -0.08401968860031772, -5.999411695485442, False, 8_000),
    Arc(7, 13, 23.080864728623506, -4.0435425461818895, True, 8_000),
    # the last, straight step too late
    Arc(-772, -772, 0.48014685451005334, -772.48014685451, False, 8_000),
    # half circles and short arcs over an extremum or a border
    Arc(0, 37, 0.0, 18.5, False, 8_000),
    Arc(30, 0, 15.0, 0.0, True, 8_000),
    Arc(-3, 0, -1.5, 22.951034835057, False, 8_000),
    Arc(2, -2, 13.489850074338827, 11.489850074338827, True, 8_000),
    Arc(3, -1, 10664.700258365216, 31989.10077509565, True, 8_000),
    # an end behind the border, taken for one in the same octant
    Arc(-2, 4, 4.529291954192588, 4.7646459770962934, False, 8_000),
    Arc(0, 1, 5.037369911167847, 0.5, True, 8_000),
    Arc(4, -9, 3.4067589268671594, -3.8747738102812623, False, 8_000),
    Arc(-7973, -218, -4796.367703790442, 29510.611019821994, False, 8_000),
)


def follow_one(rig: Rig, move: Move) -> tuple[Trace, Judgement]:
    """Run one move as a chain of its own and compare it with the reference."""
    rig.ready()
    trace = rig.follow([move], 10.0)
    assert trace.counted == (move.dx & 0xFFFF, move.dz & 0xFFFF)
    return trace, judge_all(trace, [move])[0][1]


def bound_of(move: Move) -> float:
    """How far from the path a point may be, in steps."""
    if isinstance(move, Line):
        return LINE_BOUND
    return next(bound for radius, bound in ARC_BOUNDS if move.radius >= radius)


def assert_followed(rig: Rig, move: Move) -> None:
    """The move keeps to the path and to the feed."""
    trace, judged = follow_one(rig, move)
    assert judged.worst <= bound_of(move), move
    if isinstance(move, Line) or move.radius >= FEED_RADIUS:
        error = feed_errors(trace, judged.lengths, [move.rate] * len(judged.lengths))
        assert error <= FEED_BOUND_PCT, (move, error)


@on_a_new_chip
def test_a_line_visits_the_nearest_points_at_the_feed() -> None:
    rig = Rig()
    rig.quick()

    @REPEATABLE
    @given(move=lines())
    def check(move: Line) -> None:
        assert_followed(rig, move)

    check()


@on_a_new_chip
def test_an_arc_visits_the_nearest_points_at_the_feed() -> None:
    rig = Rig()
    rig.quick()

    @REPEATABLE
    @given(move=arcs())
    def check(move: Arc) -> None:
        assert_followed(rig, move)

    check()


@on_a_new_chip
def test_a_small_arc_visits_the_nearest_points() -> None:
    rig = Rig()
    rig.quick()

    @REPEATABLE
    @given(move=arcs(smallest=2.0, largest=40.0))
    def check(move: Arc) -> None:
        assert_followed(rig, move)

    check()


@on_a_new_chip
def test_a_slow_feed_is_as_exact_as_a_fast_one() -> None:
    rig = Rig()
    rig.quick()

    @settings(REPEATABLE, max_examples=12)
    @given(rate=rates(10.0, 3_000.0), direction=lines(longest=40))
    def check(rate: float, direction: Line) -> None:
        assert_followed(rig, Line(direction.dx, direction.dz, rate))
        assert_followed(rig, arc_between(60.0, 0.5, 1.2, True, rate))

    check()


@pytest.mark.parametrize("move", ONCE_WRONG, ids=str)
def test_a_move_that_once_went_wrong_is_right(move: Move) -> None:
    @on_a_new_chip
    def check() -> None:
        rig = Rig()
        rig.quick()
        assert_followed(rig, move)

    check()


@on_a_new_chip
def test_every_octant_is_cut_in_both_senses() -> None:
    rig = Rig()
    rig.quick()
    for eighth in range(8):
        for towards_z in (False, True):
            start = eighth * math.pi / 4
            assert_followed(rig, arc_between(700.0, start, math.pi / 4, towards_z, 15_000))
            assert_followed(rig, arc_between(701.3, start + 0.4, 3.0, towards_z, 15_000))


@on_a_new_chip
def test_the_longest_lines_and_the_largest_radius_fit_the_numbers() -> None:
    rig = Rig()
    rig.quick()
    assert_followed(rig, Line(32_767, -32_767, 20_000))
    assert_followed(rig, Line(-32_767, 12_345, 20_000))
    assert_followed(rig, arc_through(-4_000, 20_000, 60_000.0, True, False, 20_000))
    assert_followed(rig, arc_through(8_000, 0, 60_000.0, False, False, 20_000))


@on_a_new_chip
def test_a_centre_off_by_a_step_still_ends_at_the_end() -> None:
    rig = Rig()
    rig.quick()
    exact = arc_between(200.0, 0.3, 2.0, True, 10_000)
    for off_x, off_z in ((0.6, 0.0), (0.0, -0.6), (-0.4, 0.4)):
        move = Arc(exact.dx, exact.dz, exact.cx + off_x, exact.cz + off_z, True, 10_000)
        trace, _ = follow_one(rig, move)
        assert trace.points()[-1] == exact.end
        assert max(exact.distance(point) for point in trace.points()) < 2.0
