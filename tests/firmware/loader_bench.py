# SPDX-License-Identifier: Apache-2.0
"""What the tests of the boot loader share: a chip in its loader, its requests, small programs.

The bytes of requests and programs are written down here once more, beside firmware/loader/ and the
host's module for updates, so that the three check each other.
"""

from __future__ import annotations

from tornillo.frames import crc16
from virtual_lathe.chip import Drive, NonVolatile, Reset

from firmware.usb_bench import UsbBench

HOLD_BUTTON = "RD5"
BEGIN, HEADER_SIZE, ROW, BLOCK = 0x0800, 0x20, 32, 64
DONE, DAMAGED, UNKNOWN, WRONG_PLACE, NOT_KEPT, NOT_WHOLE = range(6)
#: From a reset to the decision, with the longest program there can be.
DECISION_S = 0.09
#: CLRWDT and a jump back to it.
IDLE_LOOP = b"\x04\x00\xfe\xd7"


class LoaderBench(UsbBench):
    """A chip that has been powered on with HOLD down, its loader on the bus."""

    def __init__(self, flash: bytes | None = None) -> None:
        """Power on; ``flash`` instead of the firmware."""
        super().__init__()
        if flash is not None:
            self.chip.restore(NonVolatile(flash, self.chip.save().eeprom))
        self.chip.drive(HOLD_BUTTON, Drive.LOW)
        self.chip.run(DECISION_S)
        self.chip.drive(HOLD_BUTTON, Drive.OPEN)

    def assert_no_mistakes(self) -> None:
        """The loader has done nothing that the data sheet forbids."""
        mistakes = self.host.mistakes
        assert not mistakes, mistakes

    def open(self) -> LoaderBench:
        """Open the port; forget what was said before."""
        super().open()
        self.host.receive()
        return self

    @property
    def in_loader(self) -> bool:
        """Whether the loader has the chip, rather than a program."""
        return self.chip.pc < BEGIN

    def request(self, packet: bytes) -> bytes:
        """Send a packet and return the answer without its CRC, which is right."""
        self.send_raw(packet)
        answer = b""
        end = self.chip.seconds + 0.5
        while not answer and self.chip.seconds < end:
            self.host.wait(1e-4)
            answer = self.host.receive()
        assert crc16(answer[:-2]) == int.from_bytes(answer[-2:], "little")
        return answer[:-2]

    def command(self, command: str, place: int = 0, data: bytes = b"") -> tuple[int, bytes]:
        """Return result and data of a request."""
        body = command.encode() + place.to_bytes(2, "little") + data
        answer = self.request(body + crc16(body).to_bytes(2, "little"))
        assert answer[:1] == body[:1]
        return answer[1], answer[2:]

    def update(self, program: bytes) -> None:
        """Write a program as the host does: its first block last."""
        assert len(program) % BLOCK == 0
        for at in (*range(BLOCK, len(program), ROW), *range(0, BLOCK, ROW)):
            assert self.command("W", BEGIN + at, program[at : at + ROW]) == (DONE, b"")

    def power_cycle(self) -> None:
        """Take power and cable away and give both back; wait for the loader's decision."""
        self.host.unplug()
        self.chip.reset(Reset.POWER_ON)
        self.chip.run(DECISION_S)


def program(blocks: int, filler: int) -> bytes:
    """Return a sealed program of so many blocks of 64 bytes that does nothing."""
    size = blocks * BLOCK
    entry = bytes([0x10, 0xEF, 0x04, 0xF0])  # GOTO 0x0820
    identity = b"Tornillo" + bytes([1, 9, 9, 9, 3]) + b"\xff"
    head = ((BEGIN + size).to_bytes(2, "little") + entry + identity).ljust(HEADER_SIZE - 2, b"\xff")
    sealed = (head + IDLE_LOOP).ljust(size - 2, bytes([filler]))
    return crc16(sealed).to_bytes(2, "little") + sealed
