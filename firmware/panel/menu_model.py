# SPDX-License-Identifier: Apache-2.0
"""The contents of menus.toml, with the short texts of protocol.toml, as typed Python objects."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
MENUS = HERE / "menus.toml"
PROTOCOL = HERE.parent / "link" / "protocol.toml"
COLUMNS = 16
#: At the end of an alarm's text: its axis stands in the last column.
AXIS = " {axis}"
LANGUAGES = ("English", "Spanish")
#: Tables of menus.toml that are no menu.
NO_MENU = ("kind", "text", "state", "letter")

Text = tuple[str, ...]
NONE: Text = ("", "")


@dataclass(frozen=True)
class Entry:
    """One entry of a menu."""

    text: Text
    kind: str
    argument: str | int  # menu, setting, or the number `with`
    last: bool


@dataclass(frozen=True)
class Panel:
    """Menus and texts of the panel; `raw` is protocol.toml."""

    raw: dict[str, Any]
    kinds: dict[str, Text]
    menus: dict[str, list[Entry]]
    texts: dict[str, Text]
    states: dict[str, Text]
    letters: dict[str, list[str]]

    def entries(self) -> list[Entry]:
        """All entries in the order of their numbers."""
        return [entry for menu in self.menus.values() for entry in menu]

    def first(self, menu: str) -> int:
        """Number of a menu's first entry."""
        names = list(self.menus)
        return sum(len(self.menus[name]) for name in names[: names.index(menu)])

    def numbered(self, table: str) -> list[Text]:
        """Texts of a table of protocol.toml by the number of the thing, none where it has none."""
        rows = {
            row["value"]: tuple(text.removesuffix(AXIS) for text in row.get("panel", NONE))
            for row in self.raw[table].values()
        }
        return [rows.get(number, NONE) for number in range(max(rows) + 1)]

    def by_state(self) -> list[Text]:
        """Texts of the states by their number."""
        return [self.states.get(name, NONE) for name in self.raw["state"]]

    def ways(self) -> list[Text]:
        """Ways out of an alarm, in their order."""
        return [tuple(text) for text in self.raw["panel_way"].values()]

    def with_axis(self) -> set[int]:
        """Numbers of the alarms that show their axis."""
        rows = self.raw["alarm"].values()
        return {row["value"] for row in rows if row.get("panel", NONE)[0].endswith(AXIS)}

    def way_numbers(self) -> list[int]:
        """Which way leads out of each alarm, 0 for numbers that are none."""
        names = list(self.raw["panel_way"])
        rows = {
            row["value"]: names.index(row["panel_way"])
            for row in self.raw["alarm"].values()
            if "panel_way" in row
        }
        return [rows.get(number, 0) for number in range(max(rows) + 1)]

    def all_texts(self) -> dict[str, list[Text]]:
        """Every text in the order of its number, by group."""
        return {
            "ENTRY": [entry.text for entry in self.entries()],
            "STATE": self.by_state(),
            "ALARM": self.numbered("alarm"),
            "WAY": self.ways(),
            "ERROR": self.numbered("error"),
        } | {name.upper(): [text] for name, text in self.texts.items()}


def load(menus: Path = MENUS, protocol: Path = PROTOCOL) -> Panel:
    """Read both files.

    Raises ValueError when a text does not fit the display or cannot be shown, or an entry leads
    to nothing that is there.
    """
    data = tomllib.loads(menus.read_text(encoding="utf-8"))
    raw = tomllib.loads(protocol.read_text(encoding="utf-8"))
    names = [name for name in data if name not in NO_MENU]
    panel = Panel(
        raw,
        {name: tuple(text) for name, text in data["kind"].items()},
        {name: _menu(data[name]) for name in names},
        {name: tuple(text) for name, text in data["text"].items()},
        {name: tuple(text) for name, text in data["state"].items()},
        data["letter"],
    )
    _judge(panel)
    return panel


def _menu(rows: list[dict[str, Any]]) -> list[Entry]:
    entries = []
    for number, row in enumerate(rows):
        kind = row.get("does") or ("menu" if "menu" in row else "setting")
        argument = row.get("menu", row.get("setting", row.get("with", 0)))
        entries.append(Entry(tuple(row["text"]), kind, argument, number == len(rows) - 1))
    return entries


def _judge(panel: Panel) -> None:
    for kind, said in panel.kinds.items():
        if len(said) != len(LANGUAGES):
            raise ValueError(f"kind {kind}: not one text for each of {LANGUAGES}")
    for menu, entries in panel.menus.items():
        for entry in entries:
            _judge_entry(panel, menu, entry)
    for number in panel.with_axis():
        for shown in panel.numbered("alarm")[number]:
            if len(shown) > COLUMNS - 2:
                raise ValueError(f"alarm {number}: {shown!r} leaves no room for the axis")
    for group, texts in panel.all_texts().items():
        for text in texts:
            _judge_text(panel, group, text)


def _judge_entry(panel: Panel, menu: str, entry: Entry) -> None:
    main, *submenus = panel.menus
    if entry.kind not in panel.kinds:
        raise ValueError(f"{entry.text[0]}: no such kind: {entry.kind}")
    if entry.kind == "menu" and (menu != main or entry.argument not in submenus):
        raise ValueError(f"{entry.text[0]}: leads to no submenu: {entry.argument}")
    if entry.kind == "setting" and entry.argument not in panel.raw["setting"]:
        raise ValueError(f"{entry.text[0]}: no such setting: {entry.argument}")


def _judge_text(panel: Panel, group: str, text: Text) -> None:
    if len(text) != len(LANGUAGES):
        raise ValueError(f"{text}: not one text for each of {LANGUAGES}")
    for shown in text:
        if len(shown) > COLUMNS:
            raise ValueError(f"{group}: {shown!r} has more than {COLUMNS} characters")
        if shown[:1].islower():
            raise ValueError(f"{group}: {shown!r} does not begin with a capital letter")
        for letter in shown:
            if letter not in panel.letters and not " " <= letter <= "}":
                raise ValueError(f"{group}: {shown!r}: the display has no {letter!r}")
