# SPDX-License-Identifier: Apache-2.0
"""The serial number: changed over the link, kept over a cut of power, told by HELLO and USB."""

from __future__ import annotations

from functools import partial

import pytest
from simulated.bench import Bench
from simulated.processes import on_a_new_chip
from tornillo.link import Link
from tornillo.protocol import Command, ErrorCode, State

SERIAL_AT, SERIAL_END = 0xF0, 0xF8
STRING_SERIAL = 3


def stored(bench: Bench) -> bytes:
    """The number in the EEPROM."""
    return bench.chip.save().eeprom[SERIAL_AT:SERIAL_END]


def usb_serial(bench: Bench) -> str:
    """The number that the computer is told when the cable is plugged in again."""
    bench.unplug()
    bench.run(0.1)
    bench.connect()
    return bench.lathe.host.description.strings[STRING_SERIAL]


@on_a_new_chip
def test_a_blank_chip_has_zeros_and_takes_a_number() -> None:
    bench = Bench()
    assert bench.host.serial_number == "00000000"
    bench.host.set_serial_number("LATHE-07")
    assert stored(bench) == b"LATHE-07"
    assert bench.host.serial_number == "LATHE-07"
    assert usb_serial(bench) == "LATHE-07"
    bench.power_cycle()
    assert bench.host.serial_number == "LATHE-07"


@on_a_new_chip
def test_every_character_that_hosts_take_is_taken_and_nothing_around_it_changes() -> None:
    bench = Bench()
    before = bench.chip.save().eeprom
    good = [character for character in range(0x21, 0x7F) if character != ord(",")]
    for at in range(0, len(good), 8):
        number = bytes(good[at : at + 8]).ljust(8, b"0").decode("ascii")
        bench.host.set_serial_number(number)
        assert bench.host.serial_number == number
    after = bench.chip.save().eeprom
    assert (after[:SERIAL_AT], after[SERIAL_END:]) == (before[:SERIAL_AT], before[SERIAL_END:])


@on_a_new_chip
def test_a_number_with_one_bad_character_is_refused_and_the_old_one_stays() -> None:
    bench = Bench()
    bench.host.set_serial_number("LATHE-07")
    link = Link(bench.lathe.port)
    link.request(Command.HELLO)
    for place in range(8):
        for character in b"\x00\x20,\x7f\xff":
            number = bytearray(b"ABCDEFGH")
            number[place] = character
            change = partial(link.request, Command.SERIAL_SET, bytes(number))
            assert bench.refusal(change) is ErrorCode.OUT_OF_RANGE
    assert stored(bench) == b"LATHE-07"


@pytest.mark.parametrize("length", [0, 7, 9])
@on_a_new_chip
def test_a_number_of_another_length_is_refused(length: int) -> None:
    bench = Bench()
    bench.lathe.plug()
    link = Link(bench.lathe.port)
    link.request(Command.HELLO)
    change = partial(link.request, Command.SERIAL_SET, b"A" * length)
    assert bench.refusal(change) is ErrorCode.BAD_LENGTH
    assert stored(bench) == b"\xff" * 8


@on_a_new_chip
def test_the_number_is_not_changed_while_the_machine_moves() -> None:
    bench = Bench()
    bench.host.home()
    assert bench.is_in(State.HOMING)
    assert bench.refusal(lambda: bench.host.set_serial_number("LATHE-07")) is ErrorCode.BUSY
    assert stored(bench) == b"\xff" * 8


@on_a_new_chip
def test_the_change_is_answered_in_the_time_of_one_try() -> None:
    bench = Bench()
    assert bench.host.serial_number == "00000000"
    begun = bench.chip.seconds
    bench.host.set_serial_number("LATHE-07")
    assert bench.host._link.repeats == 0
    assert bench.chip.seconds - begun < 0.1
