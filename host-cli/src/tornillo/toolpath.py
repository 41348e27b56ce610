# SPDX-License-Identifier: Apache-2.0
"""Where the tool is while a plan is made, and the moves it has made since."""

from tornillo.image import unpack_segments
from tornillo.moves import Move


class Toolpath:
    """Collects moves; one that leads nowhere is left out. Positions in steps of the part."""

    def __init__(self, z: int, x: int, clear: int) -> None:
        """The tool stands at (z, x); radius `clear` is outside the stock."""
        self.z = z
        self.x = x
        self.clear = clear
        self._first = False
        self._moves: list[Move] = []

    def stand(self, z: int, x: int) -> None:
        """The same place is now called (z, x), because another tool is meant."""
        self.z, self.x = z, x

    def take(self) -> tuple[Move, ...]:
        """The moves since the last time."""
        moves, self._moves = tuple(self._moves), []
        return moves

    def begin_operation(self) -> None:
        """The next move along Z is made outside the stock."""
        self._first = True

    def _go(self, z: int, x: int, feed: int) -> None:
        if (z, x) != (self.z, self.x):
            self._moves.append(Move((self.z, self.x), (z, x), feed))
            self.z, self.x = z, x

    def rapid(self, z: int, x: int) -> None:
        """Both axes at once through air."""
        self._go(z, x, 0)

    def rapid_x(self, x: int) -> None:
        """X through air."""
        self._go(self.z, x, 0)

    def rise(self, x: int) -> None:
        """X outwards to `x`, unless it is out there already, or will be before it goes along."""
        if not self._first and self.x < x:
            self.rapid_x(x)

    def sink(self, x: int) -> None:
        """X inwards to `x` through air, unless it is farther in already."""
        if self.x > x:
            self.rapid_x(x)

    def rapid_z(self, z: int) -> None:
        """Z through air; the first time in an operation outside the stock.

        Where the tool is farther out than that, both axes move at once.
        """
        if self._first:
            self._first = False
            if self.x < self.clear:
                self.rapid_x(self.clear)
            self.rapid(z, self.clear)
        else:
            self.rapid(z, self.x)

    def feed_x(self, x: int, feed: int) -> None:
        """X at a feed, 1/8 step/s."""
        self._go(self.z, x, feed)

    def feed_z(self, z: int, feed: int) -> None:
        """Z at a feed, 1/8 step/s."""
        self._go(z, self.x, feed)

    def follow(self, segments: bytes, feed: int) -> None:
        """The segments of a contour from here on, at a feed, 1/8 step/s along them."""
        for segment in unpack_segments(segments):
            start = self.z, self.x
            self.z, self.x = self.z + segment.dz, self.x + segment.dx
            kind, cz, cx = segment.kind, segment.cz, segment.cx
            self._moves.append(Move(start, (self.z, self.x), feed, kind, cz, cx))
