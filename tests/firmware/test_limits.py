# SPDX-License-Identifier: Apache-2.0
"""Hard limits: latched alarms with a way out, broken wires, and how soon the motors stop."""

from __future__ import annotations

from functools import partial

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import branch, on_a_new_chip
from simulated.standing import COILS
from simulated.stopping import INPUTS, moving_lathe, stop
from tornillo.protocol import Alarm, Axis, ErrorCode, State
from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.machine import AxisName

#: Farther than this from its end a closed switch is a broken wire.
NEAR = 400


@pytest.mark.parametrize("axis", [Axis.X, Axis.Z])
@on_a_new_chip
def test_a_hard_limit_is_latched_and_leaves_one_way_out(axis: Axis) -> None:
    bench = Bench(stock_diameter_mm=0.1, backlash_x=7, backlash_z=12)
    other = Axis(1 - axis)
    host = bench.host
    host.jog(axis, 60, 300)
    bench.wait_for(State.ALARM, 1.0)
    assert bench.alarm == (Alarm.LIMIT, axis)
    # The filter takes 4 ms, a step 3.3 ms.
    assert 1 <= bench.axis(axis).slide <= 3
    assert bench.refusal(lambda: host.jog(axis, -60)) is ErrorCode.ALARM
    host.reset()
    assert bench.axis(axis).pressed
    for steps in (1, 60):
        assert bench.refusal(partial(host.jog, axis, steps)) is ErrorCode.WRONG_WAY
    # The other slide may move: the tool may have to leave the work.
    host.jog(other, -10)
    bench.wait_for(State.IDLE)
    assert bench.axis(other).slide < -30
    # Not far enough: still pressed, and still only this way.
    host.jog(axis, -1)
    bench.wait_for(State.IDLE)
    assert bench.refusal(lambda: host.jog(axis, 1)) is ErrorCode.WRONG_WAY
    host.jog(axis, -40)
    bench.wait_for(State.IDLE)
    assert not bench.axis(axis).pressed
    host.jog(axis, 2)
    bench.wait_for(State.IDLE)
    assert bench.alarm == (Alarm.NONE, 0)
    bench.home()


@on_a_new_chip
def test_homing_is_a_way_out_too() -> None:
    bench = Bench(stock_diameter_mm=0.1)
    bench.host.jog(Axis.X, 60, 300)
    bench.wait_for(State.ALARM, 1.0)
    bench.host.reset()
    bench.home()


@on_a_new_chip
def test_on_the_way_out_of_one_limit_the_other_one_is_watched() -> None:
    bench = Bench(stock_diameter_mm=0.1)
    bench.host.jog(Axis.X, 60, 300)
    bench.wait_for(State.ALARM, 1.0)
    bench.host.reset()
    bench.host.jog(Axis.Z, 60, 300)
    bench.wait_for(State.ALARM, 1.0)
    assert bench.alarm == (Alarm.LIMIT, Axis.Z)
    bench.host.reset()
    for axis in Axis:
        assert bench.refusal(partial(bench.host.jog, axis, 1)) is ErrorCode.WRONG_WAY
        bench.host.jog(axis, -40)
        bench.wait_for(State.IDLE)
    bench.home()


@pytest.mark.parametrize("axis", [Axis.X, Axis.Z])
@pytest.mark.parametrize("place", [-NEAR, -NEAR - 1])
@on_a_new_chip
def test_a_switch_that_closes_far_from_its_end_is_a_fault_of_its_wire(
    axis: Axis, place: int
) -> None:
    bench = Bench(stock_diameter_mm=0.1)
    bench.set(homing_repeats=1)
    bench.home()
    bench.host.goto(**{"x" if axis is Axis.X else "z": place})
    bench.wait_for(State.IDLE)
    bench.lathe.machine.break_switch_wire(AxisName(axis))
    bench.wait_for(State.ALARM, 0.1)
    kind = Alarm.SWITCH_WIRING if place < -NEAR else Alarm.LIMIT
    assert bench.alarm == (kind, axis)
    assert bench.status().alarm_axis is axis
    assert not bench.homed
    bench.host.reset()
    # A broken wire keeps that slide from its switch, and nothing else.
    assert bench.refusal(lambda: bench.host.jog(axis, 1)) is ErrorCode.WRONG_WAY
    bench.host.jog(Axis(1 - axis), 10)
    bench.wait_for(State.IDLE)
    bench.lathe.machine.break_switch_wire(AxisName(axis), broken=False)
    bench.run(0.01)
    bench.home()


@on_a_new_chip
def test_a_wire_that_breaks_in_the_cut_is_told_from_a_limit() -> None:
    bench = moving_lathe()
    bench.wait(lambda: bench.axis(Axis.Z).slide < -NEAR - 20, 5.0)
    bench.lathe.machine.break_switch_wire(AxisName.Z)
    bench.wait_for(State.ALARM, 0.1)
    assert bench.alarm == (Alarm.SWITCH_WIRING, Axis.Z)


@on_a_new_chip
def test_emergency_stop_and_hard_limits_end_the_steps_within_a_millisecond() -> None:
    bench = moving_lathe()
    for moment in range(8):
        bench.run(0.0371)
        for name in INPUTS:
            stopped = branch(partial(stop, bench, name))
            assert stopped.latency_cycles <= CYCLES_PER_SECOND // 1000, (moment, name)
            assert stopped.total_cycles <= 5 * CYCLES_PER_SECOND // 1000
            assert stopped.alarm is INPUTS[name]


@on_a_new_chip
def test_a_part_that_leaves_the_travel_in_its_last_cut_is_refused_before_the_first_step() -> None:
    bench = little_pin.homed_lathe_with_pin()
    bench.host.upload(little_pin.image("two", little_pin.OPERATIONS))
    # The first operation, the face, still fits: only the end of the cylinder does not.
    last = little_pin.end_of(little_pin.CYLINDER)
    bench.set(travel_z=100, zero_z=-(100 + last) - 1)
    bench.chip.log_pins(*COILS)
    assert bench.refusal(bench.host.run) is ErrorCode.INVALID_PART
    bench.run(0.2)
    assert bench.chip.pin_changes() == []
    assert (bench.state, bench.homed) == (State.IDLE, True)
    bench.set(zero_z=-(100 + last))
    bench.host.run()
    bench.run(0.2)
    assert bench.chip.pin_changes() != []
