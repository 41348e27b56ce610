# SPDX-License-Identifier: Apache-2.0
"""Whole programs: a profile of tangent segments, a ball with dead steps, the peer's roughing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from motion.backlash import tool_points
from motion.reference import Arc, Line, Move, Point, Segment, ramp_time
from motion.rig import Rig
from motion.trace import Trace, judge
from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.worker import in_new_process

FEED = 1_000.0
ACCELERATION, START_RATE = 8_000, 400
PROFILE_SEGMENTS = 60

BALL_RADIUS, DEAD_STEPS, BALL_FEED = 300, 23, 500.0

STEP_MM = 0.007112
PEER_ACCELERATION = 20.0 / STEP_MM
PEER_FEED, PEER_RAPID = 4.0 / STEP_MM, 15.0 / STEP_MM
PEER_CORNER_RATE = 97
PEER_SECONDS = 39.46


def wave(rate: float) -> list[Segment]:
    """60 segments, each beginning in the direction in which the one before has ended.

    Lines and quarter circles in turn; the quarters swing out and back, so that the profile has
    no corner anywhere.
    """
    chain: list[Segment] = []
    for i in range(PROFILE_SEGMENTS // 4):
        radius = 20 + 7 * (i % 11)
        chain += [Line(0, -30 - 5 * (i % 7), rate), *turn(radius, i % 2 == 0, rate)]
    return chain


def turn(radius: int, outwards: bool, rate: float) -> list[Segment]:
    """From travel towards -Z to X and back to -Z: quarter, line, quarter."""
    side = 1 if outwards else -1
    first = Arc(side * radius, -radius, side * radius, 0.0, outwards, rate)
    second = Arc(side * radius, -radius, 0.0, -radius, not outwards, rate)
    return [first, Line(side * 25, 0, rate), second]


def moves_of(chain: Sequence[Segment]) -> list[Move]:
    """The segments that move."""
    return [s for s in chain if isinstance(s, Line | Arc)]


def lookahead(rig: Rig) -> dict[str, Any]:
    """Time of a profile of 60 tangent segments, divided by the least time there is."""
    rig.settle(
        acceleration=ACCELERATION,
        start_rate_x=START_RATE,
        start_rate_z=START_RATE,
        rapid_rate_x=4_000,
        rapid_rate_z=4_000,
    )
    chain = wave(FEED)
    trace = rig.follow(chain, 60.0)
    length = sum(move.length for move in moves_of(chain))
    ideal = ramp_time(length, FEED, START_RATE, ACCELERATION)
    # The trace begins with the end of the first step.
    taken = trace.seconds + 1.0 / START_RATE
    return {"lookahead_time_ratio": taken / ideal, "lookahead_segments": len(chain)}


def ball(rate: float) -> Arc:
    """Half a circle from the tip of a ball over its largest diameter to the far end."""
    return Arc(0, -2 * BALL_RADIUS, 0.0, float(-BALL_RADIUS), False, rate)


def still_ms(trace: Trace, tool: Sequence[Point]) -> float:
    """Time in milliseconds during which the tool stands still although the path goes on.

    A step that moves no tool stands still for the whole of its interval.
    """
    total = 0
    for i in range(1, len(trace.times)):
        if tool[i] == tool[i + 1]:
            total += trace.times[i] - trace.times[i - 1]
    return total / CYCLES_PER_SECOND * 1e3


def plateau(rig: Rig) -> dict[str, Any]:
    """A full ball cut with dead steps: the tool's own path, and whether it ever waits."""
    rig.quick(2_000)
    rig.dead_steps(DEAD_STEPS, DEAD_STEPS, 0, -DEAD_STEPS)
    move = ball(BALL_FEED)
    trace = rig.follow([move], 10.0)
    rig.dead_steps(0, 0)
    tool = tool_points(trace.moves, (DEAD_STEPS, DEAD_STEPS), (0, -DEAD_STEPS))
    judged = judge(move, tool)
    return {
        "plateau_takeup_path_error_steps": judged.worst,
        "plateau_takeup_dwell_ms": still_ms(trace, tool),
        "plateau_end_missed_steps": math.dist(tool[-1], move.end),
        "plateau_time_ratio": trace.seconds / (move.length / BALL_FEED),
    }


def roughing() -> list[Segment]:
    """The peer's roughing program in steps of 7,112 nm: four passes of 1.27 mm."""

    def steps(millimetres: float) -> int:
        return round(millimetres / STEP_MM)

    chain: list[Segment] = []
    x = steps(12.7)
    z = steps(25.4)
    for k in range(1, 5):
        deep, clear = steps(12.7 - 1.27 * k), steps(12.7 - 1.27 * (k - 1))
        chain += [
            Line(deep - x, 0, PEER_RAPID, rapid=True),
            Line(0, -z, PEER_FEED),
            Line(clear - deep, 0, PEER_RAPID, rapid=True),
            Line(0, z, PEER_RAPID, rapid=True),
        ]
        x = clear
    return chain


def peer_program(rig: Rig) -> dict[str, Any]:
    """Time of the peer's program with its acceleration and rates, at two start/stop rates.

    The second is what the peer's junction deviation of 0.01 mm allows at a right angle.
    """
    seconds: dict[str, float] = {}
    for start in (START_RATE, PEER_CORNER_RATE):
        rig.settle(
            acceleration=round(PEER_ACCELERATION),
            start_rate_x=start,
            start_rate_z=start,
            rapid_rate_x=round(PEER_RAPID),
            rapid_rate_z=round(PEER_RAPID),
        )
        trace = rig.follow(roughing(), 90.0)
        seconds[str(start)] = trace.seconds + 1.0 / start
    return {
        "roughing_s": seconds[str(START_RATE)],
        "roughing_s_by_start_rate": seconds,
        "roughing_peer_s": PEER_SECONDS,
    }


def _measure() -> dict[str, Any]:
    rig = Rig()
    return lookahead(rig) | plateau(rig) | peer_program(rig)


def programs() -> dict[str, Any]:
    """Run the programs on one chip, one after the other."""
    return in_new_process(_measure)
