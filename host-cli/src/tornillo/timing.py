# SPDX-License-Identifier: Apache-2.0
"""How long moves take, by the rules of the chip's motion core.

The speed is followed as firmware/motion/ramp_tick.asm sets it, entry by entry while it changes,
and in one go while it does not.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

from tornillo.drives import NO_LIMIT, Drives, LegPlanner, exits, sizes, x_way
from tornillo.moves import Move, Plan
from tornillo.protocol import FEED_UNIT

#: The ramp counts time in 1/1024 s.
TICKS = 1024
TICK_S = 1 / TICKS
REST_S = 10e-3
BEGIN_S = 1e-3
#: Entries before the braking point at which the speed is followed again.
MARGIN = 2


def move_times(chain: Sequence[Move], planner: LegPlanner) -> list[float]:
    """Seconds of each move of a chain that begins and ends with a stand."""
    drives = planner.drives
    legs = list(planner.chain(chain))
    speed = min(float(drives.start), legs[0].rate) if legs else 0.0
    times: list[float] = []
    for number, (leg, allowed) in enumerate(zip(legs, exits(legs, drives), strict=True)):
        stretch = leg.length / leg.entries
        stands = number == 0 or leg.rest
        task = Task(drives, round(leg.entries), stretch, leg.dead, leg.rate, allowed, stands)
        seconds, speed = task_time(task, speed)
        seconds += leg.flat / leg.rate
        times.append(seconds + (REST_S if leg.rest else 0.0))
    if times:
        times[0] += BEGIN_S
    return times


class Task(NamedTuple):
    """`entries` steps of the faster axis at `rate`, after `dead` ones that lead nowhere.

    `stretch` is the way along the path of one entry; `allowed` is the braking distance that may
    be left behind, half steps; `stands` tells that the tool stands before, so that the speed
    changes with the second step.
    """

    drives: Drives
    entries: int
    stretch: float
    dead: int
    rate: float
    allowed: int
    stands: bool


@lru_cache(maxsize=4096)
def task_time(task: Task, speed: float) -> tuple[float, float]:
    """Seconds of a task begun with `speed`, and the speed at its end."""
    now, way, left = 0.0, 0.0, task.entries + task.dead
    while left > 0:
        stretch = task.stretch if left <= task.entries else 1.0
        if speed == task.rate and left <= task.entries:
            steady = _steady(task, left)
            now += steady * stretch / speed
            left -= steady
            if not left:
                break
        # So many entries go by at this speed while the next is worked out: that of a ramp which
        # changes speed with every tick and has come as far.
        entries = min(left, int(speed) // TICKS + 1)
        now += entries * stretch / speed
        way += entries * stretch * TICKS
        if task.stands and not left < task.entries + task.dead:
            way = 0.0
        following = speed
        while way >= int(following):
            way -= int(following)
            before, following = following, next_speed(task, following, min(left, task.entries))
            if following == before:
                way = 0.0
        left -= entries
        speed = following
    return now, speed


def _steady(task: Task, left: int) -> int:
    """Entries that will certainly be made at the task's rate."""
    if task.rate <= task.drives.start:
        return left
    braking = task.drives.distance(task.rate) + 4 + int(task.rate) // 256 - task.allowed
    return max(0, left - max(0, braking // 2 + MARGIN))


def next_speed(task: Task, speed: float, left: int) -> float:
    """The speed a tick later, with `left` entries to go when the speed before began."""
    drives, rate = task.drives, task.rate
    limit = min(NO_LIMIT, max(0, 2 * left - 4 - int(speed) // 256) + task.allowed)
    change = drives.acceleration * TICK_S
    least = min(drives.start, rate)
    if speed > drives.start and drives.distance(speed) > limit:
        return max(speed - change, least)
    if speed < rate:
        faster = min(speed + change, rate)
        if faster > drives.start and drives.distance(faster) > limit:
            return speed
        return faster
    if speed > rate and speed > drives.start:
        return max(speed - change, rate)
    return rate


@dataclass(frozen=True)
class Timing:
    """How long a plan takes, in seconds.

    `steps` are those of the plan's passes and stops in order, `feeding` what of them is made at a
    feed, `least` the time that the length of these cuts takes at their feeds.
    """

    steps: tuple[float, ...]
    feeding: tuple[float, ...]
    least: tuple[float, ...]

    @property
    def total(self) -> float:
        """The whole part, without the time at pauses."""
        return sum(self.steps)

    @property
    def share(self) -> float:
        """How much of it the tool moves at a feed, 0 to 1."""
        return sum(self.feeding) / self.total if self.total else 0.0


def time_plan(plan: Plan, drives: Drives) -> Timing:
    """The time of every pass and stop."""
    planner = LegPlanner(drives)
    times = [seconds for chain in plan.chains() for seconds in move_times(chain, planner)]
    taken = iter(times)
    steps, feeding, least = [], [], []
    for step in plan.steps:
        seconds = [(move, next(taken)) for move in step.moves]
        steps.append(sum(time for _, time in seconds))
        feeding.append(sum(time for move, time in seconds if not move.rapid))
        cuts = (move for move in step.moves if not move.rapid)
        least.append(sum(sizes(move)[1] / move.feed * FEED_UNIT for move in cuts))
    return Timing(tuple(steps), tuple(feeding), tuple(least))


def axis_steps(moves: Iterable[Move]) -> tuple[int, int]:
    """Steps of X and of Z, without dead steps."""
    of_x = of_z = 0
    for move in moves:
        of_x += x_way(move)
        of_z += abs(move.dz)
    return of_x, of_z
