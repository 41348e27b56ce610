# SPDX-License-Identifier: Apache-2.0
"""Where the lengths of a part land on the sheet."""

import math
from collections.abc import Iterable

from tornillo.contour import Arc, Element
from tornillo.contour import Point as Place
from tornillo.part import Part
from tornillo.scene import Point
from tornillo.units import NM_PER_UNIT

SCALES = (20.0, 10.0, 5.0, 4.0, 3.0, 2.5, 2.0, 1.5, 1.0, 0.5, 0.25, 0.2, 0.1, 0.05)
CHUCK_LENGTH, JAW_HEIGHT = 20.0, 11.0
#: Room above the stock for the tool and the widths of grooves, mm on the sheet.
ABOVE = 13.0
#: Longest piece of a polygon that stands for an arc, mm on the sheet.
CHORD = 0.4


class View:
    """Maps file units to the sheet; z to the right, x up."""

    def __init__(
        self, part: Part, area: tuple[Point, Point], room_right: float, room_below: float
    ) -> None:
        """Choose the largest usual scale at which stock and dimensions fit into `area`."""
        stock = part.stock
        self.mm = NM_PER_UNIT[part.units] / NM_PER_UNIT["mm"]
        (left, low), (right, high) = area
        below = max(JAW_HEIGHT, room_below)
        room_x = right - left - CHUCK_LENGTH - room_right
        room_y = high - low - ABOVE - below
        length = (stock.length + stock.allowance) * self.mm
        diameter = stock.diameter * self.mm
        fits = min(room_x / length, room_y / diameter)
        self.factor = next((value for value in SCALES if value <= fits), fits)
        used = CHUCK_LENGTH + length * self.factor + room_right
        start = left + (right - left - used) / 2 + CHUCK_LENGTH
        self.zero = start + stock.length * self.mm * self.factor
        spare = room_y - diameter * self.factor
        self.centre = low + below + spare / 2 + diameter * self.factor / 2
        self.area = area

    def size(self, length: float) -> float:
        """A length of the file on the sheet, mm."""
        return length * self.mm * self.factor

    def at(self, z: float, x: float) -> Point:
        """The place of a point; `x` below 0 is the lower half."""
        return self.zero + self.size(z), self.centre + self.size(x)

    def trace(self, pieces: Iterable[Element]) -> list[tuple[float, float]]:
        """(z, x) along a chain, arcs as many short chords."""
        found: list[tuple[float, float]] = []
        for piece in pieces:
            places: list[Place] = [piece.start, piece.end]
            if isinstance(piece, Arc):
                count = max(2, math.ceil(self.size(piece.length) / CHORD))
                places = [piece.at(number / count) for number in range(count + 1)]
            found += [(place.z, place.x) for place in places]
        return found
