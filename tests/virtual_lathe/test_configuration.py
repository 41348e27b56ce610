# SPDX-License-Identifier: Apache-2.0
"""Configuration words from the hex file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from virtual_lathe.configuration import read_configuration, wrong_words

Program = Callable[[str], str]


def test_words_are_read_and_the_wrong_ones_named(program: Program) -> None:
    firmware = program("two_priorities")
    found = read_configuration(firmware)
    assert found[0] & 0x3F == 0x04
    assert found[1] & 0x0F == 0x0E
    # USBDIV=1 and VREGEN=OFF are not written in that program.
    assert [text.split(":")[0] for text in wrong_words(firmware)] == ["USBDIV", "VREGEN"]


def test_a_damaged_hex_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.hex"
    path.write_text(":0400000000EF00F01E\n", encoding="ascii")
    with pytest.raises(ValueError, match=r"x\.hex:1"):
        read_configuration(path)
