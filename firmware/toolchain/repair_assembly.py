#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Repair what SDCC's PIC16 port is known to write wrong or at length, refuse what it must not.

- A bit test or change on a byte inside a variable, `BTFSC (_rate + 1), 7`, comes
  without the flag that says "banked", although the bank has been selected just
  before; the assembler then silently takes the access bank. The flag is added.
- A test of a sign bit goes through the carry, in four instructions: two do.
- An interrupt vector lies at the chip's; behind the boot loader it belongs 0x800 higher. The
  compiler has an option for that, which prints a line for every file.
- An initialised variable would need a copying start-up, which this firmware does
  not have. It is refused.

usage: repair_assembly.py FILE.asm [FILE.asm ...]      (changed in place)
"""

import re
import sys
from pathlib import Path

BIT_WITHOUT_BANK = re.compile(
    r"^(\s*(?:BTFSC|BTFSS|BTG|BSF|BCF)\s+\(_\w+\s*\+\s*\d+\),\s*\d+)\s*$", re.IGNORECASE
)
SIGN_TEST = re.compile(
    r"^\tBSF\tSTATUS, 0\n\tBTFSS\t(\S.*), 7\n\tBCF\tSTATUS, 0\n\t(BNC|BC)\t(\S+)$", re.MULTILINE
)
VECTOR = re.compile(r"^(\w+_ivec_\w+\s+code\s+)0X0000([01]8)$", re.MULTILINE)
INITIALISED = re.compile(r"^\w*\s+idata\b", re.IGNORECASE)


def repair(source: str) -> str:
    """Return the assembly text repaired.

    Raises ValueError when the text has an initialised variable.
    """
    lines = []
    for number, line in enumerate(source.splitlines(), 1):
        if INITIALISED.match(line):
            raise ValueError(f"{number}: initialised variable; set it in the room's init function")
        lines.append(BIT_WITHOUT_BANK.sub(r"\1, B", line))
    return VECTOR.sub(r"\g<1>0X0008\2", SIGN_TEST.sub(_test_bit, "\n".join(lines) + "\n"))


def _test_bit(match: re.Match[str]) -> str:
    """Jump by the bit itself."""
    skip = "BTFSS" if match[2] == "BNC" else "BTFSC"
    return f"\t{skip}\t{match[1]}, 7\n\tBRA\t{match[3]}"


def main() -> None:
    """Repair every file named, in place."""
    for name in sys.argv[1:]:
        path = Path(name)
        try:
            path.write_text(repair(path.read_text()))
        except ValueError as fault:
            path.unlink()
            sys.exit(f"{name}:{fault}")


if __name__ == "__main__":
    main()
