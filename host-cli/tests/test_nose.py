# SPDX-License-Identifier: Apache-2.0
"""Nose-radius compensation: the worked values of paper S3, corners, and what does not fit."""

import itertools
import math

import pytest

from tornillo.contour import Arc, Element, Line, Point, arc_by_radius, distance, intersections
from tornillo.corners import rounded
from tornillo.nose import NoseError, away, largest_nose, tip_path

R = 1 / 32
FINE = 1e-5
ANGLES = (15, 30, 45, 60, 75)
#: S3, section III.5.1 and table, r = 1/32 inch: (angle, dX, dZ rising, dZ falling).
TABLE = (
    (15, 0.00727, 0.02714, 0.03536),
    (30, 0.01321, 0.02288, 0.03962),
    (45, 0.01831, 0.01831, 0.04419),
    (60, 0.02288, 0.01321, 0.04929),
    (75, 0.02714, 0.00727, 0.05523),
)


def slanted(corner: Point, degrees: float, length: float) -> Point:
    """A place behind `corner` on a line that rises with this angle from the axis."""
    angle = math.radians(degrees)
    return Point(corner.z - length * math.cos(angle), corner.x + length * math.sin(angle))


def programmed(contour: list[Element]) -> Point:
    """Where the tip's paths along the first and the last piece of a corner meet."""
    path = tip_path(contour, R, FINE)
    places = intersections(path[0], path[-1])
    return min(places, key=lambda place: distance(place, contour[0].end))


def near(place: Point, z: float, diameter: float, digits: float = 2e-4) -> bool:
    """Whether a place is the one that the paper prints."""
    return abs(place.z - z) < digits and abs(2 * place.x - diameter) < digits


@pytest.mark.parametrize(("degrees", "dx", "dz_rising", "dz_falling"), TABLE)
def test_the_table_of_the_paper_comes_out(
    degrees: float, dx: float, dz_rising: float, dz_falling: float
) -> None:
    corner = Point(-2.0, 1.0)
    behind = slanted(corner, degrees, 1.0)
    front = Line(Point(-2.0, 0.2), corner)
    level = Line(corner, Point(-4.0, 1.0))
    rising = Line(slanted(corner, degrees, -0.5), corner)
    falling = Line(corner, slanted(corner, -degrees, 0.5))
    assert programmed([front, Line(corner, behind)]).x == pytest.approx(1 - dx, abs=1e-5)
    assert programmed([rising, level]).z == pytest.approx(-2 - dz_rising, abs=1e-5)
    before = Line(Point(-1.0, 1.0), corner)
    assert programmed([before, falling]).z == pytest.approx(-2 - dz_falling, abs=1e-5)


def test_the_programs_of_the_paper_come_out() -> None:
    end = Point(-12.4375, 1.0)
    rising = Line(slanted(end, 30, -0.5), end)
    assert near(programmed([rising, Line(end, Point(-14, 1.0))]), -12.4604, 2.0)
    start = Point(-7.1875, 1.0)
    falling = Line(start, slanted(start, -30, 0.5))
    assert near(programmed([Line(Point(-6, 1.0), start), falling]), -7.2271, 2.0)


def test_the_chamfers_of_the_paper_come_out() -> None:
    radius, face, leg = 3.234 / 2, -6.4375, 1 / 64
    low, high = Point(face, radius - leg), Point(face - leg, radius)
    front, chamfer = Line(Point(face, 1.0), low), Line(low, high)
    assert near(programmed([front, chamfer]), face, 3.1662)
    assert near(programmed([chamfer, Line(high, Point(-8, radius))]), -6.4714, 3.234)
    corner = Point(-0.125, 2.761 / 2)
    at_face = Point(0.0, corner.x - 0.125 * math.tan(math.radians(30)))
    bevel = Line(at_face, corner)
    meeting = programmed([Line(Point(0.0, 0.5), at_face), bevel])
    assert near(meeting, 0.0, 2.5902)
    way = corner.minus(at_face).unit
    assert near(meeting.plus(way, -0.010 / math.cos(math.radians(30))), 0.010, 2.5788)


def test_a_quarter_of_a_circle_comes_out_as_in_the_paper() -> None:
    arc = arc_by_radius(Point(0.0, 2.0), Point(-0.5, 2.5), 0.5)
    [path] = tip_path([arc], R, FINE)
    assert isinstance(path, Arc)
    assert near(path.start, 0.0, 3.9375, 1e-9)
    assert near(path.end, -0.53125, 5.0, 1e-9)
    assert path.radius == pytest.approx(0.53125)
    hollow = arc_by_radius(Point(-0.5, 2.0), Point(-1.0, 2.5), -0.5)
    [path] = tip_path([hollow], R, FINE)
    assert isinstance(path, Arc)
    assert path.radius == pytest.approx(0.5 - R)


def test_the_hemisphere_of_example_4_comes_out() -> None:
    ball = arc_by_radius(Point(0.0, 0.0), Point(-2.375, 2.375), 2.375)
    [path] = tip_path([ball], R, FINE)
    assert isinstance(path, Arc)
    assert near(path.start, 0.0, -0.0625, 1e-9)
    assert near(path.end, -2.40625, 4.75, 1e-9)
    assert path.centre.z - path.start.z == pytest.approx(-2.40625)


def arc_of(contour: list[Element]) -> Arc:
    """The arc in the middle of a path around a rounded corner."""
    path = tip_path(contour, R, FINE)
    [arc] = [element for element in path if isinstance(element, Arc)]
    return arc


def test_the_oracle_of_case_2_comes_out() -> None:
    corner = Point(-0.125, 2.761 / 2)
    line = Line(slanted(corner, 30, -0.2), corner)
    arc = arc_of(rounded(line, Line(corner, Point(-1.0, corner.x)), 1 / 64))
    assert near(arc.start, -0.1370, 2.7484)
    assert near(arc.end, -0.1604, 2.761)
    assert arc.centre.x - arc.start.x == pytest.approx(-0.0406, abs=2e-4)
    assert arc.centre.z - arc.start.z == pytest.approx(-0.0234, abs=2e-4)


@pytest.mark.parametrize("degrees", ANGLES)
@pytest.mark.parametrize("radius", [1 / 16, 1 / 8, 1 / 4])
def test_the_four_cases_of_a_rounded_corner_come_out(degrees: float, radius: float) -> None:
    a = math.radians(degrees)
    x, z = 2.0, -3.0
    corner = Point(z, x)
    tan = radius * math.tan(a / 2)
    behind = slanted(corner, degrees, 2.0)
    steep = slanted(corner, 90 - degrees, 2.0)
    face = Line(Point(z, 0.5), corner)
    level = Line(Point(-1.0, x), corner)
    # Case I: face, convex arc, line at `a` from the face.
    arc = arc_of(rounded(face, Line(corner, steep), radius))
    rise = radius * math.sin(a) - tan
    assert near(arc.start, z, 2 * (x - tan - R), 1e-9)
    back = radius - radius * math.cos(a) + R - R * math.cos(a)
    assert near(arc.end, z - back, 2 * (x + rise - (R - R * math.sin(a))), 1e-9)
    # Case III: cylinder, concave arc, line at `a` from the axis.
    arc = arc_of(rounded(level, Line(corner, behind), radius))
    assert near(arc.start, z + tan - R, 2 * x, 1e-9)
    up = radius - radius * math.cos(a) - (R - R * math.cos(a))
    assert near(
        arc.end, z - (radius * math.sin(a) - tan) - (R - R * math.sin(a)), 2 * (x + up), 1e-9
    )
    # Case IV: line at `a` from the face, concave arc, face.
    sloping = Line(slanted(corner, 90 - degrees, -2.0), corner)
    arc = arc_of(rounded(sloping, Line(corner, Point(z, 5.0)), radius))
    low = radius * math.sin(a) - tan + R - R * math.sin(a)
    front = radius - radius * math.cos(a) - (R - R * math.cos(a))
    assert near(arc.start, z + front, 2 * (x - low), 1e-9)
    assert near(arc.end, z, 2 * (x + tan - R), 1e-9)


def lines(*places: tuple[float, float]) -> list[Element]:
    """Lines through places."""
    points = [Point(*place) for place in places]
    return [Line(a, b, n + 1) for n, (a, b) in enumerate(itertools.pairwise(points))]


def test_a_tool_without_a_nose_follows_the_contour() -> None:
    contour = lines((0, 1), (-2, 3))
    assert tip_path(contour, 0.0, FINE) == contour


def test_the_nose_rolls_round_outside_corners_and_meets_in_inside_ones() -> None:
    path = tip_path(lines((0, 1), (-1, 3), (-4, 3)), 0.4, FINE)
    assert [type(element) for element in path] == [Line, Arc, Line]
    roll = path[1]
    assert isinstance(roll, Arc)
    assert roll.convex
    assert roll.radius == pytest.approx(0.4)
    path = tip_path(lines((0, 1), (-2, 1), (-4, 3)), 0.4, FINE)
    assert [type(element) for element in path] == [Line, Line]
    assert path[0].end == path[1].start
    assert path[0].end.z == pytest.approx(-2 - 0.4 * (1 - math.tan(math.radians(22.5))))


def test_the_tip_itself_turns_a_square_outside_corner() -> None:
    path = tip_path(lines((0, 1), (0, 3), (-4, 3)), 0.4, FINE)
    assert [element.end for element in path] == [Point(0, 3), Point(-4.4, 3)]


def test_a_square_shoulder_keeps_its_place_and_gets_the_nose_as_its_root() -> None:
    path = tip_path(lines((0, 1), (-3, 1), (-3, 2)), 0.4, FINE)
    assert near(path[0].end, -3, 2, 1e-12)


def test_smooth_joints_stay_smooth() -> None:
    arc = arc_by_radius(Point(0.0, 0.0), Point(-2.0, 2.0), 2.0)
    path = tip_path([arc, Line(arc.end, Point(-5.0, 2.0))], 0.4, FINE)
    assert len(path) == 2
    assert path[0].end == path[1].start


@pytest.mark.parametrize(
    ("contour", "place", "fits"),
    [
        ([arc_by_radius(Point(0, 2), Point(-0.3, 2.3), -0.3)], 0, 0.3),
        (lines((0, 2), (-1, 1), (-1.1, 1), (-2, 2)), 2, None),
        (lines((0, 1), (-3, 1), (-3, 1.2), (-6, 1.2)), 2, 0.2),
        (lines((0, 2), (-0.5, 1.9), (-1, 2.4)), 0, None),
        (lines((0, 1), (-0.1, 1), (-0.1, 5)), 0, None),
    ],
)
def test_what_the_nose_does_not_reach_is_refused_with_the_largest_that_does(
    contour: list[Element], place: int, fits: float | None
) -> None:
    big = 3.0 if fits is None else 0.4
    with pytest.raises(NoseError) as caught:
        tip_path(contour, big, FINE)
    if place:
        assert caught.value.place == place
    best = largest_nose(contour, big, FINE, None, None)
    assert 0 < best < big
    if fits is not None:
        assert best == pytest.approx(fits, abs=1e-4)
    tip_path(contour, best * 0.999, FINE)


def test_neighbours_are_touched_and_not_cut() -> None:
    cone = lines((-5, 3), (-10, 5))
    before, after = Line(Point(0, 3), Point(-5, 3)), Line(Point(-10, 5), Point(-10, 9))
    path = tip_path(cone, 0.4, FINE, before, after)
    centres = [(path[0].start.z + 0.4, path[0].start.x + 0.4)]
    assert centres[0][1] == pytest.approx(3.4)
    assert path[-1].end.z == pytest.approx(-10)
    for element in (before, cone[0], after):
        assert away(element, Point(path[-1].end.z + 0.4, path[-1].end.x + 0.4)) > 0.4 - 1e-9


def test_a_nose_in_the_next_pocket_is_seen() -> None:
    narrow = lines((0, 3), (-1, 2.8), (-1.05, 2.85), (-1.1, 2.8), (-3, 3.5))
    with pytest.raises(NoseError):
        tip_path(narrow, 2.0, FINE)
