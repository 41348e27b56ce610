# SPDX-License-Identifier: Apache-2.0
"""Find and open the lathe's serial port.

pyserial is imported when it is needed, so that commands without a port start fast.
"""

import errno
from typing import TYPE_CHECKING

from tornillo.errors import PortError
from tornillo.protocol import USB_PRODUCT_ID, USB_VENDOR_ID

if TYPE_CHECKING:
    from serial import Serial

WRITE_TIMEOUT_S = 1.0


def find_port() -> str:
    """The port of the one lathe that is plugged in.

    Raises PortError when there is none or more than one.
    """
    from serial.tools.list_ports import comports

    found = [port for port in comports() if (port.vid, port.pid) == (USB_VENDOR_ID, USB_PRODUCT_ID)]
    if not found:
        raise PortError(
            f"no lathe found: no port has the USB id {USB_VENDOR_ID:04x}:{USB_PRODUCT_ID:04x}",
            "plug in the USB cable and switch the lathe on, or name the port with --port",
        )
    if len(found) > 1:
        names = ", ".join(f"{port.device} (serial number {port.serial_number})" for port in found)
        raise PortError(f"more than one lathe found: {names}", "choose one with --port")
    return str(found[0].device)


def open_port(name: str) -> "Serial":
    """Open `name` for this program alone.

    Raises PortError, with what to do about it.
    """
    from serial import Serial, SerialException

    try:
        return Serial(name, exclusive=True, write_timeout=WRITE_TIMEOUT_S)
    except SerialException as error:
        raise _explained(name, error) from error


def _explained(name: str, error: OSError) -> PortError:
    """The reason why a port did not open, as far as it can be known."""
    text = str(error)
    if error.errno == errno.EACCES or "Permission" in text or "Access is denied" in text:
        return PortError(
            f"no permission to use {name}",
            "on Linux run `sudo tornillo udev` once and plug the cable in again, or join the group "
            "that owns the port: `sudo usermod -aG dialout $USER`, then log out and in again; "
            "on Windows close the program that uses the port",
        )
    if error.errno == errno.EBUSY or "exclusively lock" in text or "busy" in text.lower():
        return PortError(
            f"{name} is in use by another program",
            "close the other program; right after plugging in, ModemManager may be probing the "
            "port: wait 30 s, or keep it off for good with `sudo tornillo udev`",
        )
    if error.errno in (errno.ENOENT, errno.ENODEV, errno.ENXIO) or "FileNotFound" in text:
        return PortError(
            f"there is no port {name}",
            "check the name, or leave out --port to find the lathe by its USB id",
        )
    return PortError(f"{name} cannot be opened: {text}", "check that it is the lathe's port")
