# SPDX-License-Identifier: Apache-2.0
"""What a turning tool looks like: its nose, its two edges, its width, and where its tip is.

Lengths are steps, angles degrees. The tip is the corner, towards the chuck and the axis, of the
square around the nose; of a grooving tool the corner on the chuck's side, the body reaching
``width`` to the free end.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass

from .native_library import ToolC, library

SQUARE = 90.0


@dataclass(frozen=True)
class Tool:
    """A tool.

    ``front_clearance`` is how far the leading edge leans back from a square shoulder; a negative
    one leans forward. ``back_clearance`` is the angle between the trailing edge and the Z axis.
    The leading edge is the one towards the chuck, of a left-hand tool the one towards the free
    end. ``offset_x`` (radius) and ``offset_z`` are what the slides must be farther out for this
    tool's tip to be where that of the first tool would be. An edge cuts up to ``edge_length``
    above the tip; what is behind it is the holder.
    """

    name: str = "right-hand"
    hand: str = "right"
    front_clearance: float = 3.0
    back_clearance: float = 30.0
    nose: float = 0.0
    width: float = 0.0
    offset_x: float = 0.0
    offset_z: float = 0.0
    edge_length: float = 850.0

    @property
    def edges(self) -> tuple[float, float]:
        """Angles between the Z axis and the edges towards chuck and free end."""
        if self.width > 0:
            return SQUARE, SQUARE
        leading = SQUARE + min(self.front_clearance, 0.0)
        if self.hand == "left":
            return self.back_clearance, leading
        return leading, self.back_clearance

    def native(self) -> ToolC:
        """Return the tool for the shared library."""
        return ToolC(self.nose, self.width, *self.edges)

    def outline(self, distance: float) -> float:
        """Return how far above its tip the tool begins at a distance along Z (infinite: nowhere).

        The distance counts from the tip to the free end.
        """
        return float(library().vl_tool_outline(ctypes.byref(self.native()), distance))


#: For faces and cylinders of parts that name no tool: a point with a broad body behind it.
BROAD = Tool(name="broad", width=200.0)
#: For everything else of parts that name no tool.
RIGHT_HAND = Tool()
