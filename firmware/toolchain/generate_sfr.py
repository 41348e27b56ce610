#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Write the names of the chip's special function registers for SDCC.

SDCC's own device files are not part of Debian, gputils' are: the section
"Register Files" of p18f4550.inc lists every register as NAME EQU H'0FXX'.
Two files come out of it: sfr.h, declarations for every module, and sfr.c,
the one definition of each that the linker needs.

usage: generate_sfr.py P18F4550.INC OUTPUT_DIRECTORY
"""

import re
import sys
from pathlib import Path

REGISTER = re.compile(r"^(\w+)\s+EQU\s+H'0?(F[0-9A-F]{2})'")
FIRST_SFR, LAST_SFR = 0xF60, 0xFFF


def read_registers(include_file: Path) -> list[tuple[str, int]]:
    """Return (name, address) for every register of the include file."""
    section = include_file.read_text(encoding="latin-1").split("Register Files", 1)[1]
    registers = []
    for line in section.splitlines()[1:]:
        if line.startswith(";-----"):
            break
        match = REGISTER.match(line)
        if match and FIRST_SFR <= int(match[2], 16) <= LAST_SFR:
            registers.append((match[1], int(match[2], 16)))
    return registers


def main() -> None:
    """Write both files; fail when the include file has an unknown layout."""
    include_file, output = Path(sys.argv[1]), Path(sys.argv[2])
    registers = read_registers(include_file)
    if len(registers) < 100:
        sys.exit(f"{include_file}: only {len(registers)} registers found, expected 150 or more")
    output.mkdir(parents=True, exist_ok=True)
    declared = "".join(f"extern __sfr __at(0x{a:03X}) {n};\n" for n, a in registers)
    defined = "".join(f"__sfr __at(0x{a:03X}) {n};\n" for n, a in registers)
    (output / "sfr.h").write_text(f"#ifndef SFR_H\n#define SFR_H\n{declared}#endif\n")
    (output / "sfr.c").write_text(defined)


if __name__ == "__main__":
    main()
