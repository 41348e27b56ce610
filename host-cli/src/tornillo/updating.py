# SPDX-License-Identifier: Apache-2.0
"""Write a program through the boot loader, and compare every byte of it.

The block with the header goes last, so a program that was written in part has none and is never
started: whatever interrupts an update, the chip comes up in its boot loader again.
"""

from collections.abc import Callable

from tornillo.errors import LoaderError
from tornillo.firmware_file import BLOCK, FIRST, HEADER, IDENTITY, Firmware, Header
from tornillo.language import _
from tornillo.loader import (
    LOADER_VERSION,
    PIECE,
    Identity,
    Loader,
    LoaderRefusedError,
    LoaderResult,
)

#: Writing 27 KB takes 3 s, comparing 0.3 s; with a bad cable both no longer than this.
UPDATE_S = 120.0
#: How often a block that was not kept, or a program that does not compare, is written.
BLOCK_TRIES = 3
ROUNDS = 2

#: Is told how many of how many bytes are done; each is written once and compared once.
Progress = Callable[[int, int], None]


def old_version(loader: Loader, identity: Identity) -> str | None:
    """The version of the program in the chip; None when there is no whole one."""
    if not identity.whole:
        return None
    header = Header.unpack(loader.read(identity.first)[: HEADER.size])
    return header.version if header.identity == IDENTITY else None


def check_fits(identity: Identity, firmware: Firmware) -> None:
    """Raise LoaderError when this chip is none that `firmware` was made for."""
    if identity.version != LOADER_VERSION:
        raise LoaderError(
            _("the boot loader speaks version {theirs}, this tornillo version {ours}").format(
                theirs=identity.version, ours=LOADER_VERSION
            ),
            _("use the tornillo version that belongs to this boot loader"),
        )
    if identity.board != firmware.header.board:
        raise LoaderError(
            _("{name} was made for board {board}, and this is board {theirs}").format(
                name=firmware.name, board=firmware.header.board, theirs=identity.board
            ),
            _("take the firmware made for your board; nothing has been changed"),
        )
    if identity.first != FIRST or identity.end < firmware.header.end:
        raise LoaderError(
            _(
                "{name} fills 0x{first:04X} to 0x{end:04X}, and this chip has 0x{theirs:04X} to "
                "0x{limit:04X} for a program"
            ).format(
                name=firmware.name,
                first=FIRST,
                end=firmware.header.end,
                theirs=identity.first,
                limit=identity.end,
            ),
            _("take the firmware of a release made for this boot loader; nothing has been changed"),
        )


def write_whole(loader: Loader, firmware: Firmware, progress: Progress | None = None) -> None:
    """Write the program and compare it, again when it does not compare.

    Raises LoaderError when the loader does not answer, the chip does not keep what is written,
    or UPDATE_S seconds are over. The same again goes on from any of these.
    """
    end = loader.clock() + UPDATE_S
    size = len(firmware.image)
    first, *others = range(0, size, BLOCK)

    def step(done: int) -> None:
        _keep_time(loader, end)
        if progress is not None:
            progress(done, 2 * size)

    wrong: int | None = first
    for _round in range(ROUNDS):
        for count, offset in enumerate((*others, first), start=1):
            _write_block(loader, offset, firmware.image[offset : offset + BLOCK])
            step(count * BLOCK)
        wrong = _difference(loader, firmware.image, step)
        if wrong is None:
            return
    raise LoaderError(
        _("the chip holds something else at 0x{address:04X} than was written").format(
            address=wrong
        ),
        _("try again; if it stays, the supply is weak or the chip is worn out"),
    )


def _difference(loader: Loader, image: bytes, step: Callable[[int], None]) -> int | None:
    """Read everything back; the first address with something else than `image` has."""
    for offset in range(0, len(image), PIECE):
        found = loader.read(FIRST + offset)
        wanted = image[offset : offset + PIECE]
        if found != wanted:
            different = zip(found, wanted, strict=True)
            return FIRST + offset + [is_ != want for is_, want in different].index(True)
        step(len(image) + offset + PIECE)
    return None


def _keep_time(loader: Loader, end: float) -> None:
    """Raise LoaderError when the time is over."""
    if loader.clock() >= end:
        raise LoaderError(
            _("the update is not over after {seconds:g} s: {repeats} requests were lost").format(
                seconds=UPDATE_S, repeats=loader.repeats
            ),
            _("use another USB cable or port, away from motor cables, and try again"),
        )


def _write_block(loader: Loader, offset: int, block: bytes) -> None:
    """Write one block, from its beginning again when the chip did not keep it."""
    for number in range(1, BLOCK_TRIES + 1):
        try:
            for at in range(0, BLOCK, PIECE):
                loader.write(FIRST + offset + at, block[at : at + PIECE])
        except LoaderRefusedError as error:
            if error.result != LoaderResult.NOT_KEPT or number == BLOCK_TRIES:
                raise
        else:
            return
