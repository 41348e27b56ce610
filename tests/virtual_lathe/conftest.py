# SPDX-License-Identifier: Apache-2.0
"""Assembles the small programs that the models are tested with."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

PROGRAMS = Path(__file__).parent / "programs"


@pytest.fixture
def program(tmp_path: Path) -> Callable[..., str]:
    """Return a function that assembles ``programs/NAME.asm`` and gives the hex file's path.

    What follows the name are symbols for the assembler, ``SYMBOL=NUMBER``.
    """

    def assemble(name: str, *symbols: str) -> str:
        target = tmp_path / f"{name}.hex"
        source = PROGRAMS / f"{name}.asm"
        subprocess.run(
            [
                *("gpasm", "-q", "-w2", "-p18f4550"),
                *(f"-D{symbol}" for symbol in symbols),
                *(str(source), "-o", str(target)),
            ],
            check=True,
        )
        return str(target)

    return assemble
