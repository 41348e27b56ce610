# SPDX-License-Identifier: Apache-2.0
"""Display and keys: what is written is read, what is pressed is measured."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from itertools import accumulate
from pathlib import Path
from xml.etree import ElementTree

import pytest
from PIL import Image
from simulated.processes import branch, on_a_new_chip

from virtual_lathe.chip import CYCLES_PER_SECOND, Chip, NonVolatile, Reset
from virtual_lathe.lathe import Options, VirtualLathe
from virtual_lathe.machine import AxisOptions, Machine
from virtual_lathe.panel import COLUMNS, KEYS, LcdByte, Panel
from virtual_lathe.panel_font import Rows, dots
from virtual_lathe.panel_picture import DARK, DOT, size, squares
from virtual_lathe.worker import in_new_process

Program = Callable[..., str]
ROOT = Path(__file__).resolve().parents[2]
BLANK = " " * COLUMNS
#: What programs/panel.asm shows without a key; the fifth of the second line is no letter.
SHOWN = ("Diámetro 25.4°  ", "A/¥→\N{REPLACEMENT CHARACTER}          8")
#: The program has written everything after 25 ms.
READY_S = 0.04
LEVEL, KEY, STARTS = 0x20, 0x21, 0x22


def fitted(firmware: str) -> tuple[Chip, Panel]:
    """A chip with a panel on it, just switched on."""
    chip = Chip(firmware)
    return chip, Panel(chip, chip.run)


def _text(firmware: str) -> list[object]:
    chip, panel = fitted(firmware)
    seen: list[object] = [panel.lines()]
    chip.run(READY_S)
    glass = panel.glass()
    return [*seen, panel.lines(), glass.codes[0], glass.on, glass.cursor, panel.mistakes]


def test_a_program_wakes_the_display_and_writes_text_and_custom_characters(
    program: Program,
) -> None:
    codes = b"Di\0metro 25.4\xdf  "
    assert in_new_process(_text, program("panel")) == [
        *((BLANK, BLANK), SHOWN, codes, True, False, []),
    ]


def _bytes(firmware: str) -> tuple[list[LcdByte], int]:
    chip, panel = fitted(firmware)
    chip.run(READY_S)
    return panel.take_bytes(), len(panel.take_bytes())


def test_every_byte_has_the_exact_cycle_of_the_fall_of_e(program: Program) -> None:
    found, left = in_new_process(_bytes, program("panel"))
    # D0 to D3 are open, and high, until the display knows that there are none.
    assert [byte.value for byte in found[:9]] == [
        *(0x3F, 0x3F, 0x3F, 0x2F, 0x28, 0x08, 0x01, 0x06, 0x0C),
    ]
    letters = found[10 + 16 + 1 :][:15]
    assert bytes(byte.value for byte in letters) == b"Di\0metro 25.4\xdf"[:14] + b"\xc0"
    # The key's place and the key: 38 us in 455 cycles, and 56 to get there and back.
    place, key = found[-2:]
    assert (place.data, place.value, key.data, key.value) == (False, 0xCF, True, ord("8"))
    assert key.cycle - place.cycle == 455 + 56
    assert left == 0


def _keys(firmware: str) -> list[tuple[int, int]]:
    chip, panel = fitted(firmware)
    chip.run(READY_S)
    measured = []
    for key in KEYS:
        panel.hold(key)
        chip.run(0.02)
        measured.append((chip.peek(LEVEL), chip.peek(KEY)))
        assert panel.lines()[1][-1] == str(chip.peek(KEY))
        panel.release()
        chip.run(0.02)
    assert panel.mistakes == []
    return [*measured, (chip.peek(LEVEL), chip.peek(KEY))]


def test_every_key_has_its_voltage_and_none_has_the_supply(program: Program) -> None:
    design = (ROOT / "hw" / "kicad" / "design" / "panel.py").read_text(encoding="utf-8")
    on_the_board = re.findall(r'\("R\d+", "(\d+)"\)', design)
    assert on_the_board == ["330", "390", "620", "910"]
    ohms = [0, *accumulate([*map(int, on_the_board), 1500, 3000, 9100])]
    # The upper eight of ten bits, behind 2k2.
    levels = [round(1024 * ohm / (2200 + ohm)) >> 2 for ohm in ohms]
    assert levels == [0, 33, 63, 97, 129, 161, 193, 224]
    wanted = list(zip([*levels, 255], range(9), strict=True))
    assert in_new_process(_keys, program("panel")) == wanted


def _press(firmware: str) -> list[object]:
    chip, panel = fitted(firmware)
    chip.run(READY_S)
    before = chip.cycle
    panel.press("left")
    spent = (chip.cycle - before) * 1000 / CYCLES_PER_SECOND
    panel.hold("ok", "right")
    chip.run(0.02)
    both = chip.peek(KEY)
    panel.release()
    try:
        panel.hold("enter")
    except ValueError as error:
        return [round(spent), both, str(error)]
    return []


def test_a_press_takes_its_time_and_of_two_keys_the_lower_one_counts(program: Program) -> None:
    assert in_new_process(_press, program("panel")) == [
        *(150, 3, "no key 'enter': up, down, left, right, ok, back, x-out, x-in"),
    ]


def _convert(chip: Chip) -> tuple[int, int]:
    """One conversion by hand; returns the cycle in which the input was sampled, and ADRESH."""
    adcon2, adcon1, adcon0, adresh = 0xFC0, 0xFC1, 0xFC2, 0xFC4
    chip.write(adcon1, 0x0E)
    chip.write(adcon2, 0x16)
    chip.write(adcon0, 1)
    chip.run(1e-5)
    # 4 TAD of 64 TOSC to acquire, 16 cycles each, from the cycle after.
    sampled = chip.cycle + 1 + 4 * 16
    chip.write(adcon0, 3)
    assert chip.run_until(lambda: not chip.peek(adcon0) & 2, 1e-3, 1e-6)
    return sampled, chip.peek(adresh)


def _voltages(firmware: str) -> list[list[tuple[float, int]]]:
    """Seconds since a key was pressed, or released, and ADRESH."""
    chip, panel = fitted(firmware)
    chip.run(READY_S)
    found = []
    for keys in (("up",), ()):
        panel.hold(*keys)
        begin = chip.cycle
        conversions = []
        for wait in (0.0, 1e-4, 3e-4, 3e-3):
            chip.run(wait)
            conversions.append(_convert(chip))
        found.append([((cycle - begin) / CYCLES_PER_SECOND, level) for cycle, level in conversions])
    return found


def test_the_capacitor_of_the_ladder_makes_changes_slow(program: Program) -> None:
    down, up = in_new_process(_voltages, program("spin"))
    # UP leads to ground: 1k and 100 nF. On the way back 2k2 and 1k charge it.
    for seconds, level in down:
        assert level == pytest.approx(min(256 * math.exp(-seconds / 0.1e-3), 255), abs=1)
    for seconds, level in up:
        assert level == pytest.approx(256 * (1 - math.exp(-seconds / 0.32e-3)), abs=1)


def _bouncing(firmware: str) -> tuple[int, int, int]:
    chip, panel = fitted(firmware)
    machine = Machine(AxisOptions(-30, 3575), AxisOptions(-30, 16072))
    machine.set_switch_quality(bounce_us=5000, noise_hz=0, seed=3)
    chip.run(READY_S)
    panel.hold("up")
    levels = []
    for _ in range(60):
        chip.run(1e-4)
        levels.append(_convert(chip)[1])
    chip.run(0.005)
    turns = sum((a < b) != (b < c) for a, b, c in zip(levels, levels[1:], levels[2:], strict=False))
    return turns, min(levels[:20]), _convert(chip)[1]


def test_keys_bounce_as_long_as_the_switches_do(program: Program) -> None:
    turns, lowest, last = in_new_process(_bouncing, program("spin"))
    assert turns > 4
    assert lowest < 200
    assert last == 0


def _resets(firmware: str) -> list[object]:
    chip, panel = fitted(firmware)
    chip.run(READY_S)
    seen: list[object] = []
    chip.reset(Reset.POWER_ON)
    chip.run(0.01)
    seen.append(panel.lines())
    chip.run(READY_S)
    seen.append(panel.lines())
    # Between any two halves of a byte, or anywhere else.
    for step in range(40):
        chip.reset(Reset.MCLR)
        chip.run(0.0214 + step * 3.1e-6)
    chip.reset(Reset.WATCHDOG)
    seen.append(panel.lines()[0].startswith("D") or panel.lines()[0] == BLANK)
    chip.run(READY_S)
    return [*seen, panel.lines(), panel.mistakes]


def test_a_power_cycle_empties_the_display_and_any_reset_can_be_recovered_from(
    program: Program,
) -> None:
    assert in_new_process(_resets, program("panel")) == [
        *((BLANK, BLANK), SHOWN, True, SHOWN, []),
    ]


def _pressed_key(chip: Chip, panel: Panel) -> tuple[str, int]:
    panel.hold("back")
    chip.run(READY_S)
    return panel.lines()[1][-1], chip.peek(KEY)


@on_a_new_chip
def test_a_branch_has_a_panel_of_its_own(program: Program) -> None:
    chip, panel = fitted(program("panel"))
    chip.run(READY_S)
    assert branch(lambda: _pressed_key(chip, panel)) == ("5", 5)
    assert panel.lines() == SHOWN
    chip.run(READY_S)
    assert panel.lines() == SHOWN
    assert panel.mistakes == []


def _second_power_on(firmware: str) -> list[object]:
    lathe = VirtualLathe(Options(Path(firmware), panel=True, usb=False))
    lathe.run(READY_S)
    memory = lathe.chip.save()
    return [lathe.panel.lines(), in_new_process(_restored, firmware, memory)]


def _restored(firmware: str, memory: NonVolatile) -> list[object]:
    lathe = VirtualLathe(Options(Path(firmware), panel=True, usb=False), memory)
    first = lathe.panel.lines()
    lathe.run(READY_S)
    return [first, lathe.panel.lines(), lathe.panel.mistakes]


def test_a_new_process_begins_with_an_empty_display(program: Program) -> None:
    shown, again = in_new_process(_second_power_on, program("panel"))
    assert shown == SHOWN
    assert again == [(BLANK, BLANK), SHOWN, []]


def _other_firmware(firmware: str) -> list[object]:
    lathe = VirtualLathe(Options(Path(firmware), panel=True, usb=False))
    lathe.run(0.01)
    lathe.panel.press("ok")
    report = lathe.report()
    broken = [check.name for check in lathe.checks() if check.broken]
    return [
        lathe.panel.lines(),
        report["panel"],
        lathe.panel.mistakes,
        "display by the book" in broken,
    ]


def test_a_program_that_never_drives_the_display_leaves_it_empty(program: Program) -> None:
    assert in_new_process(_other_firmware, program("memories")) == [
        *((BLANK, BLANK), [BLANK, BLANK], [], False),
    ]


def _no_panel(firmware: str) -> list[object]:
    lathe = VirtualLathe(Options(Path(firmware), usb=False))
    lathe.run(READY_S)
    try:
        lathe.panel.lines()
    except RuntimeError as error:
        return [str(error), lathe.report()["panel"]]
    return []


def test_without_the_option_there_is_no_panel(program: Program) -> None:
    assert in_new_process(_no_panel, program("panel")) == [
        *("no panel is fitted: Options(panel=True) does it", None),
    ]


def _picture(firmware: str, folder: str) -> tuple[list[list[Rows]], str]:
    chip, panel = fitted(firmware)
    chip.run(READY_S)
    for kind in ("png", "svg"):
        panel.picture(Path(folder) / f"glass.{kind}")
    try:
        panel.picture("glass.gif")
    except ValueError as error:
        return panel.cells(), str(error)
    return panel.cells(), "not refused"


def test_the_picture_shows_every_dot(program: Program, tmp_path: Path) -> None:
    cells, refused = in_new_process(_picture, program("panel"), str(tmp_path))
    assert refused == "glass.gif: a picture of the panel is a .png or a .svg"
    assert cells[0][0] == dots("D")
    assert cells[0][2] == dots("á") == (0x02, 0x04, 0x0E, 0x01, 0x0F, 0x11, 0x0F, 0)
    assert cells[1][4] == (0x15, 0x0A) * 4
    with Image.open(tmp_path / "glass.png") as image:
        assert image.size == size(cells)
        pixels, wide = image.convert("RGB").tobytes(), image.width
    for x, y, colour in squares(cells):
        for at in (y * wide + x, (y + DOT - 1) * wide + x + DOT - 1):
            assert f"#{pixels[3 * at : 3 * at + 3].hex()}" == colour
    root = ElementTree.parse(tmp_path / "glass.svg").getroot()
    lit = next(path for path in root.iter() if path.get("fill") == DARK)
    wanted = sum(row.bit_count() for line in cells for cell in line for row in cell)
    assert lit.get("d", "").count("z") == wanted
