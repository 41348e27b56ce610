# SPDX-License-Identifier: Apache-2.0
"""The wanted surface: at every z the lowest of all that is to be cut, with walls at shoulders."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise

from .shape import TINY, Line, Point, Segment, meetings

STOCK = -1


@dataclass(frozen=True)
class Cut:
    """A segment that operation ``owner`` cuts down to; ``STOCK`` is the raw bar."""

    segment: Segment
    owner: int

    @property
    def low(self) -> float:
        """The end nearer to the chuck, z in steps."""
        return min(self.segment.start.z, self.segment.end.z)

    @property
    def high(self) -> float:
        """The end nearer to the free end, z in steps."""
        return max(self.segment.start.z, self.segment.end.z)

    def between(self, low: float, high: float) -> Cut:
        """Return the part of it between two z."""
        ends = [Point(z, self.segment.radius_at(z)) for z in (high, low)]
        return Cut(self.segment.between(*ends), self.owner)


class Contour:
    """The lowest of all ``cuts`` along a bar.

    Everything is in steps: ``radius`` of the bar, which reaches from ``back`` to ``front``.
    """

    def __init__(self, cuts: Iterable[Cut], radius: float, back: float, front: float) -> None:
        """Work out which cut is the lowest where."""
        bar = Cut(Line(Point(front, radius), Point(back, radius)), STOCK)
        self.back, self.front = back, front
        self.pieces = _lowest([bar, *(cut for cut in cuts if cut.high - cut.low > TINY)])
        self._lows = [piece.low for piece in self.pieces]
        self._outline = list(self._with_walls())
        self._outline_lows = [segment.end.z for segment in self._outline]
        self._longest = max(s.start.z - s.end.z for s in self._outline)

    def _with_walls(self) -> Iterator[Segment]:
        """Yield the pieces and the walls between them."""
        for piece, then in pairwise(self.pieces):
            yield piece.segment
            if abs(piece.segment.start.x - then.segment.end.x) > TINY:
                yield Line(then.segment.end, piece.segment.start)
        last = self.pieces[-1].segment
        yield last
        yield Line(Point(last.start.z, 0.0), last.start)

    def both_sides(self, z: float) -> tuple[float, float]:
        """Return the radius just behind and just in front of a place; 0 outside of the bar."""
        if not self.back <= z <= self.front:
            return 0.0, 0.0
        behind = self.pieces[max(0, bisect_left(self._lows, z - TINY) - 1)]
        ahead = self.pieces[max(0, bisect_right(self._lows, z + TINY) - 1)]
        return behind.segment.radius_at(z), ahead.segment.radius_at(z)

    def radius_at(self, z: float) -> float:
        """Return the radius at a place, at a shoulder the smaller one; 0 outside of the bar."""
        return min(self.both_sides(z))

    def owner_at(self, z: float) -> int:
        """Return the operation that makes the surface at a place; ``STOCK`` if none does."""
        index = max(0, bisect_right(self._lows, z) - 1)
        return self.pieces[index].owner if self.back <= z <= self.front else STOCK

    def sample(self, per_step: int) -> list[float]:
        """Return the radius at all places from back to front, ``per_step`` of them to a step."""
        count = round((self.front - self.back) * per_step) + 1
        radii = [math.inf] * count
        for piece in self.pieces:
            first = math.ceil((piece.low - self.back) * per_step - TINY)
            last = math.floor((piece.high - self.back) * per_step + TINY)
            for i in range(first, min(last, count - 1) + 1):
                z = self.back + i / per_step
                radii[i] = min(radii[i], piece.segment.radius_at(z))
        return radii

    def distance_to(self, place: Point, limit: float) -> float:
        """Return how far a place is from the contour, ``limit`` if that is nearer; in steps."""
        best = limit
        index = bisect_left(self._outline_lows, place.z - limit - self._longest)
        while index < len(self._outline) and self._outline_lows[index] <= place.z + best:
            segment = self._outline[index]
            if segment.start.z >= place.z - best:
                best = min(best, segment.distance_to(place))
            index += 1
        return best


def _lowest(cuts: list[Cut]) -> list[Cut]:
    """Return the lowest cuts from the chuck to the free end; the first one is the bar."""
    places: set[float] = set()
    for number, cut in enumerate(cuts):
        places.update((cut.low, cut.high))
        for other in cuts[:number]:
            if min(cut.high, other.high) - max(cut.low, other.low) > TINY:
                places.update(meetings(cut.segment, other.segment))
    inside = sorted(z for z in places if cuts[0].low <= z <= cuts[0].high)
    found: list[tuple[Cut, float, float]] = []
    low = inside[0]
    for high in inside[1:]:
        if high - low < TINY:
            continue
        middle = (low + high) / 2
        over = [cut for cut in cuts if cut.low < middle < cut.high]
        heights = [(cut.segment.radius_at(middle), -cut.owner) for cut in over]
        best = over[heights.index(min(heights))]
        if found and found[-1][0] is best:
            low = found.pop()[1]
        found.append((best, low, high))
        low = high
    return [cut.between(low, high) for cut, low, high in found]
