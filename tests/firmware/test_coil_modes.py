# SPDX-License-Identifier: Apache-2.0
"""How the motors are driven: coil patterns, step and direction, and when no current flows."""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from typing import Any

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import branch, on_a_new_chip
from simulated.standing import COILS, REST_CYCLES
from tornillo.protocol import Axis, SettingId, State
from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.machine import AxisName
from virtual_lathe.part import Cylinder, Face, Nominal, WantedPart

PINS = {"X": COILS[4:], "Z": COILS[:4]}
SHIFT = {"X": 24, "Z": 8}
TWO_PHASES, WAVE, HALF = [5, 9, 10, 6], [1, 8, 2, 4], [5, 1, 9, 8, 10, 2, 6, 4]
STEP_DIRECTION = 3
CYCLES_PER_US = CYCLES_PER_SECOND // 1_000_000
#: The firmware looks every 4 ms whether something moves, and whether the time is over.
LOOK_MS = 4
#: From the last step to the idle lathe: a rest, and the record of the part in the EEPROM.
ENDING_MS = 40


def patterns(bench: Bench, axis: str) -> list[int]:
    """Return the patterns logged on an axis, each as often as it was written anew."""
    found: list[int] = []
    for _, levels in bench.chip.pin_changes():
        pattern = levels >> SHIFT[axis] & 15
        if not found or found[-1] != pattern:
            found.append(pattern)
    return found


@pytest.mark.parametrize("axis", [Axis.X, Axis.Z])
@pytest.mark.parametrize(("mode", "order"), [(0, TWO_PHASES), (1, WAVE), (2, HALF)])
@pytest.mark.parametrize("inverted", [0, 1])
@on_a_new_chip
def test_the_coils_follow_the_table_forward_and_backward(
    axis: Axis, mode: int, order: list[int], inverted: int
) -> None:
    bench = Bench(start_x=-400) if axis is Axis.X else Bench(start_z=-400)
    bench.set(coil_mode=mode, homing_repeats=1)
    bench.host.set_setting(SettingId.INVERT_X if axis is Axis.X else SettingId.INVERT_Z, inverted)
    forward = branch(partial(patterns_while_homing, bench, axis))
    bench.lathe.machine.break_switch_wire(AxisName(axis))
    bench.run(0.01)
    backward = branch(partial(patterns_while_homing, bench, axis))
    if inverted:
        forward, backward = backward, forward
    assert_follows(forward, order)
    assert_follows(backward, order[::-1])


def patterns_while_homing(bench: Bench, axis: Axis) -> list[int]:
    """Home and return the first patterns on an axis: + until the switch, - if it is pressed."""
    bench.host.home()
    bench.wait(lambda: bench.chip.variable("homing_axis") == axis, 10.0)
    bench.chip.log_pins(*PINS[axis.name])
    bench.run(0.2)
    return patterns(bench, axis.name)


def assert_follows(found: list[int], order: list[int]) -> None:
    """Check that patterns come in a cyclic order, every one of them."""
    assert len(found) > 40
    for before, after in pairwise(found[1:]):
        assert after == order[(order.index(before) + 1) % len(order)]


@on_a_new_chip
def test_a_part_is_cut_exactly_with_one_phase_on_at_a_time() -> None:
    bench = little_pin.lathe_with_pin(backlash_x=7, backlash_z=12)
    bench.set(coil_mode=1)
    bench.home()
    bench.chip.log_pins(*PINS["X"])
    bench.host.run()
    bench.wait_for(State.IDLE)
    assert set(patterns(bench, "X")) == set(WAVE)
    # With one phase on the rotors stand half a step beside the whole ones, where the switch and
    # with it zero are: the same half step everywhere.
    report = bench.lathe.report()
    assert {abs(entry["error_steps"]) for entry in report["dimensions"]} <= {0, 0.5}
    assert (report["lost_steps"], report["crashes"]) == (0, [])
    assert {bench.axis(axis).slide - -20 for axis in Axis} <= {-0.5, 0.5}


#: The little pin in half steps: the chip counts twice as many for everything.
HALF_STEP_OPTIONS: dict[str, Any] = {
    "stock_diameter_mm": little_pin.RADIUS * little_pin.STEP_MM,
    "stock_length_mm": little_pin.LENGTH * little_pin.STEP_MM / 2,
    "stock_allowance_mm": little_pin.FRONT * little_pin.STEP_MM / 2,
    "part_zero_x": little_pin.ZERO_X // 2,
    "part_zero_z": little_pin.ZERO_Z // 2,
}


@on_a_new_chip
def test_a_part_is_cut_exactly_in_half_steps() -> None:
    bench = Bench(backlash_x=7, backlash_z=12, **HALF_STEP_OPTIONS)
    bench.set(zero_x=little_pin.ZERO_X, zero_z=little_pin.ZERO_Z, coil_mode=2)
    bench.lathe.wanted = WantedPart(
        little_pin.RADIUS // 2,
        little_pin.LENGTH // 2,
        little_pin.FRONT // 2,
        (Face(0, 0, Nominal(0.0, 0)), Cylinder(0, -20, 18, Nominal(18, 20))),
    )
    operations = (little_pin.FACE, little_pin.cylinder(0, -40, 36))
    bench.host.upload(little_pin.image("half", operations))
    bench.home()
    status = bench.status()
    assert (status.dead_x, status.dead_z) == (14, 24)
    assert bench.position == (-20, -20)
    assert (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide) == (-10, -10)
    bench.chip.log_pins(*PINS["X"])
    bench.host.run()
    bench.wait_for(State.IDLE)
    assert set(patterns(bench, "X")) == set(HALF)
    assert bench.position == (-20, -20)
    assert (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide) == (-10, -10)
    little_pin.assert_cut_exactly(bench)


# -- step and direction ----------------------------------------------------------------------------


class Driver:
    """A step and direction driver with its motor, at the pins of one axis."""

    def __init__(self, axis: Axis) -> None:
        """Stand at the place where the little pin's slides start."""
        self.place = -30
        self.pulses: list[int] = []
        self.setups: list[int] = []
        self.holds: list[int] = []
        self.disabled = False
        self._shift = SHIFT[axis.name]
        self._levels = 0
        self._direction_since = 0
        self._step_since = 0

    def see(self, cycle: int, levels: int) -> None:
        """Take the levels of step (1), direction (2) and enable (4)."""
        now = levels >> self._shift & 15
        changed = now ^ self._levels
        self._levels = now
        if not now & 4:
            self.disabled = True
        if changed & 2:
            self._direction_since = cycle
            self.holds.append(cycle - self._step_since)
        if changed & 1 and now & 1:
            self.setups.append(cycle - self._direction_since)
            self.place += -1 if now & 2 else 1
            self._step_since = cycle
        elif changed & 1:
            self.pulses.append(cycle - self._step_since)


def drive(bench: Bench, drivers: dict[Axis, Driver], seconds: float) -> None:
    """Let time pass; the drivers move, and the switches follow."""
    bench.run(seconds)
    for cycle, levels in bench.chip.pin_changes():
        for driver in drivers.values():
            driver.see(cycle, levels)
    for axis, driver in drivers.items():
        bench.lathe.machine.break_switch_wire(AxisName(axis), driver.place > 0)


@pytest.mark.parametrize("pulse_us", [5, 6, 20, 60])
@on_a_new_chip
def test_step_and_direction_outputs_keep_their_times_and_count_the_same_steps(
    pulse_us: int,
) -> None:
    bench = little_pin.lathe_with_pin()
    bench.expect_broken("coil pattern legal", "at most one full step at a time", "no step lost")
    # The drivers below stand for the motors.
    bench.lathe.machine.set_motor_power(False)
    bench.set(coil_mode=STEP_DIRECTION, pulse_us=pulse_us, homing_repeats=1, latch_rate=50)
    drivers = {axis: Driver(axis) for axis in Axis}
    bench.chip.log_pins(*COILS)
    bench.host.home()
    while bench.is_in(State.HOMING):
        drive(bench, drivers, 0.0005)
    assert bench.homed
    assert {axis: driver.place for axis, driver in drivers.items()} == {Axis.X: -20, Axis.Z: -20}
    for driver in drivers.values():
        driver.disabled = False
        driver.pulses.clear()
    bench.host.run()
    while bench.is_in(State.RUNNING):
        drive(bench, drivers, 0.0005)
        places = drivers[Axis.X].place, drivers[Axis.Z].place
        # The interrupt counts a step right behind its edge.
        assert all(abs(p - q) <= 1 for p, q in zip(places, bench.position, strict=True))
    drive(bench, drivers, 0.01)
    assert (drivers[Axis.X].place, drivers[Axis.Z].place) == bench.position == (-20, -20)
    for driver in drivers.values():
        assert len(driver.setups) > 250
        assert not driver.disabled
        assert min(driver.setups) >= 5 * CYCLES_PER_US
        assert min(driver.pulses) >= pulse_us * CYCLES_PER_US
        # The last one before a rest, a wait or a stop is ended when the next step is prepared.
        usual = [pulse for pulse in driver.pulses[1:-1] if pulse < REST_CYCLES]
        assert max(usual) <= (pulse_us + 6) * CYCLES_PER_US
        assert len(driver.pulses) - len(usual) <= 10
        # The direction stays for the whole pulse too.
        assert min(driver.holds[1:]) >= 5 * CYCLES_PER_US
    assert bench.chip.port("D") & 4
    assert bench.chip.port("B") & 4


# -- idle ------------------------------------------------------------------------------------------


def current(bench: Bench) -> tuple[bool, bool]:
    """Return whether X and Z have current."""
    return bool(bench.chip.port("D") & 15), bool(bench.chip.port("B") & 15)


@pytest.mark.parametrize("idle_ms", [0, 50, 700])
@on_a_new_chip
def test_the_current_goes_so_long_after_the_last_step_and_the_position_stays(idle_ms: int) -> None:
    bench = little_pin.lathe_with_pin(backlash_x=7, backlash_z=12)
    bench.set(idle_ms=idle_ms)
    bench.home()
    for _ in range(2):
        bench.chip.log_pins(*COILS)
        bench.host.run()
        bench.wait_for(State.IDLE)
        bench.run(idle_ms / 1000 + 0.010)
        assert current(bench) == (False, False)
        changes = [cycle for cycle, _ in bench.chip.pin_changes()]
        # All coils go within 0.1 ms; the step before them was the last one.
        last_step = max(cycle for cycle in changes if cycle < changes[-1] - 100 * CYCLES_PER_US)
        waited = (changes[-1] - last_step) / CYCLES_PER_US / 1000
        assert idle_ms - LOOK_MS <= waited <= max(idle_ms + LOOK_MS, ENDING_MS)
        assert bench.homed
        assert bench.position == (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide) == (-20, -20)
        bench.run(0.3)
    little_pin.assert_cut_exactly(bench)


@on_a_new_chip
def test_the_current_stays_for_ever_when_idle_is_minus_one() -> None:
    bench = little_pin.homed_lathe_with_pin()
    bench.set(idle_ms=-1)
    bench.run(3.0)
    assert current(bench) == (True, True)


@on_a_new_chip
def test_the_current_never_goes_while_the_lathe_homes_cuts_or_holds() -> None:
    bench = little_pin.lathe_with_pin(backlash_x=7, backlash_z=12)
    bench.set(idle_ms=1, home_rate=20, homing_repeats=1)
    bench.host.home()
    bench.run(0.1)
    while bench.is_in(State.HOMING):
        assert current(bench)[bench.chip.variable("homing_axis")]
        bench.run(0.001)
    assert bench.homed
    bench.host.upload(little_pin.image("slow", feed=20 * 8, finish_feed=20 * 8))
    bench.host.run()
    bench.run(0.01)
    bench.chip.log_pins(*COILS)
    for _ in range(4):
        bench.run(0.4)
        bench.host.hold()
        bench.run(0.3)
        assert current(bench) == (True, True)
        bench.host.resume()
    assert bench.is_in(State.RUNNING)
    assert all(levels >> 24 & 15 and levels >> 8 & 15 for _, levels in bench.chip.pin_changes())
    bench.host.stop()
    bench.run(0.01)
    assert current(bench) == (False, False)
    assert bench.homed
    bench.host.run()
    bench.run(0.5)
    assert bench.position == (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide)
