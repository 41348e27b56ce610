# SPDX-License-Identifier: Apache-2.0
"""What the tests of `tornillo flash` share: how it is typed, and how it ends."""

from pathlib import Path

from click.testing import CliRunner, Result
from hex_files import SIZE, program
from scripted_loader import ScriptedSocket

from tornillo.cli import main
from tornillo.firmware_file import FIRST

DONE = f"firmware was 0.1.0, is 0.2.0: {SIZE} bytes written and compared\n"
WAITS = "The chip waits in its boot loader until an update has come to its end.\n"


def tornillo(*arguments: str | Path) -> Result:
    """Type a command."""
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def assert_updated(socket: ScriptedSocket) -> None:
    """The chip runs the new firmware."""
    assert socket.loader.flash[FIRST : FIRST + SIZE] == program()
    assert socket.loader.whole
    assert not socket.in_loader
