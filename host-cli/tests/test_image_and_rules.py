# SPDX-License-Identifier: Apache-2.0
"""The part image as bytes, and the rules that chip and host apply to it."""

import struct
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tornillo.image import ImageError, Operation, PartImage
from tornillo.machine import Machine
from tornillo.protocol import (
    IMAGE_HEADER,
    POSITION_MAX,
    CylinderRecord,
    FaceRecord,
    ImageHeader,
    Refusal,
)
from tornillo.rules import Violation, check, verdict
from tornillo.units import Scale

MACHINE = Machine("test", 7112, 7112, 3575, 16072, -3575, -8000, 1000)
HEADER = ImageHeader(
    format=1,
    operation_count=2,
    flags=0,
    reserved=0,
    name=b"pin".ljust(16, b"\0"),
    step_x_nm=7112,
    step_z_nm=7112,
    stock_radius=1000,
    stock_length=5000,
    stock_front=100,
    depth_of_cut=100,
    finish_allowance=10,
    feed=100_000,
    finish_feed=50_000,
    retract=40,
    reserved_end=0,
)
GOOD = PartImage(HEADER, (FaceRecord(0, 0), CylinderRecord(0, -2000, 600)))
i32 = st.integers(-(2**31), 2**31 - 1)
near = st.integers(-6000, 1200)
operations = st.one_of(
    st.builds(FaceRecord, near | i32, near | i32),
    st.builds(CylinderRecord, near | i32, near | i32, near | i32),
)


def with_header(**changes: Any) -> bytes:
    """GOOD with another header."""
    return PartImage(HEADER._replace(**changes), GOOD.operations).pack()


def with_operations(*wanted: Operation) -> bytes:
    """GOOD with other operations."""
    return PartImage(HEADER._replace(operation_count=len(wanted)), wanted).pack()


def patched(at: int, value: int) -> bytes:
    """GOOD with one byte changed."""
    data = bytearray(GOOD.pack())
    data[at] = value
    return bytes(data)


def test_the_good_image_is_accepted_and_has_the_documented_size() -> None:
    data = GOOD.pack()
    assert len(data) == 56 + 12 + 16
    assert verdict(data, MACHINE) is None
    assert PartImage.unpack(data) == GOOD
    assert GOOD.name == "pin"


@pytest.mark.parametrize(
    ("data", "refusal", "operation"),
    [
        (b"", Refusal.LENGTH, 0),
        (GOOD.pack()[:55], Refusal.LENGTH, 0),
        (GOOD.pack() + bytes(1), Refusal.LENGTH, 0),
        (GOOD.pack() + bytes(900), Refusal.LENGTH, 0),
        (GOOD.pack()[:-1], Refusal.LENGTH, 2),
        (GOOD.pack()[:70], Refusal.LENGTH, 2),
        (with_header(format=2), Refusal.FORMAT, 0),
        (with_header(flags=1), Refusal.FORMAT, 0),
        (with_header(reserved=1), Refusal.FORMAT, 0),
        (with_header(reserved_end=1), Refusal.FORMAT, 0),
        (with_header(name=bytes(16)), Refusal.NAME, 0),
        (with_header(name=b"Pin".ljust(16, b"\0")), Refusal.NAME, 0),
        (with_header(name=b"a\0b".ljust(16, b"\0")), Refusal.NAME, 0),
        (with_header(step_x_nm=7113), Refusal.STEP_SIZE, 0),
        (with_header(step_z_nm=7111), Refusal.STEP_SIZE, 0),
        (with_header(stock_radius=0), Refusal.STOCK, 0),
        (with_header(stock_radius=POSITION_MAX + 1), Refusal.STOCK, 0),
        (with_header(stock_length=0), Refusal.STOCK, 0),
        (with_header(stock_front=-1), Refusal.STOCK, 0),
        (with_header(operation_count=0), Refusal.OPERATION_COUNT, 0),
        (with_header(operation_count=49), Refusal.OPERATION_COUNT, 0),
        (with_header(depth_of_cut=0, finish_allowance=0), Refusal.DEPTH_OF_CUT, 0),
        (with_header(depth_of_cut=1001), Refusal.DEPTH_OF_CUT, 0),
        (with_header(finish_allowance=101), Refusal.ALLOWANCE, 0),
        (with_header(feed=1023), Refusal.FEED, 0),
        (with_header(feed=256_001), Refusal.FEED, 0),
        (with_header(finish_feed=0), Refusal.FEED, 0),
        (with_header(retract=0), Refusal.RETRACT, 0),
        (with_header(stock_radius=3536), Refusal.OUTSIDE_TRAVEL, 0),
        (with_header(stock_front=7961), Refusal.OUTSIDE_TRAVEL, 0),
        (patched(56, 9), Refusal.OPERATION_TYPE, 1),
        (patched(57, 16), Refusal.OPERATION_SIZE, 1),
        (patched(58, 1), Refusal.FORMAT, 1),
        (patched(59, 1), Refusal.FORMAT, 1),
        (with_operations(FaceRecord(0, -1)), Refusal.OUTSIDE_STOCK, 1),
        (with_operations(FaceRecord(0, 1001)), Refusal.OUTSIDE_STOCK, 1),
        (with_operations(FaceRecord(-4961, 0)), Refusal.OUTSIDE_STOCK, 1),
        (with_operations(FaceRecord(POSITION_MAX + 1, 0)), Refusal.EMPTY_CUT, 1),
        (with_operations(FaceRecord(100, 0)), Refusal.EMPTY_CUT, 1),
        (with_operations(FaceRecord(0, 1000)), Refusal.EMPTY_CUT, 1),
        (with_operations(CylinderRecord(101, -1, 500)), Refusal.OUTSIDE_STOCK, 1),
        (with_operations(CylinderRecord(100, -4961, 500)), Refusal.OUTSIDE_STOCK, 1),
        (with_operations(CylinderRecord(100, 100, 500)), Refusal.EMPTY_CUT, 1),
        (with_operations(CylinderRecord(-10, 10, 500)), Refusal.EMPTY_CUT, 1),
        (with_operations(CylinderRecord(100, 0, 1000)), Refusal.EMPTY_CUT, 1),
        (with_operations(CylinderRecord(0, -10, 500)), Refusal.BLOCKED, 1),
        (
            with_operations(CylinderRecord(100, -50, 700), CylinderRecord(-10, -90, 600)),
            Refusal.BLOCKED,
            2,
        ),
        (
            with_operations(CylinderRecord(100, -50, 600), CylinderRecord(-60, -90, 700)),
            Refusal.BLOCKED,
            2,
        ),
        (with_operations(FaceRecord(0, 300), CylinderRecord(0, -90, 200)), Refusal.BLOCKED, 2),
    ],
)
def test_a_broken_rule_is_answered_with_reason_and_operation(
    data: bytes, refusal: Refusal, operation: int
) -> None:
    found = verdict(data, MACHINE)
    assert found is not None
    assert (found.refusal, found.operation) == (refusal, operation)


@pytest.mark.parametrize(
    "data",
    [
        with_header(name=b"0123456789abcde-"),
        with_header(depth_of_cut=1000, finish_allowance=1000),
        with_header(feed=1024, finish_feed=256_000),
        with_header(stock_radius=3535),
        with_header(retract=1),
        with_operations(FaceRecord(99, 999)),
        with_operations(FaceRecord(-4960, 0)),
        with_operations(CylinderRecord(100, -4960, 0)),
        with_operations(CylinderRecord(100, -50, 700), CylinderRecord(-50, -90, 700)),
        with_operations(FaceRecord(0, 300), CylinderRecord(0, -90, 300)),
        with_operations(*[CylinderRecord(100, -50, 700)] * 48),
    ],
)
def test_a_part_at_the_edge_of_a_rule_is_accepted(data: bytes) -> None:
    assert verdict(data, MACHINE) is None


def test_ends_behind_the_travel_are_refused_for_each_axis() -> None:
    short_x = Machine("x", 7112, 7112, 3000, 16072, -3575, -8000, 1000)
    short_z = Machine("z", 7112, 7112, 3575, 9999, -3575, -8000, 1000)
    for machine in (short_x, short_z):
        found = verdict(with_operations(CylinderRecord(100, -2000, 500)), machine)
        assert found is not None
        assert found.refusal is Refusal.OUTSIDE_TRAVEL
        assert found.operation == 1


@given(st.lists(operations, min_size=1, max_size=5))
def test_bytes_and_steps_are_judged_alike(wanted: list[Operation]) -> None:
    data = with_operations(*wanted)
    image = PartImage.unpack(data)
    assert image.operations == tuple(wanted)
    first = next(check(image, Scale("mm", MACHINE)), None)
    found = verdict(data, MACHINE)
    assert describe(first) == describe(found)


def describe(violation: Violation | None) -> object:
    """The part of a violation that the chip answers."""
    return violation and (violation.refusal, violation.operation)


@given(st.binary(max_size=1000))
def test_any_bytes_get_a_verdict(data: bytes) -> None:
    assert verdict(data, MACHINE) is not None


@given(st.integers(0, len(GOOD.pack()) * 8 - 1))
def test_an_image_with_a_flipped_bit_gets_a_verdict_and_survives_if_accepted(bit: int) -> None:
    data = bytearray(GOOD.pack())
    data[bit // 8] ^= 1 << bit % 8
    if verdict(bytes(data), MACHINE) is None:
        assert PartImage.unpack(bytes(data)).pack() == bytes(data)


@pytest.mark.parametrize(
    "unpack", [lambda: PartImage.unpack(b"short"), lambda: PartImage.unpack(GOOD.pack() + b"x")]
)
def test_unpacking_bytes_that_are_no_image_is_refused(unpack: Callable[[], PartImage]) -> None:
    with pytest.raises(ImageError, match="LENGTH at operation 0"):
        unpack()


def test_numbers_that_do_not_fit_their_field_cannot_be_packed() -> None:
    with pytest.raises(struct.error):
        PartImage(HEADER._replace(retract=70_000), ()).pack()
    assert IMAGE_HEADER.size == 56
