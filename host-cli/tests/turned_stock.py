# SPDX-License-Identifier: Apache-2.0
"""A turned bar, cut by moves one after the other: what planning is judged by.

Knows nothing of contours or plans. The radius left is kept halfway between every two whole z, so
that a move that ends at a whole z touches the one side or the other and never both.
"""

import math

from tornillo.image import SegmentKind
from tornillo.moves import Move


class CrashError(AssertionError):
    """A rapid has gone through material."""


class TurnedStock:
    """Raw stock from z = `front` to `back`; `width` is that of the tool."""

    def __init__(self, radius: int, front: int, back: int) -> None:
        """A raw bar."""
        self.back = back
        self.left = [float(radius)] * (front - back)
        self.width = 0

    def radius(self, z: float) -> float:
        """What is left around z, a half number; 0 in front of the stock."""
        index = math.floor(z) - self.back
        if index < 0:
            raise AssertionError(f"the tool is behind the stock, z = {z}")
        return self.left[index] if index < len(self.left) else 0.0

    def make(self, move: Move, facing: bool = False) -> float:
        """Make a move; returns how deep it has cut where it cut deepest.

        Across and `facing`, the body of the tool clears what stands in front of it, and the depth
        is a length of z. Raises CrashError when a rapid meets material.
        """
        if move.dz == 0:
            return self._face(move) if facing and not move.rapid else self._across(move)
        deepest = 0.0
        behind = [max(move.start[0], move.end[0]) + k + 0.5 for k in range(self.width)]
        for z in halves(move) + behind:
            x = height(move, z) if z not in behind else min(move.start[1], move.end[1])
            deepest = max(deepest, self._lower(z, x, move))
        return deepest

    def _across(self, move: Move) -> float:
        z, low = move.start[0], min(move.start[1], move.end[1])
        if self.width:
            body = (z + k + 0.5 for k in range(self.width))
            return max(self._lower(place, low, move) for place in body)
        # Along a shoulder the tool may slide; inside the material there is something on both sides.
        if move.rapid and min(self.radius(z - 0.5), self.radius(z + 0.5)) > low:
            raise CrashError(f"{move} goes through material")
        return 0.0

    def _face(self, move: Move) -> float:
        z, low = move.start[0], min(move.start[1], move.end[1])
        front = [z + k + 0.5 for k in range(len(self.left) + self.back - z)]
        cut = [place for place in front if self._lower(place, low, move)]
        return max(cut) + 0.5 - z if cut else 0.0

    def _lower(self, z: float, x: float, move: Move) -> float:
        before = self.radius(z)
        if before <= x:
            return 0.0
        if move.rapid:
            raise CrashError(f"{move} meets {before} at z = {z}, x = {x}")
        self.left[math.floor(z) - self.back] = x
        return before - x


def halves(move: Move) -> list[float]:
    """Every half z that a move passes, in order."""
    first, last = move.start[0], move.end[0]
    if first > last:
        return [z - 0.5 for z in range(first, last, -1)]
    return [z + 0.5 for z in range(first, last)]


def height(move: Move, z: float) -> float:
    """The radius at which a move passes z."""
    (zs, xs), (ze, xe) = move.start, move.end
    if move.kind is SegmentKind.LINE:
        return xs + (xe - xs) * (z - zs) / (ze - zs)
    zc, xc = zs + move.cz / 256, xs + move.cx / 256
    radius = math.hypot(move.cz, move.cx) / 256
    rise = math.sqrt(max(0.0, radius * radius - (z - zc) ** 2))
    return xc + rise if move.kind is SegmentKind.CONVEX else xc - rise
