# SPDX-License-Identifier: Apache-2.0
"""The moves of a run as the chip queues them, next to those that the host has planned."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from tornillo.image import SegmentKind
from tornillo.moves import Move
from tornillo.protocol import State

from simulated.bench import Bench

PATH_HEADER = Path(__file__).parents[2] / "firmware" / "motion" / "path.h"
SEGMENT_SIZE = 22
KIND, RAPID = 0x07, 0x80
#: Between two looks at the queue; a segment takes the chip longer than a fifteenth of it.
LOOK_S = 1e-3
#: 1/256 step/s, the chip's unit, in one of the feeds of the image.
RATE_OF_FEED = 32


class Queued(NamedTuple):
    """A segment; of a rapid the feed is 0, of a line the centre."""

    kind: SegmentKind
    dz: int
    dx: int
    feed: int
    cz: int = 0
    cx: int = 0

    @classmethod
    def planned(cls, move: Move) -> Queued:
        """What the chip has to make of a move of the host's plan."""
        return cls(move.kind, move.dz, move.dx, move.feed, move.cz, move.cx)


def queue_length() -> int:
    """Return how many segments the queue has, one of them always free."""
    found = re.search(r"#define SEGMENTS (\d+)u", PATH_HEADER.read_text(encoding="ascii"))
    assert found is not None
    return int(found[1])


@dataclass
class Listener:
    """Follows runs; ``chains`` are the moves between two pauses, ``seconds`` their times.

    ``at_pause`` is called in every pause, before the run goes on.
    """

    bench: Bench
    at_pause: Callable[[], None] = lambda: None
    chains: list[list[Queued]] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)

    def follow(self, timeout: float, slot: int | None = None, step: bool = False) -> None:
        """Run a part to its end, going on at once after each pause."""
        bench = self.bench
        bench.host.run(slot, step)
        self._chain(timeout)
        while bench.is_in(State.PAUSE):
            self.at_pause()
            bench.host.resume()
            self._chain(timeout)
        assert bench.is_in(State.IDLE), bench.alarm
        assert bench.status().finished

    @property
    def moves(self) -> list[Queued]:
        """Every move so far."""
        return [move for chain in self.chains for move in chain]

    def _chain(self, timeout: float) -> None:
        """Note what is queued until the run ends or pauses."""
        chip, length = self.bench.chip, queue_length()
        begun, seen = chip.seconds, 0
        found: list[Queued] = []
        while True:
            running = self.bench.state in (State.RUNNING, State.HOLD)
            head = chip.variable("path_head")
            assert (head - seen) % length < length - 1, "looked too rarely"
            while seen != head:
                found.append(self._segment(seen))
                seen = (seen + 1) % length
            if not running:
                break
            assert chip.seconds - begun < timeout, f"still running after {timeout} s"
            self.bench.run(LOOK_S)
        self.chains.append(found)
        self.seconds.append(chip.seconds - begun)

    def _segment(self, index: int) -> Queued:
        """Read a segment from the queue."""
        chip = self.bench.chip
        at = chip.symbols.ram("segments") + SEGMENT_SIZE * index

        def number(offset: int, size: int) -> int:
            data = bytes(chip.peek(at + offset + i) for i in range(size))
            return int.from_bytes(data, "little", signed=True)

        kind = chip.peek(at + 12)
        speed = chip.symbols.ram("segment_speed") + 4 * index
        rate = sum(chip.peek(speed + i) << 8 * i for i in range(4))
        feed = 0 if kind & RAPID else rate // RATE_OF_FEED
        shape = SegmentKind(kind & KIND)
        if shape is SegmentKind.LINE:
            return Queued(shape, number(2, 2), number(0, 2), feed)
        return Queued(shape, number(2, 2), number(0, 2), feed, number(8, 4), number(4, 4))
