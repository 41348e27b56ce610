# SPDX-License-Identifier: Apache-2.0
"""DXF import: the same outline comes out however it is placed, cut, turned and shuffled."""

import math
import random
from pathlib import Path

import pytest
from dxf_drawings import Piece, Point, deviation, drawing, imported
from ezdxf.layouts.layout import Modelspace

from tornillo.dxf.options import Tool

FINE = 0.0005
ANY_SLOPE = Tool("any", back_clearance=90.0)


def random_outline(chance: random.Random) -> list[Piece]:
    """Lines and arcs from a flat or pointed front to a cylinder at the chuck."""
    found: list[Piece] = []
    z, x = 0.0, chance.choice([0.0, 2.0])
    for _ in range(chance.randint(1, 7)):
        kind = chance.choice(["line", "arc", "step"])
        if kind == "step" and x > 0:
            end = (z, x + chance.uniform(0.3, 1.5))
        else:
            end = (z - chance.uniform(0.5, 4), max(0.5, x + chance.uniform(-1, 1.5)))
        found.append(Piece((z, x), end, None))
        if kind == "arc":
            found[-1] = bent(found[-1], chance)
        z, x = end
    return [*found, Piece((z, x), (z - 1.5, x), None)]


def bent(piece: Piece, chance: random.Random) -> Piece:
    """The piece as an arc, where that stays between the ends and above the axis."""
    (z0, x0), (z1, x1) = piece.start, piece.end
    chord = math.dist(piece.start, piece.end)
    radius = chord * chance.uniform(1.2, 4)
    height = chance.choice([-1, 1]) * math.sqrt(radius * radius - chord * chord / 4)
    center = (z0 + z1) / 2 - height * (x1 - x0) / chord, (x0 + x1) / 2 + height * (z1 - z0) / chord
    lowest = center[1] - radius if z1 < center[0] < z0 else min(x0, x1)
    one_side = (x0 - center[1]) * (x1 - center[1]) > 0
    above = min(x0, x1) > center[1] or lowest > FINE
    return piece._replace(center=center) if one_side and above else piece


def places_on(piece: Piece) -> list[Point]:
    """Places evenly along a piece."""
    shares = [index / 20 for index in range(21)]
    (z0, x0), (z1, x1) = piece.start, piece.end
    if piece.center is None:
        return [(z0 + (z1 - z0) * share, x0 + (x1 - x0) * share) for share in shares]
    zc, xc = piece.center
    first = math.atan2(x0 - xc, z0 - zc)
    turn = (math.atan2(x1 - xc, z1 - zc) - first + math.pi) % (2 * math.pi) - math.pi
    radius = math.dist(piece.start, piece.center)
    angles = [first + turn * share for share in shares]
    return [(zc + radius * math.cos(angle), xc + radius * math.sin(angle)) for angle in angles]


def add(space: Modelspace, start: Point, end: Point, center: Point | None) -> None:
    """Draw one piece."""
    if center is None:
        space.add_line(start, end)
        return
    first, last = (
        math.degrees(math.atan2(place[1] - center[1], place[0] - center[0]))
        for place in (start, end)
    )
    if (last - first) % 360 > 180:
        first, last = last, first
    space.add_arc(center, math.dist(start, center), first, last)


@pytest.mark.parametrize("seed", range(60))
def test_an_outline_comes_out_as_it_was_meant(tmp_path: Path, seed: int) -> None:
    chance = random.Random(seed)
    outline = random_outline(chance)
    back = outline[-1].end
    pieces = [*outline, Piece(back, (back[0], 0.0), None)]
    if outline[0].start[1]:
        pieces.append(Piece((0.0, 0.0), outline[0].start, None))
    x, y = chance.choice([(0.0, 0.0), (50.0, 0.0), (123.4, -77.7)])
    left, upright = chance.random() < 0.5, chance.random() < 0.4
    sides = chance.choice([(1,), (-1,), (1, -1)])

    def put(place: Point, side: int) -> Point:
        along, across = x + (-place[0] if left else place[0]), y + side * place[1]
        return (across, along) if upright else (along, across)

    document, space = drawing()
    drawn = [(piece, side) for piece in pieces for side in sides]
    chance.shuffle(drawn)
    for piece, side in drawn:
        start, end = chance.sample([put(piece.start, side), put(piece.end, side)], 2)
        add(space, start, end, put(piece.center, side) if piece.center else None)
    found = imported(
        document,
        tmp_path,
        tool=ANY_SLOPE,
        free_end="left" if left else "right",
        spindle="y" if upright else "x",
        axis=y,
    )
    places = [place for piece in outline for place in places_on(piece)]
    at_front = [place for place in places if place[0] > -FINE and place[1] < found[0].start[1]]
    assert deviation(found, [place for place in places if place not in at_front]) < FINE
    assert max(piece.mismatch() for piece in found) < FINE
