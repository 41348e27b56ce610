# SPDX-License-Identifier: Apache-2.0
"""Open the lathe's port for this program alone, and explain why it did not open."""

import errno
import sys
import time
from collections.abc import Callable
from enum import Enum, auto
from pathlib import Path
from typing import TYPE_CHECKING

from tornillo import udev
from tornillo.errors import PortError
from tornillo.holders import MODEM_MANAGER, holders, modem_manager_runs
from tornillo.language import _
from tornillo.protocol import FRAME_TIMEOUT_MS

if TYPE_CHECKING:
    from serial import Serial

#: How long a port that is held for a moment is tried again, and how often, in seconds.
PATIENCE_S = 5.0
RETRY_S = 0.25
#: A port that has been there for less is being set up by the system, in seconds.
JUST_PLUGGED_S = 3.0
WRITE_TIMEOUT_S = FRAME_TIMEOUT_MS / 1000

#: Takes a line that tells a person why it takes longer.
Notify = Callable[[str], None]


class Trouble(Enum):
    """Why a port did not open."""

    PERMISSION = auto()
    HELD = auto()  # by a program that lets nobody else open it
    LOCKED = auto()  # by a program that asked for it alone, as tornillo does
    MISSING = auto()
    OTHER = auto()


def open_port(name: str, notify: Notify | None = None) -> "Serial":
    """Open the port `name` for this program alone.

    A port that ModemManager is trying out, or that the system is still setting up, is tried
    again for PATIENCE_S seconds; `notify` is told so once.

    Raises PortError, with what to do about it.
    """
    from serial import Serial, SerialException

    end = time.monotonic() + PATIENCE_S
    while True:
        try:
            return Serial(name, exclusive=True, write_timeout=WRITE_TIMEOUT_S)
        except SerialException as error:
            reason = _passing(name, _trouble(error))
            if reason is None or time.monotonic() >= end:
                raise _explained(name, error) from error
        if notify is not None:
            notify(
                _("{reason}; trying for {patience_s:g} s").format(
                    reason=reason, patience_s=PATIENCE_S
                )
            )
            notify = None
        time.sleep(RETRY_S)


def _trouble(error: OSError) -> Trouble:
    """What a failure of pyserial means; on Windows it has no number, only a text."""
    text = str(error)
    if "exclusively lock" in text:
        return Trouble.LOCKED
    if error.errno == errno.EBUSY or "PermissionError(13" in text:
        return Trouble.HELD
    if error.errno in (errno.EACCES, errno.EPERM):
        return Trouble.PERMISSION
    if error.errno in (errno.ENOENT, errno.ENODEV, errno.ENXIO) or "FileNotFoundError" in text:
        return Trouble.MISSING
    return Trouble.OTHER


def _passing(name: str, trouble: Trouble) -> str | None:
    """Why `trouble` may be over in a moment; None when it will stay."""
    if not sys.platform.startswith("linux"):
        return None
    if trouble is Trouble.PERMISSION and _just_plugged(name):
        return _("{name} is still being set up by the system").format(name=name)
    if trouble is Trouble.HELD:
        known = {holder.name for holder in holders(name)}
        if known <= {MODEM_MANAGER} and (known or modem_manager_runs() or _just_plugged(name)):
            return _("{name} is in use: ModemManager may be trying whether it is a modem").format(
                name=name
            )
    return None


def _just_plugged(name: str) -> bool:
    """Whether the port has been there for a moment only."""
    try:
        return 0 <= time.time() - Path(name).stat().st_ctime < JUST_PLUGGED_S
    except OSError:
        return False


def _explained(name: str, error: OSError) -> PortError:
    """The reason why a port did not open, as far as it can be known."""
    trouble = _trouble(error)
    if trouble is Trouble.PERMISSION:
        return _no_permission(name)
    if trouble in (Trouble.HELD, Trouble.LOCKED):
        return _in_use(name)
    if trouble is Trouble.MISSING:
        return PortError(
            _("there is no port {name}").format(name=name),
            _("check the name, or leave out --port to find the lathe by its USB id"),
        )
    return PortError(
        _("{name} cannot be opened: {error}").format(name=name, error=error),
        _("check that it is the lathe's port"),
    )


def _in_use(name: str) -> PortError:
    """Another program has the port; which one, if this system tells."""
    found = holders(name)
    if any(holder.name == MODEM_MANAGER for holder in found):
        return PortError(
            _("{name} is in use by ModemManager, which tries whether it is a modem").format(
                name=name
            ),
            _(
                "make it leave the lathe alone: `{command}`, then plug the cable in again; "
                "or wait half a minute"
            ).format(command=udev.COMMAND),
        )
    if found:
        return PortError(
            _("{name} is in use by another program: {list}").format(
                name=name, list=", ".join(map(str, found))
            ),
            _("close that program, then try again"),
        )
    remedy = _("close the other program (a terminal, another tornillo), then try again")
    if sys.platform.startswith("linux"):
        remedy += _(
            "; right after plugging in, ModemManager may be trying the port: wait half "
            "a minute, or make it leave the lathe alone with `{command}`"
        ).format(command=udev.COMMAND)
    return PortError(_("{name} is in use by another program").format(name=name), remedy)


def _no_permission(name: str) -> PortError:
    """The port belongs to others."""
    message = _("no permission to use {name}{name2}").format(name=name, name2=_owner(name))
    if not sys.platform.startswith("linux"):
        return PortError(message, _("see who may with `ls -l {name}`").format(name=name))
    group = _("or join the group that may: `sudo usermod -aG dialout $USER`, then log in again")
    if udev.installed():
        return PortError(
            message,
            _("the udev rule is there: plug the cable out and in again, {group}").format(
                group=group
            ),
        )
    return PortError(
        message,
        _("install the udev rule: `{command}`, then plug the cable in again; {group}").format(
            command=udev.COMMAND, group=group
        ),
    )


def _owner(name: str) -> str:
    """Whose the port is, where the system tells."""
    try:
        path = Path(name)
        return _(", which belongs to {owner} and the group {group}").format(
            owner=path.owner(), group=path.group()
        )
    except (OSError, KeyError, NotImplementedError):
        return ""
