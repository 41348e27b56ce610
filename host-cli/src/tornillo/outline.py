# SPDX-License-Identifier: Apache-2.0
"""The outline of the finished part: what all operations together leave of the stock.

Pieces of lines and arcs in file units, from the free end to the chuck. Between two pieces that
do not meet there is a shoulder.
"""

from collections.abc import Iterator
from itertools import combinations, pairwise
from typing import NamedTuple

from tornillo.contour import Element, Line, Point, intersections
from tornillo.operations import Contour, Operation, Plunge
from tornillo.part import Part

#: File units below which a piece is not there.
SLIVER = 1e-6
#: Above it there is always material in front of a face.
NOTHING = -1.0


class Cover(NamedTuple):
    """A piece that nothing stands above, from `front` to `back`."""

    element: Element
    front: float
    back: float


def outline(part: Part) -> tuple[Element, ...]:
    """The outline of `part`; empty when nothing is left of it."""
    stock = part.stock
    raw = Line(Point(stock.allowance, stock.diameter / 2), Point(-stock.length, stock.diameter / 2))
    covers = [Cover(raw, raw.start.z, raw.end.z)]
    for operation in part.ordered:
        covers += _covers(operation, stock.allowance)
    covers = [cover for cover in covers if cover.front - cover.back > SLIVER]
    pieces: list[Element] = []
    for front, back in pairwise(_breaks(covers, stock.allowance, -stock.length)):
        element = _lowest(covers, (front + back) / 2)
        start, end = _at(element, front), _at(element, back)
        if min(start.x, end.x) < SLIVER and max(start.x, end.x) < SLIVER:
            pieces.clear()
        elif pieces and _same(pieces[-1], element):
            pieces[-1] = pieces[-1].between(pieces[-1].start, end)
        else:
            pieces.append(element.between(start, end))
    return tuple(pieces)


def _covers(operation: Operation, front: float) -> Iterator[Cover]:
    """What one operation leaves at most."""
    shape = operation.shape
    if isinstance(shape, Plunge):
        back = shape.back
        if operation.type == "part-off":
            back -= operation.tool.width
        radius = max(shape.diameter / 2, 0.0)
        floor = Line(Point(shape.front, radius), Point(back, radius))
        yield Cover(floor, shape.front, back)
    elif isinstance(shape, Contour):
        first = shape.elements[0].start
        if operation.type == "face":
            inner = max(first.x, 0.0)
            yield Cover(Line(Point(front, inner), Point(first.z, inner)), front, first.z)
        for element in shape.elements:
            yield Cover(element, element.start.z, element.end.z)


def _breaks(covers: list[Cover], front: float, back: float) -> list[float]:
    """Every z at which another piece may come to be the lowest, from the front."""
    found = {front, back}
    for cover in covers:
        found |= {cover.front, cover.back}
    for one, other in combinations(covers, 2):
        low, high = max(one.back, other.back), min(one.front, other.front)
        if low < high:
            met = intersections(one.element, other.element)
            found |= {place.z for place in met if low < place.z < high}
    ordered = sorted((z for z in found if back <= z <= front), reverse=True)
    kept = ordered[:1]
    for z in ordered[1:]:
        if kept[-1] - z > SLIVER:
            kept.append(z)
    return kept


def _lowest(covers: list[Cover], z: float) -> Element:
    """The piece that is the lowest at `z`; there always is the stock."""
    here = [cover.element for cover in covers if cover.back < z < cover.front]
    return min(here, key=lambda element: _at(element, z).x)


def _at(element: Element, z: float) -> Point:
    """The place on a piece at `z`."""
    height = element.height(min(max(z, element.end.z), element.start.z))
    return Point(z, 0.0 if height is None else max(height, 0.0))


def _same(one: Element, other: Element) -> bool:
    """Whether two neighbours are parts of the same piece."""
    if isinstance(one, Line) and isinstance(other, Line):
        level = abs(one.start.x - one.end.x) + abs(other.start.x - other.end.x) < SLIVER
        return level and abs(one.end.x - other.start.x) < SLIVER
    return False
