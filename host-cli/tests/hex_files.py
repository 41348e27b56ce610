# SPDX-License-Identifier: Apache-2.0
"""Firmware for tests of `tornillo flash`: programs with a header, and hex files of them."""

import random
from pathlib import Path

from tornillo.firmware_file import FIRST, HEADER, IDENTITY
from tornillo.frames import crc16
from tornillo.protocol import PROTOCOL_VERSION

#: Ten blocks, the last one not full.
SIZE = 610
LINE = 16
END_RECORD = ":00000001FF"
#: Line of the hex file, from 1, with the byte at FIRST: behind the record of the upper address.
FIRST_LINE = 2


def program(
    version: tuple[int, int, int] = (0, 2, 0),
    size: int = SIZE,
    board: int = 1,
    identity: bytes = IDENTITY,
    protocol: int = PROTOCOL_VERSION,
) -> bytes:
    """A whole program of `size` bytes; the same at every call."""
    code = bytearray(random.Random(size).randbytes(size))
    HEADER.pack_into(code, 0, 0, FIRST + size, identity, board, *version, protocol)
    code[4:8] = b"\x14\xef\x04\xf0"
    code[:2] = crc16(bytes(code[2:])).to_bytes(2, "little")
    return bytes(code)


def record(address: int, kind: int, data: bytes) -> str:
    """One line of a hex file."""
    raw = bytes([len(data), *address.to_bytes(2, "big"), kind]) + data
    return ":" + (raw + bytes([-sum(raw) & 0xFF])).hex().upper()


def lines(data: bytes, first: int = FIRST) -> list[str]:
    """Data from address `first` on, in lines."""
    upper = record(0, 4, (first >> 16).to_bytes(2, "big"))
    pieces = range(0, len(data), LINE)
    return [
        upper,
        *(record((first + at) & 0xFFFF, 0, data[at : at + LINE]) for at in pieces),
    ]


def hex_file(folder: Path, *parts: list[str], end: str = END_RECORD) -> Path:
    """A hex file of these lines."""
    path = folder / "new.hex"
    text = "\n".join(line for part in parts for line in part)
    path.write_text(f"{text}\n{end}\n", encoding="ascii")
    return path


def firmware_file(folder: Path, code: bytes | None = None) -> Path:
    """A hex file as `make firmware` leaves it: boot loader, program, configuration."""
    loader = lines(bytes(range(64)), 0)
    configuration = lines(bytes(14), 0x300000)
    return hex_file(folder, loader, lines(code or program()), configuration)
