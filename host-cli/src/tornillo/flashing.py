# SPDX-License-Identifier: Apache-2.0
"""Give the chip another firmware: into the boot loader, write, compare, and back.

The version that a chip tells in HELLO and the request LOADER are the same in every version of
the protocol, so any firmware with a boot loader can be replaced.
"""

import time
from collections.abc import Callable
from contextlib import suppress
from enum import Enum, auto
from typing import TypeVar

from tornillo import loader as boot_loader
from tornillo import versions
from tornillo.chips import Chip, Kind, beside, ports_of
from tornillo.errors import (
    ChipError,
    LinkError,
    LoaderError,
    NoAnswerError,
    PortError,
    TornilloError,
)
from tornillo.firmware_file import Firmware
from tornillo.language import _
from tornillo.link import Link
from tornillo.loader import Loader, LoaderRefusedError
from tornillo.opening import Notify, open_port
from tornillo.protocol import LOADER_MAGIC, REQUESTS, Command, ErrorCode
from tornillo.updating import Progress, check_fits, old_version, write_whole
from tornillo.versions import Told

#: The chip leaves the bus 50 ms after its answer; it needs a second or two to come back.
LEAVES_S = 0.3
COMES_BACK_S = 15.0
RETRY_S = 0.25

Found = TypeVar("Found")


class Stage(Enum):
    """How far an update has come; what an interruption means depends on it."""

    UNTOUCHED = auto()  # the old firmware runs
    ENTERING = auto()  # the chip was told to go into its boot loader
    IN_LOADER = auto()  # the chip waits for the new one
    WRITTEN = auto()  # the new one is whole and has been started


class Update:
    """One update of `chip` to `firmware`.

    `stage` tells how far it is; `before` the old version, None when there was no whole one;
    `after` what the lathe tells about itself in the end, `port` where.
    """

    def __init__(self, firmware: Firmware, chip: Chip, notify: Notify | None = None) -> None:
        """Nothing happens before `run`; `notify` hears why it takes longer."""
        self.firmware = firmware
        self.stage = Stage.UNTOUCHED
        self.before: str | None = None
        self.after: Told | None = None
        self.port = chip.port
        self._chip = chip
        self._others = beside(chip)
        self._notify = notify

    def run(self, progress: Progress | None = None) -> None:
        """Do all of it.

        Raises PortError when the chip cannot be reached, ChipError or LinkError when it says
        no, does not answer or does not come back.
        """
        loader = self._enter()
        try:
            self.stage = Stage.IN_LOADER
            identity = loader.identify()
            try:
                check_fits(identity, self.firmware)
            except LoaderError:
                if identity.whole:
                    _start(loader)
                    self.stage = Stage.UNTOUCHED
                raise
            self.before = self.before or old_version(loader, identity)
            write_whole(loader, self.firmware, progress)
            _start(loader)
        finally:
            loader.close()
        self.stage = Stage.WRITTEN
        self._meet_again()

    def _enter(self) -> Loader:
        """The boot loader of the chip, which runs its firmware or waits in the loader already."""
        if self._chip.kind is Kind.LOADER:
            return _loader_at(self._chip.port, self._notify)
        serial = open_port(self._chip.port, self._notify)
        link = Link(serial)
        try:
            self.before = _told(link).firmware
        except NoAnswerError as error:
            if boot_loader.answers(serial):
                return Loader(serial)
            link.close()
            raise versions.no_hello(self._chip.port, error) from error
        except (ChipError, LinkError):
            link.close()
            raise
        try:
            # Whether it went although its answer got lost is seen by who comes.
            with suppress(LinkError):
                link.request(Command.LOADER, REQUESTS[Command.LOADER].pack(LOADER_MAGIC))
        except ChipError as error:
            raise _explained(error, self.before) from error
        finally:
            link.close()
        self.stage = Stage.ENTERING
        time.sleep(LEAVES_S)
        return self._wait(Kind.LOADER, _loader_at)

    def _meet_again(self) -> None:
        """Wait for the lathe and hear what it says about itself."""
        time.sleep(LEAVES_S)
        self.port, self.after = self._wait(Kind.LATHE, _hello_at)
        wanted = self.firmware.header.version
        if self.after.firmware != wanted:
            raise LinkError(
                _("the lathe says that its firmware is {told}, not {wanted}").format(
                    told=self.after.firmware, wanted=wanted
                ),
                _("see `tornillo doctor`; then try again"),
            )

    def _wait(self, kind: Kind, reach: Callable[[str], Found]) -> Found:
        """Try to `reach` the chip as `kind` until it is back.

        Raises LinkError after COMES_BACK_S seconds, with the last reason why it was not reached.
        """
        end = time.monotonic() + COMES_BACK_S
        last: TornilloError | None = None
        while time.monotonic() < end:
            for port in ports_of(self._chip, kind, self._others):
                try:
                    return reach(port)
                except (LinkError, PortError) as error:
                    last = error
            time.sleep(RETRY_S)
        raise _missing(kind, last) from last


def _told(link: Link) -> Told:
    """What the chip tells in HELLO; raises VersionError when it tells no version."""
    try:
        found = versions.told(link.request(Command.HELLO))
    except ChipError as error:
        raise versions.refused_hello(error.code.name) from error
    if found is None:
        raise versions.silent_hello()
    return found


def _explained(error: ChipError, version: str) -> TornilloError:
    """Why the chip does not go into its boot loader."""
    if error.code is ErrorCode.BUSY:
        return TornilloError(
            _("the lathe is at work: its firmware can only be changed while it is at rest"),
            _("let it finish, or end it with `tornillo stop`; then type the same command again"),
        )
    if error.code is ErrorCode.UNKNOWN_COMMAND:
        return TornilloError(
            _("the firmware {version} has no boot loader").format(version=version),
            _(
                "burn build/firmware/tornillo.hex once with a PIC programmer (docs/flashing.md); "
                "from then on `tornillo flash` does it"
            ),
        )
    return error


def _start(loader: Loader) -> None:
    """Start the program; whether it runs is seen when the lathe is back."""
    try:
        loader.go()
    except LoaderError as error:
        # Without an answer it may have left before that was read.
        if isinstance(error, LoaderRefusedError):
            raise


def _missing(kind: Kind, last: TornilloError | None) -> LinkError:
    """The chip did not come back as `kind`; `last`: why it was not reached when last tried."""
    if kind is Kind.LOADER:
        message = _("the boot loader does not appear within {seconds:g} s{why}")
        remedy = _(
            "type the same command again; if it stays, hold HOLD at the lathe while you switch "
            "it on, which leads into the boot loader too"
        )
    else:
        message = _("the new firmware is written, but the lathe is not back in {seconds:g} s{why}")
        remedy = _("switch the lathe off and on, then see `tornillo doctor`")
    if isinstance(last, PortError):
        remedy = last.remedy
    why = "" if last is None else f": {last}"
    return LinkError(message.format(seconds=COMES_BACK_S, why=why), remedy)


def _loader_at(port: str, notify: Notify | None = None) -> Loader:
    """The boot loader at a port; raises LoaderError when none answers there."""
    loader = Loader(open_port(port, notify))
    try:
        loader.identify()
    except LoaderError:
        loader.close()
        raise
    return loader


def _hello_at(port: str) -> tuple[str, Told]:
    """Where the lathe is, and what it tells."""
    link = Link(open_port(port))
    try:
        return port, _told(link)
    finally:
        link.close()
