# SPDX-License-Identifier: Apache-2.0
"""Which program holds a serial port, as far as this system tells.

Linux tells it for programs of the same user and for those that lock the port; macOS by `lsof`;
Windows not at all. Not knowing is no error.
"""

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from tornillo.language import _

PROCESSES = Path("/proc")
MODEM_MANAGER = "ModemManager"
LSOF_S = 3.0
LOCK_WORDS = 8


class Holder(NamedTuple):
    """A program that has a port open; `process` is its number."""

    name: str
    process: int

    def __str__(self) -> str:
        """Both, for a person."""
        return _("{name} (process {process})").format(name=self.name, process=self.process)


def holders(port: str) -> list[Holder]:
    """The other programs that have `port` open; empty when none is known."""
    if sys.platform == "darwin":
        return _by_lsof(port)
    found = {*_by_open_files(port), *_by_locks(port)} - {os.getpid()}
    return sorted(Holder(_name(process), process) for process in found)


def modem_manager_runs() -> bool:
    """Whether ModemManager, which tries every new port, is at work here."""
    return any(_name(process) == MODEM_MANAGER for process in _processes())


def _processes() -> Iterator[int]:
    """The numbers of all processes."""
    if PROCESSES.is_dir():
        yield from (int(entry.name) for entry in PROCESSES.iterdir() if entry.name.isdigit())


def _name(process: int) -> str:
    """What a process is called."""
    try:
        return (PROCESSES / str(process) / "comm").read_text(encoding="utf-8").strip()
    except OSError:
        return _("unknown")


def _by_open_files(port: str) -> Iterator[int]:
    """Processes with `port` among their open files; others' cannot be looked into."""
    device = Path(port).resolve()
    for process in _processes():
        try:
            files = (PROCESSES / str(process) / "fd").iterdir()
            if any(file.readlink() == device for file in files):
                yield process
        except OSError:
            continue


def _by_locks(port: str) -> Iterator[int]:
    """Processes of any user that have locked `port`.

    A line of the kernel: `1: FLOCK ADVISORY WRITE 42 00:05:7 0 EOF`, where 42 is the process,
    00:05 the device of the file system and 7 the inode.
    """
    try:
        file = Path(port).stat()
        lines = (PROCESSES / "locks").read_text(encoding="utf-8").splitlines()
    except OSError:
        return
    place = f"{os.major(file.st_dev):02x}:{os.minor(file.st_dev):02x}:{file.st_ino}"
    for line in lines:
        words = line.split()
        if len(words) == LOCK_WORDS and words[5] == place and int(words[4]) > 0:
            yield int(words[4])


def _by_lsof(port: str) -> list[Holder]:
    """What macOS tells: lines `p` with the process and `c` with its name."""
    program = shutil.which("lsof")
    if program is None:
        return []
    try:
        told = subprocess.run(
            [program, "-F", "pc", "--", port],
            capture_output=True,
            text=True,
            timeout=LSOF_S,
            check=False,
        ).stdout.splitlines()
    except (OSError, subprocess.TimeoutExpired):
        return []
    numbers = [int(line[1:]) for line in told if line.startswith("p")]
    names = [line[1:] for line in told if line.startswith("c")]
    found = map(Holder, names, numbers)
    return [holder for holder in found if holder.process != os.getpid()]
