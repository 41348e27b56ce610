# SPDX-License-Identifier: Apache-2.0
"""Read an Intel hex file, strictly: a file that is damaged anywhere is refused with its line.

A line is `:`, then bytes in hexadecimal: how many bytes of data, address (high byte first), type,
data, checksum; all of them add up to 0 modulo 256. Type 0 is data, 1 the end of the file, 4 the
upper half of the addresses that follow ("Intel Hexadecimal Object File Format", revision A,
1988). Other types do not occur in files for a PIC.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from tornillo.errors import FirmwareError
from tornillo.language import _

DATA, END, UPPER_ADDRESS = 0, 1, 4
#: Count, address, type and checksum.
FRAME_BYTES = 5
PAGE = 0x10000


class HexFile(NamedTuple):
    """Bytes by their address, and the line that each of them stands in."""

    name: str
    bytes: dict[int, int]
    lines: dict[int, int]


class _Record(NamedTuple):
    """One line taken apart."""

    line: int
    address: int
    type: int
    data: bytes


def damaged(name: str, line: int, what: str) -> FirmwareError:
    """The refusal of a file that is not as it was made."""
    return FirmwareError(
        f"{name}:{line}: {what}",
        _(
            "the file was damaged on its way: get it again, or make it anew with `make firmware` "
            "(build/firmware/tornillo.hex)"
        ),
    )


def read_hex(name: str) -> HexFile:
    """Read the file `name`.

    Raises FirmwareError, naming the line, for a file that cannot be read, is no Intel hex file,
    is damaged or has lost its end.
    """
    found = HexFile(name, {}, {})
    base = 0
    ended = False
    record = _Record(0, 0, DATA, b"")
    for record in _records(name):
        if ended:
            raise damaged(name, record.line, _("there is more behind the end record"))
        if record.type == DATA:
            _place(found, base, record)
        elif record.type == END and not record.data:
            ended = True
        elif record.type == UPPER_ADDRESS and len(record.data) == 2:
            base = int.from_bytes(record.data, "big") * PAGE
        else:
            what = _("a record of type {type} with {size} bytes does not belong here")
            size = len(record.data)
            raise damaged(name, record.line, what.format(type=record.type, size=size))
    if not ended:
        what = _("the file is cut short: its end record (:00000001FF) is missing")
        raise damaged(name, record.line + 1, what)
    return found


def _records(name: str) -> Iterator[_Record]:
    """Every line of the file that is not empty."""
    for number, text in enumerate(_lines(name), start=1):
        if text.strip():
            yield _record(name, number, text.strip())


def _lines(name: str) -> list[str]:
    """The lines of the file."""
    try:
        return Path(name).read_text(encoding="ascii").splitlines()
    except OSError as error:
        raise FirmwareError(
            _("{name}: the file cannot be read: {strerror}").format(
                name=name, strerror=error.strerror
            ),
            _("check its name; `make firmware` leaves it at build/firmware/tornillo.hex"),
        ) from error
    except UnicodeDecodeError as error:
        raise _no_hex_file(name, 1) from error


def _no_hex_file(name: str, line: int) -> FirmwareError:
    """Something else than an Intel hex file."""
    return FirmwareError(
        _("{name}:{line}: this is no line of an Intel hex file").format(name=name, line=line),
        _("give the file that `make firmware` leaves at build/firmware/tornillo.hex"),
    )


def _record(name: str, line: int, text: str) -> _Record:
    """Take one line apart."""
    if not text.startswith(":"):
        raise _no_hex_file(name, line)
    try:
        raw = bytes.fromhex(text[1:])
    except ValueError as error:
        what = _("after the colon there is something else than pairs of 0 to 9 and A to F")
        raise damaged(name, line, what) from error
    wanted = raw[0] + FRAME_BYTES if raw else FRAME_BYTES
    if len(raw) != wanted:
        what = _("the line has {found} bytes, but should have {wanted}")
        raise damaged(name, line, what.format(found=len(raw), wanted=wanted))
    if sum(raw) & 0xFF:
        what = _("the checksum is wrong: {found:02X}, but {wanted:02X} fits the line")
        right = -sum(raw[:-1]) & 0xFF
        raise damaged(name, line, what.format(found=raw[-1], wanted=right))
    return _Record(line, int.from_bytes(raw[1:3], "big"), raw[3], raw[4:-1])


def _place(found: HexFile, base: int, record: _Record) -> None:
    """Add the bytes of a data record."""
    if record.address + len(record.data) > PAGE:
        what = _("the line runs beyond the 64 KB that it may fill")
        raise damaged(found.name, record.line, what)
    for offset, byte in enumerate(record.data):
        address = base + record.address + offset
        if address in found.bytes:
            what = _("the byte at 0x{address:04X} has been told before, in line {line}")
            told = what.format(address=address, line=found.lines[address])
            raise damaged(found.name, record.line, told)
        found.bytes[address] = byte
        found.lines[address] = record.line
