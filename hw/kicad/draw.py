#!/usr/bin/python3
# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Writes the schematic of the board: the root sheet and one file per sheet.

    draw.py [FOLDER]

Without a folder the files beside this script are rewritten. The same program
always writes the same bytes, so a changed file is a changed circuit. Exits
with 1 and a list when texts on a sheet would lie on each other.
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

from design import controller, expansion, machine, motor, panel, power
from design.overlap import overlaps
from design.sheet import Sheet
from design.write import PROJECT, root_text, sheet_text

NOTES = [
    ("Tornillo control board", (20, 22), 4.0),
    ("Logic side (GND): controller, USB, panel, programming.", (20, 28), 1.8),
    ("Machine side (MGND): supply, motors, switches, contact sensor, outputs.", (20, 32), 1.8),
    (
        "Only the opto-couplers U5, U6, U7, U10, U11 and the converter U4 bridge the\n"
        "5 mm gap between them. Nets of one name are one net on all sheets.",
        (20, 39),
        1.8,
    ),
]


def twice(sheets: list[Sheet]) -> list[str]:
    """Return a line for each unit of a part that is drawn more than once."""
    drawn = Counter((part.ref, part.unit) for sheet in sheets for part in sheet.parts)
    return [
        f"{ref} unit {unit} is drawn {count} times"
        for (ref, unit), count in drawn.items()
        if count > 1
    ]


def main(arguments: list[str]) -> int:
    """Write all sheets; return the exit status."""
    folder = Path(arguments[0]) if arguments else Path(__file__).resolve().parent
    sheets = [module.draw() for module in (controller, power, motor, machine, panel, expansion)]
    complaints = [line for sheet in sheets for line in overlaps(sheet)]
    complaints += twice(sheets)
    for line in complaints:
        print(line, file=sys.stderr)
    for sheet in sheets:
        (folder / f"{sheet.name}.kicad_sch").write_text(sheet_text(sheet), encoding="utf-8")
    (folder / f"{PROJECT}.kicad_sch").write_text(root_text(sheets, NOTES), encoding="utf-8")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
