# SPDX-License-Identifier: Apache-2.0
"""Find the lathe among the serial ports, by its USB id, its serial number or the port's name.

pyserial is imported when it is needed, so that commands without a port start fast.
"""

import re
from pathlib import Path
from typing import NamedTuple

from tornillo.errors import InLoaderError, PortError
from tornillo.language import _
from tornillo.protocol import USB_LOADER_PRODUCT_ID, USB_PRODUCT_ID, USB_VENDOR_ID

WINDOWS_NAME = re.compile(r"(?:\\\\[.?]\\)?(COM\d+):?", re.IGNORECASE)
BARE_UNIX_NAME = re.compile(r"tty[A-Z]+\d+|(?:tty|cu)\.\S+")
MACOS_WAITING = "/dev/tty."
MACOS_CALLING = "/dev/cu."


class FoundLathe(NamedTuple):
    """A lathe that is plugged in: the name of its port and its serial number."""

    port: str
    serial_number: str

    def __str__(self) -> str:
        """Both, for a person."""
        return _("{port} (serial number {serial_number})").format(
            port=self.port, serial_number=self.serial_number
        )


def found_lathes() -> list[FoundLathe]:
    """Every lathe that is plugged in, by the name of its port."""
    from serial.tools.list_ports import comports

    return sorted(
        FoundLathe(str(port.device), port.serial_number or "unknown")
        for port in comports()
        if (port.vid, port.pid) == (USB_VENDOR_ID, USB_PRODUCT_ID)
    )


def found_loaders() -> list[str]:
    """The ports of all chips that wait in their boot loader."""
    from serial.tools.list_ports import comports

    return sorted(
        str(port.device)
        for port in comports()
        if (port.vid, port.pid) == (USB_VENDOR_ID, USB_LOADER_PRODUCT_ID)
    )


def port_name(text: str) -> str | None:
    r"""`text` as the name of a port, the way this system opens it; None when it is none.

    Windows: COM3, com3:, \\.\COM12. macOS: /dev/cu.usbmodem1; /dev/tty.usbmodem1 is replaced
    by it, because opening that one waits for a modem. Linux: /dev/ttyACM0, any path. The
    folder /dev may be left out.
    """
    windows = WINDOWS_NAME.fullmatch(text)
    if windows is not None:
        return windows[1].upper()
    name = f"/dev/{text}" if BARE_UNIX_NAME.fullmatch(text) else text
    if name.startswith(MACOS_WAITING):
        return MACOS_CALLING + name.removeprefix(MACOS_WAITING)
    return name if "/" in name or Path(name).exists() else None


def find_port(wanted: str | None = None) -> str:
    """The port that `wanted` names, a port's name or a lathe's serial number; else the only lathe.

    Raises PortError when there is no such lathe, or more than one, InLoaderError when there is
    none but a chip that waits in its boot loader.
    """
    name = None if wanted is None else port_name(wanted)
    if name is not None:
        return name
    plugged = found_lathes()
    if wanted is None:
        found = plugged
    else:
        found = [lathe for lathe in plugged if lathe.serial_number.lower() == wanted.lower()]
    if len(found) > 1:
        raise _several(found)
    if not found:
        waiting = found_loaders()
        if waiting:
            raise InLoaderError(", ".join(waiting))
        raise _none(wanted, plugged)
    return found[0].port


def _none(wanted: str | None, plugged: list[FoundLathe]) -> PortError:
    """No lathe, or not the wanted one."""
    if wanted is None or not plugged:
        return PortError(
            _(
                "no lathe found: no port has the USB id {usb_vendor_id:04x}:{usb_product_id:04x}"
            ).format(usb_vendor_id=USB_VENDOR_ID, usb_product_id=USB_PRODUCT_ID),
            _("plug in the USB cable and switch the lathe on, or name the port with --port"),
        )
    return PortError(
        _("no lathe has the serial number {wanted}, and no port is called so").format(
            wanted=wanted
        ),
        _("plugged in: {plugged}").format(plugged=_listed(plugged)),
    )


def _several(found: list[FoundLathe]) -> PortError:
    """More than one lathe, and how to choose."""
    first = found[0]
    remedy = _("choose one: `tornillo --port {port} ...`").format(port=first.port)
    if len({lathe.serial_number for lathe in found}) == len(found):
        remedy += _(" or `tornillo --port {serial_number} ...`").format(
            serial_number=first.serial_number
        )
    else:
        remedy += _(
            "; to choose by serial number give each its own, `tornillo --port {port} "
            "serial --random`"
        ).format(port=first.port)
    return PortError(_("more than one lathe found: {found}").format(found=_listed(found)), remedy)


def _listed(found: list[FoundLathe]) -> str:
    """Ports and serial numbers in one line."""
    return ", ".join(map(str, found))
