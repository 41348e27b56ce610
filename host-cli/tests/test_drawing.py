# SPDX-License-Identifier: Apache-2.0
"""Drawings: the shape and the passes behind them, and what is on the sheet."""

from pathlib import Path
from xml.etree import ElementTree

import pytest

from tornillo.drawing import draw_part, part_scene
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.scene import Line, Text
from tornillo.shape import Section, finished, levels, passes

MANY = """
[part]
name = "many"
units = "mm"
[stock]
diameter = 20.0
length = 30.0
[cut]
depth_of_cut = 1.0
feed = 100.0
retract = 0.5
"""


def texts(part: Part, machine: Machine) -> list[str]:
    """Every text on the sheet."""
    return [thing.text for thing in part_scene(part, machine).things if isinstance(thing, Text)]


def many(*operations: str) -> Part:
    """A part of these operations."""
    return Part.parse(MANY + "".join(f"[[operation]]\n{text}\n" for text in operations))


def test_the_test_bar_takes_four_even_passes_and_ends_on_size(
    test_bar: Path, machine: Machine
) -> None:
    image = Part.load(test_bar).steps(machine)
    strokes = passes(image)
    assert [stroke.start for stroke in strokes] == [(0, 1608), (0, 1429), (0, 1250), (0, 1071)]
    assert all(stroke.end[0] == -3571 and not stroke.finishing for stroke in strokes)
    assert finished(image) == [Section(0, -3571, 1071), Section(-3571, -7143, 1786)]


def test_no_pass_is_deeper_than_the_depth_of_cut() -> None:
    for outside in range(1, 60):
        at = 60
        for finishing, level in levels(60, 60 - outside, 7, 3):
            assert 0 < at - level <= (3 if finishing else 7)
            at = level
        assert at == 60 - outside


def test_a_face_is_cut_from_outside_and_leaves_the_face(
    stepped_pin: Path, machine: Machine
) -> None:
    image = Part.load(stepped_pin).steps(machine)
    strokes = [stroke for stroke in passes(image) if stroke.operation == 1]
    assert strokes[0].start == (strokes[0].end[0], 1125)
    assert {stroke.end[1] for stroke in strokes} == {0}
    assert strokes[-1].end == (0, 0)
    assert not any(stroke.finishing for stroke in strokes)
    assert [section.radius for section in finished(image)] == [422, 703, 984, 1125]


def test_a_pass_starts_where_earlier_operations_have_left_material(machine: Machine) -> None:
    part = many(
        'type = "cylinder"\nz = [0.0, -10.0]\ndiameter = 10.0',
        'type = "cylinder"\nz = [0.0, -20.0]\ndiameter = 19.0',
        'type = "cylinder"\nz = [0.0, -5.0]\ndiameter = 12.0',
    )
    strokes = passes(part.steps(machine))
    assert [stroke.start[0] for stroke in strokes if stroke.operation == 2] == [-1406]
    assert not [stroke for stroke in strokes if stroke.operation == 3]


def test_a_part_turned_away_completely_can_be_drawn(machine: Machine) -> None:
    part = many(
        'type = "cylinder"\nz = [0.0, -10.0]\ndiameter = 0.0',
        'type = "face"\nz = -10.0\ndiameter = 5.0',
    )
    assert finished(part.steps(machine))[0].z_front == -1406
    assert "Ø20" in texts(part, machine)


def test_the_sheet_has_every_dimension_in_the_units_of_the_file(
    test_bar: Path, stepped_pin: Path, machine: Machine
) -> None:
    found = texts(Part.load(test_bar), machine)
    assert {"Ø0.600", "Ø1.000", "1.000", "2.000", "test-bar"} <= set(found)
    found = texts(Part.load(stepped_pin), machine)
    assert {"Ø6", "Ø10", "Ø14", "Ø16", "12", "22", "30", "45", "0.8"} <= set(found)
    assert "Ø16 x 45 + 0.8 raw mm" in found
    assert any("3 passes + finish" in text for text in found)


def test_a_long_list_of_operations_is_cut_short(machine: Machine) -> None:
    operation = 'type = "cylinder"\nz = [0.0, -10.0]\ndiameter = 15.0'
    assert "    and 14 more" in texts(many(*[operation] * 20), machine)


def test_the_drawing_stays_on_the_sheet(
    test_bar: Path, stepped_pin: Path, machine: Machine
) -> None:
    for path in (test_bar, stepped_pin):
        scene = part_scene(Part.load(path), machine)
        for thing in scene.things:
            places = (thing.at,) if isinstance(thing, Text) else thing.points
            assert all(0 <= x <= scene.width and 0 <= y <= scene.height for x, y in places)


@pytest.mark.parametrize(("diameter", "length"), [(0.5, 60.0), (24.0, 2.0), (24.0, 60.0)])
def test_thin_and_short_parts_stay_on_the_sheet_too(
    machine: Machine, diameter: float, length: float
) -> None:
    text = MANY.replace("20.0", str(diameter)).replace("30.0", str(length))
    text = text.replace("depth_of_cut = 1.0", "depth_of_cut = 0.2")
    operation = f'type = "cylinder"\nz = [0.0, {-length / 2}]\ndiameter = {diameter / 2}'
    scene = part_scene(Part.parse(f"{text}[[operation]]\n{operation}"), machine)
    for thing in scene.things:
        if isinstance(thing, Line):
            assert all(0 <= x <= scene.width and 0 <= y <= scene.height for x, y in thing.points)


def test_the_svg_is_well_formed_and_as_large_as_a4(
    test_bar: Path, machine: Machine, tmp_path: Path
) -> None:
    path = tmp_path / "bar.svg"
    draw_part(Part.load(test_bar), machine, path)
    root = ElementTree.parse(path).getroot()
    assert (root.get("width"), root.get("height")) == ("297mm", "210mm")
    name = "{http://www.w3.org/2000/svg}text"
    assert "Ø0.600" in [element.text for element in root.iter(name)]


def test_the_same_part_gives_the_same_svg(test_bar: Path, machine: Machine) -> None:
    part = Part.load(test_bar)
    assert part_scene(part, machine).svg() == part_scene(part, machine).svg()
