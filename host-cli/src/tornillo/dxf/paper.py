# SPDX-License-Identifier: Apache-2.0
"""How places and distances of a drawing are measured, and shown in messages."""

from dataclasses import dataclass

from tornillo.dxf.curves import Point

Mark = tuple[Point, str]


@dataclass(frozen=True)
class Paper:
    """The drawing `file` while it is read.

    `units` are those of the part file, `factor` one unit of the drawing in them. `tolerance`
    and `snap` are in units of the drawing; `largest_radius`, of an arc that a part can have,
    in those of the part file. With `upright` the spindle runs along the
    drawing's y; x and y are then exchanged while it is read.
    """

    file: str
    units: str
    factor: float
    tolerance: float
    snap: float
    largest_radius: float
    upright: bool

    @property
    def symmetry(self) -> float:
        """How far halves of a section may differ."""
        return max(self.tolerance, self.snap)

    def turn(self, place: Point) -> Point:
        """A place of the drawing with the spindle along x, and back."""
        return (place[1], place[0]) if self.upright else place

    def show(self, place: Point) -> str:
        """A place in the drawing's coordinates."""
        x, y = self.turn(place)
        return f"x {number(x)}, y {number(y)}"

    def show_level(self, level: float) -> str:
        """A line along the spindle in the drawing's coordinates."""
        return f"{'x' if self.upright else 'y'} {number(level)}"

    def show_along(self, along: float) -> str:
        """A place along the spindle in the drawing's coordinates."""
        return f"{'y' if self.upright else 'x'} {number(along)}"

    def length(self, distance: float) -> str:
        """A distance in the drawing as a length of the part."""
        return f"{number(distance * self.factor)} {self.units}"

    def mark(self, place: Point, text: str) -> Mark:
        """A place for the picture."""
        return self.turn(place), text


def number(value: float, decimals: int = 4) -> str:
    """A number without needless zeros."""
    text = f"{value:.{decimals}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
