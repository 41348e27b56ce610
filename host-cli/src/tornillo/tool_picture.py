# SPDX-License-Identifier: Apache-2.0
"""What a tool looks like: its edges, its nose, its width, to scale."""

import math

from tornillo.scene import Pen, Point, Scene, Text
from tornillo.tools import SQUARE, Tool

FILL = "#6e7781"
EDGE = Pen(0.25, "#30363d")
GUIDE = Pen(0.13, "#57606a", (1.0, 0.8))
NOSE_CHORDS = 12
TEXT_SIZE = 2.4
#: Degrees: below it the number of an angle needs more room.
STEEP = 40.0


def leading_angle(tool: Tool) -> float:
    """Degrees from the axis, on the chuck's side, to the edge there; above 90 it leans back."""
    if tool.hand == "left":
        return tool.back_clearance
    return SQUARE + tool.front_clearance


def trailing_angle(tool: Tool) -> float:
    """Degrees from the axis, on the free side, to the edge there."""
    if tool.hand == "left":
        return SQUARE + tool.front_clearance
    return tool.back_clearance


def tool_points(tool: Tool, tip: Point, scale: float, height: float) -> list[Point]:
    """The outline of a tool with its imaginary tip at `tip`.

    `scale`: mm on the sheet for one unit of the file; `height` of the picture, mm.
    """
    x, y = tip
    if tool.width:
        wide = tool.width * scale
        lean = math.tan(math.radians(2.0)) * height
        inner = min(lean, wide / 3)
        return [
            (x, y),
            (x + inner, y + height),
            (x + wide - inner, y + height),
            (x + wide, y),
        ]
    radius = min(tool.nose_radius * scale, height / 3)
    left, right = (math.radians(angle(tool)) for angle in (leading_angle, trailing_angle))
    centre = x + radius, y + radius
    first, last = math.pi + (SQUARE_ANGLE - left), -(SQUARE_ANGLE - right)
    # Round the nose, from the leading edge below to the trailing one.
    angles = [
        first + (last + math.tau - first) * part / NOSE_CHORDS for part in range(NOSE_CHORDS + 1)
    ]
    nose = [
        (centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle))
        for angle in angles
    ]
    start = _along(nose[0], math.pi - left, height)
    end = _along(nose[-1], right, height)
    top = max(start[1], end[1])
    return [start, *nose, end, (end[0], top), (start[0], top)]


SQUARE_ANGLE = math.pi / 2


def _along(start: Point, angle: float, height: float) -> Point:
    """Along an edge until it is `height` high or three quarters as far."""
    far = min(height / max(math.sin(angle), 1e-3), 0.75 * height / max(abs(math.cos(angle)), 1e-3))
    return start[0] + far * math.cos(angle), start[1] + far * math.sin(angle)


def draw_tool(scene: Scene, tool: Tool, tip: Point, scale: float, height: float) -> None:
    """The tool alone."""
    points = tool_points(tool, tip, scale, height)
    scene.area(FILL, *points)
    scene.line(EDGE, *points, points[0])


def draw_angles(scene: Scene, tool: Tool, tip: Point, height: float) -> None:
    """The angles of the edges beside a tool, or its width below it."""
    x, y = tip
    scene.line(GUIDE, (x - height * 0.6, y), (x + height, y))
    scene.line(GUIDE, (x, y), (x, y + height * 1.12))
    if tool.width:
        return
    for angle, side in ((leading_angle(tool), -1), (trailing_angle(tool), 1)):
        radius = height * (0.55 if angle > STEEP else 0.85)
        if angle > SQUARE:
            # How far it leans back, from upright.
            _bow(scene, tip, height * 0.9, (SQUARE, SQUARE - side * (SQUARE - angle)))
            place = x + side * 1.0, y + height * 1.28
            text = f"{angle - SQUARE:g}°"
        else:
            ends = (0.0, angle) if side > 0 else (180.0 - angle, 180.0)
            _bow(scene, tip, radius, ends)
            middle = math.radians(angle / 2)
            place = (
                x + side * (radius + 2.2) * math.cos(middle),
                y + (radius + 1.0) * math.sin(middle),
            )
            text = f"{angle:g}°"
        scene.text(Text(place, text, TEXT_SIZE, "middle"))


def _bow(scene: Scene, centre: Point, radius: float, degrees: tuple[float, float]) -> None:
    """An arc of a circle."""
    low, high = sorted(degrees)
    points = [
        (
            centre[0] + radius * math.cos(math.radians(low + (high - low) * part / 16)),
            centre[1] + radius * math.sin(math.radians(low + (high - low) * part / 16)),
        )
        for part in range(17)
    ]
    scene.line(Pen(0.15, EDGE.color), *points)
