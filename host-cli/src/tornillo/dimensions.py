# SPDX-License-Identifier: Apache-2.0
"""Dimension lines, leaders and numbers, as on a workshop drawing.

All coordinates are mm on the sheet.
"""

import math
from collections.abc import Sequence

from tornillo.scene import Pen, Point, Scene, Text

Span = tuple[float, float]
Box = tuple[float, float, float, float]

THIN = Pen(0.18, "#30363d")
FAINT = Pen(0.13, "#8c959f")
ARROW = 2.4
ARROW_HALF = 0.45
BEYOND = 1.5
TEXT_SIZE = 3.2
SMALL_SIZE = 2.8
CHARACTER = 0.62
#: Distances and turns (degrees) at which a place for a label is looked for.
REACHES = (5.0, 8.0, 11.0, 15.0, 20.0, 26.0)
TURNS = (0, 25, -25, 50, -50, 75, -75)
SHELF = 2.0


def along(scene: Scene, span: Span, edge: float, at: float, text: str) -> None:
    """A horizontal dimension at height `at`; extension lines come from height `edge`."""
    left, right = span
    beyond = BEYOND if at < edge else -BEYOND
    for x in (left, right):
        scene.line(THIN, (x, edge), (x, at - beyond))
    inwards = 1 if right - left > 3 * ARROW else -1
    tail = 0.0 if inwards == 1 else 2 * ARROW
    _arrow(scene, (left, at), inwards, 0)
    _arrow(scene, (right, at), -inwards, 0)
    scene.line(THIN, (left - tail, at), (right + tail, at))
    middle = (left + right) / 2
    anchor = "middle"
    if width_of(text, TEXT_SIZE) + 2 * ARROW > right - left:
        middle, anchor = left - tail, "end"
    scene.text(Text((middle, at + TEXT_SIZE * 0.65), text, TEXT_SIZE, anchor))


def across(scene: Scene, span: Span, edge: float, at: float, text: str) -> None:
    """A vertical dimension at `at`; extension lines come from `edge`."""
    low, high = span
    if edge != at:
        for y in (low, high):
            scene.line(FAINT, (edge, y), (at + BEYOND, y))
    inwards = 1 if high - low > 3 * ARROW else -1
    tail = 0.0 if inwards == 1 else 2 * ARROW
    _arrow(scene, (at, low), 0, inwards)
    _arrow(scene, (at, high), 0, -inwards)
    scene.line(THIN, (at, low - tail), (at, high + tail))
    room = width_of(text, TEXT_SIZE)
    middle = (low + high) / 2 + (high - low) * 0.18
    if room + 2 * ARROW > high - low:
        middle = high + tail + room / 2
    scene.text(Text((at - TEXT_SIZE * 0.65, middle), text, TEXT_SIZE, "middle", 90))


def spread(places: Sequence[float], apart: float, span: Span) -> list[float]:
    """Ascending `places` moved as little as possible, at least `apart`, within `span`."""
    groups: list[tuple[float, int]] = []
    for place in places:
        groups.append((place, 1))
        while len(groups) > 1:
            (first, count), (second, more) = groups[-2], groups[-1]
            if second - first >= apart * (count + more) / 2:
                break
            middle = (first * count + second * more) / (count + more)
            groups[-2:] = [(middle, count + more)]
    found: list[float] = []
    low, high = span
    for middle, count in groups:
        half = apart * (count - 1) / 2
        start = min(max(middle, low + half), high - half) - half
        start = max(start, found[-1] + apart if found else low)
        found += [start + apart * number for number in range(count)]
    return found


def ordinates_below(
    scene: Scene, places: Sequence[tuple[float, float, str]], at: float, span: Span
) -> None:
    """Numbers in a row at height `at`, each with a line from its (x, y); x ascending."""
    moved = spread([x for x, _, _ in places], TEXT_SIZE * 1.35, span)
    for (x, y, text), beside in zip(places, moved, strict=True):
        scene.line(THIN, (x, y), (x, at + 4.5), (beside, at + 1.5), (beside, at))
        scene.text(Text((beside, at - 0.8), text, TEXT_SIZE, "end", 90))


def ordinates_beside(
    scene: Scene, places: Sequence[tuple[float, float, str]], at: float, span: Span
) -> None:
    """Numbers in a column at `at`, each with a line from its (x, y); y ascending."""
    moved = spread([y for _, y, _ in places], TEXT_SIZE * 1.35, span)
    for (x, y, text), above in zip(places, moved, strict=True):
        scene.line(FAINT, (x, y), (at - 4.5, y), (at - 1.5, above), (at, above))
        scene.text(Text((at + 0.8, above), text, TEXT_SIZE))


def width_of(text: str, size: float) -> float:
    """About how wide a text is."""
    return len(text) * size * CHARACTER


class Labels:
    """Finds room for short texts with a leader, so that none covers another."""

    def __init__(self, scene: Scene, area: tuple[Point, Point]) -> None:
        """Labels stay inside `area`."""
        self.scene = scene
        self.area = area
        self.taken: list[Box] = []
        self.body: list[Box] = []

    def keep_off(self, low: Point, high: Point) -> None:
        """Leave a rectangle free of labels."""
        self.taken.append((*low, *high))

    def rather_off(self, low: Point, high: Point) -> None:
        """Put no label into a rectangle as long as there is room elsewhere."""
        self.body.append((*low, *high))

    def put(self, tip: Point, away: Point, text: str) -> bool:
        """Point at `tip` from the side of the direction `away`; False when there is no room."""
        angle = math.atan2(away[1], away[0])
        places = [(reach, turn) for reach in REACHES for turn in TURNS]
        for obstacles in (self.taken + self.body, self.taken):
            for reach, turn in places:
                way = angle + math.radians(turn)
                elbow = tip[0] + reach * math.cos(way), tip[1] + reach * math.sin(way)
                side = 1 if math.cos(way) >= 0 else -1
                box = self._box(elbow, side, text)
                if self._free(box, obstacles):
                    self._draw(tip, elbow, side, text)
                    self.taken.append(box)
                    return True
        return False

    @staticmethod
    def _box(elbow: Point, side: int, text: str) -> Box:
        """The room that a label takes beside its elbow."""
        end = elbow[0] + side * (SHELF + width_of(text, SMALL_SIZE) + 0.6)
        half = SMALL_SIZE * 0.7
        return min(elbow[0], end), elbow[1] - half, max(elbow[0], end), elbow[1] + half

    def _free(self, box: Box, obstacles: Sequence[Box]) -> bool:
        """Whether nothing is there yet."""
        (left, low), (right, high) = self.area
        x0, y0, x1, y1 = box
        if x0 < left or y0 < low or x1 > right or y1 > high:
            return False
        return not any(
            x0 < other[2] and other[0] < x1 and y0 < other[3] and other[1] < y1
            for other in obstacles
        )

    def _draw(self, tip: Point, elbow: Point, side: int, text: str) -> None:
        """An arrow, its line, a shelf and the text."""
        dx, dy = elbow[0] - tip[0], elbow[1] - tip[1]
        size = math.hypot(dx, dy)
        _arrow(self.scene, tip, dx / size, dy / size)
        shelf = elbow[0] + side * SHELF, elbow[1]
        self.scene.line(THIN, tip, elbow, shelf)
        anchor = "start" if side > 0 else "end"
        place = shelf[0] + side * 0.5, shelf[1]
        self.scene.text(Text(place, text, SMALL_SIZE, anchor))


def _arrow(scene: Scene, tip: Point, dx: float, dy: float) -> None:
    """A filled arrow head whose tip touches `tip`, pointing away from (dx, dy)."""
    x, y = tip
    base_x, base_y = x + dx * ARROW, y + dy * ARROW
    scene.area(
        THIN.color,
        tip,
        (base_x - dy * ARROW_HALF, base_y + dx * ARROW_HALF),
        (base_x + dy * ARROW_HALF, base_y - dx * ARROW_HALF),
    )
