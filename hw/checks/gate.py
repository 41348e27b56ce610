#!/usr/bin/python3
# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Checks the board: generated files, ERC, DRC, nets, spice benches.

    gate.py [--only NAME ...] [ROOT]

ROOT is the top of the repository (default: where this script lives). Each
check prints one line, and what is wrong; the exit status is 0 when all hold,
1 when one does not. Needs KiCad 9, its Python (pcbnew) and ngspice; see
hw/install.sh.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import nets

KICAD_PYTHON = "/usr/bin/python3"
GENERATED = ("*.kicad_sch", "tornillo.kicad_pcb", "tornillo.kicad_pro")


def run(command: list[str | Path], folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run a command, its output captured."""
    return subprocess.run(
        [str(word) for word in command], cwd=folder, text=True, check=False, capture_output=True
    )


def tail(done: subprocess.CompletedProcess[str]) -> list[str]:
    """Return the last lines a failed command wrote."""
    return (done.stdout + done.stderr).strip().splitlines()[-12:]


def export_netlist(schematic: Path, target: Path) -> list[str]:
    """Write the netlist as XML; return complaints."""
    done = run(
        ["kicad-cli", "sch", "export", "netlist", "--format", "kicadxml", "-o", target, schematic]
    )
    return [] if done.returncode == 0 and target.is_file() else tail(done)


def check_generated(root: Path) -> list[str]:
    """Draw and lay out the board again in a copy; name files that differ."""
    original = root / "hw/kicad"
    with tempfile.TemporaryDirectory() as name:
        copy = Path(name) / "kicad"
        shutil.copytree(original, copy, ignore=shutil.ignore_patterns("__pycache__"))
        board, netlist = copy / "tornillo.kicad_pcb", Path(name) / "net.xml"
        drawn = run([KICAD_PYTHON, copy / "draw.py"])
        if drawn.returncode:
            return tail(drawn)
        complaints = export_netlist(copy / "tornillo.kicad_sch", netlist)
        if complaints:
            return complaints
        steps: list[list[str | Path]] = [
            ["place", netlist, board, Path(name) / "board.dsn"],
            ["finish", board, copy / "layout/tornillo.ses"],
        ]
        for step in steps:
            built = run([KICAD_PYTHON, copy / "build_board.py", *step])
            if built.returncode:
                return tail(built)
        return [
            f"{path.name} is not what the scripts write"
            for pattern in GENERATED
            for path in sorted(original.glob(pattern))
            if path.read_bytes() != (copy / path.name).read_bytes()
        ]


def check_erc(root: Path) -> list[str]:
    """Run KiCad's electrical rules, warnings included."""
    with tempfile.TemporaryDirectory() as name:
        report = Path(name) / "erc.json"
        done = run(
            [
                "kicad-cli",
                "sch",
                "erc",
                "--severity-all",
                "--exit-code-violations",
                "--format",
                "json",
                "-o",
                report,
                root / "hw/kicad/tornillo.kicad_sch",
            ]
        )
        if done.returncode == 0:
            return []
        if not report.is_file():
            return tail(done)
        sheets = json.loads(report.read_text(encoding="utf-8"))["sheets"]
        return [
            f"{sheet['path']} {found['type']}: {found['description']}"
            for sheet in sheets
            for found in sheet["violations"]
        ]


def check_drc(root: Path) -> list[str]:
    """Run KiCad's design rules and compare the board with the schematic."""
    with tempfile.TemporaryDirectory() as name:
        report = Path(name) / "drc.json"
        done = run(
            [
                "kicad-cli",
                "pcb",
                "drc",
                "--severity-all",
                "--schematic-parity",
                "--exit-code-violations",
                "--format",
                "json",
                "-o",
                report,
                root / "hw/kicad/tornillo.kicad_pcb",
            ]
        )
        if done.returncode == 0:
            return []
        if not report.is_file():
            return tail(done)
        findings = json.loads(report.read_text(encoding="utf-8"))
        return [
            f"{found['type']}: {found['description']}"
            for kind in ("violations", "unconnected_items", "schematic_parity")
            for found in findings[kind]
        ]


def check_nets(root: Path) -> list[str]:
    """Compare the netlist with the hand-kept tables and firmware/board.h."""
    with tempfile.TemporaryDirectory() as name:
        netlist = Path(name) / "net.xml"
        return export_netlist(root / "hw/kicad/tornillo.kicad_sch", netlist) or nets.check(
            netlist, root / "firmware/board.h"
        )


def check_spice(root: Path) -> list[str]:
    """Run the spice benches; each says itself what is out of bounds."""
    done = run([KICAD_PYTHON, root / "hw/spice/run.py"])
    return [] if done.returncode == 0 else tail(done)


CHECKS: dict[str, Callable[[Path], list[str]]] = {
    "generated": check_generated,
    "erc": check_erc,
    "drc": check_drc,
    "nets": check_nets,
    "spice": check_spice,
}


def main(arguments: list[str]) -> int:
    """Run the wanted checks; return the exit status."""
    parser = argparse.ArgumentParser(description="Check the board.")
    parser.add_argument("--only", nargs="+", choices=list(CHECKS), default=list(CHECKS))
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parents[2])
    wanted = parser.parse_args(arguments)
    failed = False
    for name in wanted.only:
        complaints = CHECKS[name](wanted.root)
        print(f"{name}: {'FAILED' if complaints else 'ok'}", flush=True)
        for line in complaints[:40]:
            print(f"  {line}")
        failed = failed or bool(complaints)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
