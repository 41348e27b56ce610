#!/usr/bin/python3
# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Writes what is needed to read, order and build the board.

    export.py FOLDER

schematic.pdf, board.pdf, bom.csv, bom.html, gerbers and drill files (also as
gerbers.zip), positions.csv, tornillo.step, board-top.png, board-bottom.png,
wiring.svg. Pictures and STEP show parts when their models can be fetched, and
the bare board with a warning when not.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import bom
import wiring

HERE = Path(__file__).resolve().parent
KICAD = HERE.parent / "kicad"
SCHEMATIC, BOARD = KICAD / "tornillo.kicad_sch", KICAD / "tornillo.kicad_pcb"
LAYERS = "F.Cu,B.Cu,F.Mask,B.Mask,F.Silkscreen,B.Silkscreen,F.Paste,Edge.Cuts"


def kicad(*words: str | Path, also_fine: int = 0) -> None:
    """Run kicad-cli; end the program when it fails."""
    done = subprocess.run(
        ["kicad-cli", *map(str, words)], text=True, check=False, capture_output=True
    )
    if done.returncode not in (0, also_fine):
        sys.exit(f"kicad-cli {' '.join(map(str, words[:3]))} failed:\n{done.stdout}{done.stderr}")


def models() -> bool:
    """Fetch the 3D models of the parts; tell whether they are there."""
    done = subprocess.run(
        [str(HERE / "fetch_models.sh"), str(BOARD)], text=True, check=False, capture_output=True
    )
    if done.returncode:
        print(
            "warning: the 3D models cannot be fetched; pictures and STEP show the bare board",
            file=sys.stderr,
        )
        return False
    os.environ["KICAD9_3DMODEL_DIR"] = done.stdout.strip()
    return True


def fabrication(out: Path) -> None:
    """Write gerbers, drill files and positions."""
    folder = out / "gerbers"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    kicad("pcb", "export", "gerbers", "-l", LAYERS, "-o", f"{folder}/", BOARD)
    kicad(
        "pcb",
        "export",
        "drill",
        "--format",
        "excellon",
        "--excellon-separate-th",
        "--generate-map",
        "--map-format",
        "gerberx2",
        "-o",
        f"{folder}/",
        BOARD,
    )
    with zipfile.ZipFile(out / "gerbers.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(folder.iterdir()):
            archive.write(path, path.name)
    kicad(
        "pcb",
        "export",
        "pos",
        "--format",
        "csv",
        "--units",
        "mm",
        "-o",
        out / "positions.csv",
        BOARD,
    )


def main(arguments: list[str]) -> int:
    """Write everything; return the exit status."""
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    out = Path(arguments[0])
    out.mkdir(parents=True, exist_ok=True)
    netlist = out / "netlist.xml"
    kicad("sch", "export", "netlist", "--format", "kicadxml", "-o", netlist, SCHEMATIC)
    kicad("sch", "export", "pdf", "-o", out / "schematic.pdf", SCHEMATIC)
    kicad(
        "pcb",
        "export",
        "pdf",
        "--mode-multipage",
        "--include-border-title",
        "-l",
        "F.Cu,B.Cu,F.Silkscreen",
        "--common-layers",
        "Edge.Cuts",
        "-o",
        out / "pages",
        BOARD,
    )
    (out / "pages/tornillo.pdf").replace(out / "board.pdf")
    (out / "pages").rmdir()
    total = bom.write(netlist, out)
    wiring.write(netlist, out / "wiring.svg")
    fabrication(out)
    with_parts = models()
    kicad(
        "pcb",
        "export",
        "step",
        "--force",
        *([] if with_parts else ["--board-only"]),
        "-o",
        out / "tornillo.step",
        BOARD,
        also_fine=2,
    )
    for side in ("top", "bottom"):
        kicad(
            "pcb",
            "render",
            "--side",
            side,
            "--quality",
            "basic",
            "-w",
            "1600",
            "-h",
            "1200",
            "-o",
            out / f"board-{side}.png",
            BOARD,
        )
    print(f"{out}: schematic, gerbers, STEP, pictures; parts cost about {total:.0f} US dollars")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
