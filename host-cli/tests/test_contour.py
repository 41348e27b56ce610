# SPDX-License-Identifier: Apache-2.0
"""Geometry of lines and arcs, rounded corners, and the way onto the grid of whole steps."""

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from part_texts import HEAD, operation, profile

from tornillo.contour import (
    Arc,
    Element,
    Line,
    Point,
    arc_by_centre,
    arc_by_radius,
    arc_by_third,
    distance,
    intersections,
    monotone,
    smallest_radius,
    turn,
)
from tornillo.corners import chamfered, joined, rounded
from tornillo.grid import Grid, path_segments
from tornillo.image import Segment, SegmentKind, unpack_segments
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol import ContourRecord
from tornillo.rules_shape import arc_exists

LINE, CONVEX, CONCAVE = SegmentKind
STEPS = Grid(1.0, 1.0)


def test_an_arc_knows_its_way() -> None:
    arc = arc_by_radius(Point(0, 0), Point(-3, 3), 3)
    assert distance(arc.centre, Point(-3, 0)) < 1e-12
    assert arc.radius == pytest.approx(3)
    assert arc.sweep == pytest.approx(math.pi / 2)
    assert distance(arc.at(0.5), Point(-3 + 3 * math.sqrt(0.5), 3 * math.sqrt(0.5))) < 1e-12
    assert distance(arc.direction(arc.start), Point(0, 1)) < 1e-12
    assert distance(arc.normal(arc.end), Point(0, 1)) < 1e-12
    assert arc.along(arc.end) == pytest.approx(arc.length)
    assert arc.along(Point(0, -1)) < 0
    assert arc.height(-3) == pytest.approx(3)
    assert arc.height(-4) is None


def test_a_line_knows_its_way() -> None:
    line = Line(Point(0, 1), Point(-4, 4))
    assert line.length == 5
    assert line.direction(line.start) == Point(-0.8, 0.6)
    assert line.normal(line.start) == Point(0.6, 0.8)
    assert line.along(Point(-4, 4)) == pytest.approx(5)
    assert (line.height(-2), line.height(1), line.height(-5)) == (2.5, None, None)
    assert Line(Point(0, 3), Point(0, 1)).height(0) == 1


def test_arcs_through_a_centre_or_a_third_point_are_the_same_as_by_radius() -> None:
    start, end = Point(0, 2), Point(-4, 5)
    for radius in (4.0, -4.0):
        arc = arc_by_radius(start, end, radius)
        assert arc_by_centre(start, end, arc.centre).convex is (radius > 0)
        third = arc_by_third(start, end, arc.at(0.3))
        assert third.convex is (radius > 0)
        assert distance(third.centre, arc.centre) < 1e-9


def test_the_smallest_radius_is_the_first_that_does_not_run_back() -> None:
    start, end = Point(0, 2), Point(-4, 8)
    least = smallest_radius(start, end)
    for sign in (1, -1):
        assert monotone(arc_by_radius(start, end, sign * least))
        assert not monotone(arc_by_radius(start, end, sign * least * 0.99))
    assert math.isinf(smallest_radius(Point(0, 0), Point(0, 5)))


def test_lines_and_circles_meet_in_none_one_or_two_places() -> None:
    level, upright = Line(Point(0, 1), Point(-9, 1)), Line(Point(-2, 0), Point(-2, 5))
    circle = arc_by_radius(Point(0, 0), Point(-2, 2), 2)
    other = arc_by_radius(Point(-2, 0), Point(-4, 2), 2)
    assert intersections(level, upright) == [Point(-2, 1)]
    assert intersections(level, Line(Point(0, 2), Point(-9, 2))) == []
    assert len(intersections(level, circle)) == len(intersections(circle, level)) == 2
    assert intersections(Line(Point(0, 3), Point(-9, 3)), circle) == []
    assert len(intersections(circle, other)) == 2
    assert intersections(circle, replace(circle, convex=False)) == []
    far = Arc(Point(90, 0), Point(88, 2), Point(88, 0), convex=True)
    assert intersections(circle, far) == []
    for place in intersections(circle, other):
        assert distance(place, circle.centre) == pytest.approx(2)


def both_ways(before: Element, after: Element, radius: float) -> Arc:
    """The arc of a rounded corner, which touches both sides."""
    one, arc, two = rounded(before, after, radius)
    assert isinstance(arc, Arc)
    assert abs(turn(one, arc)) < 1e-6
    assert abs(turn(arc, two)) < 1e-6
    assert (one.start, two.end) == (before.start, after.end)
    return arc


def test_corners_between_lines_and_arcs_are_rounded_smoothly() -> None:
    corner = Point(-4, 4)
    ball = arc_by_radius(Point(0, 0), corner, 4)
    hollow = arc_by_radius(Point(0, 0), corner, -4)
    level, rise = Line(corner, Point(-9, 4)), Line(corner, Point(-5, 8))
    fall = Line(corner, Point(-9, 1))
    dip = arc_by_radius(corner, Point(-9, 4), -4)
    for before, after in (
        (ball, rise),
        (ball, fall),
        (hollow, level),
        (hollow, fall),
        (Line(Point(0, 4), corner), rise),
        (Line(Point(0, 2), corner), level),
        (ball, dip),
        (hollow, dip),
    ):
        arc = both_ways(before, after, 0.5)
        assert arc.convex is (turn(before, after) < 0)
        assert arc.radius == pytest.approx(0.5)


def test_a_chamfer_is_measured_along_both_sides() -> None:
    corner = Point(-4, 4)
    hollow = arc_by_radius(Point(0, 0), corner, -4)
    _, line, _ = chamfered(hollow, Line(corner, Point(-9, 4)), 0.5)
    assert distance(line.start, corner) == pytest.approx(0.5)
    assert line.end == Point(-4.5, 4)


@pytest.mark.parametrize("work", [rounded, chamfered])
def test_what_has_no_corner_or_no_room_is_refused(
    work: Callable[[Element, Element, float], list[Element]],
) -> None:
    one, two = Line(Point(0, 4), Point(-4, 4)), Line(Point(-4, 4), Point(-9, 4))
    with pytest.raises(ValueError, match="there is no corner"):
        work(one, two, 1.0)
    hollow = arc_by_radius(Point(-4, 4), Point(-5, 5), -1)
    with pytest.raises(ValueError, match=r"does not fit|longer"):
        work(Line(Point(0, 6), Point(-4, 4)), hollow, 3.0)


def test_straight_continuations_become_one_line() -> None:
    one = Line(Point(0, 4), Point(-4, 4))
    assert joined([one, Line(one.end, one.end), Line(one.end, Point(-9, 4))]) == [
        Line(Point(0, 4), Point(-9, 4))
    ]


def worst(arc: Arc, segments: tuple[Segment, ...], grid: Grid) -> float:
    """How far, in steps, the fitted segments are from the true curve, at most."""
    (z, x), found = grid.rounded(arc.start), 0.0
    pieces: list[Arc | Line] = []
    for s in segments:
        end = Point(z + s.dz, x + s.dx)
        if s.kind is LINE:
            pieces.append(Line(Point(z, x), end))
        else:
            centre = Point(z + s.cz / 256, x + s.cx / 256)
            assert arc_exists(s)
            pieces.append(Arc(Point(z, x), end, centre, s.kind is CONVEX))
        z, x = z + s.dz, x + s.dx
    for number in range(201):
        place = grid.place(arc.at(number / 200))
        near = []
        for piece in pieces:
            if isinstance(piece, Arc) and 0 <= piece.along(place) <= piece.length:
                near.append(abs(distance(place, piece.centre) - piece.radius))
            elif isinstance(piece, Line) and 0 <= piece.along(place) <= piece.length:
                near.append(abs(place.minus(piece.start).dot(piece.normal(piece.start))))
            near += [distance(place, piece.start), distance(place, piece.end)]
        found = max(found, min(near))
    return found


@given(
    st.floats(3, 3000),
    st.floats(0, 180),
    st.floats(1, 180),
    st.booleans(),
    st.floats(0, 1),
)
def test_an_arc_on_the_grid_stays_within_a_step_and_the_chip_accepts_it(
    radius: float, first: float, sweep: float, convex: bool, aside: float
) -> None:
    last = min(180.0, first + sweep)
    angles = (first, last) if convex else (-first, -last)
    centre = Point(aside, 4000 + 7 * aside)
    start, end = (
        Point(
            centre.z + radius * math.cos(math.radians(a)),
            centre.x + radius * math.sin(math.radians(a)),
        )
        for a in angles
    )
    arc = Arc(start, end, centre, convex)
    _, segments = path_segments([arc], STEPS)
    assume(segments)
    assert worst(arc, segments, STEPS) < 1.0
    assert abs(sum(s.dz for s in segments) - (end.z - start.z)) <= 1.0
    assert len(segments) <= 2 or start.z - end.z < 20


@given(st.floats(1, 9), st.floats(60, 800), st.floats(60, 800), st.booleans())
def test_steps_of_different_size_get_an_arc_in_pieces(
    radius: float, z: float, x: float, convex: bool
) -> None:
    ends = (Point(0, 2), Point(-radius, 2 + radius))
    arc = arc_by_radius(*ends, radius if convex else -radius)
    grid = Grid(z, x)
    _, segments = path_segments([arc], grid)
    assert worst(arc, segments, grid) < 1.3
    assert len(segments) <= 64


def test_very_flat_and_very_small_arcs_become_lines() -> None:
    flat = arc_by_radius(Point(0, 100), Point(-100, 100), 60_000)
    assert [s.kind for s in path_segments([flat], STEPS)[1]] == [LINE]
    small = arc_by_radius(Point(0, 100), Point(-1.2, 101), 1.5)
    assert [s.kind for s in path_segments([small], STEPS)[1]] == [LINE]
    wide = arc_by_radius(Point(0, 100), Point(-20_000, 100), 200_000)
    _, segments = path_segments([wide], STEPS)
    assert {s.kind for s in segments} == {LINE}
    assert worst(wide, segments, STEPS) < 1.0


def test_a_part_for_a_machine_with_different_screws_is_cut_to_size() -> None:
    machine = Machine("coarse", 3556, 7112, 7150, 16072, -7150, -8000, 1000, 100, 3800)
    text = HEAD + profile("0 0", "-5 10 radius = 5", "-9 18 radius = -4", "-12 18")
    text += operation("cylinder", 'z = [0, -2]\ndiameter = 2\nroughing = "facing"')
    part = Part.parse(text)
    part.check(machine)
    [contour] = [r for r in part.steps(machine).records if isinstance(r, ContourRecord)][:1]
    found = tuple(unpack_segments(contour.segments))
    assert (sum(s.dz for s in found), sum(s.dx for s in found)) == (-1687, 2531)
    assert len(found) > 4
