# SPDX-License-Identifier: CERN-OHL-P-2.0
"""A copy of the board that a test may spoil, and what the checks say of it."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path

KICAD_PYTHON = "/usr/bin/python3"


@dataclass(frozen=True)
class Verdict:
    """What the checks said: exit status and all they printed."""

    status: int
    output: str

    def failed(self, check: str) -> bool:
        """Tell whether the check of this name found something."""
        return f"{check}: FAILED" in self.output


@dataclass(frozen=True)
class Board:
    """A copy of the board's sources and of firmware/board.h."""

    root: Path

    def read(self, name: str) -> str:
        """Return the text of a file of the copy."""
        return (self.root / name).read_text(encoding="utf-8")

    def edit(self, name: str, old: str, new: str, count: int = -1) -> None:
        """Replace text in a file of the copy, count times or everywhere.

        Raises ValueError when the text is not there.
        """
        path = self.root / name
        text = path.read_text(encoding="utf-8")
        if old not in text:
            raise ValueError(f"{name} has no {old!r}")
        path.write_text(text.replace(old, new, count), encoding="utf-8")

    def draw(self) -> None:
        """Draw the schematic of the copy again from its scripts."""
        subprocess.run([KICAD_PYTHON, str(self.root / "hw/kicad/draw.py")], check=True)

    def check(self, *names: str) -> Verdict:
        """Run the named checks on the copy."""
        done = subprocess.run(
            [KICAD_PYTHON, str(self.root / "hw/checks/gate.py"), str(self.root), "--only", *names],
            text=True,
            capture_output=True,
            check=False,
        )
        return Verdict(done.returncode, done.stdout + done.stderr)

    def make(self, target: str) -> Verdict:
        """Run a target of the board's make fragment on the copy."""
        done = subprocess.run(
            ["make", "-f", "hw/hw.mk", target],
            cwd=self.root,
            text=True,
            capture_output=True,
            check=False,
        )
        return Verdict(done.returncode, done.stdout + done.stderr)
