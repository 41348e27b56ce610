# SPDX-License-Identifier: Apache-2.0
"""Random parts as a whole: no nose cuts into the finished part, and downloads are the same."""

import math
from dataclasses import replace

import pytest
from part_texts import HEAD, TOOLS, operation, profile
from random_parts import random_part

from tornillo.contour import Arc, Element, Line, Point
from tornillo.errors import PartError
from tornillo.finished import FinishedPart
from tornillo.image import CENTRE_UNIT, PartImage, SegmentKind, unpack_segments
from tornillo.machine import Machine
from tornillo.nose import away
from tornillo.operations import Contour
from tornillo.part import Part
from tornillo.part_writer import part_text
from tornillo.protocol import ContourRecord
from tornillo.units import NM_PER_UNIT

ROUNDING = 1.25  # steps: two ends, each rounded in X and Z
SPACING = 12.0
COARSE = Machine("coarse", 5000, 7112, 6000, 16072, -6000, -8000, 1000, 100, 3800)


def in_pieces(record: ContourRecord) -> list[Element]:
    """A contour of an image as lines and arcs in steps."""
    at, found = Point(record.z, record.x), list[Element]()
    for s in unpack_segments(record.segments):
        end = Point(at.z + s.dz, at.x + s.dx)
        if s.kind is SegmentKind.LINE:
            found.append(Line(at, end))
        else:
            centre = Point(at.z + s.cz / CENTRE_UNIT, at.x + s.cx / CENTRE_UNIT)
            found.append(Arc(at, end, centre, s.kind is SegmentKind.CONVEX))
        at = end
    return found


def places(element: Element, step: float) -> list[Point]:
    """Some places of a contour in file units, about SPACING steps apart."""
    count = max(2, int(element.length / step / SPACING))
    if isinstance(element, Arc):
        return [element.at(number / count) for number in range(count + 1)]
    way = element.end.minus(element.start)
    return [element.start.plus(way, number / count) for number in range(count + 1)]


def finished_places(part: Part, step: float) -> list[Point]:
    """Places on the surface of the finished part, in steps."""
    finished = FinishedPart(part.ordered, part.stock.diameter / 2, part.stock.allowance)
    nobody = replace(part.ordered[0], position=-1)
    found = []
    for operation_ in part.ordered:
        if not isinstance(operation_.shape, Contour):
            continue
        for element in operation_.shape.elements:
            for place in places(element, step):
                beside = (finished.height(place.z + aside, nobody) for aside in (-2e-4, 2e-4))
                if place.x > 0 and max(beside) >= place.x - step / 8:
                    found.append(Point(place.z / step, place.x / step))
    return found


@pytest.mark.parametrize("seed", range(40))
def test_the_nose_of_no_tool_cuts_into_the_finished_part(seed: int, machine: Machine) -> None:
    part = Part.parse(random_part(seed))
    step = machine.step_z_nm / NM_PER_UNIT[part.units]
    surface = finished_places(part, step)
    compiled = part.compiled(machine)
    for record, origin in zip(compiled.image.records, compiled.origins, strict=True):
        if not isinstance(record, ContourRecord):
            continue
        nose = origin.operation.tool.nose_radius / step
        for element in in_pieces(record):
            centre = element.shifted(Point(nose, nose))
            low, high = centre.end.z - nose - 1, centre.start.z + nose + 1
            for place in surface:
                if low <= place.z <= high and place.x <= max(centre.start.x, centre.end.x) + nose:
                    below = isinstance(element, Line) or away(centre, place) < nose
                    assert not below or away(centre, place) > nose - ROUNDING


@pytest.mark.parametrize("machine", [Machine.load(), COARSE], ids=["equal", "different"])
@pytest.mark.parametrize("seed", range(40))
def test_a_part_that_was_read_back_has_the_same_image(seed: int, machine: Machine) -> None:
    part = Part.parse(random_part(seed))
    try:
        data = part.image(machine)
    except PartError:
        assert machine is COARSE
        return
    text = part_text(PartImage.unpack(data), machine)
    assert 'path = "tip"' in text
    assert Part.parse(text).image(machine) == data


def test_everything_that_a_part_can_have_comes_back(machine: Machine) -> None:
    head = HEAD.replace("length = 40.0", "length = 40.0\nallowance = 0.5")
    pointed = TOOLS.replace("width = 2.0", "width = 2.0\noffset = { z = 0.25, diameter = 0.5 }")
    text = (
        head
        + pointed
        + operation("face", 'z = 0\ntool = "round"')
        + operation("pause", 'message = "say \\"ah\\" \\\\ now"')
        + operation("cone", "start = {z=0,diameter=8}\nend = {z=-5,diameter=12}\nfeed = 50")
        + operation("arc", "start = {z=-5,diameter=12}\nend = {z=-9,diameter=14}\nradius = 9")
        + operation("drill", "diameter = 3\ndepth = 4")
        + profile("0 6", "-1 6", "-2 7", more='tool = "left"\nroughing = "along"\npeck = 0.2\n')
        + operation("groove", 'z = [-10, -14]\ndiameter = 9\ntool = "parting"\nspindle = 500')
        + operation("part-off", 'z = -20\ntool = "parting"\npeck = 0.3')
    )
    data = Part.parse(text).image(machine)
    back = part_text(PartImage.unpack(data), machine)
    assert Part.parse(back).image(machine) == data
    for kept in ('tool = "round"', "peck = 0.3", "spindle = 500", 'type = "cone"\nstart', "center"):
        assert kept in back
    assert 'message = "say \\"ah\\" \\\\ now"' in back


def test_two_cones_of_a_round_tool_meet_in_their_corner(machine: Machine) -> None:
    both = profile("0 6", "-5 10", "-9 18", more='tool = "round"\nroughing = "along"\n')
    apart = operation(
        "cone", 'start={z=0,diameter=6}\nend={z=-5,diameter=10}\ntool="round"\nroughing = "along"'
    ) + operation("cone", 'start={z=-5,diameter=10}\nend={z=-9,diameter=18}\ntool = "round"')
    whole = Part.parse(HEAD + TOOLS + both).steps(machine).records[-1]
    one, two = (
        record
        for record in Part.parse(HEAD + TOOLS + apart).steps(machine).records
        if isinstance(record, ContourRecord)
    )
    assert isinstance(whole, ContourRecord)
    meeting = in_pieces(one)[-1].end
    assert meeting in [element.end for element in in_pieces(whole)]
    assert meeting in [element.start for element in in_pieces(two)]


def test_a_shoulder_keeps_its_place_whatever_the_nose(machine: Machine) -> None:
    for tool in ("turning", "round"):
        text = operation("cylinder", f'z = [0, -5]\ndiameter = 6\ntool = "{tool}"')
        record = Part.parse(HEAD + TOOLS + text).steps(machine).records[-1]
        assert isinstance(record, ContourRecord)
        [line] = in_pieces(record)
        assert (line.start, line.end) == (Point(0, 422), Point(-703, 422))


def test_lengths_are_right_to_the_last_step() -> None:
    assert math.isclose(7112 / NM_PER_UNIT["inch"], 0.00028)
