# SPDX-License-Identifier: Apache-2.0
"""Chains of segments on the chip: joints, waits, dead steps, holds, stops."""

from __future__ import annotations

import math
from typing import Any

from hypothesis import given
from hypothesis import strategies as st
from simulated.processes import on_a_new_chip
from tornillo.protocol import State
from virtual_lathe.chip import CYCLES_PER_SECOND

from motion.reference import Arc, Line, Move, Segment, Signal, Wait, jump
from motion.rig import Rig
from motion.strategies import chains, repeatable
from motion.trace import Trace, feed_errors, judge_all

BOUND = 0.51
FEED_BOUND_PCT = 2.0
# Where an axis turns back the tool rests.
TURNS_BACK = 0.97
CYCLES_PER_MS = CYCLES_PER_SECOND // 1000
REPEATABLE = repeatable(12)


def one_rate(chain: list[Move], rate: float) -> list[Move]:
    """The same moves at one feed."""
    return [
        Line(m.dx, m.dz, rate)
        if isinstance(m, Line)
        else Arc(m.dx, m.dz, m.cx, m.cz, m.towards_z, rate)
        for m in chain
    ]


def ramped(rig: Rig, **changes: int) -> Rig:
    """Settings of the machine with fast ramps."""
    values = {
        "acceleration": 20_000,
        "start_rate_x": 600,
        "start_rate_z": 600,
        "rapid_rate_x": 6_000,
        "rapid_rate_z": 6_000,
    }
    rig.settle(**(values | changes))
    return rig


@on_a_new_chip
def test_a_chain_visits_every_point_of_its_segments_in_order() -> None:
    rig = Rig()
    rig.quick()

    @REPEATABLE
    @given(chain=chains())
    def check(chain: list[Move]) -> None:
        trace = rig.ready().follow(chain, 60.0)
        for move, judged in judge_all(trace, chain):
            assert judged.worst <= BOUND, move

    check()


@on_a_new_chip
def test_a_chain_at_one_feed_keeps_it_over_the_joints() -> None:
    rig = Rig()
    rig.quick()

    @REPEATABLE
    @given(chain=chains(most=12), rate=st.sampled_from((300.0, 1_000.0, 3_000.0)))
    def check(chain: list[Move], rate: float) -> None:
        steady: list[Move] = [Line(40, 30, rate)]
        for move in one_rate(chain, rate):
            wide = isinstance(move, Line) or move.radius >= 100.0
            if wide and jump(steady[-1], move) < TURNS_BACK:
                steady.append(move)
        trace = rig.ready().follow(steady, 120.0)
        lengths = [length for _, judged in judge_all(trace, steady) for length in judged.lengths]
        assert feed_errors(trace, lengths, [rate] * len(lengths)) <= FEED_BOUND_PCT

    check()


@on_a_new_chip
def test_ramps_change_when_steps_come_and_never_which() -> None:
    rig = Rig()

    @REPEATABLE
    @given(chain=chains(most=20))
    def check(chain: list[Move]) -> None:
        rig.quick()
        plain = rig.follow(chain, 60.0)
        ramped(rig)
        assert rig.follow(chain, 60.0).moves == plain.moves

    check()


def axis_times(trace: Trace, axis: int) -> list[int]:
    """Times of the steps of one axis."""
    return [t for t, move in zip(trace.times, trace.moves, strict=True) if move[axis]]


@on_a_new_chip
def test_no_axis_is_faster_than_its_maximum() -> None:
    rig = ramped(Rig(), rapid_rate_x=2_000, rapid_rate_z=3_000)

    @REPEATABLE
    @given(chain=chains(most=12))
    def check(chain: list[Move]) -> None:
        trace = rig.ready().follow(one_rate(chain, 9_000.0), 60.0)
        for axis, most in ((0, 2_000), (1, 3_000)):
            times = axis_times(trace, axis)
            # Over 16 steps: single ones of the slower axis fall on the grid of the faster.
            for first, last in zip(times, times[16:], strict=False):
                assert 16 * CYCLES_PER_SECOND / (last - first) <= 1.08 * most

    check()


@on_a_new_chip
def test_a_hold_loses_nothing_wherever_it_comes() -> None:
    rig = ramped(Rig())

    @REPEATABLE
    @given(
        chain=chains(most=12),
        waits=st.lists(st.floats(0.0, 0.2), min_size=1, max_size=4),
    )
    def check(chain: list[Move], waits: list[float]) -> None:
        plain = rig.ready().follow(chain, 60.0)
        rig.start(chain)
        for wait in waits:
            rig.run(wait)
            if not rig.is_in(State.RUNNING):
                break
            rig.hold()
            rig.run(0.3)
            if not rig.is_in(State.HOLD):
                break
            stands = rig.position
            rig.run(0.05)
            assert rig.position == stands
            rig.resume()
        rig.finish(60.0)
        assert rig.trace().moves == plain.moves

    check()


LONG = [Line(-3_000, -1_000, 3_000.0), Line(3_000, -2_000, 3_000.0)]


@on_a_new_chip
def test_a_resume_before_the_tool_stands_goes_on_at_once() -> None:
    rig = ramped(Rig(), acceleration=4_000)
    plain = rig.follow(LONG, 20.0)
    rig.start(LONG)
    rig.run(0.6)
    rig.hold()
    rig.run(0.02)
    assert rig.stepping
    rig.resume()
    rig.finish(20.0)
    assert rig.trace().moves == plain.moves


@on_a_new_chip
def test_a_hold_before_the_first_step_holds() -> None:
    rig = ramped(Rig())
    plain = rig.follow(LONG, 20.0)
    rig.start_and_hold(LONG)
    assert not rig.trace().moves
    stands = rig.position
    rig.run(0.3)
    assert rig.is_in(State.HOLD)
    assert rig.position == stands
    rig.resume()
    rig.finish(20.0)
    assert rig.trace().moves == plain.moves


@on_a_new_chip
def test_a_second_hold_and_a_second_resume_change_nothing() -> None:
    rig = ramped(Rig())
    plain = rig.follow(LONG, 20.0)
    rig.start(LONG)
    rig.run(0.3)
    rig.hold()
    rig.tap("hold")
    rig.run(0.3)
    stands = rig.position
    rig.tap("hold")
    assert rig.is_in(State.HOLD)
    assert rig.position == stands
    rig.resume()
    rig.tap("run")
    rig.finish(20.0)
    assert rig.trace().moves == plain.moves


@on_a_new_chip
def test_a_stop_in_a_hold_leaves_the_position_true() -> None:
    rig = ramped(Rig())
    before = rig.position
    rig.start(LONG)
    rig.run(0.3)
    rig.hold()
    rig.run(0.3)
    rig.stop()
    assert rig.is_in(State.IDLE)
    rig.run(0.05)
    x, z = rig.trace().points()[-1]
    assert rig.position == (before[0] + x, before[1] + z)
    again: list[Segment] = [Line(-x, -z, 1_000.0)]
    trace = rig.follow(again, 20.0)
    assert trace.points()[-1] == (-x, -z)
    assert rig.position == before


@on_a_new_chip
def test_a_stop_at_full_speed_leaves_the_position_true() -> None:
    rig = ramped(Rig())
    before = rig.position
    rig.start(LONG)
    rig.run(0.4)
    rig.stop()
    rig.run(0.05)
    x, z = rig.trace().points()[-1]
    assert rig.position == (before[0] + x, before[1] + z)
    assert rig.follow([Line(5, 5, 500.0)], 5.0).moves == [(1, 1)] * 5


def gap(trace: Trace, index: int) -> float:
    """Milliseconds before a step."""
    return (trace.times[index] - trace.times[index - 1]) / CYCLES_PER_MS


@on_a_new_chip
def test_a_wait_is_as_long_as_it_says() -> None:
    rig = Rig()
    rig.quick(2_000)
    for milliseconds in (1, 20, 255):
        chain: list[Segment] = [Line(0, 20, 1_000.0), Wait(milliseconds), Line(0, 20, 1_000.0)]
        trace = rig.follow(chain, 10.0)
        assert len(trace.moves) == 40
        assert math.isclose(gap(trace, 20), milliseconds + 1.0, abs_tol=0.1)


@on_a_new_chip
def test_a_signal_is_seen_between_the_steps_that_it_stands_between() -> None:
    rig = Rig()
    rig.quick(2_000)
    seen: dict[str, Any] = {}
    rig.chip.set_variable("stream_signal", 0)

    def watch(rig: Rig) -> None:
        while not rig.chip.variable("stream_signal"):
            rig.run(1e-4)
        seen["cycle"] = rig.chip.cycle

    trace = rig.follow([Line(30, 0, 1_000.0), Signal(77), Line(30, 0, 1_000.0)], 5.0, watch)
    assert rig.chip.variable("stream_signal") == 77
    assert trace.times[29] < seen["cycle"] < trace.times[31]
