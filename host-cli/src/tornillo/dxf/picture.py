# SPDX-License-Identifier: Apache-2.0
"""A drawing on A4 as the importer sees it: outline, the rest, the axis, places of problems."""

import math
import textwrap
from collections.abc import Sequence
from pathlib import Path

from tornillo.dxf.curves import Point, Segment
from tornillo.dxf.importer import Import
from tornillo.dxf.paper import Mark
from tornillo.scene import Pen, Scene, Text

SHEET = (297.0, 210.0)
FRAME = ((8.0, 8.0), (289.0, 202.0))
VIEW = ((24.0, 68.0), (273.0, 190.0))
BORDER, OTHER, OUTLINE = Pen(0.5), Pen(0.2, "#8c959f"), Pen(0.5)
AXIS = Pen(0.18, "#57606a", (6.0, 1.2, 1.2, 1.2))
MARK = Pen(0.6, "#c2255c")
RING, RING_CORNERS = 4.0, 24
CURVE_POINTS = 32
TOP_OF_TEXT, ROW, SMALL, LARGE = 52.0, 4.6, 2.9, 4.2
COLUMNS, MOST_ROWS = 150, 8


def save_picture(
    task: Import, title: str, lines: Sequence[str], marks: Sequence[Mark], path: Path
) -> None:
    """Write the picture of `task` to `path`, .svg or .png; `lines` stand below the drawing.

    Raises TornilloError when .png is wanted and matplotlib is not installed.
    """
    scene = picture(task, title, lines, marks)
    if path.suffix == ".png":
        from tornillo.scene_png import save_png

        save_png(scene, path)
    else:
        path.write_text(scene.svg(), encoding="utf-8")


def picture(task: Import, title: str, lines: Sequence[str], marks: Sequence[Mark]) -> Scene:
    """The sheet."""
    scene = Scene(*SHEET)
    scene.box(BORDER, *FRAME)
    scene.line(BORDER, (FRAME[0][0], TOP_OF_TEXT + 6), (FRAME[1][0], TOP_OF_TEXT + 6))
    drawn = task.drawn()
    places = [place for segment in drawn for place in segment.samples()]
    places += [place for place, _ in marks]
    if places:
        sheet = _Sheet(places)
        for segment in drawn:
            scene.line(OTHER, *sheet.path(segment))
        for segment in task.outline():
            scene.line(OUTLINE, *sheet.path(segment))
        _draw_axis(scene, sheet, task, places)
        for place, text in marks:
            _draw_mark(scene, sheet.at(place), text)
    _write(scene, title, lines)
    return scene


class _Sheet:
    """Where places of the drawing land on the sheet."""

    def __init__(self, places: Sequence[Point]) -> None:
        """As large as fits."""
        xs, ys = zip(*places, strict=True)
        (left, low), (right, high) = VIEW
        room = (right - left) / max(max(xs) - min(xs), 1e-9)
        self.factor = min(room, (high - low) / max(max(ys) - min(ys), 1e-9))
        self.middle = (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2
        self.center = (left + right) / 2, (low + high) / 2

    def at(self, place: Point) -> Point:
        """The place on the sheet."""
        return (
            self.center[0] + (place[0] - self.middle[0]) * self.factor,
            self.center[1] + (place[1] - self.middle[1]) * self.factor,
        )

    def path(self, segment: Segment) -> list[Point]:
        """A segment as corners on the sheet."""
        count = CURVE_POINTS if segment.center else 1
        return [self.at(place) for place in segment.samples(count)]


def _draw_axis(scene: Scene, sheet: _Sheet, task: Import, places: Sequence[Point]) -> None:
    """The spindle axis, when it is known."""
    if task.half is None or task.paper is None:
        return
    turned = [task.paper.turn(place)[0] for place in places]
    ends = [task.paper.turn((x, task.half.axis)) for x in (min(turned), max(turned))]
    scene.line(AXIS, *(sheet.at(end) for end in ends))


def _draw_mark(scene: Scene, at: Point, text: str) -> None:
    """A ring around a place, with what is there."""
    angles = [2 * math.pi * index / RING_CORNERS for index in range(RING_CORNERS + 1)]
    ring = [(at[0] + RING * math.cos(turn), at[1] + RING * math.sin(turn)) for turn in angles]
    scene.line(MARK, *ring)
    label = (at[0] + RING + 1, at[1] + RING)
    scene.text(Text(label, text, SMALL, bold=True, color=MARK.color))


def _write(scene: Scene, title: str, lines: Sequence[str]) -> None:
    """The text below the drawing."""
    left = FRAME[0][0] + 4
    scene.text(Text((left, TOP_OF_TEXT), title, LARGE, bold=True))
    rows = [row for line in lines for row in textwrap.wrap(line, COLUMNS)]
    for index, row in enumerate(rows[:MOST_ROWS], start=1):
        scene.text(Text((left, TOP_OF_TEXT - 1 - index * ROW), row, SMALL))
