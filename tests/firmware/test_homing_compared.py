# SPDX-License-Identifier: Apache-2.0
"""What a homing finds compared with the one before: dead steps, coil phase, position."""

from __future__ import annotations

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.homings import PARK, assert_alarm_and_recovery
from simulated.processes import on_a_new_chip
from tornillo.protocol import Alarm, Axis, MachineWarning, State
from virtual_lathe.machine import AxisName


def homing_after_a_power_cut(backlash_x: int, start_x: int = -30) -> Bench:
    """Home with 20 dead steps of X, and put the slide elsewhere and change them without power."""
    bench = Bench(backlash_x=20, backlash_z=30)
    bench.expect_broken("at most one full step at a time", "no step lost")
    bench.lathe.machine.options(AxisName.X).slack = 0
    bench.lathe.machine.place(AxisName.X, -30)
    bench.home()
    assert bench.status().warnings == 0
    bench.power_cycle()
    bench.lathe.machine.options(AxisName.X).backlash = backlash_x
    bench.lathe.machine.place(AxisName.X, start_x)
    bench.host.home()
    bench.wait(lambda: bench.state is not State.HOMING, 60.0)
    return bench


@pytest.mark.parametrize(("now", "reported"), [(25, False), (26, True), (15, False), (14, True)])
@on_a_new_chip
def test_dead_steps_that_jump_are_reported_until_the_next_homing(now: int, reported: bool) -> None:
    bench = homing_after_a_power_cut(backlash_x=now)
    assert bench.homed
    assert bench.status().dead_x == now
    assert bench.status().warnings == (MachineWarning.DEAD_X if reported else 0)
    bench.home()
    assert bench.status().warnings == 0


@on_a_new_chip
def test_how_much_the_dead_steps_may_change_is_a_setting() -> None:
    bench = Bench(backlash_x=20, backlash_z=30)
    bench.set(dead_jump=1, dead_x=21, dead_z=32)
    bench.home()
    assert bench.status().warnings == MachineWarning.DEAD_Z


@pytest.mark.parametrize(
    ("moved", "drifted"), [(0, False), (1, False), (2, True), (3, False), (4, False), (6, True)]
)
@on_a_new_chip
def test_another_coil_phase_at_the_switch_than_before_the_power_cut_is_an_alarm(
    moved: int, drifted: bool
) -> None:
    # Whole turns of the phase, four steps, cannot be told without power; one step is allowed.
    bench = homing_after_a_power_cut(backlash_x=20, start_x=-30 - moved)
    if drifted:
        assert_alarm_and_recovery(bench, Alarm.PHASE_DRIFT, Axis.X)
        bench.home()
    assert bench.homed


@pytest.mark.parametrize("mode", [0, 1, 2])
@on_a_new_chip
def test_no_drift_is_seen_where_there_is_none_in_any_coil_mode(mode: int) -> None:
    bench = Bench(backlash_x=7, backlash_z=12)
    bench.expect_broken("at most one full step at a time", "no step lost")
    bench.set(coil_mode=mode)
    for _ in range(2):
        bench.home()
        bench.home()
        bench.power_cycle()
        bench.connect()


@on_a_new_chip
def test_steps_lost_in_a_run_are_found_by_the_next_homing() -> None:
    bench = little_pin.homed_lathe_with_pin(backlash_x=7, backlash_z=12)
    bench.expect_broken("no step lost", "no crash", "at most one full step at a time")
    bench.set(estop_fitted=0)
    bench.host.run()
    bench.wait(lambda: bench.position[1] <= -99, 5.0)
    bench.wait(lambda: bench.position[1] >= -90, 5.0)
    bench.lathe.machine.set_motor_power(False)  # on the way back from a pass
    bench.run(0.02)
    bench.lathe.machine.set_motor_power(True)
    bench.wait_for(State.IDLE)
    lost = PARK - bench.axis(Axis.Z).slide
    # A rotor without current falls in step again a multiple of four steps behind.
    assert lost in range(8, 32, 4)
    bench.host.home()
    assert_alarm_and_recovery(bench, Alarm.PHASE_DRIFT, Axis.Z)
    bench.home()


@on_a_new_chip
def test_homing_twice_finds_the_same_place() -> None:
    bench = Bench(backlash_x=17, backlash_z=8)
    bench.home()
    bench.home()
    assert (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide) == (PARK, PARK)
    assert (bench.status().dead_x, bench.status().dead_z) == (17, 8)


@on_a_new_chip
def test_a_switch_reached_while_the_main_loop_looks_whether_the_move_is_over_is_found() -> None:
    bench = Bench(backlash_x=10)
    bench.set(dead_max=20)
    bench.host.home()
    bench.wait(lambda: bench.axis(Axis.X).pressed, 10.0, every=1e-3)
    bench.wait(lambda: not bench.axis(Axis.X).pressed, 10.0, every=1e-3)
    bench.wait(lambda: bench.axis(Axis.X).pressed, 10.0, every=1e-3)
    # Now the dead steps are counted; all of the short move is in the stream already.
    bench.run(0.03)
    assert bench.chip.run_to_address(bench.chip.symbols.code("path_busy"))
    bench.abort_stream()
    bench.chip.set_variable("guard_stopped", 1)
    bench.run(0.002)
    assert (bench.state, bench.alarm) == (State.HOMING, (Alarm.NONE, 0))
