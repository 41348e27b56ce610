# SPDX-License-Identifier: Apache-2.0
"""Brings a lathe into each column of firmware/lathe/states.toml."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tornillo.frames import crc16
from tornillo.image import Segment, SegmentKind
from tornillo.link import Link
from tornillo.protocol import REQUESTS, UPLOAD_PIECE_MAX, Command, HomedAxis, State
from virtual_lathe.machine import AxisName

from simulated import little_pin
from simulated.bench import Bench

#: The part that is cut: a face, a cylinder, a rounding, a pause, and a thinner cylinder.
ROUNDING = Segment(SegmentKind.CONVEX, -20, 20, -20 * 256, 0)
OPERATIONS = (
    *little_pin.OPERATIONS,
    little_pin.contour(0, 15, ROUNDING),
    little_pin.pause("look"),
    little_pin.cylinder(0, -40, 25),
)
OTHER, THIRD = little_pin.image("other"), little_pin.image("third")
IDLE_MS = 700
#: Far enough from the switch to be under way for a while.
START_X = -900
#: Where moves by hand go to, in front of the bar, and how fast: contact is a collision then.
FAR_X, FAST = -300, 300
#: How long a JOG goes on when the host is not heard.
PATIENCE_MS = 500


@dataclass
class Walker:
    """A lathe in one situation.

    ``other`` is the slot of a second part, which is not the selected one; of a third part all
    pieces but ``last_piece`` have been sent.
    """

    bench: Bench
    link: Link
    other: int
    last_piece: bytes

    def send(self, command: Command, *values: int | bytes, data: bytes = b"") -> bytes:
        """Send a request made of numbers and data."""
        return self.link.request(command, REQUESTS[command].pack(*values) + data)


def _send_third(link: Link) -> bytes:
    """Send all of a third part but its last piece, which is returned."""
    begin = REQUESTS[Command.UPLOAD_BEGIN].pack(len(THIRD), crc16(THIRD))
    link.request(Command.UPLOAD_BEGIN, begin)
    for offset in range(0, len(THIRD), UPLOAD_PIECE_MAX):
        piece = REQUESTS[Command.UPLOAD_DATA].pack(offset) + THIRD[offset:][:UPLOAD_PIECE_MAX]
        if offset + UPLOAD_PIECE_MAX >= len(THIRD):
            return piece
        link.request(Command.UPLOAD_DATA, piece)
    raise AssertionError("the image is empty")


def _prepared() -> Walker:
    """A homed lathe with two parts and most of a third."""
    bench = Bench(**(little_pin.OPTIONS | {"start_x": START_X}))
    bench.set(zero_x=little_pin.ZERO_X, zero_z=little_pin.ZERO_Z, homing_repeats=1, idle_ms=IDLE_MS)
    bench.set(probe_fitted=1)
    other = bench.host.upload(OTHER)
    bench.host.upload(little_pin.image("walked", OPERATIONS))
    link = Link(bench.lathe.port)
    link.request(Command.HELLO)
    return Walker(bench, link, other, _send_third(link))


def _idle() -> Walker:
    walker = _prepared()
    walker.send(Command.HOME, HomedAxis.X | HomedAxis.Z)
    walker.bench.wait_for(State.IDLE)
    return walker


def _homing() -> Walker:
    walker = _prepared()
    walker.send(Command.HOME, HomedAxis.X | HomedAxis.Z)
    walker.bench.run(0.05)
    return walker


def _running() -> Walker:
    """In the first cut of the cylinder."""
    walker = _idle()
    walker.send(Command.RUN, 0xFF, 0)
    bench = walker.bench
    bench.wait(lambda: bench.position[1] < little_pin.ZERO_Z - 8, 5.0, every=1e-3)
    return walker


def _hold() -> Walker:
    walker = _running()
    walker.send(Command.HOLD)
    walker.bench.run(0.2)
    return walker


def _pause() -> Walker:
    walker = _running()
    walker.bench.wait_for(State.PAUSE)
    return walker


def _moving() -> Walker:
    """On the way to a place in front of the bar."""
    walker = _idle()
    walker.send(Command.GOTO, FAR_X, walker.bench.position[1], FAST)
    walker.bench.run(0.1)
    return walker


def _adrift() -> Walker:
    """The same by jogging, not homed."""
    walker = _unhomed()
    walker.send(Command.JOG, FAR_X, walker.bench.position[1], FAST, PATIENCE_MS)
    walker.bench.run(0.1)
    return walker


def _touching() -> Walker:
    """In a search of some seconds; the coils keep their current when it is over."""
    walker = _idle()
    walker.bench.set(idle_ms=-1)
    walker.send(Command.TOUCH, FAR_X, walker.bench.position[1])
    walker.bench.run(0.1)
    return walker


def _alarm() -> Walker:
    """The switch of X closes and opens again."""
    walker = _idle()
    for broken in (True, False):
        walker.bench.lathe.machine.break_switch_wire(AxisName.X, broken)
        walker.bench.run(0.02)
    return walker


def _unhomed() -> Walker:
    walker = _alarm()
    walker.send(Command.RESET)
    return walker


def _estop() -> Walker:
    walker = _idle()
    walker.bench.lathe.press("estop")
    walker.bench.run(0.02)
    return walker


SITUATIONS: dict[str, Callable[[], Walker]] = {
    "idle": _idle,
    "unhomed": _unhomed,
    "homing": _homing,
    "running": _running,
    "hold": _hold,
    "pause": _pause,
    "moving": _moving,
    "adrift": _adrift,
    "touching": _touching,
    "alarm": _alarm,
    "estop": _estop,
}
#: Where the chip trusts its position.
HOMED = {"idle", "running", "hold", "pause", "moving", "touching"}
#: Where motors turn.
MOVING = {"homing", "running", "moving", "adrift", "touching"}
