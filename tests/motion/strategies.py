# SPDX-License-Identifier: Apache-2.0
"""Random motion for the property tests."""

from __future__ import annotations

import math

from hypothesis import HealthCheck, reject, settings
from hypothesis import strategies as st

from .reference import Arc, Line, Move, arc_between

SMALLEST_RADIUS, LARGEST_RADIUS = 5.0, 60_000.0
EIGHTHS = tuple(k * math.pi / 4 for k in range(8))


def repeatable(examples: int) -> settings:
    """Settings of a property test that tries the same examples every time."""
    return settings(
        derandomize=True,
        max_examples=examples,
        deadline=None,
        database=None,
        suppress_health_check=list(HealthCheck),
    )


def rates(lowest: float = 2_000.0, highest: float = 15_000.0) -> st.SearchStrategy[float]:
    """Feeds in steps/s."""
    return st.floats(lowest, highest).map(round).map(float)


@st.composite
def lines(draw: st.DrawFn, longest: int = 3_000) -> Line:
    """Lines of any direction; short ones, steep ones and those of one axis are frequent."""
    size = draw(st.sampled_from((1, 4, 40, longest)))
    dx = draw(st.integers(-size, size))
    dz = draw(st.one_of(st.integers(-size, size), st.just(0), st.sampled_from((dx, -dx, 1, -1))))
    if (dx, dz) == (0, 0):
        dz = draw(st.sampled_from((1, -1)))
    return Line(dx, dz, draw(rates()))


@st.composite
def arcs(
    draw: st.DrawFn,
    smallest: float = SMALLEST_RADIUS,
    largest: float = LARGEST_RADIUS,
    longest: float = 3_000.0,
) -> Arc:
    """Arcs of any radius, sense and place; ends on the axes and diagonals are frequent."""
    radius = math.exp(draw(st.floats(math.log(smallest), math.log(largest))))
    if draw(st.booleans()):
        radius = float(round(radius))
    radius = min(max(radius, smallest), largest)
    start = draw(st.one_of(st.floats(0.0, math.tau), st.sampled_from(EIGHTHS)))
    sweep = draw(st.one_of(st.floats(0.02, 6.2), st.sampled_from(EIGHTHS[1:])))
    sweep = min(max(sweep, 4.0 / radius), longest / radius, 6.2)
    towards_z = draw(st.booleans())
    rate = draw(rates())
    try:
        arc = arc_between(radius, start, sweep, towards_z, rate)
    except ValueError:
        reject()
    # Rounding the ends of a nearly full circle may have made it a short one.
    if abs(arc.sweep - sweep) > 3.0 / radius:
        arc = arc_between(radius, start, min(sweep, 3.0), towards_z, rate)
    return arc


def moves(longest: int = 300) -> st.SearchStrategy[Move]:
    """Lines and arcs for chains."""
    return st.one_of(lines(longest), arcs(largest=5_000.0, longest=float(longest)))


def chains(most: int = 40, longest: int = 300) -> st.SearchStrategy[list[Move]]:
    """Sequences of lines and arcs."""
    return st.lists(moves(longest), min_size=2, max_size=most)
