# SPDX-License-Identifier: Apache-2.0
"""Collects what every simulated chip has executed, over all processes of a test run.

The record of a test run is a file of its own, so that runs at the same time do not mix: 16,384
bytes, one for each program word, 1 = executed; then one byte, the deepest use of the hardware
stack. Writers add to it under a lock.
"""

from __future__ import annotations

import ctypes
import fcntl
import os
from dataclasses import dataclass
from pathlib import Path

from virtual_lathe.native_library import library

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build" / "coverage"
PROGRAM_WORDS = 0x4000


@dataclass(frozen=True)
class Record:
    """Executed word addresses (byte addresses, even) and the deepest hardware stack."""

    executed: frozenset[int]
    stack_depth: int


class Recorder:
    """The record of this test run; every process forked from it writes to the same file."""

    def __init__(self) -> None:
        """Record nothing until :meth:`begin`."""
        self._path: Path | None = None

    def begin(self) -> None:
        """Begin a new record."""
        self._path = FOLDER / f"firmware-{os.getpid()}.bin"
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._path.write_bytes(bytes(PROGRAM_WORDS + 1))

    def add(self) -> None:
        """Add what the chip of this process has executed so far; it must have our firmware."""
        if self._path is None:
            return
        flags = (ctypes.c_uint8 * PROGRAM_WORDS)()
        library().vl_executed(flags)
        depth = int(library().vl_stack_depth_max())
        with self._path.open("r+b") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            before = file.read()
            merged = int.from_bytes(before[:-1], "big") | int.from_bytes(bytes(flags), "big")
            file.seek(0)
            file.write(merged.to_bytes(PROGRAM_WORDS, "big") + bytes([max(before[-1], depth)]))

    def end(self) -> Record:
        """Return what has been recorded and remove the file."""
        if self._path is None:
            return Record(frozenset(), 0)
        content = self._path.read_bytes()
        self._path.unlink()
        self._path = None
        executed = frozenset(2 * word for word, flag in enumerate(content[:-1]) if flag)
        return Record(executed, content[-1])


#: The recorder of this process and its forks.
RECORDER = Recorder()
