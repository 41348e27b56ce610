# SPDX-License-Identifier: Apache-2.0
"""Drawings: what is on the sheet, that it stays there, and that nothing covers anything."""

import math
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tornillo.dimensions import Labels, spread, width_of
from tornillo.drawing import FINISHING, RAPID, ROUGHING, SMOOTHING, clipped, draw_part, part_scene
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.scene import Area, Line, Scene, Text
from tornillo.sheet import TITLE_TOP
from tornillo.tool_picture import FILL, tool_points
from tornillo.tools import Tool

HEAD = """
[part]
name = "drawn"
units = "mm"
[stock]
diameter = 20.0
length = 30.0
[cut]
depth_of_cut = 1.0
feed = 100.0
retract = 0.5
spindle = 900
"""
TURNED = """
[part]
name = "knob"
units = "mm"
[stock]
diameter = 24.0
length = 45.0
allowance = 1.0
[cut]
depth_of_cut = 1.5
finish_allowance = 0.2
feed = 120.0
finish_feed = 60.0
retract = 0.5
[[tool]]
name = "profile"
back_clearance = 50.0
nose_radius = 0.2
[[tool]]
name = "parting"
width = 2.0
[[operation]]
type = "face"
z = 0.0
[[operation]]
type = "profile"
points = [
 { z = 0.0, diameter = 0.0 },
 { z = -9.0, diameter = 8.0, radius = 5.5 },
 { z = -10.0, diameter = 8.0 },
 { z = -22.0, diameter = 12.0, radius = -40.0 },
 { z = -24.0, diameter = 18.0, corner = 0.6 },
 { z = -35.0, diameter = 18.0 },
]
[[operation]]
type = "pause"
message = "check the diameter"
[[operation]]
type = "groove"
tool = "parting"
z = [-26.0, -29.5]
diameter = 14.0
"""


def of_type(scene: Scene, kind: type) -> list[object]:
    """The things of one kind on the sheet."""
    return [thing for thing in scene.things if isinstance(thing, kind)]


def texts(part: Part, machine: Machine) -> list[str]:
    """Every text on the sheet."""
    return [thing.text for thing in part_scene(part, machine).things if isinstance(thing, Text)]


def drawn(*operations: str, head: str = HEAD) -> Part:
    """A part of these operations."""
    return Part.parse(head + "".join(f"[[operation]]\n{text}\n" for text in operations))


@pytest.fixture
def knob() -> Part:
    """A part of every kind of line."""
    return Part.parse(TURNED)


def test_the_sheet_has_every_dimension_in_the_units_of_the_file(
    test_bar: Path, stepped_pin: Path, machine: Machine
) -> None:
    found = texts(Part.load(test_bar), machine)
    assert {"Ø0.600", "Ø1.000", "1.000", "2.000", "test-bar"} <= set(found)
    found = texts(Part.load(stepped_pin), machine)
    assert {"Ø6", "Ø10", "Ø14", "Ø16", "12", "22", "30", "45", "0.8"} <= set(found)
    assert "Ø16 x 45 + 0.8 raw mm" in found
    assert any(text.startswith("3 passes, ") for text in found)


def test_radii_angles_and_widths_are_told(knob: Part, machine: Machine) -> None:
    found = set(texts(knob, machine))
    # The corner of 0.6 mm is dimensioned by its radius and the place of the sharp corner.
    assert {"R5.5", "R40", "R0.6", "56.3°", "3.5", "Ø8", "Ø12", "Ø14", "Ø18", "Ø24"} <= found
    assert {"-9", "-10", "-22", "-24", "-26", "-29.5", "-35", "-45", "0", "1"} <= found


def test_a_small_break_of_a_corner_is_a_chamfer(machine: Machine) -> None:
    part = drawn(
        'type = "cone"\nstart = { z = 0.0, diameter = 18.0 }\nend = { z = -0.5, diameter = 19.0 }'
    )
    assert "0.5 x 45°" in texts(part, machine)


def test_the_title_block_tells_stock_cutting_data_time_and_tools(
    knob: Part, machine: Machine
) -> None:
    found = texts(knob, machine)
    assert {"knob", "profile", "parting", "nose R0.2", "width 2", "front 3°", "back 50°"} <= set(
        found
    )
    assert "1.5 mm, retract 0.5" in found
    assert "120 mm/min, finish 60" in found
    assert any(text.startswith("about ") and text.endswith("in the cut") for text in found)
    assert "RUN goes on" in found
    assert "900 rev/min" in texts(drawn('type = "cylinder"\nz = [0, -9]\ndiameter = 9'), machine)


def test_every_kind_of_move_has_its_line(knob: Part, machine: Machine) -> None:
    pens = {thing.pen for thing in part_scene(knob, machine).things if isinstance(thing, Line)}
    assert {ROUGHING, SMOOTHING, FINISHING, RAPID} <= pens
    assert RAPID.dashes


def test_the_finished_shape_follows_its_arcs(knob: Part, machine: Machine) -> None:
    """The outline is as smooth as a circle: no corner between two chords above 8 degrees."""
    scene = part_scene(knob, machine)
    lines = [thing for thing in scene.things if isinstance(thing, Line)]
    outline = max(lines, key=lambda line: len(line.points)).points
    assert len(outline) > 100
    sharp = 0
    for a, b, c in zip(outline, outline[1:], outline[2:], strict=False):
        if math.dist(a, b) > 1e-6 and math.dist(b, c) > 1e-6:
            before = math.atan2(b[1] - a[1], b[0] - a[0])
            turn = (math.atan2(c[1] - b[1], c[0] - b[0]) - before + math.pi) % math.tau - math.pi
            sharp += abs(turn) > math.radians(8)
    assert sharp < 40


def boxes(scene: Scene) -> list[tuple[str, float, float, float, float]]:
    """The room of every text."""
    found = []
    for thing in scene.things:
        if not isinstance(thing, Text):
            continue
        wide, high = width_of(thing.text, thing.size) * 0.9, thing.size * 0.8
        shift = {"start": 0.5, "middle": 0.0, "end": -0.5}[thing.anchor] * wide
        x, y = thing.at
        if thing.turn:
            wide, high, y = high, wide, y + shift
        else:
            x += shift
        found.append((thing.text, x - wide / 2, y - high / 2, x + wide / 2, y + high / 2))
    return found


def test_no_two_texts_cover_each_other(
    knob: Part, test_bar: Path, stepped_pin: Path, machine: Machine
) -> None:
    for part in (knob, Part.load(test_bar), Part.load(stepped_pin)):
        for one, other in combinations(boxes(part_scene(part, machine)), 2):
            apart = (
                one[1] >= other[3] or other[1] >= one[3] or one[2] >= other[4] or other[2] >= one[4]
            )
            assert apart, (one, other)


def test_a_long_list_of_operations_is_cut_short(machine: Machine) -> None:
    operation = 'type = "cylinder"\nz = [0.0, -10.0]\ndiameter = 15.0'
    assert "    and 12 more" in texts(drawn(*[operation] * 20), machine)


def test_many_tools_are_at_least_named(machine: Machine) -> None:
    tools = "".join(f'[[tool]]\nname = "tool-{number}"\n' for number in range(5))
    operations = [
        f'type = "cylinder"\nz = [0.0, -10.0]\ndiameter = {15 - number}\ntool = "tool-{number}"'
        for number in range(5)
    ]
    assert "and tool-3, tool-4" in texts(drawn(*operations, head=HEAD + tools), machine)


def inside_the_sheet(scene: Scene) -> None:
    """Every point of the drawing is on the paper."""
    for thing in scene.things:
        places = (thing.at,) if isinstance(thing, Text) else thing.points
        assert all(0 <= x <= scene.width and 0 <= y <= scene.height for x, y in places), thing


@pytest.mark.parametrize(("diameter", "length"), [(0.5, 60.0), (24.0, 2.0), (24.0, 60.0)])
def test_thin_and_short_parts_stay_on_the_sheet(
    machine: Machine, diameter: float, length: float
) -> None:
    head = HEAD.replace("20.0", str(diameter)).replace("30.0", str(length))
    head = head.replace("depth_of_cut = 1.0", "depth_of_cut = 0.2")
    operation = f'type = "cylinder"\nz = [0.0, {-length / 2}]\ndiameter = {diameter / 2}'
    inside_the_sheet(part_scene(drawn(operation, head=head), machine))


def test_parts_with_many_dimensions_stay_on_the_sheet(machine: Machine) -> None:
    points = ", ".join(
        f"{{ z = {-number}, diameter = {4 + number % 2 * 3 + number * 0.3} }}"
        for number in range(28)
    )
    tool = '[[tool]]\nname = "sharp"\nback_clearance = 80\n'
    part = drawn(f'type = "profile"\npoints = [{points}]', head=HEAD + tool)
    scene = part_scene(part, machine)
    inside_the_sheet(scene)
    drawn_above = [
        thing for thing in scene.things if isinstance(thing, Line) and thing.pen == RAPID
    ]
    assert all(y > TITLE_TOP for line in drawn_above[1:-1] for _, y in line.points)


def test_a_part_turned_away_completely_can_be_drawn(machine: Machine) -> None:
    part = drawn(
        'type = "cylinder"\nz = [0.0, -10.0]\ndiameter = 0.0',
        'type = "face"\nz = -10.0\ndiameter = 5.0',
    )
    assert "Ø20" in texts(part, machine)


def test_tools_are_drawn_in_the_scale_of_the_part(knob: Part, machine: Machine) -> None:
    fills = [
        thing
        for thing in part_scene(knob, machine).things
        if isinstance(thing, Area) and thing.fill == FILL
    ]
    assert len(fills) == 3


def test_the_edges_of_a_tool_have_its_angles() -> None:
    right = tool_points(Tool(front_clearance=5.0, back_clearance=30.0), (0.0, 0.0), 1.0, 10.0)
    (x0, y0), (x1, y1) = right[0], right[1]
    assert math.degrees(math.atan2(x0 - x1, y0 - y1)) == pytest.approx(5.0)
    (x0, y0), (x1, y1) = right[-4], right[-3]
    assert math.degrees(math.atan2(y1 - y0, x1 - x0)) == pytest.approx(30.0)
    left = tool_points(Tool(hand="left"), (0.0, 0.0), 1.0, 10.0)
    assert max(x for x, _ in right) > 5
    assert min(x for x, _ in left) < -5
    round_nose = tool_points(Tool(nose_radius=2.0), (0.0, 0.0), 1.0, 10.0)
    assert min(y for _, y in round_nose) == pytest.approx(0.0, abs=0.05)
    assert min(x for x, _ in round_nose) == pytest.approx(0.0, abs=0.05)
    parting = tool_points(Tool(width=3.0), (0.0, 0.0), 2.0, 10.0)
    assert max(x for x, _ in parting) == 6.0


def test_lines_are_cut_off_at_the_edge_of_the_view() -> None:
    area = ((0.0, 0.0), (10.0, 10.0))
    assert clipped((-5.0, 5.0), (5.0, 5.0), area) == ((0.0, 5.0), (5.0, 5.0))
    assert clipped((-5.0, -5.0), (-1.0, 5.0), area) is None
    assert clipped((20.0, 5.0), (20.0, 9.0), area) is None


def test_crowded_numbers_make_room_for_each_other() -> None:
    moved = spread([5.0, 5.5, 6.0, 20.0], 3.0, (0.0, 30.0))
    assert moved == pytest.approx([2.5, 5.5, 8.5, 20.0])
    assert spread([0.0, 0.1], 4.0, (0.0, 30.0)) == pytest.approx([0.0, 4.0])


def test_a_label_without_room_is_left_out() -> None:
    labels = Labels(Scene(100, 100), ((0.0, 0.0), (30.0, 30.0)))
    assert labels.put((15.0, 15.0), (0.0, 1.0), "R5")
    labels.keep_off((0.0, 0.0), (30.0, 30.0))
    assert not labels.put((15.0, 15.0), (0.0, 1.0), "R6")


def test_the_svg_is_well_formed_and_as_large_as_a4(
    test_bar: Path, machine: Machine, tmp_path: Path
) -> None:
    path = tmp_path / "bar.svg"
    draw_part(Part.load(test_bar), machine, path)
    root = ElementTree.parse(path).getroot()
    assert (root.get("width"), root.get("height")) == ("297mm", "210mm")
    name = "{http://www.w3.org/2000/svg}text"
    assert "Ø0.600" in [element.text for element in root.iter(name)]


def test_the_same_part_gives_the_same_svg(knob: Part, machine: Machine) -> None:
    assert part_scene(knob, machine).svg() == part_scene(knob, machine).svg()
