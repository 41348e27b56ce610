# SPDX-License-Identifier: Apache-2.0
"""How good a surface is: how deep it was cut into, and what was left standing on it.

Both are distances to the wanted contour, in steps: how much radius is wrong says nothing at a
steep wall. A corner that the drawing has between whole steps may be cut on either side of the
drawing, as far as the nearest whole step: an error counts only where it is one against the drawing
and against the drawing with its corners on whole steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .contour import STOCK
from .metal import PER_STEP, heights_above, reachable
from .shape import TINY, Point
from .tool import Tool
from .wanted import WantedPart

#: Columns to a step at which what is reachable is worked out.
COARSE = 4
#: A tool that comes so near (steps of radius) gets down to the wanted surface.
TOUCHED = 0.02


@dataclass(frozen=True)
class Surface:
    """What has become of the bar: radii in steps, a column every 1/16 step from ``first_z`` on."""

    first_z: int
    radii: list[float]

    @property
    def front(self) -> float:
        """The z of the foremost column."""
        return self.z_of(len(self.radii) - 1)

    def z_of(self, column: int) -> float:
        """Return where a column stands, in steps."""
        return self.first_z + column / PER_STEP

    def column(self, z: float) -> int:
        """Return the column nearest to a place, one at an end of the bar if it is outside."""
        return min(max(0, round((z - self.first_z) * PER_STEP)), len(self.radii) - 1)

    def radius_at(self, z: float) -> float:
        """Return the radius of the column nearest to a place."""
        return self.radii[self.column(z)]

    def over(self, first_z: int, front: int) -> Surface:
        """Return the surface between two places, with no metal where there is no bar."""
        before = max(0, self.first_z - first_z) * PER_STEP
        skipped = max(0, first_z - self.first_z) * PER_STEP
        radii = [0.0] * before + self.radii[skipped:]
        count = (front - first_z) * PER_STEP + 1
        return Surface(first_z, (radii + [0.0] * max(0, count - len(radii)))[:count])


def gouge(surface: Surface, wanted: WantedPart) -> float:
    """Return how deep the tool went into the wanted part at its worst, in steps."""
    contours = [wanted.contour(), wanted.contour(exact=True)]
    samples = [contour.sample(PER_STEP) for contour in contours]
    surface = surface.over(-wanted.length, wanted.front)
    depths = [min(wants) - radius for radius, *wants in zip(surface.radii, *samples, strict=True)]
    worst = 0.0
    for column in _deepest_first(depths):
        if depths[column] <= worst:
            break
        place = Point(surface.z_of(column), surface.radii[column])
        found = (
            contour.distance_to(place, sample[column] - place.x)
            for contour, sample in zip(contours, samples, strict=True)
        )
        worst = max(worst, min(found))
    return round(worst, 6)


def _deepest_first(depths: Sequence[float]) -> list[int]:
    columns = (column for column, depth in enumerate(depths) if depth > TINY)
    return sorted(columns, key=lambda column: -depths[column])


class Reach:
    """What the tools of a part can make of it, 4 columns to a step."""

    def __init__(self, wanted: WantedPart) -> None:
        """Work out the wanted surface; that of each tool is worked out when it is asked for."""
        self._wanted = wanted
        self._first_z = -wanted.length
        self._contour = wanted.contour()
        exact = wanted.contour(exact=True).sample(COARSE)
        nearest = self._contour.sample(COARSE)
        self._surface = [max(both) for both in zip(nearest, exact, strict=True)]
        self._reached: dict[Tool, list[float]] = {}

    def z_of(self, column: int) -> float:
        """Return where a column stands, in steps."""
        return self._first_z + column / COARSE

    def _of(self, owner: int) -> list[float]:
        tool = self._wanted.tool_of(self._wanted.operations[owner])
        if tool not in self._reached:
            self._reached[tool] = reachable(tool, self._surface, COARSE)
        return self._reached[tool]

    def target(self) -> list[float]:
        """Return the surface that every operation can make with its tool, infinite elsewhere."""
        target = []
        for column in range(len(self._surface)):
            owner = self._contour.owner_at(self.z_of(column))
            target.append(float("inf") if owner == STOCK else self._of(owner)[column])
        return target

    def is_reached(self, owner: int, z: float) -> bool:
        """Whether the tool of an operation gets down to the wanted surface at a place."""
        column = round((z - self._first_z) * COARSE)
        return self._of(owner)[column] - self._surface[column] < TOUCHED


def left(surface: Surface, wanted: WantedPart) -> float:
    """Return how thick the metal is at its worst that its tool could have taken off, in steps."""
    target = Reach(wanted).target()
    radii = surface.over(-wanted.length, wanted.front).radii[:: PER_STEP // COARSE]
    heights = [radius - low for radius, low in zip(radii, target, strict=True)]
    order = _deepest_first(heights)
    above = heights_above(target, COARSE, ((column, radii[column]) for column in order))
    worst = 0.0
    for column in order:
        if heights[column] <= worst:
            break
        worst = max(worst, next(above))
    return round(worst, 6)
