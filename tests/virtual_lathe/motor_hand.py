# SPDX-License-Identifier: Apache-2.0
"""Turns a motor by writing the coil latches, for tests without firmware."""

from __future__ import annotations

from .chip import Chip
from .machine import AxisName, AxisOptions, AxisState, Machine

LATD, TRISD, TRISB, INTCON2 = 0xF8C, 0xF95, 0xF93, 0xFF1
FORWARD = (5, 9, 10, 6)
SLOW = 1 / 500


class Hand:
    """Turns the X motor step by step."""

    def __init__(self, firmware: str, x: AxisOptions, z: int = -900) -> None:
        """Switch on with axis X as given, Z at a place, and the X coils on pattern 5."""
        self.chip = Chip(firmware)
        self.machine = Machine(x, AxisOptions(start=z, travel=16072))
        self.chip.run(1e-4)
        self.chip.write(INTCON2, self.chip.peek(INTCON2) & 0x7F)
        self.chip.write(TRISB, 0xF0)
        self.chip.write(TRISD, 0xF0)
        self.phase = 0
        self.set(FORWARD[0])

    def set(self, pattern: int, seconds: float = SLOW) -> None:
        """Write a coil pattern and wait."""
        self.chip.write(LATD, pattern)
        self.chip.run(seconds)

    def step(self, count: int, ring: tuple[int, ...] = FORWARD, seconds: float = SLOW) -> None:
        """Turn by ``count`` entries of the ring."""
        for _ in range(abs(count)):
            self.phase += 1 if count > 0 else -1
            self.set(ring[self.phase % len(ring)], seconds)

    @property
    def x(self) -> AxisState:
        """The truth about X."""
        return self.machine.axis(AxisName.X)

    @property
    def pressed(self) -> int:
        """Level of the X switch's pin."""
        return self.chip.level("RB4")
