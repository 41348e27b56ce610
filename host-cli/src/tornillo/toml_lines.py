# SPDX-License-Identifier: Apache-2.0
"""Which line of a TOML text a table, key or list item stands in: tomllib does not tell."""

import re

Place = tuple[str | int, ...]
_HEADER = re.compile(r"\s*(\[\[?)\s*([\w.-]+)\s*\]")
_KEY = re.compile(r"\s*([\w-]+)\s*[.=]")
_NO_MARKS = re.compile(r'"(?:\\.|[^"\\])*"|\'[^\']*\'|#.*')


class _Items:
    """Counts the items of the list that a key holds, through as many lines as it takes."""

    def __init__(self, places: dict[Place, int]) -> None:
        """Write what is found to `places`."""
        self._places = places
        self._place: Place = ()
        self._index = 0
        self._fresh = False
        self._list = False
        self.depth = 0

    def begin(self, place: Place) -> None:
        """The value of `place` comes next."""
        self._place, self._index, self._fresh, self._list = place, 0, True, False

    def read(self, text: str, line: int) -> None:
        """Go through one line without strings and comments."""
        for mark in text:
            if mark in "]}":
                self.depth -= 1
            elif self.depth == 1 and mark == ",":
                self._index, self._fresh = self._index + 1, True
            elif self.depth == 1 and self._list and self._fresh and not mark.isspace():
                self._places[*self._place, self._index] = line
                self._fresh = False
            if mark in "[{":
                self._list = mark == "[" if self.depth == 0 else self._list
                self.depth += 1


def line_numbers(text: str) -> dict[Place, int]:
    """The line, from 1, of every table, key and list item; tables in a list are items too."""
    places: dict[Place, int] = {}
    items = _Items(places)
    counts: dict[Place, int] = {}
    table: Place = ()
    for number, line in enumerate(text.splitlines(), start=1):
        if items.depth == 0 and (header := _HEADER.match(line)):
            table = tuple(header[2].split("."))
            if header[1] == "[[":
                count = counts.get(table, 0)
                counts[table] = count + 1
                table = (*table, count)
            places[table] = number
            continue
        bare = _NO_MARKS.sub('""', line)
        if items.depth == 0 and (key := _KEY.match(line)):
            places.setdefault((*table, key[1]), number)
            items.begin((*table, key[1]))
            bare = bare.partition("=")[2]
        items.read(bare, number)
    return places
