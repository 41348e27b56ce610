# SPDX-License-Identifier: Apache-2.0
"""Every shape of tool against what geometry says it leaves."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import pytest

from virtual_lathe.dimensions import Ruler
from virtual_lathe.driver import Driver
from virtual_lathe.part import Cylinder, Groove, PartOff, Turned, WantedPart, read_part
from virtual_lathe.shape import Arc, Line, Point
from virtual_lathe.tool import Tool
from virtual_lathe.workpiece import Stock, Workpiece

#: The model may be wrong by this much; see README.md.
MODEL = 0.1
LENGTH = 2000


def bench(tool: Tool, allowance: int = 0) -> tuple[Workpiece, Driver]:
    """Return a bar of radius 300, and the tool in front of it."""
    work = Workpiece(Stock(300, LENGTH, allowance), tool=tool)
    return work, Driver(work, 320, 60)


def cone(*places: tuple[float, float], tool: Tool | None = None) -> WantedPart:
    """Return a part with one chain of lines through places (x, z)."""
    points = [Point(z, x) for x, z in places]
    chain = tuple(Line(a, b) for a, b in pairwise(points))
    tools = {tool.name: tool} if tool else {}
    return WantedPart(300, LENGTH, 0, (Turned("cone", chain),), tools)


# -- noses -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("rise", [30, 100, 200, 260])
@pytest.mark.parametrize("nose", [7.0, 28.123, 56.2])
def test_a_rising_cone_that_is_not_compensated_is_too_thick_by_the_formula(
    nose: float, rise: int
) -> None:
    work, driver = bench(Tool(nose=nose))
    driver.along((20, 20), (20, 0), (20 + rise, -200), (320, -200))
    angle = math.atan2(rise, 200)
    error = nose * (1 - math.tan((math.pi / 2 - angle) / 2))
    for z in (-150, -140.5, -125.0625):
        assert work.radius_at(z) - (20 - z * rise / 200) == pytest.approx(error, abs=MODEL)


@pytest.mark.parametrize("nose", [7.0, 56.2])
def test_a_compensated_cone_is_right_and_its_diameters_and_angle_are_measured(nose: float) -> None:
    tool = Tool(nose=nose)
    work, driver = bench(tool)
    angle = math.pi / 4
    down = nose * (1 - math.tan((math.pi / 2 - angle) / 2))
    start = round(2 * (100 - down)) / 2
    driver.along((start - 60, 60), (start + 150, -150), (320, -150))
    wanted = cone((100, 0), (250, -150), tool=tool)
    assert work.gouge_max_steps(wanted) < 0.25 + MODEL
    assert work.left_max_steps(wanted) < 0.25 + MODEL
    start_diameter, end_diameter = work.dimensions(wanted, 10_000, 10_000)
    assert (start_diameter["name"], end_diameter["name"]) == (
        "cone 1 start diameter",
        "cone 1 end diameter",
    )
    assert (start_diameter["wanted_mm"], end_diameter["wanted_mm"]) == (2.0, 5.0)
    off = start + down - 100
    for entry in (start_diameter, end_diameter):
        assert entry["error_steps"] == pytest.approx(off, abs=MODEL)


def test_a_nose_leaves_its_radius_in_a_shoulder_and_that_is_not_left_over() -> None:
    nose = 40.0
    tool = Tool(nose=nose)
    work, driver = bench(tool)
    driver.along((200, 20), (200, -300), (320, -300))
    for u in (0, 1, 5.5, 20, 39):
        expected = 200 + nose - math.sqrt(nose**2 - (nose - u) ** 2)
        assert work.radius_at(-300 + u) == pytest.approx(expected, abs=1e-6)
    wanted = WantedPart(300, LENGTH, 0, (Cylinder(0, -300, 200),), {"t": tool})
    assert work.gouge_max_steps(wanted) == 0
    assert work.left_max_steps(wanted) == pytest.approx(0, abs=MODEL)
    errors = [entry["error_steps"] for entry in work.dimensions(wanted, 7112, 7112)]
    assert errors == pytest.approx([0, 0], abs=MODEL)
    assert work.left_max_steps(WantedPart(300, LENGTH, 0, (Cylinder(0, -300, 200),))) > 10


def test_a_face_to_the_centre_needs_the_nose_to_go_past_the_axis() -> None:
    nose = 30.0
    work, driver = bench(Tool(nose=nose), allowance=40)
    driver.along((320, 0), (0, 0))
    assert work.radius_at(0) == nose
    assert work.radius_at(nose) == work.radius_at(40) == 0
    driver.along((-30, 0), (320, 0))
    assert work.radius_at(0) == 0
    assert work.crashes == []


@pytest.mark.parametrize(("nose", "convex"), [(0.0, True), (25.0, True), (25.0, False)])
def test_an_arc_is_measured_by_its_radius_and_its_worst_deviation(
    nose: float, convex: bool
) -> None:
    tool = Tool(nose=nose, back_clearance=60)
    work, driver = bench(tool)
    start, end = Point(0.0, 100.0), Point(-150.0, 250.0)
    arc = Arc.of_radius(start, end, 150.0 if convex else -150.0)
    first = 100 - nose if convex else 100
    driver.along((first, 60), (first, 20))
    outwards = 1 if convex else -1
    for degrees in range(91):
        turn = math.radians(degrees if convex else 90 - degrees)
        away_z, away_x = outwards * math.cos(turn), outwards * math.sin(turn)
        # The nose lies on the free side of the surface: its centre is farther from the arc's
        # centre if that is below, nearer if it is above.
        reach = 150 + outwards * nose
        driver.to(arc.centre.x + reach * away_x - nose, arc.centre.z + reach * away_z - nose)
    driver.along((250, driver.z), (250, -300), (320, -300))
    behind = Cylinder(-150, -300, 250)
    wanted = WantedPart(300, LENGTH, 0, (Turned("arc", (arc,)), behind), {tool.name: tool})
    radius, deviation, *_ = work.dimensions(wanted, 10_000, 10_000)
    assert (radius["name"], radius["wanted_mm"]) == ("arc 1 radius", 1.5)
    # Places are rounded to half steps, and a chord of one degree lies 0.006 inside.
    assert abs(radius["error_steps"]) < 0.3
    assert abs(deviation["error_steps"]) < 0.5
    assert work.gouge_max_steps(wanted) < 0.5
    (circle,) = Ruler(work.surface(), wanted, 10_000, 10_000).circles()
    assert circle["radius_mm"] == pytest.approx(1.5, abs=0.005)
    assert circle["centre_off_steps"] < 0.5


def test_a_profile_is_measured_segment_by_segment() -> None:
    places = ((100, 0), (100, -50), (150, -50), (200, -150), (200, -220))
    points = [Point(z, x) for x, z in places]
    chain = tuple(Line(a, b) for a, b in pairwise(points))
    wanted = WantedPart(300, LENGTH, 0, (Turned("profile", chain),))
    work, driver = bench(Tool())
    driver.along((102, 60), (102, -51), (150, -51), (201, -151), (201, -220), (320, -220))
    measured = {entry["name"]: entry for entry in work.dimensions(wanted, 10_000, 10_000)}
    assert {name: round(entry["error_steps"], 1) for name, entry in measured.items()} == {
        "profile 1 line 1 diameter": 2,
        "profile 1 line 2 z": -1,
        "profile 1 line 3 start diameter": -0.5,
        "profile 1 line 3 end diameter": 0.5,
        "profile 1 line 4 diameter": 1,
    }
    assert measured["profile 1 line 2 z"]["wanted_mm"] == -0.5
    assert measured["profile 1 line 3 end diameter"]["wanted_mm"] == 4.0
    (angle,) = Ruler(work.surface(), wanted, 10_000, 10_000).angles()
    assert angle["wanted_degrees"] == pytest.approx(math.degrees(math.atan(0.5)), abs=1e-3)
    assert angle["error_steps"] == pytest.approx(1.0, abs=0.1)


def test_a_face_that_becomes_a_point_is_where_it_was(tmp_path: Path) -> None:
    points = "{ z = 0, diameter = 0 }, { z = -1, diameter = 0.4 }"
    file = tmp_path / "point.toml"
    file.write_text(
        '[part]\nname = "point"\nunits = "mm"\n[stock]\ndiameter = 6\nlength = 8\n'
        'allowance = 0.2\n[[operation]]\ntype = "face"\nz = 0\n'
        f'[[operation]]\ntype = "profile"\npoints = [ {points} ]\n',
        encoding="utf-8",
    )
    wanted = read_part(file, 10_000, 10_000)
    for off in (0, 2):
        work = Workpiece(Stock(300, 800, 20), tool=Tool())
        driver = Driver(work, 320, 60)
        driver.along((320, off), (0, off), (20, -100 + off), (320, -100 + off))
        face, *_ = work.dimensions(wanted, 10_000, 10_000)
        assert face["name"] == "face 1 z"
        assert face["error_steps"] == pytest.approx(off, abs=MODEL)


# -- edges -----------------------------------------------------------------------------------------


def test_the_trailing_edge_gouges_a_cone_that_falls_more_steeply_than_it() -> None:
    places = ((250, 0), (250, -100), (100, -250), (100, -400))
    for back, nose in ((50.0, 0.0), (46.0, 0.0)):
        tool = Tool(back_clearance=back, nose=nose)
        work, driver = bench(tool)
        driver.along((250, 20), *places)
        assert work.gouge_max_steps(cone(*places, tool=tool)) == 0
    work, driver = bench(Tool(back_clearance=30))
    driver.along((250, 20), *places)
    # The edge's line from the foot of the cone; worst where the cone and what is in front of it
    # are equally far.
    k = math.tan(math.radians(30))
    s = (1 - k) / math.sqrt(2)
    worst = 150 * s / (s + k)
    assert work.gouge_max_steps(cone(*places)) == pytest.approx(worst, abs=MODEL)


def test_a_part_without_tools_that_falls_too_steeply_is_left_uncut_where_the_edge_is() -> None:
    places = ((250, 0), (250, -100), (100, -250), (100, -400))
    tool = Tool(back_clearance=30)
    work, driver = bench(tool)
    # Only as deep as the edge allows: from the top of the cone on with 30 degrees.
    foot = -100 - 150 / math.tan(math.radians(30))
    driver.along((250, 20), (250, -100), (100, round(foot * 2) / 2), (100, -400), (320, -400))
    wanted = cone(*places, tool=tool)
    assert work.gouge_max_steps(wanted) < 0.5
    assert work.left_max_steps(wanted) < 0.5


def test_a_leading_edge_that_leans_forward_cuts_the_shoulder_at_its_angle() -> None:
    work, driver = bench(Tool(front_clearance=-30.0))
    driver.along((200, 20), (200, -300))
    assert work.radius_at(-300) == 200
    assert work.radius_at(-330) == pytest.approx(200 + 30 * math.tan(math.radians(60)))
    assert work.radius_at(-360) == 300


def test_a_left_hand_tool_has_its_square_edge_at_the_free_end() -> None:
    tool = Tool(hand="left", nose=10.0)
    work, driver = bench(tool)
    driver.along((320, -200), (200, -200))
    slope, nose = math.tan(math.radians(30)), 10.0
    foot = nose * (1 - math.sin(math.radians(30)))
    low = nose * (1 - math.cos(math.radians(30)))
    assert work.radius_at(-200 - 50) == pytest.approx(200 + low + (50 + foot) * slope)
    assert work.radius_at(-200 + 20) == 210
    assert work.radius_at(-200 + 20.0625) == 300


# -- tools with a width ----------------------------------------------------------------------------


@pytest.mark.parametrize("step", [-1, 0, 2.5])
def test_a_groove_is_as_wide_as_tool_and_shift_and_measured_so(step: float) -> None:
    tool = Tool(name="groover", width=30.0)
    work, driver = bench(tool)
    driver.along((320, -130), (200, -130), (320, -130))
    driver.along((320, -155 - step), (201, -155 - step), (320, -155 - step))
    wanted = WantedPart(300, LENGTH, 0, (Groove(-100.0, -155.0, 200.0),), {tool.name: tool})
    diameter, width, place = work.dimensions(wanted, 7112, 7112)
    assert [e["name"] for e in (diameter, width, place)] == [
        "groove 1 diameter",
        "groove 1 width",
        "groove 1 z",
    ]
    assert (diameter["error_steps"], place["error_steps"]) == (1, 0)
    assert width["error_steps"] == pytest.approx(step, abs=MODEL)
    assert work.gouge_max_steps(wanted) == pytest.approx(max(0.0, step), abs=MODEL)
    assert work.left_max_steps(wanted) == pytest.approx(1, abs=0.3)


def test_what_is_parted_off_is_measured_as_if_it_were_still_there() -> None:
    tool = Tool(name="parting", width=20.0)
    work, driver = bench(tool)
    driver.along((200, 20), (200, -20), (320, -20))
    driver.along((320, -421), (0, -421), (320, -421))
    wanted = WantedPart(300, LENGTH, 0, (PartOff(-400.0, 0.0, 20.0),), {tool.name: tool})
    assert work.radius_at(-410) == work.radius_at(-100) == 0
    assert work.radius_at(-422) == 300
    (length,) = work.dimensions(wanted, 10_000, 10_000)
    assert (length["name"], length["wanted_mm"], length["error_steps"]) == (
        "part-off 1 length",
        4.0,
        1,
    )
    profile = work.profile(10_000, 10_000, wanted)
    assert profile[-4:] == [[-4.0, 6.0], [-0.21, 6.0], [-0.2, 4.0], [0.0, 4.0]]
    # 100 steps of radius too small, but only over the 20 steps behind the front.
    assert work.gouge_max_steps(wanted) == pytest.approx(20)
    assert work.crashes == []


# -- changing tools --------------------------------------------------------------------------------


def test_another_tool_stands_elsewhere_by_its_offset() -> None:
    work, driver = bench(Tool())
    driver.along((250, 20), (250, -100), (320, -100))
    work.change_tool(Tool(name="second", offset_x=12.5, offset_z=-40.0))
    driver.along((262.5, -40), (262.5, -140 - 60), (330, -200))
    assert work.radius_at(-159) == 250
    assert work.radius_at(-160) == 250
    assert work.radius_at(-161) == 300
    assert work.crashes == []


def test_a_tool_changed_inside_the_material_is_a_crash() -> None:
    work, driver = bench(Tool())
    driver.along((250, 20), (250, -100))
    work.change_tool(Tool(name="longer", offset_x=30.0))
    assert [crash.kind for crash in work.crashes] == ["tool changed inside the material"]
    assert work.radius_at(-100) == 250
