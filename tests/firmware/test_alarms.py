# SPDX-License-Identifier: Apache-2.0
"""Every alarm of protocol.toml: provoked, explained, and over when its cause is gone."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import state_table
from simulated.bench import Bench
from simulated.effects import moves
from simulated.happenings import HAPPENINGS
from simulated.processes import on_a_new_chip
from simulated.situations import SITUATIONS, Walker
from tornillo.protocol import Alarm, Axis, ErrorCode, State
from tornillo.protocol_texts import ALARM_TEXTS
from virtual_lathe.machine import AxisName

PAGE = Path(__file__).parents[2] / "docs" / "alarms.md"
ALARMS = [alarm for alarm in Alarm if alarm is not Alarm.NONE]
#: A change that homing must notice: more than the setting spread_max.
WOBBLE = 6
#: More than dead_max = 20, less than LATE_MARGIN_STEPS of firmware/config.h beyond it.
LATE = 40
LOST = 8
#: Beyond SWITCH_NEAR_STEPS of firmware/config.h.
FAR_FROM_SWITCH = -450


def cells_of(alarm: Alarm) -> list[tuple[str, str]]:
    """Return the cells of the table of states that end in an alarm: situation, event."""
    return [
        (situation, event.name)
        for event in state_table.load().events.values()
        for situation, cell in event.cells.items()
        if cell.alarm == alarm.name
    ]


def _stuck_switch() -> Walker:
    """The switch of X closes while homing and does not open again."""
    walker = SITUATIONS["homing"]()
    bench = walker.bench
    bench.wait(lambda: bench.axis(Axis.X).pressed, 5.0, every=1e-3)
    bench.lathe.machine.break_switch_wire(AxisName.X)
    return walker


def _loose_switch() -> Walker:
    """The switch of X opens later at each of two measurements."""
    walker = SITUATIONS["unhomed"]()
    bench = walker.bench
    bench.set(homing_repeats=2)
    bench.host.home()
    for _ in range(2):  # the fast way, and the first measurement
        bench.wait(lambda: bench.axis(Axis.X).pressed, 9.0, every=1e-3)
        bench.wait(lambda: not bench.axis(Axis.X).pressed, 9.0, every=1e-3)
    bench.lathe.machine.options(AxisName.X).switch_travel = WOBBLE
    bench.lathe.machine.break_switch_wire(AxisName.X, broken=False)
    return walker


def _broken_wire() -> Walker:
    """The switch of X reads as closed far from its end."""
    walker = SITUATIONS["idle"]()
    bench = walker.bench
    bench.host.goto(x=FAR_FROM_SWITCH)
    bench.wait_for(State.IDLE)
    bench.lathe.machine.break_switch_wire(AxisName.X)
    return walker


def _late_switch() -> Walker:
    """The switch of X opens after more steps than dead_max allows."""
    walker = SITUATIONS["unhomed"]()
    bench = walker.bench
    bench.set(dead_max=20)
    bench.lathe.machine.options(AxisName.X).switch_travel = LATE
    bench.lathe.machine.break_switch_wire(AxisName.X, broken=False)
    bench.host.home()
    return walker


def _lost_steps() -> Walker:
    """Z is not where the chip has counted it to be."""
    walker = SITUATIONS["idle"]()
    bench = walker.bench
    bench.chip.set_variable("position_z", (bench.position[1] - LOST) & 0xFFFF, 2)
    bench.host.home()
    return walker


#: Alarms that no cell of the table of states ends in, because they take a fault in mid-homing.
OTHERS: dict[Alarm, Callable[[], Walker]] = {
    Alarm.HOME_NOT_RELEASED: _stuck_switch,
    Alarm.DEAD_STEPS_SPREAD: _loose_switch,
    Alarm.SWITCH_WIRING: _broken_wire,
    Alarm.HOME_OPENED_LATE: _late_switch,
    Alarm.PHASE_DRIFT: _lost_steps,
}


def provoke(alarm: Alarm) -> Bench:
    """Bring a lathe into an alarm."""
    cells = cells_of(alarm)
    if cells:
        situation, event = cells[0]
        walker = SITUATIONS[situation]()
        HAPPENINGS[event](walker)
    else:
        walker = OTHERS[alarm]()
    walker.bench.wait_for(State.ALARM, 20.0)
    return walker.bench


def repair(bench: Bench) -> None:
    """Do what the remedies say."""
    machine = bench.lathe.machine
    for name in AxisName:
        machine.options(name).switch_travel = 0
        machine.break_switch_wire(name, broken=False)
    machine.short_probe(False)
    bench.lathe.press("release")
    bench.run(0.02)


@pytest.mark.parametrize("alarm", ALARMS, ids=lambda alarm: alarm.name)
@on_a_new_chip
def test_an_alarm_stops_everything_until_it_is_acknowledged_and_its_cause_is_gone(
    alarm: Alarm,
) -> None:
    bench = provoke(alarm)
    assert bench.alarm[0] is alarm
    bench.run(0.01)
    assert not moves(bench)
    status = bench.status()
    assert (status.state, status.alarm, status.homed) == (State.ALARM, alarm, False)
    assert ALARM_TEXTS[alarm].cause in str(status.alarm_error())
    assert status.alarm_error().remedy == ALARM_TEXTS[alarm].remedy
    assert bench.refusal(bench.host.home) is ErrorCode.ALARM
    assert bench.refusal(bench.host.run) is ErrorCode.ALARM
    repair(bench)
    assert bench.is_in(State.ALARM)
    bench.host.reset()
    assert bench.refusal(bench.host.run) is ErrorCode.NOT_HOMED
    bench.home()
    assert bench.position == (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide)


def test_every_alarm_has_a_way_to_provoke_it_and_no_way_is_for_nothing() -> None:
    from_table = {alarm for alarm in ALARMS if cells_of(alarm)}
    assert from_table | set(OTHERS) == set(ALARMS)
    assert from_table.isdisjoint(OTHERS)


def test_the_page_tells_cause_and_remedy_of_every_alarm() -> None:
    page = PAGE.read_text(encoding="utf-8")
    rows = [line for line in page.splitlines() if line.startswith("| ") and "`" in line[:8]]
    assert rows == [
        f"| {alarm.value} | `{alarm.name}` | {text.cause} | {text.remedy} |"
        for alarm, text in ((alarm, ALARM_TEXTS[alarm]) for alarm in Alarm)
    ]
    for alarm in ALARMS:
        assert len(ALARM_TEXTS[alarm].cause) > 10
        assert len(ALARM_TEXTS[alarm].remedy) > 10
