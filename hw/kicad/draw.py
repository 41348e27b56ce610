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
from pathlib import Path

from design import controller, expansion, machine, motor, panel, power
from design.overlap import overlaps
from design.write import PROJECT, root_text, sheet_text

NOTES = [
    ("Tornillo control board", (20, 26), 4.0),
    ("Logic side (GND): controller, USB, panel, programming.", (20, 32), 1.8),
    ("Machine side (MGND): supply, motors, switches, contact sensor, outputs.", (20, 36), 1.8),
    ("Only the opto-couplers U5, U6, U7, U10, U11 and the converter U4 bridge the "
     "5 mm gap between them.", (20, 40), 1.8),
]


def main(arguments: list[str]) -> int:
    """Write all sheets; return the exit status."""
    folder = Path(arguments[0]) if arguments else Path(__file__).resolve().parent
    sheets = [module.draw() for module in (controller, power, motor, machine, panel, expansion)]
    complaints = [line for sheet in sheets for line in overlaps(sheet)]
    for line in complaints:
        print(line, file=sys.stderr)
    for sheet in sheets:
        (folder / f"{sheet.name}.kicad_sch").write_text(sheet_text(sheet), encoding="utf-8")
    (folder / f"{PROJECT}.kicad_sch").write_text(root_text(sheets, NOTES), encoding="utf-8")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
