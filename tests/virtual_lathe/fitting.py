# SPDX-License-Identifier: Apache-2.0
"""Lines and circles through measured points, by least squares."""

from __future__ import annotations

import math
from collections.abc import Sequence

from .shape import Point

ROUNDS = 20


def fit_line(points: Sequence[Point]) -> tuple[float, float]:
    """Return radius at z = 0 and rise per z of the line nearest to points in X.

    Raises:
        ValueError: all points have the same z.
    """
    z_mean = sum(p.z for p in points) / len(points)
    x_mean = sum(p.x for p in points) / len(points)
    spread = sum((p.z - z_mean) ** 2 for p in points)
    if spread == 0:
        raise ValueError("a line needs points at two z at least")
    rise = sum((p.z - z_mean) * (p.x - x_mean) for p in points) / spread
    return x_mean - rise * z_mean, rise


def fit_circle(points: Sequence[Point], centre: Point, radius: float) -> tuple[Point, float]:
    """Return centre and radius of the circle nearest to points, beginning with a guess.

    Raises:
        ValueError: the points do not tell a circle from a line.
    """
    for _ in range(ROUNDS):
        rows, errors = [], []
        for point in points:
            away = math.hypot(point.z - centre.z, point.x - centre.x)
            rows.append(((centre.z - point.z) / away, (centre.x - point.x) / away, -1.0))
            errors.append(away - radius)
        by_z, by_x, by_radius = _solve(rows, errors)
        centre = Point(centre.z - by_z, centre.x - by_x)
        radius -= by_radius
        if abs(by_z) + abs(by_x) + abs(by_radius) < 1e-9:
            break
    return centre, radius


def _solve(rows: Sequence[Sequence[float]], values: Sequence[float]) -> list[float]:
    """Solve the normal equations of an over-determined system by elimination."""
    size = len(rows[0])
    table = [
        [sum(row[i] * row[j] for row in rows) for j in range(size)]
        + [sum(row[i] * value for row, value in zip(rows, values, strict=True))]
        for i in range(size)
    ]
    for i in range(size):
        pivot = max(range(i, size), key=lambda row: abs(table[row][i]))
        table[i], table[pivot] = table[pivot], table[i]
        if abs(table[i][i]) < 1e-12 * len(rows):
            raise ValueError("the points do not tell what is looked for")
        for row in range(size):
            if row != i:
                factor = table[row][i] / table[i][i]
                table[row] = [a - factor * b for a, b in zip(table[row], table[i], strict=True)]
    return [table[i][size] / table[i][i] for i in range(size)]
