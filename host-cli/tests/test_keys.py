# SPDX-License-Identifier: Apache-2.0
"""Keys from a pseudo-terminal and from a scripted Windows console."""

import os
import pty
import sys
import termios
from collections.abc import Iterator
from typing import Any

import pytest

from tornillo.keys import PosixKeys, WindowsKeys, keyboard


@pytest.fixture
def terminal() -> Iterator[tuple[int, int]]:
    """Both ends of a pseudo-terminal: the person's, and the program's."""
    ends = pty.openpty()
    yield ends
    for end in ends:
        os.close(end)


@pytest.mark.parametrize(
    ("sent", "keys"),
    [
        (b"h", ["h"]),
        (b"+-", ["+", "-"]),
        (b"\x1b[A\x1b[D", ["up", "left"]),
        (b"\x1bOB\x1bOC", ["down", "right"]),
        (b"\x1b", ["escape"]),
        (b"\x1b[5~\n", ["page-up", "enter"]),
        ("ñ".encode(), ["ñ"]),
    ],
)
def test_keys_come_one_by_one(terminal: tuple[int, int], sent: bytes, keys: list[str]) -> None:
    person, program = terminal
    with PosixKeys(program) as pressed:
        os.write(person, sent)
        assert [pressed.read(1.0) for _ in keys] == keys
        assert pressed.read(0.0) is None


def test_the_terminal_is_put_back_as_it_was(terminal: tuple[int, int]) -> None:
    before = termios.tcgetattr(terminal[1])
    with PosixKeys(terminal[1]):
        assert not termios.tcgetattr(terminal[1])[3] & termios.ICANON
        assert termios.tcgetattr(terminal[1])[3] & termios.ISIG
    assert termios.tcgetattr(terminal[1]) == before


class Console:
    """A Windows console with keys waiting."""

    def __init__(self, keys: str) -> None:
        """`keys` as getwch gives them."""
        self.keys = list(keys)

    def kbhit(self) -> bool:
        """Whether a key waits."""
        return bool(self.keys)

    def getwch(self) -> str:
        """The next half of a key."""
        return self.keys.pop(0)


def test_a_windows_console_gives_the_same_keys() -> None:
    with WindowsKeys(Console("h\xe0H\0K\r")) as pressed:
        assert [pressed.read(0.0) for _ in range(5)] == ["h", "up", "left", "enter", None]
    with pytest.raises(KeyboardInterrupt):
        WindowsKeys(Console("\x03")).read(0.0)


def test_the_system_chooses_the_keyboard(
    monkeypatch: pytest.MonkeyPatch, terminal: tuple[int, int]
) -> None:
    class Stdin:
        """Standard input that is a terminal."""

        def fileno(self) -> int:
            """Its number."""
            return terminal[1]

    monkeypatch.setattr(sys, "stdin", Stdin())
    assert isinstance(keyboard(), PosixKeys)
    fake: Any = Console("")
    monkeypatch.setitem(sys.modules, "msvcrt", fake)
    monkeypatch.setattr(sys, "platform", "win32")
    assert isinstance(keyboard(), WindowsKeys)
