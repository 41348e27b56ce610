# SPDX-License-Identifier: Apache-2.0
"""The CDC port as a pseudo-terminal, so that any program opens it like a serial port."""

from __future__ import annotations

import os
import termios
import tty
from pathlib import Path
from typing import Protocol

CHUNK = 1024


class BytePort(Protocol):
    """What the terminal needs of a host: :class:`virtual_lathe.usb_host.UsbHost` has it."""

    port_open: bool

    def send(self, data: bytes) -> int:
        """Take bytes for the device; returns how many."""

    def receive(self, room: int = 4096) -> bytes:
        """Give at most ``room`` bytes that came from the device."""


class Terminal:
    """A raw pseudo-terminal joined to the serial port of a host.

    Bytes wait on both sides when the other is slow; nothing is lost. While the cable is out what
    is written to the terminal stays in it, as in the buffer of a stopped modem.

    Args:
        link: a symbolic link to make to the terminal, replaced if it is one already.
    """

    def __init__(self, host: BytePort, link: Path | None = None) -> None:
        """Open the terminal and make the link."""
        self._host = host
        self._link = link
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave, termios.TCSANOW)
        os.set_blocking(self._master, False)
        self._to_device = b""
        self._to_program = b""
        self.name = os.ttyname(self._slave)
        if link is not None:
            if link.is_symlink():
                link.unlink()
            link.parent.mkdir(parents=True, exist_ok=True)
            link.symlink_to(self.name)

    def exchange(self) -> bool:
        """Move what can be moved in both directions; True when anything was."""
        if not self._host.port_open:
            return False
        moved = False
        if not self._to_device:
            try:
                self._to_device = os.read(self._master, CHUNK)
            except BlockingIOError:
                self._to_device = b""
        if self._to_device:
            taken = self._host.send(self._to_device)
            self._to_device = self._to_device[taken:]
            moved = taken > 0
        if not self._to_program:
            self._to_program = self._host.receive(CHUNK)
        if self._to_program:
            try:
                written = os.write(self._master, self._to_program)
            except BlockingIOError:
                written = 0
            self._to_program = self._to_program[written:]
            moved = moved or written > 0
        return moved

    def close(self) -> None:
        """Close the terminal and remove the link."""
        os.close(self._master)
        os.close(self._slave)
        if self._link is not None and self._link.is_symlink():
            self._link.unlink()
