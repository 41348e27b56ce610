# SPDX-License-Identifier: Apache-2.0
"""The table of states and events, firmware/lathe/states.toml, read and checked."""

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1] / "firmware" / "lathe" / "states.toml"
KINDS = ("command", "button", "input", "inside")
NOTHING = "-"
_CELL = re.compile(r"(-|[a-z_]+|[A-Z_]+)(?: -> (?:alarm ([A-Z_]+)|([a-z_]+)))?")


@dataclass(frozen=True)
class Situation:
    """A column: a state of the protocol and what else decides what happens."""

    name: str
    state: str
    meaning: str


@dataclass(frozen=True)
class Cell:
    """What an event does in a situation.

    `action`: "-" or a key of the actions; empty when it is refused with the error `refused`.
    `then`: the situation that follows, or empty: the same, or the alarm `alarm`.
    """

    action: str
    refused: str = ""
    then: str = ""
    alarm: str = ""

    @classmethod
    def parse(cls, text: str) -> "Cell":
        """Read a cell; raises ValueError when it is none."""
        found = _CELL.fullmatch(text)
        if found is None or (found[1].isupper() and found[1] != text):
            raise ValueError(f'"{text}" is no cell')
        if found[1].isupper():
            return cls("", refused=text)
        return cls(found[1], then=found[3] or "", alarm=found[2] or "")


@dataclass(frozen=True)
class Event:
    """A row: one cell for each situation, in their order."""

    name: str
    kind: str
    meaning: str
    cells: dict[str, Cell]


@dataclass(frozen=True)
class StateTable:
    """The whole table."""

    situations: dict[str, Situation]
    actions: dict[str, str]
    events: dict[str, Event]


def load(path: Path = SOURCE) -> StateTable:
    """Read the table.

    Raises ValueError when a cell is missing, one too many, or names something that is not there.
    """
    raw = tomllib.loads(path.read_text(encoding="utf-8"))
    situations = {
        name: Situation(name, row["state"], row["meaning"])
        for name, row in raw["situation"].items()
    }
    actions: dict[str, str] = raw["action"]
    events = {}
    for name, row in raw["event"].items():
        if row["kind"] not in KINDS or set(row["cells"]) != set(situations):
            raise ValueError(f"event {name}: wrong kind, or not one cell for each situation")
        cells = {one: Cell.parse(row["cells"][one]) for one in situations}
        for one, cell in cells.items():
            known = cell.action in {*actions, NOTHING, ""} and cell.then in {*situations, ""}
            if not known:
                raise ValueError(f"event {name}, {one}: unknown action or situation")
        events[name] = Event(name, row["kind"], row["meaning"], cells)
    used = {cell.action for event in events.values() for cell in event.cells.values()}
    unused = set(actions) - used
    if unused:
        raise ValueError(f"no cell has the action {', '.join(sorted(unused))}")
    return StateTable(situations, actions, events)
