# SPDX-License-Identifier: Apache-2.0
"""The part image as bytes, and the rules that chip and host apply to it."""

import struct
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st
from images import (
    BAR,
    CONCAVE,
    CONVEX,
    CUT,
    FACE,
    GOOD,
    GROOVE,
    HEADER,
    MACHINE,
    PARTING,
    PAUSE,
    SHORT_X,
    SHORT_Z,
    TOOL,
    arc,
    contour,
    cut,
    header,
    image,
    line,
)
from random_parts import damaged, random_part
from refusal_cases import CASES

from tornillo.image import ImageError, PartImage, Segment, pack_segments, unpack_segments
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol import IMAGE_HEADER, Refusal
from tornillo.rules import Violation, check, verdict
from tornillo.units import Scale

FREE = TOOL._replace(back=65535)


def test_the_good_image_is_accepted_and_has_the_documented_size() -> None:
    data = GOOD.pack()
    assert len(data) == GOOD.size == 32 + 30 + 16 + 13 + 13
    assert verdict(data, MACHINE) is None
    assert PartImage.unpack(data) == GOOD
    assert (GOOD.name, GOOD.inch, len(GOOD.operations)) == ("pin", False, 2)


def test_every_rule_has_ten_cases_or_more() -> None:
    assert {rule for rule, cases in CASES.items() if len(cases) >= 10} == set(Refusal)


@pytest.mark.parametrize(
    ("refusal", "number"),
    [(rule, number) for rule, cases in CASES.items() for number in range(len(cases))],
)
def test_a_broken_rule_is_answered_with_reason_and_operation(refusal: Refusal, number: int) -> None:
    data, operation = CASES[refusal][number]
    found = verdict(data, MACHINE)
    assert found is not None
    assert (found.refusal, found.operation) == (refusal, operation)


@pytest.mark.parametrize(
    "data",
    [
        header(name=b"0123456789abcde-"),
        header(flags=1),
        header(stock_radius=3535),
        header(stock_front=7920),
        header(retract=1),
        image(TOOL, CUT._replace(depth_of_cut=1000, finish_allowance=1000), FACE),
        image(TOOL, CUT._replace(feed=32, finish_feed=8000), FACE),
        image(TOOL, CUT._replace(kind=9, spindle=3800, peck=65535), FACE),
        image(TOOL._replace(kind=15, offset_x=2535, offset_z=7820), CUT, FACE),
        cut(contour(99, 999, line(0, 1), kind=0x80)),
        cut(contour(-4960, 0, line(0, 1000), kind=0x80)),
        cut(contour(140, 600, line(-5100, 0))),
        cut(contour(100, -57, line(-9, 0)), tool=TOOL._replace(offset_x=57)),
        cut(contour(100, 600, line(-100, -100), line(-100, 400))),
        cut(contour(100, 0, arc(CONVEX, -500, 500, -500, 0))),
        cut(contour(100, 0, arc(CONVEX, -900, 0, -450, 0)), tool=FREE),
        cut(contour(100, 900, arc(CONCAVE, -900, 0, -450, 0)), tool=FREE),
        cut(contour(100, 0, arc(CONCAVE, -500, 500, 0, 500))),
        cut(contour(100, 990, arc(CONVEX, -80, 0, -40, -3000))),
        cut(contour(0, 600, line(-9, 0)), tool=FREE),
        cut(contour(0, 600, line(-9, 0), kind=0x81)),
        cut(contour(100, 700, line(-150, 0)), contour(-50, 700, line(-40, 0))),
        cut(contour(0, 300, line(0, 700), kind=0x80), contour(0, 300, line(-90, 0))),
        cut(GROOVE, GROOVE._replace(kind=1, z_high=-1000, z_low=-1000, x=0), tool=PARTING),
        image(TOOL, CUT, FACE, PARTING, GROOVE, TOOL, contour(-600, 400, line(-9, 0))),
        image(TOOL, CUT, PAUSE, FACE, PAUSE._replace(kind=1, message=b""), CUT, BAR),
        image(TOOL, CUT, *[contour(100, 700, line(-150, 0))] * 64),
    ],
)
def test_a_part_at_the_edge_of_a_rule_is_accepted(data: bytes) -> None:
    assert verdict(data, MACHINE) is None


@pytest.mark.parametrize("machine", [SHORT_X, SHORT_Z])
def test_places_behind_the_travel_are_refused_for_each_axis(machine: Machine) -> None:
    for shape in (
        contour(100, 0, line(-300, 0)),
        contour(100, 0, arc(CONVEX, -500, 500, -500, 0)),
        contour(100, 0, line(0, 30), line(-300, 0)),
    ):
        found = verdict(cut(shape), machine)
        assert found is not None
        assert (found.refusal, found.operation) == (Refusal.OUTSIDE_TRAVEL, 1)


def test_a_machine_that_does_not_tell_its_spindle_speeds_takes_them_all() -> None:
    machine = Machine("silent", 7112, 7112, 3575, 16072, -3575, -8000, 1000)
    data = image(TOOL, CUT._replace(spindle=9999), FACE)
    assert verdict(data, machine) is None
    assert verdict(data, MACHINE) is not None


def test_an_arc_may_miss_its_end_by_a_step_and_no_more() -> None:
    for off, fits in ((0, True), (-1, True), (1, False), (3, False), (-3, False)):
        data = cut(contour(100, 0, arc(CONVEX, -500, 500 + off, -500, 0)))
        assert (verdict(data, MACHINE) is None) is fits


def test_checking_tells_every_broken_rule_and_stops_at_senseless_stock() -> None:
    bad = PartImage(
        HEADER._replace(retract=0, name=b"X".ljust(16, b"\0")),
        (TOOL, CUT._replace(feed=0, spindle=5), FACE, contour(0, 1500, line(-9, 0))),
    )
    found = [violation.refusal for violation in check(bad, Scale("mm", MACHINE))]
    assert found == [
        Refusal.NAME,
        Refusal.RETRACT,
        Refusal.FEED,
        Refusal.SPINDLE,
        Refusal.OUTSIDE_STOCK,
    ]
    senseless = PartImage(HEADER._replace(stock_radius=0), bad.records)
    assert [v.refusal for v in check(senseless, Scale("mm", MACHINE))] == [Refusal.STOCK]


def test_a_part_that_is_too_long_is_told_with_its_size() -> None:
    long = PartImage(HEADER, (TOOL, CUT, FACE, contour(100, 600, *[line(-1, 0)] * 500)))
    first = next(check(long, Scale("mm", MACHINE)))
    assert (first.refusal, first.detail) == (Refusal.LENGTH, "2599 bytes, at most 2496")


def describe(violation: Violation | None) -> object:
    """The part of a violation that the chip answers."""
    return violation and (violation.refusal, violation.operation)


@pytest.mark.parametrize("seed", range(60))
def test_random_parts_are_judged_alike_as_steps_and_as_bytes(seed: int, machine: Machine) -> None:
    data = Part.parse(random_part(seed)).image(machine)
    assert verdict(data, machine) is None
    assert PartImage.unpack(data).pack() == data


@pytest.mark.parametrize("seed", range(300))
def test_damaged_parts_get_the_same_verdict_as_steps_and_as_bytes(
    seed: int, machine: Machine
) -> None:
    data = damaged(Part.parse(random_part(seed % 20)).image(machine), seed)
    found = verdict(data, machine)
    try:
        steps = PartImage.unpack(data)
    except ImageError:
        assert found is not None
        return
    if found is None or found.refusal not in (Refusal.ORDER, Refusal.OPERATION_COUNT):
        assert describe(next(check(steps, Scale("mm", machine)), None)) == describe(found)


def test_damage_is_often_refused_and_sometimes_harmless(machine: Machine) -> None:
    data = Part.parse(random_part(3)).image(machine)
    refused = sum(verdict(damaged(data, seed), machine) is not None for seed in range(200))
    assert 100 < refused < 200


@given(st.binary(max_size=300))
def test_any_bytes_get_a_verdict(data: bytes) -> None:
    assert verdict(data, MACHINE) is not None


@given(st.integers(0, len(GOOD.pack()) * 8 - 1))
def test_an_image_with_a_flipped_bit_survives_if_accepted(bit: int) -> None:
    data = bytearray(GOOD.pack())
    data[bit // 8] ^= 1 << bit % 8
    if verdict(bytes(data), MACHINE) is None:
        assert PartImage.unpack(bytes(data)).pack() == bytes(data)


@pytest.mark.parametrize(
    ("unpack", "refusal"),
    [
        (lambda: PartImage.unpack(b"short"), "LENGTH at operation 0"),
        (lambda: PartImage.unpack(GOOD.pack() + b"x"), "LENGTH at operation 3"),
        (lambda: PartImage.unpack(header(operation_count=9)), "OPERATION_COUNT at operation 0"),
    ],
)
def test_unpacking_bytes_that_are_no_image_is_refused(
    unpack: Callable[[], PartImage], refusal: str
) -> None:
    with pytest.raises(ImageError, match=refusal):
        unpack()


@given(
    st.lists(
        st.builds(
            Segment,
            st.sampled_from([CONVEX, CONCAVE]),
            st.integers(-32768, 32767),
            st.integers(-32768, 32767),
            st.integers(-(2**23), 2**23 - 1),
            st.integers(-(2**23), 2**23 - 1),
        )
        | st.builds(line, st.integers(-32768, 32767), st.integers(-32768, 32767)),
        max_size=5,
    )
)
def test_segments_survive_their_bytes(segments: list[Segment]) -> None:
    assert list(unpack_segments(pack_segments(tuple(segments)))) == segments


def test_numbers_that_do_not_fit_their_field_cannot_be_packed() -> None:
    with pytest.raises(struct.error):
        PartImage(HEADER._replace(retract=70_000), ()).pack()
    assert IMAGE_HEADER.size == 32
