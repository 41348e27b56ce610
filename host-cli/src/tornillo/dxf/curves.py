# SPDX-License-Identifier: Apache-2.0
"""Lines and arcs in a plane: where they are, how to cut, turn and move them.

The unit is that of the drawing; angles are radians, counterclockwise.
"""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from itertools import pairwise

from tornillo.language import _

Point = tuple[float, float]
FULL_TURN = 2 * math.pi
SAMPLES = 8
NOTHING = 1e-9


@dataclass(frozen=True)
class Origin:
    """The entity of the drawing that a piece comes from."""

    kind: str
    handle: str
    layer: str

    def __str__(self) -> str:
        """As messages name it."""
        return _("{kind} {handle} on layer {layer}").format(
            kind=self.kind, handle=self.handle, layer=self.layer
        )


@dataclass(frozen=True)
class Segment:
    """A line, or an arc around `center`, from `start` to `end`."""

    start: Point
    end: Point
    origin: Origin
    center: Point | None = None
    clockwise: bool = False

    @property
    def radius(self) -> float:
        """The arc's radius; 0 for a line."""
        return math.dist(self.start, self.center) if self.center else 0.0

    @property
    def sweep(self) -> float:
        """The angle that the arc turns, 0 to a full turn; 0 for a line."""
        if self.center is None:
            return 0.0
        first, last = angle(self.center, self.start), angle(self.center, self.end)
        return (first - last if self.clockwise else last - first) % FULL_TURN

    @property
    def length(self) -> float:
        """How long the path is."""
        return self.radius * self.sweep if self.center else math.dist(self.start, self.end)

    def point(self, fraction: float) -> Point:
        """The place after `fraction` (0 to 1) of the path."""
        if self.center is None or fraction in (0.0, 1.0):
            if fraction in (0.0, 1.0):
                return self.end if fraction else self.start
            (x0, y0), (x1, y1) = self.start, self.end
            return x0 + (x1 - x0) * fraction, y0 + (y1 - y0) * fraction
        turned = self.sweep * fraction * (-1 if self.clockwise else 1)
        at = angle(self.center, self.start) + turned
        return around(self.center, self.radius, at)

    def samples(self, count: int = SAMPLES) -> list[Point]:
        """`count` + 1 places evenly along the path, the ends among them."""
        return [self.point(index / count) for index in range(count + 1)]

    def reversed(self) -> "Segment":
        """The same path from its end to its start."""
        return replace(self, start=self.end, end=self.start, clockwise=not self.clockwise)

    def cut(self, fractions: Iterable[float]) -> "list[Segment]":
        """The pieces between `fractions` of the path; those at its ends cut nothing."""
        least = NOTHING / max(self.length, NOTHING)
        inside = sorted(place for place in fractions if least < place < 1 - least)
        corners = [self.start, *(self.point(place) for place in inside), self.end]
        return [replace(self, start=start, end=end) for start, end in pairwise(corners)]

    def at_angles(self, *angles: float) -> list[float]:
        """The fractions of the path where the arc passes `angles` around its centre."""
        assert self.center is not None
        sign = -1 if self.clockwise else 1
        first = angle(self.center, self.start)
        turned = [(sign * (wanted - first)) % FULL_TURN for wanted in angles]
        return [turn / self.sweep for turn in turned if turn < self.sweep]

    def across(self, level: float) -> list[float]:
        """The fractions of the path where y is `level`."""
        if self.center is None:
            low, high = self.start[1] - level, self.end[1] - level
            return [low / (low - high)] if low * high < 0 else []
        height = level - self.center[1]
        if abs(height) >= self.radius:
            return []
        at = math.asin(height / self.radius)
        return self.at_angles(at, math.pi - at)

    def along(self, place: float) -> list[float]:
        """The fractions of the path where x is `place`."""
        if self.center is None:
            low, high = self.start[0] - place, self.end[0] - place
            return [low / (low - high)] if low * high < 0 else []
        offset = place - self.center[0]
        if abs(offset) >= self.radius:
            return []
        at = math.acos(offset / self.radius)
        return self.at_angles(at, -at)

    def distance(self, place: Point) -> float:
        """How far `place` is from the path."""
        if self.center is not None:
            turned = self.at_angles(angle(self.center, place))
            if turned:
                return abs(math.dist(place, self.center) - self.radius)
            return min(math.dist(place, self.start), math.dist(place, self.end))
        (x0, y0), (x1, y1) = self.start, self.end
        dx, dy = x1 - x0, y1 - y0
        square = dx * dx + dy * dy
        share = ((place[0] - x0) * dx + (place[1] - y0) * dy) / square if square else 0.0
        return math.dist(place, self.point(min(1.0, max(0.0, share))))

    def moved(self, start: Point, end: Point) -> "Segment":
        """The same piece with other ends close by; the centre of an arc follows them."""
        if self.center is None or (start, end) == (self.start, self.end):
            return replace(self, start=start, end=end)
        chord = math.dist(start, end)
        if chord < NOTHING:
            return replace(self, start=start, end=end)
        middle = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
        normal = (start[1] - end[1]) / chord, (end[0] - start[0]) / chord
        offset = (self.center[0] - middle[0]) * normal[0]
        offset += (self.center[1] - middle[1]) * normal[1]
        center = middle[0] + normal[0] * offset, middle[1] + normal[1] * offset
        return replace(self, start=start, end=end, center=center)

    def mapped(self, function: Callable[[Point], Point], mirrored: bool) -> "Segment":
        """The piece with every place put through `function`, which keeps circles."""
        center = function(self.center) if self.center else None
        return Segment(
            function(self.start),
            function(self.end),
            self.origin,
            center,
            self.clockwise != mirrored,
        )


def angle(center: Point, place: Point) -> float:
    """The direction from `center` to `place`."""
    return math.atan2(place[1] - center[1], place[0] - center[0])


def around(center: Point, radius: float, at: float) -> Point:
    """The place on a circle in direction `at`."""
    return center[0] + radius * math.cos(at), center[1] + radius * math.sin(at)


def bulged(start: Point, end: Point, bulge: float, origin: Origin) -> Segment:
    """A side of a polyline: `bulge` is the tangent of a quarter of the arc's angle.

    It is positive when the arc runs counterclockwise, 0 for a line.
    """
    if abs(bulge) < NOTHING:
        return Segment(start, end, origin)
    middle = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    height = (1 - bulge * bulge) / (4 * bulge)
    center = (
        middle[0] - (end[1] - start[1]) * height,
        middle[1] + (end[0] - start[0]) * height,
    )
    return Segment(start, end, origin, center, bulge < 0)


def steady(segment: Segment) -> list[Segment]:
    """The pieces of an arc between its leftmost and rightmost places: x never turns in one."""
    if segment.center is None:
        return [segment]
    return segment.cut(segment.at_angles(0.0, math.pi))
