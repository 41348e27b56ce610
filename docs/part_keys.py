# SPDX-License-Identifier: Apache-2.0
"""The keys of a part file, asked from the code that reads part files.

A reader is given a table that has every key it asks for, and notes what it asked. What is
noted cannot differ from what is accepted, because every other key is refused.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any, cast

from tornillo import part, tools
from tornillo.contour import Point
from tornillo.cutting import Cut, read_cut, read_overrides
from tornillo.operations import READERS, ROUGHING, Context
from tornillo.profiles import read_points
from tornillo.tools import Tool

USUAL_CUT = Cut(1.0, 0.0, 60.0, 60.0, 0.5)
LEFT_OUT = "left out"
#: What stands behind keys that are only looked for: places, not numbers.
KINDS = {"center": "{ z, diameter }", "via": "{ z, diameter }", "offset": "{ z, diameter }"}
CONTEXT = Context("mm", 10.0, False, (Tool(),), USUAL_CUT)
#: Says words of the table in the language of the page; `str` leaves them in English.
Say = Callable[[str], str]


@dataclass(frozen=True)
class Key:
    """One key: what may stand there, and what is taken when it is left out (None: needed)."""

    name: str
    kind: str
    default: str | None


class Refused(Exception):
    """A reader did not like the values of the note-taker; what it asked is noted all the same."""


class Noting:
    """Has the methods of `tornillo.toml_source.Table` and notes what is asked for."""

    def __init__(self, low: float = 0.0, say: Say = str) -> None:
        """Nothing noted yet; places lie behind z = `low`."""
        self._say = say
        self.title = "noting"
        self.keys: dict[str, Key] = {}
        self.points: list[Noting] = []
        self._optional: set[str] = set()
        self._low = low

    def _note(self, name: str, kind: str, default: object) -> None:
        """Remember a key; one that was looked for first may be left out."""
        shown = None if default is None else str(default)
        if isinstance(default, str):
            shown = f'"{default}"' if default else self._say("none")
        elif isinstance(default, float):
            shown = f"{default:g}"
        if name == "finish_feed":
            shown = "`feed`"
        if name in self._optional and shown is None:
            shown = LEFT_OUT
        self.keys.setdefault(name, Key(name, kind, shown))

    def has(self, name: str) -> bool:
        """It might be there; it is not."""
        self._optional.add(name)
        self.keys.setdefault(name, Key(name, KINDS.get(name) or self._say("number"), LEFT_OUT))
        return False

    def text(self, name: str, choices: tuple[str, ...] = (), default: str | None = None) -> str:
        """A text."""
        self._note(name, _choices(choices, self._say) or self._say("text"), default)
        return default or (choices[0] if choices else "a")

    def number(self, name: str, default: float | None = None) -> float:
        """A number; each z is smaller than the one before."""
        self._note(name, self._say("number"), default)
        self._low -= 1.0
        return self._low if name == "z" else 5.0

    def positive(self, name: str, default: float | None = None) -> float:
        """A number above 0."""
        self._note(name, self._say("number above 0"), default)
        return 5.0

    def within(self, name: str, low: float, high: float, default: float) -> float:
        """A number in a range."""
        kind = self._say("{} to {}").format(f"{low:g}", f"{high:g}")
        self._note(name, kind, default)
        return default

    def whole(self, name: str, low: int, high: int, default: int) -> int:
        """A whole number in a range."""
        self._note(name, self._say("whole number, {} to {}").format(low, high), default)
        return default

    def point(self, name: str) -> Point:
        """A place; each is behind the one before."""
        self._note(name, "{ z, diameter }", None)
        self._low -= 1.0
        return Point(self._low, 5.0)

    def pair(self, name: str) -> tuple[float, float]:
        """Two numbers."""
        self._note(name, self._say("[front, back]"), None)
        return 0.0, -1.0

    def items(self, name: str, least: int) -> "list[Noting]":
        """A list of places."""
        self._note(name, self._say("list of {} points or more").format(least), None)
        return self.points or [Noting(), Noting(-10.0)]

    def refuse(self, _name: str, message: str, _remedy: str) -> None:
        """Stop here."""
        raise Refused(message)

    def finish(self) -> None:
        """Nothing is left over."""


def _choices(choices: tuple[str, ...], say: Say) -> str:
    """Texts of which one may stand there."""
    return f" {say('or')} ".join(f'"{choice}"' for choice in choices)


def asked(read: Callable[[Any], object], say: Say = str) -> list[Key]:
    """The keys that `read` asks a table for."""
    table = Noting(say=say)
    with suppress(Refused):
        read(table)
    return list(table.keys.values())


def _point_keys(say: Say) -> list[Key]:
    """What a point of a profile may have: asked of the one in the middle."""
    first, middle, last = Noting(), Noting(-10.0, say), Noting(-20.0)
    profile = Noting()
    profile.points = [first, middle, last]
    with suppress(Refused):
        read_points(cast(Any, profile))
    return list(middle.keys.values())


def sections(say: Say = str) -> dict[str, list[Key]]:
    """The keys of every table of a part file, by its head."""
    found = {
        "`[part]`": asked(part._read_title, say),
        "`[stock]`": asked(part._read_stock, say),
        "`[cut]`": asked(read_cut, say),
        "`[[tool]]`": asked(lambda table: tools._read_tool(table, 0), say),
    }
    found[say("every `[[operation]]` that cuts")] = [
        Key("tool", say("name of a tool"), say("the first")),
        *(
            Key(key.name, key.kind, say("as in `[cut]`"))
            for key in asked(lambda table: read_overrides(table, USUAL_CUT), say)
        ),
        Key("roughing", _choices(ROUGHING, say), f'"{ROUGHING[0]}"'),
    ]
    for kind, read in READERS.items():
        keys = asked(partial(_read, read), say)
        found[f'`[[operation]]` `type = "{kind}"`'] = keys
    found[say("a point of a profile")] = _point_keys(say)
    return found


def _read(read: Callable[[Any, Context], object], table: Any) -> object:
    """Read one operation."""
    return read(table, CONTEXT)


def table_text(say: Say = str) -> str:
    """All keys as a Markdown table."""
    heads = ("table", "keys that are needed", "keys that may be left out")
    rows = ["| " + " | ".join(say(head) for head in heads) + " |", "|---|---|---|"]
    for head, keys in sections(say).items():
        needed = ", ".join(f"`{key.name}` ({key.kind})" for key in keys if key.default is None)
        others = ", ".join(
            f"`{key.name}` ({key.kind})"
            if key.default == LEFT_OUT
            else f"`{key.name}` ({key.kind}; {say('else')} {key.default})"
            for key in keys
            if key.default is not None
        )
        rows.append(f"| {head} | {needed} | {others} |")
    return "\n".join(rows) + "\n"
