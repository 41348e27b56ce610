# SPDX-License-Identifier: Apache-2.0
"""Part images whose numbers stand at the edges of the rules and of 16 bits.

Made number by number, not from a part file: most of them are no part at all, but broken in ways
that neither a person nor a bad cable would come upon.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from math import isqrt

from tornillo.image import (
    OPERATIONS,
    PartImage,
    Record,
    Segment,
    SegmentKind,
    pack_segments,
)
from tornillo.machine import Machine
from tornillo.protocol import (
    CONTOUR_FACING,
    SLOPE_ANY,
    ContourRecord,
    CutRecord,
    ImageHeader,
    PauseRecord,
    PlungeRecord,
    ToolRecord,
)

I16, U16 = range(-0x8000, 0x8000), range(0x10000)
I24 = range(-0x800000, 0x800000)
EXTREMES = (-0x8000, -0x7FFF, -32001, -32000, -1, 0, 1, 2, 32000, 32001, 0x7FFF, 0x8000, 0xFFFF)


def clipped(value: int, allowed: range) -> int:
    """Return the nearest number that a field can hold."""
    return min(max(value, allowed[0]), allowed[-1])


class Maker:
    """Makes one image from a seed; ``wild`` is how often a number is anything at all."""

    def __init__(self, seed: int, machine: Machine) -> None:
        """Choose the stock."""
        self.dice = random.Random(seed)
        self.machine = machine
        self.wild = self.dice.choice([0.0, 0.0, 0.0, 0.003, 0.02])
        room_x, room_z = -machine.zero_x, -machine.zero_z
        self.retract = self.edge(U16, 14, 14, 14, 2, 40)
        self.front = self.edge(U16, 1, 1, 50, 300, room_z - 2 * self.retract)
        self.radius = self.edge(U16, 60, 800, 1786, room_x - self.retract)
        self.length = self.edge(U16, 1000, 7143, machine.travel_z - room_z + self.retract)
        if self.dice.random() < 0.1:
            self.retract = self.edge(U16, 1, 8000, 0xFFFF)
            self.front = self.edge(U16, 8000, 0xFFFF)
            self.radius = self.edge(U16, 1, 32000, 0xFFFF)
            self.length = self.edge(U16, 1, 32000, 0xFFFF)
        self.tool = ToolRecord(0, b"t".ljust(12, b"\0"), 0, 0, 0, 148, SLOPE_ANY, 0, 0)

    def edge(self, allowed: range, *values: int) -> int:
        """Return one of some numbers or a neighbour; now and then anything."""
        dice = self.dice
        if dice.random() < self.wild:
            return clipped(dice.choice([*EXTREMES, dice.choice(allowed)]), allowed)
        return clipped(dice.choice(values) + dice.choice([0] * 60 + [-1, 1]), allowed)

    def image(self) -> bytes:
        """Return the bytes."""
        records: list[Record] = [self.changed_tool(turning=True), self.cut()]
        for _ in range(self.dice.choice([1, 2, 3, 6])):
            records += self.operation()
        if self.dice.random() < 0.005:
            records[2:2] = [PauseRecord(0, b"")] * self.dice.randint(60, 400)
        count = sum(isinstance(record, OPERATIONS) for record in records) & 0xFF
        header = ImageHeader(
            format=self.edge(range(256), *[2] * 20) if self.wild else 2,
            operation_count=self.edge(range(256), *[count] * 20) if self.wild else count,
            flags=self.dice.choice([0, 1]),
            reserved=0,
            name=b"nasty".ljust(16, b"\0"),
            step_x_nm=self.machine.step_x_nm,
            step_z_nm=self.machine.step_z_nm,
            stock_radius=self.radius,
            stock_length=self.length,
            stock_front=self.front,
            retract=self.retract,
        )
        return PartImage(header, tuple(records)).pack()

    def changed_tool(self, turning: bool) -> ToolRecord:
        """Return another tool, which is used from now on."""
        dice, machine = self.dice, self.machine
        room_x = -machine.zero_x - self.radius - self.retract
        room_z = -machine.zero_z - self.front - 2 * self.retract
        self.tool = ToolRecord(
            kind=self.edge(range(256), 1, 15) if self.wild else dice.randint(0, 15),
            name=b"tool".ljust(12, b"\0"),
            nose=dice.choice(U16),
            below=self.edge(U16, 1, 20, 112, 112),
            width=0 if turning else self.edge(U16, 2, 141, 422),
            back=self.edge(U16, 2, 45, 148, 256, 1000, SLOPE_ANY),
            front=self.edge(U16, 1000, SLOPE_ANY, SLOPE_ANY, SLOPE_ANY),
            offset_x=0,
            offset_z=dice.choice([0, 0, clipped(room_z // 2, I16), -70]),
        )
        if dice.random() < 0.05:
            self.tool = self.tool._replace(
                below=self.edge(U16, 0, 8000, 0x8000, 0xFFFF),
                width=self.edge(U16, 1, 8000, 0x8000, 0xFFFF),
                offset_x=self.edge(I16, 0, room_x, -room_x, 0x7FFF, -0x8000),
                offset_z=self.edge(I16, 0, room_z, -room_z, 0x7FFF, -0x8000),
            )
        return self.tool

    def cut(self) -> CutRecord:
        """Return cutting data."""
        fastest = self.machine.max_rate * 8
        depth = self.edge(U16, 2, 10, 50, max(1, self.radius))
        return CutRecord(
            kind=self.edge(range(256), 1, 8),
            depth_of_cut=depth,
            finish_allowance=self.edge(U16, 0, depth // 2, depth),
            feed=self.edge(U16, 33, 400, 3200, fastest - 1, 32, fastest),
            finish_feed=self.edge(U16, 33, 1600, fastest - 1),
            spindle=self.edge(U16, 0, 100, 2000, 3800) if self.dice.random() < 0.3 else 0,
            peck=self.edge(U16, 0, 70, 0xFFFF),
        )

    def operation(self) -> Sequence[Record]:
        """Return an operation, with another tool or cutting data in front of it where needed."""
        dice = self.dice
        found: list[Record] = []
        if dice.random() < 0.1:
            found.append(self.cut())
        kind = dice.choice(["face", "contour", "contour", "contour", "plunge", "pause"])
        plunges = kind == "plunge"
        if kind != "pause" and (self.tool.width > 0) is not plunges and dice.random() < 0.97:
            found.append(self.changed_tool(turning=not plunges))
        if kind == "pause":
            message = b"m" * dice.randint(0, 32)
            found.append(PauseRecord(self.edge(range(256), 0) if self.wild else 0, message))
        elif plunges:
            found.append(self.plunge())
        elif kind == "face":
            z = self.edge(I16, 0, 0, self.front)
            x = self.edge(I16, 0, -self.tool.below)
            line = Segment(SegmentKind.LINE, 0, clipped(self.radius - x, I16))
            found.append(ContourRecord(CONTOUR_FACING, z, x, pack_segments((line,))))
        else:
            found.append(self.contour())
        return found

    def plunge(self) -> PlungeRecord:
        """Return a groove or a cut to part off."""
        low = self.edge(I16, -100, -1000, self.retract - self.length)
        high = self.edge(I16, low, low + 300, self.front + self.retract - self.tool.width)
        kind = self.edge(range(256), 0) if self.wild else self.dice.randint(0, 1)
        return PlungeRecord(
            kind, high, low, self.edge(I16, 0, self.radius // 2, self.radius, -self.tool.below)
        )

    def contour(self) -> ContourRecord:
        """Return a chain of segments that mostly stays inside the stock."""
        dice = self.dice
        z = self.edge(I16, 0, 0, 0, 20, -200, self.front, self.front + self.retract)
        x = self.edge(I16, 0, self.radius // 2, self.radius, -self.tool.below)
        start_z, start_x = z, x
        facing = dice.random() < 0.2
        segments = []
        for _ in range(dice.choice([1, 1, 2, 3, 8])):
            segment = self.segment(z, x, facing)
            segments.append(segment)
            z, x = clipped(z + segment.dz, I16), clipped(x + segment.dx, I16)
        kind = dice.choice([1, 2, 3, 4]) + CONTOUR_FACING * facing
        if dice.random() < self.wild:
            kind = dice.randrange(256)
        data = pack_segments(tuple(segments))
        if dice.random() < self.wild:
            data = data[: dice.randrange(len(data) + 1)]
        return ContourRecord(kind, start_z, start_x, data)

    def segment(self, z: int, x: int, facing: bool) -> Segment:
        """Return a line or an arc from a place."""
        dice = self.dice
        highest, lowest = self.radius - x, -self.tool.below - x
        dx = self.edge(I16, 0, 0, highest, highest // 2, highest // 5, lowest // 3, lowest)
        dz = self.edge(I16, 0, -1, -30, -200, -dice.randint(1, 900), dice.choice([-9000, 1]))
        if facing:
            dx = min(abs(dx), I16[-1])
        if dice.random() < 0.5 or not dx or not dz:
            return Segment(SegmentKind.LINE, dz, dx)
        return self.arc(dz, dx)

    def arc(self, dz: int, dx: int) -> Segment:
        """Return an arc to a place, its centre not always where it should be."""
        dice = self.dice
        kind = dice.choice([SegmentKind.CONVEX, SegmentKind.CONCAVE])
        chord = isqrt(dz * dz + dx * dx)
        radius = dice.choice([chord // 2 + 1, chord, 2 * chord, 32000, 32001, 40000])
        height = isqrt(max(0, radius * radius - chord * chord // 4))
        side = 1 if kind is SegmentKind.CONVEX else -1
        # Right of the chord on the way to the chuck is towards the axis.
        cz = 128 * dz + 256 * side * height * dx // chord
        cx = 128 * dx - 256 * side * height * -dz // chord
        off = dice.choice([0, 0, 0, 128, 255, 256, 300, 511, 700, 2000])
        cz, cx = cz + dice.randint(-off, off), cx + dice.randint(-off, off)
        return Segment(kind, dz, dx, self.edge(I24, *[cz] * 9, 0), self.edge(I24, *[cx] * 9, 0))


def nasty_image(seed: int, machine: Machine) -> bytes:
    """Return the image of a seed."""
    return Maker(seed, machine).image()
