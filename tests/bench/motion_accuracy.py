# SPDX-License-Identifier: Apache-2.0
"""How near to the path and to the feed: random lines and arcs, every visited point counts."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass, field
from typing import Any

from motion.reference import Arc, Line, Move, arc_between
from motion.rig import Rig
from motion.trace import feed_errors, judge_all
from virtual_lathe.worker import in_new_process

SEED = 7
LINES, ARCS, SLOW_MOVES = 100, 300, 80
SMALL_ARCS = 400
LARGEST_RADIUS = 60_000.0
LONGEST = 4_000.0
FAST_RATE = 12_000.0
#: Radii from which on the feed on arcs is in the headline figure, to 3,000 steps/s and above.
FEED_RADIUS, FAST_FEED_RADIUS = 8.0, 20.0
EIGHTH = math.pi / 4


@dataclass
class Tally:
    """Distances and feed errors of many moves."""

    worst: float = 0.0
    square_sum: float = 0.0
    points: int = 0
    feed: float = 0.0
    moves: int = 0
    worst_move: Move | None = None
    by_band: dict[str, float] = field(default_factory=dict)

    @property
    def rms(self) -> float:
        """Root of the mean square distance of all points."""
        return math.sqrt(self.square_sum / max(self.points, 1))


def take(rig: Rig, move: Move, tally: Tally, band: str = "") -> None:
    """Run one move and add what came of it."""
    trace = rig.follow([move], 60.0)
    judged = judge_all(trace, [move])[0][1]
    tally.moves += 1
    tally.square_sum += judged.square_sum
    tally.points += judged.points
    if judged.worst > tally.worst:
        tally.worst, tally.worst_move = judged.worst, move
    error = feed_errors(trace, judged.lengths, [move.rate] * len(judged.lengths))
    tally.feed = max(tally.feed, error)
    tally.by_band[band] = max(tally.by_band.get(band, 0.0), error)


def random_line(chance: random.Random, longest: int, rate: float) -> Line:
    """A line of any direction; one in four along an axis, a diagonal or nearly so."""
    size = chance.choice((5, 50, longest))
    dx, dz = chance.randint(-size, size), chance.randint(1, size)
    if chance.random() < 0.25:
        dx = chance.choice((0, dz, -dz, 1, -1))
    return Line(dx, dz, rate) if chance.random() < 0.5 else Line(-dz, -dx, rate)


def random_arc(
    chance: random.Random, smallest: float, largest: float, longest: float, rate: float
) -> Arc:
    """An arc of any radius, place and sense; many begin or end on an axis or a diagonal."""
    while True:
        radius = math.exp(chance.uniform(math.log(smallest), math.log(largest)))
        start = chance.choice((chance.uniform(0, math.tau), chance.randrange(8) * EIGHTH))
        sweep = chance.choice((chance.uniform(0.05, 6.2), chance.randrange(1, 8) * EIGHTH))
        sweep = min(max(sweep, 3.0 / radius), longest / radius)
        try:
            arc = arc_between(radius, start, sweep, chance.random() < 0.5, rate)
        except ValueError:
            continue
        if smallest <= arc.radius <= LARGEST_RADIUS:
            return arc


def band_of(radius: float) -> str:
    """Name of a range of radii."""
    return "R 5 to 20" if radius < FAST_FEED_RADIUS else "R from 20"


def _measure() -> dict[str, Any]:
    chance = random.Random(SEED)
    rig = Rig()
    rig.quick()
    lines, arcs, slow, tiny = Tally(), Tally(), Tally(), Tally()
    for _ in range(LINES):
        take(rig, random_line(chance, int(LONGEST), FAST_RATE), lines)
    for _ in range(ARCS):
        arc = random_arc(chance, 5.0, LARGEST_RADIUS, LONGEST, FAST_RATE)
        take(rig, arc, arcs, band_of(arc.radius))
    for _ in range(SMALL_ARCS):
        arc = random_arc(chance, 5.0, FEED_RADIUS, LONGEST, FAST_RATE)
        take(rig, arc, arcs, band_of(arc.radius))
    for _ in range(SLOW_MOVES):
        rate = math.exp(chance.uniform(math.log(10.0), math.log(3_000.0)))
        steps = max(20.0, rate / 4.0)
        take(rig, random_line(chance, int(steps), rate), slow)
        arc = random_arc(chance, FEED_RADIUS, 5_000.0, steps, rate)
        take(rig, arc, slow)
        take(rig, random_arc(chance, 5.0, FEED_RADIUS, 60.0, rate), tiny)
    return {
        "line_error_max_steps": lines.worst,
        "line_error_rms_steps": lines.rms,
        "arc_error_max_steps": max(arcs.worst, tiny.worst),
        "arc_error_rms_steps": arcs.rms,
        "arc_error_worst_arc": str(arcs.worst_move),
        "feed_error_max_pct": max(slow.feed, lines.feed, arcs.by_band["R from 20"]),
        "feed_error_max_pct_tiny": tiny.feed,
        "feed_error_max_pct_fast": {"lines": lines.feed, **arcs.by_band},
        "accuracy_moves": lines.moves + arcs.moves + slow.moves + tiny.moves,
        "accuracy_points": lines.points + arcs.points + slow.points + tiny.points,
    }


def accuracy() -> dict[str, Any]:
    """Measure distances from the path and errors of the feed."""
    return in_new_process(_measure)
