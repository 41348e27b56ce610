# SPDX-License-Identifier: Apache-2.0
"""What a person may say about a drawing and about how the part is to be cut.

Lengths are in the units of the part file that is written: inch when the drawing is in inches
or feet, otherwise mm.
"""

import math
from dataclasses import dataclass

MM_PER_INCH = 25.4


@dataclass(frozen=True)
class View:
    """Which lines of the drawing are the part, and where the lathe stands in it.

    `axis` and `front` are in units of the drawing: the spindle axis, and the place of z = 0.
    None lets the importer find or choose a value.
    """

    layers: tuple[str, ...] = ()
    units: str | None = None
    scale: float = 1.0
    spindle: str = "x"
    axis: float | None = None
    half: str = "auto"
    free_end: str = "auto"
    mirror: bool = False
    front: float | None = None
    length: float | None = None
    tolerance: float | None = None
    snap: float | None = None


@dataclass(frozen=True)
class Tool:
    """The tool: angles in degrees, as in the part file."""

    name: str = "right-hand"
    hand: str = "right"
    front_clearance: float = 3.0
    back_clearance: float = 30.0
    nose_radius: float = 0.0

    @property
    def steepest_fall(self) -> float:
        """Degrees down from the Z axis that it can follow towards the chuck."""
        return self._square if self.hand == "left" else self.back_clearance

    @property
    def steepest_rise(self) -> float:
        """Degrees up from the Z axis that it can follow towards the chuck."""
        return self.back_clearance if self.hand == "left" else self._square

    @property
    def _square(self) -> float:
        """How steep a shoulder the leading edge can cut."""
        return 90.0 + min(self.front_clearance, 0.0)


@dataclass(frozen=True)
class Cutting:
    """Name, stock and cutting data; None takes a default that suits a small lathe."""

    name: str | None = None
    stock_diameter: float | None = None
    stock_length: float | None = None
    allowance: float = 0.0
    depth_of_cut: float | None = None
    finish_allowance: float | None = None
    feed: float | None = None
    finish_feed: float | None = None
    retract: float | None = None
    spindle_speed: float | None = None
    tool: Tool = Tool()


@dataclass(frozen=True)
class Defaults:
    """What is used when nothing is said, in one unit of length; feeds per minute."""

    depth_of_cut: float
    finish_allowance: float
    feed: float
    finish_feed: float
    retract: float
    snap: float
    spare_length: float
    stock_grid: float
    decimals: int


DEFAULTS = {
    "mm": Defaults(0.5, 0.1, 120.0, 60.0, 0.5, 0.01, 5.0, 1.0, 4),
    "inch": Defaults(0.02, 0.004, 4.0, 2.0, 0.02, 0.0004, 0.2, 0.125, 5),
}


def rounded_up(value: float, grid: float) -> float:
    """The next multiple of `grid` that is not below `value`."""
    return math.ceil(value / grid - 1e-6) * grid
