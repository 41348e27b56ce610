# SPDX-License-Identifier: Apache-2.0
"""DXF import: the axis, the half, the free end, and what of an outline is turned."""

import math
from pathlib import Path
from typing import Any

import pytest
from dxf_drawings import (
    MM,
    STEEP,
    STEPPED_PIN,
    add_stepped_pin,
    corners,
    drawing,
    imported,
    pieces,
    task_for,
)
from ezdxf.layouts.layout import Modelspace

from tornillo.dxf.options import Cutting, Tool


def add_full_section(space: Modelspace, x: float = 0.0, y: float = 0.0) -> None:
    """Both halves of the stepped pin, its front at `x`, its axis at `y`."""
    half = [(0, 2), (-5, 2), (-5, 4), (-12, 4), (-12, 6), (-20, 6)]
    around = [*half, *((a, -b) for a, b in reversed(half))]
    space.add_lwpolyline([(x + a, y + b) for a, b in around], close=True)


@pytest.mark.parametrize(("x", "y"), [(0, 0), (100, 50), (-3, -200)])
def test_a_full_section_is_found_wherever_it_stands(tmp_path: Path, x: float, y: float) -> None:
    document, space = drawing()
    add_full_section(space, x, y)
    task = task_for(document, tmp_path)
    assert corners(pieces(task.part_text(Cutting()))) == STEPPED_PIN
    assert task.remarks[1].startswith("full section, upper half taken; axis")


def test_halves_may_differ_by_less_than_the_snap(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_lwpolyline([(0, 2), (-5, 2), (-5, -2.004), (0, -2.004)], close=True)
    assert corners(imported(document, tmp_path)) == [(0, 4), (-5, 4)]


@pytest.mark.parametrize(("half", "diameter"), [("upper", 4), ("lower", 6)])
def test_one_of_two_different_halves_can_be_chosen(
    tmp_path: Path, half: str, diameter: float
) -> None:
    document, space = drawing()
    space.add_lwpolyline([(0, 2), (-5, 2), (-5, -3), (0, -3)], close=True)
    found = imported(document, tmp_path, half=half)
    assert corners(found) == [(0, diameter), (-5, diameter)]


def test_a_lower_half_is_turned_up(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_arc((-4, 0), 4, 270, 360)
    space.add_line((-4, -4), (-9, -4))
    space.add_line((-9, 0), (0, 0))
    found = imported(document, tmp_path)
    assert corners(found) == [(0, 0), (-4, 8), (-9, 8)]
    assert found[0].center == (-4, 0)


def test_the_smaller_end_is_free_wherever_it_is_drawn(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_arc((4, 0), 4, 90, 180)
    space.add_line((4, 4), (9, 4))
    space.add_line((9, 4), (9, 6))
    space.add_line((9, 6), (12, 6))
    space.add_line((12, 6), (12, 0))
    task = task_for(document, tmp_path)
    found = pieces(task.part_text(Cutting()))
    assert corners(found) == [(0, 0), (-4, 8), (-9, 8), (-9, 12), (-12, 12)]
    assert found[0].center == (-4, 0)
    assert "the free end is the left one, z = 0 at x 0" in task.remarks


@pytest.mark.parametrize("said", [{"free_end": "left"}, {"mirror": True}])
def test_a_person_may_say_which_end_is_free(tmp_path: Path, said: dict[str, Any]) -> None:
    document, space = drawing()
    space.add_lwpolyline([(0, 2), (-5, 2), (-9, 4)])
    found = imported(document, tmp_path, **said)
    assert corners(found) == [(0, 8), (-4, 4), (-9, 4)]


def test_a_person_may_say_where_the_front_and_the_axis_are(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_lwpolyline([(40, 12), (30, 12), (30, 15), (20, 15)])
    found = imported(document, tmp_path, front=41.0, axis=10.0)
    assert corners(found) == [(-1, 4), (-11, 4), (-11, 10), (-21, 10)]


def test_the_spindle_may_stand_upright(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_arc((0, 16), 4, 0, 90)
    space.add_line((4, 16), (4, 10))
    space.add_line((4, 10), (6, 10))
    space.add_line((6, 10), (6, 0))
    space.add_line((6, 0), (0, 0))
    task = task_for(document, tmp_path, spindle="y")
    found = pieces(task.part_text(Cutting()))
    assert corners(found) == [(0, 0), (-4, 8), (-10, 8), (-10, 12), (-20, 12)]
    assert found[0].center == (-4, 0)
    assert "the free end is the right one, z = 0 at y 20" in task.remarks
    assert "upper half; axis at x 0" in task.remarks


def test_the_outer_side_of_a_ring_is_turned(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_lwpolyline([(0, 3), (0, 5), (-2, 6), (-8, 6), (-8, 3)], close=True)
    task = task_for(document, tmp_path, axis=0.0)
    assert corners(pieces(task.part_text(Cutting()))) == [(0, 10), (-2, 12), (-8, 12)]
    assert "the outer side of the closed figure is turned, not its bore" in task.remarks


def test_an_allowance_is_faced_off_in_front_of_the_profile(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_lwpolyline([(0, 1), (0, 2), (-5, 2), (-9, 4)])
    text = task_for(document, tmp_path).part_text(Cutting(allowance=0.5))
    assert "allowance = 0.5" in text
    assert 'type = "face"' in text
    assert "diameter = 2.0\n\n" in text
    assert corners(pieces(text)) == [(0, 4), (-5, 4), (-9, 8)]


def test_lines_and_arcs_that_go_on_are_one_piece(tmp_path: Path) -> None:
    document, space = drawing()
    for start, end in ((0, 20), (20, 50), (50, 90)):
        space.add_arc((-4, 0), 4, start, end)
    space.add_line((-4, 4), (-5, 4))
    space.add_line((-5, 4), (-9, 4))
    found = imported(document, tmp_path)
    assert corners(found) == [(0, 0), (-4, 8), (-9, 8)]


def test_a_line_that_leans_back_by_less_than_the_tolerance_is_square(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_lwpolyline([(0, 2), (-5, 2), (-4.998, 4), (-9, 4), (-8.999, 0)])
    assert corners(imported(document, tmp_path)) == [(0, 4), (-5, 4), (-5, 8), (-9, 8)]


def test_ends_closer_than_the_snap_are_joined_and_arcs_follow(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_arc((-4, 0), 4, 0, 90)
    space.add_line((-4.006, 4.006), (-9, 4))
    found = imported(document, tmp_path)
    assert len(found) == 2
    assert found[0].mismatch() < 0.0002
    assert math.dist(found[0].end, (-4, 4)) < 0.005
    found = imported(document, tmp_path, snap=0.02)
    assert len(found) == 2


def test_a_gap_above_the_snap_can_be_bridged_by_a_larger_one(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_line((0, 2), (-5, 2))
    space.add_line((-5.1, 2), (-9, 4))
    assert corners(imported(document, tmp_path, snap=0.11)) == [(0, 4), (-5.05, 4), (-9, 8)]


def test_only_the_named_layers_are_taken(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_line((0, 2), (-5, 2), {"layer": "Outline"})
    space.add_line((-5, 2), (-9, 4), {"layer": "Cone"})
    space.add_line((0, 3), (-7, 3), {"layer": "Other"})
    found = imported(document, tmp_path, layers=("OUTLINE", "cone"))
    assert corners(found) == [(0, 4), (-5, 4), (-9, 8)]


def test_a_tool_with_its_angles_is_written_and_named(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_lwpolyline([(0, 4), (-5, 4), (-8, 2), (-12, 2)])
    tool = Tool("slim", "right", -1.0, 40.0, 0.2)
    text = task_for(document, tmp_path, free_end="right").part_text(Cutting(tool=tool))
    for line in (
        'name = "slim"',
        "front_clearance = -1.0",
        "back_clearance = 40.0     # degrees; the profile falls at up to 33.7",
        "nose_radius = 0.2",
        'tool = "slim"',
    ):
        assert f"\n{line}\n" in text


def test_a_left_hand_tool_may_fall_squarely_but_not_rise(tmp_path: Path) -> None:
    document, space = drawing(MM)
    space.add_lwpolyline([(0, 4), (-5, 4), (-5, 2), (-12, 3)])
    found = imported(document, tmp_path, tool=Tool("left", "left"), free_end="right")
    assert corners(found) == [(0, 8), (-5, 8), (-5, 4), (-12, 6)]


def test_the_stock_suits_the_part_when_nothing_is_said(tmp_path: Path) -> None:
    document, space = drawing()
    add_stepped_pin(space)
    space.add_circle((-30, 0), 0.2, {"layer": "elsewhere"})
    text = task_for(document, tmp_path, layers=("0",)).part_text(Cutting(tool=STEEP))
    assert "[stock]\ndiameter = 12.0\nlength = 25.0\n" in text
    assert corners(pieces(text)) == STEPPED_PIN


def test_a_bulging_profile_counts_with_its_top(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_arc((-5, 2), 5, 30, 150)
    space.add_line((-5 + 5 * math.cos(math.pi / 6), 0), (-5, 0))
    task = task_for(document, tmp_path)
    task.part_text(Cutting(tool=STEEP))
    assert task.contour is not None
    assert task.contour.largest_diameter == pytest.approx(14)
