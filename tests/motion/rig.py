# SPDX-License-Identifier: Apache-2.0
"""Drives chains of segments through the unchanged firmware on a simulated chip.

The chip runs a part that was uploaded once, started with the RUN button. Whenever its path asks
path_source() for the next segment, the rig overwrites the answer in RAM. The coils tell what the
motors did.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import SimpleNamespace

from simulated import little_pin
from tornillo import Lathe, link
from tornillo.protocol import SettingId, State
from virtual_lathe.chip import CYCLES_PER_SECOND, Chip, Drive, Reset, Stop
from virtual_lathe.serial_port import SerialPort
from virtual_lathe.usb_host import UsbHost

from .reference import Arc, Line, Output, Segment, Wait
from .trace import COIL_PINS, Trace, decode

ROOT = Path(__file__).resolve().parents[2]
FIRMWARE = Path(os.environ.get("MOTION_FIRMWARE", ROOT / "build" / "firmware" / "tornillo.hex"))
PATH_HEADER = ROOT / "firmware" / "motion" / "path.h"
WREG, STATUS, TOSL = 0xFE8, 0xFD8, 0xFFD
PIE2 = 0xFA0
ZERO = 0x04
RUN_PIN, HOLD_PIN, STOP_PIN = "RD4", "RD5", "RD6"
PRESS_TIMEOUT_S = 0.1
LOOK_CYCLES, HOLD_LOOK_CYCLES = 1_200, 120
# The chip filters its inputs for 4 ms.
RELEASE_CYCLES = 72_000
HOLD_AFTER_CYCLES = 14_000
BOOT_S = 0.02
RATE_UNIT = 256
FIELD_BYTES = {"int16_t": 2, "uint16_t": 2, "int32_t": 4, "uint32_t": 4, "uint8_t": 1}
CW, CCW, WAIT, OUTPUT, SIGNAL = "ARC_CW", "ARC_CCW", "WAIT", "OUTPUT", "SIGNAL"


class MotionFault(AssertionError):
    """The firmware did not finish a chain: alarm, reset, or no end in time."""


def segment_layout() -> tuple[dict[str, int], dict[str, int]]:
    """Offsets of the fields of struct segment and numbers of its kinds, from path.h."""
    text = PATH_HEADER.read_text(encoding="ascii")
    body = text[text.index("struct segment {") : text.index("};")]
    offsets: dict[str, int] = {}
    at = 0
    for kind, name in re.findall(r"^\s+(\w+) (\w+);", body, re.MULTILINE):
        offsets[name] = at
        at += FIELD_BYTES[kind]
    kinds = {
        name: int(number, 0) for name, number in re.findall(r"SEGMENT_(\w+) (0x\w+|\d+)", text)
    }
    return offsets, kinds


class Rig:
    """A chip with firmware, all inputs at rest, no machine behind the pins.

    Args:
        usb: leave the cable in and the port open, for tests with USB traffic.
        firmware: the hex file; its map must be beside it.
    """

    def __init__(self, usb: bool = False, firmware: Path = FIRMWARE) -> None:
        """Boot the firmware, store a part in it, and hold it to be homed."""
        self.chip = Chip(firmware)
        self.symbols = self.chip.symbols
        self.offsets, self.kinds = segment_layout()
        for pin in ("RB4", "RB5", "RD7"):
            self.chip.drive(pin, Drive.LOW)
        for pin in (RUN_PIN, HOLD_PIN, STOP_PIN):
            self.chip.drive(pin, Drive.OPEN)
        self._rest: Iterator[Segment] = iter(())
        self.asked: list[int] = []
        self._coils = (0, 0)
        self._settings: dict[str, int] = {}
        self._answer_at = -1
        self._released = 0
        self._resets = 1
        self.host = UsbHost(self.chip, self.run_to)
        self.usb = usb
        self.chip.run(BOOT_S)
        self._store_part()
        self._find_answer()
        self.settle()

    def _plug(self) -> None:
        self.host.plug()
        self.host.enumerate()
        self.host.open_port()

    def connect(self) -> Lathe:
        """The host library at the other end of the cable, for a rig with USB."""
        vars(link)["time"] = SimpleNamespace(monotonic=lambda: self.chip.seconds)
        return Lathe(SerialPort(self.host))

    def _store_part(self) -> None:
        """Upload a part: without one the chip has nothing to run.

        One that takes the chip no time: it must not compute passes while it answers.
        """
        self._plug()
        self.connect().upload(little_pin.image("harness", (little_pin.pause(),)))
        self.host.unplug()
        self.chip.set_variable("machine_homed", 1)

    def _find_answer(self) -> None:
        """Find out where path_source() returns to.

        Where the function was put in place of its only call, the map names the end of it; else the
        chip is let ask once.
        """
        if "_end_path_source" in self.symbols.program:
            self._answer_at = self.symbols.code("end_path_source")
        else:
            self._push(RUN_PIN)
            if not self.chip.run_to_address(self.symbols.code("path_source")):
                raise MotionFault("the firmware never asks for a segment")
            self._answer_at = self.chip.read(TOSL) | self.chip.read(TOSL + 1) << 8
        self.chip.set_break(self._answer_at)

    # -- time -------------------------------------------------------------------------------------

    def run_to(self, cycle: int) -> None:
        """Run to a cycle, answering the firmware's questions for segments on the way."""
        reason = Stop.ADDRESS
        while reason == Stop.ADDRESS:
            reason = self.chip.run_to(cycle)
            # The end of the time may fall on the very place: going on does not stop there again.
            if self.asks:
                self.answer()

    def run(self, seconds: float) -> None:
        """Let simulated time pass."""
        self.run_to(self.chip.cycle + round(seconds * CYCLES_PER_SECOND))

    @property
    def asks(self) -> bool:
        """The chip has just asked for the next segment."""
        return self.chip.pc == self._answer_at

    def answer(self) -> None:
        """Give the next segment instead of what path_source() has come back with."""
        segment = next(self._rest, None)
        self.asked.append(self.chip.cycle)
        if segment is not None:
            self._describe(segment)
        else:
            self.chip.set_variable("passes_more", 0)  # nor is this the way to a pause
        self.chip.poke(WREG, int(segment is not None))
        status = self.chip.peek(STATUS)
        self.chip.poke(STATUS, status & ~ZERO if segment is not None else status | ZERO)

    def _describe(self, segment: Segment) -> None:
        fields: dict[str, tuple[int, int]] = {"mark": (0, 1)}
        rate, rapid = 1000.0, False
        if isinstance(segment, Line | Arc):
            fields |= {"dx": (segment.dx, 2), "dz": (segment.dz, 2)}
            rate, rapid = segment.rate, segment.rapid
            kind = "LINE"
            if isinstance(segment, Arc):
                kind = CCW if segment.towards_z else CW
                cx, cz = segment.rounded_centre
                fields |= {"cx": (cx, 4), "cz": (cz, 4)}
        elif isinstance(segment, Wait):
            kind, fields["dx"] = WAIT, (segment.milliseconds, 2)
        elif isinstance(segment, Output):
            kind, fields["dx"] = OUTPUT, (segment.relays, 2)
        else:
            kind, fields["dx"] = SIGNAL, (segment.number, 2)
        fields["kind"] = (self.kinds[kind] | (self.kinds["RAPID"] if rapid else 0), 1)
        base = self.symbols.ram("path_next")
        for name, (value, size) in fields.items():
            self.chip.poke(base + self.offsets[name], value & (1 << 8 * size) - 1, size)
        self.chip.set_variable("path_rate", round(rate * RATE_UNIT), 4)

    # -- hands ------------------------------------------------------------------------------------

    def _press(self, pin: str, until: Callable[[], bool], look: int = LOOK_CYCLES) -> None:
        """Hold a button down until something has come of it; not too soon after the last time."""
        if self.chip.level(pin):
            self.run_to(self._released + RELEASE_CYCLES)
        self.chip.drive(pin, Drive.LOW)
        self._await(pin, until, look)
        self.chip.drive(pin, Drive.OPEN)
        self._released = self.chip.cycle

    def _await(self, pin: str, until: Callable[[], bool], look: int) -> None:
        """Run until something has come of a button."""
        end = self.chip.cycle + round(PRESS_TIMEOUT_S * CYCLES_PER_SECOND)
        while not until():
            if self.chip.cycle >= end:
                raise MotionFault(f"nothing happens on {pin}, state {self.state.name}")
            self.run_to(self.chip.cycle + look)

    def _push(self, pin: str) -> None:
        """Push a button and let it go: RUN acts then, because a long press means another thing."""
        self.run_to(self._released + RELEASE_CYCLES)
        self.chip.drive(pin, Drive.LOW)
        self.run_to(self.chip.cycle + RELEASE_CYCLES)
        self.chip.drive(pin, Drive.OPEN)
        self._released = self.chip.cycle

    def hold(self) -> None:
        """Press the HOLD button; comes back within 10 us of the chip's taking notice."""
        self._press(HOLD_PIN, lambda: self.state != State.RUNNING, HOLD_LOOK_CYCLES)

    def resume(self) -> None:
        """Press the RUN button in a hold."""
        self._press(RUN_PIN, lambda: self.state != State.HOLD)

    def tap(self, button: str) -> None:
        """Press "run" or "hold" when nothing is to come of it."""
        self._push({"run": RUN_PIN, "hold": HOLD_PIN}[button])

    def stop(self) -> None:
        """Press the STOP button while something runs."""
        self._press(STOP_PIN, lambda: self.state in (State.IDLE, State.ALARM))

    def settle(self, **settings: int) -> None:
        """Restart the chip with settings, by their names in lower case; the others are kept.

        They are put in when the firmware has loaded its own, so that a range may be exceeded.
        """
        self._settings |= settings
        self.host.unplug()
        self.chip.reset(Reset.MCLR)
        self._resets = len(self.chip.resets)
        # The first that the machine does with its settings loaded.
        if not self.chip.run_to_address(self.symbols.code("path_cancel")):
            raise MotionFault("the firmware does not take its settings into use")
        base = self.symbols.ram("settings")
        for name, value in self._settings.items():
            self.chip.poke(base + 2 * SettingId[name.upper()], value & 0xFFFF, 2)
        self.chip.run(BOOT_S)
        if self.usb:
            self._plug()
        self.chip.set_variable("machine_homed", 1)

    def recover(self) -> None:
        """Back to IDLE and homed, whatever has happened: a restart."""
        self.settle()

    def ready(self) -> Rig:
        """The rig, restarted if what was before has left it in trouble."""
        if not self.is_in(State.IDLE):
            self.recover()
        return self

    def quick(self, rate: int = 20_000, acceleration: int = 32_000, top: int = 32_000) -> None:
        """Settings without ramps up to a rate: it is the start/stop rate of both axes.

        ``top`` is the highest rate of both axes, at most 65,535.
        """
        self.settle(
            acceleration=acceleration,
            start_rate_x=rate,
            start_rate_z=rate,
            rapid_rate_x=top,
            rapid_rate_z=top,
        )

    def dead_steps(self, x: int, z: int, slack_x: int = 0, slack_z: int = 0) -> None:
        """Give the axes dead steps; slack 0 means last turned in the positive direction."""
        self.chip.set_variable("motion_dead_x", x, 2)
        self.chip.set_variable("motion_dead_z", z, 2)
        self.chip.set_variable("slack_x", slack_x & 0xFFFF, 2)
        self.chip.set_variable("slack_z", slack_z & 0xFFFF, 2)

    # -- chains -----------------------------------------------------------------------------------

    def start(self, chain: Sequence[Segment]) -> None:
        """Begin a chain: the next question for a segment is answered with its first one."""
        self._rest = iter(chain)
        self.asked = []
        self.chip.log_pins(*COIL_PINS)
        self._push(RUN_PIN)
        self._await(RUN_PIN, lambda: bool(self.asked), LOOK_CYCLES)
        self.chip.pin_changes()
        self._coils = (self.chip.port("D") & 15, self.chip.port("B") & 15)

    @property
    def state(self) -> State:
        """State of the machine."""
        return State(self.chip.variable("machine_state"))

    def start_and_hold(self, chain: Sequence[Segment]) -> None:
        """Let RUN go and, 1.2 ms later, press HOLD: the chip sees it before the first step."""
        self._rest = iter(chain)
        self.asked = []
        self.chip.log_pins(*COIL_PINS)
        self._push(RUN_PIN)
        self.run_to(self.chip.cycle + HOLD_AFTER_CYCLES)
        self.chip.drive(HOLD_PIN, Drive.LOW)
        self._await(RUN_PIN, lambda: bool(self.asked), LOOK_CYCLES)
        self.chip.pin_changes()
        self._coils = (self.chip.port("D") & 15, self.chip.port("B") & 15)
        self.hold()

    def is_in(self, state: State) -> bool:
        """Whether the machine is in a state now."""
        return self.state is state

    @property
    def stepping(self) -> bool:
        """The step interrupt is at work: it is switched off when a hold has come to a stand."""
        return bool(self.chip.peek(PIE2) & 1)

    @property
    def position(self) -> tuple[int, int]:
        """Tool position that the chip counts, 16 bits."""
        return (
            self.chip.variable("position_x", 2, signed=True),
            self.chip.variable("position_z", 2, signed=True),
        )

    def finish(self, timeout: float, every: float = 2e-3) -> None:
        """Run until the chain is complete.

        Raises:
            MotionFault: alarm, reset, or not complete after ``timeout`` simulated seconds.
        """
        end = self.chip.cycle + round(timeout * CYCLES_PER_SECOND)
        slice_cycles = round(every * CYCLES_PER_SECOND)
        while self.state != State.IDLE:
            if self.state == State.ALARM:
                raise MotionFault(f"alarm {self.chip.variable('machine_alarm')}")
            if len(self.chip.resets) != self._resets:
                raise MotionFault(f"resets {self.chip.resets}")
            if self.chip.cycle >= end:
                raise MotionFault(f"not complete after {timeout} s, state {self.state.name}")
            self.run_to(self.chip.cycle + slice_cycles)

    def trace(self) -> Trace:
        """What the coils have done since :meth:`start`."""
        return decode(self.chip.pin_changes(), self._coils)

    def follow(
        self,
        chain: Sequence[Segment],
        timeout: float = 10.0,
        meanwhile: Callable[[Rig], None] | None = None,
    ) -> Trace:
        """Run a chain to its end; ``meanwhile`` is called once when it has begun."""
        before = self.position
        self.start(chain)
        if meanwhile is not None:
            meanwhile(self)
        self.finish(timeout)
        taken = self.trace()
        taken.counted = (
            (self.position[0] - before[0]) & 0xFFFF,
            (self.position[1] - before[1]) & 0xFFFF,
        )
        return taken
