# SPDX-License-Identifier: Apache-2.0
"""What the display's instructions do, with the test in the place of the firmware."""

from __future__ import annotations

from collections.abc import Callable

from virtual_lathe.chip import Chip, Reset
from virtual_lathe.panel import BLINK_S, COLUMNS, SLOWEST_KHZ, TYPICAL_KHZ, Panel
from virtual_lathe.panel_font import dots
from virtual_lathe.worker import in_new_process

Program = Callable[..., str]
LATA, LATE, TRISA, TRISE = 0xF89, 0xF8D, 0xF92, 0xF96
E = 2
HOME, CLEAR, INCREMENT, DECREMENT = 0x02, 0x01, 0x06, 0x04
ON, OFF, CURSOR, BLINK = 0x0C, 0x08, 0x0E, 0x0D
SECOND_LINE = 0x80 + 0x40


class Hand:
    """Writes to the display as a careful firmware does, 2 us between any two changes."""

    def __init__(self, firmware: str, khz: float = TYPICAL_KHZ) -> None:
        """Switch on, wake the display and set it up: cleared, on, no cursor."""
        self.chip = Chip(firmware)
        self.panel = Panel(self.chip, self.chip.run, khz)
        self.slow = TYPICAL_KHZ / khz
        self.chip.run(0.016)
        self.wake()
        self.instruct(0x28, OFF, CLEAR, INCREMENT, ON)

    def wake(self) -> None:
        """The sequence that every reset of the chip needs."""
        self.set(TRISA, 0x03)
        self.set(TRISE, 0)
        for nibble, wait in ((3, 4.2e-3), (3, 1.2e-4), (3, 4e-5), (2, 4e-5)):
            self.nibble(nibble)
            self.chip.run(wait * self.slow)

    def set(self, register: int, value: int) -> None:
        """Write a register and let 2 us pass."""
        self.chip.write(register, value)
        self.chip.run(2e-6)

    def nibble(self, nibble: int, data: int = 0) -> None:
        """Half a byte."""
        self.set(LATE, data)
        self.set(LATA, nibble << 2)
        self.set(LATE, data | E)
        self.set(LATE, data)

    def byte(self, value: int, data: int = 0) -> None:
        """One byte, without waiting for the display."""
        self.nibble(value >> 4, data)
        self.nibble(value & 15, data)

    def instruct(self, *values: int) -> None:
        """Instructions, each with its time."""
        for value in values:
            self.byte(value)
            self.chip.run((1.53e-3 if value < 4 else 4e-5) * self.slow)

    def write(self, text: str) -> None:
        """Characters of the ROM."""
        for letter in text:
            self.byte(ord(letter), data=1)
            self.chip.run(4.2e-5 * self.slow)


def _addresses(firmware: str) -> list[object]:
    hand = Hand(firmware)
    hand.write("abcdefghijklmnopqrstuvwxyzabcdefghijklmnNEXT")
    seen: list[object] = [hand.panel.lines()]
    hand.instruct(SECOND_LINE + 0x27)
    hand.write("zAB")
    seen.append(hand.panel.lines()[0])
    hand.instruct(DECREMENT, SECOND_LINE + 1)
    hand.write("321")
    hand.instruct(0x07 + 0x80 + 0x20, INCREMENT)
    seen.append(hand.panel.lines()[1])
    return [*seen, hand.panel.mistakes]


def test_lines_are_forty_characters_long_and_lead_into_each_other(program: Program) -> None:
    assert in_new_process(_addresses, program("spin")) == [
        ("abcdefghijklmnop", "NEXT            "),
        "ABcdefghijklmnop",
        "23XT            ",
        [],
    ]


def _shifted(firmware: str) -> list[object]:
    hand = Hand(firmware)
    hand.write("0123456789abcdefghij")
    hand.instruct(SECOND_LINE)
    hand.write("second")
    hand.instruct(0x18, 0x18)
    seen: list[object] = [hand.panel.lines()]
    hand.instruct(0x1C, 0x1C, 0x1C)
    seen.append(hand.panel.lines())
    hand.instruct(HOME)
    seen.append(hand.panel.lines()[0])
    # Entry mode with shift: the cursor stands still, the text moves.
    hand.instruct(0x07, 0x80 + 16)
    hand.write("XY")
    seen.append(hand.panel.lines()[0])
    hand.instruct(0x05)
    hand.write("Z")
    seen += [hand.panel.lines()[0], hand.panel.mistakes]
    return seen


def test_the_glass_is_a_window_that_shifts_over_both_lines(program: Program) -> None:
    assert in_new_process(_shifted, program("spin")) == [
        ("23456789abcdefgh", "cond            "),
        (" 0123456789abcde", " second         "),
        "0123456789abcdef",
        "23456789abcdefXY",
        "123456789abcdefX",
        [],
    ]


def _cursor(firmware: str) -> list[object]:
    hand = Hand(firmware)
    hand.instruct(CURSOR, SECOND_LINE + 3)
    panel = hand.panel
    seen: list[object] = [panel.glass().place, panel.cells()[1][3]]
    hand.instruct(0x14)
    seen.append(panel.glass().place)
    hand.instruct(0x10, 0x10, BLINK)
    seen.append(panel.glass().place)
    black = 0
    for _ in range(40):
        hand.chip.run(BLINK_S / 10)
        black += panel.cells()[1][2] == (0x1F,) * 8
    hand.instruct(0x40)
    outside: list[object] = [panel.glass().place]
    hand.instruct(0x80 + 20)
    outside.append(panel.glass().place)
    hand.instruct(OFF)
    return [*seen, black, outside, panel.lines(), panel.cells()[0][0], panel.mistakes]


def test_the_cursor_is_a_line_a_blinking_character_is_black_half_of_the_time(
    program: Program,
) -> None:
    assert in_new_process(_cursor, program("spin")) == [
        *((1, 3), (0, 0, 0, 0, 0, 0, 0, 0x1F), (1, 4), (1, 2)),
        *(20, [None, None], (" " * COLUMNS, " " * COLUMNS), (0,) * 8, []),
    ]


def _custom(firmware: str) -> list[object]:
    hand = Hand(firmware)
    letters = "ñÁ¿⌀"
    hand.instruct(0x40)
    for letter in letters:
        for row in dots(letter):
            hand.byte(row | 0xE0, data=1)
            hand.chip.run(4.2e-5)
    hand.instruct(0x80)
    hand.write("\0\1\2\3\x08\x0b\xff\x1f")
    seen: list[object] = [hand.panel.lines()[0].rstrip()]
    # One dot more, and it is no letter any more.
    hand.instruct(0x40 + 7)
    hand.byte(1, data=1)
    hand.chip.run(4.2e-5)
    return [*seen, hand.panel.lines()[0][:2], hand.panel.glass().custom[0][7], hand.panel.mistakes]


def test_custom_characters_are_the_letters_whose_dots_they_have(program: Program) -> None:
    assert in_new_process(_custom, program("spin")) == [
        *("ñÁ¿⌀ñ⌀█\N{REPLACEMENT CHARACTER}", "\N{REPLACEMENT CHARACTER}Á", 1, []),
    ]


def _again(firmware: str) -> list[object]:
    hand = Hand(firmware)
    hand.write("old")
    # Once more without a reset, as against interference: what is shown stays.
    hand.wake()
    hand.instruct(0x28, ON)
    seen: list[object] = [hand.panel.lines()[0].rstrip(), hand.panel.mistakes]
    # Half a byte is lost by a reset of the chip, that of the display is still open.
    hand.nibble(4, data=1)
    hand.chip.reset(Reset.MCLR)
    hand.wake()
    hand.instruct(0x28, OFF, CLEAR, INCREMENT, ON)
    hand.write("new")
    return [*seen, hand.panel.lines()[0].rstrip(), hand.panel.mistakes]


def test_it_can_be_woken_up_at_any_time(program: Program) -> None:
    assert in_new_process(_again, program("spin")) == ["old", [], "new", []]


def _slow(firmware: str, wait: float) -> list[str]:
    hand = Hand(firmware, SLOWEST_KHZ)
    hand.byte(CURSOR)
    hand.chip.run(wait)
    hand.byte(ON)
    return [text.partition(": ")[2] for text in hand.panel.mistakes]


def test_the_slowest_clock_of_a_display_takes_longer(program: Program) -> None:
    # 37 us at 270 kHz are 52.6 us at 190 kHz; the next byte takes 14 us itself.
    assert in_new_process(_slow, program("spin"), 46e-6) == []
    early = in_new_process(_slow, program("spin"), 37e-6)
    assert len(early) == 1
    assert "busy with the last byte" in early[0]


def _too_early(firmware: str) -> list[object]:
    hand = Hand(firmware)
    for letter in "ab":
        hand.byte(ord(letter), data=1)
    hand.chip.run(1e-4)
    hand.write("c")
    return [hand.panel.lines()[0].rstrip(), len(hand.panel.mistakes)]


def test_what_comes_while_the_display_is_busy_is_lost(program: Program) -> None:
    # Both halves of the b.
    assert in_new_process(_too_early, program("spin")) == ["ac", 2]


def _both_at_once(firmware: str) -> list[str]:
    hand = Hand(firmware)
    hand.set(LATE, E)
    # No time in between: as if one instruction wrote both ports.
    hand.chip.write(LATA, 0x14)
    hand.chip.write(LATE, 0)
    hand.chip.run(2e-6)
    hand.set(LATE, 1)
    hand.set(LATE, 1 | E)
    hand.chip.write(LATE, 0)
    hand.chip.run(2e-6)
    return [text.partition(": ")[2] for text in hand.panel.mistakes]


def test_data_and_rs_must_stand_still_when_e_falls(program: Program) -> None:
    assert in_new_process(_both_at_once, program("spin")) == [
        "display: data set less than 80 ns before E falls",
        "display: RS changed while E was high",
    ]
