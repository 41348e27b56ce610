# SPDX-License-Identifier: Apache-2.0
"""Where contours pass a height, and what stands on the bar after some of them are cut."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tornillo.image import Segment, SegmentKind, pack_segments
from tornillo.material import (
    FAR,
    NOWHERE,
    Chain,
    Material,
    Stretch,
    chain_of,
    contour_chain,
    cross,
    interval,
    pieces,
    plunge_chain,
)
from tornillo.protocol import ContourRecord, PlungeRecord

LINE, CONVEX, CONCAVE = SegmentKind


def line(dz: int, dx: int) -> Segment:
    """A line."""
    return Segment(LINE, dz, dx)


def arc(kind: SegmentKind, dz: int, dx: int, cz: int, cx: int) -> Segment:
    """An arc with its centre (cz, cx) steps from its start."""
    return Segment(kind, dz, dx, cz * 256, cx * 256)


BALL = chain_of(100, 0, [arc(CONVEX, -200, 0, -100, 0)])
NECK = chain_of(0, 300, [line(-100, -200), line(-50, 0), line(-100, 200), line(-100, 0)])
FACE = chain_of(0, 0, [line(0, 500)], facing=True)
BAR = chain_of(0, 200, [line(-400, 0)])


def test_an_arc_over_its_top_is_two_pieces_and_others_are_one() -> None:
    assert [(sub.zs, sub.xs, sub.ze, sub.xe) for sub in BALL.subs] == [
        (100, 0, 0, 101),
        (0, 101, -100, 0),
    ]
    assert len(pieces(100, 0, arc(CONVEX, -100, 100, -100, 0))) == 1
    assert len(pieces(0, 0, line(-7, 3))) == 1
    dip = pieces(50, 100, arc(CONCAVE, -100, 0, -50, 0))
    assert [(sub.ze, sub.xe) for sub in dip] == [(0, 50), (-50, 100)]


@pytest.mark.parametrize(
    ("cz", "apex_z"), [(-128, 0), (-129, -1), (-383, -1), (-384, -1), (-385, -2)]
)
def test_the_centre_is_rounded_to_the_nearest_step(cz: int, apex_z: int) -> None:
    subs = pieces(0, 0, Segment(CONVEX, -10, 0, cz, -100 * 256))
    assert subs[0].zc == apex_z
    assert len(subs) == (2 if apex_z < 0 else 1)


def test_a_chain_knows_its_ends_and_extremes() -> None:
    assert (NECK.z_end, NECK.x_end, NECK.lowest, NECK.highest) == (-350, 300, 100, 300)
    assert (BALL.z_end, BALL.x_end, BALL.lowest, BALL.highest) == (-100, 0, 0, 101)
    empty = Chain(False, 3, 4, ())
    assert (empty.z_end, empty.x_end, empty.lowest, empty.highest) == (3, 4, 4, 4)


@pytest.mark.parametrize(
    ("segments", "simple"),
    [
        ([line(-10, 0)], True),
        ([line(0, 10)], True),
        ([line(-10, 1)], False),
        ([line(-10, 0), line(-10, 0)], False),
        ([arc(CONVEX, -10, 0, -5, -20)], False),
    ],
)
def test_one_horizontal_or_vertical_line_is_simple(segments: list[Segment], simple: bool) -> None:
    assert chain_of(0, 50, segments).simple is simple


def test_the_crossing_of_a_line_lies_on_the_low_side() -> None:
    [fall] = pieces(0, 300, line(-100, -200))
    [rise] = pieces(0, 100, line(-100, 200))
    assert cross(fall, 201) == -50
    assert cross(fall, 200) == -50
    assert cross(fall, 299) == -1
    assert cross(rise, 200) == -50
    assert cross(rise, 201) == -50
    assert cross(rise, 299) == -99
    [wall] = pieces(7, 0, line(0, 30))
    assert cross(wall, 12) == 7


@given(
    st.integers(0, 500),
    st.integers(0, 500),
    st.integers(0, 500),
    st.integers(0, 500),
)
def test_a_line_is_never_above_the_height_on_the_low_side(
    xs: int, xe: int, run: int, v: int
) -> None:
    if (xs <= v) == (xe <= v):
        return
    [sub] = pieces(0, xs, line(-run, xe - xs))
    z = cross(sub, v)
    assert -run <= z <= 0
    height = xs + (xe - xs) * -z / run if run else min(xs, xe)
    assert height <= v + 1e-9


@given(st.integers(5, 3000), st.integers(-3000, 3000), st.booleans(), st.booleans())
def test_an_arc_is_never_above_the_height_on_the_low_side(
    radius: int, v: int, front: bool, convex: bool
) -> None:
    kind = CONVEX if convex else CONCAVE
    flat = radius if convex else -radius
    start, end = ((radius, 0), (0, flat)) if front else ((0, flat), (-radius, 0))
    sub = pieces(
        start[0],
        start[1],
        arc(kind, end[0] - start[0], end[1] - start[1], -start[0], -start[1]),
    )[0]
    if (sub.xs <= v) == (sub.xe <= v):
        return
    z = cross(sub, v)
    height = math.sqrt(max(0, radius**2 - z**2)) * (1 if convex else -1)
    assert height <= v + 1e-9
    beside = z + (1 if (sub.xs > sub.xe) else -1) * 4
    if sub.ze <= beside <= sub.zs:
        at = math.sqrt(max(0, radius**2 - beside**2)) * (1 if convex else -1)
        assert at > v - 2


@pytest.mark.parametrize(
    ("chain", "v", "z_from", "found"),
    [
        (NECK, 99, 0, None),
        (NECK, 100, 0, Stretch(-100, -150, False)),
        (NECK, 200, 0, Stretch(-50, -200, False)),
        (NECK, 200, -100, Stretch(-100, -200, True)),
        (NECK, 200, -50, Stretch(-50, -200, True)),
        (NECK, 200, -49, Stretch(-50, -200, False)),
        (NECK, 200, -200, None),
        (NECK, 300, 0, Stretch(0, -350, True)),
        (NECK, 300, 5, Stretch(0, -350, False)),
        (FACE, 300, 40, Stretch(40, 0, True)),
        (FACE, 300, FAR, Stretch(FAR, 0, True)),
        (FACE, 500, 40, Stretch(40, 0, True)),
        (FACE, -1, 40, None),
        (FACE, 300, 0, None),
        (BAR, 200, 0, Stretch(0, -400, True)),
        (BAR, 199, 0, None),
        (BALL, 50, 100, Stretch(100, 89, True)),
        (BALL, 50, 80, Stretch(-89, -100, False)),
    ],
)
def test_the_first_low_stretch_behind_a_place_is_found(
    chain: Chain, v: int, z_from: int, found: Stretch | None
) -> None:
    assert interval(chain, v, z_from) == found


def test_a_record_becomes_the_same_chain() -> None:
    segments = (line(-100, -200), arc(CONVEX, -50, 50, -50, 0))
    record = ContourRecord(4, 0, 300, pack_segments(segments))
    assert contour_chain(record) == chain_of(0, 300, segments)
    assert contour_chain(record._replace(kind=0x84)).facing
    groove = plunge_chain(PlungeRecord(0, -100, -150, 80), 60)
    assert (groove.z, groove.z_end, groove.x, groove.simple) == (-40, -150, 80, True)
    with pytest.raises(ValueError, match="cut off"):
        contour_chain(record._replace(segments=b"\1"))


def test_raw_stock_stands_everywhere() -> None:
    raw = Material(500, 20)
    assert raw.free_end(499, 900) == 20
    assert raw.free_end(499, -5) == -5
    assert raw.free_end(500, 900) == NOWHERE
    assert raw.highest(20, -100) == 500


def test_every_cut_frees_the_way_to_the_next_material() -> None:
    bar = Material(500, 20)
    bar.cut(FACE)
    assert bar.free_end(100, 20) == 0
    bar.cut(BAR)
    assert bar.free_end(200, 20) == -400
    assert bar.free_end(199, 20) == 0
    bar.cut(chain_of(-300, 150, [line(-300, 0)]))
    assert bar.free_end(200, 20) == -600
    assert bar.free_end(150, -300) == -600
    assert bar.free_end(150, 20) == 0
    assert (bar.highest(20, -100), bar.highest(-350, -400), bar.highest(-1, -601)) == (
        200,
        150,
        500,
    )


def test_the_order_of_cuts_that_meet_does_not_matter() -> None:
    bar = Material(500, 0)
    bar.cut(chain_of(-200, 100, [line(-200, 0)]))
    bar.cut(chain_of(0, 100, [line(-200, 0)]))
    assert bar.free_end(100, 0) == -400


def test_nothing_is_higher_than_what_the_tool_may_reach_below_the_axis() -> None:
    bar = Material(500, 0)
    bar.cut(chain_of(0, -30, [line(-100, 0)]))
    assert bar.highest(0, -100) == 0
    assert bar.highest(0, -100, below=30) == -30
