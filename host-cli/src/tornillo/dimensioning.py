# SPDX-License-Identifier: Apache-2.0
"""Which dimensions a drawing gets, and where: diameters, lengths, radii, angles, widths."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from tornillo.contour import Arc, Element, Line, distance, intersections
from tornillo.dimensions import Labels, across, along, ordinates_below, ordinates_beside
from tornillo.operations import Plunge
from tornillo.part import Part
from tornillo.scene import Point, Scene
from tornillo.view import JAW_HEIGHT, View

FIRST_ROW, ROW = 11.0, 7.0
#: More dimensions than these are written as a row of numbers instead of lines with arrows.
ROWS_MOST = 5
ORDINATES = 17.0
#: Shortest piece of the outline that is dimensioned across inside, mm on the sheet.
INSIDE = 9.0
#: Shortest cone whose angle is told, mm on the sheet.
CONE = 2.5
#: More leaders than these make a drawing harder to read, not easier.
LEADERS_MOST = 16
#: Pieces shorter than this part of the stock round or break a corner: the corner is dimensioned.
CORNER = 0.02
SAME = 1e-6


class Diameter(NamedTuple):
    """A diameter of the outline at `z`; `hidden` from the free end by a larger one.

    `level`: the length of the cylinder that has it, 0 for the end of a cone or an arc.
    """

    z: float
    radius: float
    level: float
    hidden: bool


class Leader(NamedTuple):
    """A number with an arrow at `tip`, from the side of `away`; `size` of the piece, mm."""

    size: float
    tip: Point
    away: Point
    text: str


def show(part: Part, value: float) -> str:
    """A number as a machinist writes it in the units of the file."""
    if part.units == "inch":
        return f"{value:.3f}"
    text = f"{value:.3f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def diameters(pieces: Sequence[Element]) -> list[Diameter]:
    """Every diameter once, where it is seen best: long cylinders before ends of cones."""
    found: list[Diameter] = []
    highest = 0.0
    for piece in pieces:
        ends = [piece.start, piece.end]
        is_level = isinstance(piece, Line) and abs(piece.start.x - piece.end.x) < SAME
        length = piece.start.z - piece.end.z if is_level else 0.0
        for end in ends[:1] if is_level else ends:
            highest_here = max(highest, piece.start.x)
            hidden = end.x < highest_here - SAME
            if end.x > SAME:
                found.append(Diameter(end.z, end.x, length, hidden))
        highest = max(highest, _top(piece))
    best: dict[int, Diameter] = {}
    for diameter in sorted(found, key=lambda entry: (entry.hidden, -entry.level)):
        best.setdefault(round(diameter.radius / 1e-4), diameter)
    return sorted(best.values(), key=lambda entry: entry.radius)


def sharpened(pieces: Sequence[Element], small: float) -> list[Element]:
    """The pieces with the corners that were rounded or broken; `small` in file units."""
    found = list(pieces)
    for number in range(1, len(found) - 1):
        before, piece, after = found[number - 1 : number + 2]
        if distance(piece.start, piece.end) > small:
            continue
        if not (isinstance(before, Line) and isinstance(after, Line)):
            continue
        if min(before.length, after.length) < SAME:
            continue
        met = intersections(before, after)
        if met and distance(met[0], piece.start) < 2 * small:
            found[number - 1 : number + 2] = [
                before.between(before.start, met[0]),
                Line(met[0], met[0]),
                after.between(met[0], after.end),
            ]
    return [piece for piece in found if distance(piece.start, piece.end) > SAME]


def _top(piece: Element) -> float:
    """The largest radius of a piece."""
    ends = max(piece.start.x, piece.end.x)
    over = isinstance(piece, Arc) and piece.convex and piece.end.z < piece.centre.z < piece.start.z
    return piece.centre.x + piece.radius if over and isinstance(piece, Arc) else ends


def lengths(part: Part, pieces: Sequence[Element]) -> list[float]:
    """Every z at which something begins or ends, from the free end, part zero left out."""
    found = {part.stock.allowance, -part.stock.length}
    for piece in pieces:
        found |= {piece.start.z, piece.end.z}
    ordered: list[float] = []
    for z in sorted(found, reverse=True):
        if abs(z) > SAME and not (ordered and ordered[-1] - z < 1e-4):
            ordered.append(z)
    return ordered


class Dimensions:
    """The dimensions of one part; knows how much room they take before the scale is chosen."""

    def __init__(self, part: Part, pieces: Sequence[Element]) -> None:
        """Choose what is dimensioned."""
        self.part = part
        self.pieces = pieces
        small = CORNER * (part.stock.length + part.stock.allowance)
        sharp = sharpened(pieces, small)
        every = diameters(sharp)
        self.outside = [entry for entry in every if not entry.hidden]
        self.inside = [entry for entry in every if entry.hidden]
        stock = part.stock.diameter / 2
        if not any(abs(entry.radius - stock) < SAME for entry in self.outside):
            self.outside.append(Diameter(-part.stock.length, stock, 0.0, False))
        self.lengths = lengths(part, sharp)

    @property
    def room_right(self) -> float:
        """Room to the right of the stock, mm."""
        count = len(self.outside)
        return FIRST_ROW + ROW * count if count <= ROWS_MOST else ORDINATES + FIRST_ROW

    @property
    def room_below(self) -> float:
        """Room below the stock, mm."""
        count = len(self.lengths)
        return FIRST_ROW + ROW * count if count <= ROWS_MOST else ORDINATES + FIRST_ROW

    def draw(self, scene: Scene, view: View) -> None:
        """Everything."""
        self._outside(scene, view)
        self._lengths(scene, view)
        (left, low), (right, high) = view.area
        _, bottom = view.at(0, -self.part.stock.diameter / 2)
        labels = Labels(scene, ((left, low), (right, high)))
        front, _ = view.at(self.part.stock.allowance, 0)
        labels.keep_off((left, low), (right, bottom - FIRST_ROW + 4.5))
        labels.keep_off((front + 2, low), (right, high))
        labels.keep_off((left, view.centre - 2), (right, high))
        for (z0, x0), (z1, x1) in pairwise(view.trace(self.pieces)):
            corner = view.at(z1, -max(x0, x1))
            labels.rather_off((corner[0] - 0.5, corner[1] - 0.5), view.at(z0, 0))
        leaders = [*self._inside(scene, view, labels), *self._curves(view)]
        leaders = sorted(leaders, key=lambda leader: -leader.size)[:LEADERS_MOST]
        for leader in sorted(leaders, key=lambda leader: leader.tip):
            labels.put(leader.tip, leader.away, leader.text)
        self._widths(scene, view)

    def _outside(self, scene: Scene, view: View) -> None:
        """Diameters that are seen from the free end, to the right."""
        right, _ = view.at(self.part.stock.allowance, 0)
        if len(self.outside) <= ROWS_MOST:
            for column, entry in enumerate(self.outside):
                edge, high = view.at(entry.z, entry.radius)
                place = right + FIRST_ROW + ROW * column
                span = 2 * view.centre - high, high
                across(scene, span, edge, place, self._diameter(entry))
            return
        places = []
        for entry in self.outside:
            x, y = view.at(entry.z, entry.radius)
            places.append((x, y, self._diameter(entry)))
        span = view.centre, view.area[1][1] - 2
        ordinates_beside(scene, places, right + FIRST_ROW + 2, span)

    def _diameter(self, entry: Diameter) -> str:
        return f"Ø{show(self.part, 2 * entry.radius)}"

    def _lengths(self, scene: Scene, view: View) -> None:
        """Distances from part zero, below."""
        zero, bottom = view.at(0, -self.part.stock.diameter / 2)
        if len(self.lengths) <= ROWS_MOST:
            for row, z in enumerate(sorted(self.lengths, key=abs)):
                other, _ = view.at(z, 0)
                span = min(zero, other), max(zero, other)
                place = bottom - FIRST_ROW - ROW * row
                along(scene, span, bottom - 1, place, show(self.part, abs(z)))
            return
        places = [(zero, bottom - 1, "0")]
        places += [(view.at(z, 0)[0], bottom - 1, show(self.part, z)) for z in self.lengths]
        span = view.area[0][0] + 2, view.area[1][0] - 2
        ordinates_below(scene, sorted(places), bottom - FIRST_ROW, span)

    def _inside(self, scene: Scene, view: View, labels: Labels) -> Iterator[Leader]:
        """Diameters behind larger ones: across the part where there is room for it."""
        for entry in self.inside:
            x, low = view.at(entry.z - entry.level / 2, -entry.radius)
            size = view.size(entry.level)
            if size >= INSIDE:
                span = low, 2 * view.centre - low
                across(scene, span, x, x, self._diameter(entry))
                labels.keep_off((x - 4, low), (x + 1, view.centre))
            else:
                yield Leader(size + CONE, (x, low), (0.3, -1.0), self._diameter(entry))

    def _curves(self, view: View) -> Iterator[Leader]:
        """Radii of arcs and angles of cones, in the lower half."""
        for piece in self.pieces:
            if isinstance(piece, Arc):
                middle = piece.at(0.5)
                text: str | None = f"R{show(self.part, piece.radius)}"
            else:
                middle = piece.start.plus(piece.end.minus(piece.start), 0.5)
                text = self._angle(view, piece)
            if text is not None:
                normal = piece.normal(middle)
                tip = view.at(middle.z, -middle.x)
                yield Leader(view.size(piece.length), tip, (normal.z, -normal.x), text)

    def _angle(self, view: View, piece: Line) -> str | None:
        """The angle of a cone to the axis; small ones of 45 degrees as chamfers."""
        run, rise = piece.start.z - piece.end.z, abs(piece.end.x - piece.start.x)
        if run < SAME or rise < SAME:
            return None
        angle = math.degrees(math.atan2(rise, run))
        if abs(angle - 45) < 0.05 and run * 16 < self.part.stock.diameter:
            return f"{show(self.part, run)} x 45°"
        if view.size(piece.length) < CONE:
            return None
        return f"{angle:.1f}°".replace(".0°", "°")

    def _widths(self, scene: Scene, view: View) -> None:
        """Widths of grooves, above the stock."""
        _, top = view.at(0, self.part.stock.diameter / 2)
        for operation in self.part.ordered:
            shape = operation.shape
            if not isinstance(shape, Plunge) or operation.type == "part-off":
                continue
            left, floor = view.at(shape.back, shape.diameter / 2)
            right, _ = view.at(shape.front, 0)
            text = show(self.part, shape.front - shape.back)
            edge = top + 1 if floor < top else floor
            along(scene, (left, right), edge, top + JAW_HEIGHT * 0.55, text)
