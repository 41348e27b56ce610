# SPDX-License-Identifier: Apache-2.0
"""Contours on the grid of whole steps: lines and arcs as the chip interpolates them.

End points are rounded to the grid. The centre of an arc is fitted again, so that its circle
leads from the rounded start through the rounded end and deviates as little as possible in
between; it has 1/256 step. Where one circle does not do (steps of different size in X and Z,
radii that the chip cannot count), several arcs or lines follow the curve.
"""

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

from tornillo.contour import Element, Line, Point
from tornillo.image import CENTRE_UNIT, Segment, SegmentKind
from tornillo.protocol import RADIUS_MAX
from tornillo.rules_shape import arc_exists

#: Steps that an arc may stand above its chord and still be a line.
FLAT = 0.25
#: Steps that a fitted arc may be away from the true curve, its rounded ends left out.
CLOSE = 0.25
DEEPEST = 8
CENTRE_MAX = (1 << 23) - 1
SAMPLES = (0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875)
#: How far, in steps, the centre is moved along the bisector until the chip accepts the arc.
SHIFTS = (
    0.0,
    *(sign * n / 16 for n in range(1, 33) for sign in (1, -1)),
    *(sign * 2 * 1.15**n for n in range(1, 40) for sign in (1, -1)),
)


class Grid(NamedTuple):
    """Steps per unit of the part file along and across."""

    z: float
    x: float

    def place(self, point: Point) -> Point:
        """A place in steps, not rounded."""
        return Point(point.z * self.z, point.x * self.x)

    def rounded(self, point: Point) -> tuple[int, int]:
        """(z, x) in whole steps."""
        return round(point.z * self.z), round(point.x * self.x)


def path_segments(
    path: list[Element], grid: Grid, exact: bool = False
) -> tuple[tuple[int, int], tuple[Segment, ...]]:
    """Start (z, x) and segments of a path.

    `exact`: the path comes from an image, so that the centres of its arcs are kept.
    """
    start = grid.rounded(path[0].start)
    at = start
    segments: list[Segment] = []
    for element in path:
        for segment in _segments(element, grid, at, exact):
            if segments and not exact and _straight_on(segments[-1], segment):
                before = segments.pop()
                segments.append(
                    before._replace(dz=before.dz + segment.dz, dx=before.dx + segment.dx)
                )
            else:
                segments.append(segment)
            at = at[0] + segment.dz, at[1] + segment.dx
    return start, tuple(segments)


def _straight_on(one: Segment, two: Segment) -> bool:
    """Whether two lines are one."""
    lines = one.kind is SegmentKind.LINE and two.kind is SegmentKind.LINE
    same_way = one.dz * two.dz >= 0 and one.dx * two.dx >= 0
    return lines and same_way and one.dz * two.dx == one.dx * two.dz


def _segments(element: Element, grid: Grid, at: tuple[int, int], exact: bool) -> Iterator[Segment]:
    """One piece of a path, from where the one before has ended."""
    if isinstance(element, Line):
        yield from _line(at, grid.rounded(element.end))
        return
    if exact:
        yield _segment(at, grid.rounded(element.end), grid.place(element.centre), element.convex)
        return
    curve = element.at

    def place(part: float) -> Point:
        return grid.place(curve(part))

    yield from _arc(_Curve(place, element.convex), (0.0, 1.0), at, 0)


def _line(start: tuple[int, int], end: tuple[int, int]) -> Iterator[Segment]:
    """A line, unless it has no length."""
    if start != end:
        yield Segment(SegmentKind.LINE, end[0] - start[0], end[1] - start[1])


class _Curve(NamedTuple):
    """A bow in steps, by the part of its length."""

    at: Callable[[float], Point]
    convex: bool


def _arc(
    curve: _Curve, span: tuple[float, float], start: tuple[int, int], depth: int
) -> Iterator[Segment]:
    """Arcs along `span` of a curve, from the rounded `start`."""
    low, high = span
    last = curve.at(high)
    end = round(last.z), round(last.x)
    middle = curve.at((low + high) / 2)
    if _bow(Point(*start), Point(*end), middle) < FLAT and (
        _bow(curve.at(low), last, middle) < 2 * FLAT
    ):
        yield from _line(start, end)
        return
    fitted = _fit(curve, span, start, end)
    if fitted is not None:
        yield fitted
    elif depth == DEEPEST:
        yield from _line(start, end)
    else:
        half = (low + high) / 2
        at = start
        for part in ((low, half), (half, high)):
            for segment in _arc(curve, part, at, depth + 1):
                yield segment
                at = at[0] + segment.dz, at[1] + segment.dx


def _bow(start: Point, end: Point, middle: Point) -> float:
    """How far `middle` is from the chord, in steps; infinite when there is no chord in z."""
    chord = end.minus(start)
    if chord.length == 0:
        return middle.minus(start).length
    return abs(chord.cross(middle.minus(start))) / chord.length


def _fit(
    curve: _Curve, span: tuple[float, float], start: tuple[int, int], end: tuple[int, int]
) -> Segment | None:
    """The one arc along `span`, or None when no circle does.

    Its centre is the place nearest to that of the true curve that is as far from the rounded
    start as from the rounded end.
    """
    true = _circle(curve, span) if end[0] < start[0] else None
    if true is None:
        return None
    first, last = Point(*start), Point(*end)
    normal = last.minus(first).unit.normal
    halfway = Point((first.z + last.z) / 2, (first.x + last.x) / 2)
    centre = halfway.plus(normal, true.minus(halfway).dot(normal))
    middle = curve.at(sum(span) / 2)

    def off(moved: Point) -> float:
        return abs(moved.minus(middle).length - moved.minus(first).length)

    limit = off(centre) + CLOSE
    for shift in SHIFTS:
        moved = centre.plus(normal, shift)
        segment = _segment(start, end, moved, curve.convex)
        small = max(abs(segment.cz), abs(segment.cx)) <= CENTRE_MAX
        if small and off(moved) <= limit and arc_exists(segment):
            return segment
    return None


def _circle(curve: _Curve, span: tuple[float, float]) -> Point | None:
    """The centre of the circle that follows the true curve closely, None when none does."""
    low, high = span
    first, middle, last = curve.at(low), curve.at((low + high) / 2), curve.at(high)
    if last.minus(first).length == 0:
        return None
    normal = last.minus(first).unit.normal
    half = last.minus(first).length / 2
    halfway = Point((first.z + last.z) / 2, (first.x + last.x) / 2)
    side = 1 if curve.convex else -1
    bow = middle.minus(halfway).dot(normal) * side
    radius = (bow * bow + half * half) / (2 * bow) if bow > 0 else math.inf
    if radius > RADIUS_MAX:
        return None
    centre = halfway.plus(normal, side * (bow - radius))
    for part in SAMPLES:
        place = curve.at(low + (high - low) * part)
        if abs(centre.minus(place).length - radius) > CLOSE:
            return None
    return centre


def _segment(start: tuple[int, int], end: tuple[int, int], centre: Point, convex: bool) -> Segment:
    """The segment with its centre in 1/256 step."""
    return Segment(
        SegmentKind.CONVEX if convex else SegmentKind.CONCAVE,
        end[0] - start[0],
        end[1] - start[1],
        math.floor((centre.z - start[0]) * CENTRE_UNIT + 0.5),
        math.floor((centre.x - start[1]) * CENTRE_UNIT + 0.5),
    )
