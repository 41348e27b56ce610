# SPDX-License-Identifier: Apache-2.0
"""Turns logged coil levels into steps, and judges them against the reference."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from virtual_lathe.chip import CYCLES_PER_SECOND

from .reference import Arc, Line, Move, Point, Segment, entry_length

COIL_PINS = tuple(f"R{port}{bit}" for port in "BD" for bit in range(4))
SHIFT_Z, SHIFT_X = 8, 24
# The step interrupt writes the coils of Z first and those of X two cycles later.
X_LATER = 2
PHASES = {5: 0, 9: 1, 10: 2, 6: 3}


class BadCoils(AssertionError):
    """A coil pattern that full steps with two phases on do not have, or a jump."""


@dataclass
class Trace:
    """Steps of both screws: ``times`` in cycles, ``moves`` as (dx, dz) of -1, 0, 1."""

    times: list[int] = field(default_factory=list)
    moves: list[Point] = field(default_factory=list)
    counted: Point = (0, 0)

    def points(self) -> list[Point]:
        """Every place of the screws, beginning with (0, 0)."""
        x = z = 0
        points = [(0, 0)]
        for dx, dz in self.moves:
            x += dx
            z += dz
            points.append((x, z))
        return points

    @property
    def seconds(self) -> float:
        """Time between the first step and the last."""
        return (self.times[-1] - self.times[0]) / CYCLES_PER_SECOND


def _step(before: int, after: int, cycle: int) -> int:
    if after not in PHASES:
        raise BadCoils(f"pattern {after:#x} at cycle {cycle}")
    if before not in PHASES:
        return 0
    change = (PHASES[after] - PHASES[before]) & 3
    if change == 2:
        raise BadCoils(f"jump of two steps at cycle {cycle}")
    return -1 if change == 3 else change


def decode(changes: Sequence[tuple[int, int]], first: tuple[int, int] = (0, 0)) -> Trace:
    """Decode a log of pin levels, full steps with two phases on.

    ``first`` are the patterns of X and Z before the log; 0 is switched off.
    """
    trace = Trace()
    x, z = first
    for cycle, levels in changes:
        new_x, new_z = levels >> SHIFT_X & 15, levels >> SHIFT_Z & 15
        if new_z not in (z, 0):
            step = _step(z, new_z, cycle)
            if step:
                trace.times.append(cycle)
                trace.moves.append((0, step))
        if new_x not in (x, 0):
            step = _step(x, new_x, cycle)
            if step and trace.times and trace.times[-1] == cycle - X_LATER:
                trace.moves[-1] = (step, trace.moves[-1][1])
            elif step:
                trace.times.append(cycle - X_LATER)
                trace.moves.append((step, 0))
        x, z = new_x or x, new_z or z
    return trace


@dataclass
class Judgement:
    """How well the tool has followed one move.

    ``worst`` and ``rms`` are distances in steps; ``lengths`` are the true path lengths of the
    steps of the move, in order.
    """

    worst: float
    square_sum: float
    points: int
    lengths: list[float]

    @property
    def rms(self) -> float:
        """Root of the mean square distance."""
        return math.sqrt(self.square_sum / self.points) if self.points else 0.0


def split(points: Sequence[Point], moves: Sequence[Move]) -> list[list[Point]]:
    """Cut visited points into those of each move, by the places where the moves end.

    A move's points contain its start and its end. A place may be passed before it is the end, so
    a move ends where its end is reached and the path length travelled fits.

    Raises:
        AssertionError: an end is never reached or something follows the last one.
    """
    parts: list[list[Point]] = []
    at = 0
    for move in moves:
        start = points[at]
        goal = start[0] + move.end[0], start[1] + move.end[1]
        stop = at
        for index in range(at + least_steps(move), len(points)):
            if points[index] == goal:
                stop = index
                break
        else:
            raise AssertionError(
                f"{move} from {start} never reaches {goal}; {len(points) - 1 - at} steps remain, "
                f"the last place is {points[-1]}"
            )
        parts.append([(p[0] - start[0], p[1] - start[1]) for p in points[at : stop + 1]])
        at = stop
    if at != len(points) - 1:
        raise AssertionError(f"{len(points) - 1 - at} steps too many: {points[at : at + 5]}")
    return parts


def least_steps(move: Move) -> int:
    """A number of entries that a move cannot be shorter than."""
    if isinstance(move, Line):
        return max(abs(move.dx), abs(move.dz))
    return max(abs(move.dx), abs(move.dz), int(move.length / math.sqrt(2.0)) - 2)


def judge(move: Move, points: Sequence[Point]) -> Judgement:
    """Compare the points of one move, from its start, with its true path."""
    distances = [move.distance(point) for point in points]
    lengths = [entry_length(move, points[i], points[i + 1]) for i in range(len(points) - 1)]
    return Judgement(max(distances), sum(d * d for d in distances), len(distances), lengths)


def judge_all(trace: Trace, chain: Sequence[Segment]) -> list[tuple[Move, Judgement]]:
    """Judge every move of a chain."""
    moves: list[Move] = [
        s for s in chain if isinstance(s, Line | Arc) and (s.end != (0, 0) or isinstance(s, Arc))
    ]
    return [
        (move, judge(move, part))
        for move, part in zip(moves, split(trace.points(), moves), strict=True)
    ]


def feed_errors(
    trace: Trace, lengths: Sequence[float], rates: Sequence[float], window: int = 16
) -> float:
    """Largest relative error of the feed over ``window`` consecutive steps, in percent.

    ``lengths`` and ``rates`` belong to the steps of the trace; the first step has no time before
    it and does not count.
    """
    ideal = [0.0]
    for length, rate in zip(lengths[1:], rates[1:], strict=True):
        ideal.append(ideal[-1] + length / rate * CYCLES_PER_SECOND)
    worst = 0.0
    for i in range(len(ideal) - window):
        wanted = ideal[i + window] - ideal[i]
        taken = trace.times[i + window] - trace.times[i]
        worst = max(worst, abs(wanted / taken - 1.0) * 100.0)
    return worst
