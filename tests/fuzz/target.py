# SPDX-License-Identifier: Apache-2.0
"""The firmware under fire, and what must stay true: alive, unmoved, no reset, RAM kept."""

from __future__ import annotations

import json
from collections.abc import Callable

from firmware.usb_bench import FIRMWARE, UsbBench
from simulated.processes import branch
from tornillo.frames import Frame, encode
from tornillo.protocol import REQUESTS, Command, ErrorCode, RunFlag, SettingId
from virtual_lathe.chip import Drive
from virtual_lathe.usb_host import UsbError

SIZES = FIRMWARE.with_name("size.json")
RAM_END = 0x800
ESTOP_PIN = "RD7"
#: Simulated seconds after which a request without answer is a hang.
HANG_S = 2.0
#: Counters of two bytes, which reach their upper bytes by and by: what makes the next count do so.
COUNTERS = {"milliseconds": 0xFFFF, "tick_high": 0x00FF, "frame_bad_frames": 0x00FF}
#: What happens by itself happens within this simulated time.
LONG_S = 3.0
IMAGE = bytes(range(84))


class Broken(AssertionError):
    """The firmware did what no nonsense may make it do."""


class Target:
    """A chip with the firmware at the end of a cable, watched.

    RAM that no well-formed request makes the firmware write is found out first, in a copy of the
    simulation; writing it is a failure from then on. The stack may be as deep as the build says.
    """

    def __init__(self) -> None:
        """Switch on, put the cable in, learn which RAM is written by right."""
        self.bench = UsbBench()
        self.bench.chip.drive(ESTOP_PIN, Drive.LOW)
        self.bench.enumerate()
        allowed = branch(self._learn)
        worst = json.loads(SIZES.read_text(encoding="utf-8"))["sw_stack_worst_bytes"]
        stack = set(range(RAM_END - worst, RAM_END))
        self.forbidden = set(range(RAM_END)) - allowed - stack
        for address in sorted(self.forbidden):
            self.bench.chip.watch_writes(address, address)
        self._entries = self.bench.chip.interrupt_cost(high=True).entries
        self._positions = self._position()

    def _learn(self) -> set[int]:
        """Everything a host can ask for by right, except motion; returns the RAM written."""
        chip = self.bench.chip
        chip.watch_writes(0, RAM_END - 1)
        for name, value in COUNTERS.items():
            chip.set_variable(name, value, 2)
        self._control_requests()
        self._link_requests()
        self._accidents()
        chip.run(LONG_S)
        return chip.written()

    def _control_requests(self) -> None:
        host = self.bench.host
        for value in (0x0100, 0x0200, 0x0300, 0x0301, 0x0302, 0x0303):
            host.control(0x80, 6, value, 0x0409, length=255)
        for endpoint in (0x81, 0x02, 0x82):
            host.control(0x02, 3, 0, endpoint)
            host.control(0x82, 0, 0, endpoint, length=2)
            host.control(0x02, 1, 0, endpoint)
        host.control(0x81, 0, 0, 1, length=2)
        host.control(0x81, 10, 0, 1, length=1)
        host.control(0x01, 11, 0, 1)
        host.control(0x21, 0x20, data=bytes(range(7)))
        host.control(0xA1, 0x21, length=7)
        host.control(0x21, 0x23, 100)
        self.bench.refuses(0xC0, 1, length=4)

    def _link_requests(self) -> None:
        bench = self.bench.open()
        seq = 0

        def ask(command: Command, *values: int, data: bytes = b"") -> bytes:
            nonlocal seq
            seq = seq % 255 + 1
            return bench.ask(seq, command, REQUESTS[command].pack(*values) + data)

        ask(Command.HELLO)
        for setting in SettingId:
            ask(Command.SETTING_GET, setting)
        ask(Command.SETTING_SET, SettingId.ZERO_X, -3000)
        for slot in (0, 7, 8):
            ask(Command.PART_SELECT, slot)
            ask(Command.PART_INFO, slot)
            ask(Command.PART_READ, slot, 0)
            ask(Command.RUN, slot, 0)
            ask(Command.RUN, slot, RunFlag.RESUME)
            ask(Command.PART_DELETE, slot)
        bench.ask(99, Command.SERIAL_SET, b"TN-00042")
        ask(Command.ZERO, 0, 0)
        ask(Command.OVERRIDE, 100)
        ask(Command.GOTO, 0, 0, 0)
        ask(Command.TOUCH, 0, 0)
        for command in (Command.HOLD, Command.RESUME, Command.STOP, Command.RESET):
            ask(command)
        for command in (Command.STATUS, Command.PROGRESS):
            ask(command)
        self._uploads(ask)
        bench.ask(1, 0x7F, bytes(56))
        bench.send_raw(b"\x02\x01\0", b"\xff" * 64 + b"\0", bytes(8))

    @staticmethod
    def _uploads(ask: Callable[..., bytes]) -> None:
        from simulated.little_pin import image
        from tornillo.frames import crc16

        for part in (IMAGE, image(), image(depth_of_cut=0)):
            ask(Command.UPLOAD_BEGIN, len(part), crc16(part))
            for offset in range(0, len(part), 32):
                ask(Command.UPLOAD_DATA, offset, data=part[offset : offset + 32])
            ask(Command.UPLOAD_COMMIT)
            ask(Command.PART_INFO, 0)
            ask(Command.PART_READ, 0, 0)
            ask(Command.RUN, 0, 0)

    def _accidents(self) -> None:
        host = self.bench.host
        host.suspend(True)
        host.wait(0.01)
        host.suspend(False)
        host.wait(0.002)
        host.reset_bus()
        host.unplug()
        host.wait(0.1)
        self.bench.open()

    def _position(self) -> tuple[int, int]:
        chip = self.bench.chip
        return chip.variable("position_x", 2), chip.variable("position_z", 2)

    def check(self) -> None:
        """Look at everything that can be seen without disturbing the chip.

        Raises:
            Broken: saying what is not as it must be.
        """
        chip = self.bench.chip
        if self.bench.host.mistakes:
            raise Broken(f"mistakes with the engine: {self.bench.host.mistakes}")
        if len(chip.resets) != 1:
            raise Broken(f"the chip restarted: {chip.resets}")
        entries = chip.interrupt_cost(high=True).entries
        if entries != self._entries or self._position() != self._positions:
            raise Broken(f"something moved: {entries - self._entries} step interrupts")
        stray = chip.written() & self.forbidden
        if stray:
            writes = [w for w in chip.ram_writes() if w.address in stray][:5]
            raise Broken(f"RAM written that is none of its business: {writes}")

    def check_alive(self) -> None:
        """Enumerate anew, open the port and be answered.

        Raises:
            Broken: it is not.
        """
        try:
            self.bench.open()
            self.bench.send_raw(b"\0")
            self.bench.receive_raw(timeout=0.02)
            answer = self.bench.ask(0, Command.HELLO)
        except (UsbError, AssertionError, ValueError) as error:
            raise Broken(f"the device does not answer any more: {error!r}") from error
        if answer[0] != ErrorCode.OK:
            raise Broken(f"HELLO was answered with {answer.hex()}")
        self.check()


def frame(seq: int, code: int, payload: bytes = b"") -> bytes:
    """A whole frame with its delimiter."""
    return encode(Frame(seq, code, payload))
