# SPDX-License-Identifier: Apache-2.0
"""Leads a tool by hand, for tests that need no chip."""

from __future__ import annotations

import math

from .chip import CYCLES_PER_SECOND
from .machine import Move
from .workpiece import Workpiece

FEED, RAPID = 500.0, 1000.0


class Driver:
    """Moves the slides in straight lines; places are those of the first tool's tip, in steps."""

    def __init__(self, work: Workpiece, x: float, z: float) -> None:
        """Begin at radius ``x`` and ``z``."""
        self.work, self.x, self.z = work, x, z
        self.cycle = 1_000_000
        self._go(x, z)

    def _go(self, x: float, z: float) -> None:
        place = Move(
            self.cycle, round(2 * (x + self.work.zero_x)), round(2 * (z + self.work.zero_z))
        )
        self.work.cut([place])
        self.x, self.z = x, z

    def to(self, x: float, z: float, rate: float = FEED) -> None:
        """Move straight to a place at a rate in steps/s."""
        way = math.hypot(x - self.x, z - self.z)
        self.cycle += round(way / rate * CYCLES_PER_SECOND) + 1
        self._go(x, z)

    def along(self, *places: tuple[float, float]) -> None:
        """Move from place to place, (x, z) each, at feed."""
        for x, z in places:
            self.to(x, z)
