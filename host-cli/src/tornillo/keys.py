# SPDX-License-Identifier: Apache-2.0
"""Keys as they are pressed, one by one, on the terminals of Linux, macOS and Windows.

A terminal tells presses and repeats, never releases.
"""

import os
import sys
import time
from types import TracebackType
from typing import Any, Protocol

#: What terminals send for keys that are no characters.
ESCAPES = {
    "\x1b[A": "up",
    "\x1b[B": "down",
    "\x1b[C": "right",
    "\x1b[D": "left",
    "\x1bOA": "up",
    "\x1bOB": "down",
    "\x1bOC": "right",
    "\x1bOD": "left",
    "\x1b[5~": "page-up",
    "\x1b[6~": "page-down",
    "\x1b": "escape",
    "\r": "enter",
    "\n": "enter",
}
#: The second half of such a key on Windows.
WINDOWS = {
    "H": "up",
    "P": "down",
    "M": "right",
    "K": "left",
    "I": "page-up",
    "Q": "page-down",
}
POLL_S = 0.01


class Keys(Protocol):
    """Where keys come from."""

    def read(self, timeout_s: float) -> str | None:
        """The next key, a character or a name of ESCAPES; None when none came in time."""


class PosixKeys:
    """Keys of a POSIX terminal, which is put back as it was at the end of the `with` block.

    Ctrl-C still raises KeyboardInterrupt.
    """

    def __init__(self, descriptor: int | None = None) -> None:
        """`descriptor`: of the terminal, standard input when left out."""
        self._descriptor = sys.stdin.fileno() if descriptor is None else descriptor
        self._before: list[Any] = []
        self._waiting = ""

    def __enter__(self) -> "PosixKeys":
        """Read keys at once, without showing them."""
        import termios
        import tty

        self._before = termios.tcgetattr(self._descriptor)
        tty.setcbreak(self._descriptor)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Put the terminal back."""
        import termios

        termios.tcsetattr(self._descriptor, termios.TCSADRAIN, self._before)

    def read(self, timeout_s: float) -> str | None:
        """The next key; None when none came within `timeout_s` seconds."""
        import select

        if not self._waiting and select.select([self._descriptor], [], [], timeout_s)[0]:
            self._waiting = os.read(self._descriptor, 64).decode("utf-8", "replace")
        return self._take()

    def _take(self) -> str | None:
        """The first key of what has come."""
        for sequence in sorted(ESCAPES, key=len, reverse=True):
            if self._waiting.startswith(sequence):
                self._waiting = self._waiting.removeprefix(sequence)
                return ESCAPES[sequence]
        key, self._waiting = self._waiting[:1], self._waiting[1:]
        return key or None


class WindowsKeys:
    """Keys of a Windows console; `console` is its module msvcrt."""

    def __init__(self, console: Any = None) -> None:
        """Use the console of this process."""
        if console is None:
            import msvcrt as console
        self._console = console

    def __enter__(self) -> "WindowsKeys":
        """Nothing to do: the console gives keys at once."""
        return self

    def __exit__(self, *_what: object) -> None:
        """Nothing to put back."""

    def read(self, timeout_s: float) -> str | None:
        """The next key; None when none came within `timeout_s` seconds."""
        end = time.monotonic() + timeout_s
        while not self._console.kbhit():
            if time.monotonic() >= end:
                return None
            time.sleep(POLL_S)
        key: str = self._console.getwch()
        if key == "\x03":
            raise KeyboardInterrupt
        if key in ("\0", "\xe0"):
            return WINDOWS.get(self._console.getwch(), "")
        return ESCAPES.get(key, key)


def keyboard() -> PosixKeys | WindowsKeys:
    """The keys of this terminal."""
    return WindowsKeys() if sys.platform == "win32" else PosixKeys()
