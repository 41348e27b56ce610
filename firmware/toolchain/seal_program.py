#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Write seal.inc: the CRC and the end of the program, for its head at 0x0800.

usage: seal_program.py [-o SEAL.INC] PROTOCOL.TOML [HEX]

Without HEX, for a first link, the CRC and the end are 0 and 0x0900. The boot loader begins a
program only when the CRC-16 fits everything from 0x0802 to the end (firmware/loader/README.md).
"""

import argparse
import binascii
import tomllib
from pathlib import Path

from report_size import read_hex

PROGRAM_BEGIN, SEALED = 0x0800, 0x0802
CRC_START = 0xFFFF
#: The Tornillo board; another one with other pins would get another number.
BOARD_NUMBER = 1


def seal(flash: bytes) -> tuple[int, int]:
    """Return CRC and end, exclusive and even, of the program in a whole flash memory."""
    end = len(flash.rstrip(b"\xff")) + 1 & ~1
    sealed = end.to_bytes(2, "little") + flash[SEALED + 2 : end]
    return binascii.crc_hqx(sealed, CRC_START), end


def main() -> None:
    """Write the file; leave it alone when nothing changes."""
    parser = argparse.ArgumentParser()
    parser.add_argument("-o", dest="output", type=Path, required=True)
    parser.add_argument("protocol", type=Path)
    parser.add_argument("hex", type=Path, nargs="?")
    arguments = parser.parse_args()
    crc, end = seal(read_hex(arguments.hex)) if arguments.hex else (0, 0x0900)
    protocol = tomllib.loads(arguments.protocol.read_text())
    major, minor, patch = protocol["firmware"]["version"].split(".")
    values = {
        "SEAL_CRC": f"0x{crc:04X}",
        "SEAL_END": f"0x{end:04X}",
        "BOARD_NUMBER": BOARD_NUMBER,
        "VERSION_MAJOR": major,
        "VERSION_MINOR": minor,
        "VERSION_PATCH": patch,
        "PROTOCOL_VERSION": protocol["protocol"]["version"],
    }
    lines = [f"{name:18}equ {value}" for name, value in values.items()]
    arguments.output.parent.mkdir(parents=True, exist_ok=True)
    arguments.output.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
