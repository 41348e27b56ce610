# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Writes the bill of materials, as CSV and as a page, from netlist and catalogue.

catalogue.csv is kept by hand: what to order for each value (or value and
letters of the reference, as "10k RN"), second sources and a rough price for
one piece in US dollars. A value without a line there is an error, so the bill
is always whole.
"""

from __future__ import annotations

import csv
import html
import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

CATALOGUE = Path(__file__).resolve().parent / "catalogue.csv"
UNBOUGHT = re.compile(r"^(H|TP)\d+$")


@dataclass(frozen=True)
class Line:
    """One kind of part: its references, and what to order."""

    refs: tuple[str, ...]
    value: str
    footprint: str
    what: str
    part: str
    second_source: str
    usd: float

    @property
    def total(self) -> float:
        """Price of all pieces, US dollars."""
        return self.usd * len(self.refs)


def _order(ref: str) -> tuple[str, int]:
    letters = ref.rstrip("0123456789")
    return letters, int(ref[len(letters) :])


def read(netlist: Path) -> list[Line]:
    """Return the bill; raises KeyError for a value the catalogue lacks."""
    with CATALOGUE.open(encoding="utf-8", newline="") as file:
        catalogue = {row["value"]: row for row in csv.DictReader(file)}
    groups: dict[tuple[str, str], list[tuple[str, str]]] = {}
    rows = {}
    for part in ElementTree.parse(netlist).iterfind(".//comp"):
        ref, value = part.get("ref", ""), part.findtext("value", "")
        if not UNBOUGHT.match(ref):
            special = f"{value} {ref.rstrip('0123456789')}"
            row = catalogue[special if special in catalogue else value]
            key = (row["part"], part.findtext("footprint", "").split(":")[-1])
            rows[key] = row
            groups.setdefault(key, []).append((ref, value))
    lines = []
    for key, parts in groups.items():
        row = rows[key]
        refs = tuple(sorted((ref for ref, _ in parts), key=_order))
        values = " ".join(sorted({value for _, value in parts}))
        lines.append(
            Line(
                refs,
                values,
                key[1],
                row["what"],
                row["part"],
                row["second_source"],
                float(row["usd"]),
            )
        )
    return sorted(lines, key=lambda line: _order(line.refs[0]))


def write(netlist: Path, folder: Path) -> float:
    """Write bom.csv and bom.html; return the price of all parts in US dollars."""
    lines = read(netlist)
    total = sum(line.total for line in lines)
    with (folder / "bom.csv").open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(
            [
                "references",
                "count",
                "value",
                "footprint",
                "what",
                "order",
                "second sources",
                "USD each",
                "USD",
            ]
        )
        for line in lines:
            table.writerow(
                [
                    " ".join(line.refs),
                    len(line.refs),
                    line.value,
                    line.footprint,
                    line.what,
                    line.part,
                    line.second_source,
                    f"{line.usd:.2f}",
                    f"{line.total:.2f}",
                ]
            )
    rows = "\n".join(
        "<tr><td><input type=checkbox></td>"
        + "".join(
            f"<td>{html.escape(str(cell))}</td>"
            for cell in (
                " ".join(line.refs),
                len(line.refs),
                line.value,
                line.what,
                line.part,
                line.second_source,
                f"{line.total:.2f}",
            )
        )
        + "</tr>"
        for line in lines
    )
    (folder / "bom.html").write_text(
        "<!doctype html><meta charset=utf-8><title>Tornillo board: parts</title>\n"
        "<style>body{font:14px sans-serif;margin:2em}table{border-collapse:collapse}"
        "td,th{border:1px solid #999;padding:3px 6px;text-align:left;vertical-align:top}"
        "tr:nth-child(even){background:#f2f2f2}</style>\n"
        f"<h1>Tornillo control board: parts</h1><p>{sum(len(x.refs) for x in lines)} parts, "
        f"about {total:.0f} US dollars for one board, without the board itself.</p>\n"
        "<table><tr><th></th><th>references</th><th>count</th><th>value</th><th>what</th>"
        f"<th>order</th><th>second sources</th><th>USD</th></tr>\n{rows}\n</table>\n",
        encoding="utf-8",
    )
    return total
