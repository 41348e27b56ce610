# SPDX-License-Identifier: Apache-2.0
"""Dimension lines with arrows and numbers, as on a workshop drawing."""

from tornillo.scene import Pen, Scene, Text

Span = tuple[float, float]

THIN = Pen(0.18, "#30363d")
ARROW = 2.4
ARROW_HALF = 0.45
BEYOND = 1.5
TEXT_SIZE = 3.2
CHARACTER = 0.62


def along(scene: Scene, span: Span, edge: float, at: float, text: str) -> None:
    """A horizontal dimension at height `at`; extension lines come from height `edge`."""
    left, right = span
    for x in (left, right):
        scene.line(THIN, (x, edge), (x, at - BEYOND))
    inwards = 1 if right - left > 3 * ARROW else -1
    tail = 0.0 if inwards == 1 else 2 * ARROW
    _arrow(scene, (left, at), inwards, 0)
    _arrow(scene, (right, at), -inwards, 0)
    scene.line(THIN, (left - tail, at), (right + tail, at))
    middle = (left + right) / 2
    anchor = "middle"
    if len(text) * TEXT_SIZE * CHARACTER + 2 * ARROW > right - left:
        middle, anchor = left - tail, "end"
    scene.text(Text((middle, at + TEXT_SIZE * 0.65), text, TEXT_SIZE, anchor))


def across(scene: Scene, span: Span, edge: float, at: float, text: str) -> None:
    """A vertical dimension at `at`; extension lines come from `edge`."""
    low, high = span
    for y in (low, high):
        scene.line(THIN, (edge, y), (at + BEYOND, y))
    _arrow(scene, (at, low), 0, 1)
    _arrow(scene, (at, high), 0, -1)
    scene.line(THIN, (at, low), (at, high))
    place = (at - TEXT_SIZE * 0.65, (low + high) / 2 + (high - low) * 0.18)
    scene.text(Text(place, text, TEXT_SIZE, "middle", 90))


def _arrow(scene: Scene, tip: tuple[float, float], dx: int, dy: int) -> None:
    """A filled arrow head whose tip touches `tip`, pointing away from (dx, dy)."""
    x, y = tip
    base_x, base_y = x + dx * ARROW, y + dy * ARROW
    scene.area(
        THIN.color,
        tip,
        (base_x - dy * ARROW_HALF, base_y + dx * ARROW_HALF),
        (base_x + dy * ARROW_HALF, base_y - dx * ARROW_HALF),
    )
