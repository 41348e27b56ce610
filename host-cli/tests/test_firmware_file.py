# SPDX-License-Identifier: Apache-2.0
"""Hex files of firmware: what is in a good one, and why the others are refused, with the line."""

import re
from pathlib import Path

import pytest
from babel.messages.pofile import read_po
from hex_files import (
    FIRST_LINE,
    LINE,
    SIZE,
    firmware_file,
    hex_file,
    lines,
    program,
    record,
)

from tornillo import language
from tornillo.errors import FirmwareError
from tornillo.firmware_file import BLOCK, CONFIGURATION, FIRST, Firmware
from tornillo.frames import crc16
from tornillo.intel_hex import read_hex
from tornillo.protocol import PROTOCOL_VERSION

DOCS = Path(__file__).resolve().parents[2] / "docs"
CATALOGUE = language.LOCALE / "es" / "LC_MESSAGES" / "tornillo.po"
GOOD = lines(program())
DAMAGED = "get it again, or make it anew with `make firmware`"
OURS = "give the file that `make firmware` leaves at build/firmware/tornillo.hex"


def refusal(path: Path) -> FirmwareError:
    """Why the file is refused; its message begins with the file."""
    with pytest.raises(FirmwareError) as caught:
        Firmware.load(str(path))
    assert str(caught.value).startswith(f"{path}:")
    return caught.value


def changed(number: int, *new: str) -> list[str]:
    """The lines of a good program, line `number` replaced by `new`."""
    return [*GOOD[: number - 1], *new, *GOOD[number:]]


def test_a_good_file_is_taken_apart(tmp_path: Path) -> None:
    firmware = Firmware.load(str(firmware_file(tmp_path)))
    code = program()
    assert (firmware.header.version, firmware.header.board) == ("0.2.0", 1)
    assert firmware.header.protocol == PROTOCOL_VERSION
    assert firmware.size == SIZE
    assert firmware.image[:SIZE] == code
    assert len(firmware.image) % BLOCK == 0
    assert set(firmware.image[SIZE:]) == {0xFF}
    assert (firmware.has_loader, firmware.has_configuration) == (True, True)


def test_the_program_alone_will_do(tmp_path: Path) -> None:
    firmware = Firmware.load(str(hex_file(tmp_path, GOOD)))
    assert (firmware.has_loader, firmware.has_configuration) == (False, False)


def test_small_letters_empty_lines_and_other_line_ends_do_no_harm(tmp_path: Path) -> None:
    path = tmp_path / "new.hex"
    text = "\r\n".join([*GOOD, "", ":00000001FF", "", ""]).lower()
    path.write_bytes(text.encode("ascii"))
    assert Firmware.load(str(path)).image[:SIZE] == program()


def test_left_out_bytes_that_are_erased_in_the_chip_are_not_missing(tmp_path: Path) -> None:
    code = bytearray(program())
    code[8 * LINE : 9 * LINE] = b"\xff" * LINE
    code[:2] = crc16(bytes(code[2:])).to_bytes(2, "little")
    text = lines(bytes(code))
    del text[FIRST_LINE - 1 + 8]
    assert Firmware.load(str(hex_file(tmp_path, text))).image[:SIZE] == bytes(code)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        (changed(5, GOOD[4][:-3]), 5, "pairs of 0 to 9 and A to F"),
        (changed(5, GOOD[4][:-4]), 5, "the line has 19 bytes, but should have 21"),
        (changed(5, ":"), 5, "the line has 0 bytes, but should have 5"),
        (changed(5, GOOD[4] + "00"), 5, "the line has 22 bytes, but should have 21"),
        (changed(5, GOOD[4].replace("0", "G", 1)), 5, "pairs of 0 to 9 and A to F"),
        (changed(6, ":02083000ABCD00"), 6, "the checksum is wrong: 00, but 4E fits the line"),
        (changed(5, record(0, 3, bytes(4))), 5, "a record of type 3 with 4 bytes"),
        (changed(5, record(0, 4, bytes(3))), 5, "a record of type 4 with 3 bytes"),
        (changed(5, record(0, 1, b"\0")), 5, "a record of type 1 with 1 bytes"),
        ([*GOOD, ":00000001FF"], len(GOOD) + 2, "there is more behind the end record"),
        ([*GOOD, GOOD[6]], len(GOOD) + 1, "the byte at 0x0850 has been told before, in line 7"),
        ([*GOOD, record(0xFFFF, 0, b"12")], len(GOOD) + 1, "runs beyond the 64 KB"),
    ],
)
def test_a_damaged_line_is_refused_by_its_number(
    tmp_path: Path, text: list[str], line: int, message: str
) -> None:
    path = hex_file(tmp_path, text)
    error = refusal(path)
    assert str(error).startswith(f"{path}:{line}: ")
    assert message in str(error)
    assert DAMAGED in error.remedy


def test_a_file_without_its_end_record_is_refused(tmp_path: Path) -> None:
    for kept in (len(GOOD), 10, 0):
        path = tmp_path / "short.hex"
        path.write_text("\n".join(GOOD[:kept]), encoding="ascii")
        error = refusal(path)
        assert str(error) == (
            f"{path}:{kept + 1}: the file is cut short: its end record (:00000001FF) is missing"
        )
        assert DAMAGED in error.remedy


@pytest.mark.parametrize("content", [b"#include <avr.h>\n", b"\x7fELF\x90\xff\xfe", b"S1130000\n"])
def test_another_kind_of_file_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "other.hex"
    path.write_bytes(content)
    error = refusal(path)
    assert str(error) == f"{path}:1: this is no line of an Intel hex file"
    assert error.remedy == OURS


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    error = refusal(tmp_path / "none.hex")
    assert "none.hex: the file cannot be read: No such file or directory" in str(error)
    assert "check its name" in error.remedy
    assert "the file cannot be read: Is a directory" in str(refusal(tmp_path))


@pytest.mark.parametrize("lost", [FIRST_LINE + 1, FIRST_LINE + 10, len(GOOD)])
def test_a_lost_line_is_refused_naming_the_one_before(tmp_path: Path, lost: int) -> None:
    path = hex_file(tmp_path, changed(lost))
    error = refusal(path)
    missing = FIRST + (lost - FIRST_LINE) * LINE
    assert str(error) == (
        f"{path}:{lost - 1}: behind this line bytes are missing at 0x{missing:04X}"
    )
    assert DAMAGED in error.remedy


def test_a_changed_byte_with_a_right_checksum_is_found_by_the_crc(tmp_path: Path) -> None:
    code = bytearray(program())
    crc = int.from_bytes(code[:2], "little")
    code[300] ^= 0x10
    path = hex_file(tmp_path, lines(bytes(code)))
    error = refusal(path)
    assert str(error) == (
        f"{path}:{FIRST_LINE}: the program is not whole: its CRC should be {crc:04X}"
    )
    assert DAMAGED in error.remedy


@pytest.mark.parametrize("first", [0x0000, 0x0900, 0x2000])
def test_a_file_with_nothing_where_the_program_begins_is_foreign(
    tmp_path: Path, first: int
) -> None:
    path = hex_file(tmp_path, lines(bytes(32), first))
    error = refusal(path)
    assert str(error) == (
        f"{path}:1: this is no firmware of a Tornillo: there is nothing at 0x0800, where the "
        "program begins"
    )
    assert error.remedy == OURS


def test_the_firmware_of_something_else_is_foreign(tmp_path: Path) -> None:
    path = hex_file(tmp_path, lines(program(identity=b"Tornilla")))
    error = refusal(path)
    assert str(error) == (
        f"{path}:{FIRST_LINE}: this is no firmware of a Tornillo: the identity "
        '"Tornillo" is not at 0x0808'
    )
    assert error.remedy == OURS


def test_a_firmware_for_another_board_is_refused(tmp_path: Path) -> None:
    path = hex_file(tmp_path, lines(program(board=2)))
    error = refusal(path)
    assert str(error) == (
        f"{path}:{FIRST_LINE + 1}: it was made for board 2; this tornillo knows board 1"
    )
    assert "take the firmware made for your board" in error.remedy


@pytest.mark.parametrize("end", [0x0814, 0x08FE, 0x0A63, 0x8000, 0xFFFF])
def test_an_impossible_end_is_refused(tmp_path: Path, end: int) -> None:
    code = bytearray(program())
    code[2:4] = end.to_bytes(2, "little")
    path = hex_file(tmp_path, lines(bytes(code)))
    error = refusal(path)
    assert str(error) == (
        f"{path}:{FIRST_LINE}: the program is said to end at 0x{end:04X}, which cannot be"
    )
    assert DAMAGED in error.remedy


@pytest.mark.parametrize("address", [FIRST + SIZE, 0x7800, 0x7FFF, 0x8000, 0x200000, 0xF00000])
def test_bytes_outside_the_program_are_refused(tmp_path: Path, address: int) -> None:
    more = lines(b"\x00", address)
    path = hex_file(tmp_path, GOOD, more)
    error = refusal(path)
    assert str(error) == (
        f"{path}:{len(GOOD) + 2}: there are bytes at 0x{address:04X}, behind the end of the "
        f"program at 0x{FIRST + SIZE:04X}: stored parts or settings could be there"
    )
    assert "not one that was read out of a chip" in error.remedy


def test_addresses_are_those_of_the_chip(tmp_path: Path) -> None:
    found = read_hex(str(firmware_file(tmp_path)))
    assert {at for at in found.bytes if at >= 0x8000} == set(CONFIGURATION)
    assert found.lines[FIRST] == 7


@pytest.mark.parametrize(
    ("page", "heading", "number"),
    [
        ("flashing.md", "## Files that are refused", 0),
        ("es/actualizar.md", "## Archivos rechazados", 1),
    ],
)
def test_the_pages_quote_what_is_said(page: str, heading: str, number: int) -> None:
    section = (DOCS / page).read_text(encoding="utf-8").split(heading)[1].split("\n## ")[0]
    quoted = re.findall(r'"([^"]+)"', section)
    with CATALOGUE.open("rb") as file:
        said = [(str(message.id), str(message.string))[number] for message in read_po(file)]
    assert len(quoted) == 10
    assert [words for words in quoted if not any(words in text for text in said)] == []
