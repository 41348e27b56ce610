# SPDX-License-Identifier: Apache-2.0
"""The parts that the chip keeps: store, read, choose and delete them.

`tornillo.Lathe` is such a store; it brings the link.
"""

from collections.abc import Callable
from typing import Any

from tornillo.errors import ChipError, LinkError, TornilloError
from tornillo.frames import crc16
from tornillo.image import ImageError, PartImage
from tornillo.language import _
from tornillo.protocol import (
    UPLOAD_PIECE_MAX,
    Command,
    ErrorCode,
    HelloData,
    PartInfoData,
    UploadCommitData,
)
from tornillo.stored import StoredPart

Progress = Callable[[int, int], None]


class PartStore:
    """The part store of a lathe. `hello` is what the chip told about itself."""

    hello: HelloData

    def _request(self, command: Command, *values: int | bytes, data: bytes = b"") -> bytes:
        """Send a request and return the data of the response."""
        raise NotImplementedError

    def _numbers(self, command: Command, *values: int) -> tuple[Any, ...]:
        """Send a request and take its response apart."""
        raise NotImplementedError

    def upload(self, image: bytes, progress: Progress | None = None) -> int:
        """Store a part image and return its slot.

        `progress(sent, total)` is called after each piece. Raises ChipError with reason and
        operation when the chip refuses the part, LinkError when it stored something else.
        """
        crc = crc16(image)
        self._request(Command.UPLOAD_BEGIN, len(image), crc)
        for offset in range(0, len(image), UPLOAD_PIECE_MAX):
            piece = image[offset : offset + UPLOAD_PIECE_MAX]
            self._request(Command.UPLOAD_DATA, offset, data=piece)
            if progress is not None:
                progress(offset + len(piece), len(image))
        stored = UploadCommitData(*self._numbers(Command.UPLOAD_COMMIT))
        if stored.crc != crc:
            raise LinkError(
                _(
                    "the chip stored another part than was sent (CRC {crc:04x}, not {crc2:04x})"
                ).format(crc=stored.crc, crc2=crc),
                _("upload it again; if it stays, the chip's memory is worn out"),
            )
        return stored.slot

    def part(self, slot: int) -> StoredPart | None:
        """What is in `slot`; None when it is empty."""
        info = PartInfoData(*self._numbers(Command.PART_INFO, slot))
        return StoredPart.from_info(slot, info) if info.present else None

    def parts(self) -> list[StoredPart]:
        """Every stored part, by slot."""
        found = (self.part(slot) for slot in range(self.hello.slots))
        return [part for part in found if part is not None]

    def find(self, name: str) -> StoredPart:
        """The newest stored part called `name`, or the part in the slot of that number.

        Raises TornilloError, naming the parts there are, when there is none.
        """
        parts = self.parts()
        named = [part for part in parts if part.name == name]
        numbered = [part for part in parts if str(part.slot) == name]
        found = max(named, key=lambda part: part.generation, default=None)
        if found is None and numbered:
            found = numbered[0]
        if found is None:
            stored = ", ".join(part.name for part in parts) or "none"
            raise TornilloError(
                _("no part called {name!r} is stored in the lathe").format(name=name),
                _(
                    "stored are: {stored}; upload it with `tornillo upload`, or see `tornillo "
                    "parts`"
                ).format(stored=stored),
            )
        return found

    def read(self, slot: int) -> bytes:
        """The image of the part in `slot`."""
        part = self.part(slot)
        image = b""
        while part is not None and len(image) < part.length:
            piece = self._request(Command.PART_READ, slot, len(image))
            if not piece:
                break
            image += piece
        if part is None or len(image) != part.length or crc16(image) != part.crc:
            raise ChipError(Command.PART_READ, ErrorCode.NO_PART)
        return image

    def image(self, slot: int) -> PartImage:
        """The part in `slot` in steps; raises LinkError when it is none that this host knows."""
        try:
            return PartImage.unpack(self.read(slot))
        except ImageError as error:
            raise LinkError(
                _("the part in slot {slot} cannot be understood: {error}").format(
                    slot=slot, error=error
                ),
                _("use the tornillo version that it was uploaded with"),
            ) from error

    def select(self, slot: int) -> None:
        """Make the part in `slot` the one that the RUN button cuts."""
        self._request(Command.PART_SELECT, slot)

    def delete(self, slot: int) -> None:
        """Empty `slot`."""
        self._request(Command.PART_DELETE, slot)
