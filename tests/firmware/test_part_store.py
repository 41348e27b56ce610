# SPDX-License-Identifier: Apache-2.0
"""The part store: what stays, what replaces what, and what the link may ask of it."""

from __future__ import annotations

import struct
from functools import partial

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import branch, on_a_new_chip
from tornillo.errors import ChipError
from tornillo.frames import crc16
from tornillo.image import CENTRE_UNIT, Record, Segment, SegmentKind
from tornillo.link import Link
from tornillo.protocol import PART_IMAGE_MAX, PART_SLOTS, PART_UNIT, Command, ErrorCode, State
from virtual_lathe.chip import NonVolatile

EVERY = [f"part-{number:02}" for number in range(1, PART_SLOTS + 1)]
EIGHT = EVERY[:8]
STORE_BEGIN, UNIT_HEADER = 0x7600, 64


def names(bench: Bench) -> list[str]:
    """Names of the stored parts, sorted."""
    return sorted(part.name for part in bench.host.parts())


def selected(bench: Bench) -> str:
    """Name of the part that RUN cuts."""
    (chosen,) = [part.name for part in bench.host.parts() if part.selected]
    return chosen


def stored(parts: list[str]) -> Bench:
    """Return a lathe with these parts, of one unit each, and no other."""
    bench = little_pin.lathe_with_pin()
    bench.host.delete(bench.host.find("little-pin").slot)
    for number, name in enumerate(parts):
        bench.host.upload(little_pin.image(name, depth_of_cut=10 + number))
    return bench


def of_length(units: int) -> bytes:
    """Return a part that takes so many units to the last byte, named after their number."""
    length = min(units * PART_UNIT - UNIT_HEADER, PART_IMAGE_MAX)
    spare = length - len(little_pin.image())
    pauses: list[Record] = []
    while spare:
        size = min(36, spare if spare <= 36 or spare > 40 else spare - 4)
        pauses.append(little_pin.pause("m" * (size - 4)))
        spare -= size
    if len(pauses) > 60:
        raise ValueError("too many operations")
    image = little_pin.image(f"units-{units}", (*pauses, *little_pin.OPERATIONS))
    assert len(image) == length
    return image


@on_a_new_chip
def test_a_part_is_read_back_as_it_was_sent_and_survives_power_cycles() -> None:
    bench = little_pin.lathe_with_pin()
    for seed in (1, 2):
        bench.power_cycle(seed)
        part = bench.host.find("little-pin")
        assert bench.host.read(part.slot) == little_pin.image()
        assert (part.operations, part.selected, part.crc) == (2, True, crc16(little_pin.image()))


@on_a_new_chip
def test_the_longest_part_can_be_stored_and_read_back() -> None:
    bench = little_pin.lathe_with_pin()
    bench.host.delete(bench.host.find("little-pin").slot)
    image = of_many_segments()
    slot = bench.host.upload(image)
    assert bench.host.read(slot) == image
    part = bench.host.part(slot)
    assert part is not None
    assert (part.length, part.operations) == (PART_IMAGE_MAX, 64)
    bench.home()
    bench.host.run(slot)
    bench.wait_for(State.IDLE)
    assert bench.status().finished
    little_pin.assert_cut_exactly(bench)


def of_many_segments() -> bytes:
    """Return the little pin as the longest image: 64 operations, 380 segments.

    Behind its face and its cylinder nothing comes that would still be there to cut.
    """
    up, along = little_pin.line(0, 1), little_pin.line(-1, 0)
    stairs = [little_pin.contour(-5, 40, *[along, up] * 3, *[along] * (n < 11)) for n in range(61)]
    corner = Segment(SegmentKind.CONVEX, -4, 4, -4 * CENTRE_UNIT, 0)
    operations = (*little_pin.OPERATIONS, *stairs, little_pin.contour(-5, 40, corner))
    return little_pin.image("long", operations)


@on_a_new_chip
def test_a_small_part_in_every_unit_fits_and_the_next_one_is_refused() -> None:
    bench = stored(EVERY)
    host = bench.host
    assert names(bench) == EVERY
    for name in ("one-more", EVERY[4]):
        upload = partial(host.upload, little_pin.image(name, depth_of_cut=25))
        assert bench.refusal(upload) is ErrorCode.STORE_FULL
    assert names(bench) == EVERY
    host.delete(host.find(EVERY[2]).slot)
    host.upload(little_pin.image("one-more"))
    bench.power_cycle()
    assert names(bench) == sorted({*EVERY, "one-more"} - {EVERY[2]})


@on_a_new_chip
def test_each_of_eight_parts_can_be_replaced() -> None:
    bench = stored(EIGHT)
    host = bench.host
    for name in EIGHT:
        image = little_pin.image(name, depth_of_cut=25)
        assert host.read(host.upload(image)) == image
        assert names(bench) == EIGHT
        assert selected(bench) == name


@on_a_new_chip
def test_each_of_eight_parts_is_cut_by_the_button_once_it_is_selected() -> None:
    bench = stored(EIGHT)
    bench.home()
    for name in (EIGHT[0], EIGHT[7], EIGHT[3]):
        slot = bench.host.find(name).slot
        bench.host.select(slot)
        bench.press("run")
        bench.wait_for(State.RUNNING)
        assert bench.status().slot == slot
        bench.wait_for(State.IDLE)
        assert bench.status().finished
    little_pin.assert_cut_exactly(bench)


@on_a_new_chip
def test_long_parts_take_units_side_by_side_and_go_where_they_first_fit() -> None:
    bench = stored([])
    host = bench.host
    images = {units: of_length(units) for units in (1, 2, 3, 4, 5)}
    slots = {units: host.upload(images[units]) for units in (3, 1, 4, 2)}
    assert slots == {3: 0, 1: 3, 4: 4, 2: 8}
    assert bench.refusal(partial(host.upload, images[5])) is ErrorCode.STORE_FULL
    host.delete(slots[1])
    host.delete(slots[3])
    assert bench.refusal(partial(host.upload, images[5])) is ErrorCode.STORE_FULL
    host.delete(slots[2])
    assert host.upload(little_pin.image()) == 0
    assert host.upload(images[3]) == 1
    assert bench.refusal(partial(host.upload, images[5])) is ErrorCode.STORE_FULL
    host.delete(slots[4])
    assert host.upload(images[5]) == 4
    bench.power_cycle()
    assert {part.slot: part.name for part in bench.host.parts()} == {
        0: "little-pin",
        1: "units-3",
        4: "units-5",
    }
    assert bench.host.read(1) == images[3]
    assert bench.host.read(4) == images[5]
    assert bench.host.read(0) == little_pin.image()


@on_a_new_chip
def test_a_long_part_is_not_stored_over_one_behind_the_free_units() -> None:
    bench = stored(EVERY)
    host = bench.host
    for slot in (1, 2, 3, 5, 6, 9):
        host.delete(slot)
    kept = {part.slot: host.read(part.slot) for part in host.parts()}
    assert bench.refusal(partial(host.upload, of_length(4))) is ErrorCode.STORE_FULL
    assert host.upload(of_length(3)) == 1
    assert host.upload(of_length(2)) == 5
    assert bench.refusal(partial(host.upload, of_length(2))) is ErrorCode.STORE_FULL
    assert {slot: host.read(slot) for slot in kept} == kept


@on_a_new_chip
def test_the_selected_part_is_remembered_and_falls_back_to_the_newest() -> None:
    bench = stored(EIGHT)
    host = bench.host
    assert selected(bench) == "part-08"
    host.select(host.find("part-02").slot)
    bench.power_cycle()
    assert selected(bench) == "part-02"
    bench.host.delete(bench.host.find("part-02").slot)
    assert selected(bench) == "part-08"
    bench.host.delete(bench.host.find("part-08").slot)
    assert selected(bench) == "part-07"
    assert bench.status().slot == bench.host.find("part-07").slot


@on_a_new_chip
def test_deleting_and_selecting_what_is_not_there_is_refused() -> None:
    bench = little_pin.lathe_with_pin()
    empty = (bench.host.find("little-pin").slot + 1) % PART_SLOTS
    for slot in (empty, PART_SLOTS, 255):
        assert bench.refusal(partial(bench.host.delete, slot)) is ErrorCode.NO_PART
        assert bench.refusal(partial(bench.host.select, slot)) is ErrorCode.NO_PART
    assert names(bench) == ["little-pin"]


@on_a_new_chip
def test_run_with_a_slot_cuts_that_part_and_not_the_selected_one() -> None:
    bench = little_pin.homed_lathe_with_pin()
    first = bench.host.find("little-pin").slot
    bench.host.upload(little_pin.image("selected", little_pin.OPERATIONS[:1]))
    bench.host.run(first)
    assert bench.status().slot == first
    bench.wait_for(State.IDLE)
    little_pin.assert_cut_exactly(bench)


def slot_at(slot: int) -> int:
    """Address of a slot in flash."""
    return STORE_BEGIN + PART_UNIT * slot


def header(generation: int, image: bytes) -> bytes:
    """Return the header of a stored part, as firmware/store/parts.h describes it."""
    fields = struct.pack("<HHHH", 0x4E54, generation, len(image), crc16(image))
    return fields + struct.pack("<H", crc16(fields))


def store(bench: Bench, slot: int, generation: int, image: bytes) -> None:
    """Put a part straight into the flash, and forget which one was selected."""
    memory = bench.chip.save()
    flash = bytearray(memory.flash)
    content = header(generation, image).ljust(UNIT_HEADER, b"\xff") + image
    flash[slot_at(slot) : slot_at(slot) + len(content)] = content
    eeprom = memory.eeprom[:0xE0] + b"\xff" + memory.eeprom[0xE1:]
    bench.chip.restore(NonVolatile(bytes(flash), eeprom))


@pytest.mark.parametrize("generation", [7, 0x7FFF, 0xFFFE, 0xFFFF])
@on_a_new_chip
def test_the_newest_part_is_told_by_its_generation_even_when_that_wraps(generation: int) -> None:
    bench = Bench()
    store(bench, 2, generation, little_pin.image("older"))
    store(bench, 1, (generation + 1) & 0xFFFF, little_pin.image("newer"))
    assert selected(bench) == "newer"
    bench.set(zero_x=little_pin.ZERO_X, zero_z=little_pin.ZERO_Z)
    bench.host.upload(little_pin.image("newest"))
    assert bench.host.find("newest").generation == (generation + 2) & 0xFFFF


@pytest.mark.parametrize(("older", "newer"), [(1, 5), (5, 1)])
@on_a_new_chip
def test_of_two_parts_with_one_name_only_the_newer_survives_the_next_start(
    older: int, newer: int
) -> None:
    bench = Bench()
    store(bench, older, 8, little_pin.image(depth_of_cut=8))
    store(bench, newer, 9, little_pin.image(depth_of_cut=9))
    bench.power_cycle()
    (part,) = bench.host.parts()
    assert (part.slot, part.generation) == (newer, 9)
    assert bench.host.read(newer) == little_pin.image(depth_of_cut=9)


# -- uploads out of order --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("command", "payload", "answer"),
    [
        (Command.UPLOAD_DATA, struct.pack("<H", 0) + bytes(32), ErrorCode.NO_UPLOAD),
        (Command.UPLOAD_COMMIT, b"", ErrorCode.NO_UPLOAD),
        (Command.UPLOAD_BEGIN, struct.pack("<HH", 31, 0), ErrorCode.OUT_OF_RANGE),
        (Command.UPLOAD_BEGIN, struct.pack("<HH", PART_IMAGE_MAX + 1, 0), ErrorCode.OUT_OF_RANGE),
        (Command.UPLOAD_BEGIN, struct.pack("<H", 72), ErrorCode.BAD_LENGTH),
        (Command.PART_READ, struct.pack("<BH", PART_SLOTS, 0), ErrorCode.NO_PART),
        (Command.PART_INFO, bytes([PART_SLOTS]), ErrorCode.OUT_OF_RANGE),
        (Command.STATUS, b"\x00", ErrorCode.BAD_LENGTH),
    ],
)
@on_a_new_chip
def test_a_request_out_of_place_is_refused_and_changes_nothing(
    command: Command, payload: bytes, answer: ErrorCode
) -> None:
    bench = little_pin.lathe_with_pin()
    before = bench.chip.nonvolatile_counts
    link = Link(bench.lathe.port)
    link.request(Command.HELLO)
    assert bench.refusal(lambda: link.request(command, payload)) is answer
    assert bench.chip.nonvolatile_counts == before


@on_a_new_chip
def test_reading_beside_or_behind_a_part_is_refused() -> None:
    bench = little_pin.lathe_with_pin()
    slot = bench.host.find("little-pin").slot
    link = Link(bench.lathe.port)
    link.request(Command.HELLO)

    def read(number: int, offset: int) -> ErrorCode:
        payload = struct.pack("<BH", number, offset)
        return bench.refusal(lambda: link.request(Command.PART_READ, payload))

    length = len(little_pin.image())
    assert read(slot, length // 32 * 32) is ErrorCode.OK
    assert read(slot, (length // 32 + 1) * 32) is ErrorCode.BAD_OFFSET
    assert read(slot, 1) is ErrorCode.BAD_OFFSET
    assert read((slot + 1) % PART_SLOTS, 0) is ErrorCode.NO_PART


@on_a_new_chip
def test_pieces_of_an_upload_must_come_whole_and_in_order() -> None:
    bench = little_pin.lathe_with_pin()
    image = little_pin.image("other")
    link = Link(bench.lathe.port)
    link.request(Command.HELLO)

    def data(offset: int, length: int = 32) -> ErrorCode:
        piece = struct.pack("<H", offset) + image[offset : offset + length]
        return bench.refusal(lambda: link.request(Command.UPLOAD_DATA, piece))

    def commit() -> ErrorCode:
        return bench.refusal(lambda: link.request(Command.UPLOAD_COMMIT))

    link.request(Command.UPLOAD_BEGIN, struct.pack("<HH", len(image), crc16(image)))
    assert data(32) is ErrorCode.BAD_OFFSET
    assert data(0, 31) is ErrorCode.BAD_OFFSET
    assert commit() is ErrorCode.BAD_LENGTH
    assert data(0) is ErrorCode.OK
    assert data(0) is ErrorCode.BAD_OFFSET
    assert data(32) is ErrorCode.OK
    assert commit() is ErrorCode.BAD_LENGTH
    assert data(64) is ErrorCode.OK
    assert data(96) is ErrorCode.OK
    assert commit() is ErrorCode.OK
    assert commit() is ErrorCode.NO_UPLOAD
    assert names(bench) == ["little-pin", "other"]


@on_a_new_chip
def test_an_image_that_is_not_the_announced_one_is_not_stored() -> None:
    bench = little_pin.lathe_with_pin()
    image = little_pin.image("other")
    link = Link(bench.lathe.port)
    link.request(Command.HELLO)
    link.request(Command.UPLOAD_BEGIN, struct.pack("<HH", len(image), crc16(image) ^ 1))
    for offset in range(0, len(image), 32):
        link.request(Command.UPLOAD_DATA, struct.pack("<H", offset) + image[offset : offset + 32])
    with pytest.raises(ChipError) as refused:
        link.request(Command.UPLOAD_COMMIT)
    assert refused.value.code is ErrorCode.CRC_MISMATCH
    assert names(bench) == ["little-pin"]


# -- without a computer ----------------------------------------------------------------------------


def stored_by_usb() -> NonVolatile:
    """Store the little pin over USB and switch off."""
    return little_pin.lathe_with_pin().chip.save()


def cut_by_buttons(memory: NonVolatile) -> None:
    """Home and run by the button on a lathe whose cable is never plugged in."""
    bench = Bench(memory, usb=False, backlash_x=23, backlash_z=31, **little_pin.OPTIONS)
    bench.lathe.wanted = little_pin.wanted()
    bench.run(0.1)
    bench.press("run")
    assert bench.is_in(State.HOMING)
    bench.wait_for(State.IDLE)
    bench.press("run")
    bench.wait_for(State.RUNNING)
    bench.wait_for(State.IDLE)
    little_pin.assert_cut_exactly(bench)
    assert bench.lathe.host.counts["transactions"] == 0


def test_a_stored_part_is_cut_by_the_button_with_usb_never_attached() -> None:
    memory = branch(stored_by_usb)
    branch(partial(cut_by_buttons, memory))
