# SPDX-License-Identifier: Apache-2.0
"""Operations that cannot be, and shapes that the tool cannot cut: how they are refused."""

import pytest
from part_texts import HEAD, TOOLS, line_of, operation, profile, refusal, steps

from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol import SLOPE_ANY, ContourRecord, ToolRecord


@pytest.mark.parametrize(
    ("kind", "body", "message", "remedy"),
    [
        ("face", "", "z is missing", "add a line"),
        ("face", "z = 0\ndiameter = 20", "nothing to cut: the stock is not larger", "smaller"),
        ("cylinder", "z = [0, -9]", "diameter is missing", "add"),
        ("cylinder", "z = 0\ndiameter = 9", "z must be two numbers", "write"),
        ("cylinder", "z = [-9, 0]\ndiameter = 9", "from z = -9 to 0", "free end"),
        ("cylinder", "z = [0, 0]\ndiameter = 9", "from z = 0 to 0", "free end"),
        ("cylinder", "z = [0, -9]\ndiameter = 9\nspeed = 1", 'unknown key "speed"', '"feed"'),
        ("cylinder", "z = [0, -9]\ndiameter = 9\nfed = 1", 'unknown key "fed"', '"feed"'),
        ("cylinder", 'z = [0, -9]\ndiameter = 9\ntool = "turnin"', "tool cannot be", '"turning"'),
        ("cylinder", 'z = [0, -9]\ndiameter = 9\ntool = "x"', "tool cannot be", "use one of"),
        ("cylinder", "z = [0, -9]\ndiameter = 9\ntool = 1", "tool must be a text", "tool ="),
        ("cylinder", 'z = [0, -9]\ndiameter = 9\nroughing = "a"', "roughing cannot", "along"),
        ("cylinder", "z = [0, -9]\ndiameter = 9\nspring_passes = 10", "cannot be 10", "0 to 9"),
        ("cylinder", "z = [0, -9]\ndiameter = 9\nspring_passes = 1.5", "cannot be 1.5", "whole"),
        ("cylinder", "z = [0, -9]\ndiameter = 9\nspindle = -1", "cannot be -1", "0 to"),
        ("cylinder", "z = [0, -9]\ndiameter = 9\nspindle = 9999", "cannot turn", "range"),
        ("cylinder", "z = [0, -9]\ndiameter = 9\nfeed = 0", "feed cannot be 0", "above"),
        ("cylinder", "z = [0, -9]\ndiameter = 9\npeck = -1", "peck cannot be -1", "above"),
        ("cylinder", "z = [0, -0.001]\ndiameter = 9", "shorter than a step", "smaller"),
        ("cone", "start = { z = 0, diameter = 3 }", "end is missing", "add"),
        ("cone", "start = 3\nend = 4", "start must be a table", "write start"),
        ("cone", "start = { z = 0 }\nend = 4", "start: diameter is missing", "add"),
        ("cone", "start = { z = 0, diameter = 3, x = 1 }\nend = 4", 'key "x"', "known keys"),
        ("cone", "start = {z=-5,diameter=3}\nend = {z=0,diameter=9}", "from z = -5 to 0", "start"),
        ("cone", "start = {z=0,diameter=3}\nend = {z=-5,diameter=30}", "outside the stock", "in"),
        ("cone", "start = {z=0,diameter=9}\nend = {z=-5,diameter=2}", "falls with 35.0", "35.0"),
        ("arc", "start = {z=0,diameter=3}\nend = {z=-5,diameter=9}", "radius is missing", "add"),
        (
            "arc",
            "start = {z=0,diameter=3}\nend = {z=-5,diameter=9}\nradius = 2",
            "less than half the distance of the ends, 2.91548",
            "at least 3.4",
        ),
        (
            "arc",
            "start = {z=0,diameter=3}\nend = {z=-5,diameter=9}\nradius = 3",
            "would run back in z, by way of z = 0.",
            "at least 3.4",
        ),
        (
            "arc",
            "start = {z=0,diameter=3}\nend = {z=-5,diameter=9}\nradius = 0",
            "its radius or its length is 0",
            "above 0",
        ),
        (
            "arc",
            "start = {z=0,diameter=3}\nend = {z=-5,diameter=9}\ncenter = {z=-2,diameter=3}",
            "the center is 2 from the start and 4.24264 from the end",
            "as far",
        ),
        (
            "arc",
            "start = {z=0,diameter=0}\nend = {z=-8,diameter=16}\n"
            "center = {z=-8,diameter=0}\nradius = 7",
            "the center is 8 from the ends, the radius says 7",
            "one of",
        ),
        (
            "arc",
            "start = {z=0,diameter=0}\nend = {z=-8,diameter=16}\n"
            "center = {z=-8,diameter=0}\nvia = {z=-7,diameter=1}",
            "center and via are too much",
            "one of",
        ),
        (
            "arc",
            "start = {z=0,diameter=0}\nend = {z=-8,diameter=16}\nvia = {z=-4,diameter=8}",
            "the three points lie on a line",
            "aside",
        ),
        (
            "arc",
            "start = {z=0,diameter=4}\nend = {z=-8,diameter=4}\nvia = {z=-9,diameter=9}",
            "would run back in z, by way of z = 1.03",
            "upright",
        ),
        ("profile", "points = 3", "a list of at least 2 points", "write"),
        ("profile", "points = [{ z = 0, diameter = 3 }]", "at least 2 points", "write"),
        ("profile", "points = [1, 2]", "point 1 must be a table", "write it as"),
        ("groove", 'z = [-9, -5]\ndiameter = 9\ntool = "parting"', "from z = -9 to -5", "free"),
        ("groove", 'z = [-5, -6]\ndiameter = 9\ntool = "parting"', "narrower than the", "wider"),
        ("groove", 'z = [-5, -9]\ndiameter = 20\ntool = "parting"', "nothing to cut", ""),
        ("groove", 'z = [-5, -9]\ndiameter = -1\ntool = "parting"', "outside the stock", ""),
        ("groove", "z = [-5, -9]\ndiameter = 9", "a tool without a width", "width"),
        ("part-off", "z = -9", "a tool without a width", "width"),
        ("part-off", 'z = -39\ntool = "parting"', "outside the stock", "retract"),
        ("cylinder", 'z = [0, -9]\ndiameter = 9\ntool = "parting"', "grooves only", "width"),
        ("drill", "diameter = 3", "depth is missing", "add"),
        ("drill", "diameter = 0\ndepth = 3", "diameter cannot be 0", "above"),
        ("drill", "diameter = 3\ndepth = 3\nfeed = 3", 'unknown key "feed"', ""),
        ("pause", "", "message is missing", "add"),
        ("pause", f'message = "{"x" * 33}"', "has 33 characters", "at most 32"),
        ("pause", 'message = "für dich"', "does not know", "ASCII"),
        ("pause", 'message = "a\\tb"', "does not know", "ASCII"),
        ("thread", "", 'type cannot be "thread"', ""),
    ],
)
def test_an_operation_that_cannot_be_is_refused_with_its_number_and_a_remedy(
    kind: str, body: str, message: str, remedy: str
) -> None:
    error = refusal(operation(kind, body))
    assert str(error).startswith("part.toml:")
    assert "operation 1" in str(error)
    assert message in str(error)
    assert remedy in error.remedy


@pytest.mark.parametrize(
    ("points", "message", "remedy"),
    [
        (("0 4", "-3 4 radius = 1", "-9 9"), "half the distance", "at least 1.5"),
        (("0 4", "-3 8 radius = 2", "-9 9"), "run back in z", "at least 2.166"),
        (("0 4", "-3 8 raduis = 2", "-9 9"), 'unknown key "raduis"', '"radius"'),
        (("0 4", "-3 8", "-2 9"), "the wrong way, from z = -3 to -2", "free end"),
        (("0 4", "0 4", "-2 9"), "it is where the one before is", "leave one"),
        (("0 4 corner = 1", "-3 4"), "corner is not possible here", "between"),
        (("0 4", "-3 4 chamfer = 1"), "chamfer is not possible here", "between"),
        (("0 4", "-3 4 corner = 1, chamfer = 1", "-3 9"), "is not possible here", "or"),
        (("0 4", "-3 4 corner = -1", "-3 9"), "corner cannot be -1", "above 0"),
        (("0 4", "-3 4 corner = 4", "-3 9"), "an arc of radius 4 does not fit", "smaller"),
        (("0 4", "-3 4 chamfer = 4", "-3 9"), "a chamfer of 4 is longer", "smaller"),
        (("0 4", "-3 4 corner = 1", "-9 4"), "there is no corner to round", "leave"),
        (("0 4", "-3 4 chamfer = 1", "-9 4"), "there is no corner to chamfer", "leave"),
        (("0 4 radius = 3", "-3 4"), 'unknown key "radius"', ""),
    ],
)
def test_a_profile_is_refused_with_the_line_of_the_point(
    points: tuple[str, ...], message: str, remedy: str
) -> None:
    text = profile(*points)
    error = refusal(text)
    number = int(str(error).split(":")[1])
    wrong = line_of(HEAD + TOOLS + text, "points = [")
    assert wrong < number <= wrong + len(points)
    assert message in str(error)
    assert remedy in error.remedy


@pytest.mark.parametrize(
    ("tool", "points", "follows"),
    [
        ("turning", ("0 10", "-5 16"), True),
        ("turning", ("0 10", "0 16", "-5 16"), True),
        ("turning", ("0 10", "-5 4.3"), True),
        ("turning", ("0 10", "-5 4.2"), False),
        ("pointed", ("0 1", "-1 4.4"), True),
        ("pointed", ("0 1", "-1 4.6"), False),
        ("pointed", ("0 10", "-1 6.6"), True),
        ("pointed", ("0 10", "-1 6.4"), False),
        ("left", ("0 10", "-1 11.6"), True),
        ("left", ("0 10", "-1 11.8"), False),
        ("left", ("0 10", "-1 5", "-2 5"), True),
        ("turning", ("0 10", "-5 10 radius = 5.1"), True),
        ("turning", ("0 10", "-5 10 radius = 4.9"), False),
        ("pointed", ("0 10", "-5 10 radius = -2.9"), True),
        ("pointed", ("0 10", "-5 10 radius = -2.8"), False),
    ],
)
def test_what_the_edges_of_the_tool_cannot_follow_is_refused(
    tool: str, points: tuple[str, ...], follows: bool
) -> None:
    text = profile(*points, more=f'tool = "{tool}"\nroughing = "along"\n')
    part = Part.parse(HEAD + TOOLS + text)
    found = [str(problem) for problem in part.problems(Machine.load())]
    assert follows is not any("edge of the tool would cut into the work" in one for one in found)
    if not follows:
        assert f'the tool "{tool}" follows' in found[0]


def test_a_refused_slope_names_the_place_and_the_angle_that_would_do() -> None:
    error = refusal(profile("0 10", "-3 10", "-5 4", "-9 4"))
    assert (
        "the back edge of the tool would cut into the work at z = -3.00 mm, diameter 10.00 mm"
        in (str(error))
    )
    assert 'the contour falls with 56.3 degrees, the tool "turning" follows 30.0' in str(error)
    assert "a tool with a back_clearance of 56.3 degrees or more" in error.remedy
    error = refusal(profile("0 4", "-1 12", more='tool = "pointed"\n'))
    assert "a front_clearance of -14.0 degrees or more" in error.remedy


def test_rounding_to_steps_never_makes_the_chip_refuse_what_the_edges_can_follow() -> None:
    image = steps(profile("0 10", "-0.5 9.43", "-0.9 8.97", "-5 8.97", "-5.1 8.86", "-6 8.86"))
    tool = image.records[0]
    assert isinstance(tool, ToolRecord)
    assert (tool.front, 148 <= tool.back <= 170) == (SLOPE_ANY, True)


def test_a_nose_that_does_not_fit_is_refused_with_the_largest_that_does() -> None:
    text = profile("0 6", "-3 6 corner = 0.25", "-3 12", "-9 12", more='tool = "round"\n')
    error = refusal(text)
    assert 'the nose of the tool "round" (radius 0.4) does not fit at z = -3.00 mm' in str(error)
    assert "the concave arc has a radius of 0.25 only" in str(error)
    assert "use a nose radius of at most 0.25" in error.remedy


def test_what_stays_in_the_middle_is_noted() -> None:
    ball = operation(
        "arc",
        'start = {z=0,diameter=0}\nend = {z=-5,diameter=10}\nradius = 5\ntool = "round"',
    )
    part = Part.parse(HEAD + TOOLS + ball)
    [note] = part.notes(Machine.load())
    assert "a pip of diameter 0.80 mm, at most 0.40 mm high, stays in the middle" in note
    far = Machine("far", 7112, 7112, 3700, 16072, -3575, -8000, 1000)
    assert part.notes(far) == ()
    record = part.steps(far).records[-1]
    assert isinstance(record, ContourRecord)
    assert record.x == -56


def test_a_machine_without_room_below_the_axis_still_says_what_it_cannot_reach() -> None:
    short = Machine("short", 7112, 7112, 3500, 16072, -3575, -8000, 1000)
    ball = operation("cylinder", 'z = [0,-5]\ndiameter = 0.5\ntool = "round"')
    problems = list(Part.parse(HEAD + TOOLS + ball).problems(short))
    assert "the slides cannot go that far" in str(problems[0])


def test_places_that_the_chip_cannot_count_to_are_refused_with_their_numbers() -> None:
    error = refusal(profile("0 10", "-5 10", "-900 12"))
    assert "the operation lies outside the stock: z = -900, diameter 12" in str(error)
