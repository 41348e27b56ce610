# SPDX-License-Identifier: Apache-2.0
"""Part files: what is understood, and how every refusal teaches."""

from pathlib import Path

import pytest

from tornillo.contour import Line, Point
from tornillo.errors import PartError
from tornillo.image import unpack_segments
from tornillo.machine import Machine
from tornillo.operations import Contour
from tornillo.part import Part
from tornillo.protocol import ContourRecord, CutRecord
from tornillo.toml_lines import line_numbers

TEXT = """\
[part]
name = "bar"
units = "mm"

[stock]
diameter = 20.0
length = 40.0
allowance = 0.5

[cut]
depth_of_cut = 0.5
finish_allowance = 0.1
feed = 120.0
finish_feed = 60.0
retract = 0.3

[[operation]]
type = "face"
z = 0.0

[[operation]]
type = "cylinder"
z = [0.0, -10.0]
diameter = 15.0
"""


def refused(old: str, new: str, machine: Machine | None = None) -> PartError:
    """How TEXT is refused with `old` replaced by `new`."""
    assert old in TEXT
    with pytest.raises(PartError) as caught:
        Part.parse(TEXT.replace(old, new), "bar.toml").check(machine or Machine.load())
    assert caught.value.remedy
    return caught.value


def test_the_example_text_is_understood_and_accepted(machine: Machine) -> None:
    part = Part.parse(TEXT)
    assert [operation.type for operation in part.operations] == ["face", "cylinder"]
    face, cylinder = (operation.shape for operation in part.operations)
    assert isinstance(face, Contour)
    assert isinstance(cylinder, Contour)
    assert face.elements == (Line(Point(0.0, 0.0), Point(0.0, 10.0)),)
    assert cylinder.elements == (Line(Point(0.0, 7.5), Point(-10.0, 7.5)),)
    part.check(machine)


def test_the_test_bar_is_the_one_of_the_paper(test_bar: Path, machine: Machine) -> None:
    part = Part.load(test_bar)
    assert (part.units, part.stock.diameter, part.stock.length) == ("inch", 1.0, 2.0)
    image = part.steps(machine)
    _, cut, cylinder = image.records
    assert isinstance(cut, CutRecord)
    assert isinstance(cylinder, ContourRecord)
    assert (image.header.stock_radius, cut.depth_of_cut, cut.feed) == (1786, 179, 4286)
    [line] = unpack_segments(cylinder.segments)
    assert (cylinder.z, cylinder.x, line.dz, line.dx) == (0, 1071, -3571, 0)


def test_finish_feed_allowances_and_inner_diameter_may_be_left_out() -> None:
    shorter = TEXT
    for line in ("allowance = 0.5\n", "finish_allowance = 0.1\n", "finish_feed = 60.0\n"):
        shorter = shorter.replace(f"\n{line}", "\n", 1)
    part = Part.parse(shorter)
    assert (part.stock.allowance, part.cut.finish_allowance, part.cut.finish_feed) == (0, 0, 120)


def test_whole_numbers_are_numbers_too() -> None:
    assert Part.parse(TEXT.replace("20.0", "20")).stock.diameter == 20.0


@pytest.mark.parametrize(
    ("old", "new", "message", "remedy"),
    [
        ('name = "bar"', 'name = "bar', "bar.toml:2: this is not TOML", "missing quote"),
        ('name = "bar"', 'name = "Bar"', 'bar.toml:2: [part]: the name "Bar"', "a-z, 0-9"),
        ('name = "bar"', 'name = ""', 'bar.toml:2: [part]: the name ""', "1 to 16"),
        ('name = "bar"', 'name = "a\\u0000"', "bar.toml:2: [part]: the name", "a-z, 0-9"),
        ('name = "bar"', "name = 7", "bar.toml:2: [part]: name must be a text", 'name = "7"'),
        ('name = "bar"', 'nane = "bar"', 'bar.toml:2: [part]: unknown key "nane"', '"name"'),
        ('name = "bar"\n', "", "bar.toml:1: [part]: name is missing", "add a line"),
        ('"mm"', '"mn"', 'bar.toml:3: [part]: units cannot be "mn"', "mm, inch"),
        ('"mm"', '"yards"', 'bar.toml:3: [part]: units cannot be "yards"', "mm, inch"),
        ("[stock]", "[stok]", 'bar.toml:5: the file: unknown key "stok"', '"stock"'),
        ("length = 40.0", 'length = "40"', "bar.toml:7: [stock]: length must be a number", "quot"),
        ("length = 40.0", "length = true", "bar.toml:7: [stock]: length must be a number", "quot"),
        ("length = 40.0", "length = inf", "bar.toml:7: [stock]: length must be finite", "ordinar"),
        ("length = 40.0", "length = 0.0", "bar.toml:7: [stock]: length cannot be 0", "above 0"),
        ("length = 40.0", "length = 1e99", "bar.toml:7: [stock]: length cannot be 1e+99", "above"),
        ("diameter = 20.0", "diamter = 20.0", 'bar.toml:6: [stock]: unknown key "diamter"', '"dia'),
        ("feed = 120.0", "feed = -1.0", "bar.toml:13: [cut]: feed cannot be -1", "above 0"),
        ("retract = 0.3", "retract = 0.3\nspeed = 1", 'unknown key "speed"', '"feed"'),
        ("retract = 0.3", "retract = 0.3\nqqq = 1", 'unknown key "qqq"', "known keys: depth"),
        ('"face"', '"fase"', 'bar.toml:18: operation 1: type cannot be "fase"', '"face"'),
        ("diameter = 15.0", "radius = 7", "operation 2 (cylinder): diameter is missing", "add"),
        (
            "z = [0.0, -10.0]",
            "z = -10.0",
            "bar.toml:23: operation 2 (cylinder): z must be two",
            "[",
        ),
        (
            "z = [0.0, -10.0]",
            "z = [0.0]",
            "bar.toml:23: operation 2 (cylinder): z must be two",
            "[",
        ),
        ("z = [0.0, -10.0]", 'z = [0.0, "a"]', "operation 2 (cylinder): z must be a number", "quo"),
        (
            "z = 0.0",
            "z = 0.0\ndepth = 1",
            'operation 1 (face): unknown key "depth"',
            "depth_of_cut",
        ),
        ("[cut]", "[cut]\nfeed = 1", "this is not TOML", "missing"),
    ],
)
def test_what_cannot_be_understood_is_refused_with_place_and_remedy(
    old: str, new: str, message: str, remedy: str
) -> None:
    error = refused(old, new)
    assert message in str(error)
    assert remedy in error.remedy


@pytest.mark.parametrize(
    ("old", "new", "message", "remedy"),
    [
        ("diameter = 20.0", "diameter = 0.001", "bar.toml:6: the stock has no sensible", "stock"),
        ("length = 40.0", "length = 9999.0", "bar.toml:7: the stock has no sensible size", "free"),
        ("allowance = 0.5", "allowance = 9999", "bar.toml:8: the stock has no sensible", "stock"),
        (
            "= 0.5\nfin",
            "= 11.0\nfin",
            "bar.toml:11: the depth of cut has no",
            "at most the stock's",
        ),
        ("= 0.5\nfin", "= 0.001\nfin", "bar.toml:11: the depth of cut has no", "at least one step"),
        (
            "finish_allowance = 0.1",
            "finish_allowance = 0.6",
            "bar.toml:12: the finish allow",
            "one",
        ),
        ("feed = 120.0", "feed = 500.0", "bar.toml:13: a feed is too slow or too fast", "range"),
        ("finish_feed = 60.0", "finish_feed = 1.0", "the machine feeds 1.71 mm/min to", "range"),
        ("retract = 0.3", "retract = 0.001", "bar.toml:15: the retract is too small", "one step"),
        ("diameter = 20.0", "diameter = 50.5", "bar.toml:6: the slides cannot go that far", "zero"),
        ("allowance = 0.5", "allowance = 57.0", "bar.toml:8: the stock has no sensible", "stock"),
        ("allowance = 0.5", "allowance = 56.5", "bar.toml:8: the slides cannot go that", "zero"),
        (
            "length = 40.0",
            "length = 10.1",
            "operation 2 (cylinder): the operation lies outs",
            "chuck",
        ),
        (
            "[0.0, -10.0]",
            "[0.9, -10.0]",
            "bar.toml:23: operation 2 (cylinder): the operation",
            "in",
        ),
        (
            "diameter = 15.0",
            "diameter = 20.1",
            "bar.toml:24: operation 2 (cylinder): the op",
            "ins",
        ),
        (
            "diameter = 15.0",
            "diameter = -1.0",
            "bar.toml:24: operation 2 (cylinder): the op",
            "ins",
        ),
        (
            "diameter = 15.0",
            "diameter = 20.0",
            "operation 2 (cylinder): the operation has no",
            "sma",
        ),
        (
            "[0.0, -10.0]",
            "[-10.0, 0.0]",
            "the operation has nothing to cut: from z = -10 to 0",
            "free end",
        ),
        (
            "z = 0.0",
            "z = 0.5",
            "bar.toml:19: operation 1 (face): the operation has noth",
            "allowance",
        ),
        (
            "z = 0.0",
            "z = 0.0\ndiameter = 20",
            "operation 1 (face): the operation has noth",
            "small",
        ),
        ("z = 0.0", "z = 2000.0", "operation 1 (face): the operation lies outside", "keep"),
        ("z = 0.0\n", "z = 0.2\n", "bar.toml:23: operation 2 (cylinder): mater", "in front first"),
    ],
)
def test_what_the_machine_cannot_do_is_refused_with_line_operation_and_remedy(
    old: str, new: str, message: str, remedy: str
) -> None:
    error = refused(old, new)
    assert message in str(error)
    assert remedy in error.remedy


def test_a_part_beyond_the_travel_is_refused() -> None:
    text = TEXT.replace("length = 40.0", "length = 70.0").replace("-10.0]", "-60.0]")
    with pytest.raises(PartError, match=r"bar:23: operation 2 \(cylinder\): the slides cannot"):
        Part.parse(text, "bar").check(Machine.load())


def test_a_diameter_that_the_slide_cannot_reach_is_refused() -> None:
    machine = Machine("short", 7112, 7112, 3000, 16072, -3575, -8000, 1000)
    with pytest.raises(
        PartError,
        match=r"operation 1 .face.: .* diameter 0.00 mm, the slide ends at diameter 8.18 mm",
    ):
        Part.parse(TEXT).check(machine)


def test_too_many_operations_are_refused(machine: Machine) -> None:
    cylinder = '[[operation]]\ntype = "cylinder"\nz = [0.0, -10.0]\ndiameter = 15.0\n'
    with pytest.raises(PartError, match="the number of operations is wrong: 65 operations"):
        Part.parse(TEXT + 63 * cylinder).check(machine)


@pytest.mark.parametrize("broken", ["operation = []", "operation = 3", "[operation]"])
def test_operations_that_are_no_array_of_tables_are_refused(broken: str) -> None:
    text = TEXT[: TEXT.index("[[operation]]")]
    text = text + broken if broken.startswith("[") else f"{broken}\n{text}"
    with pytest.raises(PartError, match=r"operation must be written as \[\[operation\]\]"):
        Part.parse(text)


def test_something_else_in_place_of_a_table_is_refused() -> None:
    with pytest.raises(PartError, match=r"part.toml:1: \[part\] must be a table"):
        Part.parse("part = 3")


def test_every_problem_of_a_part_is_found(machine: Machine) -> None:
    text = TEXT.replace("retract = 0.3", "retract = 0.001").replace("15.0", "25.0")
    problems = [str(problem) for problem in Part.parse(text).problems(machine)]
    assert len(problems) == 2
    assert "retract" in problems[0]
    assert "operation 2" in problems[1]


def test_a_part_without_sensible_stock_gets_no_further_complaints(machine: Machine) -> None:
    text = TEXT.replace("length = 40.0", "length = 9999.0").replace("15.0", "25.0")
    [problem] = Part.parse(text).problems(machine)
    assert "the stock has no sensible size" in str(problem)


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(PartError, match=r"none.toml: the file cannot be read: No such file"):
        Part.load(tmp_path / "none.toml")


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "picture.toml"
    path.write_bytes(b"\xff\xd8\xff")
    with pytest.raises(PartError, match="cannot be read: it is not UTF-8 text"):
        Part.load(path)


def test_lines_are_found_through_comments_arrays_and_strings() -> None:
    text = (
        '# [x]\n[a]\nb = [\n  [1.5],\n  { c = "]" },\n]\n"d]" = 1\nd = 2 # [y]\n[[e]]\n[[e]]\nf=1\n'
    )
    places = line_numbers(text)
    assert places["a",] == 2
    assert places["a", "b"] == 3
    assert places["a", "d"] == 8
    assert places["e", 1] == 10
    assert places["e", 1, "f"] == 11
