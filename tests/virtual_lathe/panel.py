# SPDX-License-Identifier: Apache-2.0
"""Display and keys of the panel; the work is done in native/lcd.cc, lcd_bus.cc and keys.cc.

The display is an HD44780 with two lines of sixteen characters, the keys are a ladder of resistors
on the analogue input RA0.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from .chip import CYCLES_PER_SECOND, Chip
from .native_library import LcdByteC, LcdStateC, library
from .panel_font import CUSTOM_CODES, HEIGHT, Rows, custom_letter, dots, rom_letter

#: In the order of the ladder: of two pressed at once the earlier one counts.
KEYS = ("up", "down", "left", "right", "ok", "back", "x-out", "x-in")
LINES, COLUMNS = 2, 16
#: Characters of DDRAM behind a line; the glass is a window on them.
STORED = 40
PRESS_S, REST_S = 0.1, 0.05
#: Frequency of the display's own clock: typical, and the slowest its data sheet allows.
TYPICAL_KHZ, SLOWEST_KHZ = 270.0, 190.0
#: A blinking character is black this long, then visible as long: 102,400 periods of the clock.
BLINK_S = 102.4 / TYPICAL_KHZ
_TEXT_BYTES = 256
_BATCH = 4096
_FULL_CELL: Rows = (0x1F,) * HEIGHT
_CURSOR_ROW = 0x1F


@dataclass(frozen=True)
class Glass:
    """What the display holds: characters by code, and where the cursor is."""

    #: Codes of the two lines as they are seen, whether the display is on or not.
    codes: tuple[bytes, bytes]
    #: Rows of dots of the eight custom characters.
    custom: tuple[Rows, ...]
    on: bool
    cursor: bool
    blink: bool
    #: Line and column of the cursor, None when it is outside of the glass or in CGRAM.
    place: tuple[int, int] | None
    #: Bytes taken since power came.
    writes: int


@dataclass(frozen=True)
class LcdByte:
    """One byte to the display, with the cycle of the fall of E that completed it."""

    cycle: int
    data: bool
    value: int


class Panel:
    """The panel on the pins of the chip of this process.

    Args:
        run: lets simulated seconds pass, with all that belongs to it.
        oscillator_khz: the display's own clock; the slower, the longer it is busy.
    """

    def __init__(
        self, chip: Chip, run: Callable[[float], object], oscillator_khz: float = TYPICAL_KHZ
    ) -> None:
        """Wire display and keys, with power just coming."""
        self._chip = chip
        self._run = run
        self._native = library()
        self._native.vl_lcd_attach(oscillator_khz)
        self._native.vl_keys_attach()

    # -- keys -------------------------------------------------------------------------------------

    def hold(self, *keys: str) -> None:
        """Keep these keys pressed, and no others; time stands still.

        Raises:
            ValueError: no such key.
        """
        for key in keys:
            if key not in KEYS:
                raise ValueError(f"no key {key!r}: {', '.join(KEYS)}")
        self._native.vl_keys_hold(sum(1 << KEYS.index(key) for key in set(keys)))

    def release(self) -> None:
        """Take the fingers off all keys; time stands still."""
        self.hold()

    def press(self, key: str, seconds: float = PRESS_S) -> None:
        """Press a key for some simulated time, release it and rest for 50 ms.

        Raises:
            ValueError: no such key.
        """
        self.hold(key)
        self._run(seconds)
        self.release()
        self._run(REST_S)

    # -- display ----------------------------------------------------------------------------------

    def glass(self) -> Glass:
        """Return what the display holds."""
        state = LcdStateC()
        self._native.vl_lcd_read(ctypes.byref(state))
        ddram, cgram = bytes(state.ddram), bytes(state.cgram)
        first, second = (
            bytes(ddram[line * STORED + (state.shift + i) % STORED] for i in range(COLUMNS))
            for line in range(LINES)
        )
        line, at = divmod(int(state.address), STORED)
        column = (at - state.shift) % STORED
        seen = column < COLUMNS and not state.in_cgram
        return Glass(
            (first, second if state.two_lines else b" " * COLUMNS),
            tuple(tuple(cgram[i : i + HEIGHT]) for i in range(0, len(cgram), HEIGHT)),
            bool(state.on),
            bool(state.cursor),
            bool(state.blink),
            (line, column) if seen else None,
            int(state.writes),
        )

    def lines(self) -> tuple[str, str]:
        """Return the two lines as they are read, sixteen letters each; spaces when it is off.

        A custom character is the letter whose dots were loaded into it; dots that nobody has drawn
        in ``panel_font.py`` are U+FFFD.
        """
        glass = self.glass()
        if not glass.on:
            return " " * COLUMNS, " " * COLUMNS
        first, second = (
            "".join(
                custom_letter(glass.custom[code % len(glass.custom)])
                if code < CUSTOM_CODES
                else rom_letter(code)
                for code in codes
            )
            for codes in glass.codes
        )
        return first, second

    def take_bytes(self) -> list[LcdByte]:
        """Return and forget the bytes that the display has taken so far, those lost left out."""
        entries = (LcdByteC * _BATCH)()
        found: list[LcdByte] = []
        while count := self._native.vl_lcd_bytes(entries, _BATCH):
            found += [LcdByte(e.cycle, bool(e.data), e.value) for e in entries[:count]]
        return found

    def cells(self) -> list[list[Rows]]:
        """Return the dots of every cell of both lines as they are seen now, cursor included."""
        glass = self.glass()
        if not glass.on:
            return [[(0,) * HEIGHT] * COLUMNS] * LINES
        cells = [[self._dots(glass, code) for code in codes] for codes in glass.codes]
        if glass.place is not None:
            line, column = glass.place
            rows = cells[line][column]
            if glass.cursor:
                cells[line][column] = (*rows[:-1], _CURSOR_ROW)
            if glass.blink and self._chip.cycle // round(BLINK_S * CYCLES_PER_SECOND) % 2 == 0:
                cells[line][column] = _FULL_CELL
        return cells

    @staticmethod
    def _dots(glass: Glass, code: int) -> Rows:
        if code < CUSTOM_CODES:
            return glass.custom[code % len(glass.custom)]
        return dots(rom_letter(code))

    def picture(self, path: Path | str) -> None:
        """Draw the glass dot by dot, as ``.png`` or ``.svg``.

        Raises:
            ValueError: another kind of file.
        """
        from .panel_picture import draw_glass

        draw_glass(self.cells(), Path(path))

    # -- judgement --------------------------------------------------------------------------------

    @property
    def mistakes(self) -> list[str]:
        """What the firmware did that the data sheets of display and A/D converter forbid."""
        found = []
        for ask in (self._native.vl_lcd_mistake, self._native.vl_adc_mistake):
            line = ctypes.create_string_buffer(_TEXT_BYTES)
            index = 0
            while ask(index, line, _TEXT_BYTES) == 0:
                found.append(line.value.decode())
                index += 1
        return found
