# SPDX-License-Identifier: Apache-2.0
"""The part in characters: what is where, to scale, with and without braille."""

import math
from pathlib import Path

from tornillo.contour import Point
from tornillo.part import Part
from tornillo.terminal_picture import Picture, shows_braille


def test_the_test_bar_is_drawn_to_scale(test_bar: Path) -> None:
    # 2.1 inch along on 42 columns: 0.05 inch each, and twice that for each row.
    lines = Picture(Part.load(test_bar), 44, 12).lines(braille=False)
    assert len(lines) == 12
    assert lines[5] == "%%" + 40 * "#" + "  "
    assert lines[1] == "%%" + 20 * "#" + 20 * "." + "  "
    thick = [number for number, line in enumerate(lines) if line.endswith("####  ")]
    stock = [number for number, line in enumerate(lines) if "####" in line]
    assert thick == list(range(3, 9))
    assert stock == list(range(1, 11))


def test_braille_shows_the_same_with_dots(test_bar: Path) -> None:
    lines = Picture(Part.load(test_bar), 44, 12).lines()
    assert lines[5][2:42] == 40 * "\N{BRAILLE PATTERN DOTS-12345678}"
    assert lines[1][30] not in (" ", "\N{BRAILLE PATTERN DOTS-12345678}")


def test_tool_and_marks_stand_at_their_places_and_go_again(test_bar: Path) -> None:
    picture = Picture(Part.load(test_bar), 44, 12)
    picture.show(Point(-0.5, 0.3), "tool")
    picture.show(Point(-1.5, math.nan), "mark")
    lines = picture.lines(braille=False)
    assert [(row, line.index("V")) for row, line in enumerate(lines) if "V" in line] == [(3, 32)]
    assert {line.index("+") for line in lines} == {12}
    picture.show(Point(9.0, 9.0), "tool")
    assert picture.lines()[0][43] == "V"
    picture.clear()
    assert not any("V" in line or "+" in line for line in picture.lines())


def test_colours_tell_the_kinds_apart(test_bar: Path) -> None:
    picture = Picture(Part.load(test_bar), 44, 12)
    picture.show(Point(0.0, 0.3), "tool")
    text = picture.text()
    assert text.plain == "\n".join(picture.lines())
    assert {str(span.style) for span in text.spans} >= {"bold cyan", "yellow", "dim", "bold red"}


def test_what_the_terminal_cannot_show_is_known() -> None:
    assert shows_braille("utf-8")
    assert not shows_braille("cp1252")
    assert not shows_braille("nonsense")
    assert not shows_braille(None)
