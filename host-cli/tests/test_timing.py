# SPDX-License-Identifier: Apache-2.0
"""Times of plans, by hand, and what depends on them; the chip judges them in tests/motion."""

import pytest
from planned import POINT, arc, contour, cut, cylinder, face, line, part, random_part

from tornillo.drives import Drives, LegPlanner
from tornillo.machine import Machine
from tornillo.moves import Move
from tornillo.planning import plan_part
from tornillo.protocol import FEED_UNIT
from tornillo.roughing_time import facing_is_shorter
from tornillo.timing import BEGIN_S, REST_S, axis_steps, move_times, time_plan

DRIVES = Drives(rapid_x=1_000, rapid_z=1_000, start_x=400, start_z=400, acceleration=8_000)


def seconds(*moves: Move, drives: Drives = DRIVES) -> float:
    """The time of a chain."""
    return sum(move_times(moves, LegPlanner(drives)))


def test_a_feed_below_the_start_rate_takes_its_length() -> None:
    assert seconds(Move((0, 0), (-300, 0), 100 * FEED_UNIT)) == pytest.approx(3 + BEGIN_S)
    assert seconds(Move((0, 0), (-300, 400), 100 * FEED_UNIT)) == pytest.approx(
        5 + BEGIN_S, rel=1e-3
    )


def test_a_rapid_has_its_ramps() -> None:
    # Two ramps of 75 ms at 700 step/s in the mean, and the rest at 1,000 step/s.
    expected = 2 * 0.075 + (1_000 - 2 * 0.075 * 700) / 1_000
    assert seconds(Move((0, 0), (1_000, 0))) == pytest.approx(expected + BEGIN_S, rel=0.01)


def test_turning_back_takes_a_rest_and_the_dead_steps() -> None:
    there, back = Move((0, 0), (-400, 0), 100 * FEED_UNIT), Move((-400, 0), (0, 0), 100 * FEED_UNIT)
    assert seconds(there, back) == pytest.approx(8 + REST_S + BEGIN_S)
    play = Drives(1_000, 1_000, 400, 400, 8_000, dead_x=50, dead_z=20)
    assert seconds(there, back, drives=play) == pytest.approx(8 + REST_S + BEGIN_S + 20 / 100)


def test_two_axes_at_once_are_as_fast_as_the_slower_allows() -> None:
    slow = Drives(rapid_x=500, rapid_z=1_000, start_x=400, start_z=400, acceleration=8_000)
    assert seconds(Move((0, 0), (2_000, 2_000)), drives=slow) > 2_000 / 500


def test_the_times_of_a_plan_add_up() -> None:
    plan = plan_part(random_part(5), Machine.load())
    timing = time_plan(plan, DRIVES)
    assert len(timing.steps) == len(plan.steps)
    assert timing.total == pytest.approx(sum(timing.steps))
    # A stroke begins with a step at once, which the way at the feed does not know.
    assert sum(timing.least) <= sum(timing.feeding) * 1.03
    assert 0 < timing.share < 1


def test_the_steps_of_an_arc_count_the_way_over_its_top() -> None:
    over = arc(-80, 0, 50, convex=True)
    assert over is not None
    move = Move((0, 0), (-80, 0), 1, over.kind, over.cz, over.cx)
    assert axis_steps([move]) == (40, 80)
    assert axis_steps([Move((0, 0), (30, -40), 1)]) == (40, 30)


def test_a_short_thick_end_is_roughed_in_facing_direction() -> None:
    image = part(POINT, cut(20))
    disc = contour(0, 20, line(-20, 10), line(0, 70))
    shaft = contour(0, 80, line(-300, 10), line(0, 10))
    assert facing_is_shorter(image.header, image.records, disc)
    assert not facing_is_shorter(image.header, image.records, shaft)


def test_what_falls_is_roughed_along_and_what_is_flat_across() -> None:
    image = part(POINT, cut(20), front=9)
    assert not facing_is_shorter(
        image.header, image.records, contour(0, 20, line(-5, 60), line(-1, -1))
    )
    assert facing_is_shorter(image.header, image.records, face(0, 0, 100))


def test_the_choice_sees_what_has_been_cut_before() -> None:
    step = contour(0, 20, line(-30, 0), line(0, 80))
    raw = part(POINT, cut(20))
    cleared = part(POINT, cut(20), cylinder(0, -29, 21))
    assert not facing_is_shorter(raw.header, raw.records, step)
    assert isinstance(facing_is_shorter(cleared.header, cleared.records, step), bool)
