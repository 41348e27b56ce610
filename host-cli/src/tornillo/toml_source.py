# SPDX-License-Identifier: Apache-2.0
"""A TOML text that knows its lines, read key by key with checks that teach.

Every refusal names the line to correct.
"""

import difflib
import math
import re
import tomllib
from collections.abc import Mapping
from typing import NoReturn

from tornillo.contour import Point
from tornillo.errors import PartError
from tornillo.language import _
from tornillo.toml_lines import Place, line_numbers

NUMBER_MAX = 1e6
_AT_LINE = re.compile(r" \(at line (\d+), column \d+\)| \(at end of document\)")


class Source:
    """The text of one part file."""

    def __init__(self, name: str, text: str) -> None:
        """Parse `text`; `name` is what messages call the file.

        Raises PartError when it is not TOML.
        """
        self.name = name
        self.lines = line_numbers(text)
        try:
            self.values = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            found = _AT_LINE.search(str(error))
            line = int(found[1]) if found and found[1] else len(text.splitlines())
            reason = _AT_LINE.sub("", str(error))
            raise PartError(
                _("{name}:{line}: this is not TOML: {reason}").format(
                    name=name, line=line, reason=reason
                ),
                _('look for a missing quote, bracket or "=" in this line or the one before'),
            ) from error

    def refuse(self, place: Place, message: str, remedy: str) -> NoReturn:
        """Raise PartError for the line of `place`, or of the nearest table around it."""
        raise self.error(place, message, remedy)

    def error(self, place: Place, message: str, remedy: str) -> PartError:
        """The PartError for `place`."""
        around = place
        while around and around not in self.lines:
            around = around[:-1]
        return PartError(f"{self.name}:{self.lines.get(around, 1)}: {message}", remedy)


class Table:
    """One table of a part file; every key that is read is known, the others are refused."""

    def __init__(
        self, source: Source, place: Place, values: object, title: str, remedy: str = ""
    ) -> None:
        """Look at `values` found at `place`; `title` names it in messages.

        Raises PartError when it is not a table.
        """
        self.source = source
        self.place = place
        self.title = title
        if not isinstance(values, Mapping):
            self.refuse(
                "",
                _("{title} must be a table").format(title=title),
                remedy or _("write {title} on a line of its own").format(title=title),
            )
        self._values = dict(values)
        self._known: list[str] = []

    def refuse(self, key: str, message: str, remedy: str) -> NoReturn:
        """Raise PartError for the line of `key`, or of the table when `key` is empty."""
        place = (*self.place, key) if key else self.place
        self.source.refuse(place, message, remedy)

    def table(self, key: str) -> "Table":
        """The table `key` inside this one, which must be there."""
        return Table(self.source, (*self.place, key), self._take(key, f"[{key}]"), f"[{key}]")

    def tables(self, key: str, needed: bool = True) -> "list[object]":
        """The array of tables `key`, which must have an entry; empty when it may be missing."""
        if not needed and not self.has(key):
            return []
        found = self._take(key, f"[[{key}]]")
        if not isinstance(found, list) or not found:
            self.refuse(
                key,
                _("{key} must be written as [[{key}]]").format(key=key),
                _("use two square brackets"),
            )
        return list(found)

    def has(self, key: str) -> bool:
        """Whether `key` is there; it is known from now on."""
        self._known.append(key)
        return key in self._values

    def text(self, key: str, choices: tuple[str, ...] = (), default: str | None = None) -> str:
        """The string `key`, one of `choices` when there are any; `default` when it is missing."""
        if default is not None and not self.has(key):
            return default
        value = self._take(key, f'{key} = "{choices[0] if choices else "..."}"')
        if not isinstance(value, str):
            self.refuse(
                key,
                _("{title}: {key} must be a text").format(title=self.title, key=key),
                _('write {key} = "{value}"').format(key=key, value=value),
            )
        if choices:
            self.choice(key, value, choices)
        return value

    def choice(self, key: str, value: str, choices: tuple[str, ...]) -> None:
        """Refuse a `value` of `key` that is none of `choices`, naming the nearest one."""
        if value not in choices:
            remedy = _nearest(value, choices) or _("use one of: {choices}").format(
                choices=", ".join(choices)
            )
            self.refuse(
                key,
                _('{title}: {key} cannot be "{value}"').format(
                    title=self.title, key=key, value=value
                ),
                remedy,
            )

    def number(self, key: str, default: float | None = None) -> float:
        """The finite number `key`, or `default` when it is missing."""
        if default is not None and not self.has(key):
            return default
        return self._number(key, self._take(key, f"{key} = 1.0"))

    def positive(self, key: str, default: float | None = None) -> float:
        """A number above 0 (or equal to its default) and below 1e6."""
        value = self.number(key, default)
        if value != default and not 0 < value < NUMBER_MAX:
            self.refuse(
                key,
                _("{title}: {key} cannot be {value:g}").format(
                    title=self.title, key=key, value=value
                ),
                _("give a number above 0"),
            )
        return value

    def within(self, key: str, low: float, high: float, default: float) -> float:
        """A number from `low` to `high`, or `default` when it is missing."""
        value = self.number(key, default)
        if not low <= value <= high:
            self.refuse(
                key,
                _("{title}: {key} cannot be {value:g}").format(
                    title=self.title, key=key, value=value
                ),
                _("give a number from {low:g} to {high:g}").format(low=low, high=high),
            )
        return value

    def whole(self, key: str, low: int, high: int, default: int) -> int:
        """A whole number from `low` to `high`, or `default` when it is missing."""
        value = self.within(key, low, high, default)
        if value != int(value):
            self.refuse(
                key,
                _("{title}: {key} cannot be {value:g}").format(
                    title=self.title, key=key, value=value
                ),
                _("give a whole number"),
            )
        return int(value)

    def point(self, key: str) -> Point:
        """The place `key = { z = ..., diameter = ... }`, with its radius."""
        inner = Table(
            self.source,
            (*self.place, key),
            self._take(key, _("{key} = {{ z = 0.0, diameter = 10.0 }}").format(key=key)),
            f"{self.title}: {key}",
            _("write {key} = {{ z = 0.0, diameter = 10.0 }}").format(key=key),
        )
        place = Point(inner.number("z"), inner.number("diameter") / 2)
        inner.finish()
        return place

    def items(self, key: str, least: int) -> "list[Table]":
        """The tables in the list `key`, at least `least` of them."""
        value = self._take(key, _("{key} = [{{ z = 0.0, diameter = 10.0 }}]").format(key=key))
        if not isinstance(value, list) or len(value) < least:
            self.refuse(
                key,
                _("{title}: {key} must be a list of at least {least} points").format(
                    title=self.title, key=key, least=least
                ),
                _("write {key} = [{{ z = 0.0, diameter = 10.0 }}, ...]").format(key=key),
            )
        return [
            Table(
                self.source,
                (*self.place, key, number),
                item,
                _("{title}, point {number}").format(title=self.title, number=number + 1),
                _("write it as { z = 0.0, diameter = 10.0 }"),
            )
            for number, item in enumerate(value)
        ]

    def pair(self, key: str) -> tuple[float, float]:
        """The two finite numbers `key = [first, second]`."""
        value = self._take(key, f"{key} = [0.0, -1.0]")
        if not isinstance(value, list) or len(value) != 2:
            self.refuse(
                key,
                _("{title}: {key} must be two numbers, [start, end]").format(
                    title=self.title, key=key
                ),
                _("write for example {key} = [0.0, -1.0]").format(key=key),
            )
        return self._number(key, value[0]), self._number(key, value[1])

    def finish(self) -> None:
        """Refuse the first key that was not read, naming the nearest known one."""
        for key in self._values:
            if key not in self._known:
                remedy = _nearest(key, self._known) or _("known keys: {known}").format(
                    known=", ".join(self._known)
                )
                self.refuse(
                    key, _('{title}: unknown key "{key}"').format(title=self.title, key=key), remedy
                )

    def _take(self, key: str, example: str) -> object:
        """The value of `key`, which must be there."""
        self._known.append(key)
        if key not in self._values:
            for unknown in self._values:
                if _nearest(unknown, [key]):
                    self.refuse(
                        unknown,
                        _('{title}: unknown key "{unknown}"').format(
                            title=self.title, unknown=unknown
                        ),
                        _('did you mean "{key}"?').format(key=key),
                    )
            self.refuse(
                "",
                _("{title}: {key} is missing").format(title=self.title, key=key),
                _("add a line like {example}").format(example=example),
            )
        return self._values[key]

    def _number(self, key: str, value: object) -> float:
        """`value` as a finite number."""
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            self.refuse(
                key,
                _("{title}: {key} must be a number, not {value!r}").format(
                    title=self.title, key=key, value=value
                ),
                _("write it without quotes, with a decimal point"),
            )
        if not math.isfinite(value):
            self.refuse(
                key,
                _("{title}: {key} must be finite").format(title=self.title, key=key),
                _("write an ordinary number"),
            )
        return float(value)


def _nearest(word: str, known: "list[str] | tuple[str, ...]") -> str:
    """A question for the known word nearest to `word`; empty when none is near."""
    begun = [name for name in known if len(word) > 2 and name.startswith(word)]
    close = begun or difflib.get_close_matches(word, known, n=1)
    return _('did you mean "{close}"?').format(close=close[0]) if close else ""
