# SPDX-License-Identifier: Apache-2.0
"""Images sent past the command line: the chip refuses them itself, with reason and operation."""

from __future__ import annotations

import random
from typing import Any

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import on_a_new_chip
from tornillo.errors import ChipError
from tornillo.image import Operation, PartImage
from tornillo.machine import Machine
from tornillo.protocol import (
    CylinderRecord,
    ErrorCode,
    FaceRecord,
    Refusal,
)
from tornillo.rules import verdict

FACE, CYLINDER = little_pin.OPERATIONS
RADIUS, LENGTH, FRONT, RETRACT = little_pin.RADIUS, little_pin.LENGTH, little_pin.FRONT, 5
TRAVEL_Z = 120  # from machine zero: part z down to -60
GOOD = little_pin.image()

Answer = tuple[Refusal, int] | None


def small_machine() -> Bench:
    """Return a lathe whose Z slide ends before the chuck."""
    bench = little_pin.lathe_with_pin()
    bench.set(travel_z=TRAVEL_Z)
    return bench


def answer(bench: Bench, image: bytes) -> Answer:
    """Send an image past all checks of the host; delete it again when the chip has taken it."""
    try:
        slot = bench.host.upload(image)
    except ChipError as error:
        if error.code is ErrorCode.OUT_OF_RANGE:
            return Refusal.LENGTH, 0  # announced length, before the first piece
        if error.code is not ErrorCode.INVALID_PART or error.reason is None:
            raise
        return error.reason, error.operation
    bench.host.delete(slot)
    return None


def with_operations(*operations: Operation) -> bytes:
    """Return the image of a part with these operations."""
    return little_pin.image(operations=operations)


def patched(at: int, value: int) -> bytes:
    """Return the good image with one byte changed."""
    return GOOD[:at] + bytes([value]) + GOOD[at + 1 :]


REFUSED: list[tuple[bytes, Refusal, int]] = [
    (little_pin.image(format=2), Refusal.FORMAT, 0),
    (little_pin.image(flags=1), Refusal.FORMAT, 0),
    (little_pin.image(reserved=1), Refusal.FORMAT, 0),
    (little_pin.image(reserved_end=256), Refusal.FORMAT, 0),
    (patched(58, 1), Refusal.FORMAT, 1),
    (patched(71, 1), Refusal.FORMAT, 2),
    (GOOD + bytes(1), Refusal.LENGTH, 0),
    (GOOD[:-1], Refusal.LENGTH, 2),
    (GOOD[:60], Refusal.LENGTH, 1),
    (GOOD[:55], Refusal.LENGTH, 0),
    (GOOD + bytes(900), Refusal.LENGTH, 0),
    (little_pin.image(""), Refusal.NAME, 0),
    (little_pin.image("Pin"), Refusal.NAME, 0),
    (little_pin.image("a\0b"), Refusal.NAME, 0),
    (little_pin.image("a b"), Refusal.NAME, 0),
    (little_pin.image(step_x_nm=7111), Refusal.STEP_SIZE, 0),
    (little_pin.image(step_z_nm=7112 + 0x10000), Refusal.STEP_SIZE, 0),
    (little_pin.image(stock_radius=0), Refusal.STOCK, 0),
    (little_pin.image(stock_radius=32001), Refusal.STOCK, 0),
    (little_pin.image(stock_length=0), Refusal.STOCK, 0),
    (little_pin.image(stock_length=0xFFFFFFFF), Refusal.STOCK, 0),
    (little_pin.image(stock_front=-1), Refusal.STOCK, 0),
    (little_pin.image(stock_front=0x10000), Refusal.STOCK, 0),
    (little_pin.image(depth_of_cut=0, finish_allowance=0), Refusal.DEPTH_OF_CUT, 0),
    (little_pin.image(depth_of_cut=RADIUS + 1), Refusal.DEPTH_OF_CUT, 0),
    (little_pin.image(finish_allowance=11), Refusal.ALLOWANCE, 0),
    (little_pin.image(feed=1023), Refusal.FEED, 0),
    (little_pin.image(feed=1000 * 256 + 1), Refusal.FEED, 0),
    (little_pin.image(finish_feed=0), Refusal.FEED, 0),
    (little_pin.image(finish_feed=0x80000000), Refusal.FEED, 0),
    (little_pin.image(retract=0), Refusal.RETRACT, 0),
    (little_pin.image(retract=41), Refusal.OUTSIDE_TRAVEL, 0),
    (little_pin.image(retract=0xFFFF), Refusal.OUTSIDE_TRAVEL, 0),
    (little_pin.image(stock_radius=96), Refusal.OUTSIDE_TRAVEL, 0),
    (little_pin.image(stock_front=56), Refusal.OUTSIDE_TRAVEL, 0),
    (with_operations(), Refusal.OPERATION_COUNT, 0),
    (with_operations(*[FACE] * 49), Refusal.OPERATION_COUNT, 0),
    (patched(56, 3), Refusal.OPERATION_TYPE, 1),
    (patched(68, 0), Refusal.OPERATION_TYPE, 2),
    (patched(57, 16), Refusal.OPERATION_SIZE, 1),
    (patched(69, 12), Refusal.OPERATION_SIZE, 2),
    (with_operations(FaceRecord(0, -1)), Refusal.OUTSIDE_STOCK, 1),
    (with_operations(FaceRecord(0, RADIUS + 1)), Refusal.OUTSIDE_STOCK, 1),
    (with_operations(FACE, CylinderRecord(FRONT + 1, -9, 30)), Refusal.OUTSIDE_STOCK, 2),
    (with_operations(FACE, CylinderRecord(0, RETRACT - LENGTH - 1, 30)), Refusal.OUTSIDE_STOCK, 2),
    (with_operations(FACE, CylinderRecord(0, -61, 30)), Refusal.OUTSIDE_TRAVEL, 2),
    (with_operations(FACE, CylinderRecord(0, 0, 30)), Refusal.EMPTY_CUT, 2),
    (with_operations(FACE, CylinderRecord(-30, -20, 30)), Refusal.EMPTY_CUT, 2),
    (with_operations(FaceRecord(FRONT, 0)), Refusal.EMPTY_CUT, 1),
    (with_operations(FaceRecord(0, RADIUS)), Refusal.EMPTY_CUT, 1),
    (with_operations(CylinderRecord(0, -20, 30)), Refusal.BLOCKED, 1),
    (with_operations(FACE, CYLINDER, CylinderRecord(-41, -50, 50)), Refusal.BLOCKED, 3),
    (with_operations(FACE, CYLINDER, CylinderRecord(-20, -50, 34)), Refusal.BLOCKED, 3),
]

ACCEPTED = [
    GOOD,
    little_pin.image("0123456789abcde-"),
    little_pin.image(depth_of_cut=RADIUS, finish_allowance=RADIUS),
    little_pin.image(feed=1024, finish_feed=1000 * 256),
    little_pin.image(retract=40),
    little_pin.image(stock_radius=95),
    little_pin.image(stock_front=55),
    with_operations(*[FACE] * 48),
    with_operations(FACE, CylinderRecord(0, -60, 0)),
    with_operations(FaceRecord(FRONT - 1, RADIUS - 1)),
    with_operations(FACE, CYLINDER, CylinderRecord(-40, -50, 35)),
]


@on_a_new_chip
def test_the_chip_refuses_by_itself_with_reason_and_operation() -> None:
    bench = small_machine()
    found = [answer(bench, image) for image, _, _ in REFUSED]
    assert found == [(refusal, operation) for _, refusal, operation in REFUSED]
    assert [part.name for part in bench.host.parts()] == ["little-pin"]


def test_every_reason_of_the_protocol_is_tried() -> None:
    assert {refusal for _, refusal, _ in REFUSED} == set(Refusal)


@on_a_new_chip
def test_the_chip_accepts_what_lies_on_the_edge_of_a_rule() -> None:
    bench = small_machine()
    bench.host.delete(bench.host.find("little-pin").slot)
    assert [answer(bench, image) for image in ACCEPTED] == [None] * len(ACCEPTED)


@pytest.mark.parametrize("seed", [1, 2, 3])
@on_a_new_chip
def test_host_and_chip_judge_generated_images_alike(seed: int) -> None:
    bench = small_machine()
    bench.host.delete(bench.host.find("little-pin").slot)
    machine = bench.host.machine()
    chance = random.Random(seed)
    verdicts = []
    for _ in range(200):
        image = generated(chance, machine)
        judged = verdict(image, machine)
        expected = (judged.refusal, judged.operation) if judged else None
        assert answer(bench, image) == expected, image.hex()
        verdicts.append(expected)
    assert verdicts.count(None) > 20
    assert len({found[0] for found in verdicts if found}) >= 12


def generated(chance: random.Random, machine: Machine) -> bytes:
    """Return an image: sound, on an edge, just beyond it, or damaged."""
    header = little_pin.HEADER
    edges: dict[str, list[int]] = {
        "stock_radius": [1, 60, 95, 96, 0, 32000, 32001, 0xFFFFFFFF],
        "stock_length": [1, 100, 66, 32000, 32001, 0, 0x80000000],
        "stock_front": [0, 6, 55, 56, -1, 32000, -0x80000000],
        "depth_of_cut": [1, 10, 60, 61, 0, 0xFFFF],
        "finish_allowance": [0, 2, 10, 11, 0x8000],
        "feed": [1024, 400 * 256, machine.max_rate * 256, machine.max_rate * 256 + 1, 1023],
        "finish_feed": [1024, 200 * 256, 256_001, 0, 0xFFFFFFFF],
        "retract": [1, 5, 40, 41, 0, 0x8000, 0xFFFF],
        "step_x_nm": [7112, 7113, 0x17112],
    }
    for field, values in edges.items():
        if chance.random() < 0.08:
            changed: dict[str, Any] = {field: chance.choice(values)}
            header = header._replace(**changed)
    count = chance.randint(1, 5)
    operations = [generated_operation(chance) for _ in range(count)]
    if chance.random() < 0.7:
        operations[0] = FACE
    image = bytearray(PartImage(header._replace(operation_count=count), tuple(operations)).pack())
    fate = chance.random()
    if fate < 0.15:
        image[chance.randrange(len(image))] ^= 1 << chance.randrange(8)
    elif fate < 0.25:
        del image[chance.randrange(56, len(image)) :]
    elif fate < 0.3:
        image += bytes(chance.randint(1, 40))
    return bytes(image)


def generated_operation(chance: random.Random) -> Operation:
    """Return an operation with ends on and around every edge."""
    places = [FRONT + 1, FRONT, FRONT - 1, 1, 0, -1, -20, -40, -59, -60, -61, -95, -96, 0x7FFFFFFF]
    radii = [-1, 0, 1, 34, 35, 36, RADIUS - 1, RADIUS, RADIUS + 1, 32768, -0x80000000]
    if chance.random() < 0.6:
        places, radii = [0, 0, -20, -40, -60], [20, 34, 35, 36, 50]
    if chance.random() < 0.3:
        return FaceRecord(chance.choice(places), chance.choice(radii))
    start, end = chance.choice(places), chance.choice(places)
    if chance.random() < 0.85:
        start, end = max(start, end), min(start, end)
    return CylinderRecord(start, end, chance.choice(radii))
