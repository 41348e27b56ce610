# SPDX-License-Identifier: Apache-2.0
"""The configuration words, read from the hex file: gpsim does not know all of them.

The simulation takes 48 MHz for granted; this says whether the words would give that on the chip.
Positions of bits are those of register 25-1 to 25-6 of the data sheet.
"""

from __future__ import annotations

from pathlib import Path

BASE = 0x300000
COUNT = 14
EXPECTED = (
    # name, byte, mask, value, what it means
    ("PLLDIV", 0, 0x07, 0x04, "20 MHz crystal divided by 5"),
    ("CPUDIV", 0, 0x18, 0x00, "96 MHz divided by 2"),
    ("USBDIV", 0, 0x20, 0x20, "USB clock from the PLL"),
    ("FOSC", 1, 0x0E, 0x0E, "crystal with PLL"),
    ("VREGEN", 2, 0x20, 0x20, "USB regulator on"),
    ("BOREN", 2, 0x06, 0x06, "brown-out reset on"),
    ("CCP2MX", 5, 0x01, 0x01, "CCP2 on RC1, not on the coil pin RB3"),
    ("PBADEN", 5, 0x02, 0x00, "PORTB digital at reset"),
    ("MCLRE", 5, 0x80, 0x80, "MCLR pin on"),
    ("STVREN", 6, 0x01, 0x01, "stack overflow resets"),
    ("LVP", 6, 0x04, 0x00, "low-voltage programming off"),
    ("XINST", 6, 0x40, 0x00, "no extended instruction set"),
)


def read_configuration(hex_file: Path | str) -> dict[int, int]:
    """Return the configuration bytes in an Intel hex file, by number 0 (CONFIG1L) to 13.

    Raises:
        ValueError: a line of the file is damaged.
    """
    found: dict[int, int] = {}
    upper = 0
    for number, line in enumerate(Path(hex_file).read_text(encoding="ascii").split(), 1):
        record = bytes.fromhex(line.removeprefix(":"))
        if not line.startswith(":") or sum(record) & 0xFF or record[0] != len(record) - 5:
            raise ValueError(f"{hex_file}:{number}: not a record of an Intel hex file")
        address, kind, data = int.from_bytes(record[1:3], "big"), record[3], record[4:-1]
        if kind == 4:
            upper = int.from_bytes(data, "big") << 16
        elif kind == 0:
            for i, byte in enumerate(data):
                if 0 <= upper + address + i - BASE < COUNT:
                    found[upper + address + i - BASE] = byte
    return found


def write_protection(hex_file: Path | str) -> int:
    """Return CONFIG6L and CONFIG6H: a bit that is 0 protects a block; all ones when not given."""
    found = read_configuration(hex_file)
    return found.get(10, 0xFF) | found.get(11, 0xFF) << 8


def wrong_words(hex_file: Path | str) -> list[str]:
    """Return what in the configuration does not suit the lathe's board; empty is right."""
    found = read_configuration(hex_file)
    return [
        f"{name}: not {meaning}"
        for name, byte, mask, value, meaning in EXPECTED
        if byte not in found or found[byte] & mask != value
    ]
