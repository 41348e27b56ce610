# SPDX-License-Identifier: Apache-2.0
"""Splines and ellipses as chains of arcs that meet without a corner.

Each stretch of a curve becomes two arcs that share its end points and its directions there
(a biarc). Stretches are made as long as the tolerance allows.
"""

import math
from collections.abc import Callable, Iterable
from itertools import pairwise

from tornillo.dxf.curves import Origin, Point, Segment

Curve = Callable[[float], Point]
CHECKS = 32
HALVINGS = 12
SHORTEST = 1 / 4096
SHARE = 0.8
STEP = 1e-6
STRAIGHT = 1e-9


def approximate(
    curve: Curve, corners: Iterable[float], tolerance: float, origin: Origin
) -> list[Segment]:
    """Lines and arcs never farther than `tolerance` from `curve`, which runs from 0 to 1.

    At `corners` the curve may change its direction suddenly.
    """
    places = [0.0, *sorted(corner for corner in corners if 0 < corner < 1), 1.0]
    result: list[Segment] = []
    for first, last in pairwise(places):
        at = first
        while at < last:
            until, pieces = _longest(curve, at, last, SHARE * tolerance, origin)
            result += pieces
            at = until
    return result


def _longest(
    curve: Curve, start: float, last: float, tolerance: float, origin: Origin
) -> tuple[float, list[Segment]]:
    """The farthest place up to which one biarc does, and its pieces; else a short line."""
    pieces = _fitting(curve, start, last, tolerance, origin)
    if pieces:
        return last, pieces
    low = min(last, start + SHORTEST)
    best = [Segment(curve(start), curve(low), origin)]
    high = last
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        pieces = _fitting(curve, start, middle, tolerance, origin)
        if pieces:
            low, best = middle, pieces
        else:
            high = middle
    return low, best


def _fitting(
    curve: Curve, start: float, end: float, tolerance: float, origin: Origin
) -> list[Segment] | None:
    """The biarc between two places of the curve, None when it is too far from it."""
    places = [curve(start + (end - start) * index / CHECKS) for index in range(CHECKS + 1)]
    pieces = _biarc(curve, start, end, origin)
    if any(piece.sweep >= math.pi for piece in pieces):
        return None
    if any(min(piece.distance(place) for piece in pieces) > tolerance for place in places):
        return None
    return pieces


def _direction(curve: Curve, start: float, end: float) -> Point:
    """The direction of the curve at `start`, looking towards `end`, of length 1."""
    step = (end - start) * STEP
    p0, p1, p2 = curve(start), curve(start + step), curve(start + 2 * step)
    x, y = (4 * p1[0] - 3 * p0[0] - p2[0], 4 * p1[1] - 3 * p0[1] - p2[1])
    length = math.hypot(x, y) or 1.0
    return x / length, y / length


def _biarc(curve: Curve, start: float, end: float, origin: Origin) -> list[Segment]:
    """Two arcs with the ends and the directions of a stretch of the curve."""
    p0, p1 = curve(start), curve(end)
    t0 = _direction(curve, start, end)
    back = _direction(curve, end, start)
    t1 = -back[0], -back[1]
    vx, vy = p1[0] - p0[0], p1[1] - p0[1]
    square = vx * vx + vy * vy
    forward = vx * (t0[0] + t1[0]) + vy * (t0[1] + t1[1])
    bend = 2 * (1 - t0[0] * t1[0] - t0[1] * t1[1])
    root = math.sqrt(forward * forward + bend * square)
    reach = square / max(forward + root, STRAIGHT)
    joint = (
        (p0[0] + p1[0] + reach * (t0[0] - t1[0])) / 2,
        (p0[1] + p1[1] + reach * (t0[1] - t1[1])) / 2,
    )
    return [_arc(p0, t0, joint, origin), _arc(p1, back, joint, origin).reversed()]


def _arc(start: Point, direction: Point, end: Point, origin: Origin) -> Segment:
    """The arc, or line, that leaves `start` in `direction` and ends in `end`."""
    x, y = end[0] - start[0], end[1] - start[1]
    beside = direction[0] * y - direction[1] * x
    square = x * x + y * y
    if abs(beside) <= STRAIGHT * math.sqrt(square):
        return Segment(start, end, origin)
    radius = square / (2 * beside)
    center = start[0] - direction[1] * radius, start[1] + direction[0] * radius
    return Segment(start, end, origin, center, radius < 0)
