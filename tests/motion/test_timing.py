# SPDX-License-Identifier: Apache-2.0
"""The host's estimate of how long moves take, against the chip that makes them."""

from __future__ import annotations

import dataclasses
import random
from collections.abc import Sequence

import pytest
from planned import random_part
from simulated.processes import on_a_new_chip
from tornillo.drives import Drives, LegPlanner
from tornillo.image import SegmentKind
from tornillo.machine import Machine
from tornillo.moves import Move
from tornillo.planning import plan_part
from tornillo.protocol import FEED_UNIT
from tornillo.timing import move_times

from motion import reference
from motion.rig import Rig
from motion.strategies import EIGHTHS

#: Relative: lines and stands; whole parts with arcs, whose entries are estimated; a contour of
#: pieces so short that the look-ahead limits the speed.
PASSES_BOUND, PARTS_BOUND, CONTOUR_BOUND = 0.001, 0.003, 0.02
USUAL = Drives(rapid_x=1_000, rapid_z=1_000, start_x=400, start_z=400, acceleration=8_000)
FAST = Drives(rapid_x=4_000, rapid_z=6_000, start_x=600, start_z=900, acceleration=20_000)
#: A lathe whose switches are near the part, so that the way there does not count.
NEAR = dataclasses.replace(Machine.load(), zero_x=-180, zero_z=-60)


def driven(drives: Drives, rig: Rig | None = None) -> Rig:
    """A chip with these drives, homed; there is but one in a process."""
    rig = rig or Rig()
    rig.settle(
        acceleration=drives.acceleration,
        start_rate_x=drives.start_x,
        start_rate_z=drives.start_z,
        rapid_rate_x=drives.rapid_x,
        rapid_rate_z=drives.rapid_z,
    )
    rig.dead_steps(drives.dead_x, drives.dead_z, -drives.dead_x, -drives.dead_z)
    return rig


def segment(move: Move, drives: Drives) -> reference.Segment:
    """A move as the rig gives it to the chip."""
    rate = move.feed / FEED_UNIT
    if move.rapid:
        rate = drives.rapid_z if move.dz else drives.rapid_x
    if move.kind is SegmentKind.LINE:
        return reference.Line(move.dx, move.dz, rate, move.rapid)
    towards_z = move.kind is SegmentKind.CONCAVE
    return reference.Arc(move.dx, move.dz, move.cx / 256, move.cz / 256, towards_z, rate)


def compare(rig: Rig, moves: Sequence[Move], drives: Drives) -> float:
    """Relative error of the estimate; the chip's time from its first step on."""
    estimated = sum(move_times(moves, LegPlanner(drives)))
    taken = rig.follow([segment(move, drives) for move in moves], 600.0).seconds
    return abs(estimated / taken - 1)


def strokes(dice: random.Random, feed: int) -> list[Move]:
    """Passes as they are planned: to a level, along, off it and back, now and then a curve."""
    found: list[Move] = []
    at = (0, 0)

    def go(dz: int, dx: int, feed: int = 0) -> None:
        nonlocal at
        end = at[0] + dz, at[1] + dx
        found.append(Move(at, end, feed))
        at = end

    go(-dice.randint(50, 400), -dice.randint(50, 400))
    for _ in range(6):
        length, retract = dice.randint(5, 600), dice.randint(2, 60)
        go(0, -dice.randint(3, 80) - retract)
        go(-length, 0, feed)
        if dice.random() < 0.5:
            radius = dice.randint(10, 300)
            end = at[0] - radius, at[1] + radius
            found.append(Move(at, end, feed, SegmentKind.CONVEX, -radius * 256, 0))
            at = end
            go(-dice.randint(1, 9), 0, feed)
        go(0, retract)
        go(length, 0)
    return found


@on_a_new_chip
def test_passes_take_as_long_as_estimated() -> None:
    rig = None
    for drives in (USUAL, FAST):
        rig = driven(drives, rig)
        for seed, feed in enumerate((140, 420, 950)):
            assert (
                compare(rig, strokes(random.Random(seed), feed * FEED_UNIT), drives) <= PASSES_BOUND
            )


@on_a_new_chip
def test_dead_steps_take_as_long_as_estimated() -> None:
    drives = dataclasses.replace(USUAL, dead_x=40, dead_z=25)
    rig = driven(drives)
    # The tool is left with both screws turned in the positive direction: once per chip.
    assert compare(rig, strokes(random.Random(7), 420 * FEED_UNIT), drives) <= PASSES_BOUND


@on_a_new_chip
def test_a_contour_of_many_short_pieces_is_estimated_with_the_look_ahead() -> None:
    pieces: list[Move] = []
    at = (0, 0)
    for number in range(120):
        end = at[0] - 12, at[1] + (2 if number % 2 else 1)
        pieces.append(Move(at, end, 3_000 * FEED_UNIT))
        at = end
    assert compare(driven(FAST), pieces, FAST) <= CONTOUR_BOUND


@pytest.mark.parametrize("convex", [True, False])
def test_arcs_of_every_octant_are_as_long_as_geometry_says(convex: bool) -> None:
    from math import cos, isclose, pi, sin

    from tornillo.drives import sizes

    for first in EIGHTHS[:4]:
        for last in EIGHTHS[1:5]:
            if last > first:
                a, b = (first, last) if convex else (-first, -last)
                dz, dx = round(4000 * (cos(b) - cos(a))), round(4000 * (sin(b) - sin(a)))
                centre = -round(4000 * cos(a) * 256), -round(4000 * sin(a) * 256)
                kind = SegmentKind.CONVEX if convex else SegmentKind.CONCAVE
                entries, length = sizes(Move((0, 0), (dz, dx), 1, kind, *centre))
                assert isclose(length, 4000 * (last - first), rel_tol=0.01)
                octants = (last - first) / (pi / 4)
                assert isclose(entries, octants * 4000 * 0.5**0.5, rel_tol=0.01)


@on_a_new_chip
def test_whole_plans_take_as_long_as_estimated() -> None:
    rig = driven(USUAL)
    for seed in (3, 8, 21):
        plan = plan_part(random_part(seed), NEAR)
        for chain in plan.chains():
            if chain:
                assert compare(rig, chain, USUAL) <= PARTS_BOUND
