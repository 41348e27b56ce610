# SPDX-License-Identifier: Apache-2.0
"""Watches a run from outside: how the slides move, what they cut, when slack is taken up."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise, zip_longest

from tornillo.protocol import Axis
from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.machine import Move

from simulated.bench import Bench

#: Both ports are written by one interrupt, this many cycles apart at most.
SAME_STEP = 10


@dataclass(frozen=True)
class Stroke:
    """Movement of one slide in one direction: steps with sign, its highest rate in steps/s.

    The interval in front of its first step belongs to the corner and does not count.
    """

    axis: str
    steps: int
    rate: int


@dataclass(frozen=True)
class Movement:
    """One step of a slide, where the tool then is (part coordinates), and whether it cut."""

    cycle: int
    axis: str
    direction: int
    x: float
    z: float
    cut: bool
    clear: bool


@dataclass(frozen=True)
class Slack:
    """A step that turned the screw only."""

    cycle: int
    axis: str
    direction: int


class Watch:
    """What happens on a bench from now on; begin while nothing moves."""

    def __init__(self, bench: Bench) -> None:
        """Listen to the slides and to the slack counters."""
        self.movements: list[Movement] = []
        self._bench = bench
        bench.run(1e-4)
        self._last = (2 * bench.axis(Axis.X).slide, 2 * bench.axis(Axis.Z).slide)
        self._work = bench.lathe.workpiece
        self._cut = self._work.cut
        vars(self._work)["cut"] = self._note
        slack = bench.chip.symbols.ram("slack_x")
        self._slack = {slack + i: bench.chip.peek(slack + i) for i in range(4)}
        bench.chip.watch_writes(slack, slack + 3)

    def _note(self, moves: Iterable[Move]) -> None:
        every = list(moves)
        for move, then in zip_longest(every, every[1:]):
            before = self._work.steps_cutting
            if then is None or then.cycle - move.cycle >= SAME_STEP:
                self._cut([move])
            axis = "X" if move.x != self._last[0] else "Z"
            direction = 1 if (move.x, move.z) > self._last else -1
            self._last = move.x, move.z
            x, z = move.x / 2 - self._work.zero_x, move.z / 2 - self._work.zero_z
            cut = self._work.steps_cutting > before
            self.movements.append(
                Movement(move.cycle, axis, direction, x, z, cut, self._is_clear(x, z))
            )

    def _is_clear(self, x: float, z: float) -> bool:
        """Whether no material stands where the tool or anything in front of it is."""
        front = range(math.floor(z), self._work.stock.allowance + 1)
        return all(self._work.radius_at(place) < x for place in front)

    def approach(self) -> list[Movement]:
        """Return the movements of the first way on which both slides step at once.

        Behind the last step of both it ends with those of the slide that has the longer way.
        """
        both = [
            number
            for number, (first, then) in enumerate(pairwise(self.movements))
            if then.cycle - first.cycle < SAME_STEP
        ]
        if not both:
            return []
        end = both[-1] + 2
        axes = [movement.axis for movement in self.movements[:end]]
        longer = max(axes, key=axes.count)
        while end < len(self.movements) and self.movements[end].axis == longer:
            end += 1
        return self.movements[:end]

    def strokes(self) -> list[Stroke]:
        """Return what follows the approach as strokes of one slide each."""
        first = self.approach()
        found: list[Stroke] = []
        cycle = first[-1].cycle if first else 0
        for movement in self.movements[len(first) :]:
            rate = round(CYCLES_PER_SECOND / (movement.cycle - cycle))
            cycle = movement.cycle
            last = found[-1] if found else Stroke("", 0, 0)
            if last.axis == movement.axis and last.steps * movement.direction > 0:
                rate = max(last.rate, rate)
                found[-1] = Stroke(last.axis, last.steps + movement.direction, rate)
            else:
                found.append(Stroke(movement.axis, movement.direction, 0))
        return found

    def slack_steps(self) -> list[Slack]:
        """Return the steps that were taken up while the slides stood."""
        symbols = self._bench.chip.symbols
        names = {symbols.ram(f"slack_{name}"): name.upper() for name in "xz"}
        values = dict(self._slack)
        found = []
        for write in self._bench.chip.ram_writes():
            if write.address in names:  # the low byte changes at every step
                step = (write.value - values[write.address]) & 0xFF
                values[write.address] = write.value
                found.append(Slack(write.cycle, names[write.address], 1 if step < 0x80 else -1))
        return found

    def place_at(self, cycle: int) -> Movement | None:
        """Return the last movement before a cycle."""
        before = [movement for movement in self.movements if movement.cycle <= cycle]
        return before[-1] if before else None
