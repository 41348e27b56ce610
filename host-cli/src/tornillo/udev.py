# SPDX-License-Identifier: Apache-2.0
"""The udev rule that lets a user of Linux open the lathe's port and keeps ModemManager away."""

import shutil
import subprocess
import sys
from pathlib import Path

from tornillo.errors import TornilloError
from tornillo.language import _

RULE_FILE = "60-tornillo.rules"
RULES_FOLDER = Path("etc/udev/rules.d")
ROOT = Path("/")
#: What a person types to install the rule; sudo has a PATH of its own.
COMMAND = 'sudo "$(command -v tornillo)" udev --install'
UDEVADM = "udevadm"
UDEVADM_S = 10.0
RELOAD = (("control", "--reload"), ("trigger", "--subsystem-match=tty"))


def rule() -> str:
    """The text of the rule."""
    return (Path(__file__).parent / RULE_FILE).read_text(encoding="utf-8")


def place(root: Path = ROOT) -> Path:
    """Where the rule belongs in the system at `root`."""
    return root / RULES_FOLDER / RULE_FILE


def installed(root: Path = ROOT) -> bool:
    """Whether this version of the rule is in the system at `root`."""
    try:
        return place(root).read_text(encoding="utf-8") == rule()
    except OSError:
        return False


def install(root: Path = ROOT) -> Path:
    """Write the rule into the system at `root`, have udev read it, and return where it is.

    The rights hold at once in the running system, ModemManager stays away from a lathe that is
    plugged in afterwards. Raises TornilloError when it cannot be written, or no udev would read
    it, with what to do.
    """
    if not sys.platform.startswith("linux"):
        raise TornilloError(
            _("only Linux has udev"), _("nothing to do: the port can be used as it is")
        )
    path = place(root)
    if root == ROOT and not path.parent.is_dir() and shutil.which(UDEVADM) is None:
        raise TornilloError(
            _("there is no {parent}: this computer has no udev").format(parent=path.parent),
            _("no rule can help; give the user the right to open the port in another way"),
        )
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(rule(), encoding="utf-8")
    except PermissionError as error:
        raise TornilloError(
            _("this user may not write {path}").format(path=path),
            _("type `{command}`").format(command=COMMAND),
        ) from error
    except OSError as error:
        raise TornilloError(
            _("{path} cannot be written: {strerror}").format(path=path, strerror=error.strerror),
            _("print the rule with `tornillo udev` and put it there by hand"),
        ) from error
    if root == ROOT:
        _reload()
    return path


def _reload() -> None:
    """Have a running udev read its rules and go over the ports; else it does when it starts."""
    program = shutil.which(UDEVADM)
    if program is not None:
        for words in RELOAD:
            command = [program, *words]
            subprocess.run(command, capture_output=True, timeout=UDEVADM_S, check=False)
