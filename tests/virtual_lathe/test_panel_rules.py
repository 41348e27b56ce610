# SPDX-License-Identifier: Apache-2.0
"""Every mistake that a program can make with display and A/D converter, made on purpose.

``programs/panel.asm`` is as quick as the data sheets allow, and without a mistake; each symbol
given to the assembler makes it break one rule.
"""

from __future__ import annotations

from collections.abc import Callable

import pytest

from virtual_lathe.chip import Chip
from virtual_lathe.panel import Panel
from virtual_lathe.worker import in_new_process

Program = Callable[..., str]
RUN_S = 0.04


def _mistakes(firmware: str) -> list[str]:
    chip = Chip(firmware)
    panel = Panel(chip, chip.run)
    chip.run(RUN_S)
    return [text.partition(": ")[2] for text in panel.mistakes]


@pytest.mark.parametrize(
    ("symbol", "first"),
    [
        ("POWER_US=.14800", "display: written * us too early, busy with power-on"),
        ("WAKE_1_US=.4000", "display: written * us too early, busy with the wake-up sequence"),
        ("WAKE_2_US=.90", "display: written * us too early, busy with the wake-up sequence"),
        ("WAKE_NIBBLE=0", "display: 0 in step 2 of the wake-up sequence, 3 wanted"),
        ("NO_WAKE=1", "display: 2 in step 1 of the wake-up sequence, 3 wanted"),
        ("SHORT_PULSE=1", "display: E high for 167 ns, 230 ns wanted"),
        ("FAST_PULSES=1", "display: 417 ns from E to E, 500 ns wanted"),
        ("RS_WITH_E=1", "display: RS set less than 40 ns before E"),
        ("RS_DROPS=1", "display: RS changed while E was high"),
        ("DIRECTIONS=0x0B", "display: E falls while D4 to D7 or RS are not driven"),
        ("INSTRUCTION_US=.30", "display: written * us too early, busy with the last byte"),
        ("DATA_US=.34", "display: written * us too early, busy with the last byte"),
        ("CLEAR_US=.1490", "display: written * us too early, busy with clear or home"),
        ("LOWER_FIRST=1", "display: written before the function was set"),
        ("NO_FUNCTION=1", "display: written before the function was set"),
        ("FUNCTION=0x20", "display: function set 0x20 is not for two lines of 5x8 dots"),
        ("FUNCTION=0x2C", "display: function set 0x2c is not for two lines of 5x8 dots"),
        ("NO_CLEAR=1", "display: switched on before it was cleared"),
        ("NO_ENTRY=1", "display: data before the entry mode was set"),
        ("NO_ADDRESS=1", "display: DDRAM has no address 0x28"),
        ("NOTHING=1", "display: 0x00 is no instruction"),
        ("CONVERTER=0x12", "A/D: TAD is 0.67 us, 0.7 to 25 us wanted"),
        ("ANALOGUE=0x0F", "A/D: AN0 is not analogue"),
        ("GO_WITH_ON=1", "A/D: GO set in the write that switches it on"),
        (
            "OTHER_CHANNEL=1",
            "A/D: * us to acquire AN0, which needs 1.97 us, 3 TAD after the last conversion",
        ),
        (
            "CONVERTER=0x06",
            "A/D: 0.17 us to acquire AN0, which needs 1.97 us, 3 TAD after the last conversion",
        ),
        ("OTHER_SETTING=1", "A/D: ADCON1 or ADCON2 changed during a conversion"),
        ("OTHER_CHANNEL_LATE=1", "A/D: channel changed during a conversion"),
    ],
)
def test_a_mistake_is_seen(program: Program, symbol: str, first: str) -> None:
    found = in_new_process(_mistakes, program("panel", symbol))
    before, _, after = first.partition("*")
    assert found
    assert found[0].startswith(before)
    assert found[0].endswith(after)


def test_lines_cannot_change_without_waking_the_display_again(program: Program) -> None:
    assert in_new_process(_mistakes, program("panel", "TWO_FUNCTIONS=1")) == [
        "display: function set 0x20 is not for two lines of 5x8 dots",
        "display: lines changed without a wake-up sequence",
    ]


@pytest.mark.parametrize("symbol", ["CONVERTER=0x0E", "INSTRUCTION_US=.37"])
def test_what_is_just_right_is_no_mistake(program: Program, symbol: str) -> None:
    # The converter with 2 TAD to acquire.
    assert in_new_process(_mistakes, program("panel", symbol)) == []
