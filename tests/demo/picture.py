# SPDX-License-Identifier: Apache-2.0
"""The drawing of a part and, below it, what the virtual lathe has made of the bar."""

from pathlib import Path
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.image import imread
from verdict import MM_PER_INCH

WIDTH_INCH, SHEET_INCH, CUT_INCH = 11.7, 8.27, 4.6
DPI = 150
METAL, EDGE, WANTED = "#c9d7e6", "#1b1f24", "#c2255c"


def draw(sheet: Path, report: dict[str, Any], wanted: list[tuple[float, float]]) -> None:
    """Put the measured profile of `report` under the drawing in `sheet`, a PNG, in place.

    `wanted` is the outline that the part file asks for, (z, diameter) in mm.
    """
    figure = Figure(figsize=(WIDTH_INCH, SHEET_INCH + CUT_INCH), dpi=DPI)
    FigureCanvasAgg(figure)
    share = CUT_INCH / (SHEET_INCH + CUT_INCH)
    top = figure.add_axes((0, share, 1, 1 - share))
    top.imshow(imread(sheet))
    top.set_axis_off()
    below = figure.add_axes((0.06, 0.14 * share, 0.58, 0.72 * share))
    profile = [(z, diameter) for z, diameter in report["profile"]]
    along = [z for z, _ in profile]
    radii = [diameter / 2 for _, diameter in profile]
    lower = [-radius for radius in radii]
    below.fill_between(along, radii, lower, step="post", color=METAL, linewidth=0)
    for outline in (radii, lower):
        below.step(along, outline, where="post", color=EDGE, linewidth=1.2)
    for sign in (1, -1):
        below.plot(
            [z for z, _ in wanted],
            [sign * diameter / 2 for _, diameter in wanted],
            color=WANTED,
            linewidth=1.0,
            linestyle=(0, (5, 4)),
            label="wanted" if sign == 1 else None,
        )
    below.axhline(0, color=EDGE, linewidth=0.6, linestyle=(0, (12, 3, 2, 3)))
    below.set_title("cut on the virtual lathe, measured", fontsize=12, fontweight="bold")
    below.set_xlabel("z, mm")
    below.set_ylabel("radius, mm")
    below.set_aspect("equal")
    below.margins(x=0.04, y=0.12)
    below.legend(loc="upper right", frameon=False)
    figure.text(0.68, 0.5 * share, _caption(report), fontsize=10, va="center", linespacing=1.6)
    figure.savefig(sheet)


def _caption(report: dict[str, Any]) -> str:
    """Every dimension that was cut, with its error."""
    return "\n\n".join(
        f"{entry['name']}\n{entry['cut_mm']:.3f} mm = {entry['cut_mm'] / MM_PER_INCH:.4f} inch\n"
        f"error {entry['error_steps']:+g} steps"
        for entry in report["dimensions"]
    )
