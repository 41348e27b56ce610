# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Compares the exported netlist with the tables kept by hand and board.h.

The tables are expected_nets.txt and expected_parts.txt beside this file. The
pins of the microcontroller's ports are written down here once more, from its
data sheet, so that a wrong pin in the symbol shows too.
"""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

HERE = Path(__file__).resolve().parent
Pins = frozenset[str]

# 40-pin PIC18F4550: pin numbers of bits 0 to 7 of each port.
PORT_PINS = {
    "A": (2, 3, 4, 5, 6, 7),
    "B": (33, 34, 35, 36, 37, 38, 39, 40),
    "C": (15, 16, 17, None, 23, 24, 25, 26),
    "D": (19, 20, 21, 22, 27, 28, 29, 30),
    "E": (8, 9, 10),
}
BOARD_PIN = re.compile(r"^\s*BOARD_PIN\((\w+),\s*([A-E]),\s*([0-7])\)", re.MULTILINE)


class Netlist:
    """A netlist as KiCad exports it: nets, values, and pins left open."""

    def __init__(self, path: Path) -> None:
        """Read an XML netlist; raises ParseError when it is none."""
        tree = ElementTree.parse(path)
        self.values = {
            part.get("ref", ""): part.findtext("value", "") for part in tree.iterfind(".//comp")
        }
        self.nets: dict[str, Pins] = {}
        self.open: set[str] = set()
        for net in tree.iterfind(".//net"):
            pins = frozenset(f"{node.get('ref')}.{node.get('pin')}" for node in net.iter("node"))
            name = net.get("name", "").rsplit("/", 1)[-1]
            if name.startswith("unconnected-"):
                self.open |= pins
            else:
                self.nets[name] = pins


def read_table(path: Path) -> dict[str, list[str]]:
    """Return name to entries of a table; lines of one name are joined.

    A value may hold one space: columns are separated by two or more.
    """
    table: dict[str, list[str]] = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.strip() and not line.startswith("#"):
            name, entries = re.split(r"\s{2,}", line.strip(), maxsplit=1)
            table.setdefault(name, []).extend(entries.split())
    return table


def compare_nets(netlist: Netlist, table: dict[str, list[str]]) -> list[str]:
    """Return a line for each difference between netlist and table."""
    complaints = [f"the table has {pin} twice ({name})" for name, pin in _repeated(table)]
    wanted = {name: frozenset(pins) for name, pins in table.items() if name != "nc"}
    by_pins = {pins: name for name, pins in netlist.nets.items()}
    for name, pins in wanted.items():
        if name.startswith("-"):
            if pins not in by_pins:
                complaints.append(f"no net joins just {_list(pins)} ({name[1:]})")
        elif name not in netlist.nets:
            complaints.append(f"net {name} is missing")
        elif netlist.nets[name] != pins:
            found = netlist.nets[name]
            complaints.append(
                f"net {name}: missing {_list(pins - found)}, too many {_list(found - pins)}"
            )
    known = set(wanted.values())
    complaints += [
        f"net {name} ({_list(pins)}) is not in the table"
        for name, pins in netlist.nets.items()
        if name not in wanted and pins not in known
    ]
    if netlist.open != set(table.get("nc", [])):
        complaints.append(f"open pins differ: {_list(netlist.open ^ set(table.get('nc', [])))}")
    return complaints


def _repeated(table: dict[str, list[str]]) -> list[tuple[str, str]]:
    seen: set[str] = set()
    twice = []
    for name, pins in table.items():
        for pin in pins:
            if pin in seen:
                twice.append((name, pin))
            seen.add(pin)
    return twice


def _list(pins: set[str] | Pins) -> str:
    return " ".join(sorted(pins)) or "nothing"


def compare_parts(netlist: Netlist, table: dict[str, list[str]]) -> list[str]:
    """Return a line for each part whose value differs from the table."""
    wanted = {ref: value for value, refs in table.items() for ref in refs}
    return [
        f"{ref} is {netlist.values.get(ref, 'missing')!r}, "
        f"the table says {wanted.get(ref, 'nothing')!r}"
        for ref in sorted(wanted.keys() | netlist.values.keys())
        if wanted.get(ref) != netlist.values.get(ref)
    ]


def compare_board_header(netlist: Netlist, header: Path) -> list[str]:
    """Return a line for each pin that firmware/board.h and the netlist disagree on."""
    if not header.is_file():
        return [f"{header.name} is missing: the firmware's pins cannot be compared"]
    pins = BOARD_PIN.findall(header.read_text(encoding="utf-8"))
    if not pins:
        return [f"{header.name} has no BOARD_PIN lines"]
    complaints = []
    for name, port, bit in pins:
        number = PORT_PINS[port][int(bit)] if int(bit) < len(PORT_PINS[port]) else None
        net = next((net for net, on in netlist.nets.items() if f"U1.{number}" in on), "nothing")
        if net != name:
            complaints.append(
                f"{header.name} has {name} on R{port}{bit}, pin {number}; the board has {net} there"
            )
    return complaints


def check(netlist_path: Path, header: Path) -> list[str]:
    """Return all differences, empty when the netlist is as wanted."""
    netlist = Netlist(netlist_path)
    return [
        *compare_nets(netlist, read_table(HERE / "expected_nets.txt")),
        *compare_parts(netlist, read_table(HERE / "expected_parts.txt")),
        *compare_board_header(netlist, header),
    ]
