# SPDX-License-Identifier: Apache-2.0
"""The library over a real pyserial port: a pseudo-terminal with the scripted chip behind it."""

import os
import pty
import subprocess
import sys
import threading
import tty
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from click.testing import CliRunner
from hex_files import firmware_file, program
from scripted_chip import ScriptedChip, ScriptedPort
from scripted_loader import ScriptedSocket, SocketPort

from tornillo import Lathe, Part
from tornillo.cli import main
from tornillo.errors import PortError
from tornillo.opening import open_port

LONGEST_ANSWER = 4096


@contextmanager
def terminal_of(port: ScriptedPort | SocketPort) -> Iterator[str]:
    """The name of a pseudo-terminal that whoever is behind `port` answers on."""
    chip_side, host_side = pty.openpty()
    tty.setraw(host_side)

    def answer() -> None:
        while data := read_or_nothing(chip_side):
            port.write(data)
            os.write(chip_side, port.read(LONGEST_ANSWER))

    thread = threading.Thread(target=answer, daemon=True)
    thread.start()
    yield os.ttyname(host_side)
    os.close(host_side)
    thread.join()
    os.close(chip_side)


@pytest.fixture
def terminal(chip: ScriptedChip) -> Iterator[str]:
    """The name of a pseudo-terminal that `chip` answers on."""
    with terminal_of(ScriptedPort(chip)) as name:
        yield name


def read_or_nothing(descriptor: int) -> bytes:
    """What comes in; nothing when the other side has been closed."""
    try:
        return os.read(descriptor, LONGEST_ANSWER)
    except OSError:
        return b""


def test_a_part_is_uploaded_and_read_back_over_a_serial_port(
    terminal: str, chip: ScriptedChip, test_bar: Path
) -> None:
    with Lathe.open(terminal) as lathe:
        image = Part.load(test_bar).image(lathe.machine())
        slot = lathe.upload(image)
        assert lathe.read(slot) == image
    assert chip.slots == {slot: image}


def test_what_a_modem_probe_left_on_the_line_does_no_harm(terminal: str) -> None:
    with open_port(terminal) as probe:
        probe.write(b"AT+GCAP\r")
    with Lathe.open(terminal) as lathe:
        assert lathe.status().dead_x == 23


def test_a_second_program_is_told_that_the_port_is_in_use(terminal: str) -> None:
    with Lathe.open(terminal), pytest.raises(PortError, match="is in use by another program"):
        Lathe.open(terminal)


def test_a_second_program_is_told_which_one_has_the_port(terminal: str) -> None:
    code = (
        f"import sys, serial; port = serial.Serial({terminal!r}, exclusive=True)\n"
        "print('open', flush=True); sys.stdin.read()"
    )
    command = [sys.executable, "-c", code]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"open\n"
        with pytest.raises(PortError, match=rf"program: python\S* \(process {other.pid}\)"):
            Lathe.open(terminal)
        other.communicate(b"")


def test_the_status_is_watched_over_a_serial_port(terminal: str) -> None:
    seen: list[int] = []
    with Lathe.open(terminal) as lathe, lathe.watch(lambda now: seen.append(now.dead_x), every=0):
        for _ in range(20):
            assert lathe.status().dead_z == 31
    assert set(seen) <= {23}
    assert not [thread for thread in threading.enumerate() if thread.name == "tornillo-watch"]


def test_the_command_line_works_over_a_serial_port(terminal: str) -> None:
    result = CliRunner().invoke(main, ["--port", terminal, "status"])
    assert result.exit_code == 0
    assert "state" in result.stdout


def test_the_firmware_is_changed_over_a_serial_port(tmp_path: Path) -> None:
    socket = ScriptedSocket()
    socket.loader.put(program((0, 1, 0)))
    socket.usb, socket.away_s = False, 0.0
    with terminal_of(SocketPort(socket)) as name:
        result = CliRunner().invoke(main, ["--port", name, "flash", str(firmware_file(tmp_path))])
    assert (result.exit_code, result.stderr[:7]) == (0, "Writing")
    assert "firmware was 0.1.0, is 0.2.0" in result.stdout
    assert socket.loader.header.version == "0.2.0"
