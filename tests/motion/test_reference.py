# SPDX-License-Identifier: Apache-2.0
"""The reference itself, on cases that can be worked out by hand."""

import math

import pytest

from motion.backlash import tool_points
from motion.reference import Arc, Line, arc_through, entry_length, profile_time, ramp_time
from motion.trace import BadCoils, decode, feed_errors, judge, split


def test_a_point_beside_a_line_is_as_far_as_the_perpendicular() -> None:
    assert Line(30, 40).distance((4, -3)) == pytest.approx(5.0)
    assert Line(30, 40).distance((33, 44)) == pytest.approx(5.0)
    assert Line(10, 0).distance((5, 2)) == 2.0


def test_an_arc_knows_its_sense_and_the_long_way() -> None:
    quarter = arc_through(-100, 100, 100.0, True, False)
    assert (quarter.cx, quarter.cz) == pytest.approx((-100.0, 0.0))
    assert quarter.sweep == pytest.approx(math.pi / 2)
    other = arc_through(-100, 100, 100.0, True, True)
    assert (other.cx, other.cz) == pytest.approx((0.0, 100.0))
    assert other.sweep == pytest.approx(1.5 * math.pi)


def test_points_beyond_the_ends_of_an_arc_do_not_lie_on_it() -> None:
    quarter = Arc(-100, 100, -100.0, 0.0, True)
    assert quarter.distance((-29, 71)) == pytest.approx(abs(math.hypot(71, 71) - 100))
    assert quarter.distance((0, -10)) == pytest.approx(10.0)
    assert quarter.distance((-200, 0)) > 100.0


def test_the_length_of_an_entry_is_one_step_of_the_faster_axis() -> None:
    assert entry_length(Line(4, 3), (0, 0), (1, 1)) == pytest.approx(1.25)
    arc = Arc(-100, 100, -100.0, 0.0, True)
    assert entry_length(arc, (0, 0), (0, 1)) == pytest.approx(1.0, abs=1e-4)


def test_the_least_time_of_a_line_is_the_trapezoid() -> None:
    assert ramp_time(100.0, 50.0, 100.0, 1000.0) == pytest.approx(2.0)
    assert ramp_time(1000.0, 500.0, 0.0, 1000.0) == pytest.approx(0.5 + 0.5 + 1.5)
    assert ramp_time(10.0, 500.0, 0.0, 1000.0) == pytest.approx(0.2)
    whole = profile_time([400.0, 600.0], [500.0, 500.0], [500.0], 1000.0, 0.0)
    assert whole == pytest.approx(2.5)
    stopped = profile_time([400.0, 600.0], [500.0, 500.0], [0.0], 1000.0, 0.0)
    assert stopped > whole


def test_a_screw_with_play_carries_the_slide_late() -> None:
    there = [(1, 0)] * 3 + [(-1, 0)] * 4
    points = tool_points(there, (2, 0), (0, 0))
    assert [x for x, _ in points] == [0, 1, 2, 3, 3, 3, 2, 1]


def test_the_decoder_reads_full_steps_of_both_axes_as_one() -> None:
    forward = (5, 9, 10, 6)
    log = []
    for i in range(1, 5):
        z = forward[i % 4] << 8
        log.append((1000 * i, z | forward[(1 - i) % 4] << 24))
        log.append((1000 * i + 2, z | forward[-i % 4] << 24))
    trace = decode(log, (5, 5))
    assert trace.moves == [(-1, 1)] * 4
    assert trace.times == [1000, 2000, 3000, 4000]


def test_the_decoder_refuses_jumps_and_wave_patterns() -> None:
    with pytest.raises(BadCoils, match="jump"):
        decode([(10, 10 << 8 | 5 << 24)], (5, 5))
    with pytest.raises(BadCoils, match="pattern"):
        decode([(10, 1 << 8 | 5 << 24)], (5, 5))


def test_a_missing_or_an_additional_step_is_noticed() -> None:
    with pytest.raises(AssertionError, match="never reaches"):
        split([(0, 0), (1, 0)], [Line(2, 0)])
    with pytest.raises(AssertionError, match="too many"):
        split([(0, 0), (1, 0), (2, 0)], [Line(1, 0)])


def test_a_step_that_comes_late_spoils_the_feed() -> None:
    log = [(12_000 * i, ((5, 9, 10, 6)[i % 4]) << 24 | 5 << 8) for i in range(1, 40)]
    trace = decode(log, (5, 5))
    lengths, rates = [1.0] * 39, [1000.0] * 39
    assert feed_errors(trace, lengths, rates) == pytest.approx(0.0)
    trace.times[20] += 1_920
    assert feed_errors(trace, lengths, rates) == pytest.approx(1.0, abs=0.02)


def test_a_point_off_the_circle_is_the_worst() -> None:
    arc = Arc(-5, 5, -5.0, 0.0, True)
    assert judge(arc, [(0, 0), (3, 1), (-5, 5)]).worst > 2.0
