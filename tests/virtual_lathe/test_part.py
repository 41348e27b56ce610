# SPDX-License-Identifier: Apache-2.0
"""Part files become the shapes that a drawing with the same numbers has."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from virtual_lathe.part import (
    Cylinder,
    Face,
    Groove,
    PartOff,
    Turned,
    WantedPart,
    read_part,
)
from virtual_lathe.shape import Arc, Line, Point
from virtual_lathe.tool import BROAD, RIGHT_HAND, Tool

HEAD = """
[part]
name = "part"
units = "mm"
{part}
[stock]
diameter = 20.0
length = 50.0
[cut]
depth_of_cut = 0.5
"""
GROOVER = """
[[tool]]
name = "right"
nose_radius = 0.4
[[tool]]
name = "groover"
hand = "neutral"
width = 2.0
offset = { z = -1.5, diameter = 3.0 }
"""
#: One step is a hundredth of a millimetre here.
STEP_NM = 10_000


def read(tmp_path: Path, text: str, part: str = "") -> WantedPart:
    """Read a part whose stock has radius 1000 and length 5000 in steps."""
    file = tmp_path / "part.toml"
    file.write_text(HEAD.format(part=part) + text, encoding="utf-8")
    return read_part(file, STEP_NM, STEP_NM)


def operation(kind: str, text: str) -> str:
    """Return an operation of a part file."""
    return f'[[operation]]\ntype = "{kind}"\n{text}\n'


def chain(part: WantedPart) -> tuple[Line | Arc, ...]:
    """Return the lines and arcs of a part's only operation."""
    (turned,) = part.operations
    assert isinstance(turned, Turned)
    return turned.chain


def test_a_part_file_becomes_steps_of_the_nearest_size(tmp_path: Path) -> None:
    file = tmp_path / "bar.toml"
    file.write_text(
        '[part]\nname = "bar"\nunits = "inch"\n[stock]\ndiameter = 1.0\nlength = 2.0\n'
        "allowance = 0.01\n[cut]\n"
        '[[operation]]\ntype = "face"\nz = 0.0\n'
        '[[operation]]\ntype = "cylinder"\nz = [0.0, -1.0]\ndiameter = 0.6\n',
        encoding="utf-8",
    )
    part = read_part(file)
    face, cylinder = part.operations
    assert (part.stock_radius, part.length, part.front) == (1786, 7143, 36)
    assert isinstance(face, Face)
    assert (face.z, face.inner) == (0, 0)
    assert isinstance(cylinder, Cylinder)
    assert (cylinder.start, cylinder.end, cylinder.radius) == (0, -3571, 1071)
    assert cylinder.drawn.radius == pytest.approx(7.62 / 0.007112)
    assert cylinder.drawn.length == pytest.approx(25.4 / 0.007112)
    surface = part.surface()
    assert [surface[z] for z in (36, 0, -1, -3571, -3572)] == [0, 0, 1071, 1071, 1786]
    file.write_text(
        file.read_text(encoding="utf-8").replace('"face"', '"thread"'), encoding="utf-8"
    )
    with pytest.raises(ValueError, match="thread"):
        read_part(file)


def test_a_cone_is_a_line_and_its_surface_exact_at_every_z(tmp_path: Path) -> None:
    text = "start = { z = -10.0, diameter = 8.0 }\nend = { z = -14.0, diameter = 12.0 }"
    part = read(tmp_path, operation("cone", text))
    contour = part.contour()
    assert contour.radius_at(-1100.25) == pytest.approx(450.125)
    assert contour.both_sides(-1000) == (400, 1000)
    assert contour.both_sides(-1400) == (1000, 600)
    assert contour.radius_at(-1400) == 600
    assert part.tool_order() == [RIGHT_HAND]


@pytest.mark.parametrize(
    "given",
    [
        "radius = 3.0",
        "center = { z = -13.0, diameter = 8.0 }",
        f"via = {{ z = {-13 + 3 * math.sin(math.pi / 4)}, "
        f"diameter = {8 + 6 * math.sin(math.pi / 4)} }}",
    ],
)
def test_a_convex_arc_is_the_same_by_radius_by_centre_and_by_third_point(
    tmp_path: Path, given: str
) -> None:
    ends = "start = { z = -10.0, diameter = 8.0 }\nend = { z = -13.0, diameter = 14.0 }\n"
    (arc,) = chain(read(tmp_path, operation("arc", ends + given)))
    assert isinstance(arc, Arc)
    assert arc.convex
    assert arc.centre == pytest.approx((-1300, 400))
    assert arc.radius_at(-1150) == pytest.approx(400 + math.sqrt(300**2 - 150**2))


@pytest.mark.parametrize("given", ["radius = -3.0", "center = { z = -10.0, diameter = 14.0 }"])
def test_a_concave_arc_lies_below_its_centre(tmp_path: Path, given: str) -> None:
    ends = "start = { z = -10.0, diameter = 8.0 }\nend = { z = -13.0, diameter = 14.0 }\n"
    (arc,) = chain(read(tmp_path, operation("arc", ends + given)))
    assert isinstance(arc, Arc)
    assert not arc.convex
    assert arc.centre == pytest.approx((-1000, 700))
    assert arc.radius_at(-1150) == pytest.approx(700 - math.sqrt(300**2 - 150**2))


def test_corners_of_a_profile_are_rounded_and_chamfered(tmp_path: Path) -> None:
    points = (
        "points = [ { z = 0, diameter = 6 }, { z = -5, diameter = 6, corner = 1.0 }, "
        "{ z = -5, diameter = 12, chamfer = 0.5 }, { z = -9, diameter = 12 } ]"
    )
    first, rounding, wall, chamfer, last = chain(read(tmp_path, operation("profile", points)))
    assert (first.end, wall.start) == (Point(-400, 300), Point(-500, 400))
    assert isinstance(rounding, Arc)
    assert rounding.centre == pytest.approx((-400, 400))
    assert not rounding.convex
    assert (chamfer.start, chamfer.end) == (Point(-500, 550), Point(-550, 600))
    assert last.end == Point(-900, 600)


def test_a_corner_between_a_line_and_an_arc_touches_both(tmp_path: Path) -> None:
    points = (
        "points = [ { z = 0, diameter = 0 }, { z = -3, diameter = 6, radius = 3, corner = 1 }, "
        "{ z = -3, diameter = 12 } ]"
    )
    ball, rounding, wall = chain(read(tmp_path, operation("profile", points)))
    assert isinstance(ball, Arc)
    assert isinstance(rounding, Arc)
    assert not rounding.convex
    assert rounding.radius == pytest.approx(100)
    assert math.dist(rounding.centre, ball.centre) == pytest.approx(400)
    assert rounding.centre.z == pytest.approx(-200)
    assert wall.start == pytest.approx((-300, rounding.centre.x))


@pytest.mark.parametrize(
    ("points", "reason"),
    [
        ("{ z = 0, diameter = 6, corner = 1 }, { z = -5, diameter = 6 }", "no corners"),
        (
            "{ z = 0, diameter = 6 }, { z = -1, diameter = 6, corner = 2 }, "
            "{ z = -1, diameter = 12 }",
            "too short for their rounding",
        ),
        (
            "{ z = 0, diameter = 6 }, { z = -1, diameter = 6, chamfer = 2 }, "
            "{ z = -1, diameter = 12 }",
            "too short for their chamfer",
        ),
    ],
)
def test_corners_that_do_not_fit_are_refused(tmp_path: Path, points: str, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        read(tmp_path, operation("profile", f"points = [ {points} ]"))


def test_grooves_part_off_and_pauses_have_their_place_in_the_surface(tmp_path: Path) -> None:
    part = read(
        tmp_path,
        GROOVER
        + operation("drill", "diameter = 3.0\ndepth = 10.0")
        + operation("groove", 'z = [-10.0, -14.0]\ndiameter = 12.0\ntool = "groover"')
        + operation("pause", 'message = "measure"')
        + operation("part-off", 'z = -30.0\ntool = "groover"'),
    )
    _, groove, _, cut_off = part.operations
    assert groove == Groove(-1000, -1400, 600, "groover")
    assert cut_off == PartOff(-3000, 0, 200, "groover")
    assert part.parted_at() == -3000
    contour = part.contour()
    assert [contour.radius_at(z) for z in (-999, -1000, -1400, -1401)] == [1000, 600, 600, 1000]
    assert [contour.radius_at(z) for z in (-2999, -3000, -3200, -3201)] == [1000, 0, 0, 1000]


def test_part_off_without_a_width_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="width"):
        read(tmp_path, operation("part-off", "z = -30.0"))


def test_tools_have_their_shape_and_offset(tmp_path: Path) -> None:
    part = read(tmp_path, GROOVER + operation("face", "z = 0.0"))
    groover = Tool("groover", "neutral", width=200, offset_x=150, offset_z=-150)
    assert part.tools == {"right": Tool("right", nose=40), "groover": groover}
    assert groover.edges == (90, 90)
    assert Tool(hand="left", front_clearance=-5).edges == (30, 85)
    assert part.tool_order() == [part.tools["right"]]
    with pytest.raises(ValueError, match="orientation"):
        read(tmp_path, '[[tool]]\nname = "odd"\norientation = 1\n')


def test_tools_are_needed_in_the_order_of_the_cuts(tmp_path: Path) -> None:
    text = (
        GROOVER
        + operation("groove", 'z = [-10.0, -14.0]\ndiameter = 12.0\ntool = "groover"')
        + operation("cylinder", 'z = [0.0, -8.0]\ndiameter = 12.0\ntool = "right"')
        + operation("face", "z = 0.0")
    )
    written = read(tmp_path, text)
    assert [tool.name for tool in written.tool_order()] == ["groover", "right"]
    automatic = read(tmp_path, text, part='order = "auto"')
    kinds = [type(each) for each in automatic.operations]
    assert kinds == [Face, Cylinder, Groove]
    assert [tool.name for tool in automatic.tool_order()] == ["right", "groover"]
    plain = read(tmp_path, operation("face", "z = 0.0"))
    assert plain.tool_order() == [BROAD]


def test_facing_clears_everything_in_front(tmp_path: Path) -> None:
    text = "start = { z = -5.0, diameter = 8.0 }\nend = { z = -9.0, diameter = 12.0 }\n"
    along = read(tmp_path, operation("cone", text)).contour()
    facing = read(tmp_path, operation("cone", text + 'roughing = "facing"')).contour()
    assert (along.radius_at(-100), facing.radius_at(-100)) == (1000, 400)


def test_the_lowest_operation_makes_the_surface_wherever_they_cross(tmp_path: Path) -> None:
    cone = "start = { z = 0.0, diameter = 4.0 }\nend = { z = -10.0, diameter = 14.0 }"
    cylinder = "z = [0.0, -10.0]\ndiameter = 10.0"
    part = read(tmp_path, operation("cone", cone) + operation("cylinder", cylinder))
    contour = part.contour()
    assert [contour.radius_at(z) for z in (-300, -600, -700, -1000)] == [350, 500, 500, 500]
    assert [contour.owner_at(z) for z in (-300, -700, -2000)] == [0, 1, -1]
    assert contour.distance_to(Point(-800, 470), 100) == 30
    assert contour.distance_to(Point(-995, 900), 600) == 5


def test_tip_coordinates_and_uneven_steps_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="tool coordinates"):
        read(tmp_path, "", part='path = "tip"')
    ends = "start = { z = 0, diameter = 0 }\nend = { z = -3, diameter = 6 }\n"
    read(tmp_path, operation("arc", ends + "radius = 3.0"))
    with pytest.raises(ValueError, match="equal steps"):
        read_part(tmp_path / "part.toml", 10_000, 5_000)
