# SPDX-License-Identifier: Apache-2.0
"""What counts as gouged, as left over and as reachable."""

from __future__ import annotations

import math

import pytest

from virtual_lathe.judgement import Surface, gouge, left
from virtual_lathe.metal import PER_STEP, reachable
from virtual_lathe.part import Cylinder, Nominal, Turned, WantedPart
from virtual_lathe.shape import Line, Point
from virtual_lathe.tool import RIGHT_HAND, Tool
from virtual_lathe.toolbox import Toolbox


def cone_part(tool: Tool) -> WantedPart:
    """Return a bar of radius 100 with a cone of 45 degrees from the axis to the outside."""
    chain = (Line(Point(0, 0), Point(-100, 100)),)
    return WantedPart(100, 200, 0, (Turned("cone", chain),), {tool.name: tool})


def surface(part: WantedPart, radius_off: float) -> Surface:
    """Return the wanted surface with that much more metal on it, in radius."""
    radii = part.contour().sample(PER_STEP)
    return Surface(-part.length, [max(0.0, min(100.0, r + radius_off)) for r in radii])


@pytest.mark.parametrize("off", [3.0, -3.0])
def test_errors_on_a_slope_are_measured_square_to_it(off: float) -> None:
    part = cone_part(Tool())
    found = surface(part, 0)
    slope = slice(110 * PER_STEP, 190 * PER_STEP)
    found.radii[slope] = surface(part, off).radii[slope]
    normal = abs(off) / math.sqrt(2)
    assert gouge(found, part) == pytest.approx(normal if off < 0 else 0, abs=0.1)
    assert left(found, part) == pytest.approx(normal if off > 0 else 0, abs=0.1)


def test_a_wall_in_the_wrong_place_is_wrong_by_its_distance_and_not_by_its_height() -> None:
    part = WantedPart(100, 200, 0, (Cylinder(0, -100, 20),))
    for wall, expected in ((-98, (0, 2)), (-103, (3, 0)), (-100, (0, 0))):
        radii = [100.0] * ((200 + wall) * PER_STEP) + [20.0] * (-wall * PER_STEP + 1)
        found = Surface(-200, radii)
        assert (gouge(found, part), left(found, part)) == pytest.approx(expected, abs=0.3)


def test_the_nearest_whole_step_is_no_gouge_but_more_is() -> None:
    drawn = Nominal(20.45, 100.0)
    part = WantedPart(100, 200, 0, (Cylinder(0, -100, 20, drawn),))
    assert gouge(surface(part, 0.0), part) == 0
    assert gouge(surface(part, -0.5), part) == 0.5


def test_a_bar_that_is_too_short_for_the_part_is_a_gouge() -> None:
    part = WantedPart(100, 200, 0, ())
    assert gouge(Surface(-150, [100.0] * (150 * PER_STEP + 1)), part) == 100


def test_a_nose_reaches_a_corner_only_with_its_radius() -> None:
    wanted = [50.0] * 100 + [10.0] * 301
    reached = reachable(Tool(nose=20.0), wanted, 4)
    for u in (0, 1, 10, 19):
        expected = 10 + 20 - math.sqrt(400 - (20 - u) ** 2)
        assert reached[100 + 4 * u] == pytest.approx(expected, abs=0.02)
    assert reached[100 + 4 * 21] == 10
    # At the back end of the bar there is no place for the tip.
    assert reached[81:100] == wanted[81:100]


def test_an_edge_reaches_behind_a_collar_only_with_its_slope() -> None:
    wanted = [10.0] * 401 + [40.0] * 100
    reached = reachable(RIGHT_HAND, wanted, 4)
    slope = math.tan(math.radians(30))
    for u in (2, 20, 50):
        assert reached[401 - 4 * u] == pytest.approx(max(10, 40 - u * slope), abs=0.2)
    assert reachable(Tool(width=20.0), wanted, 4) == wanted


def test_a_slot_narrower_than_the_tool_is_out_of_reach() -> None:
    wanted = [50.0] * 100 + [10.0] * 61 + [50.0] * 100
    assert reachable(Tool(width=15.0), wanted, 4) == wanted
    assert reachable(Tool(width=16.0), wanted, 4) == [50.0] * 261


def test_the_toolbox_hands_out_tools_in_the_order_of_the_cuts() -> None:
    tools = {"a": Tool("a"), "b": Tool("b", width=10)}
    cuts = (Cylinder(0, -10, 9, tool="b"), Cylinder(0, -5, 8, tool="a"))
    box = Toolbox(WantedPart(10, 20, 0, cuts, tools), nose=3.0)
    assert box.first == tools["b"]
    assert box.after() == Tool("a", nose=3.0)
    with pytest.raises(ValueError, match="no other tool"):
        box.after()
    assert box.named("b").width == 10
    with pytest.raises(ValueError, match="no tool 'c': a, b"):
        box.named("c")


def test_without_a_part_there_is_one_tool_and_a_nose_radius_makes_it_a_turning_tool() -> None:
    assert Toolbox(None).first.name == "broad"
    assert Toolbox(None, 5.0).first == Tool(nose=5.0)
