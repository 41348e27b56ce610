# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/states.md."""

from protocol_pages import table
from state_table import KINDS, Cell, Event, StateTable


def cell_text(cell: Cell) -> str:
    """A cell as a reader wants it."""
    if cell.refused:
        return f"`{cell.refused}`"
    text = cell.action.replace("_", " ")
    if cell.alarm:
        return f"{text} → **{cell.alarm}**"
    return f"{text} → **{cell.then}**" if cell.then else text


def event_text(event: Event) -> str:
    """The first column: the event's name as it is written elsewhere, and what it is."""
    if event.kind == "command":
        return f"`{event.name.upper()}`: {event.meaning}"
    return event.meaning


def state_tables(found: StateTable) -> dict[str, str]:
    """Every table of the page by the name of its marker."""
    head = ("event", *found.situations)
    tables = {
        f"states_{kind}": table(
            head,
            [
                (event_text(event), *(cell_text(cell) for cell in event.cells.values()))
                for event in found.events.values()
                if event.kind == kind
            ],
        )
        for kind in KINDS
    }
    tables["states_situations"] = table(
        ("column", "state", "the machine"),
        [(f"**{s.name}**", s.state.upper(), s.meaning) for s in found.situations.values()],
    )
    tables["states_actions"] = table(
        ("action", "what it does"),
        [(name.replace("_", " "), meaning) for name, meaning in found.actions.items()],
    )
    return tables
