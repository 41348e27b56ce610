# SPDX-License-Identifier: Apache-2.0
"""Tools and [part], [cut] of a part file: defaults, what they become, what is refused."""

import math

import pytest
from part_texts import HEAD, line_of, operation, refusal, steps

from tornillo.cutting import OVERRIDES
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol import SLOPE_ANY, ToolRecord

BAR = operation("cylinder", "z = [0.0, -10.0]\ndiameter = 15.0")


def tool(body: str) -> str:
    """The text of one tool."""
    return f'[[tool]]\nname = "a"\n{body}\n\n'


def record(body: str, head: str = HEAD) -> ToolRecord:
    """What a tool becomes."""
    found = steps(BAR, head=head + tool(body)).records[0]
    assert isinstance(found, ToolRecord)
    return found


def test_a_file_without_tools_has_a_right_hand_tool() -> None:
    [found, *_] = steps(BAR, head=HEAD).records
    name = b"right-hand\0\0"
    assert found == ToolRecord(0, name, 0, 0, 0, 148, SLOPE_ANY, 0, 0)


@pytest.mark.parametrize(
    ("body", "front", "back"),
    [
        ("", 90, 30),
        ("front_clearance = 0", 90, 30),
        ("front_clearance = -10", 80, 30),
        ("back_clearance = 45", 90, 45),
        ("back_clearance = 0", 90, 0),
        ("back_clearance = 90", 90, 90),
        ('hand = "left"', 30, 90),
        ('hand = "left"\nfront_clearance = -5', 30, 85),
        ('hand = "neutral"', 30, 30),
        ('hand = "neutral"\nfront_clearance = -20\nback_clearance = 55', 70, 55),
    ],
)
def test_the_hand_tells_which_edge_meets_rises_and_which_falls(
    body: str, front: float, back: float
) -> None:
    def slope(angle: float) -> int:
        return SLOPE_ANY if angle == 90 else round(math.tan(math.radians(angle)) * 256)

    found = record(body)
    assert (found.front, found.back) == (slope(front), slope(back))


def test_nose_width_and_offset_are_told_in_the_units_of_the_chip() -> None:
    found = record("nose_radius = 0.4\noffset = { z = 1.0, diameter = -2.0 }")
    assert (found.nose, found.below) == (400, 57)
    assert (found.offset_z, found.offset_x) == (141, -141)
    inch = HEAD.replace('"mm"', '"inch"').replace("20.0", "0.8").replace("40.0", "1.6")
    inch = inch.replace("1.0", "0.04").replace("100.0", "4.0").replace("0.5", "0.02")
    bar = operation("cylinder", "z = [0.0, -0.4]\ndiameter = 0.6")
    [drawn_in_inch, *_] = steps(bar, head=inch + tool("nose_radius = 0.03125")).records
    assert isinstance(drawn_in_inch, ToolRecord)
    assert (drawn_in_inch.nose, drawn_in_inch.below) == (794, 112)


@pytest.mark.parametrize(
    ("body", "message", "remedy"),
    [
        ('hand = "rihgt"', 'hand cannot be "rihgt"', '"right"'),
        ("hand = 3", "hand must be a text", "write hand"),
        ("front_clearance = 91", "front_clearance cannot be 91", "-90 to 90"),
        ("front_clearance = -91", "front_clearance cannot be -91", "-90 to 90"),
        ("back_clearance = -1", "back_clearance cannot be -1", "0 to 90"),
        ("back_clearance = 91", "back_clearance cannot be 91", "0 to 90"),
        ("nose_radius = -1", "nose_radius cannot be -1", "above 0"),
        ('nose_radius = "1"', "nose_radius must be a number", "quotes"),
        ("nose = 1", 'unknown key "nose"', '"nose_radius"'),
        ("orientation = 4", "a tip of orientation 4 cannot be compensated", "use 3"),
        ("orientation = 10", "orientation cannot be 10", "0 to 9"),
        ("orientation = 2.5", "orientation cannot be 2.5", "whole"),
        ("width = -1", "width cannot be -1", "above 0"),
        ("offset = 3", "offset must be a table", "write offset"),
        ("offset = { z = 1 }", "offset: diameter is missing", "add"),
        ("offset = { z = 1, diameter = 60 }", "the slides cannot go that far", "zero"),
        ("offset = { z = 900, diameter = 0 }", "the slides cannot go that far", "zero"),
        ("angle = 3", 'unknown key "angle"', "known keys: name, hand"),
    ],
)
def test_a_tool_that_cannot_be_is_refused_by_its_name(body: str, message: str, remedy: str) -> None:
    error = refusal(BAR, head=HEAD + tool(body))
    assert message in str(error)
    assert remedy in error.remedy


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("", "cannot be used"),
        ("A", "cannot be used"),
        ("a b", "cannot be used"),
        ("thirteen-char", "cannot be used"),
        ("a_b", "cannot be used"),
        ("ä", "cannot be used"),
    ],
)
def test_a_tools_name_has_a_few_plain_characters(name: str, message: str) -> None:
    error = refusal(BAR, head=HEAD + tool("").replace('"a"', f'"{name}"'))
    assert message in str(error)
    assert "1 to 12" in error.remedy


def test_two_tools_of_one_name_and_too_many_tools_are_refused() -> None:
    text = HEAD + tool("") + tool("width = 1")
    error = refusal(BAR, head=text)
    assert f'part.toml:{line_of(text, "width") - 1}: tool "a": there already is' in str(error)
    many = "".join(tool("").replace('"a"', f'"t{number}"') for number in range(17))
    assert "17 tools are too many" in str(refusal(BAR, head=HEAD + many))
    assert "tool must be written as [[tool]]" in str(
        refusal(BAR, head=HEAD.replace("[stock]", "[tool]\n[stock]"))
    )


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('units = "mm"', 'units = "mm"\norder = "atuo"', 'order cannot be "atuo"'),
        ('units = "mm"', 'units = "mm"\npath = "tap"', 'path cannot be "tap"'),
        ('units = "mm"', 'units = "mm"\nmaterial = "x"', 'unknown key "material"'),
        ("retract = 0.5", "retract = 0.5\nspindle = 99", "the spindle cannot turn"),
        ("retract = 0.5", "retract = 0.5\nspindle = 70000", "spindle cannot be 70000"),
        ("retract = 0.5", "retract = 0.5\nspring_passes = 11", "spring_passes cannot be 11"),
        ("retract = 0.5", "retract = 0.5\npeck = -1", "peck cannot be -1"),
        ("retract = 0.5", "retract = 0.5\npekc = 1", 'unknown key "pekc"'),
        ("retract = 0.5", "", "retract is missing"),
        ("feed = 100.0", "", "feed is missing"),
        ("depth_of_cut = 1.0", "", "depth_of_cut is missing"),
    ],
)
def test_a_head_that_cannot_be_is_refused(old: str, new: str, message: str) -> None:
    assert old in HEAD
    error = refusal(BAR, head=HEAD.replace(old, new))
    assert message in str(error)


@pytest.mark.parametrize("key", [key for key in OVERRIDES if key != "peck"])
def test_cutting_data_of_an_operation_are_refused_in_their_own_line(key: str) -> None:
    body = f"z = [0, -9]\ndiameter = 9\n{key} = 9999"
    error = refusal(operation("cylinder", body), head=HEAD)
    assert str(error).startswith(
        f"part.toml:{line_of(HEAD + body, key + ' = 9999') + 2}: operation 1"
    )


def test_cutting_data_of_the_part_are_refused_once_and_in_its_line() -> None:
    head = HEAD.replace("feed = 100.0", "feed = 1000.0\nfinish_feed = 50.0")
    quick = operation("cylinder", "z = [0, -9]\ndiameter = 9\npeck = 0.1")
    problems = list(Part.parse(head + BAR + quick).problems(Machine.load()))
    assert len(problems) == 1
    assert str(problems[0]).startswith(f"part.toml:{line_of(head, 'feed =')}: a feed is too")
