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
from tornillo.link import Link
from tornillo.protocol import Command, ErrorCode, State
from virtual_lathe.chip import NonVolatile

SEVEN = [f"part-{number}" for number in range(1, 8)]


def names(bench: Bench) -> list[str]:
    """Names of the stored parts, sorted."""
    return sorted(part.name for part in bench.host.parts())


def selected(bench: Bench) -> str:
    """Name of the part that RUN cuts."""
    (chosen,) = [part.name for part in bench.host.parts() if part.selected]
    return chosen


def full_store() -> Bench:
    """Return a lathe with seven parts."""
    bench = little_pin.lathe_with_pin()
    bench.host.delete(bench.host.find("little-pin").slot)
    for number, name in enumerate(SEVEN):
        bench.host.upload(little_pin.image(name, depth_of_cut=10 + number))
    return bench


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
    operations = little_pin.OPERATIONS[:1] * 20 + little_pin.OPERATIONS[1:] * 28
    image = little_pin.image("long", operations)
    slot = bench.host.upload(image)
    assert bench.host.read(slot) == image
    assert bench.host.part(slot) is not None
    bench.home()
    bench.host.run(slot)
    bench.wait_for(State.IDLE)
    assert bench.status().finished
    little_pin.assert_cut_exactly(bench)


@on_a_new_chip
def test_seven_names_fit_and_the_eighth_is_refused_but_each_can_be_replaced() -> None:
    bench = full_store()
    host = bench.host
    assert names(bench) == SEVEN
    refused = bench.refusal(lambda: host.upload(little_pin.image("part-8")))
    assert refused is ErrorCode.STORE_FULL
    assert names(bench) == SEVEN
    for name in SEVEN:
        image = little_pin.image(name, depth_of_cut=25)
        assert host.read(host.upload(image)) == image
        assert names(bench) == SEVEN
        assert selected(bench) == name
    host.delete(host.find("part-3").slot)
    host.upload(little_pin.image("part-8"))
    assert "part-8" in names(bench)
    bench.power_cycle()
    assert names(bench) == sorted({*SEVEN, "part-8"} - {"part-3"})


@on_a_new_chip
def test_the_selected_part_is_remembered_and_falls_back_to_the_newest() -> None:
    bench = full_store()
    host = bench.host
    assert selected(bench) == "part-7"
    host.select(host.find("part-2").slot)
    bench.power_cycle()
    assert selected(bench) == "part-2"
    bench.host.delete(bench.host.find("part-2").slot)
    assert selected(bench) == "part-7"
    bench.host.delete(bench.host.find("part-7").slot)
    assert selected(bench) == "part-6"
    assert bench.status().slot == bench.host.find("part-6").slot


@on_a_new_chip
def test_deleting_and_selecting_what_is_not_there_is_refused() -> None:
    bench = little_pin.lathe_with_pin()
    empty = (bench.host.find("little-pin").slot + 1) % 8
    for slot in (empty, 8, 255):
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
    return 0x6000 + 1024 * slot


def header(generation: int, image: bytes) -> bytes:
    """Return the header of a stored part, as firmware/store/parts.h describes it."""
    fields = struct.pack("<HHHH", 0x4E54, generation, len(image), crc16(image))
    return fields + struct.pack("<H", crc16(fields))


def store(bench: Bench, slot: int, generation: int, image: bytes) -> None:
    """Put a part straight into the flash, and forget which one was selected."""
    memory = bench.chip.save()
    flash = bytearray(memory.flash)
    content = header(generation, image).ljust(64, b"\xff") + image
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
        (Command.UPLOAD_BEGIN, struct.pack("<HH", 55, 0), ErrorCode.OUT_OF_RANGE),
        (Command.UPLOAD_BEGIN, struct.pack("<HH", 961, 0), ErrorCode.OUT_OF_RANGE),
        (Command.UPLOAD_BEGIN, struct.pack("<H", 72), ErrorCode.BAD_LENGTH),
        (Command.PART_READ, struct.pack("<BH", 8, 0), ErrorCode.NO_PART),
        (Command.PART_INFO, b"\x08", ErrorCode.OUT_OF_RANGE),
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
    assert read((slot + 1) % 8, 0) is ErrorCode.NO_PART


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
    assert bench.is_in(State.RUNNING)
    bench.wait_for(State.IDLE)
    little_pin.assert_cut_exactly(bench)
    assert bench.lathe.host.counts["transactions"] == 0


def test_a_stored_part_is_cut_by_the_button_with_usb_never_attached() -> None:
    memory = branch(stored_by_usb)
    branch(partial(cut_by_buttons, memory))
