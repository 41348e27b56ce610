# SPDX-License-Identifier: Apache-2.0
"""A firmware as `tornillo flash` writes it: the program of a hex file, checked whole.

The program begins with a header; what it is and how the chip uses it: docs/protocol.md, section
"The boot loader". The file may hold more: the boot loader itself, which is never written over
USB, and the configuration words of the chip, which only a programmer can write.
"""

from dataclasses import dataclass
from struct import Struct

from tornillo.errors import FirmwareError
from tornillo.frames import crc16
from tornillo.intel_hex import HexFile, damaged, read_hex
from tornillo.language import _

IDENTITY = b"Tornillo"
#: The controller boards that this tornillo knows.
BOARDS = (1,)
FIRST = 0x0800
#: The loader starts no program that ends before or behind these.
ENDS = range(0x0900, 0x8000, 2)
CONFIGURATION = range(0x300000, 0x30000E)
#: CRC, end, four bytes of program, identity, board, version (three bytes), protocol.
HEADER = Struct("<HH4x8sBBBBB")
CRC_BYTES, IDENTITY_AT, BOARD_AT = 2, 8, 16
#: The loader erases so many bytes at a time.
BLOCK = 64
ERASED = 0xFF


@dataclass(frozen=True)
class Header:
    """What a program tells about itself. `end` is the address behind its last byte."""

    crc: int
    end: int
    identity: bytes
    board: int
    version: str
    protocol: int

    @classmethod
    def unpack(cls, data: bytes) -> "Header":
        """Read it from the first bytes of a program."""
        crc, end, identity, board, *version, protocol = HEADER.unpack_from(data)
        return cls(crc, end, identity, board, ".".join(map(str, version)), protocol)


@dataclass(frozen=True)
class Firmware:
    """A program that may be written. `image` begins at FIRST and fills whole blocks."""

    name: str
    header: Header
    image: bytes
    has_loader: bool
    has_configuration: bool

    @property
    def size(self) -> int:
        """Bytes of the program."""
        return self.header.end - FIRST

    @classmethod
    def load(cls, name: str) -> "Firmware":
        """Read the hex file `name`.

        Raises FirmwareError, naming file and line, when it is damaged, cut short, or no firmware
        of a Tornillo.
        """
        return cls.from_hex(read_hex(name))

    @classmethod
    def from_hex(cls, file: HexFile) -> "Firmware":
        """Check the bytes of a hex file; raises FirmwareError as `load`."""
        header = _header(file)
        _refuse_strangers(file, header)
        used = bytes(file.bytes.get(at, ERASED) for at in range(FIRST, header.end))
        if crc16(used[CRC_BYTES:]) != header.crc:
            raise _wrong_crc(file, header)
        image = used + bytes([ERASED]) * (-len(used) % BLOCK)
        below = any(address < FIRST for address in file.bytes)
        configured = any(address in CONFIGURATION for address in file.bytes)
        return cls(file.name, header, image, below, configured)


def _header(file: HexFile) -> Header:
    """The header of the program, if it is that of a Tornillo."""
    places = range(FIRST, FIRST + HEADER.size)
    if FIRST not in file.bytes:
        what = _("there is nothing at 0x{first:04X}, where the program begins")
        raise _foreign(file, 1, what.format(first=FIRST))
    missing = next((at for at in places if at not in file.bytes), None)
    if missing is not None:
        raise _gap(file, missing)
    header = Header.unpack(bytes(file.bytes[at] for at in places))
    if header.identity != IDENTITY:
        what = _('the identity "Tornillo" is not at 0x{at:04X}').format(at=FIRST + IDENTITY_AT)
        raise _foreign(file, file.lines[FIRST + IDENTITY_AT], what)
    if header.board not in BOARDS:
        raise FirmwareError(
            _(
                "{name}:{line}: it was made for board {board}; this tornillo knows board {known}"
            ).format(
                name=file.name,
                line=file.lines[FIRST + BOARD_AT],
                board=header.board,
                known=", ".join(map(str, BOARDS)),
            ),
            _("take the firmware made for your board, or the tornillo of the same release"),
        )
    if header.end not in ENDS:
        what = _("the program is said to end at 0x{end:04X}, which cannot be")
        raise damaged(file.name, file.lines[FIRST], what.format(end=header.end))
    return header


def _refuse_strangers(file: HexFile, header: Header) -> None:
    """Raise FirmwareError for a byte that is neither program, loader nor configuration."""
    for address, line in file.lines.items():
        if address >= header.end and address not in CONFIGURATION:
            raise FirmwareError(
                _(
                    "{name}:{line}: there are bytes at 0x{address:04X}, behind the end of the "
                    "program at 0x{end:04X}: stored parts or settings could be there"
                ).format(name=file.name, line=line, address=address, end=header.end),
                _(
                    "take a file as `make firmware` leaves it (build/firmware/tornillo.hex), not "
                    "one that was read out of a chip"
                ),
            )


def _wrong_crc(file: HexFile, header: Header) -> FirmwareError:
    """The bytes are not those that the header was made for; perhaps some are missing."""
    gap = next((at for at in range(FIRST, header.end) if at not in file.bytes), None)
    if gap is not None:
        return _gap(file, gap)
    what = _("the program is not whole: its CRC should be {crc:04X}").format(crc=header.crc)
    return damaged(file.name, file.lines[FIRST], what)


def _gap(file: HexFile, address: int) -> FirmwareError:
    """A line has been lost; the one in front of it is named."""
    what = _("behind this line bytes are missing at 0x{at:04X}").format(at=address)
    return damaged(file.name, file.lines[max(at for at in file.lines if at < address)], what)


def _foreign(file: HexFile, line: int, what: str) -> FirmwareError:
    """The program of something else."""
    return FirmwareError(
        _("{name}:{line}: this is no firmware of a Tornillo: {what}").format(
            name=file.name, line=line, what=what
        ),
        _("give the file that `make firmware` leaves at build/firmware/tornillo.hex"),
    )
