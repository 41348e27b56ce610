# SPDX-License-Identifier: Apache-2.0
"""Lines, areas and text on a sheet of paper, written as SVG.

Coordinates are millimetres from the lower left corner, y up.
`tornillo.scene_png` paints the same scene as PNG.
"""

from typing import NamedTuple
from xml.sax.saxutils import escape

Point = tuple[float, float]
FONT = "DejaVu Sans, Arial, sans-serif"


class Pen(NamedTuple):
    """How a line looks: width and dashes in mm."""

    width: float
    color: str = "#1b1f24"
    dashes: tuple[float, ...] = ()


class Line(NamedTuple):
    """A line through points."""

    points: tuple[Point, ...]
    pen: Pen


class Area(NamedTuple):
    """A closed area without an outline."""

    points: tuple[Point, ...]
    fill: str


class Text(NamedTuple):
    """Text centred vertically on its place; `anchor` start, middle or end; `turn` degrees."""

    at: Point
    text: str
    size: float
    anchor: str = "start"
    turn: int = 0
    bold: bool = False
    color: str = "#1b1f24"


class Scene:
    """A sheet with things on it, painted in their order."""

    def __init__(self, width: float, height: float) -> None:
        """An empty sheet, sizes in mm."""
        self.width = width
        self.height = height
        self.things: list[Line | Area | Text] = []

    def line(self, pen: Pen, *points: Point) -> None:
        """Draw a line through `points`."""
        self.things.append(Line(points, pen))

    def area(self, fill: str, *points: Point) -> None:
        """Fill the area inside `points`."""
        self.things.append(Area(points, fill))

    def box(self, pen: Pen, low: Point, high: Point) -> None:
        """Draw a rectangle."""
        (x0, y0), (x1, y1) = low, high
        self.line(pen, (x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0))

    def text(self, thing: Text) -> None:
        """Write a text."""
        self.things.append(thing)

    def svg(self) -> str:
        """The sheet as an SVG document."""
        lines = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width:g}mm" '
            f'height="{self.height:g}mm" viewBox="0 0 {self.width:g} {self.height:g}">',
            '<rect width="100%" height="100%" fill="#ffffff"/>',
            *(self._svg_thing(thing) for thing in self.things),
            "</svg>",
        ]
        return "\n".join(lines) + "\n"

    def _svg_thing(self, thing: Line | Area | Text) -> str:
        """One element."""
        if isinstance(thing, Text):
            x, y = thing.at[0], self.height - thing.at[1]
            weight = ' font-weight="bold"' if thing.bold else ""
            turn = f' transform="rotate({-thing.turn} {x:.2f} {y:.2f})"' if thing.turn else ""
            return (
                f'<text x="{x:.2f}" y="{y:.2f}" font-family="{FONT}" font-size="{thing.size:g}" '
                f'text-anchor="{thing.anchor}" dominant-baseline="central" '
                f'fill="{thing.color}"{weight}{turn}>{escape(thing.text)}</text>'
            )
        points = " ".join(f"{x:.3f},{self.height - y:.3f}" for x, y in thing.points)
        if isinstance(thing, Area):
            return f'<polygon points="{points}" fill="{thing.fill}"/>'
        dashes = ",".join(f"{dash:g}" for dash in thing.pen.dashes)
        dashed = f' stroke-dasharray="{dashes}"' if dashes else ""
        return (
            f'<polyline points="{points}" fill="none" stroke="{thing.pen.color}" '
            f'stroke-width="{thing.pen.width:g}" stroke-linejoin="round"{dashed}/>'
        )
