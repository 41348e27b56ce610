# SPDX-License-Identifier: Apache-2.0
"""The chip among the ports while its firmware changes: as lathe, as boot loader, as lathe again.

USB knows the two apart by their ids, and that both are in the same socket. A port that USB does
not know, like that of a virtual lathe, serves both: there the answers tell.
"""

import os
from enum import Enum, auto
from typing import NamedTuple

from tornillo.errors import PortError
from tornillo.language import _
from tornillo.ports import FoundLathe, find_port, port_name
from tornillo.protocol import USB_LOADER_PRODUCT_ID, USB_PRODUCT_ID, USB_VENDOR_ID


class Kind(Enum):
    """What is at a port."""

    LATHE = auto()
    LOADER = auto()
    UNKNOWN = auto()


class Chip(NamedTuple):
    """A chip: its port, what it is now, its serial number, and the socket it is plugged into.

    The socket is empty where the system does not tell it.
    """

    port: str
    kind: Kind
    serial_number: str
    socket: str

    def __str__(self) -> str:
        """Where and what, for a person."""
        if self.kind is Kind.LOADER:
            return _("{port} (boot loader)").format(port=self.port)
        return str(FoundLathe(self.port, self.serial_number))


KINDS = {USB_PRODUCT_ID: Kind.LATHE, USB_LOADER_PRODUCT_ID: Kind.LOADER}


def plugged_in() -> list[Chip]:
    """Every chip that USB knows, by the name of its port."""
    from serial.tools.list_ports import comports

    found = [
        Chip(
            str(port.device),
            KINDS[port.pid],
            port.serial_number or "",
            # Behind the colon stands the interface, which need not be the same in both.
            (port.location or "").split(":")[0],
        )
        for port in comports()
        if port.vid == USB_VENDOR_ID and port.pid in KINDS
    ]
    return sorted(found, key=lambda chip: chip.port)


def find_chip(wanted: str | None = None) -> Chip:
    """The chip that `wanted` names by port or serial number; else the only one.

    A boot loader has no serial number: an update that was interrupted goes on with the only
    loader there is. Raises PortError when there is no such chip, or more than one.
    """
    chips = plugged_in()
    name = None if wanted is None else port_name(wanted)
    if name is not None:
        names = (name, os.path.realpath(name))
        unknown = Chip(name, Kind.UNKNOWN, "", "")
        return next((chip for chip in chips if chip.port in names), unknown)
    found = chips
    if wanted is not None:
        found = [chip for chip in chips if chip.serial_number.lower() == wanted.lower()]
        found = found or [chip for chip in chips if chip.kind is Kind.LOADER]
    if len(found) > 1:
        raise PortError(
            _("more than one chip found: {found}").format(found=", ".join(map(str, found))),
            _("choose one: `tornillo --port {port} flash ...`").format(port=found[0].port),
        )
    # Without any, the words are those of every other command.
    return found[0] if found else Chip(find_port(wanted), Kind.UNKNOWN, "", "")


def beside(chip: Chip) -> frozenset[str]:
    """The ports of all other chips that are plugged in."""
    return frozenset(other.port for other in plugged_in() if other.port != chip.port)


def ports_of(chip: Chip, kind: Kind, others: frozenset[str]) -> list[str]:
    """Where `chip` may be found now, if it has become `kind`.

    Where the system tells no sockets it is the one that was not there before, among `others`.
    """
    if chip.kind is Kind.UNKNOWN:
        return [chip.port]
    found = [now for now in plugged_in() if now.kind is kind]
    if chip.socket:
        return [now.port for now in found if now.socket == chip.socket]
    return [now.port for now in found if now.port not in others]
