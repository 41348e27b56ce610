# SPDX-License-Identifier: Apache-2.0
"""Acceleration along the path, jumps at corners, and the time that is left on the way."""

from __future__ import annotations

import math
from itertools import pairwise

from hypothesis import given
from simulated.processes import on_a_new_chip
from virtual_lathe.chip import CYCLES_PER_SECOND

from motion.reference import Arc, Line, Move, jump, limits_kept, profile_time, ramp_time
from motion.rig import Rig
from motion.strategies import chains, repeatable
from motion.trace import Judgement, Trace, judge_all

ACCELERATION, START, TOP = 20_000.0, 600.0, 6_000.0
TICK_S = 1e-3
# The stretch of an entry is a multiple of 1/256, the length of one a mean along the path.
GRAIN = 0.02
# From a change of direction by one on an axis turns back, and the tool rests for 10 ms; the chip
# knows directions to one in 128.
TURNS_BACK, REST_S = 0.97, 0.010
REPEATABLE = repeatable(12)


def ramped() -> Rig:
    """A rig with ramps."""
    rig = Rig()
    rig.settle(
        acceleration=round(ACCELERATION),
        start_rate_x=round(START),
        start_rate_z=round(START),
        rapid_rate_x=round(TOP),
        rapid_rate_z=round(TOP),
    )
    return rig


def speeds(trace: Trace, chain: list[Move]) -> tuple[list[float], list[float]]:
    """Path speed and duration of each entry but the first."""
    lengths = [length for _, judged in judge_all(trace, chain) for length in judged.lengths]
    lasted = [
        (after - before) / CYCLES_PER_SECOND
        for before, after in zip(trace.times, trace.times[1:], strict=False)
    ]
    return [le / s for le, s in zip(lengths[1:], lasted, strict=True)], lasted


def joint_rate(before: Move, after: Move) -> float:
    """Path speed at which neither axis jumps by more than the start/stop speed."""
    change = jump(before, after)
    return math.inf if change < 1 / 64 else START / min(change, 1.0)


def turned(parts: list[tuple[Move, Judgement]]) -> set[int]:
    """Entries before which the tool may rest, because an axis turns back there."""
    entries: set[int] = set()
    at = 0
    for (move, judged), (following, _) in pairwise(parts):
        at += len(judged.lengths)
        if jump(move, following) > TURNS_BACK:
            entries.add(at)
    return entries


def least_time(chain: list[Move]) -> float:
    """Least time of a chain, from the reference."""
    rates = [limits_kept(move, move.rate, TOP, TOP) for move in chain]
    joints = [
        min(joint_rate(one, other), max(rates[i], START), max(rates[i + 1], START))
        for i, (one, other) in enumerate(pairwise(chain))
    ]
    return profile_time([m.length for m in chain], rates, joints, ACCELERATION, START)


@on_a_new_chip
def test_speed_changes_no_faster_than_the_acceleration() -> None:
    rig = ramped()

    @REPEATABLE
    @given(chain=chains(most=12))
    def check(chain: list[Move]) -> None:
        round_enough = [m for m in chain if isinstance(m, Line) or m.radius >= 50.0]
        if not round_enough:
            return
        trace = rig.ready().follow(round_enough, 60.0)
        found, lasted = speeds(trace, round_enough)
        rests = turned(judge_all(trace, round_enough))
        for i in range(len(found) - 1):
            # found[i] is the speed of entry i + 1.
            if rests & {i + 1, i + 2}:
                continue
            most = ACCELERATION * (max(lasted[i], lasted[i + 1]) + TICK_S) * 1.1
            most += GRAIN * max(found[i], found[i + 1])
            assert abs(found[i + 1] - found[i]) <= most, (i, found[i - 2 : i + 4])

    check()


@on_a_new_chip
def test_no_axis_jumps_by_more_than_its_start_speed_at_a_corner() -> None:
    rig = ramped()

    @REPEATABLE
    @given(chain=chains(most=12))
    def check(chain: list[Move]) -> None:
        lines = [m for m in chain if isinstance(m, Line) and m.length >= 3.0]
        if len(lines) < 2:
            return
        trace = rig.ready().follow(list(lines), 60.0)
        parts = judge_all(trace, lines)
        found, _ = speeds(trace, list(lines))
        at = -1
        for (move, judged), (following, _) in pairwise(parts):
            at += len(judged.lengths)
            change = jump(move, following)
            speed = min(found[at - 1], found[at])
            if change <= TURNS_BACK:
                assert speed * change <= 1.1 * START, (move, following, speed)

    check()


@on_a_new_chip
def test_a_single_line_takes_hardly_longer_than_it_must() -> None:
    rig = ramped()
    for length, rate in ((200, 3_000.0), (3_000, 3_000.0), (3_000, 6_000.0), (50, 6_000.0)):
        trace = rig.follow([Line(-length, 0, rate)], 20.0)
        taken = trace.seconds + 1.0 / START
        assert taken <= 1.02 * ramp_time(length, rate, START, ACCELERATION) + 2 * TICK_S


@on_a_new_chip
def test_a_tangent_joint_does_not_slow_down() -> None:
    rig = ramped()
    chain: list[Move] = []
    for _ in range(6):
        chain += [Arc(60, 60, 60.0, 0.0, False, 2_000.0), Line(100, 0, 2_000.0)]
        chain += [Arc(60, -60, 0.0, -60.0, False, 2_000.0), Line(0, -100, 2_000.0)]
        chain += [Arc(-60, -60, -60.0, 0.0, False, 2_000.0), Line(-100, 0, 2_000.0)]
        chain += [Arc(-60, 60, 0.0, 60.0, False, 2_000.0), Line(0, 100, 2_000.0)]
    trace = rig.follow(chain, 20.0)
    length = sum(move.length for move in chain)
    ideal = ramp_time(length, 2_000.0, START, ACCELERATION)
    assert trace.seconds + 1.0 / START <= 1.02 * ideal


@on_a_new_chip
def test_a_chain_takes_hardly_longer_than_its_corners_demand() -> None:
    rig = ramped()

    @REPEATABLE
    @given(chain=chains(most=12))
    def check(chain: list[Move]) -> None:
        trace = rig.ready().follow(chain, 60.0)
        rests = sum(jump(one, other) > TURNS_BACK for one, other in pairwise(chain))
        least = least_time(chain) + rests * (REST_S + 1.0 / START)
        assert trace.seconds + 1.0 / START <= 1.1 * least + len(chain) * 3 * TICK_S

    check()


@on_a_new_chip
def test_a_long_line_ends_at_the_start_speed_however_fast_it_was() -> None:
    rig = Rig()
    for acceleration, rate in ((1_100, 6_000), (8_000, 14_000), (32_000, 32_000)):
        rig.settle(
            acceleration=acceleration,
            start_rate_x=1_000,
            start_rate_z=1_000,
            rapid_rate_x=rate,
            rapid_rate_z=rate,
        )
        trace = rig.follow([Line(-30_000, 0, float(rate))], 30.0)
        last = CYCLES_PER_SECOND / (trace.times[-1] - trace.times[-2])
        assert last <= 1.1 * 1_000, (acceleration, rate)
