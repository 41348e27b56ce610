# SPDX-License-Identifier: Apache-2.0
"""`tornillo flash`: what it says and does, what it refuses, and what an interruption means."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from flashed import DONE, WAITS, assert_updated, tornillo
from hex_files import SIZE, firmware_file, hex_file, lines, program
from scripted_chip import IDLE
from scripted_loader import ScriptedSocket

from tornillo.firmware_file import BLOCK
from tornillo.loader import LoaderCommand
from tornillo.protocol import PROTOCOL_VERSION, Command, ErrorCode, State


def test_the_running_firmware_is_replaced(socket: ScriptedSocket, new: Path) -> None:
    result = tornillo("flash", new)
    assert (result.exit_code, result.stdout) == (0, DONE)
    assert "Writing firmware 0.2.0" in result.stderr
    assert socket.chip.executed == [Command.HELLO, Command.LOADER, Command.HELLO]
    assert_updated(socket)


def test_scripts_are_told_what_was_done(socket: ScriptedSocket, new: Path) -> None:
    result = tornillo("flash", new, "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout) == {
        "file": str(new),
        "firmware": "0.2.0",
        "protocol": PROTOCOL_VERSION,
        "board": 1,
        "bytes": SIZE,
        "crc": program()[1::-1].hex(),
        "boot_loader": True,
        "configuration": True,
        "before": "0.1.0",
        "port": "/dev/ttyACM0",
    }


def test_check_says_what_a_file_is_and_needs_no_lathe(
    socket: ScriptedSocket, new: Path, tmp_path: Path
) -> None:
    socket.unplugged = True
    result = tornillo("flash", new, "--check")
    assert result.exit_code == 0
    assert result.stdout.splitlines() == [
        f"{new}: Tornillo firmware 0.2.0, protocol {PROTOCOL_VERSION}, for board 1: {SIZE} bytes "
        "from 0x0800 to 0x0A61, whole",
        "with boot loader and configuration: a programmer can burn it too",
    ]
    alone = hex_file(tmp_path, lines(program()))
    shown = tornillo("flash", alone, "--check").stdout
    assert "without boot loader or configuration: for `tornillo flash` alone\n" in shown
    assert json.loads(tornillo("flash", alone, "--check", "--json").stdout) == {
        "file": str(alone),
        "firmware": "0.2.0",
        "protocol": PROTOCOL_VERSION,
        "board": 1,
        "bytes": SIZE,
        "crc": program()[1::-1].hex(),
        "boot_loader": False,
        "configuration": False,
    }
    assert socket.opened == []


@pytest.mark.parametrize("options", [[], ["--check"], ["--json"]])
def test_a_file_that_is_refused_touches_no_lathe(
    socket: ScriptedSocket, tmp_path: Path, options: list[str]
) -> None:
    path = hex_file(tmp_path, lines(program())[:-1])
    result = tornillo("flash", path, *options)
    assert (result.exit_code, result.stdout) == (1, "")
    assert f"Error: {path}:39: behind this line bytes are missing at 0x0A60\n" in result.stderr
    assert "\nTry: the file was damaged on its way" in result.stderr
    assert socket.opened == []


def test_a_chip_that_waits_in_its_loader_is_updated_without_asking(
    socket: ScriptedSocket, new: Path
) -> None:
    socket.in_loader = True
    result = tornillo("flash", new)
    assert (result.exit_code, result.stdout) == (0, DONE)
    assert_updated(socket)


def test_a_port_that_usb_does_not_know_serves_lathe_and_loader(
    socket: ScriptedSocket, new: Path, tmp_path: Path
) -> None:
    socket.usb = False
    (tmp_path / "port").touch()
    for in_loader in (False, True):
        socket.in_loader = in_loader
        socket.loader.put(program((0, 1, 0)))
        socket.chip.firmware = (0, 1, 0)
        result = tornillo("--port", tmp_path / "port", "flash", new)
        assert (result.exit_code, result.stdout) == (0, DONE)
        assert set(socket.opened) == {str(tmp_path / "port")}
        assert_updated(socket)


def test_a_pseudo_terminal_that_keeps_what_nobody_reads_does_no_harm(
    socket: ScriptedSocket, new: Path, tmp_path: Path
) -> None:
    socket.usb = False
    socket.away_s = 4.0
    (tmp_path / "port").touch()
    result = tornillo("--port", tmp_path / "port", "flash", new)
    assert (result.exit_code, result.stdout) == (0, DONE)
    assert_updated(socket)


def test_old_and_new_protocols_are_no_obstacle(socket: ScriptedSocket, tmp_path: Path) -> None:
    socket.chip.protocol = PROTOCOL_VERSION - 1
    result = tornillo("flash", firmware_file(tmp_path, program(protocol=PROTOCOL_VERSION + 1)))
    assert (result.exit_code, result.stdout) == (0, DONE)
    assert (
        f"Note: it speaks protocol {PROTOCOL_VERSION + 1}, this tornillo {PROTOCOL_VERSION}: "
        "install the tornillo of the same release\n"
    ) in result.stderr


@pytest.mark.parametrize(
    "state",
    [
        State.HOMING,
        State.RUNNING,
        State.HOLD,
        State.PAUSE,
        State.MOVING,
        State.TOUCHING,
    ],
)
def test_a_lathe_at_work_is_left_alone(socket: ScriptedSocket, new: Path, state: State) -> None:
    socket.chip.status = IDLE._replace(state=state)
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "Error: the lathe is at work: its firmware can only be changed while" in result.stderr
    assert "Try: let it finish, or end it with `tornillo stop`; then type the" in result.stderr
    assert WAITS not in result.stderr
    assert not socket.in_loader


def test_an_alarm_is_no_obstacle(socket: ScriptedSocket, new: Path) -> None:
    socket.chip.status = IDLE._replace(state=State.ALARM)
    assert tornillo("flash", new).exit_code == 0


def test_a_firmware_without_boot_loader_is_told_from_others(
    socket: ScriptedSocket, new: Path
) -> None:
    socket.chip.unknown = {Command.LOADER}
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "Error: the firmware 0.1.0 has no boot loader\n" in result.stderr
    assert "Try: burn build/firmware/tornillo.hex once with a PIC programmer" in result.stderr


def test_another_refusal_is_told_as_usual(socket: ScriptedSocket, new: Path) -> None:
    socket.chip.refusals[Command.LOADER] = bytes([ErrorCode.OUT_OF_RANGE])
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "LOADER was refused: a value lies outside its range" in result.stderr


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (bytes([ErrorCode.UNKNOWN_COMMAND]), "the firmware answers HELLO with UNKNOWN_COMMAND"),
        (b"\0\x03", "the firmware does not tell its version"),
    ],
)
def test_a_firmware_that_does_not_tell_its_version_is_refused(
    socket: ScriptedSocket, new: Path, answer: bytes, message: str
) -> None:
    socket.chip.refusals[Command.HELLO] = answer
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert f"Error: {message}" in result.stderr
    assert "with a programmer (docs/flashing.md)" in result.stderr


def test_a_port_where_nobody_answers_is_told(socket: ScriptedSocket, new: Path) -> None:
    socket.lose_answers = 1000
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "Error: nothing answers at /dev/ttyACM0" in result.stderr


def test_an_answer_to_loader_that_got_lost_does_not_matter(
    socket: ScriptedSocket, new: Path
) -> None:
    def lose_the_next(_payload: bytes) -> bytes:
        socket.lose_answers = 1
        return type(socket.chip).do_loader(socket.chip, _payload)

    vars(socket.chip)["do_loader"] = lose_the_next
    assert tornillo("flash", new).stdout == DONE
    assert_updated(socket)


def test_an_answer_to_go_that_got_lost_does_not_matter(socket: ScriptedSocket, new: Path) -> None:
    answer = socket.loader.answer

    def lose_the_last(packet: bytes) -> bytes:
        socket.lose_answers = packet[0] == LoaderCommand.GO
        return answer(packet)

    vars(socket.loader)["answer"] = lose_the_last
    assert tornillo("flash", new).stdout == DONE
    assert_updated(socket)


def test_a_program_that_the_loader_does_not_find_whole_is_told(
    socket: ScriptedSocket, new: Path
) -> None:
    socket.loader.results[LoaderCommand.GO] = 5
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "the boot loader refused GO: the program in the chip is not whole" in result.stderr
    assert WAITS in result.stderr


# -- interrupted ---------------------------------------------------------------------------------


def test_a_cable_pulled_at_any_write_leaves_a_chip_that_is_updated_by_the_same_command(
    socket: ScriptedSocket, new: Path
) -> None:
    pieces = 2 * -(-SIZE // BLOCK)
    for number in range(pieces):
        socket.loader.put(program((0, 1, 0)))
        socket.chip.firmware = (0, 1, 0)
        countdown = iter(range(number, -1, -1))

        def pull(_address: int, left: Iterator[int] = countdown) -> None:
            socket.unplugged = next(left) == 0

        socket.loader.at_write = pull
        result = tornillo("flash", new)
        assert result.exit_code == 1, number
        assert "Error: the connection was lost" in result.stderr
        assert WAITS in result.stderr
        assert socket.in_loader
        socket.unplugged = False
        socket.loader.at_write = lambda _address: None
        whole = number == pieces - 1
        assert socket.loader.whole == whole
        result = tornillo("flash", new)
        before = "0.2.0" if whole else "not whole"
        assert result.stdout == DONE.replace("0.1.0", before)
        assert_updated(socket)


def test_ctrl_c_while_writing_says_that_the_chip_waits_and_how_to_go_on(
    socket: ScriptedSocket, new: Path
) -> None:
    def press(address: int) -> None:
        if address == 0x08C0:
            raise KeyboardInterrupt

    socket.loader.at_write = press
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "Error: interrupted; the chip stays in its boot loader and cannot cut\n" in result.stderr
    assert f"Try: type `tornillo flash {new}` again; it goes on\n" in result.stderr
    socket.loader.at_write = lambda _address: None
    assert tornillo("flash", new).exit_code == 0
    assert_updated(socket)


def test_ctrl_c_on_the_way_into_the_loader_means_the_same(
    socket: ScriptedSocket, new: Path
) -> None:
    def press() -> None:
        if socket.comings == 1:
            raise KeyboardInterrupt

    socket.after_open = press
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "Error: interrupted; the chip stays in its boot loader and cannot cut\n" in result.stderr


def test_ctrl_c_before_the_change_changes_nothing(socket: ScriptedSocket, new: Path) -> None:
    def press() -> None:
        raise KeyboardInterrupt

    socket.after_open = press
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "Error: interrupted before anything was changed\n" in result.stderr
    assert "Try: the lathe is as it was\n" in result.stderr
    assert not socket.in_loader


def test_ctrl_c_after_the_end_says_that_it_is_done(socket: ScriptedSocket, new: Path) -> None:
    def press() -> None:
        if socket.comings == 2:
            raise KeyboardInterrupt

    socket.after_open = press
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "interrupted; the new firmware is written, compared and started\n" in result.stderr
    assert "Try: see `tornillo doctor`\n" in result.stderr
    assert_updated(socket)
