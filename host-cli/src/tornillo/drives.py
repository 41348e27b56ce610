# SPDX-License-Identifier: Apache-2.0
"""How the axes are driven, and how fast the chip lets each move be entered and made.

The same rules as firmware/motion/plan.c, with its whole numbers: directions in 1/128, braking
distances in half steps.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from tornillo.image import CENTRE_UNIT, SegmentKind
from tornillo.machine import Machine
from tornillo.moves import Move
from tornillo.protocol import FEED_UNIT, SETTINGS, SettingId

#: Segments that the chip looks ahead over, behind the one that is being made.
AHEAD = 14
UNIT, TANGENT, BACK = 128, 2, 144
NO_LIMIT = 0xFFFF
#: Dead steps are taken up before the turning point of an arc in so many entries at most.
FLAT = 48


@dataclass(frozen=True)
class Drives:
    """Rates in step/s, `acceleration` in step/s^2, `dead_x` and `dead_z` in steps."""

    rapid_x: int
    rapid_z: int
    start_x: int
    start_z: int
    acceleration: int
    dead_x: int = 0
    dead_z: int = 0

    @classmethod
    def usual(cls, machine: Machine) -> "Drives":
        """Those of `machine`, with the chip's defaults for what it does not tell."""
        return replace(cls.default(), rapid_x=machine.max_rate, rapid_z=machine.max_rate)

    @classmethod
    def default(cls) -> "Drives":
        """The chip's defaults."""
        return cls(
            rapid_x=SETTINGS[SettingId.RAPID_RATE_X].default,
            rapid_z=SETTINGS[SettingId.RAPID_RATE_Z].default,
            start_x=SETTINGS[SettingId.START_RATE_X].default,
            start_z=SETTINGS[SettingId.START_RATE_Z].default,
            acceleration=SETTINGS[SettingId.ACCELERATION].default,
        )

    @property
    def start(self) -> int:
        """The rate at which a move may start and stop."""
        return min(self.start_x, self.start_z)

    def distance(self, rate: float) -> int:
        """The way to brake from a rate along the path, half steps, as the chip rounds it."""
        return min(NO_LIMIT, (int(rate) ** 2 >> 8) * ((1 << 24) // self.acceleration) >> 16)

    def capped(self, rate: int) -> int:
        """The rate, or the fastest that can be braked from in time."""
        while self.distance(rate) > 60_000:
            rate -= rate >> 4
        return rate


class Leg(NamedTuple):
    """A move as the speed is planned for it.

    `entries` are steps of the faster axis, `length` steps along the path, `rate` step/s; `corner`
    is the braking distance it may be entered with, half steps; `rest` tells that the motors come
    to rest before it. `dead` steps are taken up before it, `flat` ones in its midst.
    """

    entries: float
    length: float
    rate: float
    corner: int
    rest: bool
    dead: int
    flat: float


def direction(x: int, z: int) -> tuple[int, int]:
    """(x, z) with the length UNIT, within one percent."""
    larger, smaller = max(abs(x), abs(z)), min(abs(x), abs(z))
    while larger > 255:
        larger, smaller = larger >> 1, smaller >> 1
    slope = 255 if larger == smaller else (smaller << 8) // larger
    long = 32768 // (256 + round(256 * (math.hypot(1, slope / 256) - 1)))
    short = long * slope >> 8
    unit_x, unit_z = (short, long) if abs(x) < abs(z) else (long, short)
    return int(math.copysign(unit_x, x)), int(math.copysign(unit_z, z))


def tangents(move: Move) -> tuple[tuple[int, int], tuple[int, int]]:
    """The directions at the start and at the end of a move."""
    if move.kind is SegmentKind.LINE:
        there = direction(move.dx, move.dz)
        return there, there
    ends = []
    for dz, dx in ((0, 0), (move.dz, move.dx)):
        x, z = -move.cx + dx * CENTRE_UNIT, -move.cz + dz * CENTRE_UNIT
        while max(abs(x), abs(z)) > 32767:
            x, z = x >> 1, z >> 1
        convex = move.kind is SegmentKind.CONVEX
        ends.append(direction(z, -x) if convex else direction(-z, x))
    return ends[0], ends[1]


def sizes(move: Move) -> tuple[float, float]:
    """Entries of a move and its length along the path, both in steps."""
    if move.kind is SegmentKind.LINE:
        return float(max(abs(move.dx), abs(move.dz))), math.hypot(move.dx, move.dz)
    radius = math.hypot(move.cx, move.cz) / CENTRE_UNIT
    first = math.atan2(-move.cx, -move.cz)
    last = math.atan2(move.dx - move.cx / CENTRE_UNIT, move.dz - move.cz / CENTRE_UNIT)
    sweep = (last - first if move.kind is SegmentKind.CONVEX else first - last) % math.tau
    low = first if move.kind is SegmentKind.CONVEX else first - sweep
    entries = radius * (_faster(low + sweep) - _faster(low))
    return max(entries, abs(move.dx), abs(move.dz)), radius * sweep


def x_turns(move: Move) -> list[int]:
    """The directions of X in a move, one after the other, 1 or -1; 0 where X does not move."""
    if move.kind is not SegmentKind.LINE and move.dz * CENTRE_UNIT < move.cz < 0:
        return [1, -1] if move.kind is SegmentKind.CONVEX else [-1, 1]
    return [(move.dx > 0) - (move.dx < 0)]


def x_way(move: Move) -> int:
    """Steps of X in a move."""
    if len(x_turns(move)) == 1:
        return abs(move.dx)
    radius, centre = math.hypot(move.cx, move.cz) / CENTRE_UNIT, move.cx / CENTRE_UNIT
    apex = centre + (radius if move.kind is SegmentKind.CONVEX else -radius)
    return round(abs(apex) + abs(move.dx - apex))


def _faster(angle: float) -> float:
    """The way of the faster axis along a circle of radius 1, from angle 0."""
    quarters, angle = divmod(angle, math.pi / 2)
    part = math.sin(angle) if angle < math.pi / 4 else math.sqrt(2) - math.cos(angle)
    return quarters * math.sqrt(2) + part


def _axis_limit(limit: int, share: int) -> int:
    """The rate along the path at which an axis with this share reaches its limit."""
    return NO_LIMIT if share <= TANGENT else min(NO_LIMIT, (limit << 7) // share)


class LegPlanner:
    """Plans moves one after the other; remembers directions and which way the screws turned."""

    def __init__(self, drives: Drives) -> None:
        """The tool stands where homing leaves it: both screws turned in the negative direction."""
        self.drives = drives
        self.end: tuple[int, int] | None = None
        self.turned = {"x": -1, "z": -1}

    def chain(self, moves: Sequence[Move]) -> Iterator[Leg]:
        """The legs of moves that begin and end with a stand."""
        self.end = None
        for move in moves:
            yield self._leg(move)

    def _leg(self, move: Move) -> Leg:
        drives = self.drives
        first, last = tangents(move)
        most_x, most_z = drives.capped(drives.rapid_x), drives.capped(drives.rapid_z)
        most = min(most_x, most_z)
        if move.kind is SegmentKind.LINE:
            most = min(_axis_limit(most_x, abs(first[0])), _axis_limit(most_z, abs(first[1])))
        wanted = drives.rapid_z if move.dz else drives.rapid_x
        rate = min(wanted if move.rapid else move.feed / FEED_UNIT, most)
        corner, rest = self._corner(first)
        self.end = last
        entries, length = sizes(move)
        dead, flat = self._dead(move, length)
        return Leg(entries, length, rate, min(corner, drives.distance(int(rate))), rest, dead, flat)

    def _corner(self, first: tuple[int, int]) -> tuple[int, bool]:
        """The braking distance that the change of direction allows, and whether to rest."""
        drives = self.drives
        stop = drives.distance(drives.start)
        if self.end is None:
            return stop, False
        turn_x, turn_z = abs(first[0] - self.end[0]), abs(first[1] - self.end[1])
        if max(turn_x, turn_z) > BACK:
            return stop, True
        rate = min(_axis_limit(drives.start_x, turn_x), _axis_limit(drives.start_z, turn_z))
        return (NO_LIMIT if rate == NO_LIMIT else drives.distance(rate)), False

    def _dead(self, move: Move, length: float) -> tuple[int, float]:
        """Dead steps before a move, and those in it that its flat top does not hide."""
        directions = {"x": x_turns(move), "z": [move.dz]}
        before, within = 0, 0.0
        for axis, dead in (("x", self.drives.dead_x), ("z", self.drives.dead_z)):
            for place, way in enumerate(directions[axis]):
                if not way:
                    continue
                sign = 1 if way > 0 else -1
                if sign != self.turned[axis] and place == 0:
                    before = max(before, dead)
                elif sign != self.turned[axis]:
                    top = math.sqrt(math.hypot(move.cx, move.cz) / CENTRE_UNIT)
                    within += max(0.0, dead - min(top, FLAT) - top)
                self.turned[axis] = sign
        return before, min(within, length)


def exits(legs: Sequence[Leg], drives: Drives) -> Iterator[int]:
    """What may be left to brake behind each leg, half steps, as far as the chip looks ahead."""
    stop = drives.distance(drives.start)
    for present in range(len(legs)):
        allowed = stop
        for leg in reversed(legs[present + 1 : present + 1 + AHEAD]):
            allowed = min(leg.corner, allowed + 2 * int(leg.entries))
        yield allowed
