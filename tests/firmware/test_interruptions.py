# SPDX-License-Identifier: Apache-2.0
"""What stops a run: hold, stop, emergency stop, limit switches, a stream that runs dry."""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from itertools import pairwise
from typing import Any

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import branch, on_a_new_chip
from simulated.standing import COILS, REST_CYCLES, Holds, Limits, assert_nothing_moves, entries
from tornillo.errors import ChipError
from tornillo.protocol import Alarm, Axis, ErrorCode, State
from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.machine import AxisName

STOP_WITHIN_S = 0.005
LIMITS = Limits()


def coils(bench: Bench) -> tuple[int, int]:
    """Return the patterns on the coil pins, X and Z."""
    return bench.chip.port("D") & 15, bench.chip.port("B") & 15


def running_lathe(**options: Any) -> Bench:
    """Return a lathe that has just begun to cut the little pin."""
    bench = little_pin.homed_lathe_with_pin(**options)
    bench.host.run()
    return bench


@pytest.mark.parametrize("rate", [1000, 3000])
@on_a_new_chip
def test_hold_brakes_within_the_braking_distance_and_run_goes_on_without_losing_a_step(
    rate: int,
) -> None:
    bench = little_pin.lathe_with_pin(backlash_x=7, backlash_z=12, pull_in=float(rate + 100))
    bench.set(rapid_rate_x=rate, rapid_rate_z=rate)
    bench.home()
    bench.host.run()
    bench.run(0.12)  # in the approach one entry is more than a step of the path
    following = Holds(bench, LIMITS)
    braked, holds = 0, 0
    while bench.is_in(State.RUNNING):
        bench.run(0.0371)
        if bench.is_in(State.RUNNING):
            holds += 1
            if holds % 2:
                bench.press("hold", 0.006)
            else:
                with suppress(ChipError):  # when the part ends first
                    bench.host.hold()
            if bench.is_in(State.IDLE):
                break
            braked = max(braked, following.come_to_a_stand())
            assert bench.position == (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide)
            if holds % 2:
                bench.press("run", 0.006)
            else:
                bench.host.resume()
    assert holds > 20
    assert braked > 10
    assert bench.status().finished
    little_pin.assert_cut_exactly(bench)


@pytest.mark.parametrize("acceleration", [8000, 32000])
@on_a_new_chip
def test_behind_a_rest_a_slide_starts_no_faster_than_the_start_rate(acceleration: int) -> None:
    bench = little_pin.lathe_with_pin()
    bench.set(acceleration=acceleration)
    bench.home()
    bench.chip.log_pins(*COILS)
    bench.host.run()
    bench.wait_for(State.IDLE)
    times = entries(bench.chip.pin_changes())
    intervals = [after - time for time, after in pairwise(times)]
    rests = [number for number, interval in enumerate(intervals) if interval > REST_CYCLES]
    # Between the way out of the face and the first infeed.
    assert len(rests) >= 1
    start = CYCLES_PER_SECOND // LIMITS.start_rate
    assert min(intervals[number + 1] for number in rests if number + 1 < len(intervals)) >= (
        CYCLES_PER_SECOND // (LIMITS.start_rate + 3 * acceleration // 1000)
    )
    assert min(intervals[number] - REST_CYCLES for number in rests) >= start


@on_a_new_chip
def test_resume_while_it_still_brakes_goes_on_and_a_second_hold_or_resume_changes_nothing() -> None:
    bench = running_lathe(backlash_x=7, backlash_z=12)
    bench.run(0.06)
    for _ in range(8):
        bench.run(0.05)
        bench.host.hold()
        bench.host.hold()
        bench.host.resume()
        bench.host.resume()
        assert bench.is_in(State.RUNNING)
    bench.wait_for(State.IDLE)
    assert bench.status().finished
    little_pin.assert_cut_exactly(bench)


@on_a_new_chip
def test_stop_while_a_hold_brakes_or_stands_ends_the_run_and_keeps_the_position() -> None:
    bench = running_lathe(backlash_x=7, backlash_z=12)
    bench.run(0.3)

    def stop_after(seconds: float) -> None:
        bench.host.hold()
        bench.run(seconds)
        bench.host.stop()
        assert (bench.state, bench.homed) == (State.IDLE, True)
        assert_nothing_moves(bench)
        bench.host.run()
        bench.wait_for(State.IDLE)
        little_pin.assert_cut_exactly(bench)

    for seconds in (0.0, 0.004, 0.3):
        branch(partial(stop_after, seconds))


@on_a_new_chip
def test_after_stop_the_next_run_cuts_the_part_exactly() -> None:
    bench = running_lathe(backlash_x=7, backlash_z=12)

    def stop_and_run_again(after: float) -> None:
        bench.run(after)
        bench.host.stop()
        assert (bench.state, bench.homed) == (State.IDLE, True)
        assert_nothing_moves(bench)
        bench.host.run()
        bench.wait_for(State.IDLE)
        little_pin.assert_cut_exactly(bench)

    for after in (0.12, 0.513, 0.931, 1.307):
        branch(partial(stop_and_run_again, after))


@on_a_new_chip
def test_a_move_broken_off_anywhere_leaves_coils_and_rotor_together() -> None:
    bench = running_lathe(backlash_x=7, backlash_z=12)

    def stop_and_start_again() -> None:
        bench.host.stop()
        patterns = bench.chip.variable("pattern_x"), bench.chip.variable("pattern_z")
        assert patterns == coils(bench)
        x, z = bench.axis(Axis.X), bench.axis(Axis.Z)
        assert (x.rotor, z.rotor) == (x.commanded, z.commanded)
        assert bench.position == (x.slide, z.slide)
        bench.host.run()
        bench.run(0.08)
        assert_nothing_lost(bench)

    for _ in range(30):
        bench.run(0.0503)
        branch(stop_and_start_again)


def assert_nothing_lost(bench: Bench) -> None:
    """Check that the chip's position is the slides' and that no coil change was a jump."""
    bench.host.stop()
    assert bench.position == (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide)
    assert bench.axis(Axis.X).jumps == bench.axis(Axis.Z).jumps == 0


@pytest.mark.parametrize("moving", ["running", "homing"])
@on_a_new_chip
def test_the_emergency_stop_ends_all_steps_and_takes_the_current_off(moving: str) -> None:
    bench = little_pin.homed_lathe_with_pin(start_x=-200)
    bench.expect_broken("no step lost", "coil pattern legal")
    if moving == "running":
        bench.host.run()
    else:
        bench.host.home()
    bench.run(0.15)
    assert bench.moving
    bench.chip.log_pins(*COILS)
    pressed = bench.chip.cycle
    bench.lathe.press("estop")
    bench.run(0.1)
    last = bench.chip.pin_changes()[-1][0]
    assert last - pressed <= STOP_WITHIN_S * CYCLES_PER_SECOND
    assert coils(bench) == (0, 0)
    assert (bench.state, bench.alarm[0]) == (State.ALARM, Alarm.ESTOP)
    assert not bench.homed
    assert bench.refusal(bench.host.reset) is ErrorCode.ESTOP
    bench.press("stop")
    assert bench.state is State.ALARM
    bench.lathe.press("release")
    bench.run(0.01)
    assert bench.state is State.ALARM
    bench.host.reset()
    assert bench.refusal(bench.host.run) is ErrorCode.NOT_HOMED
    bench.home()
    assert bench.position == (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide)


@on_a_new_chip
def test_a_trip_while_the_main_loop_looks_whether_the_run_is_over_does_not_finish_it() -> None:
    bench = running_lathe()
    bench.wait(lambda: bench.axis(Axis.Z).slide < -90, 5.0)
    bench.wait(lambda: bench.axis(Axis.X).slide == -20, 5.0)
    bench.wait(lambda: bench.axis(Axis.Z).slide > -40, 5.0)
    # On the last way home; all of it is in the stream already.
    assert bench.chip.run_to_address(bench.chip.symbols.code("path_busy"))
    bench.abort_stream()
    bench.chip.set_variable("guard_tripped", 0x01)
    bench.run(0.01)
    assert bench.alarm == (Alarm.LIMIT, Axis.X)
    bench.host.reset()
    assert not bench.status().finished


@on_a_new_chip
def test_a_machine_without_emergency_stop_does_not_look_at_its_pin() -> None:
    bench = Bench()
    bench.set(estop_fitted=0)
    bench.lathe.press("estop")
    bench.lathe.machine.set_motor_power(True)
    bench.run(0.02)
    assert bench.state is State.IDLE
    bench.home()


@pytest.mark.parametrize("axis", [Axis.X, Axis.Z])
@on_a_new_chip
def test_a_limit_switch_while_homed_is_an_alarm_with_its_axis_and_the_coils_hold(
    axis: Axis,
) -> None:
    bench = running_lathe()
    bench.run(0.3)
    bench.chip.log_pins(*COILS)
    broken = bench.chip.cycle
    bench.lathe.machine.break_switch_wire(AxisName(axis))
    bench.run(0.05)
    last = bench.chip.pin_changes()[-1][0]
    assert last - broken <= STOP_WITHIN_S * CYCLES_PER_SECOND
    assert bench.alarm == (Alarm.LIMIT, axis)
    assert all(coils(bench))
    assert not bench.homed
    assert bench.position == (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide)
    assert bench.refusal(bench.host.home) is ErrorCode.ALARM
    # The way out, besides homing: test_limits.py.
    bench.host.reset()
    assert bench.state is State.IDLE
    bench.lathe.machine.break_switch_wire(AxisName(axis), broken=False)
    bench.run(0.01)
    bench.home()


@on_a_new_chip
def test_a_stream_that_runs_dry_in_mid_move_is_an_alarm() -> None:
    bench = running_lathe()
    bench.run(0.3)
    # In the state IDLE the main loop plans nothing; the step interrupt was not told.
    bench.chip.set_variable("machine_state", State.IDLE)
    bench.wait_for(State.ALARM, 1.0)
    assert bench.alarm == (Alarm.STREAM_DRY, 0)
    assert not bench.homed
    assert_nothing_moves(bench)
    assert bench.position == (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide)
    bench.host.reset()
    bench.home()
    bench.host.run()
    bench.wait_for(State.IDLE)
    assert bench.status().finished


@on_a_new_chip
def test_the_stream_never_comes_near_to_running_dry_while_status_is_polled() -> None:
    bench = running_lathe(backlash_x=7, backlash_z=12)
    while bench.state is State.RUNNING:
        bench.run(0.05)
        low = bench.status().stream_low
    assert low >= 40


@on_a_new_chip
def test_the_cable_pulled_in_mid_cut_changes_nothing() -> None:
    bench = running_lathe(backlash_x=7, backlash_z=12)
    bench.run(0.4)
    bench.unplug()
    bench.run(0.4)
    bench.lathe.host.plug()
    bench.run(0.1)
    bench.wait_for(State.IDLE)
    little_pin.assert_cut_exactly(bench)
    assert bench.status().finished
