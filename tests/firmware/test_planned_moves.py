# SPDX-License-Identifier: Apache-2.0
"""The host's plan against the moves that the chip itself describes, to the step.

The chip runs a part; what its path_source() comes back with is written down and replaced by a few
steps, so that a whole part takes it hardly more than the time of thinking.
"""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

from motion.rig import WREG, Rig
from planned import random_part as random_steps
from random_parts import random_part as random_file
from simulated.processes import on_a_new_chip
from tornillo import Part
from tornillo.errors import ChipError
from tornillo.image import PartImage
from tornillo.lathe import Lathe
from tornillo.machine import Machine
from tornillo.moves import Halt, Stop
from tornillo.planning import plan_part
from tornillo.protocol import FEED_UNIT, ErrorCode, State, ToolRecord

KIND, RAPID = 0x07, 0x80
RATE_UNIT = 256
#: What a move is replaced by: Z steps, so many that a full queue sets the stream going.
STEPS, FAST = 10, 1_000
TURN_AT = 2_000
TIMEOUT_S = 60.0
POLL_S = 2e-3
KNOWN = Machine.load()


class Told(NamedTuple):
    """A segment as the chip described it; its end in machine steps, feed 0 for a rapid."""

    z: int
    x: int
    kind: int
    feed: int
    centre: tuple[int, int]


class Listener(Rig):
    """Writes down every segment and lets the chip go on at once."""

    def __init__(self) -> None:
        """A homed lathe that has been told nothing."""
        self.told: list[Told] = []
        self.at = (0, 0)
        self.steps, self.shift = STEPS, 0
        super().__init__(usb=True)
        self.quick(FAST, top=1_000)

    def _field(self, name: str, size: int) -> int:
        value = self.chip.peek(self.symbols.ram("path_next") + self.offsets[name], size)
        return value - (1 << 8 * size) if value >> 8 * size - 1 else value

    def answer(self) -> None:
        """Write down what the chip is about to queue."""
        if not self.chip.peek(WREG):
            return
        dx, dz = self._field("dx", 2), self._field("dz", 2)
        kind = self._field("kind", 1) & 0xFF
        self.at = self.at[0] + dz, self.at[1] + dx
        arc = kind & KIND
        centre = (self._field("cz", 4), self._field("cx", 4)) if arc else (0, 0)
        rate = self.chip.variable("path_rate", 4)
        feed = 0 if kind & RAPID else rate * FEED_UNIT // RATE_UNIT
        self.told.append(Told(*self.at, arc, feed, centre))
        if abs(self.shift + self.steps) > TURN_AT:
            self.steps = -self.steps
        self.shift += self.steps
        base = self.symbols.ram("path_next")
        for name, value in (("dx", 0), ("dz", self.steps & 0xFFFF)):
            self.chip.poke(base + self.offsets[name], value, 2)
        self.chip.poke(base + self.offsets["kind"], 0, 1)
        self.chip.set_variable("path_rate", FAST * RATE_UNIT, 4)

    def cut(self, lathe: Lathe, image: bytes) -> list[Told]:
        """Run a part to its end, through all its pauses."""
        slot = lathe.upload(image)
        self.told, self.at = [], self.position[::-1]
        lathe.run(slot)
        end = self.chip.seconds + TIMEOUT_S
        while not self.is_in(State.IDLE):
            assert self.chip.seconds < end, self.state
            assert not self.is_in(State.ALARM), self.chip.variable("machine_alarm")
            if self.is_in(State.PAUSE):
                lathe.resume()
            self.run(POLL_S)
        lathe.delete(slot)
        return self.told


def expected(image: PartImage, machine: Machine) -> list[Told]:
    """The host's plan in machine steps."""
    tools = [record for record in image.records if isinstance(record, ToolRecord)]
    number = 0
    found: list[Told] = []
    for step in plan_part(image, machine).steps:
        tool = tools[number]
        for move in step.moves:
            z = move.end[0] + machine.zero_z + tool.offset_z
            x = move.end[1] + machine.zero_x + tool.offset_x
            found.append(Told(z, x, int(move.kind), move.feed, (move.cz, move.cx)))
        number += isinstance(step, Stop) and step.halt is Halt.TOOL
    return found


def compare(rig: Listener, lathe: Lathe, image: PartImage, machine: Machine) -> bool:
    """Whether the chip takes a part; it then makes the moves of the plan."""
    try:
        told = rig.cut(lathe, image.pack())
    except ChipError as error:
        if error.code is not ErrorCode.INVALID_PART:
            raise
        return False
    wanted = expected(image, machine)
    for place, (one, other) in enumerate(zip(told, wanted, strict=False)):
        assert one == other, (place, told[max(0, place - 3) : place + 3], wanted[place - 1 :][:4])
    assert len(told) == len(wanted)
    return True


@on_a_new_chip
def test_random_contours_are_cut_on_the_chip_move_by_move_as_planned() -> None:
    near = dataclasses.replace(KNOWN, zero_x=-400, zero_z=-200)
    rig = Listener()
    rig.settle(zero_x=near.zero_x, zero_z=near.zero_z)
    lathe = rig.connect()
    assert sum(compare(rig, lathe, random_steps(seed), near) for seed in range(60)) >= 30


@on_a_new_chip
def test_random_part_files_are_cut_on_the_chip_move_by_move_as_planned() -> None:
    rig = Listener()
    lathe = rig.connect()
    for seed in range(25):
        image = Part.parse(random_file(seed)).steps(KNOWN)
        assert compare(rig, lathe, image, KNOWN)
