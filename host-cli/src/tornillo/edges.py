# SPDX-License-Identifier: Apache-2.0
"""Whether the edges of a tool can follow a contour, by its true geometry."""

import math
from collections.abc import Iterator
from typing import NamedTuple

from tornillo.contour import Arc, Element, Point
from tornillo.language import _
from tornillo.tools import Tool

SLACK = 1e-4  # degrees


class Steep(NamedTuple):
    """A place that is too steep for a tool. Angles in degrees from the axis."""

    at: Point
    place: int
    falls: bool
    angle: float
    follows: float


def too_steep(elements: tuple[Element, ...], tool: Tool) -> Iterator[Steep]:
    """Where the contour is steeper than the edges of `tool` allow."""
    for element in elements:
        ends = (element.start, element.end) if isinstance(element, Arc) else (element.start,)
        for at in ends:
            direction = element.direction(at)
            angle = math.degrees(math.atan2(abs(direction.x), -direction.z))
            falls = direction.x < 0
            follows = tool.steepest_fall if falls else tool.steepest_rise
            if direction.x and angle > follows + SLACK:
                yield Steep(at, element.place, falls, angle, follows)


def remedy(steep: Steep, tool: Tool) -> str:
    """What tool would do."""
    trailing = steep.falls == (tool.hand != "left")
    if trailing:
        need = _("back_clearance of {angle:.1f} degrees").format(angle=steep.angle)
    else:
        need = _("front_clearance of {angle:.1f} degrees").format(angle=steep.angle - 90)
    return _("make it less steep, or use a tool with a {need} or more").format(need=need)
