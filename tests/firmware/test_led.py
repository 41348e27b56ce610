# SPDX-License-Identifier: Apache-2.0
"""The codes of the status LED, as firmware/panel/led.h lists them."""

from __future__ import annotations

from itertools import pairwise

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import on_a_new_chip
from tornillo.protocol import Alarm, State
from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.machine import AxisName

LED = "RC0"
LED_BIT = 1 << 16


def phases(bench: Bench, seconds: float) -> list[tuple[bool, float]]:
    """Watch the LED; return whole phases as (lit, length in ms), the first and last left out."""
    bench.chip.log_pins(LED)
    bench.run(seconds)
    changes = bench.chip.pin_changes()
    return [
        (bool(levels & LED_BIT), (after - cycle) / CYCLES_PER_SECOND * 1000)
        for (cycle, levels), (after, _) in pairwise(changes)
    ]


def homed_lathe_after_the_start_light() -> Bench:
    """Return a homed lathe more than two seconds after its start."""
    bench = little_pin.homed_lathe_with_pin()
    bench.wait(lambda: bench.chip.seconds > 2.1, 3.0)
    return bench


def about(milliseconds: float) -> object:
    """Compare with a length in ms; the codes are counted in units of 64 and 128 ms."""
    return pytest.approx(milliseconds, rel=0.3)


@on_a_new_chip
def test_after_a_reset_the_led_is_lit_for_two_seconds_and_then_blinks_slowly() -> None:
    bench = Bench()
    bench.wait(lambda: bench.chip.level(LED) == 1, 0.1)
    bench.chip.log_pins(LED)
    bench.run(5.0)
    (first, _), *_ = changes = bench.chip.pin_changes()
    assert first / CYCLES_PER_SECOND == pytest.approx(2.05, abs=0.1)
    lengths = [(b[0] - a[0]) / CYCLES_PER_SECOND for a, b in pairwise(changes)]
    assert lengths[1:] == [pytest.approx(0.512, abs=0.01)] * len(lengths[1:])
    assert len(lengths) >= 4


@on_a_new_chip
def test_it_is_lit_when_homed_and_nearly_always_while_moving() -> None:
    bench = homed_lathe_after_the_start_light()
    assert phases(bench, 1.0) == []
    assert bench.chip.level(LED) == 1
    bench.host.run()
    moving = phases(bench, 1.3)
    assert bench.is_in(State.RUNNING)
    lit = [length for on, length in moving if on]
    dark = [length for on, length in moving if not on]
    assert lit == [about(448)] * len(lit)
    # It may begin to move in the middle of a dark time.
    assert dark[1:] == [about(64)] * len(dark[1:])
    assert lit
    assert dark[1:]


@on_a_new_chip
def test_it_blinks_fast_in_hold() -> None:
    bench = homed_lathe_after_the_start_light()
    bench.host.run()
    bench.run(0.2)
    bench.host.hold()
    held = phases(bench, 1.3)
    assert [length for _, length in held] == [pytest.approx(128, abs=2)] * len(held)
    assert len(held) >= 7


def raise_alarm(bench: Bench, alarm: Alarm) -> None:
    """Bring the machine into an alarm."""
    if alarm is Alarm.LIMIT:
        bench.home()
        bench.lathe.machine.break_switch_wire(AxisName.X)
    elif alarm is Alarm.ESTOP:
        bench.lathe.press("estop")
    elif alarm is Alarm.STOPPED_HOMING:
        bench.host.home()
        bench.host.stop()
    bench.wait_for(State.ALARM)
    assert bench.alarm[0] is alarm


@pytest.mark.parametrize("alarm", [Alarm.LIMIT, Alarm.ESTOP, Alarm.STOPPED_HOMING])
@on_a_new_chip
def test_an_alarm_flashes_its_number_and_pauses(alarm: Alarm) -> None:
    bench = Bench()
    raise_alarm(bench, alarm)
    bench.wait(lambda: bench.chip.seconds > 2.1, 3.0)
    seen = phases(bench, 2 * (alarm + 6) * 0.256 + 1.8)
    flashes = [on for on, _ in seen]
    pauses = [number for number, (on, length) in enumerate(seen) if not on and length > 500]
    assert len(pauses) >= 2
    assert flashes[pauses[0] + 1 : pauses[1]].count(True) == alarm
    assert seen[pauses[0]][1] == pytest.approx(1500, abs=200)
