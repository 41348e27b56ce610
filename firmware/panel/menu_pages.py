# SPDX-License-Identifier: Apache-2.0
"""Write the tables of docs/panel.md and docs/es/panel.md."""

from __future__ import annotations

import re
from dataclasses import dataclass

from menu_model import Entry, Panel


@dataclass(frozen=True)
class Words:
    """What a page in one language says around the texts."""

    language: int
    languages: tuple[str, ...]
    does: str
    leads: str
    changes: str
    alarm: str


#: In the order of menu_model.LANGUAGES.
WORDS = (
    Words(
        0,
        ("English", "Spanish"),
        "what it does",
        "leads to the menu",
        "changes the setting",
        "alarm",
    ),
    Words(1, ("inglés", "español"), "qué hace", "lleva al menú", "cambia el ajuste", "alarma"),
)
MARKED = re.compile(r"(<!-- panel: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)


def table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """A table of Markdown."""
    lines = [head, tuple("---" for _ in head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def _does(panel: Panel, words: Words, entry: Entry) -> str:
    if entry.kind == "menu":
        return f"{words.leads} `{entry.argument}`"
    if entry.kind == "setting":
        return f"{words.changes} `{entry.argument}`"
    return panel.kinds[entry.kind][words.language].partition(";")[0]


def menus(panel: Panel, words: Words) -> str:
    """Every menu with its entries."""
    parts = []
    for name, entries in panel.menus.items():
        rows = [(*entry.text, _does(panel, words, entry)) for entry in entries]
        parts.append(f"**{name}**\n\n" + table((*words.languages, words.does), rows))
    return "\n".join(parts)


def alarms(panel: Panel, words: Words) -> str:
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
    return table((words.alarm, *words.languages), rows)


def fill(panel: Panel, page: str, words: Words) -> str:
    """The page with its tables renewed."""
    tables = {"menus": menus, "alarms": alarms}
    return MARKED.sub(lambda found: f"{found[1]}{tables[found[2]](panel, words)}{found[3]}", page)
