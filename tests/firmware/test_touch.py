# SPDX-License-Identifier: Apache-2.0
"""Touching the work: where the contact is found, and when touching is refused."""

from __future__ import annotations

from functools import partial
from typing import Any

import pytest
from simulated import little_pin
from simulated.bench import START_S, Bench
from simulated.processes import on_a_new_chip
from tornillo.protocol import Alarm, Axis, ErrorCode, SettingId, State, StatusInput
from tornillo.touching import Touch, TouchError, set_zero, touch
from virtual_lathe.chip import Drive

#: Machine steps at which the tool touches the raw bar and its raw front face.
SURFACE_X = little_pin.ZERO_X + little_pin.RADIUS
SURFACE_Z = little_pin.ZERO_Z + little_pin.FRONT
BESIDE = {"x": -30, "z": -100}
IN_FRONT = {"x": -70, "z": -40}


def lathe_with_sensor(place: dict[str, int] = BESIDE, **options: Any) -> Bench:
    """Return a homed lathe with a contact sensor, the tool near the work."""
    bench = Bench(**(little_pin.OPTIONS | {"probe": True} | options))
    bench.set(zero_x=little_pin.ZERO_X, zero_z=little_pin.ZERO_Z, probe_fitted=1, homing_repeats=1)
    bench.home()
    bench.host.goto(**place)
    bench.wait_for(State.IDLE)
    return bench


def touched(bench: Bench, axis: Axis, steps: int, repeats: int = 3) -> Touch:
    """Touch as a program does."""
    return touch(bench.host, axis, steps, repeats, every=0.0)


@pytest.mark.parametrize(("backlash", "bounce_us"), [(0, 0), (7, 0), (150, 0), (7, 5000)])
@on_a_new_chip
def test_the_surface_of_the_bar_is_found_to_the_step_every_time(
    backlash: int, bounce_us: int
) -> None:
    bench = lathe_with_sensor(backlash_x=backlash, bounce_us=bounce_us)
    found = touched(bench, Axis.X, -40, repeats=5)
    assert found.positions == (SURFACE_X,) * 5
    assert (found.position, found.spread) == (SURFACE_X, 0)
    # Back where it began, and the chip has not lost where that is.
    assert bench.position == (BESIDE["x"], BESIDE["z"])
    assert bench.axis(Axis.X).slide == BESIDE["x"]


@pytest.mark.parametrize("backlash", [0, 12])
@on_a_new_chip
def test_the_front_face_is_found_to_the_step(backlash: int) -> None:
    bench = lathe_with_sensor(IN_FRONT, backlash_z=backlash)
    found = touched(bench, Axis.Z, -40)
    assert found.positions == (SURFACE_Z,) * 3


@on_a_new_chip
def test_the_tool_stops_on_the_step_that_closed_the_contact() -> None:
    bench = lathe_with_sensor(backlash_x=7)
    bench.host.touch(Axis.X, -60)
    assert bench.is_in(State.TOUCHING)
    bench.wait(lambda: bench.chip.level("RA1") == 0, 10.0, every=1e-4)
    bench.wait_for(State.IDLE)
    status = bench.status()
    assert status.inputs == StatusInput.CONTACT | StatusInput.TOUCHED
    assert status.x == bench.axis(Axis.X).slide == SURFACE_X
    assert bench.lathe.workpiece.steps_cutting == 0


@on_a_new_chip
def test_a_turned_diameter_is_found_where_it_was_turned() -> None:
    bench = lathe_with_sensor({"x": -30, "z": -20})
    # Turn it 12 steps smaller over 40 steps, then look for it there.
    bench.set(latch_rate=100)
    bench.host.goto(x=SURFACE_X - 12, rate=100)
    bench.wait_for(State.IDLE)
    bench.host.goto(z=-100, rate=200)
    bench.wait_for(State.IDLE)
    assert bench.status().contact
    bench.host.goto(x=-30)
    bench.wait_for(State.IDLE)
    bench.host.goto(z=-90)
    bench.wait_for(State.IDLE)
    assert touched(bench, Axis.X, -60).positions == (SURFACE_X - 12,) * 3
    # It was the tool that cut, on purpose and slowly.
    assert bench.lathe.workpiece.crashes == []


@on_a_new_chip
def test_part_zero_is_set_from_the_touch_though_the_tool_has_gone_back() -> None:
    bench = lathe_with_sensor()
    bench.set(zero_x=-50, zero_z=-3)
    found = touched(bench, Axis.X, -40)
    set_zero(bench.host, Axis.X, found.position, little_pin.RADIUS)
    assert bench.host.setting(SettingId.ZERO_X).value == little_pin.ZERO_X
    bench.host.goto(x=IN_FRONT["x"] + 60)
    bench.wait_for(State.IDLE)
    bench.host.goto(z=IN_FRONT["z"])
    bench.wait_for(State.IDLE)
    bench.host.goto(x=IN_FRONT["x"])
    bench.wait_for(State.IDLE)
    found = touched(bench, Axis.Z, -40)
    set_zero(bench.host, Axis.Z, found.position, little_pin.FRONT)
    assert bench.host.setting(SettingId.ZERO_Z).value == little_pin.ZERO_Z


@on_a_new_chip
def test_the_speed_of_a_search_is_that_of_the_setting() -> None:
    bench = lathe_with_sensor()
    bench.set(latch_rate=40)
    bench.host.touch(Axis.X, -60)
    bench.run(0.05)
    before = bench.axis(Axis.X).slide
    bench.run(0.1)
    assert before - bench.axis(Axis.X).slide == 4
    bench.wait_for(State.IDLE)


@on_a_new_chip
def test_no_contact_within_the_way_is_told_and_the_tool_is_back() -> None:
    bench = lathe_with_sensor()
    with pytest.raises(TouchError, match="no contact within 6 steps"):
        touched(bench, Axis.X, -6)
    assert bench.position[0] == BESIDE["x"]
    # Contact on the very last step is contact.
    assert touched(bench, Axis.X, SURFACE_X - BESIDE["x"]).positions == (SURFACE_X,) * 3


@on_a_new_chip
def test_interference_on_the_line_of_the_sensor_is_no_contact() -> None:
    bench = lathe_with_sensor({"x": -30, "z": -20})
    bench.host.touch(Axis.X, -60)
    while bench.is_in(State.TOUCHING):
        bench.chip.drive("RA1", Drive.LOW)
        bench.run(0.0005)
        bench.chip.drive_volts("RA1", 5.0, 10e3)
        bench.run(0.0055)
        bench.status()
    assert bench.position[0] == -60
    assert bench.status().inputs == StatusInput(0)


@on_a_new_chip
def test_a_contact_that_does_not_open_again_is_told() -> None:
    bench = lathe_with_sensor()
    bench.lathe.at(bench.lathe.seconds + 0.05, bench.lathe.machine.short_probe)
    with pytest.raises(TouchError, match="the contact stayed closed"):
        touched(bench, Axis.X, -40)
    assert bench.is_in(State.IDLE)


@on_a_new_chip
def test_readings_that_differ_are_refused() -> None:
    bench = lathe_with_sensor()
    short = bench.lathe.machine.short_probe

    def early() -> None:
        short()
        bench.lathe.at(bench.lathe.seconds + 0.006, lambda: short(False))

    bench.lathe.at(bench.lathe.seconds + 0.03, early)
    with pytest.raises(TouchError, match="the readings differ by"):
        touched(bench, Axis.X, -40)


@on_a_new_chip
def test_touching_is_refused_without_sensor_with_closed_contact_and_outside_the_travel() -> None:
    bench = lathe_with_sensor()
    bench.set(probe_fitted=0)
    assert bench.refusal(lambda: bench.host.touch(Axis.X, -40)) is ErrorCode.NOT_FITTED
    bench.set(probe_fitted=1)
    bench.lathe.machine.short_probe()
    bench.run(0.01)
    assert bench.refusal(lambda: bench.host.touch(Axis.X, -40)) is ErrorCode.PROBE_CLOSED
    bench.lathe.machine.short_probe(False)
    bench.run(0.01)
    for end in (1, -3576):
        assert bench.refusal(partial(bench.host.touch, Axis.X, end)) is (ErrorCode.OUT_OF_RANGE)
    assert bench.is_in(State.IDLE)


@on_a_new_chip
def test_touching_needs_a_known_position() -> None:
    bench = Bench(probe=True)
    bench.set(probe_fitted=1)
    assert bench.refusal(lambda: bench.host.touch(Axis.X, -40)) is ErrorCode.NOT_HOMED


@pytest.mark.parametrize("by", ["command", "button"])
@on_a_new_chip
def test_stop_ends_a_search_and_the_position_stays_known(by: str) -> None:
    bench = lathe_with_sensor()
    bench.host.touch(Axis.X, -60)
    bench.run(0.05)
    if by == "command":
        bench.host.stop()
    else:
        bench.press("stop")
    assert (bench.state, bench.homed) == (State.IDLE, True)
    assert bench.position[0] == bench.axis(Axis.X).slide > SURFACE_X
    assert bench.status().inputs == StatusInput(0)


@on_a_new_chip
def test_a_search_ends_when_the_cable_is_pulled() -> None:
    bench = lathe_with_sensor({"x": -30, "z": -20})
    bench.set(latch_rate=20)
    bench.host.touch(Axis.X, -99)
    bench.unplug()
    bench.run(0.45)
    assert bench.is_in(State.TOUCHING)
    bench.run(0.15)
    assert (bench.state, bench.homed) == (State.IDLE, True)


@on_a_new_chip
def test_the_emergency_stop_ends_a_search() -> None:
    bench = lathe_with_sensor()
    bench.expect_broken("no step lost", "coil pattern legal")
    bench.host.touch(Axis.X, -60)
    bench.run(0.05)
    bench.lathe.press("estop")
    bench.wait_for(State.ALARM, 0.1)
    assert bench.alarm == (Alarm.ESTOP, 0)


@pytest.mark.parametrize("fast", [True, False])
@on_a_new_chip
def test_contact_in_a_fast_move_is_an_alarm_and_in_a_slow_one_is_not(fast: bool) -> None:
    bench = lathe_with_sensor()
    bench.expect_broken("no crash")
    bench.host.goto(x=-60, rate=600 if fast else 200)
    bench.wait(lambda: not bench.is_in(State.MOVING), 1.0)
    if fast:
        assert bench.alarm == (Alarm.PROBE_UNEXPECTED, 0)
        # The filter takes 4 ms: at 600 step/s that is 3 steps into the work.
        assert 0 <= SURFACE_X - bench.axis(Axis.X).slide <= 3
        assert not bench.homed
        bench.host.reset()
        # The way out: contact is closed, and does not stop the way back.
        bench.host.jog(Axis.X, 20)
        bench.wait_for(State.IDLE)
        assert bench.axis(Axis.X).slide > SURFACE_X + 15
    else:
        assert (bench.state, bench.position[0]) == (State.IDLE, -60)
        assert bench.status().contact


@on_a_new_chip
def test_an_open_input_without_a_sensor_says_nothing() -> None:
    bench = Bench()
    bench.chip.drive("RA1", Drive.LOW)
    bench.run(START_S)
    assert bench.status().inputs == StatusInput(0)
