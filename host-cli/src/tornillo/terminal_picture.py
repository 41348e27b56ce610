# SPDX-License-Identifier: Apache-2.0
"""A part in the characters of a terminal: stock, finished part, tool; the chuck is on the left.

Each character is a cell of 2 x 4 dots. The finished part is solid, what will be cut away is a
grid of single dots, so that it also reads without colours.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import groupby
from operator import itemgetter
from typing import TYPE_CHECKING

from tornillo.contour import Element, Point
from tornillo.outline import outline
from tornillo.part import Part

if TYPE_CHECKING:
    from rich.text import Text

#: The dots of a braille character: bit of each (column, row).
BITS = ((0x01, 0x02, 0x04, 0x40), (0x08, 0x10, 0x20, 0x80))
BRAILLE = 0x2800
#: What stands for a cell where braille cannot be shown: solid, to be cut, chuck.
PLAIN = {"part": "#", "stock": ".", "chuck": "%", "tool": "V", "mark": "+", "": " "}
STYLES = {
    "part": "bold cyan",
    "stock": "yellow",
    "chuck": "dim",
    "tool": "bold red",
    "mark": "bold green",
    "": "",
}
#: Cells for the jaws, left of the stock; and free room on the other sides.
JAWS = 2
#: Of the things in a cell the first one gives it its colour.
ORDER = ("part", "stock", "chuck")


@dataclass
class Cell:
    """One character: its dots, and what is in it."""

    dots: int = 0
    kinds: set[str] = field(default_factory=set)

    @property
    def kind(self) -> str:
        """What gives the cell its colour."""
        return next((kind for kind in ORDER if kind in self.kinds), "")

    def character(self, braille: bool) -> str:
        """What is printed."""
        if not braille:
            return PLAIN[self.kind]
        return chr(BRAILLE + self.dots) if self.dots else " "


class Picture:
    """A part on `columns` x `rows` characters.

    Places are in file units (z, radius); one whose radius is NaN is a line across.
    """

    def __init__(self, part: Part, columns: int, rows: int) -> None:
        """Draw stock, chuck and what all operations leave."""
        self.columns, self.rows = columns, rows
        self.part = part
        stock = part.stock
        self._front = stock.allowance + stock.length * 0.05
        self._length = self._front + stock.length
        wide = 2 * (columns - JAWS) / self._length
        high = 4 * (rows - 2) / stock.diameter
        #: Dots for each unit of the file.
        self.scale = min(wide, high)
        self.cells = [[Cell() for _ in range(columns)] for _ in range(rows)]
        self._pieces = outline(part)
        self._places: dict[tuple[int, int], str] = {}
        self._fill()

    def _z(self, dot: int) -> float:
        """The z of a column of dots."""
        return (dot + 0.5) / self.scale - self.part.stock.length - 2 * JAWS / self.scale

    def _radius(self, dot: int) -> float:
        """The distance of a row of dots from the axis."""
        return abs(dot + 0.5 - 2 * self.rows) / self.scale

    def _fill(self) -> None:
        """Ask for each dot what is there."""
        half = self.part.stock.diameter / 2
        for x in range(2 * self.columns):
            z = self._z(x)
            chuck = z < -self.part.stock.length
            left = height(self._pieces, z)
            for y in range(4 * self.rows):
                r = self._radius(y)
                if chuck:
                    if r <= half * 1.25:
                        self._dot(x, y, "chuck", (x + y) % 2 == 0)
                elif left is not None and r <= left:
                    self._dot(x, y, "part", True)
                elif z <= self.part.stock.allowance and r <= half:
                    self._dot(x, y, "stock", x % 2 == 0 and y % 4 == 1)

    def _dot(self, x: int, y: int, kind: str, seen: bool) -> None:
        """Note what is at a dot, and show the dot."""
        cell = self.cells[y // 4][x // 2]
        cell.kinds.add(kind)
        if seen:
            cell.dots |= BITS[x % 2][y % 4]

    def show(self, place: Point, kind: str) -> None:
        """Put a character at a place: "tool" or "mark"; outside of the picture, at its edge."""
        stock = self.part.stock
        x = (place.z + stock.length) * self.scale + 2 * JAWS
        column = min(max(int(x) // 2, 0), self.columns - 1)
        if math.isnan(place.x):
            self._places |= {(row, column): kind for row in range(self.rows)}
            return
        y = 2 * self.rows - place.x * self.scale
        row = min(max(int(y) // 4, 0), self.rows - 1)
        self._places[row, column] = kind

    def clear(self) -> None:
        """Take all characters of `show` away."""
        self._places.clear()

    def _rows(self, braille: bool) -> Iterator[list[tuple[str, str]]]:
        """Every row as characters with their kinds."""
        for row, cells in enumerate(self.cells):
            shown: list[tuple[str, str]] = []
            for column, cell in enumerate(cells):
                kind = self._places.get((row, column))
                shown.append(
                    (cell.character(braille), cell.kind) if kind is None else (PLAIN[kind], kind)
                )
            yield shown

    def lines(self, braille: bool = True) -> list[str]:
        """The picture as lines without colours."""
        return ["".join(character for character, _kind in row) for row in self._rows(braille)]

    def text(self, braille: bool = True) -> "Text":
        """The picture in colours."""
        from rich.text import Text

        text = Text(no_wrap=True, overflow="crop")
        for number, row in enumerate(self._rows(braille)):
            if number:
                text.append("\n")
            for kind, cells in groupby(row, key=itemgetter(1)):
                text.append("".join(character for character, _kind in cells), STYLES[kind])
        return text


def height(pieces: tuple[Element, ...], z: float) -> float | None:
    """The radius of an outline at `z`; None where nothing is left."""
    found = [element.height(z) for element in pieces if element.end.z <= z <= element.start.z]
    known = [value for value in found if value is not None]
    return min(known) if known else None


def shows_braille(encoding: str | None) -> bool:
    """Whether a terminal with this encoding has the characters."""
    try:
        chr(BRAILLE).encode(encoding or "ascii")
    except (LookupError, UnicodeEncodeError):
        return False
    return True
