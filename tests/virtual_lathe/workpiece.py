# SPDX-License-Identifier: Apache-2.0
"""The piece of metal in the chuck, the tool that cuts it, and what must not happen to them.

Whatever the nose, the edges or the body of the tool sweep is removed; see ``metal.py``. Between
two places the tool moves straight. Material cut through to the axis falls off.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import zip_longest
from typing import Any

from .chip import CYCLES_PER_SECOND
from .dimensions import Ruler
from .judgement import Surface, gouge, left
from .machine import Move
from .metal import PER_STEP, Metal, Removal
from .shape import Point, distance
from .tool import BROAD, SQUARE, Tool
from .wanted import WantedPart

SAME_CRASH_S = 0.1
BEYOND_AXIS_STEPS = 5
#: Steps of both slides this near to each other (cycles) are one step of the tool.
SAME_STEP_CYCLES = 100
#: The rate is that of the way over so many steps, so that a staircase has the rate of its slope.
RATE_STEPS = 4


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


@dataclass(frozen=True)
class Piece:
    """Metal that fell off: its first column and the radii of its columns."""

    first: int
    radii: list[float]


@dataclass
class Workpiece:
    """Stock being cut.

    Args:
        stock: the raw material.
        zero_x: machine X of the spindle axis; ``zero_z``: machine Z of part zero, in steps.
        cut_rate_limit: a tool that removes metal faster than this (steps/s) has crashed.
        tool: the tool in the holder at first.
    """

    stock: Stock
    zero_x: int = -3575
    zero_z: int = -8000
    cut_rate_limit: float = 900.0
    tool: Tool = BROAD
    crashes: list[Crash] = field(default_factory=list)
    steps_cutting: int = 0

    def __post_init__(self) -> None:
        self.first_z = -self.stock.length
        self.metal = Metal(self.stock.radius, self.first_z, self.stock.allowance, self.tool)
        self.pieces: list[Piece] = []
        self.chuck_radius = self.stock.chuck_radius or self.stock.radius + 1500
        self._slides: Point | None = None
        self._probe = False
        self._trail: deque[tuple[int, Point]] = deque(maxlen=RATE_STEPS)
        self._crash_cycles: dict[str, int] = {}

    def radius_at(self, z: float) -> float:
        """Return the radius in steps at ``z`` steps from part zero; 0 outside the material."""
        column = math.floor((z - self.first_z) * PER_STEP)
        return self.metal.radius(column) if 0 <= column < self.metal.count else 0.0

    # -- contact ----------------------------------------------------------------------------------

    def connect_probe(self) -> None:
        """Put the contact sensor between the work and the tool that is in the holder."""
        self._probe = True
        self.metal.connect_probe(self.zero_x + self.tool.offset_x, self.zero_z + self.tool.offset_z)

    # -- cutting ----------------------------------------------------------------------------------

    def change_tool(self, tool: Tool) -> None:
        """Put another tool into the holder, where the slides stand."""
        self.tool = tool
        self.metal.set_tool(tool)
        if self._probe:
            self.connect_probe()
        if self._slides is not None:
            tip = self._tip(self._slides)
            if self.metal.move(tip, tip, trial=True):
                cycle = self._trail[-1][0] if self._trail else 0
                self._crash("tool changed inside the material", cycle, tip, 0.0)

    def cut(self, moves: Iterable[Move]) -> None:
        """Let the tool follow movements of the slides.

        Of two slides that step at once only the place where both have arrived counts.
        """
        every = list(moves)
        for move, then in zip_longest(every, every[1:]):
            if then is None or then.cycle - move.cycle >= SAME_STEP_CYCLES:
                self._follow(move)
        if self._probe and every:
            self.metal.look_for_contact()

    def _follow(self, move: Move) -> None:
        slides = Point(move.z / 2 - self.zero_z, move.x / 2 - self.zero_x)
        rate = self._rate(move.cycle, slides)
        tip = self._tip(slides)
        start = tip if self._slides is None else self._tip(self._slides)
        self._slides = slides
        if self._is_in_chuck(tip):
            self._crash("chuck", move.cycle, tip, rate)
            return
        removal = self.metal.move(start, tip)
        if removal is not None:
            self.steps_cutting += 1
            self._judge(removal, move.cycle, tip, rate)

    def _tip(self, slides: Point) -> Point:
        return Point(slides.z - self.tool.offset_z, slides.x - self.tool.offset_x)

    def _rate(self, cycle: int, place: Point) -> float:
        """The speed of the tool in steps/s: of this step or of the last few, the slower one."""
        rates = (
            [
                distance(place, last) * CYCLES_PER_SECOND / max(1, cycle - then)
                for then, last in (self._trail[0], self._trail[-1])
            ]
            if self._trail
            else [0.0]
        )
        self._trail.append((cycle, place))
        return min(rates)

    def _is_in_chuck(self, tip: Point) -> bool:
        """Whether nose or edge touch the chuck; an edge ends at its length."""
        beyond = self.first_z - tip.z
        edge, _ = self.tool.edges
        if tip.x >= self.chuck_radius or (beyond <= 0 and edge >= SQUARE):
            return False
        lowest = 0.0 if beyond > self.tool.nose else self.tool.outline(beyond)
        return lowest <= self.tool.edge_length and tip.x + lowest < self.chuck_radius

    def _judge(self, removal: Removal, cycle: int, tip: Point, rate: float) -> None:
        if tip.x < -BEYOND_AXIS_STEPS - self.tool.nose:
            self._crash("beyond the axis", cycle, tip, rate)
        if rate > self.cut_rate_limit:
            self._crash("rapid into material", cycle, tip, rate)
        if removal.reach > self.tool.edge_length:
            self._crash("holder into material", cycle, tip, rate)
        if removal.severed is not None:
            self.pieces.append(Piece(removal.severed, self.metal.fallen()))

    def _crash(self, kind: str, cycle: int, tip: Point, rate: float) -> None:
        last = self._crash_cycles.get(kind)
        self._crash_cycles[kind] = cycle
        if last is not None and cycle - last < SAME_CRASH_S * CYCLES_PER_SECOND:
            return
        self.crashes.append(Crash(kind, cycle / CYCLES_PER_SECOND, tip.x, tip.z, round(rate, 1)))

    # -- measuring --------------------------------------------------------------------------------

    def surface(self, wanted: WantedPart | None = None) -> Surface:
        """Return what there is to measure; a part that was parted off is put back in its place."""
        radii = self.metal.radii()
        parted_at = wanted.parted_at() if wanted else None
        for piece in self.pieces if parted_at is not None else ():
            if piece.first / PER_STEP + self.first_z <= (parted_at or 0.0) + 1:
                radii[piece.first :] = piece.radii
        return Surface(self.first_z, radii)

    def profile(
        self, step_x_nm: int, step_z_nm: int, wanted: WantedPart | None = None
    ) -> list[list[float]]:
        """Return ``[z_mm, diameter_mm]`` from the chuck to the free end, at whole steps.

        Points between two neighbours of the same diameter are left out.
        """
        radii = self.surface(wanted).radii[::PER_STEP]
        points: list[list[float]] = []
        for i, radius in enumerate(radii):
            inner = 0 < i < len(radii) - 1
            if inner and radii[i - 1] == radius == radii[i + 1]:
                continue
            z = (i + self.first_z) * step_z_nm / 1e6
            points.append([round(z, 6), round(2 * radius * step_x_nm / 1e6, 6)])
        return points

    def gouge_max_steps(self, wanted: WantedPart) -> float:
        """Return how deep the tool went into the wanted part, in steps."""
        return gouge(self.surface(wanted), wanted)

    def left_max_steps(self, wanted: WantedPart) -> float:
        """Return how thick the metal is that the tools could have taken off, in steps."""
        return left(self.surface(wanted), wanted)

    def dimensions(
        self, wanted: WantedPart, step_x_nm: int, step_z_nm: int
    ) -> list[dict[str, Any]]:
        """Compare every operation with what was cut; errors in steps, + is too much metal."""
        return Ruler(self.surface(wanted), wanted, step_x_nm, step_z_nm).dimensions()
