# SPDX-License-Identifier: Apache-2.0
"""The table of states and events, firmware/lathe/states.toml, cell by cell."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

import pytest
import state_table
from simulated import little_pin
from simulated.bench import Bench
from simulated.effects import EFFECTS, Seen, moves
from simulated.happenings import HAPPENINGS, answer_of
from simulated.processes import branch, on_a_new_chip
from simulated.situations import HOMED, MOVING, SITUATIONS, Walker
from tornillo.link import Link
from tornillo.protocol import Alarm, Axis, Command, ErrorCode, State

TABLE = state_table.load()
BUSY, IDLE = ErrorCode.BUSY, State.IDLE


class Outcome(NamedTuple):
    """What came of an event: answer, state, alarm, whether the position is trusted."""

    answer: ErrorCode
    state: State
    alarm: Alarm
    homed: bool


def expected(situation: str, event: str, before: Outcome) -> Outcome:
    """Return what a cell promises."""
    cell = TABLE.events[event].cells[situation]
    if cell.alarm:
        return Outcome(ErrorCode.OK, State.ALARM, Alarm[cell.alarm], False)
    if cell.then:
        state = State[TABLE.situations[cell.then].state.upper()]
        return Outcome(ErrorCode.OK, state, Alarm.NONE, cell.then in HOMED)
    answer = ErrorCode[cell.refused] if cell.refused else ErrorCode.OK
    return before._replace(answer=answer)


def walk(walker: Walker, situation: str, event: str, moved: bool) -> str:
    """Let an event happen; return what is wrong, empty when the cell is right."""
    bench = walker.bench
    cell = TABLE.events[event].cells[situation]
    before = Seen.now(bench)
    there = Outcome(ErrorCode.OK, bench.state, bench.alarm[0], bench.homed)
    answer = answer_of(HAPPENINGS[event], walker)
    bench.run(0.01)
    found = Outcome(answer, bench.state, bench.alarm[0], bench.homed)
    wanted = expected(situation, event, there)
    if found != wanted:
        return f"{found}, not {wanted}"
    try:
        EFFECTS[cell.action](walker, before, moved)
    except AssertionError:
        return f"not what {cell.action or cell.refused!r} means: {traceback.format_exc()}"
    return ""


@pytest.mark.parametrize("situation", TABLE.situations)
@on_a_new_chip
def test_every_event_does_what_its_cell_says(situation: str) -> None:
    walker = SITUATIONS[situation]()
    bench = walker.bench
    assert bench.state is State[TABLE.situations[situation].state.upper()]
    assert bench.homed == (situation in HOMED)
    moved = branch(partial(moves, bench))
    assert moved == (situation in MOVING)
    found = {
        event: branch(partial(walk, walker, situation, event, moved)) for event in TABLE.events
    }
    wrong = [f"{event}: {text}" for event, text in found.items() if text]
    assert not wrong, "\n".join(wrong)


def test_the_table_has_every_command_and_every_state_and_nothing_else() -> None:
    commands = {name for name, event in TABLE.events.items() if event.kind == "command"}
    assert commands == {command.name.lower() for command in Command}
    states = {situation.state for situation in TABLE.situations.values()}
    assert states == {state.name.lower() for state in State}
    for event in TABLE.events.values():
        for cell in event.cells.values():
            assert not cell.refused or cell.refused in ErrorCode.__members__
            assert not cell.alarm or cell.alarm in Alarm.__members__


def test_every_row_column_and_action_of_the_table_can_be_walked() -> None:
    assert set(TABLE.events) == set(HAPPENINGS)
    assert set(TABLE.situations) == set(SITUATIONS)
    used = {cell.action for event in TABLE.events.values() for cell in event.cells.values()}
    assert used == set(EFFECTS)


@pytest.mark.parametrize(
    ("text", "cell"),
    [
        ("-", state_table.Cell("-")),
        ("BUSY", state_table.Cell("", refused="BUSY")),
        ("seek -> homing", state_table.Cell("seek", then="homing")),
        ("freeze -> alarm LIMIT", state_table.Cell("freeze", alarm="LIMIT")),
    ],
)
def test_a_cell_of_the_table_is_read(text: str, cell: state_table.Cell) -> None:
    assert state_table.Cell.parse(text) == cell


@pytest.mark.parametrize("text", ["", "Busy", "BUSY -> idle", "seek ->", "seek -> ALARM", "a b"])
def test_what_is_no_cell_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="is no cell"):
        state_table.Cell.parse(text)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('idle = "seek -> homing", ', ""),
        ('idle = "seek -> homing"', 'idle = "seek -> humming"'),
        ('idle = "seek -> homing"', 'idle = "leap -> homing"'),
        ('kind = "input"', 'kind = "inputs"'),
        ("[action]", '[action]\nunused = "by nobody"'),
    ],
)
def test_a_table_with_a_hole_or_an_unknown_name_is_refused(
    tmp_path: Path, old: str, new: str
) -> None:
    text = state_table.SOURCE.read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "states.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ValueError, match=r"event home|event limit_x|no cell has"):
        state_table.load(path)


@on_a_new_chip
def test_homing_ends_idle_and_homed_and_a_finished_part_ends_idle() -> None:
    bench = little_pin.homed_lathe_with_pin()
    assert (bench.state, bench.homed) == (IDLE, True)
    bench.host.run()
    bench.wait_for(IDLE)
    assert bench.status().finished
    assert bench.homed


@on_a_new_chip
def test_running_without_a_part_is_refused() -> None:
    bench = Bench()
    bench.home()
    assert bench.refusal(bench.host.run) is ErrorCode.NO_PART
    assert bench.refusal(lambda: bench.host.run(3)) is ErrorCode.NO_PART
    assert bench.refusal(lambda: bench.host.run(200)) is ErrorCode.NO_PART
    assert bench.state is IDLE


@on_a_new_chip
def test_a_part_that_has_changed_in_flash_is_not_cut() -> None:
    bench = little_pin.homed_lathe_with_pin()
    memory = bench.chip.save()
    flash = bytearray(memory.flash)
    flash[flash.index(little_pin.image()) + 30] ^= 4
    bench.chip.restore(type(memory)(bytes(flash), memory.eeprom))
    assert bench.refusal(bench.host.run) is ErrorCode.CRC_MISMATCH
    assert bench.state is IDLE


@on_a_new_chip
def test_a_part_that_no_longer_fits_the_settings_is_not_cut() -> None:
    bench = little_pin.homed_lathe_with_pin()
    bench.set(zero_x=-(little_pin.RADIUS + 4))
    assert bench.refusal(bench.host.run) is ErrorCode.INVALID_PART
    assert bench.state is IDLE


@on_a_new_chip
def test_nothing_is_stored_while_the_machine_moves() -> None:
    bench = little_pin.homed_lathe_with_pin()
    host = bench.host
    host.run()
    bench.run(0.1)
    before = bench.chip.nonvolatile_counts
    link = Link(bench.lathe.port)
    image = little_pin.image("other")
    attempts: list[Callable[[], object]] = [
        lambda: host.upload(image),
        lambda: link.request(Command.UPLOAD_COMMIT),
        lambda: host.delete(0),
        lambda: host.select(0),
        lambda: bench.set(rapid_rate_x=500),
        lambda: host.zero(Axis.X, 0),
    ]
    assert [bench.refusal(attempt) for attempt in attempts] == [BUSY] * len(attempts)
    host.hold()
    assert [bench.refusal(attempt) for attempt in attempts] == [BUSY] * len(attempts)
    assert bench.chip.nonvolatile_counts == before
