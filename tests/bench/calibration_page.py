# SPDX-License-Identifier: Apache-2.0
"""The figures of docs/calibration.md: what switch travel does to a part, and readings of paper S2.

docs/es/calibracion.md gets the same figures with Spanish words.

python tests/bench/calibration_page.py      write them, in two minutes; make bench does, too
"""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from simulated.processes import branch
from simulated.switch_travel import SWITCH_TRAVEL, Size, Zero, cut_reference
from spanish import translated
from tornillo.calibration import Known, Programme, from_ways
from tornillo.calibration_report import report
from tornillo.language import use
from tornillo.protocol import Axis
from tornillo.readings import read_ways

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "calibration.md"
SPANISH_PAGE = ROOT / "docs" / "es" / "calibracion.md"
S2 = ROOT / "host-cli" / "examples" / "s2-marks.txt"
BRANCH_S = 900.0
MM_PER_INCH = 25.4
#: Setting of the switch travel, and how part zero was taken, in the order of the columns.
CASES = (
    (0, Zero.OUTWARDS),
    (0, Zero.INWARDS),
    (SWITCH_TRAVEL, Zero.OUTWARDS),
    (SWITCH_TRAVEL, Zero.INWARDS),
)
#: Diameters A and B of paper S0 as drawn and as measured by its author, mm.
PAPER = {
    "S0, part in inches": ((24.892, 24.841), (15.24, 15.164)),
    "S0, part in millimetres": ((25.146, 24.917), (20.066, 19.761)),
}

Cut = dict[tuple[int, Zero], Sequence[Size]]


def cut_all() -> Cut:
    """Cut the part in every case, each on a lathe of its own."""
    return {
        (setting, zero): branch(partial(cut_reference, zero, setting), BRANCH_S)
        for setting, zero in CASES
    }


def diameters(sizes: Sequence[Size]) -> list[Size]:
    """Those that a calliper measures."""
    return [size for size in sizes if size.name.endswith("diameter")]


def turned_inwards(sizes: Sequence[Size]) -> float:
    """The mean error of the cylinders, mm: X goes inwards to their size."""
    return statistics.fmean(size.error for size in diameters(sizes) if "cylinder" in size.name)


def turned_outwards(sizes: Sequence[Size]) -> float:
    """The mean error of the cone, mm: X goes outwards along it."""
    return statistics.fmean(size.error for size in diameters(sizes) if "cone" in size.name)


def _off(mm: float) -> str:
    return f"{mm:+.3f} mm ({mm / MM_PER_INCH:+.4f} inch)"


def _undersize(pairs: Sequence[tuple[float, float]]) -> float:
    return statistics.fmean(cut - drawn for drawn, cut in pairs)


def switch_travel_table(cut: Cut) -> str:
    """What was cut, next to what the paper measured."""
    lines = [
        "| switch travel set | part zero taken with the tool last moving | cylinders, cut going "
        "inwards | cone, cut going outwards |",
        "|---|---|---|---|",
    ]
    for setting, zero in CASES:
        sizes = cut[setting, zero]
        figures = f"{_off(turned_inwards(sizes))} | {_off(turned_outwards(sizes))}"
        lines.append(f"| {setting} of {SWITCH_TRAVEL} steps | {zero.value} | {figures} |")
    lines += [
        f"| {name}: A, B | not told | {_off(_undersize(pairs))} | not told |"
        for name, pairs in PAPER.items()
    ]
    lines += ["", "Every diameter of the part, drawn and cut, mm:", ""]
    names = [size.name for size in diameters(cut[CASES[0]])]
    lines += [
        "| "
        + " | ".join(("diameter", "drawn", *(f"{s}, {z.name.lower()}" for s, z in CASES)))
        + " |",
        "|---" * (2 + len(CASES)) + "|",
    ]
    for number, name in enumerate(names):
        row = [diameters(cut[case])[number] for case in CASES]
        values = [f"{row[0].wanted:.3f}", *(f"{size.cut:.3f}" for size in row)]
        lines.append(f"| {name.removesuffix(' diameter')} | " + " | ".join(values) + " |")
    return "\n".join(lines) + "\n"


def s2_report(language: str = "en") -> str:
    """What `tornillo calibrate marks` prints for the readings of paper S2."""
    found = from_ways(read_ways(S2, "um"), Programme(1050, 1050), Known(Axis.Z, 7112, 0, 0))
    use(language)
    lines = report(found)
    use("en")
    return "\n".join(["```", *lines, "```"]) + "\n"


def fill(page: str, tables: dict[str, str]) -> str:
    """`page` with the marked places written anew; raises ValueError when one is missing."""
    for name, text in tables.items():
        begin = page.index(mark := f"<!-- {name} -->\n") + len(mark)
        page = page[:begin] + text + page[page.index("<!-- end -->", begin) :]
    return page


def calibration_figures() -> dict[str, float]:
    """Cut, write the pages; the error of the cylinders without and with correction, mm."""
    cut = cut_all()
    table = switch_travel_table(cut)
    english = {"switch travel": table, "s2": s2_report()}
    spanish = {"switch travel": translated(table), "s2": s2_report("es")}
    for page, tables in ((PAGE, english), (SPANISH_PAGE, spanish)):
        page.write_text(fill(page.read_text(encoding="utf-8"), tables), encoding="utf-8")
    return {
        "switch_travel_left_in_mm": round(turned_inwards(cut[0, Zero.OUTWARDS]), 4),
        "switch_travel_set_mm": round(turned_inwards(cut[SWITCH_TRAVEL, Zero.OUTWARDS]), 4),
    }


if __name__ == "__main__":
    print(calibration_figures())
