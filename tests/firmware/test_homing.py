# SPDX-License-Identifier: Apache-2.0
"""Homing: where zero is, how many dead steps were found, and every way it can fail."""

from __future__ import annotations

from functools import partial

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.homings import assert_alarm_and_recovery, dead_step_errors, spread
from simulated.processes import on_a_new_chip
from tornillo.link import Link
from tornillo.protocol import (
    Alarm,
    Axis,
    Command,
    ErrorCode,
    HomedAxis,
    State,
)
from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.machine import AxisName

PARK = -20
FILTERED_S = 0.01


@on_a_new_chip
def test_dead_steps_of_0_to_200_are_measured_exactly_behind_switches_with_0_to_60_of_travel() -> (
    None
):
    # All pairs are measured by the benchmark.
    assert set(dead_step_errors(((0, 60), (40, 7), (200, 60)))) == {0}


@pytest.mark.parametrize(("x", "z"), [(0, 150), (1, 23), (23, 1), (150, 0)])
@on_a_new_chip
def test_the_dead_steps_measured_are_those_of_the_screws(x: int, z: int) -> None:
    bench = Bench(backlash_x=x, backlash_z=z, seed=x + 1)
    bench.set(homing_repeats=2)
    bench.home()
    status = bench.status()
    assert (status.dead_x, status.dead_z) == (x, z)


@pytest.mark.parametrize(("x", "z"), [(0, 150), (23, 1)])
@on_a_new_chip
def test_the_travel_of_the_switch_is_not_taken_for_dead_steps(x: int, z: int) -> None:
    bench = Bench(backlash_x=x, backlash_z=z, switch_travel_x=14, switch_travel_z=14)
    bench.set(switch_travel_x=14, switch_travel_z=14, homing_repeats=2)
    bench.home()
    status = bench.status()
    assert (status.dead_x, status.dead_z) == (x, z)


@on_a_new_chip
def test_the_dead_steps_are_remembered_without_power() -> None:
    bench = Bench(backlash_x=9, backlash_z=11)
    bench.home()
    bench.power_cycle()
    settings = {entry.id.name: data.value for entry, data in bench.host.settings()}
    assert (settings["DEAD_X"], settings["DEAD_Z"]) == (9, 11)


@pytest.mark.parametrize("seed", [1, 5, 9])
@on_a_new_chip
def test_zero_is_where_the_switch_opens_and_the_slides_park_before_it(seed: int) -> None:
    bench = Bench(backlash_x=30, backlash_z=40, seed=seed)
    bench.home()
    assert bench.position == (PARK, PARK)
    assert bench.axis(Axis.X).slide == PARK
    assert bench.axis(Axis.Z).slide == PARK


@on_a_new_chip
def test_z_does_not_move_before_x_is_parked() -> None:
    bench = Bench(backlash_x=5, backlash_z=5)
    bench.host.home()
    bench.wait(lambda: bench.axis(Axis.Z).commanded != 0, 10.0, every=1e-3)
    assert bench.axis(Axis.X).slide == PARK
    assert bench.state is State.HOMING


@on_a_new_chip
def test_homing_starts_right_on_switches_that_are_already_pressed() -> None:
    bench = Bench(start_x=10, start_z=7, backlash_x=12, backlash_z=3)
    bench.home()
    assert (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide) == (PARK, PARK)
    assert (bench.status().dead_x, bench.status().dead_z) == (12, 3)


@pytest.mark.parametrize("seed", [1, 2])
@on_a_new_chip
def test_switches_that_bounce_for_5_ms_on_wires_with_10000_pulses_a_second_have_no_spread(
    seed: int,
) -> None:
    assert spread(homings=5, seed=seed) == 0


@on_a_new_chip
def test_10000_pulses_a_second_on_the_switch_lines_never_stop_a_run() -> None:
    bench = little_pin.homed_lathe_with_pin(noise_hz=10_000)
    for _ in range(3):
        bench.host.run()
        bench.wait_for(State.IDLE)
        assert bench.alarm == (Alarm.NONE, 0)


@pytest.mark.parametrize(("axis", "other"), [(Axis.X, Axis.Z), (Axis.Z, Axis.X)])
@on_a_new_chip
def test_one_axis_alone_is_homed_and_the_other_one_neither_moves_nor_counts(
    axis: Axis, other: Axis
) -> None:
    bench = Bench(backlash_x=5, backlash_z=9)
    bit, both = HomedAxis(axis + 1), HomedAxis.X | HomedAxis.Z
    bench.host.home(bit)
    bench.wait_for(State.IDLE)
    assert bench.axis(axis).slide == PARK
    assert bench.axis(other).steps == 1  # the current came on
    status = bench.status()
    assert status.homed_axes == bit
    assert not status.homed
    assert bench.refusal(bench.host.run) is ErrorCode.NOT_HOMED
    bench.host.home(both & ~bit)
    bench.wait_for(State.IDLE)
    assert bench.status().homed_axes == both
    assert bench.homed
    bench.host.home(bit)
    bench.run(0.05)
    assert bench.status().homed_axes == both & ~bit
    bench.wait_for(State.IDLE)
    assert (bench.homed, bench.position) == (True, (PARK, PARK))
    assert (bench.status().dead_x, bench.status().dead_z) == (5, 9)


@pytest.mark.parametrize("axes", [0, 4, 255])
@on_a_new_chip
def test_homing_of_an_axis_that_does_not_exist_is_refused(axes: int) -> None:
    bench = Bench()
    link = Link((bench.host, bench.lathe.port)[1])
    link.request(Command.HELLO)
    home = partial(link.request, Command.HOME, bytes([axes]))
    assert bench.refusal(home) is ErrorCode.OUT_OF_RANGE
    assert bench.is_in(State.IDLE)


# -- every way to fail -----------------------------------------------------------------------------


@pytest.mark.parametrize("axis", [Axis.X, Axis.Z])
@on_a_new_chip
def test_a_switch_that_is_not_found_within_the_travel_is_an_alarm(axis: Axis) -> None:
    bench = Bench(start_x=-700) if axis is Axis.X else Bench(start_z=-700)
    bench.set(travel_x=100, travel_z=100)
    bench.host.home()
    assert_alarm_and_recovery(bench, Alarm.HOME_NOT_FOUND, axis)
    # Travel and margin are 500 steps: now the switch is nearer than that.
    bench.home()


@pytest.mark.parametrize("axis", [Axis.X, Axis.Z])
@on_a_new_chip
def test_a_switch_that_does_not_open_again_is_an_alarm(axis: Axis) -> None:
    bench = Bench()
    bench.set(dead_max=20)
    bench.lathe.machine.break_switch_wire(AxisName(axis))
    bench.run(FILTERED_S)
    bench.host.home()
    assert_alarm_and_recovery(bench, Alarm.HOME_NOT_RELEASED, axis)
    bench.lathe.machine.break_switch_wire(AxisName(axis), broken=False)
    bench.run(FILTERED_S)
    bench.home()


@on_a_new_chip
def test_more_dead_steps_than_the_setting_allows_are_an_alarm() -> None:
    bench = Bench(backlash_x=40)
    bench.set(dead_max=30)
    bench.host.home()
    assert_alarm_and_recovery(bench, Alarm.HOME_OPENED_LATE, Axis.X)
    bench.set(dead_max=40)
    bench.home()


@on_a_new_chip
def test_a_switch_that_does_not_open_while_the_dead_steps_are_counted_is_an_alarm() -> None:
    bench = Bench()
    bench.set(dead_max=20)
    bench.host.home()
    bench.wait(lambda: bench.axis(Axis.X).pressed, 10.0, every=1e-3)
    bench.wait(lambda: not bench.axis(Axis.X).pressed, 10.0, every=1e-3)
    bench.wait(lambda: bench.axis(Axis.X).pressed, 10.0, every=1e-3)
    bench.lathe.machine.break_switch_wire(AxisName.X)
    assert_alarm_and_recovery(bench, Alarm.HOME_NOT_RELEASED, Axis.X)
    bench.lathe.machine.break_switch_wire(AxisName.X, broken=False)
    bench.run(FILTERED_S)
    bench.home()


@pytest.mark.parametrize("axis", [Axis.X, Axis.Z])
@on_a_new_chip
def test_the_other_switch_closing_is_an_alarm(axis: Axis) -> None:
    bench = Bench(start_x=-300, start_z=-300)
    other = AxisName.Z if axis is Axis.X else AxisName.X
    bench.host.home()
    bench.wait(lambda: bench.axis(axis).slide > -100, 20.0)
    bench.lathe.machine.break_switch_wire(other)
    assert_alarm_and_recovery(bench, Alarm.WRONG_SWITCH, axis)
    bench.lathe.machine.break_switch_wire(other, broken=False)
    bench.home()


@pytest.mark.parametrize("by", ["command", "button"])
@pytest.mark.parametrize("axis", [Axis.X, Axis.Z])
@on_a_new_chip
def test_stopping_during_homing_is_an_alarm(axis: Axis, by: str) -> None:
    bench = Bench(start_x=-200, start_z=-200)
    bench.host.home()
    bench.wait(lambda: bench.axis(axis).slide > -150, 20.0)
    if by == "command":
        bench.host.stop()
    else:
        bench.press("stop")
    assert_alarm_and_recovery(bench, Alarm.STOPPED_HOMING, axis)
    bench.home()


@pytest.mark.parametrize("axis", [Axis.X, Axis.Z])
@on_a_new_chip
def test_dead_steps_that_change_between_repeats_are_an_alarm(axis: Axis) -> None:
    bench = Bench(backlash_x=10, backlash_z=10)
    name = AxisName(axis)
    bench.host.home()
    bench.wait(lambda: bench.chip.variable("homing_axis") == axis, 20.0)
    wait_for_repeat(bench, name)
    bench.lathe.machine.options(name).switch_travel = 6
    bench.lathe.machine.break_switch_wire(name, broken=False)
    assert_alarm_and_recovery(bench, Alarm.DEAD_STEPS_SPREAD, axis)
    bench.lathe.machine.options(name).switch_travel = 0
    bench.lathe.machine.break_switch_wire(name, broken=False)
    bench.home()


def wait_for_repeat(bench: Bench, name: AxisName) -> None:
    """Let the switch close and open twice: seek, and the first of the counts."""
    for _ in range(2):
        bench.wait(lambda: bench.axis(name).pressed, 10.0, every=1e-3)
        bench.wait(lambda: not bench.axis(name).pressed, 10.0, every=1e-3)


@pytest.mark.parametrize(
    ("first", "later", "median"), [(0, 2, 12), (2, 0, 10), (0, 1, 11), (1, 0, 10)]
)
@on_a_new_chip
def test_a_spread_within_the_setting_gives_the_median(first: int, later: int, median: int) -> None:
    bench = Bench(backlash_x=10, backlash_z=10, switch_travel_x=first)
    bench.host.home()
    wait_for_repeat(bench, AxisName.X)
    bench.lathe.machine.options(AxisName.X).switch_travel = later
    bench.lathe.machine.break_switch_wire(AxisName.X, broken=False)
    bench.wait(lambda: bench.state is not State.HOMING, 30.0)
    assert bench.homed
    assert bench.status().dead_x == median


@pytest.mark.parametrize("rate", [40, 60])
@on_a_new_chip
def test_the_slow_approach_has_the_rate_of_its_setting(rate: int) -> None:
    bench = Bench(backlash_x=5)
    bench.set(latch_rate=rate, homing_repeats=1)
    bench.host.home()
    bench.wait(lambda: bench.axis(Axis.X).pressed, 10.0, every=1e-3)
    bench.wait(lambda: not bench.axis(Axis.X).pressed, 10.0, every=1e-3)
    bench.wait(lambda: bench.axis(Axis.X).pressed, 10.0, every=1e-3)
    bench.run(0.018)
    bench.chip.log_pins("RD0", "RD1", "RD2", "RD3")
    bench.run(0.16)
    first, second = bench.chip.pin_changes()[:2]
    assert abs(second[0] - first[0] - CYCLES_PER_SECOND // rate) <= 1
    bench.wait(lambda: bench.state is not State.HOMING, 10.0)
    assert bench.status().dead_x == 5
