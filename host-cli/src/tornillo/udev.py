# SPDX-License-Identifier: Apache-2.0
"""The udev rule that lets everybody at the computer use the lathe and keeps modem daemons off."""

import shutil
import subprocess
import sys
from pathlib import Path

from tornillo.errors import PortError
from tornillo.protocol import USB_PRODUCT_ID, USB_VENDOR_ID

#: Before 73-seat-late.rules, which gives tagged devices to whoever sits at the computer.
RULE_NAME = "70-tornillo.rules"
RULES_FOLDER = Path("/etc/udev/rules.d")
_IDS = '{field}{{idVendor}}=="{vendor:04x}", {field}{{idProduct}}=="{product:04x}"'


def _rule() -> str:
    """The rule's text: one line for the device, one for its port."""
    ids = {"vendor": USB_VENDOR_ID, "product": USB_PRODUCT_ID}
    device, port = (_IDS.format(field=field, **ids) for field in ("ATTR", "ATTRS"))
    return (
        "# Tornillo lathe: usable without being root, left alone by ModemManager.\n"
        f'ACTION!="remove", SUBSYSTEM=="usb", {device}, ENV{{ID_MM_DEVICE_IGNORE}}="1"\n'
        f'ACTION!="remove", SUBSYSTEM=="tty", {port}, ENV{{ID_MM_PORT_IGNORE}}="1", '
        'TAG+="uaccess", GROUP="dialout", MODE="0660"\n'
    )


RULE = _rule()
RELOAD = (("udevadm", "control", "--reload"), ("udevadm", "trigger", "--subsystem-match=tty"))


def install_rule(folder: Path = RULES_FOLDER) -> Path:
    """Write the rule into `folder`, have udev read it, and return its path.

    Raises PortError when that is not allowed or the computer has no udev.
    """
    path = folder / RULE_NAME
    if not folder.is_dir():
        raise PortError(
            f"there is no {folder}: this computer has no udev",
            "only Linux needs the rule; elsewhere the port can be used as it is",
        )
    try:
        path.write_text(RULE, encoding="ascii")
    except PermissionError as error:
        raise PortError(
            f"no permission to write {path}", f"run `sudo {Path(sys.argv[0]).absolute()} udev`"
        ) from error
    if folder == RULES_FOLDER and shutil.which("udevadm"):
        for command in RELOAD:
            subprocess.run(command, check=False)
    return path
