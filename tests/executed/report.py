# SPDX-License-Identifier: Apache-2.0
"""Turns the record of executed addresses into a report, function by function.

gplink's listing has every instruction of the firmware with its address and its line of assembly;
gplink's map has where functions begin and from which file they come. Library routines of the
compiler are not in the listing and not in the report.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path

from executed.record import ROOT, Record

BUILD = ROOT / "build" / "firmware"
REPORT = ROOT / "build" / "coverage" / "firmware.txt"
#: Routines in assembly that nothing outside their file calls.
ENTRIES = ("step_interrupt", "entry")

# A line that begins an instruction: address, code word, disassembly, line of assembly.
_ADDRESS = re.compile(r"^[0-9a-f]{6}   [0-9a-f]{4} ")
_DISASSEMBLY = slice(18, 43)
_SOURCE = slice(43, None)
_DATA = re.compile(r"(?:\w+:)?\s*(?:DB|DW|DATA)\b", re.IGNORECASE)
_SYMBOL = re.compile(r"^\s*(\S+)\s+0x([0-9a-f]{6})\s+program\s+(extern|static)\s+(.*)$")
_COMPILER_LABEL = re.compile(r"^_\d+_DS_")
_C_FUNCTION = re.compile(r"^(_[A-Za-z]\w*):", re.MULTILINE)


@dataclass
class Function:
    """One function: where it is from and its instructions, executed or not."""

    name: str
    room: str
    total: int = 0
    missed: list[int] = field(default_factory=list)

    @property
    def executed(self) -> int:
        """Number of instructions executed."""
        return self.total - len(self.missed)


def instructions(listing: str) -> list[int]:
    """Return the addresses of all instructions in a listing, tables left out."""
    found = set()
    for line in listing.splitlines():
        source = line[_SOURCE].strip()
        begins = _ADDRESS.match(line) and line[_DISASSEMBLY].strip() and source
        if begins and not _DATA.match(source):
            found.add(int(line[:6], 16))
    return sorted(found)


def _c_files(build: Path) -> dict[str, str]:
    """Label of every C function -> its source file."""
    found: dict[str, str] = {}
    for path in sorted(build.glob("obj/**/*.asm")):
        if path.name != "compiled.asm":
            source = path.relative_to(build / "obj").with_suffix(".c").as_posix()
            for label in _C_FUNCTION.findall(path.read_text(encoding="latin-1")):
                found.setdefault(label, source)
    return found


def starts(symbols: str, c_files: dict[str, str]) -> dict[int, tuple[str, str]]:
    """Address -> (function, source file) from a map file; labels inside C functions left out."""
    found: dict[int, tuple[str, str]] = {}
    for line in symbols.splitlines():
        match = _SYMBOL.match(line)
        if not match or _COMPILER_LABEL.match(match.group(1)):
            continue
        name, address, file = match.group(1), int(match.group(2), 16), match.group(4).strip()
        if file.endswith("compiled.asm"):
            if name in c_files:
                found[address] = name.removeprefix("_"), c_files[name]
        elif file.startswith("firmware/") and (match.group(3) == "extern" or name in ENTRIES):
            found.setdefault(address, (name.removeprefix("_"), file.removeprefix("firmware/")))
    return found


def functions(build: Path, executed: frozenset[int]) -> list[Function]:
    """Judge every function of the firmware in a build folder."""
    listing = (build / "tornillo.lst").read_text(encoding="latin-1")
    symbols = (build / "tornillo.map").read_text(encoding="latin-1")
    begin = starts(symbols, _c_files(build))
    addresses = sorted(begin)
    found: dict[int, Function] = {}
    for address in instructions(listing):
        place = bisect_right(addresses, address) - 1
        first = addresses[place] if place >= 0 else 0
        name, file = begin.get(first, ("vectors", "main.c"))
        function = found.setdefault(first, Function(name, file))
        function.total += 1
        if address not in executed:
            function.missed.append(address)
    return sorted(found.values(), key=lambda f: (f.room, f.name))


def text(judged: list[Function], record: Record) -> str:
    """Return the report: a line per file, then what was missed, then the sum."""
    by_file: dict[str, list[Function]] = defaultdict(list)
    for function in judged:
        by_file[function.room].append(function)
    lines = ["instructions executed, by source file", ""]
    for file, members in by_file.items():
        done, total = sum(f.executed for f in members), sum(f.total for f in members)
        lines.append(f"{file:28} {done:5} of {total:5}  {100 * done / total:5.1f} %")
    lines += ["", "not executed: function, instructions, addresses as in tornillo.lst", ""]
    for function in judged:
        if function.missed:
            places = " ".join(f"{address:05x}" for address in function.missed[:12])
            more = " ..." if len(function.missed) > 12 else ""
            lines.append(
                f"{function.room}: {function.name}: "
                f"{len(function.missed)} of {function.total}: {places}{more}"
            )
    return "\n".join([*lines, "", summary(judged, record), ""])


def summary(judged: list[Function], record: Record) -> str:
    """Return the report in one line."""
    total = sum(f.total for f in judged)
    done = sum(f.executed for f in judged)
    reached = sum(1 for f in judged if f.executed)
    share = 100 * done / total if total else 0.0
    return (
        f"firmware: {done} of {total} instructions executed ({share:.1f} %), "
        f"{reached} of {len(judged)} functions, hardware stack {record.stack_depth} levels deep"
    )


def write(record: Record, build: Path = BUILD, path: Path = REPORT) -> str:
    """Write the report to ``path`` and return its summary."""
    judged = functions(build, record.executed)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text(judged, record), encoding="utf-8")
    return summary(judged, record)
