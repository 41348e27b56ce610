# SPDX-License-Identifier: Apache-2.0
"""What motion should be, computed independently of the firmware, in floating point.

Lengths are full steps, rates steps/s along the path, angles radians from +X towards +Z. Segments
count from the point where the one before has ended.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

Point = tuple[int, int]
CENTRE_UNIT = 256


@dataclass(frozen=True)
class Line:
    """A straight move by (dx, dz) steps at a rate in steps/s."""

    dx: int
    dz: int
    rate: float = 1000.0
    rapid: bool = False

    @property
    def end(self) -> Point:
        """End of the segment, from its start."""
        return self.dx, self.dz

    @property
    def length(self) -> float:
        """Length of the true path."""
        return math.hypot(self.dx, self.dz)

    def distance(self, point: Point) -> float:
        """Distance of a point, given from the start, from the nearest point of the line."""
        length = self.length
        if length == 0.0:
            return math.hypot(*point)
        along = (point[0] * self.dx + point[1] * self.dz) / length
        if along < 0.0:
            return math.hypot(*point)
        if along > length:
            return math.hypot(point[0] - self.dx, point[1] - self.dz)
        return abs(point[0] * self.dz - point[1] * self.dx) / length

    def direction(self, _point: tuple[float, float]) -> tuple[float, float]:
        """Unit vector of travel near a point given from the start."""
        return self.dx / self.length, self.dz / self.length


@dataclass(frozen=True)
class Arc:
    """A circular arc to (dx, dz) about the true centre (cx, cz), both from the start.

    ``towards_z`` is the sense: from +X towards +Z, the angle grows. The firmware is given the
    centre rounded to 1/256 step.
    """

    dx: int
    dz: int
    cx: float
    cz: float
    towards_z: bool
    rate: float = 1000.0
    rapid: bool = False

    @property
    def end(self) -> Point:
        """End of the segment, from its start."""
        return self.dx, self.dz

    @property
    def radius(self) -> float:
        """Radius through the start."""
        return math.hypot(self.cx, self.cz)

    @property
    def rounded_centre(self) -> tuple[int, int]:
        """The centre as the firmware gets it, 1/256 step."""
        return round(self.cx * CENTRE_UNIT), round(self.cz * CENTRE_UNIT)

    @property
    def start_angle(self) -> float:
        """Angle of the start seen from the centre."""
        return math.atan2(-self.cz, -self.cx)

    @property
    def sweep(self) -> float:
        """Angle of the whole arc, 0 to 2 pi."""
        return self.angle_of((self.dx, self.dz))

    @property
    def length(self) -> float:
        """Length of the true path."""
        return self.radius * self.sweep

    def angle_of(self, point: tuple[float, float]) -> float:
        """Angle travelled when the path passes a point given from the start, 0 to 2 pi."""
        angle = math.atan2(point[1] - self.cz, point[0] - self.cx) - self.start_angle
        return (angle if self.towards_z else -angle) % math.tau

    def distance(self, point: Point) -> float:
        """Distance of a point, given from the start, from the nearest point of the arc."""
        if self.angle_of(point) <= self.sweep:
            return abs(math.hypot(point[0] - self.cx, point[1] - self.cz) - self.radius)
        return min(math.hypot(*point), math.hypot(point[0] - self.dx, point[1] - self.dz))

    def direction(self, point: tuple[float, float]) -> tuple[float, float]:
        """Unit vector of travel near a point given from the start."""
        x, z = point[0] - self.cx, point[1] - self.cz
        size = math.hypot(x, z)
        sign = 1.0 if self.towards_z else -1.0
        return -z / size * sign, x / size * sign


@dataclass(frozen=True)
class Wait:
    """A pause in milliseconds, 1..255."""

    milliseconds: int


@dataclass(frozen=True)
class Output:
    """The relays: bit 6 spindle, bit 7 coolant."""

    relays: int


@dataclass(frozen=True)
class Signal:
    """A number for the main loop."""

    number: int


Move = Line | Arc
Segment = Line | Arc | Wait | Output | Signal


def arc_through(
    dx: int, dz: int, radius: float, towards_z: bool, long_way: bool, rate: float = 1000.0
) -> Arc:
    """The arc of a radius from (0, 0) to (dx, dz); a radius below half the chord is raised."""
    chord = math.hypot(dx, dz)
    if chord == 0.0:
        raise ValueError("an arc needs two different end points")
    height = math.sqrt(max(0.0, radius * radius - chord * chord / 4.0))
    left = towards_z != long_way
    side = 1.0 if left else -1.0
    cx = dx / 2.0 - side * height * dz / chord
    cz = dz / 2.0 + side * height * dx / chord
    return Arc(dx, dz, cx, cz, towards_z, rate)


def arc_between(
    radius: float, start: float, sweep: float, towards_z: bool, rate: float = 1000.0
) -> Arc:
    """The arc nearest to a start angle and a sweep whose ends are points of the grid."""
    sign = 1.0 if towards_z else -1.0
    stop = start + sign * sweep
    dx = round(radius * (math.cos(stop) - math.cos(start)))
    dz = round(radius * (math.sin(stop) - math.sin(start)))
    return arc_through(dx, dz, radius, towards_z, sweep > math.pi, rate)


def entry_length(move: Move, before: Point, after: Point) -> float:
    """True path length of the step between two neighbouring visited points, from the start.

    One grid unit of the faster axis, seen along the direction of the path between the points.
    """
    middle = (before[0] + after[0]) / 2.0, (before[1] + after[1]) / 2.0
    ux, uz = move.direction(middle)
    return 1.0 / max(abs(ux), abs(uz))


def jump(before: Move, after: Move) -> float:
    """Largest change of either axis' share of the direction where two moves meet, 0 to 2."""
    x1, z1 = before.direction(before.end)
    x2, z2 = after.direction((0.0, 0.0))
    return max(abs(x2 - x1), abs(z2 - z1))


def limits_kept(move: Move, rate: float, maximum_x: float, maximum_z: float) -> float:
    """The rate with which a move may be made so that neither axis is faster than its maximum.

    For an arc the slower of the two maxima counts, because it may cross any direction.
    """
    if isinstance(move, Arc):
        return min(rate, maximum_x, maximum_z)
    ux, uz = abs(move.dx) / move.length, abs(move.dz) / move.length
    if ux > 0.0:
        rate = min(rate, maximum_x / ux)
    if uz > 0.0:
        rate = min(rate, maximum_z / uz)
    return rate


def ramp_time(length: float, rate: float, start: float, acceleration: float) -> float:
    """Least time for a length from and to the start/stop rate without exceeding ``rate``."""
    if rate <= start:
        return length / rate
    ramps = (rate * rate - start * start) / acceleration
    if ramps >= length:
        peak = math.sqrt(start * start + acceleration * length)
        return 2.0 * (peak - start) / acceleration
    return 2.0 * (rate - start) / acceleration + (length - ramps) / rate


@dataclass(frozen=True)
class Corner:
    """A point of the speed plan: how far it is from the start and how fast it may be passed."""

    at: float
    rate: float


def profile_time(
    lengths: Sequence[float],
    rates: Sequence[float],
    joints: Sequence[float],
    acceleration: float,
    start: float,
) -> float:
    """Least time of a chain: speeds at the joints from both passes, then each segment's own.

    ``joints`` are the highest rates between neighbouring segments; both ends have ``start``.
    """
    ends = [start, *joints, start]
    for i, length in enumerate(lengths):
        ends[i + 1] = min(ends[i + 1], math.sqrt(ends[i] ** 2 + 2 * acceleration * length))
    for i in range(len(lengths) - 1, -1, -1):
        ends[i] = min(ends[i], math.sqrt(ends[i + 1] ** 2 + 2 * acceleration * lengths[i]))
    total = 0.0
    for i, length in enumerate(lengths):
        total += _segment_time(length, max(rates[i], start), ends[i], ends[i + 1], acceleration)
    return total


def _segment_time(
    length: float, rate: float, first: float, last: float, acceleration: float
) -> float:
    peak = math.sqrt((first * first + last * last) / 2.0 + acceleration * length)
    if peak <= rate:
        return (2.0 * peak - first - last) / acceleration
    ramps = (2.0 * rate * rate - first * first - last * last) / (2.0 * acceleration)
    return (2.0 * rate - first - last) / acceleration + (length - ramps) / rate
