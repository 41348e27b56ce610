# SPDX-License-Identifier: Apache-2.0
"""Measures what an operation has left, and compares it with what the drawing says.

Only places count that the operation makes the surface of and that its tool gets down to. Errors
are in steps (of radius or of Z), + is too much metal, and include the rounding to whole steps.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from .contour import Contour
from .fitting import fit_circle, fit_line
from .judgement import COARSE, Reach, Surface
from .metal import PER_STEP
from .shape import TINY, Arc, Line, Point, Segment, distance
from .wanted import Cylinder, Face, Groove, Operation, PartOff, Turned, WantedPart

#: A wall is looked for below its upper edge by this part of its height, but half a step at least.
BELOW_EDGE = 0.1
#: So much at the ends of a segment is not looked at, unless it is too short.
EDGE_STEPS = 2
#: A sloped line or an arc needs that many columns to be measured.
ENOUGH = 3

Entry = dict[str, Any]


class Ruler:
    """Measures a surface against a wanted part; the step sizes give millimetres."""

    def __init__(
        self, surface: Surface, wanted: WantedPart, step_x_nm: int, step_z_nm: int
    ) -> None:
        """Take the part in hand."""
        self._surface = surface.over(-wanted.length, wanted.front)
        self._wanted = wanted
        self._contour: Contour = wanted.contour()
        self._reach = Reach(wanted)
        self._mm_x, self._mm_z = step_x_nm / 1e6, step_z_nm / 1e6

    def dimensions(self) -> list[Entry]:
        """Return ``{name, wanted_mm, cut_mm, error_steps}`` of everything that can be measured."""
        return [entry for _, entries in self._measured() for entry in entries]

    def _measured(self) -> Iterator[tuple[str, list[Entry]]]:
        for owner, name in self._names():
            operation = self._wanted.operations[owner]
            if isinstance(operation, Face):
                yield name, [self._face(name, operation)]
            elif isinstance(operation, Cylinder):
                yield name, self._cylinder(owner, name, operation)
            elif isinstance(operation, Turned):
                for part, segment in self._segments(name, operation):
                    yield part, self._segment(owner, part, segment)
            elif isinstance(operation, Groove):
                yield name, self._groove(owner, name, operation)
            elif isinstance(operation, PartOff):
                yield name, [self._part_off(name, operation)]

    def _names(self) -> Iterator[tuple[int, str]]:
        numbers: dict[str, int] = {}
        for owner, operation in enumerate(self._wanted.operations):
            kind = _kind(operation)
            numbers[kind] = numbers.get(kind, 0) + 1
            yield owner, f"{kind} {numbers[kind]}"

    @staticmethod
    def _segments(name: str, operation: Turned) -> Iterator[tuple[str, Segment]]:
        if len(operation.chain) == 1 and operation.kind != "profile":
            yield name, operation.chain[0]
            return
        for number, segment in enumerate(operation.chain, 1):
            kind = "arc" if isinstance(segment, Arc) else "line"
            yield f"{name} {kind} {number}", segment

    # -- entries ----------------------------------------------------------------------------------

    def _diameter(self, name: str, wanted: float, cut: float) -> Entry:
        return _entry(name, wanted, cut, 2 * self._mm_x)

    def _length(self, name: str, wanted: float, cut: float) -> Entry:
        return _entry(name, wanted, cut, self._mm_z)

    # -- looking ----------------------------------------------------------------------------------

    def _own(self, owner: int, segment: Segment) -> list[Point]:
        """Return the measured points that belong to a segment, from the chuck on.

        The last steps at either end may be a steep wall already, where radii mean nothing.
        """
        low, high = sorted((segment.start.z, segment.end.z))
        if high - low > 4 * EDGE_STEPS:
            low, high = low + EDGE_STEPS, high - EDGE_STEPS
        points = []
        grid = segment.on_grid()
        for i in range(math.ceil(low * COARSE), math.floor(high * COARSE) + 1):
            z = i / COARSE
            visible = abs(self._contour.radius_at(z) - grid.radius_at(z)) < 1 / PER_STEP
            if visible and self._reach.is_reached(owner, z):
                points.append(Point(z, self._surface.radius_at(z)))
        return points

    def _wall(self, z: float, height: float, direction: int) -> float:
        """Return how far metal lower than ``height`` reaches from ``z`` on, in steps of Z."""
        radii, column = self._surface.radii, self._surface.column(z)
        while 0 <= column + direction < len(radii) and radii[column + direction] < height:
            column += direction
        return self._surface.z_of(column)

    def _front_of(self, radius: float, radii: list[float]) -> float:
        """Return the z up to which metal thicker than a radius reaches."""
        thick = (column for column in reversed(range(len(radii))) if radii[column] > radius)
        return self._surface.z_of(min(next(thick, -1) + 1, len(radii) - 1))

    @staticmethod
    def _below_edge(low: float, high: float) -> float:
        return high - min((high - low) / 2, max(0.5, BELOW_EDGE * (high - low)))

    # -- operations -------------------------------------------------------------------------------

    def _face(self, name: str, face: Face) -> Entry:
        thick = face.drawn.radius + 0.5
        front = self._front_of(thick, self._surface.radii)
        behind, _ = self._contour.both_sides(face.z)
        if behind <= thick:
            # A later operation has turned the end to a point, which is thin by itself.
            front += face.drawn.length - self._front_of(thick, self._contour.sample(PER_STEP))
        return self._length(f"{name} z", face.drawn.length, front)

    def _cylinder(self, owner: int, name: str, cylinder: Cylinder) -> list[Entry]:
        ends = (Point(z, float(cylinder.radius)) for z in (cylinder.start, cylinder.end))
        own = self._own(owner, Line(*ends))
        if not own:
            return []
        end = float(cylinder.end)
        behind, _ = self._contour.both_sides(end)
        if behind > cylinder.radius + TINY:
            height = self._below_edge(cylinder.radius, behind)
            uncut = own[-1].x >= height
            end = float(cylinder.start) if uncut else self._wall(own[-1].z, height, -1)
        radius = _farthest([p for p in own if p.z >= end] or own, cylinder.radius)
        length = cylinder.start - end
        return [
            self._diameter(f"{name} diameter", cylinder.drawn.radius, radius),
            self._length(f"{name} length", cylinder.drawn.length, length),
        ]

    def _groove(self, owner: int, name: str, groove: Groove) -> list[Entry]:
        bottom = Line(Point(groove.start, groove.radius), Point(groove.end, groove.radius))
        own = self._own(owner, bottom.on_grid())
        if not own:
            return []
        middle = own[len(own) // 2].z
        grid = bottom.on_grid()
        behind, _ = self._contour.both_sides(grid.end.z)
        _, ahead = self._contour.both_sides(grid.start.z)
        back = self._wall(middle, self._below_edge(groove.radius, behind), -1)
        front = self._wall(middle, self._below_edge(groove.radius, ahead), 1)
        inside = [p for p in own if back <= p.z <= front]
        bottom_radius = _farthest(inside or own, groove.radius)
        return [
            self._diameter(f"{name} diameter", groove.radius, bottom_radius),
            self._length(f"{name} width", groove.start - groove.end, front - back),
            self._length(f"{name} z", groove.start, front),
        ]

    def _part_off(self, name: str, cut: PartOff) -> Entry:
        back = math.floor(cut.z + 0.5)
        _, ahead = self._contour.both_sides(back)
        height = self._below_edge(max(0.0, cut.radius), ahead)
        wall = self._wall(back - cut.width / 2, height, 1)
        front = self._front_of(0.0, self._surface.radii)
        wanted_front = max((p.high for p in self._contour.pieces if p.segment.end.x > 0), default=0)
        return self._length(f"{name} length", wanted_front - cut.z, front - wall)

    def _segment(self, owner: int, name: str, segment: Segment) -> list[Entry]:
        if abs(segment.start.z - segment.end.z) < 1:
            return self._step(name, segment)
        own = self._own(owner, segment)
        if len(own) < ENOUGH:
            return []
        if isinstance(segment, Arc):
            return self._arc(name, segment, own)
        if segment.start.x == segment.end.x:
            radius = _farthest(own, segment.start.x)
            return [self._diameter(f"{name} diameter", segment.start.x, radius)]
        at_zero, rise = fit_line(own)
        return [
            self._diameter(f"{name} {end} diameter", place.x, at_zero + rise * place.z)
            for end, place in (("start", segment.start), ("end", segment.end))
        ]

    def _step(self, name: str, segment: Segment) -> list[Entry]:
        """The z of a vertical line."""
        low, high = sorted((segment.start.x, segment.end.x))
        if high - low < 2:
            return []
        direction = -1 if segment.end.x > segment.start.x else 1
        wall = math.floor(segment.start.z + 0.5)
        from_z = wall - direction * 0.5
        return [
            self._length(
                f"{name} z",
                segment.start.z,
                self._wall(from_z, self._below_edge(low, high), direction),
            )
        ]

    def _arc(self, name: str, arc: Arc, own: list[Point]) -> list[Entry]:
        """The mean radius around the wanted centre, and the worst deviation from it."""
        outwards = 1 if arc.convex else -1
        weights = [min(10.0, arc.radius / max(0.1, abs(p.x - arc.centre.x))) for p in own]
        radii = [distance(p, arc.centre) for p in own]
        mean = sum(w * r for w, r in zip(weights, radii, strict=True)) / sum(weights)
        worst = max((outwards * (r - arc.radius) for r in radii), key=abs)
        return [
            _entry(f"{name} radius", arc.radius, mean, self._mm_z),
            _entry(f"{name} deviation", 0.0, worst, self._mm_z),
        ]

    # -- beside the dimensions --------------------------------------------------------------------

    def angles(self) -> list[Entry]:
        """Return ``{name, wanted_degrees, cut_degrees, error_steps}`` of cones and sloped lines.

        The error is how much more than wanted the radius changes from one end to the other.
        """
        return list(self._of_segments(self._angle))

    def circles(self) -> list[Entry]:
        """Return the circle nearest to every arc, centre and radius free.

        ``{name, wanted_radius_mm, radius_mm, centre_z_mm, centre_diameter_mm, centre_off_steps}``;
        of a short arc these are badly determined, however well it is cut.
        """
        return list(self._of_segments(self._circle))

    def _of_segments(
        self, measure: Callable[[str, Segment, list[Point]], Entry | None]
    ) -> Iterator[Entry]:
        for owner, name in self._names():
            operation = self._wanted.operations[owner]
            if not isinstance(operation, Turned):
                continue
            for part, segment in self._segments(name, operation):
                own = self._own(owner, segment)
                entry = measure(part, segment, own) if len(own) >= ENOUGH else None
                if entry is not None:
                    yield entry

    def _angle(self, name: str, segment: Segment, own: list[Point]) -> Entry | None:
        length = segment.start.z - segment.end.z
        if isinstance(segment, Arc) or length < 1 or segment.start.x == segment.end.x:
            return None
        slope = (segment.end.x - segment.start.x) / length
        _, rise = fit_line(own)
        scale = self._mm_x / self._mm_z
        return {
            "name": f"{name} angle",
            "wanted_degrees": round(math.degrees(math.atan(slope * scale)), 4),
            "cut_degrees": round(math.degrees(math.atan(-rise * scale)), 4),
            "error_steps": round((-rise - slope) * length, 3),
        }

    def _circle(self, name: str, segment: Segment, own: list[Point]) -> Entry | None:
        if not isinstance(segment, Arc):
            return None
        try:
            centre, radius = fit_circle(own, segment.centre, segment.radius)
        except ValueError:
            return None
        return {
            "name": name,
            "wanted_radius_mm": round(segment.radius * self._mm_z, 6),
            "radius_mm": round(radius * self._mm_z, 6),
            "centre_z_mm": round(centre.z * self._mm_z, 6),
            "centre_diameter_mm": round(2 * centre.x * self._mm_x, 6),
            "centre_off_steps": round(distance(centre, segment.centre), 3),
        }


def _farthest(points: list[Point], radius: float) -> float:
    """Return the measured radius that is farthest from the wanted one."""
    return max((p.x for p in points), key=lambda x: abs(x - radius))


def _kind(operation: Operation) -> str:
    if isinstance(operation, Turned):
        return operation.kind
    return "part-off" if isinstance(operation, PartOff) else type(operation).__name__.lower()


def _entry(name: str, wanted: float, cut: float, mm: float) -> Entry:
    return {
        "name": name,
        "wanted_mm": round(wanted * mm, 6),
        "cut_mm": round(cut * mm, 6),
        "error_steps": round(cut - wanted, 3),
    }
