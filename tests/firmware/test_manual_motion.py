# SPDX-License-Identifier: Apache-2.0
"""Jog and goto: where they end, how fast they are, what ends them early."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any

import pytest
from simulated.bench import Bench
from simulated.processes import on_a_new_chip
from simulated.standing import COILS, assert_nothing_moves, entries
from simulated.watching import Watch
from tornillo.jogging import SILENCE_MS, STOPPED_WITHIN_S, fastest
from tornillo.link import Link
from tornillo.protocol import REQUESTS, Axis, Command, ErrorCode, SettingId, State
from virtual_lathe.chip import CYCLES_PER_SECOND

HOME_RATE = 800
BRAKING_STEPS = 60  # from 1000 step/s at 8000 step/s2 to 400 step/s, and some


def homed(**options: Any) -> Bench:
    """Return a homed lathe without stock in the way."""
    bench = Bench(stock_diameter_mm=0.1, **options)
    bench.set(homing_repeats=1)
    bench.home()
    return bench


def still(bench: Bench, timeout: float = 30.0) -> None:
    """Let a move end, asking for the status as a host does."""
    bench.wait(lambda: not bench.status().moving, timeout, every=0.1)


@pytest.mark.parametrize("axis", [Axis.X, Axis.Z])
@on_a_new_chip
def test_a_jog_moves_one_slide_by_its_steps_whatever_the_screw_has_to_turn(axis: Axis) -> None:
    bench = homed(backlash_x=7, backlash_z=12)
    other = Axis(1 - axis)
    place = list(bench.position)
    for steps in (-100, 40, -1, 1, 30, -300):
        bench.host.jog(axis, steps)
        assert bench.is_in(State.MOVING)
        still(bench)
        place[axis] += steps
        assert list(bench.position) == place
        assert bench.axis(axis).slide == place[axis]
        assert bench.axis(other).slide == place[other]
    assert bench.homed


@pytest.mark.parametrize("rate", [50, 300])
@on_a_new_chip
def test_a_jog_has_the_rate_asked_for(rate: int) -> None:
    bench = homed()
    bench.chip.log_pins(*COILS)
    bench.host.jog(Axis.X, -30, rate)
    still(bench)
    times = entries(bench.chip.pin_changes())
    assert len(times) == 30
    # A read of flash holds an interrupt up by a cycle.
    assert {b - a for a, b in pairwise(times)} <= {
        CYCLES_PER_SECOND // rate + i for i in (-1, 0, 1)
    }


@pytest.mark.parametrize("move", ["jog", "goto"])
@on_a_new_chip
def test_without_a_rate_a_move_is_rapid_and_never_faster(move: str) -> None:
    bench = homed()
    bench.set(rapid_rate_x=900)
    for rate in (0, 60_000):
        bench.chip.log_pins(*COILS)
        if move == "jog":
            bench.host.jog(Axis.X, -300, rate)
        else:
            bench.host.goto(x=bench.position[0] - 300, rate=rate)
        still(bench)
        times = entries(bench.chip.pin_changes())
        fastest = CYCLES_PER_SECOND / min(b - a for a, b in pairwise(times))
        assert 0.99 * 900 < fastest < 1.01 * 900


@pytest.mark.parametrize("axis", [Axis.X, Axis.Z])
@on_a_new_chip
def test_soft_limits_are_the_travel_of_the_tool_to_the_step(axis: Axis) -> None:
    bench = homed(backlash_x=7, backlash_z=12)
    bench.set(travel_x=150, travel_z=200)
    travel = 150 if axis is Axis.X else 200
    name = "x" if axis is Axis.X else "z"
    for end, beyond in ((0, 1), (-travel, -travel - 1)):
        here = bench.position[axis]
        for refused in (beyond, 32_767 if end == 0 else -32_768):
            jog = bench.refusal(partial(bench.host.jog, axis, refused - here))
            goto = bench.refusal(partial(bench.host.goto, **{name: refused}))
            assert (jog, goto) == (ErrorCode.OUT_OF_RANGE, ErrorCode.OUT_OF_RANGE)
        assert bench.is_in(State.IDLE)
        assert_nothing_moves(bench, 0.02)
        bench.host.goto(**{name: end})
        still(bench)
        assert bench.position[axis] == bench.axis(axis).slide == end
        bench.host.jog(axis, -10 if end == 0 else 10)
        still(bench)
        bench.host.jog(axis, 10 if end == 0 else -10)
        still(bench)
        assert bench.position[axis] == bench.axis(axis).slide == end
    assert bench.homed


@on_a_new_chip
def test_places_that_the_chip_cannot_count_to_are_refused() -> None:
    bench = homed()
    link = Link(bench.lathe.port)
    link.request(Command.HELLO)
    for command, rest in ((Command.JOG, (0, 500)), (Command.GOTO, (0,))):
        for place in (40_000, -40_000, 2**31 - 1, -(2**31), -65_556):
            payload = REQUESTS[command].pack(place, -20, *rest)
            answer = bench.refusal(partial(link.request, command, payload))
            assert answer is ErrorCode.OUT_OF_RANGE
    assert bench.is_in(State.IDLE)


@on_a_new_chip
def test_a_goto_needs_homing_and_a_jog_does_not() -> None:
    bench = Bench(stock_diameter_mm=0.1)
    assert bench.refusal(lambda: bench.host.goto(x=-50)) is ErrorCode.NOT_HOMED
    bench.host.jog(Axis.X, -50)
    still(bench)
    assert bench.position == (-50, 0)
    assert bench.axis(Axis.X).slide == -80


@on_a_new_chip
def test_before_homing_a_jog_is_no_faster_than_the_homing_rate() -> None:
    bench = Bench(stock_diameter_mm=0.1)
    for rate in (0, 1000, 900):
        bench.chip.log_pins(*COILS)
        bench.host.jog(Axis.X, -250, rate)
        still(bench)
        times = entries(bench.chip.pin_changes())
        fastest = CYCLES_PER_SECOND / min(b - a for a, b in pairwise(times))
        assert 0.99 * HOME_RATE < fastest < 1.01 * HOME_RATE
    bench.chip.log_pins(*COILS)
    bench.host.jog(Axis.X, 20, 100)
    still(bench)
    times = entries(bench.chip.pin_changes())
    assert {b - a for a, b in pairwise(times)} == {CYCLES_PER_SECOND // 100}


@on_a_new_chip
def test_on_the_way_out_x_goes_first_and_on_the_way_in_z() -> None:
    bench = homed(backlash_x=7, backlash_z=12)
    for x, z, first in ((-200, -150, "Z"), (-100, -60, "X"), (-50, -200, "X"), (-90, -90, "Z")):
        watch = Watch(bench)
        bench.host.goto(x=x, z=z)
        still(bench)
        axes = [movement.axis for movement in watch.movements]
        assert axes == sorted(axes, reverse=first == "Z")
        assert set(axes) == {"X", "Z"}
        assert bench.position == (x, z)
        assert (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide) == (x, z)


def interval_growth(bench: Bench) -> list[int]:
    """Return the intervals of the last steps, in cycles."""
    times = entries(bench.chip.pin_changes())
    return [b - a for a, b in pairwise(times)]


@on_a_new_chip
def test_a_jog_brakes_half_a_second_after_the_host_was_heard_last() -> None:
    bench = homed(backlash_z=12)
    bench.host.jog(Axis.Z, -5000)
    bench.run(0.1)
    bench.status()
    heard = bench.chip.seconds
    bench.unplug()
    bench.chip.log_pins(*COILS)
    bench.run(0.48)
    assert bench.is_in(State.MOVING)
    bench.wait_for(State.IDLE, 0.2)
    assert 0.49 < bench.chip.seconds - heard < 0.6
    intervals = interval_growth(bench)
    # It was at 1000 step/s and did not stop dead.
    assert 0.99 < CYCLES_PER_SECOND / min(intervals) / 1000 < 1.01
    assert CYCLES_PER_SECOND / intervals[-1] < 500
    assert bench.homed
    assert bench.position[1] == bench.axis(Axis.Z).slide
    assert_nothing_moves(bench)


@pytest.mark.parametrize("rate", [200, 1000])
@on_a_new_chip
def test_a_jog_by_keys_stands_200_ms_after_the_link_was_lost(rate: int) -> None:
    bench = homed(backlash_z=12)
    start = bench.host.setting(SettingId.START_RATE_Z).value
    acceleration = bench.host.setting(SettingId.ACCELERATION).value
    assert rate <= fastest(start, acceleration)
    bench.host.jog(Axis.Z, -5000, rate, SILENCE_MS)
    bench.run(0.5 * SILENCE_MS / 1000)
    bench.status()
    heard = bench.chip.seconds
    bench.unplug()
    bench.chip.log_pins(*COILS)
    bench.wait_for(State.IDLE, STOPPED_WITHIN_S)
    assert bench.chip.seconds - heard < STOPPED_WITHIN_S
    last = entries(bench.chip.pin_changes())[-1] / CYCLES_PER_SECOND
    assert SILENCE_MS / 1000 - 0.01 < last - heard < STOPPED_WITHIN_S
    assert bench.homed
    assert bench.position[1] == bench.axis(Axis.Z).slide


@on_a_new_chip
def test_any_request_keeps_a_jog_alive_and_a_goto_needs_none() -> None:
    bench = homed()
    bench.host.jog(Axis.Z, -1500)
    begun = bench.chip.seconds
    while bench.is_in(State.MOVING):
        bench.run(0.4)
        bench.host.part(0)
    assert bench.chip.seconds - begun > 1.4
    assert bench.position[1] == -1520
    bench.host.goto(z=-20)
    bench.unplug()
    bench.wait_for(State.IDLE, 3.0)
    assert bench.position[1] == -20


@pytest.mark.parametrize("move", ["jog", "goto"])
@pytest.mark.parametrize("by", ["command", "button"])
@on_a_new_chip
def test_hold_brakes_a_move_and_ends_it(move: str, by: str) -> None:
    bench = homed(backlash_z=12)
    start = bench.position[1]
    if move == "jog":
        bench.host.jog(Axis.Z, -3000)
    else:
        bench.host.goto(z=start - 3000)
    bench.run(0.4)
    before = bench.position[1]
    if by == "command":
        bench.host.hold()
    else:
        bench.press("hold", 0.01)
    bench.wait_for(State.IDLE, 0.3)
    assert 0 < before - bench.position[1] < BRAKING_STEPS + (20 if by == "button" else 0)
    assert bench.position[1] == bench.axis(Axis.Z).slide
    assert bench.homed
    assert_nothing_moves(bench)


@on_a_new_chip
def test_a_hold_right_behind_a_jog_ends_it_too() -> None:
    bench = homed()
    start = bench.position
    bench.host.jog(Axis.X, -300)
    bench.host.hold()
    bench.wait_for(State.IDLE, 0.2)
    assert -BRAKING_STEPS < bench.position[0] - start[0] <= 0
    bench.host.jog(Axis.X, -30)
    still(bench)
    assert bench.position[0] == bench.axis(Axis.X).slide


@pytest.mark.parametrize("by", ["command", "button"])
@on_a_new_chip
def test_stop_ends_a_move_at_once_and_the_position_stays_known(by: str) -> None:
    bench = homed(backlash_z=12)
    bench.host.jog(Axis.Z, -3000, 400)
    bench.run(0.2)
    if by == "command":
        bench.host.stop()
    else:
        bench.press("stop")
    assert (bench.state, bench.homed) == (State.IDLE, True)
    assert bench.position[1] == bench.axis(Axis.Z).slide
    assert_nothing_moves(bench)


@on_a_new_chip
def test_while_one_move_is_under_way_every_other_is_refused() -> None:
    bench = homed()
    host = bench.host
    host.jog(Axis.X, -300)
    others: tuple[Callable[[], None], ...] = (
        lambda: host.jog(Axis.X, 50),
        lambda: host.jog(Axis.Z, -50),
        lambda: host.goto(x=-20),
        lambda: host.touch(Axis.X, -50),
        host.home,
        host.run,
    )
    assert {bench.refusal(other) for other in others} == {ErrorCode.BUSY}
    assert bench.refusal(host.resume) is ErrorCode.NOT_RUNNING
    assert bench.refusal(lambda: host.override(50)) is ErrorCode.NOT_RUNNING
    still(bench)
    assert bench.position == (-320, -20)


@on_a_new_chip
def test_a_move_of_no_length_is_over_at_once() -> None:
    bench = homed()
    bench.host.goto()
    bench.wait_for(State.IDLE, 0.1)
    bench.host.jog(Axis.X, 0)
    bench.wait_for(State.IDLE, 0.1)
    assert bench.position == (-20, -20)
    assert bench.homed
