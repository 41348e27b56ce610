# SPDX-License-Identifier: Apache-2.0
"""Chains of lines and arcs, and what a drawing does to their corners: roundings and chamfers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from .shape import (
    TINY,
    Arc,
    Line,
    Point,
    Segment,
    circles,
    crossing,
    distance,
    line_and_circle,
    side,
)


@dataclass(frozen=True)
class Vertex:
    """A point of a profile; lengths in steps.

    ``radius`` or ``centre`` is that of the arc which ends here. ``corner`` is the radius of a
    rounding here, ``chamfer`` how much a chamfer takes off each of the two sides.
    """

    place: Point
    radius: float | None = None
    centre: Point | None = None
    corner: float = 0.0
    chamfer: float = 0.0


def chain(vertices: Sequence[Vertex]) -> tuple[Segment, ...]:
    """Return the lines and arcs of a profile, with its corners rounded and chamfered.

    Raises:
        ValueError: a corner is not between two segments, or too large for them.
    """
    segments = [_segment(a.place, b) for a, b in pairwise(vertices)]
    if any(v.corner or v.chamfer for v in (vertices[0], vertices[-1])):
        raise ValueError("the first and the last point of a profile are no corners")
    found: list[Segment] = segments[:1]
    for vertex, then in zip(vertices[1:-1], segments[1:], strict=True):
        before = found.pop()
        if vertex.corner:
            found += rounded(before, then, vertex.corner)
        elif vertex.chamfer:
            found += chamfered(before, then, vertex.chamfer)
        else:
            found += [before, then]
    return tuple(found)


def _segment(start: Point, vertex: Vertex) -> Segment:
    if vertex.centre is not None:
        return Arc.around(start, vertex.place, vertex.centre)
    if vertex.radius is not None:
        return Arc.of_radius(start, vertex.place, vertex.radius)
    return Line(start, vertex.place)


def chamfered(before: Segment, then: Segment, length: float) -> list[Segment]:
    """Return two lines with a chamfer between them that takes ``length`` off each.

    Raises:
        ValueError: one of them is an arc, or too short.
    """
    if not isinstance(before, Line) or not isinstance(then, Line):
        raise ValueError("a chamfer is between two lines")
    corner = before.end
    if min(distance(before.start, corner), distance(corner, then.end)) < length - TINY:
        raise ValueError("the lines are too short for their chamfer")
    start, end = _towards(corner, before.start, length), _towards(corner, then.end, length)
    return [Line(before.start, start), Line(start, end), Line(end, then.end)]


def _towards(start: Point, end: Point, length: float) -> Point:
    part = length / distance(start, end)
    return Point(start.z + part * (end.z - start.z), start.x + part * (end.x - start.x))


def rounded(before: Segment, then: Segment, radius: float) -> list[Segment]:
    """Return two segments with an arc between them that touches both.

    Raises:
        ValueError: no such arc exists.
    """
    corner = before.end
    found: list[tuple[float, Point, Point, Point]] = []
    for a in _beside(before, radius):
        for b in _beside(then, radius):
            for centre in _common(a, b):
                start, end = _foot(before, centre), _foot(then, centre)
                if start is not None and end is not None:
                    found.append((distance(centre, corner), centre, start, end))
    if not found:
        raise ValueError("the segments are too short for their rounding")
    _, centre, start, end = min(found)
    convex = side(start, end, centre) > 0
    return [
        before.between(before.start, start),
        Arc(start, end, centre, convex),
        then.between(end, then.end),
    ]


@dataclass(frozen=True)
class _Circle:
    centre: Point
    radius: float


def _beside(segment: Segment, radius: float) -> list[Line | _Circle]:
    """Where the centres of all circles are that touch a segment from either side."""
    if isinstance(segment, Arc):
        radii = (segment.radius + radius, abs(segment.radius - radius))
        return [_Circle(segment.centre, r) for r in radii]
    part = radius / distance(segment.start, segment.end)
    by_z = -(segment.end.x - segment.start.x) * part
    by_x = (segment.end.z - segment.start.z) * part
    return [
        Line(
            Point(segment.start.z + s * by_z, segment.start.x + s * by_x),
            Point(segment.end.z + s * by_z, segment.end.x + s * by_x),
        )
        for s in (1, -1)
    ]


def _common(a: Line | _Circle, b: Line | _Circle) -> list[Point]:
    if isinstance(a, Line) and isinstance(b, Line):
        place = crossing(a, b)
        return [] if place is None else [place]
    if isinstance(a, _Circle) and isinstance(b, _Circle):
        return circles(a.centre, a.radius, b.centre, b.radius)
    line, circle = (a, b) if isinstance(a, Line) else (b, a)
    if not isinstance(line, Line) or not isinstance(circle, _Circle):
        return []
    return line_and_circle(line, circle.centre, circle.radius)


def _foot(segment: Segment, centre: Point) -> Point | None:
    """Where a circle around ``centre`` touches a segment; None beside it."""
    if isinstance(segment, Arc):
        away = distance(segment.centre, centre)
        if away < TINY:
            return None
        part = segment.radius / away
        foot = Point(
            segment.centre.z + part * (centre.z - segment.centre.z),
            segment.centre.x + part * (centre.x - segment.centre.x),
        )
    else:
        length = distance(segment.start, segment.end)
        way_z = (segment.end.z - segment.start.z) / length
        way_x = (segment.end.x - segment.start.x) / length
        along = (centre.z - segment.start.z) * way_z + (centre.x - segment.start.x) * way_x
        foot = Point(segment.start.z + along * way_z, segment.start.x + along * way_x)
    return foot if segment.distance_to(foot) < 1e-6 else None
