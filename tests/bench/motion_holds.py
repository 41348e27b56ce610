# SPDX-License-Identifier: Apache-2.0
"""Feed hold: how soon it brakes, and whether anything is lost, at pseudo-random moments."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Sequence
from typing import Any

from motion.reference import Line, Move, Point, Segment, arc_between
from motion.rig import MotionFault, Rig
from tornillo.protocol import State
from virtual_lathe.worker import in_new_process

HOLDS = 1_000
ACCELERATION = 32_000
START_RATE = 1_000
TOP = 6_000
SEED = 1
HOLD_TIMEOUT_S = 1.0
LATENCY_RATES = (500, 1_000, 2_000, 5_000)
LATENCY_TRIALS = 12


def mixed_path(seed: int, count: int) -> list[Segment]:
    """Lines and arcs in every direction and at several feeds, 10 to 400 steps each."""
    chance = random.Random(seed)
    path: list[Segment] = []
    while len(path) < count:
        rate = chance.choice((1_500, 3_000, 5_000))
        size = chance.choice((10, 80, 400))
        if chance.random() < 0.5:
            move: Move = Line(chance.randint(-size, size), chance.randint(-size, size), rate)
        else:
            radius = chance.uniform(10, size + 10)
            sweep = chance.uniform(0.3, 5.0)
            move = arc_between(
                radius, chance.uniform(0, math.tau), sweep, chance.random() < 0.5, rate
            )
        if move.end != (0, 0):
            path.append(move)
    return path


def hold_and_resume(rig: Rig, chance: random.Random) -> bool:
    """Hold after a pseudo-random time, wait until it stands, resume; False at the path's end."""
    rig.run(chance.uniform(0.0, 0.12))
    if not rig.is_in(State.RUNNING):
        return False
    rig.hold()
    if not rig.is_in(State.HOLD):
        return False
    waited = 0
    while rig.stepping and rig.is_in(State.HOLD):
        rig.run(1e-3)
        waited += 1
        if waited > HOLD_TIMEOUT_S * 1e3:
            raise MotionFault("a hold did not come to a stand")
    if not rig.is_in(State.HOLD):
        return False
    stands = rig.position
    rig.run(chance.uniform(0.0, 0.01))
    if rig.position != stands:
        raise MotionFault("a step was made in a hold")
    rig.resume()
    return True


def differences(one: Sequence[Point], other: Sequence[Point]) -> int:
    """Steps that two sequences do not have in common."""
    return sum(a != b for a, b in zip(one, other, strict=False)) + abs(len(one) - len(other))


def trials(rig: Rig, wanted: int) -> tuple[int, int]:
    """Hold many times over mixed paths.

    Returns:
        holds made, and steps that differ from the same path without holds.
    """
    chance = random.Random(SEED)
    made = lost = 0
    seed = SEED
    while made < wanted:
        rig.settle(
            acceleration=ACCELERATION,
            start_rate_x=START_RATE,
            start_rate_z=START_RATE,
            rapid_rate_x=TOP,
            rapid_rate_z=TOP,
        )
        path = mixed_path(seed, 60)
        seed += 1
        plain = rig.follow(path, 60.0)
        rig.start(path)
        while hold_and_resume(rig, chance):
            made += 1
        rig.finish(60.0)
        lost += differences(plain.moves, rig.trace().moves)
    return made, lost


def latency(rig: Rig, rate: int) -> int:
    """Steps made from the command to the first step that comes later than at full speed."""
    rig.settle(
        acceleration=8_000, start_rate_x=400, start_rate_z=400, rapid_rate_x=TOP, rapid_rate_z=TOP
    )
    chance = random.Random(rate)
    worst = 0
    for _ in range(LATENCY_TRIALS):
        rig.start([Line(-6_000, 0, rate)])
        rig.run(rate / 8_000 + chance.uniform(0.05, 0.06))
        rig.hold()
        asked = rig.chip.cycle
        rig.run(0.02)
        times = rig.trace().times
        full = min(b - a for a, b in itertools.pairwise(times))
        before = sum(time <= asked for time in times)
        later = next(i for i in range(before, len(times)) if times[i] - times[i - 1] > full + 1)
        worst = max(worst, later - before)
        rig.stop()
    return worst


def _measure() -> dict[str, Any]:
    rig = Rig()
    steps = {rate: latency(rig, rate) for rate in LATENCY_RATES}
    made, lost = trials(rig, HOLDS)
    return {
        "hold_latency_steps": steps[1_000],
        "hold_latency_steps_by_rate": {str(rate): count for rate, count in steps.items()},
        "hold_trials": made,
        "hold_steps_lost": lost,
    }


def holds() -> dict[str, Any]:
    """Measure feed holds."""
    return in_new_process(_measure)
