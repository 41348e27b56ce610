# SPDX-License-Identifier: Apache-2.0
"""The pseudo-terminal against a device of a few lines."""

from __future__ import annotations

import os
import termios
from pathlib import Path

from virtual_lathe.terminal import Terminal


class Echo:
    """Stands in for the host: takes 7 bytes at a time and sends them back."""

    def __init__(self) -> None:
        """Open the port with nothing under way."""
        self.port_open = True
        self.queue = b""

    def send(self, data: bytes) -> int:
        """Take what fits."""
        taken = data[: 7 - min(7, len(self.queue))]
        self.queue += taken
        return len(taken)

    def receive(self, room: int = 4096) -> bytes:
        """Give back what came."""
        given, self.queue = self.queue[:room], self.queue[room:]
        return given


def test_all_bytes_pass_both_ways_whatever_they_mean_to_a_terminal(tmp_path: Path) -> None:
    link = tmp_path / "ports" / "lathe"
    terminal = Terminal(Echo(), link)
    program = os.open(link, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    assert not termios.tcgetattr(program)[3] & (termios.ECHO | termios.ICANON)
    message = bytes(range(256)) * 3
    back = b""
    os.write(program, message)
    while terminal.exchange():
        try:
            back += os.read(program, 4096)
        except BlockingIOError:
            continue
    assert back == message
    os.close(program)
    terminal.close()
    assert not link.exists()


def test_nothing_is_lost_while_the_cable_is_out() -> None:
    echo = Echo()
    terminal = Terminal(echo)
    echo.port_open = False
    program = os.open(terminal.name, os.O_RDWR | os.O_NOCTTY)
    os.write(program, b"later")
    assert not terminal.exchange()
    echo.port_open = True
    assert terminal.exchange()
    assert os.read(program, 5) == b"later"
    os.close(program)
    terminal.close()
