# SPDX-License-Identifier: Apache-2.0
"""The piece of metal in the chuck and the tool that cuts it.

The surface is a radius for every step of Z (a point, not a slice). The tool is an ideal point with
a body ``tool_width`` steps wide behind it, away from the chuck: whatever stands there higher than
the point is removed as well. Material cut through to the axis falls off. Inside, radii are half
steps, so that half-step motors are exact.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from .chip import CYCLES_PER_SECOND
from .machine import Move
from .part import Cylinder, Face, WantedPart

SAME_CRASH_S = 0.1
BEYOND_AXIS_STEPS = 5


@dataclass(frozen=True)
class Crash:
    """A collision; ``z`` in steps from part zero, ``x`` radius in steps, ``rate`` in steps/s."""

    kind: str
    seconds: float
    x: float
    z: float
    rate: float

    def as_dict(self) -> dict[str, Any]:
        """Return the crash for the report."""
        return dict(vars(self))


@dataclass
class Stock:
    """Raw material in steps: radius, length in front of the chuck, allowance beyond z = 0."""

    radius: int
    length: int
    allowance: int = 0
    chuck_radius: int = 0


@dataclass
class Workpiece:
    """Stock being cut.

    Args:
        stock: the raw material.
        zero_x: machine X of the spindle axis; ``zero_z``: machine Z of part zero, in steps.
        cut_rate_limit: a tool that removes metal faster than this (steps/s) has crashed.
    """

    stock: Stock
    zero_x: int = -3575
    zero_z: int = -8000
    cut_rate_limit: float = 900.0
    tool_width: int = 200
    crashes: list[Crash] = field(default_factory=list)
    steps_cutting: int = 0

    def __post_init__(self) -> None:
        self.first_z = -self.stock.length
        count = self.stock.length + self.stock.allowance + 1
        self.radii = [2 * self.stock.radius] * count
        # Highest radius from each point on towards the free end: one look tells that a tool
        # touches nothing.
        self._highest = list(self.radii)
        self._last_cycle = 0
        self._crash_cycles: dict[str, int] = {}
        self.chuck_radius = self.stock.chuck_radius or self.stock.radius + 1500

    def radius_at(self, z: int) -> float:
        """Return the radius in steps at ``z`` steps from part zero; 0 outside the material."""
        index = z - self.first_z
        return self.radii[index] / 2 if 0 <= index < len(self.radii) else 0.0

    def cut(self, moves: Iterable[Move]) -> None:
        """Let the tool follow movements of the slides."""
        for move in moves:
            x = move.x - 2 * self.zero_x
            z = (move.z - 2 * self.zero_z) / 2
            rate = CYCLES_PER_SECOND / max(1, move.cycle - self._last_cycle)
            self._last_cycle = move.cycle
            self._tool_at(move.cycle, x, z, rate)

    def _tool_at(self, cycle: int, x: int, z: float, rate: float) -> None:
        index = int(z // 1) - self.first_z
        if z < self.first_z:
            if x < 2 * self.chuck_radius:
                self._crash("chuck", cycle, x, z, rate)
            return
        if index >= len(self.radii) or self._highest[index] <= x:
            return
        if x < -2 * BEYOND_AXIS_STEPS:
            self._crash("beyond the axis", cycle, x, z, rate)
        if z != index + self.first_z:
            index += 1
        if self._remove(index, max(x, 0)):
            self.steps_cutting += 1
            if rate > self.cut_rate_limit:
                self._crash("rapid into material", cycle, x, z, rate)

    def _remove(self, index: int, x: int) -> bool:
        removed = False
        last = len(self.radii) if x == 0 else min(len(self.radii), index + self.tool_width + 1)
        for i in range(index, last):
            if self._highest[i] <= x:
                break
            if self.radii[i] > x:
                self.radii[i] = x
                removed = True
        if removed:
            self._update_highest(index, last - 1)
        return removed

    def _update_highest(self, first: int, last: int) -> None:
        above = self._highest[last + 1] if last + 1 < len(self.radii) else 0
        for i in range(last, -1, -1):
            above = max(above, self.radii[i])
            if self._highest[i] == above and i < first:
                break
            self._highest[i] = above

    def _crash(self, kind: str, cycle: int, x: int, z: float, rate: float) -> None:
        last = self._crash_cycles.get(kind)
        self._crash_cycles[kind] = cycle
        if last is not None and cycle - last < SAME_CRASH_S * CYCLES_PER_SECOND:
            return
        self.crashes.append(Crash(kind, cycle / CYCLES_PER_SECOND, x / 2, z, round(rate, 1)))

    # -- measuring --------------------------------------------------------------------------------

    def profile(self, step_x_nm: int, step_z_nm: int) -> list[list[float]]:
        """Return ``[z_mm, diameter_mm]`` from the chuck to the free end.

        Points between two neighbours of the same diameter are left out.
        """
        points: list[list[float]] = []
        for i, radius in enumerate(self.radii):
            inner = 0 < i < len(self.radii) - 1
            if inner and self.radii[i - 1] == radius == self.radii[i + 1]:
                continue
            z = (i + self.first_z) * step_z_nm / 1e6
            points.append([round(z, 6), round(radius * step_x_nm / 1e6, 6)])
        return points

    def gouge_max_steps(self, wanted: WantedPart) -> float:
        """Return how far the surface lies below the wanted one at its worst, in steps."""
        surface = wanted.surface()
        return max((max(0.0, want - self.radius_at(z)) for z, want in surface.items()), default=0.0)

    def face_position(self, inner: int) -> int:
        """Return the z (steps) of the end face outside radius ``inner``."""
        for i in range(len(self.radii) - 1, -1, -1):
            if self.radii[i] > 2 * inner:
                return i + self.first_z + 1
        return self.first_z

    def dimensions(
        self, wanted: WantedPart, step_x_nm: int, step_z_nm: int
    ) -> list[dict[str, Any]]:
        """Compare every operation with what was cut; errors in steps, + is too much metal."""
        surface = wanted.surface()
        found: list[dict[str, Any]] = []
        numbers = {"face": 0, "cylinder": 0}
        for operation in wanted.operations:
            kind = "face" if isinstance(operation, Face) else "cylinder"
            numbers[kind] += 1
            name = f"{kind} {numbers[kind]}"
            if isinstance(operation, Face):
                z = self.face_position(operation.inner)
                found.append(_dimension(f"{name} z", operation.drawn.length, z, step_z_nm / 1e6))
            else:
                found += self._cylinder(name, operation, surface, step_x_nm, step_z_nm)
        return found

    def _cylinder(
        self,
        name: str,
        cylinder: Cylinder,
        surface: dict[int, int],
        step_x_nm: int,
        step_z_nm: int,
    ) -> list[dict[str, Any]]:
        own = [
            z for z in range(cylinder.end, cylinder.start + 1) if surface.get(z) == cylinder.radius
        ]
        if not own:
            return []
        radius = max((self.radius_at(z) for z in own), key=lambda r: abs(r - cylinder.radius))
        measured = _dimension(
            f"{name} diameter", cylinder.drawn.radius, radius, 2 * step_x_nm / 1e6
        )
        end = cylinder.end
        if surface.get(end - 1, 0) > cylinder.radius:
            half_way = (self.stock.radius + cylinder.radius) / 2
            wall = min(half_way, surface[end - 1] - 0.5)
            shoulder = own[-1]
            while shoulder > self.first_z and self.radius_at(shoulder - 1) < wall:
                shoulder -= 1
            end = shoulder
        cut = cylinder.start - end
        length = _dimension(f"{name} length", cylinder.drawn.length, cut, step_z_nm / 1e6)
        return [measured, length]


def _dimension(name: str, wanted: float, cut: float, mm: float) -> dict[str, Any]:
    return {
        "name": name,
        "wanted_mm": round(wanted * mm, 6),
        "cut_mm": round(cut * mm, 6),
        "error_steps": round(cut - wanted, 3),
    }
