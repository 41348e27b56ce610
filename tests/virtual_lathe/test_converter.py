# SPDX-License-Identifier: Apache-2.0
"""The A/D converter, with the test in the place of the firmware."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from virtual_lathe.chip import Chip
from virtual_lathe.worker import in_new_process

Program = Callable[..., str]
ADCON2, ADCON1, ADCON0, ADRESL, ADRESH, PIR1 = 0xFC0, 0xFC1, 0xFC2, 0xFC3, 0xFC4, 0xF9E
ADON, GO, ADIF, RIGHT = 0x01, 0x02, 0x40, 0x80
# 64 TOSC, so that TAD is 16 cycles, and 4 TAD to acquire.
SLOW, TAD = 0x16, 16
VREF_PINS, AN0_TO_AN3, ONLY_AN0 = 0x30, 0x0B, 0x0E


class Hand:
    """A chip with its converter on, channel 0."""

    def __init__(self, firmware: str, analogue: int = ONLY_AN0, setting: int = SLOW) -> None:
        """Switch on."""
        self.chip = Chip(firmware)
        self.chip.run(1e-5)
        self.chip.write(ADCON1, analogue)
        self.chip.write(ADCON2, setting)
        self.chip.write(ADCON0, ADON)
        self.chip.run(1e-4)

    def convert(self) -> int:
        """One conversion; returns how many cycles it took, to 2."""
        begin = self.chip.cycle
        self.chip.write(ADCON0, self.chip.peek(ADCON0) | GO)
        while self.chip.peek(ADCON0) & GO:
            self.chip.run_to(self.chip.cycle + 1)
        return self.chip.cycle - begin

    def result(self) -> int:
        """Both bytes of the result."""
        return self.chip.peek(ADRESH) << 8 | self.chip.peek(ADRESL)


VOLTS = (0.0, 0.0024, 0.0025, 0.65, 1.2345, 2.5, 3.1471, 4.39, 4.9926, 4.9952, 5.0, 5.3)


def _codes(firmware: str) -> list[int]:
    hand = Hand(firmware)
    codes = []
    for volts in VOLTS:
        hand.chip.drive_volts("RA0", volts, 100)
        hand.chip.run(1e-4)
        hand.convert()
        codes.append(hand.result() >> 6)
    return codes


def test_codes_are_the_nearest_of_1024_steps_of_the_supply(program: Program) -> None:
    wanted = [min(math.floor(volts / 5 * 1024 + 0.5), 1023) for volts in VOLTS]
    assert in_new_process(_codes, program("spin")) == wanted


def _formats(firmware: str) -> list[int]:
    hand = Hand(firmware, AN0_TO_AN3 | VREF_PINS)
    hand.chip.drive_volts("RA0", 2.0, 100)
    hand.chip.drive_volts("RA2", 1.0, 100)
    hand.chip.drive_volts("RA3", 3.0, 100)
    hand.chip.run(1e-4)
    hand.chip.write(PIR1, 0)
    cycles = hand.convert()
    left, flag = hand.result(), hand.chip.peek(PIR1) & ADIF
    hand.chip.write(ADCON2, SLOW | RIGHT)
    hand.chip.run(1e-4)
    hand.convert()
    # Given up in the middle: the old result stays.
    hand.chip.drive_volts("RA0", 3.0, 100)
    hand.chip.run(1e-4)
    hand.chip.write(ADCON0, ADON | GO)
    hand.chip.run(1e-5)
    hand.chip.write(ADCON0, ADON)
    hand.chip.run(1e-4)
    return [cycles, left, flag, hand.result()]


def test_it_takes_11_tad_and_knows_references_and_both_formats(program: Program) -> None:
    cycles, left, flag, right = in_new_process(_formats, program("spin"))
    assert cycles == pytest.approx((4 + 11) * TAD + 2, abs=2)
    assert (left, flag, right) == (0x8000, ADIF, 0x0200)


def _acquired(firmware: str, cycles: int, ohms: float) -> float:
    """Volts converted when AN0 at 5 V is selected some cycles after AN1 at 0 V."""
    hand = Hand(firmware, 0x0D, 0x06)
    hand.chip.drive_volts("RA0", 5.0, ohms)
    hand.chip.drive_volts("RA1", 0.0, 10)
    hand.chip.write(ADCON0, ADON | 1 << 2)
    hand.chip.run(1e-4)
    hand.chip.write(ADCON0, ADON)
    hand.chip.run_to(hand.chip.cycle + cycles)
    hand.convert()
    return (hand.result() >> 6) * 5 / 1024


@pytest.mark.parametrize(("cycles", "ohms"), [(2, 10.0), (4, 2500.0), (12, 2500.0), (48, 2500.0)])
def test_the_holding_capacitor_takes_time_to_follow(
    program: Program, cycles: int, ohms: float
) -> None:
    # From selection to the cycle after GO, less 0.2 us of the amplifier; 25 pF through 3 kilohm
    # inside and the source.
    us = max((cycles + 1) / 12 - 0.2, 0.0)
    wanted = 5 * (1 - math.exp(-us / ((3000 + ohms) * 25e-6)))
    found = in_new_process(_acquired, program("spin"), cycles, ohms)
    assert found == pytest.approx(wanted, abs=0.01)
