# SPDX-License-Identifier: Apache-2.0
"""The boot loader: what it starts, what it refuses, and that nothing breaks it."""

from __future__ import annotations

import random
from functools import partial

import pytest
from simulated.bench import Bench
from simulated.power_cuts import BEGIN_WRITE
from simulated.processes import branch, on_a_new_chip
from simulated.standing import COILS
from tornillo.frames import crc16
from tornillo.link import Link
from tornillo.protocol import LOADER_MAGIC, Command, ErrorCode, ResetCause, State
from virtual_lathe.chip import Drive, NonVolatile, Reset, Stop
from virtual_lathe.configuration import write_protection

from firmware.loader_bench import (
    BEGIN,
    BLOCK,
    DAMAGED,
    DECISION_S,
    DONE,
    HOLD_BUTTON,
    NOT_WHOLE,
    ROW,
    UNKNOWN,
    WRONG_PLACE,
    LoaderBench,
    program,
)
from firmware.usb_bench import FIRMWARE

RELAYS = ("RC6", "RC7")
CLEAR_FEATURE, ENDPOINT_HALT, SET_CONFIGURATION = 1, 0, 9
BOOT_BLOCK_WRITABLE = 0x4000
#: How far a write of flash has come when power fails, s; it takes 2 ms.
MOMENTS_S = (0.0, 0.7e-3, 1.9e-3, 2.1e-3)


# -- which program is started ----------------------------------------------------------------------


def stays(flash: bytes, eeprom: bytes, bench: LoaderBench) -> bool:
    """Whether the loader keeps the chip when power comes with this flash."""
    bench.chip.restore(NonVolatile(flash, eeprom))
    bench.power_cycle()
    return bench.in_loader


@on_a_new_chip
def test_a_whole_program_starts_and_one_with_any_bit_wrong_does_not() -> None:
    bench = LoaderBench()
    memory = bench.chip.save()
    look = partial(stays, eeprom=memory.eeprom, bench=bench)
    assert not branch(partial(look, memory.flash))
    end = int.from_bytes(memory.flash[0x0802:0x0804], "little")
    chance = random.Random(1)
    places = [*range(BEGIN, BEGIN + 8), end - 1, *(chance.randrange(BEGIN, end) for _ in range(12))]
    for place in places:
        wrong = bytearray(memory.flash)
        wrong[place] ^= 1 << chance.randrange(8)
        assert branch(partial(look, bytes(wrong))), hex(place)
    # What is not the program's does not count: the part store.
    stored = memory.flash[:-1] + b"\x00"
    assert not branch(partial(look, stored))


@pytest.mark.parametrize("end", [0x0000, 0x0801, 0x08FF, 0x8000, 0xFFFF])
@on_a_new_chip
def test_a_program_with_an_impossible_end_is_not_read_for_ever(end: int) -> None:
    bench = LoaderBench()
    memory = bench.chip.save()
    flash = memory.flash[:0x0802] + end.to_bytes(2, "little") + memory.flash[0x0804:]
    assert stays(flash, memory.eeprom, bench)


@on_a_new_chip
def test_hold_leads_into_the_loader_when_power_comes_and_not_after_other_resets() -> None:
    bench = LoaderBench()
    assert bench.in_loader
    bench.power_cycle()
    assert not bench.in_loader
    bench.chip.drive(HOLD_BUTTON, Drive.LOW)
    for kind in (Reset.MCLR, Reset.WATCHDOG, Reset.BROWN_OUT):
        bench.chip.reset(kind)
        bench.chip.run(DECISION_S)
        assert not bench.in_loader, kind


@on_a_new_chip
def test_no_winding_has_current_and_no_relay_closes_in_the_loader() -> None:
    bench = LoaderBench()
    bench.chip.log_pins(*COILS, *RELAYS)
    bench.power_cycle()
    bench.chip.drive(HOLD_BUTTON, Drive.LOW)
    bench.power_cycle()
    bench.open()
    assert bench.command("I")[0] == DONE
    assert bench.chip.pin_changes() == []
    assert bench.chip.port("B") & 15 == bench.chip.port("D") & 15 == 0
    assert [bench.chip.level(pin) for pin in RELAYS] == [0, 0]


@on_a_new_chip
def test_the_led_flashes_twice_three_times_a_second() -> None:
    bench = LoaderBench()
    bench.chip.log_pins("RC0")
    bench.chip.run(3.5)
    lit = [levels for _, levels in bench.chip.pin_changes() if levels >> 16 & 1]
    assert len(lit) in range(19, 22)


# -- requests --------------------------------------------------------------------------------------


@on_a_new_chip
def test_the_loader_is_a_serial_port_of_its_own() -> None:
    bench = LoaderBench()
    bench.open()
    found = bench.host.description
    assert found.device[8:12] == bytes([0x09, 0x12, 0x02, 0x00])
    assert found.strings == {1: "Tornillo", 2: "Tornillo loader"}
    assert bench.command("I") == (DONE, bytes([1, 1, 0x00, 0x08, 0x00, 0x80, 1]))


@on_a_new_chip
def test_an_empty_chip_is_given_a_program_and_starts_it() -> None:
    bench = LoaderBench()
    memory = bench.chip.save()
    bench.chip.restore(NonVolatile(memory.flash[:BEGIN].ljust(0x8000, b"\xff"), memory.eeprom))
    bench.power_cycle()
    assert bench.in_loader
    bench.open()
    assert bench.command("I")[1][-1] == 0
    assert bench.command("G") == (NOT_WHOLE, b"")
    bench.update(program(5, 0x12))
    assert bench.command("G") == (DONE, b"")
    bench.chip.run(DECISION_S + 0.05)
    assert not bench.in_loader
    assert [kind for _, kind in bench.chip.resets][-1] is Reset.SOFTWARE


@on_a_new_chip
def test_the_firmware_itself_is_written_read_back_and_started() -> None:
    bench = LoaderBench()
    memory = bench.chip.save()
    end = int.from_bytes(memory.flash[0x0802:0x0804], "little")
    firmware = memory.flash[BEGIN : end + (BEGIN - end) % BLOCK]
    other = program(5, 0x77)
    bench.open()
    bench.update(other)
    bench.update(firmware)
    read = b"".join(bench.command("R", at)[1] for at in range(BEGIN, end, ROW))
    assert read[: end - BEGIN] == memory.flash[BEGIN:end]
    assert bench.command("G") == (DONE, b"")
    bench.chip.run(DECISION_S + 0.05)
    assert not bench.in_loader
    bench.open()
    assert bench.host.description.device[10:12] == bytes([0x01, 0x00])
    after = bench.chip.save()
    assert after.flash == memory.flash
    assert after.eeprom == memory.eeprom


@on_a_new_chip
def test_a_request_that_is_damaged_changes_nothing() -> None:
    bench = LoaderBench()
    bench.open()
    before = bench.chip.save()
    body = b"W" + (0x2000).to_bytes(2, "little") + bytes(ROW)
    whole = body + crc16(body).to_bytes(2, "little")
    for bit in range(8 * len(whole)):
        wrong = bytearray(whole)
        wrong[bit // 8] ^= 1 << bit % 8
        assert bench.request(bytes(wrong))[1] == DAMAGED
    for length in range(1, len(whole)):
        assert bench.request(whole[:length])[1] == DAMAGED
    for data in (b"", bytes(ROW - 1), bytes(ROW + 1)):
        assert bench.command("W", 0x2000, data) == (DAMAGED, b"")
    assert bench.command("X") == (UNKNOWN, b"")
    assert bench.chip.save() == before
    assert bench.command("I")[1][-1] == 1


@on_a_new_chip
def test_the_loader_never_writes_over_itself() -> None:
    bench = LoaderBench()
    bench.open()
    before = bench.chip.save()
    for place in (*range(0, BEGIN, ROW), 0x8000, 0xF800, 0xFFE0, BEGIN + 1, BEGIN + 16, 0x2010):
        assert bench.command("W", place, bytes(ROW)) == (WRONG_PLACE, b"")
        assert bench.command("R", place) == (WRONG_PLACE, b"")
    assert bench.chip.save() == before
    # And no program can: the configuration words protect the boot block.
    assert not write_protection(FIRMWARE) & BOOT_BLOCK_WRITABLE


@on_a_new_chip
def test_the_first_write_makes_the_old_program_no_program() -> None:
    bench = LoaderBench()
    bench.open()
    assert bench.command("W", 0x2000, bytes(ROW)) == (DONE, b"")
    assert bench.chip.save().flash[BEGIN : BEGIN + BLOCK] == b"\xff" * BLOCK
    bench.power_cycle()
    assert bench.in_loader


@on_a_new_chip
def test_flash_that_does_not_keep_what_is_written_is_noticed() -> None:
    bench = LoaderBench()
    bench.open()
    assert bench.command("W", 0x2000, bytes(ROW))[0] == DONE
    # The second half of a block that was not erased for it.
    assert bench.command("W", 0x2020, bytes(ROW))[0] == DONE
    assert bench.command("W", 0x2020, b"\x01" * ROW)[0] == 4


@on_a_new_chip
def test_control_requests_of_every_kind_are_served_or_refused() -> None:
    bench = LoaderBench().enumerate()
    host = bench.host
    assert host.control(0x80, 0, length=2) == b"\x01\x00"
    assert host.control(0x81, 0, length=2) == b"\x00\x00"
    assert host.control(0x82, 0, index=0x82, length=2) == b"\x00\x00"
    assert bench.configuration() == 1
    host.control(0x00, SET_CONFIGURATION, 0)
    assert bench.configuration() == 0
    host.control(0x00, SET_CONFIGURATION, 1)
    assert bench.refuses(0x00, SET_CONFIGURATION, 2)
    assert bench.refuses(0x80, 6, 0x0305, length=255)
    assert bench.refuses(0x40, 1)
    assert bench.refuses(0x21, 0x30)
    host.control(0x21, 0x23, 0xFFFF)  # break
    host.control(0x01, 11, 0, 1)
    assert host.control(0xA1, 0x21, length=7)[-1] == 8
    assert host.control(0x80, 6, 0x0200, length=64) == host.description.configuration[:64]
    assert host.control(0x80, 6, 0x0200, length=300) == host.description.configuration


@on_a_new_chip
def test_clearing_a_halt_begins_with_data0_again() -> None:
    bench = LoaderBench()
    bench.open()
    bench.command("I")
    bench.host.close_port()
    for endpoint in (0x02, 0x82):
        bench.host.control(0x02, CLEAR_FEATURE, ENDPOINT_HALT, endpoint)
    bench.host.control(0x00, SET_CONFIGURATION, 1)
    bench.open()
    assert bench.command("I")[0] == DONE


@pytest.mark.parametrize("seed", [1, 2, 3])
@on_a_new_chip
def test_nonsense_is_answered_and_never_written(seed: int) -> None:
    bench = LoaderBench()
    bench.open()
    before = bench.chip.save()
    chance = random.Random(seed)
    for _ in range(150):
        packet = chance.randbytes(chance.randrange(1, 63))
        assert bench.request(packet)[1] == DAMAGED
        if chance.random() < 0.2:
            bench.host.reset_bus()
            bench.host.wait(0.01)
            bench.open()
    assert bench.chip.save() == before
    assert bench.command("I")[1][-1] == 1


# -- power cuts ------------------------------------------------------------------------------------


def update_after(bench: LoaderBench, later: float, first: bytes, wanted: bytes) -> str:
    """Let power fail so much later; say what is wrong with the chip then.

    ``first`` is the flash as it was before the update, ``wanted`` the new program.
    """
    bench.chip.run(later)
    bench.power_cycle()
    memory = bench.chip.save()
    if memory.flash[:BEGIN] != first[:BEGIN]:
        return "the loader has changed"
    if not bench.in_loader:
        new = memory.flash[BEGIN : BEGIN + len(wanted)] == wanted
        return "" if new or memory.flash == first else "half a program was started"
    bench.open()
    bench.update(wanted)
    if bench.command("G")[0] != DONE:
        return "the second update fails"
    bench.chip.run(DECISION_S + 0.05)
    return "still in the loader" if bench.in_loader else ""


@on_a_new_chip
def test_power_may_fail_at_every_write_of_an_update() -> None:
    bench = LoaderBench()
    bench.open()
    first, wanted = bench.chip.save().flash, program(4, 0x55)
    at = bench.chip.save().flash[:BEGIN].index(BEGIN_WRITE)
    bench.chip.set_break(at)
    begun = bench.chip.nonvolatile_counts
    wrong: list[str] = []
    cuts = 0
    run_to = bench.chip.run_to

    def watched(cycle: int) -> Stop:
        nonlocal cuts
        stop = run_to(cycle)
        while stop is Stop.ADDRESS:
            for moment in MOMENTS_S:
                bench.chip.set_break(at, False)
                said = branch(partial(update_after, bench, moment, first, wanted))
                bench.chip.set_break(at)
                wrong.extend([f"write {cuts}, {moment} s: {said}"] if said else [])
            cuts += 1
            stop = run_to(cycle)
        return stop

    vars(bench.host)["_run_to"] = watched
    bench.update(wanted)
    assert not wrong
    done = bench.chip.nonvolatile_counts
    writes = sum(done[name] - begun[name] for name in ("flash_erases", "flash_writes"))
    # Three blocks of two rows, the head of the old program, the first block.
    assert cuts == writes == 3 * 3 + 1 + 3


# -- from the running firmware ---------------------------------------------------------------------


@on_a_new_chip
def test_the_firmware_goes_into_the_loader_when_it_is_asked_and_idle() -> None:
    bench = Bench()
    bench.connect()
    link = Link(bench.lathe.port)
    link.request(Command.HELLO)
    ask = partial(link.request, Command.LOADER, LOADER_MAGIC.to_bytes(2, "little"))
    wrong = partial(link.request, Command.LOADER, b"\0\0")
    assert bench.refusal(wrong) is ErrorCode.OUT_OF_RANGE
    bench.host.home()
    assert bench.refusal(ask) is ErrorCode.BUSY
    bench.wait_for(State.IDLE)
    ask()
    bench.run(DECISION_S + 0.06)
    assert bench.chip.pc < BEGIN
    # Power off and on: the program again, as after any update that was not begun.
    bench.unplug()
    bench.chip.reset(Reset.POWER_ON)
    bench.run(DECISION_S)
    assert bench.chip.pc >= BEGIN


@on_a_new_chip
def test_the_key_counts_after_a_reset_instruction_only() -> None:
    bench = LoaderBench()
    bench.power_cycle()
    assert not bench.in_loader
    for kind in (Reset.MCLR, Reset.WATCHDOG, Reset.BROWN_OUT, Reset.POWER_ON):
        bench.chip.poke(0x00, int.from_bytes(b"TL", "little"), 2)
        bench.chip.reset(kind)
        bench.chip.run(DECISION_S)
        assert not bench.in_loader, kind


@on_a_new_chip
def test_the_reset_cause_is_told_as_without_a_loader() -> None:
    bench = Bench()
    bench.run(DECISION_S)
    bench.connect()
    assert bench.status().reset_cause == ResetCause.POWER_ON
    for kind in (Reset.MCLR, Reset.BROWN_OUT, Reset.WATCHDOG):
        bench.unplug()
        bench.chip.reset(kind)
        bench.run(DECISION_S)
        bench.connect()
        assert bench.status().reset_cause == ResetCause[kind.name]
