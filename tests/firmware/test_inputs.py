# SPDX-License-Identifier: Apache-2.0
"""Buttons and switches: what counts as pressed, and how often."""

from __future__ import annotations

import random

import pytest
from simulated import little_pin
from simulated.bench import PINS, START_S, Bench
from simulated.processes import on_a_new_chip
from tornillo.protocol import State, StatusFlag
from virtual_lathe.chip import Drive
from virtual_lathe.machine import AxisName

MASKS = {"run": 0x08, "hold": 0x10, "stop": 0x20}
FLAGS = {
    "run": StatusFlag.BUTTON_RUN,
    "hold": StatusFlag.BUTTON_HOLD,
    "stop": StatusFlag.BUTTON_STOP,
}


def pulse(bench: Bench, pin: str, seconds: float) -> None:
    """Connect a pin to ground for some time."""
    bench.chip.drive(pin, Drive.LOW)
    bench.run(seconds)
    bench.chip.drive(pin, Drive.OPEN)


def changes(bench: Bench, mask: int) -> list[bool]:
    """Return the changes of one filtered input since the last ``watch_writes``."""
    levels = [bool(write.value & mask) for write in bench.chip.ram_writes()]
    before = [False, *levels[:-1]]
    return [now for now, then in zip(levels, before, strict=True) if now != then]


def watch_inputs(bench: Bench) -> None:
    """Log the filtered inputs from now on."""
    address = bench.chip.symbols.ram("inputs_state")
    bench.chip.watch_writes(address, address)


@pytest.mark.parametrize("button", PINS)
@on_a_new_chip
def test_pulses_of_up_to_three_milliseconds_never_count(button: str) -> None:
    bench = Bench()
    bench.run(START_S)
    watch_inputs(bench)
    for tenths in range(1, 30):
        pulse(bench, PINS[button], tenths * 1e-4)
        bench.run(0.00537)
    assert changes(bench, MASKS[button]) == []
    assert bench.state is State.IDLE


@pytest.mark.parametrize("button", PINS)
@on_a_new_chip
def test_a_press_that_bounces_for_five_milliseconds_counts_once(button: str) -> None:
    bench = Bench()
    bench.run(START_S)
    watch_inputs(bench)
    bounce = random.Random(5)
    for level in (Drive.LOW, Drive.OPEN) * 5:
        end = bench.chip.seconds + 0.005
        while bench.chip.seconds < end:
            bench.chip.drive(PINS[button], bounce.choice((Drive.LOW, Drive.OPEN)))
            bench.run(bounce.uniform(5e-5, 5e-4))
        bench.chip.drive(PINS[button], level)
        bench.run(0.015)
    assert changes(bench, MASKS[button]) == [True, False] * 5


@on_a_new_chip
def test_a_button_held_down_acts_once() -> None:
    bench = little_pin.lathe_with_pin()
    bench.chip.drive(PINS["run"], Drive.LOW)
    bench.wait_for(State.HOMING, 0.1)
    bench.wait_for(State.IDLE)
    bench.run(0.1)
    assert bench.state is State.IDLE
    assert bench.homed
    bench.chip.drive(PINS["run"], Drive.OPEN)
    bench.run(0.02)
    assert bench.state is State.IDLE
    assert not bench.status().finished


@on_a_new_chip
def test_a_part_is_started_when_the_button_is_let_go() -> None:
    bench = little_pin.homed_lathe_with_pin()
    bench.chip.drive(PINS["run"], Drive.LOW)
    bench.run(0.5)
    assert bench.state is State.IDLE
    bench.chip.drive(PINS["run"], Drive.OPEN)
    bench.wait_for(State.RUNNING, 0.1)
    bench.wait_for(State.IDLE)
    bench.run(0.1)
    assert bench.state is State.IDLE
    assert bench.status().finished


@on_a_new_chip
def test_interference_and_bounce_on_a_button_delay_it_and_no_more() -> None:
    bench = Bench()
    bench.run(START_S)
    watch_inputs(bench)
    noise = random.Random(7)
    for level in (Drive.LOW, Drive.OPEN) * 20:
        bounces_until = bench.chip.seconds + 0.005
        end = bench.chip.seconds + 0.020
        while bench.chip.seconds < end:
            if bench.chip.seconds < bounces_until:
                bench.chip.drive(PINS["hold"], noise.choice((Drive.LOW, Drive.OPEN)))
                bench.run(noise.uniform(5e-5, 5e-4))
            else:
                bench.chip.drive(PINS["hold"], Drive.LOW if level is Drive.OPEN else Drive.OPEN)
                bench.run(noise.uniform(1e-6, 1e-5))
                bench.chip.drive(PINS["hold"], level)
                bench.run(noise.uniform(1e-5, 1.9e-4))
    assert changes(bench, MASKS["hold"]) == [True, False] * 20


@on_a_new_chip
def test_a_button_held_down_while_power_comes_is_no_press() -> None:
    bench = Bench()
    bench.chip.drive(PINS["run"], Drive.LOW)
    bench.run(START_S + 0.1)
    assert bench.is_in(State.IDLE)
    bench.chip.drive(PINS["run"], Drive.OPEN)
    bench.run(0.01)
    bench.press("run")
    assert bench.is_in(State.HOMING)


@on_a_new_chip
def test_status_shows_every_button_and_switch_alone() -> None:
    bench = Bench()
    host = bench.host
    assert host.status().flags == StatusFlag(0)
    for button, flag in FLAGS.items():
        bench.chip.drive(PINS[button], Drive.LOW)
        bench.run(0.005)
        assert host.status().flags & ~StatusFlag.MOTION == flag
        bench.chip.drive(PINS[button], Drive.OPEN)
        bench.run(0.005)
        if bench.state is State.HOMING:
            host.stop()
            host.reset()
    for axis, flag in ((AxisName.X, StatusFlag.SWITCH_X), (AxisName.Z, StatusFlag.SWITCH_Z)):
        bench.lathe.machine.break_switch_wire(axis)
        bench.run(0.005)
        assert host.status().flags == flag
        bench.lathe.machine.break_switch_wire(axis, broken=False)
        bench.run(0.005)
    bench.lathe.press("estop")
    bench.run(0.005)
    assert host.status().flags == StatusFlag.ESTOP
    bench.lathe.press("release")


@on_a_new_chip
def test_an_input_is_seen_three_to_four_milliseconds_after_it_changed() -> None:
    bench = Bench()
    bench.run(START_S)
    for wait in range(20):
        bench.chip.drive(PINS["hold"], Drive.LOW)
        begun = bench.chip.seconds
        bench.wait(lambda: bool(bench.chip.variable("inputs_state") & 0x10), 0.01, every=2e-5)
        assert 0.0029 < bench.chip.seconds - begun < 0.0042
        bench.chip.drive(PINS["hold"], Drive.OPEN)
        bench.run(0.01 + wait * 5.3e-5)
