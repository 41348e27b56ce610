# SPDX-License-Identifier: Apache-2.0
"""What a plan consists of: moves, the passes they belong to, and the stops in between.

All positions are (z, x) in steps of the part, x a radius, for the tool in use then. Feeds are
1/8 step/s along the path, as in the part image.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from tornillo.image import PartImage, SegmentKind

Place = tuple[int, int]


class Move(NamedTuple):
    """One segment as the chip queues it.

    `feed` is 0 for a rapid, which goes as fast as its axes can. (`cz`, `cx`) is the centre of an
    arc from its start, in 1/256 step.
    """

    start: Place
    end: Place
    feed: int = 0
    kind: SegmentKind = SegmentKind.LINE
    cz: int = 0
    cx: int = 0

    @property
    def rapid(self) -> bool:
        """Whether it is a rapid."""
        return self.feed == 0

    @property
    def dz(self) -> int:
        """Steps along Z."""
        return self.end[0] - self.start[0]

    @property
    def dx(self) -> int:
        """Steps along X."""
        return self.end[1] - self.start[1]


class Role(Enum):
    """What a pass is for."""

    ROUGHING = "roughing"
    FACING = "facing"
    SMOOTHING = "smoothing"
    FINISHING = "finishing"
    SPRING = "spring"
    PLUNGING = "plunging"


@dataclass(frozen=True)
class Pass:
    """One stroke with the way to it and off it.

    `operation` and `number` count from 1, the latter within the operation. `depth` is what the
    pass goes deeper than the one before it, in steps: X, or Z when facing; of a plunge its whole
    depth. For passes along the contour it is the distance kept from it, in X.
    """

    operation: int
    number: int
    role: Role
    depth: int
    moves: tuple[Move, ...]

    @property
    def cuts(self) -> tuple[Move, ...]:
        """The moves at a feed."""
        return tuple(move for move in self.moves if not move.rapid)

    @property
    def stroke(self) -> tuple[Place, Place]:
        """Where the last continuous cut begins and where it ends; of a plunge all of its cuts."""
        last = len(self.moves) - 1
        while self.moves[last].rapid:
            last -= 1
        if self.role is Role.PLUNGING:
            return self.cuts[0].start, self.moves[last].end
        first = last
        while first > 0 and not self.moves[first - 1].rapid:
            first -= 1
        return self.moves[first].start, self.moves[last].end


class Halt(Enum):
    """Why the lathe parks."""

    PAUSE = "pause"
    DRILL = "drill"
    TOOL = "tool"
    END = "end"


@dataclass(frozen=True)
class Stop:
    """The way to the parking place, where the lathe waits for RUN or has finished.

    `operation` is the number of the pause, or of the last operation before. `text` is the message
    of a pause or the name of the next tool.
    """

    operation: int
    halt: Halt
    text: str
    moves: tuple[Move, ...]


@dataclass(frozen=True)
class Plan:
    """Everything the lathe does for a part, in order; the last step of a whole part is a stop."""

    image: PartImage
    steps: tuple[Pass | Stop, ...]

    @property
    def passes(self) -> tuple[Pass, ...]:
        """Without the stops."""
        return tuple(step for step in self.steps if isinstance(step, Pass))

    @property
    def stops(self) -> tuple[Stop, ...]:
        """Without the passes."""
        return tuple(step for step in self.steps if isinstance(step, Stop))

    @property
    def moves(self) -> tuple[Move, ...]:
        """Every move."""
        return tuple(move for step in self.steps for move in step.moves)

    def chains(self) -> Iterator[list[Move]]:
        """The moves between two places where the lathe waits."""
        chain: list[Move] = []
        for step in self.steps:
            chain += step.moves
            if isinstance(step, Stop):
                yield chain
                chain = []
        if chain:
            yield chain
