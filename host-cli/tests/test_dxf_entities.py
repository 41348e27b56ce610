# SPDX-License-Identifier: Apache-2.0
"""DXF import: every kind of entity becomes the profile that it draws."""

import math
import random
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from dxf_drawings import (
    INCH,
    STEEP,
    STEPPED_PIN,
    Piece,
    add_stepped_pin,
    corners,
    deviation,
    drawing,
    imported,
    pieces,
    task_for,
)
from ezdxf.math import Vec3

from tornillo.dxf.approximation import approximate
from tornillo.dxf.curves import Origin
from tornillo.dxf.options import Cutting, Tool

HALF_STEP = 0.003556
BULGE = math.tan(math.pi / 8)


def test_lines_in_any_order_and_direction_become_one_chain(tmp_path: Path) -> None:
    chance = random.Random(7)
    outline = [(0, 0), (0, 2), (-5, 2), (-5, 4), (-12, 4), (-12, 6), (-20, 6), (-20, 0)]
    for _ in range(20):
        document, space = drawing()
        lines = list(pairwise(outline))
        chance.shuffle(lines)
        for line in lines:
            start, end = chance.sample(line, 2)
            space.add_line(start, end)
        assert corners(imported(document, tmp_path)) == STEPPED_PIN


def test_arcs_keep_their_centre(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_arc((-4, 0), 4, 0, 90)
    space.add_line((-10, 4), (-4, 4))
    space.add_arc((-10, 6), 2, 180, 270)
    found = imported(document, tmp_path)
    assert corners(found) == [(0, 0), (-4, 8), (-10, 8), (-12, 12)]
    assert [piece.center for piece in found] == [(-4, 0), None, (-10, 6)]


def test_a_mirrored_arc_with_its_extrusion_turned_round_is_the_same_arc(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_arc((4, 0), 4, 90, 180, dxfattribs={"extrusion": (0, 0, -1)})
    space.add_line((-4, 4), (-9, 4))
    assert [piece.center for piece in imported(document, tmp_path)] == [(-4, 0), None]


@pytest.mark.parametrize("old", [False, True])
@pytest.mark.parametrize("turned", [False, True])
def test_polylines_with_bulges_become_lines_and_arcs(
    tmp_path: Path, old: bool, turned: bool
) -> None:
    document, space = drawing()
    sides = [(0, 1, BULGE), (-2, 3, 0), (-6, 3, -BULGE), (-8, 5, 0), (-12, 5, 0)]
    attributes = {}
    if turned:
        sides = [(-x, y, -bulge) for x, y, bulge in sides]
        attributes = {"extrusion": (0, 0, -1)}
    if old:
        space.add_polyline2d(sides, format="xyb", dxfattribs=attributes)
    else:
        space.add_lwpolyline(sides, format="xyb", dxfattribs=attributes)
    found = imported(document, tmp_path)
    assert corners(found) == [(0, 2), (-2, 6), (-6, 6), (-8, 10), (-12, 10)]
    centers = [
        (round(piece.center[0], 4), round(piece.center[1], 4)) for piece in found if piece.center
    ]
    assert centers == [(-2, 1), (-6, 5)]


@pytest.mark.parametrize("old", [False, True])
def test_a_closed_polyline_is_closed_by_its_last_side(tmp_path: Path, old: bool) -> None:
    document, space = drawing()
    outline = [(0, 0), (0, 2), (-5, 2), (-5, 4), (-12, 4), (-12, 0)]
    if old:
        space.add_polyline2d(outline, close=True)
    else:
        space.add_lwpolyline(outline, close=True)
    assert corners(imported(document, tmp_path)) == STEPPED_PIN[:4]


def test_the_control_frame_of_a_smoothed_polyline_is_not_drawn(tmp_path: Path) -> None:
    document, space = drawing()
    line = space.add_polyline2d([(0, 2), (-5, 2)])
    line.append_vertices([(-5, 9)], dxfattribs={"flags": 16})
    line.append_vertices([(-9, 4)])
    assert corners(imported(document, tmp_path)) == [(0, 4), (-5, 4), (-9, 8)]


def test_a_circle_on_the_axis_is_a_ball(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_circle((-5, 0), 5)
    found = imported(document, tmp_path, length=8.0)
    assert corners(found) == [(0, 0), (-8, 8)]
    assert found[0].center == (-5, 0)


def test_a_half_circle_is_given_as_two_quarters(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_circle((-3, 5), 1)
    found = imported(document, tmp_path, axis=0.0, tool=Tool("any", back_clearance=90.0))
    assert corners(found) == [(0, 10), (-1, 12), (-2, 10)]
    assert {piece.center for piece in found} == {(-1, 5)}


def test_entities_in_blocks_are_found_where_the_block_stands(tmp_path: Path) -> None:
    document, space = drawing()
    block = document.blocks.new("PIN")
    block.add_line((0, 2), (-5, 2))
    block.add_arc((-5, 4), 2, 180, 270)
    space.add_blockref("PIN", (30, 0))
    task = task_for(document, tmp_path)
    text = task.part_text(Cutting())
    assert corners(pieces(text)) == [(0, 4), (-5, 4), (-7, 8)]
    assert "LINE in block PIN" in text


def spline_places(entity: Any) -> list[tuple[float, float]]:
    """A thousand places on a spline or an ellipse."""
    shape = entity.construction_tool()
    if hasattr(shape, "knots"):
        first, last = shape.knots()[0], shape.max_t
        found = [shape.point(first + (last - first) * i / 1000) for i in range(1001)]
    else:
        start, span = shape.start_param, shape.param_span
        found = list(shape.vertices([start + span * i / 1000 for i in range(1001)]))
    return [(place.x, place.y) for place in found]


@pytest.mark.parametrize(
    ("tolerance", "most"), [(0.05, 8), (0.01, 14), (HALF_STEP, 20), (0.001, 28)]
)
def test_a_spline_becomes_few_arcs_within_the_tolerance(
    tmp_path: Path, tolerance: float, most: int
) -> None:
    document, space = drawing()
    spline = space.add_spline()
    spline.control_points = [Vec3(p) for p in [(0, 2), (-6, 1), (-9, 7), (-16, 3), (-24, 8)]]
    spline.knots = [0, 0, 0, 0, 1, 2, 2, 2, 2]
    found = imported(document, tmp_path, tolerance=tolerance)
    assert deviation(found, spline_places(spline)) <= tolerance
    assert max(piece.mismatch() for piece in found) < 0.0005
    assert len(found) <= most


def direction(piece: Piece, place: tuple[float, float]) -> float:
    """The angle of a piece at one of its ends."""
    if piece.center is None:
        return math.atan2(piece.end[1] - piece.start[1], piece.end[0] - piece.start[0])
    return math.atan2(place[0] - piece.center[0], piece.center[1] - place[1])


def test_arcs_along_a_spline_meet_without_a_corner(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_spline([(0, 2), (-6, 2.5), (-12, 5), (-20, 5)])
    found = imported(document, tmp_path)
    for before, after in pairwise(found):
        turn = abs(direction(before, before.end) - direction(after, after.start)) % math.pi
        assert min(turn, math.pi - turn) < math.radians(0.5)


def test_a_spline_with_corners_keeps_them(tmp_path: Path) -> None:
    document, space = drawing()
    spline = space.add_spline()
    spline.dxf.degree = 1
    spline.control_points = [Vec3(p) for p in [(0, 2), (-6, 2), (-9, 5), (-16, 5)]]
    spline.knots = [0, 0, 1, 2, 3, 3]
    found = imported(document, tmp_path)
    assert corners(found) == [(0, 4), (-6, 4), (-9, 10), (-16, 10)]
    assert not any(piece.center for piece in found)


@pytest.mark.parametrize("tolerance", [0.02, 0.003556])
def test_an_ellipse_becomes_arcs_within_the_tolerance(tmp_path: Path, tolerance: float) -> None:
    document, space = drawing()
    ellipse = space.add_ellipse((-10, 0), (10, 0), 0.5, 0, math.pi * 0.9)
    found = imported(document, tmp_path, tolerance=tolerance)
    assert deviation(found, spline_places(ellipse)) <= tolerance
    assert max(piece.mismatch() for piece in found) < 0.0005


def test_a_whole_ellipse_on_the_axis_is_an_egg(tmp_path: Path) -> None:
    document, space = drawing()
    ellipse = space.add_ellipse((-10, 0), (10, 0), 0.5)
    found = imported(document, tmp_path, length=15.0)
    places = [place for place in spline_places(ellipse) if place[1] >= 0 and place[0] >= -15]
    assert deviation(found, places) <= HALF_STEP


def test_text_dimensions_and_hidden_lines_are_left_out(tmp_path: Path) -> None:
    document, space = drawing()
    for name in ("CENTER", "HIDDEN"):
        document.linetypes.add(name, [2.0, 1.25, -0.25, 0.25, -0.25])
    document.layers.add("OFF").off()
    document.layers.add("FROZEN").freeze()
    document.layers.add("AXIS", linetype="CENTER")
    add_stepped_pin(space)
    space.add_text("A PIN")
    space.add_linear_dim((0, 9), (0, 2), (-5, 2)).render()
    space.add_line((0, 1), (-9, 1), {"linetype": "HIDDEN"})
    space.add_line((2, 0), (-22, 0), {"layer": "AXIS"})
    space.add_line((0, 3), (-9, 3), {"layer": "OFF"})
    space.add_line((0, 3), (-9, 3), {"layer": "FROZEN"})
    space.add_line((0, 3), (-9, 3), {"layer": "Defpoints"})
    space.add_line((0, 3), (-9, 3), {"invisible": 1})
    task = task_for(document, tmp_path)
    assert corners(pieces(task.part_text(Cutting()))) == STEPPED_PIN
    assert "axis on the centre line at y 0" in task.remarks[1]
    left_out = task.remarks[-1]
    for text in (
        "1 TEXT",
        "1 DIMENSION",
        "1 hidden line",
        "1 centre line",
        "1 invisible",
        "1 on layer Defpoints",
        "1 on layer FROZEN, which is off or frozen",
        "1 on layer OFF, which is off or frozen",
    ):
        assert text in left_out


def test_an_old_drawing_needs_its_units_said(tmp_path: Path) -> None:
    document, space = drawing(version="R12")
    add_stepped_pin(space)
    assert corners(imported(document, tmp_path, units="mm")) == STEPPED_PIN


@pytest.mark.parametrize(
    ("insunits", "view", "written", "factor"),
    [
        (INCH, {"scale": 0.1}, "inch", 0.1),
        (5, {"scale": 0.1}, "mm", 1.0),
        (4, {"units": "inch", "scale": 0.1}, "inch", 0.1),
        (6, {"units": "cm", "scale": 0.2}, "mm", 2.0),
        (9, {"scale": 50.0}, "inch", 0.05),
        (0, {"units": "mm"}, "mm", 1.0),
    ],
)
def test_units_come_from_the_drawing_or_from_a_person(
    tmp_path: Path, insunits: int, view: dict[str, Any], written: str, factor: float
) -> None:
    document, space = drawing(insunits)
    add_stepped_pin(space)
    text = task_for(document, tmp_path, **view).part_text(Cutting())
    assert f'units = "{written}"' in text
    wanted = [(z * factor, diameter * factor) for z, diameter in STEPPED_PIN]
    assert corners(pieces(text)) == [pytest.approx(place) for place in wanted]


def test_duplicates_and_pieces_drawn_over_others_count_once(tmp_path: Path) -> None:
    document, space = drawing()
    add_stepped_pin(space)
    space.add_line((-12, 4), (-5, 4))
    space.add_line((-14, 6), (-18, 6.001))
    space.add_line((-3, 2), (-3, 2))
    assert corners(imported(document, tmp_path)) == STEPPED_PIN


def test_an_arc_whose_centre_is_too_far_away_becomes_chords(tmp_path: Path) -> None:
    document, space = drawing()
    turn = math.degrees(math.asin(25 / 400))
    space.add_arc((-25, 405), 400, 270 - turn, 270)
    found = imported(document, tmp_path, free_end="right")
    assert not any(piece.center for piece in found)
    angles = [math.radians(270 - turn * index / 1000) for index in range(1001)]
    places = [(400 * math.cos(a), 405 + 400 * math.sin(a)) for a in angles]
    assert deviation(found, places) <= HALF_STEP
    assert len(found) < 30


def test_a_profile_that_may_be_too_long_is_told(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_spline([(-i, 3 + i / 8 + math.sin(i) / 2) for i in range(40)])
    task = task_for(document, tmp_path, tolerance=0.0005)
    task.part_text(Cutting(tool=STEEP))
    assert "a larger --tolerance makes fewer" in task.remarks[-1]
    task = task_for(document, tmp_path, tolerance=0.05)
    task.part_text(Cutting(tool=STEEP))
    assert "--tolerance" not in task.remarks[-1]


def test_a_curve_with_a_corner_that_nobody_knows_of_is_followed() -> None:
    def curve(at: float) -> tuple[float, float]:
        return -at, 1 + abs(at - 0.37)

    chain = approximate(curve, [], 0.001, Origin("SPLINE", "1F", "0"))
    for index in range(1001):
        assert min(piece.distance(curve(index / 1000)) for piece in chain) <= 0.001
    assert chain[0].start == curve(0)
    assert chain[-1].end == curve(1)
    assert all(math.dist(a.end, b.start) < 1e-9 for a, b in pairwise(chain))


def test_a_curve_that_turns_back_is_cut_where_it_must() -> None:
    def curve(at: float) -> tuple[float, float]:
        return 4 * math.cos(6 * at), 4 * math.sin(6 * at)

    chain = approximate(curve, [], 0.001, Origin("ELLIPSE", "1F", "0"))
    assert all(piece.sweep < math.pi for piece in chain)
    assert sum(piece.length for piece in chain) == pytest.approx(24)


def test_a_curve_that_cannot_be_followed_ends_in_short_lines(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("tornillo.dxf.approximation.SHORTEST", 1 / 64)
    chance = random.Random(3)
    chain = approximate(lambda at: (-at, chance.random()), [], 1e-6, Origin("SPLINE", "1F", "0"))
    assert len(chain) == 64
