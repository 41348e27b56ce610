# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Gives each test its own copy of the board."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from hardware.spoiled_board import Board

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def tools() -> None:
    """Install KiCad and ngspice where they are missing."""
    subprocess.run([str(ROOT / "hw/install.sh")], check=True)


@pytest.fixture
def board(tools: None, tmp_path: Path) -> Board:
    """Return a fresh copy of the board."""
    shutil.copytree(
        ROOT / "hw", tmp_path / "hw", ignore=shutil.ignore_patterns("__pycache__", "*.kicad_prl")
    )
    (tmp_path / "firmware").mkdir()
    shutil.copy(ROOT / "firmware/board.h", tmp_path / "firmware/board.h")
    return Board(tmp_path)
