# SPDX-License-Identifier: Apache-2.0
"""Exact geometry of contours: chains of lines and arcs, in floats.

A point is (z, x): z along the spindle, + away from the chuck; x a radius. All lengths are in
one unit, that of the part file. A contour runs from the free end towards the chuck; the tool is
on its left as drawn with z to the right, that is on the side of larger x, and normals point to
the tool.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from tornillo.language import _

#: Lengths of file units below which two places are the same.
SAME = 1e-9


class Point(NamedTuple):
    """A place, or a direction."""

    z: float
    x: float

    def plus(self, other: "Point", factor: float = 1.0) -> "Point":
        """This place moved by `factor` times `other`."""
        return Point(self.z + factor * other.z, self.x + factor * other.x)

    def minus(self, other: "Point") -> "Point":
        """The way from `other` to this place."""
        return Point(self.z - other.z, self.x - other.x)

    def dot(self, other: "Point") -> float:
        """The scalar product."""
        return self.z * other.z + self.x * other.x

    def cross(self, other: "Point") -> float:
        """The vector product; above 0 when `other` lies left of this direction."""
        return self.z * other.x - self.x * other.z

    @property
    def length(self) -> float:
        """The distance from the origin."""
        return math.hypot(self.z, self.x)

    @property
    def unit(self) -> "Point":
        """The direction, of length 1."""
        return Point(self.z / self.length, self.x / self.length)

    @property
    def normal(self) -> "Point":
        """This direction of travel turned so that it points to the tool."""
        return Point(self.x, -self.z)


def distance(a: Point, b: Point) -> float:
    """How far two places are apart."""
    return math.hypot(a.z - b.z, a.x - b.x)


@dataclass(frozen=True)
class Line:
    """A straight piece. `place` is the number of the point of the file it ends in."""

    start: Point
    end: Point
    place: int = 0

    @property
    def length(self) -> float:
        """Its length."""
        return distance(self.start, self.end)

    def direction(self, _at: Point) -> Point:
        """The direction of travel, of length 1."""
        return self.end.minus(self.start).unit

    def normal(self, at: Point) -> Point:
        """The direction to the tool."""
        return self.direction(at).normal

    def between(self, start: Point, end: Point) -> "Line":
        """The part from `start` to `end`, both on it or on its extension."""
        return Line(start, end, self.place)

    def offset(self, by: float) -> "Line":
        """The line moved by `by` towards the tool."""
        normal = self.normal(self.start)
        return Line(self.start.plus(normal, by), self.end.plus(normal, by), self.place)

    def shifted(self, by: Point) -> "Line":
        """The line moved by a vector."""
        return Line(self.start.plus(by), self.end.plus(by), self.place)

    def along(self, at: Point) -> float:
        """How far along the line, from its start, the nearest place to `at` is."""
        return at.minus(self.start).dot(self.direction(at))

    def height(self, z: float) -> float | None:
        """The x at `z`, the lowest when it is vertical; None when it does not reach there."""
        if not self.end.z - SAME <= z <= self.start.z + SAME:
            return None
        run = self.start.z - self.end.z
        if run < SAME:
            return min(self.start.x, self.end.x)
        return self.start.x + (self.end.x - self.start.x) * (self.start.z - z) / run


@dataclass(frozen=True)
class Arc:
    """A piece of a circle; convex ones bulge away from the axis, concave ones towards it."""

    start: Point
    end: Point
    centre: Point
    convex: bool
    place: int = 0

    @property
    def radius(self) -> float:
        """The radius of the circle."""
        return distance(self.start, self.centre)

    @property
    def side(self) -> int:
        """1 convex, -1 concave: which way the tool is, seen from the centre."""
        return 1 if self.convex else -1

    def angle(self, at: Point) -> float:
        """The direction of `at` from the centre, radians."""
        return math.atan2(at.x - self.centre.x, at.z - self.centre.z)

    @property
    def sweep(self) -> float:
        """The angle it covers, 0 to 2 pi."""
        turned = self.side * (self.angle(self.end) - self.angle(self.start))
        turned %= 2 * math.pi
        return turned if turned < 2 * math.pi - SAME else 0.0

    @property
    def length(self) -> float:
        """Its length."""
        return self.sweep * self.radius

    def at(self, part: float) -> Point:
        """The place at this part of its length, 0 the start, 1 the end."""
        angle = self.angle(self.start) + self.side * part * self.sweep
        radius = self.radius
        return Point(
            self.centre.z + radius * math.cos(angle), self.centre.x + radius * math.sin(angle)
        )

    def normal(self, at: Point) -> Point:
        """The direction to the tool in `at`."""
        out = at.minus(self.centre).unit
        return out if self.convex else Point(-out.z, -out.x)

    def direction(self, at: Point) -> Point:
        """The direction of travel in `at`, of length 1."""
        normal = self.normal(at)
        return Point(-normal.x, normal.z)

    def between(self, start: Point, end: Point) -> "Arc":
        """The part from `start` to `end`, both on it or on its circle."""
        return Arc(start, end, self.centre, self.convex, self.place)

    def offset(self, by: float) -> "Arc":
        """The arc moved by `by` towards the tool; a concave one must have a larger radius."""
        start = self.start.plus(self.normal(self.start), by)
        end = self.end.plus(self.normal(self.end), by)
        return Arc(start, end, self.centre, self.convex, self.place)

    def shifted(self, by: Point) -> "Arc":
        """The arc moved by a vector."""
        return Arc(
            self.start.plus(by), self.end.plus(by), self.centre.plus(by), self.convex, self.place
        )

    def along(self, at: Point) -> float:
        """How far along the arc, from its start, `at` is; below 0 when before it."""
        turned = self.side * (self.angle(at) - self.angle(self.start)) % (2 * math.pi)
        if turned > self.sweep / 2 + math.pi:
            turned -= 2 * math.pi
        return turned * self.radius

    def height(self, z: float) -> float | None:
        """The x at `z`; None when it does not reach there."""
        if not self.end.z - SAME <= z <= self.start.z + SAME:
            return None
        across = math.sqrt(max(0.0, self.radius**2 - (z - self.centre.z) ** 2))
        return self.centre.x + self.side * across


Element = Line | Arc


def monotone(arc: Arc) -> bool:
    """Whether an arc never runs back in z."""
    slack = max(SAME, arc.radius * SAME)
    ends = arc.start.x - arc.centre.x, arc.end.x - arc.centre.x
    return min(arc.side * end for end in ends) >= -slack


def arc_by_radius(start: Point, end: Point, radius: float) -> Arc:
    """The shorter arc of `radius`, above 0 convex, below 0 concave.

    Raises ValueError when the ends are farther apart than the circle is wide.
    """
    half = distance(start, end) / 2
    size = abs(radius)
    if size < half * (1 - SAME):
        raise ValueError(
            _("the radius is less than half the distance of the ends, {half:.6g}").format(half=half)
        )
    normal = end.minus(start).unit.normal
    rise = math.sqrt(max(0.0, size * size - half * half))
    middle = Point((start.z + end.z) / 2, (start.x + end.x) / 2)
    return Arc(start, end, middle.plus(normal, -rise if radius > 0 else rise), radius > 0)


def smallest_radius(start: Point, end: Point) -> float:
    """The smallest radius of an arc between two points that does not run back in z."""
    run = abs(start.z - end.z)
    return distance(start, end) ** 2 / (2 * run) if run > SAME else math.inf


def arc_by_centre(start: Point, end: Point, centre: Point) -> Arc:
    """The arc about `centre`, convex when both ends are above it, on it or no arc otherwise."""
    return Arc(start, end, centre, start.x + end.x >= 2 * centre.x)


def arc_by_third(start: Point, end: Point, via: Point) -> Arc:
    """The arc through `via`; raises ValueError when the three lie on a line."""
    a, b = via.minus(start), end.minus(start)
    twice = 2 * a.cross(b)
    if abs(twice) < SAME * max(1.0, b.length):
        raise ValueError(_("the three points lie on a line"))
    z = (b.x * a.dot(a) - a.x * b.dot(b)) / twice
    x = (a.z * b.dot(b) - b.z * a.dot(a)) / twice
    return Arc(start, end, Point(start.z + z, start.x + x), convex=twice > 0)


def intersections(a: Element, b: Element) -> list[Point]:
    """Where the line or circle of `a` meets that of `b`; none, one or two places."""
    if isinstance(a, Line) and isinstance(b, Line):
        return _line_line(a, b)
    if isinstance(a, Line) and isinstance(b, Arc):
        return _line_circle(a, b)
    if isinstance(a, Arc) and isinstance(b, Line):
        return _line_circle(b, a)
    assert isinstance(a, Arc)
    assert isinstance(b, Arc)
    return _circle_circle(a, b)


def _line_line(a: Line, b: Line) -> list[Point]:
    """Two straight lines."""
    u, v = a.direction(a.start), b.direction(b.start)
    turn = u.cross(v)
    if abs(turn) < SAME:
        return []
    return [a.start.plus(u, b.start.minus(a.start).cross(v) / turn)]


def _line_circle(line: Line, arc: Arc) -> list[Point]:
    """A straight line and a circle."""
    u = line.direction(line.start)
    foot = line.start.plus(u, arc.centre.minus(line.start).dot(u))
    square = arc.radius**2 - distance(foot, arc.centre) ** 2
    if square < -SAME * max(1.0, arc.radius):
        return []
    half = math.sqrt(max(0.0, square))
    return [foot.plus(u, -half), foot.plus(u, half)]


def _circle_circle(a: Arc, b: Arc) -> list[Point]:
    """Two circles."""
    apart = distance(a.centre, b.centre)
    if apart < SAME:
        return []
    u = b.centre.minus(a.centre).unit
    foot = (apart * apart + a.radius**2 - b.radius**2) / (2 * apart)
    square = a.radius**2 - foot * foot
    if square < -SAME * max(1.0, a.radius):
        return []
    half = math.sqrt(max(0.0, square))
    middle = a.centre.plus(u, foot)
    return [middle.plus(u.normal, half), middle.plus(u.normal, -half)]


def turn(before: Element, after: Element) -> float:
    """The angle by which the contour turns in the corner, radians; above 0 inside corners."""
    u, v = before.direction(before.end), after.direction(after.start)
    return -math.atan2(u.cross(v), u.dot(v))
