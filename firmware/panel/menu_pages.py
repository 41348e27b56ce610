# SPDX-License-Identifier: Apache-2.0
"""Write the tables of docs/panel.md."""

from __future__ import annotations

import re

from menu_model import LANGUAGES, Entry, Panel

MARKED = re.compile(r"(<!-- panel: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)


def table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """A table of Markdown."""
    lines = [head, tuple("---" for _ in head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def _does(panel: Panel, entry: Entry) -> str:
    if entry.kind == "menu":
        return f"leads to the menu `{entry.argument}`"
    if entry.kind == "setting":
        return f"changes the setting `{entry.argument}`"
    return panel.kinds[entry.kind].partition(";")[0]


def menus(panel: Panel) -> str:
    """Every menu with its entries."""
    parts = []
    for name, entries in panel.menus.items():
        rows = [(*entry.text, _does(panel, entry)) for entry in entries]
        parts.append(f"**{name}**\n\n" + table((*LANGUAGES, "what it does"), rows))
    return "\n".join(parts)


def alarms(panel: Panel) -> str:
    """Every alarm with its two lines."""
    ways = panel.raw["panel_way"]
    rows = [
        (
            str(row["value"]),
            *(
                f"{text.format(axis='X')} / {way}"
                for text, way in zip(row["panel"], ways[row["panel_way"]], strict=True)
            ),
        )
        for row in panel.raw["alarm"].values()
        if "panel" in row
    ]
    return table(("alarm", *LANGUAGES), rows)


def fill(panel: Panel, page: str) -> str:
    """The page with its tables renewed."""
    tables = {"menus": menus, "alarms": alarms}
    return MARKED.sub(lambda found: f"{found[1]}{tables[found[2]](panel)}{found[3]}", page)
