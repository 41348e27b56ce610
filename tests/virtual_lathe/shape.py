# SPDX-License-Identifier: Apache-2.0
"""Lines and arcs in the plane of Z and radius, in steps; exact, nothing is rounded by itself."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

TINY = 1e-9


class Point(NamedTuple):
    """A place: ``z`` along the spindle, ``x`` the radius, both in steps."""

    z: float
    x: float

    def on_grid(self) -> Point:
        """Return the nearest whole step, halves away from axis and chuck."""
        return Point(math.floor(self.z + 0.5), math.floor(self.x + 0.5))


def distance(a: Point, b: Point) -> float:
    """Return how far two places are from each other, in steps."""
    return math.hypot(a.z - b.z, a.x - b.x)


def side(start: Point, end: Point, place: Point) -> float:
    """Return > 0 if a place lies on the axis' side of a line towards the chuck."""
    return (end.z - start.z) * (place.x - start.x) - (end.x - start.x) * (place.z - start.z)


@dataclass(frozen=True)
class Line:
    """A straight line."""

    start: Point
    end: Point

    def radius_at(self, z: float) -> float:
        """Return the radius at ``z``; of a vertical line the smaller one."""
        length = self.end.z - self.start.z
        if abs(length) < TINY:
            return min(self.start.x, self.end.x)
        if self.start.x == self.end.x:
            return self.start.x
        return self.start.x + (z - self.start.z) * (self.end.x - self.start.x) / length

    def distance_to(self, place: Point) -> float:
        """Return how far a place is from the line, in steps."""
        dz, dx = self.end.z - self.start.z, self.end.x - self.start.x
        square = dz * dz + dx * dx
        part = 0.0
        if square > 0:
            part = ((place.z - self.start.z) * dz + (place.x - self.start.x) * dx) / square
            part = min(1.0, max(0.0, part))
        return distance(place, Point(self.start.z + part * dz, self.start.x + part * dx))

    def between(self, start: Point, end: Point) -> Line:
        """Return the part of the line between two places on it."""
        return Line(start, end)

    def on_grid(self) -> Line:
        """Return the line with its ends moved to whole steps."""
        return Line(self.start.on_grid(), self.end.on_grid())


@dataclass(frozen=True)
class Arc:
    """Part of a circle, above its centre if ``convex``, else below; at most half of it."""

    start: Point
    end: Point
    centre: Point
    convex: bool

    @classmethod
    def of_radius(cls, start: Point, end: Point, radius: float) -> Arc:
        """Return the shorter arc of a radius; > 0 is convex.

        A radius below half of the chord becomes half of the chord.

        Raises:
            ValueError: start and end are the same.
        """
        chord = distance(start, end)
        if chord < TINY:
            raise ValueError("an arc must end somewhere else than it starts")
        height = math.sqrt(max(0.0, radius * radius - chord * chord / 4))
        if radius < 0:
            height = -height
        # The unit vector that points from the chord to the axis.
        down_z, down_x = (end.x - start.x) / -chord, (end.z - start.z) / chord
        middle = Point((start.z + end.z) / 2, (start.x + end.x) / 2)
        centre = Point(middle.z + height * down_z, middle.x + height * down_x)
        return cls(start, end, centre, radius > 0)

    @classmethod
    def around(cls, start: Point, end: Point, centre: Point) -> Arc:
        """Return the shorter arc around a centre.

        Of a centre that is not as far from one end as from the other, the nearest that is.
        """
        radius = (distance(start, centre) + distance(end, centre)) / 2
        below = side(start, end, centre) >= -TINY
        return cls.of_radius(start, end, radius if below else -radius)

    @classmethod
    def via(cls, start: Point, end: Point, place: Point) -> Arc:
        """Return the arc through a third place.

        Raises:
            ValueError: the three lie on a line.
        """
        twice_area = side(start, end, place)
        if abs(twice_area) < TINY:
            raise ValueError("the three points of an arc lie on a line")
        sides = distance(start, end) * distance(end, place) * distance(place, start)
        radius = sides / (2 * abs(twice_area))
        return cls.of_radius(start, end, -radius if twice_area > 0 else radius)

    @property
    def radius(self) -> float:
        """The radius in steps."""
        return distance(self.start, self.centre)

    def radius_at(self, z: float) -> float:
        """Return the radius of the work at ``z``."""
        rest = (distance(self.start, self.centre)) ** 2 - (z - self.centre.z) ** 2
        height = math.sqrt(max(0.0, rest))
        return self.centre.x + (height if self.convex else -height)

    def distance_to(self, place: Point) -> float:
        """Return how far a place is from the arc, in steps."""
        away = distance(place, self.centre)
        if away > TINY:
            part = self.radius / away
            foot_z = self.centre.z + (place.z - self.centre.z) * part
            above = place.x >= self.centre.x
            if above == self.convex and self.end.z <= foot_z <= self.start.z:
                return abs(away - self.radius)
        return min(distance(place, self.start), distance(place, self.end))

    def between(self, start: Point, end: Point) -> Arc:
        """Return the part of the arc between two places on it."""
        return Arc(start, end, self.centre, self.convex)

    def on_grid(self) -> Arc:
        """Return the arc of the same radius with its ends moved to whole steps."""
        ends = self.start.on_grid(), self.end.on_grid()
        if distance(*ends) < 1:
            return self
        return Arc.of_radius(*ends, self.radius if self.convex else -self.radius)


Segment = Line | Arc


def meetings(a: Segment, b: Segment) -> list[float]:
    """Return every z at which two segments may meet, and perhaps some more."""
    if isinstance(a, Line) and isinstance(b, Line):
        return _lines(a, b)
    if isinstance(a, Arc) and isinstance(b, Arc):
        return [place.z for place in circles(a.centre, a.radius, b.centre, b.radius)]
    line, arc = (a, b) if isinstance(a, Line) else (b, a)
    if not isinstance(line, Line) or not isinstance(arc, Arc):
        return []
    return [place.z for place in line_and_circle(line, arc.centre, arc.radius)]


def _lines(a: Line, b: Line) -> list[float]:
    """Return the z at which two lines meet, made longer without end."""
    place = crossing(a, b)
    return [] if place is None else [place.z]


def crossing(a: Line, b: Line) -> Point | None:
    """Return where two lines meet, made longer without end; None if they are parallel."""
    a_z, a_x = a.end.z - a.start.z, a.end.x - a.start.x
    b_z, b_x = b.end.z - b.start.z, b.end.x - b.start.x
    across = a_z * b_x - a_x * b_z
    if abs(across) < TINY:
        return None
    part = ((b.start.z - a.start.z) * b_x - (b.start.x - a.start.x) * b_z) / across
    return Point(a.start.z + part * a_z, a.start.x + part * a_x)


def line_and_circle(line: Line, centre: Point, radius: float) -> list[Point]:
    """Return where a line, made longer without end, meets a circle."""
    length = distance(line.start, line.end)
    if length < TINY:
        return []
    way_z = (line.end.z - line.start.z) / length
    way_x = (line.end.x - line.start.x) / length
    along = (centre.z - line.start.z) * way_z + (centre.x - line.start.x) * way_x
    foot = Point(line.start.z + along * way_z, line.start.x + along * way_x)
    rest = radius * radius - distance(foot, centre) ** 2
    if rest < -TINY * max(1.0, radius):
        return []
    half = math.sqrt(max(0.0, rest))
    return [Point(foot.z + s * half * way_z, foot.x + s * half * way_x) for s in (1, -1)]


def circles(a: Point, a_radius: float, b: Point, b_radius: float) -> list[Point]:
    """Return where two circles meet."""
    away = distance(a, b)
    if away < TINY or away > a_radius + b_radius or away < abs(a_radius - b_radius):
        return []
    along = (away * away + a_radius * a_radius - b_radius * b_radius) / (2 * away)
    half = math.sqrt(max(0.0, a_radius * a_radius - along * along))
    way_z, way_x = (b.z - a.z) / away, (b.x - a.x) / away
    foot = Point(a.z + along * way_z, a.x + along * way_x)
    return [Point(foot.z - s * half * way_x, foot.x + s * half * way_z) for s in (1, -1)]
