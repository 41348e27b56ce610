# SPDX-License-Identifier: Apache-2.0
"""Where `tornillo flash` looks for the chip, before and after; who does not come back."""

from pathlib import Path

import pytest
from flashed import DONE, WAITS, assert_updated, tornillo
from scripted_loader import ScriptedSocket, entry

from tornillo.errors import PortError
from tornillo.flashing import COMES_BACK_S
from tornillo.protocol import USB_LOADER_PRODUCT_ID, USB_PRODUCT_ID

# -- who does not come back ----------------------------------------------------------------------


def test_a_loader_that_does_not_appear_is_waited_for_and_told(
    socket: ScriptedSocket, new: Path
) -> None:
    socket.away_s = 1000.0
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "Error: the boot loader does not appear within 15 s\n" in result.stderr
    assert "Try: type the same command again; if it stays, hold HOLD at the" in result.stderr
    assert WAITS not in result.stderr
    assert COMES_BACK_S <= socket.now <= COMES_BACK_S + 2


def test_a_loader_that_does_not_open_is_told_with_the_reason(
    socket: ScriptedSocket, new: Path
) -> None:
    socket.refuse_to_open[True] = PortError("no permission to use P", "install the udev rule")
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "the boot loader does not appear within 15 s: no permission to use P" in result.stderr
    assert "Try: install the udev rule\n" in result.stderr


def test_a_loader_that_is_silent_at_first_is_waited_for(socket: ScriptedSocket, new: Path) -> None:
    opened = iter(range(100))

    def silent() -> None:
        socket.lose_answers = 5 if next(opened) == 1 else 0

    socket.after_open = silent
    assert tornillo("flash", new).stdout == DONE


def test_a_silent_loader_is_told_as_such(socket: ScriptedSocket, new: Path) -> None:
    socket.in_loader = True
    socket.lose_answers = 1000
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "the boot loader does not answer IDENTIFY after 5 tries" in result.stderr


def test_a_lathe_that_does_not_come_back_is_told(socket: ScriptedSocket, new: Path) -> None:
    def go_away(_address: int) -> None:
        socket.away_s = 1000.0

    socket.loader.at_write = go_away
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert (
        "Error: the new firmware is written, but the lathe is not back in 15 s\n" in result.stderr
    )
    assert "Try: switch the lathe off and on, then see `tornillo doctor`\n" in result.stderr
    assert WAITS not in result.stderr


def test_a_lathe_that_tells_another_version_is_not_taken_for_updated(
    socket: ScriptedSocket, new: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def change(into_loader: bool) -> None:
        socket.in_loader = into_loader
        socket.comings += 1

    monkeypatch.setattr(socket, "change", change)
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "the lathe says that its firmware is 0.1.0, not 0.2.0" in result.stderr
    assert "Try: see `tornillo doctor`; then try again" in result.stderr


def test_a_chip_of_another_board_is_started_again_as_it_was(
    socket: ScriptedSocket, new: Path
) -> None:
    socket.loader.board = 2
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "was made for board 1, and this is board 2" in result.stderr
    assert WAITS not in result.stderr
    assert not socket.in_loader
    assert socket.loader.written == []


def test_a_chip_of_another_board_without_a_program_stays_in_its_loader(
    socket: ScriptedSocket, new: Path
) -> None:
    socket.loader.board = 2
    socket.in_loader = True
    socket.loader.put(bytes(64))
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert WAITS in result.stderr
    assert socket.in_loader


# -- which chip ----------------------------------------------------------------------------------


def test_the_loader_is_looked_for_in_the_socket_of_the_lathe(
    socket: ScriptedSocket, new: Path
) -> None:
    other = entry("/dev/ttyACM7", USB_LOADER_PRODUCT_ID, None, "1-9:1.0")
    socket.others = [other]
    assert tornillo("flash", new).exit_code == 1
    result = tornillo("--port", "T0000001", "flash", new)
    assert (result.exit_code, result.stdout) == (0, DONE)
    assert set(socket.opened) == {"/dev/ttyACM0"}


def test_without_sockets_the_loader_that_was_not_there_before_is_taken(
    socket: ScriptedSocket, new: Path
) -> None:
    socket.location = None
    socket.others = [entry("/dev/ttyACM7", USB_LOADER_PRODUCT_ID, None, None)]
    assert tornillo("--port", "/dev/ttyACM0", "flash", new).stdout == DONE
    assert_updated(socket)


def test_a_link_to_the_port_leads_to_the_socket(
    socket: ScriptedSocket, new: Path, tmp_path: Path
) -> None:
    link = tmp_path / "usb-Tornillo_lathe"
    link.symlink_to(socket.port)
    assert tornillo("--port", link, "flash", new).stdout == DONE
    assert set(socket.opened) == {socket.port}


def test_several_chips_are_listed_with_how_to_choose(socket: ScriptedSocket, new: Path) -> None:
    socket.others = [
        entry("/dev/ttyACM1", USB_PRODUCT_ID, "T0000002", "1-3"),
        entry("/dev/ttyACM2", USB_LOADER_PRODUCT_ID, None, "1-4"),
    ]
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert (
        "more than one chip found: /dev/ttyACM0 (serial number T0000001), /dev/ttyACM1 (serial "
        "number T0000002), /dev/ttyACM2 (boot loader)"
    ) in result.stderr
    assert "Try: choose one: `tornillo --port /dev/ttyACM0 flash ...`" in result.stderr


def test_an_interrupted_update_of_a_numbered_lathe_goes_on_by_its_number(
    socket: ScriptedSocket, new: Path
) -> None:
    socket.in_loader = True
    assert tornillo("--port", "T0000001", "flash", new).stdout == DONE


def test_no_chip_at_all_is_told_as_by_other_commands(socket: ScriptedSocket, new: Path) -> None:
    socket.unplugged = True
    result = tornillo("flash", new)
    assert result.exit_code == 1
    assert "Error: no lathe found: no port has the USB id 1209:0001" in result.stderr


# -- other commands ------------------------------------------------------------------------------


@pytest.mark.parametrize("words", [["status"], ["parts"], ["run", "bar"], ["home"]])
def test_other_commands_say_that_only_a_loader_is_there_and_what_to_do(
    socket: ScriptedSocket, words: list[str]
) -> None:
    socket.in_loader = True
    result = tornillo(*words)
    assert result.exit_code == 1
    assert (
        "Error: the lathe at /dev/ttyACM0 waits in its boot loader and runs no firmware\n"
    ) in result.stderr
    assert "Try: give it its firmware with `tornillo flash FILE.hex`" in result.stderr


def test_they_say_so_at_a_port_that_usb_does_not_know(
    socket: ScriptedSocket, tmp_path: Path
) -> None:
    socket.in_loader = True
    socket.usb = False
    (tmp_path / "port").touch()
    result = tornillo("--port", tmp_path / "port", "status")
    assert result.exit_code == 1
    assert f"the lathe at {tmp_path}/port waits in its boot loader" in result.stderr


def test_a_lathe_beside_a_chip_in_its_loader_works(socket: ScriptedSocket) -> None:
    socket.others = [entry("/dev/ttyACM2", USB_LOADER_PRODUCT_ID, None, "1-4")]
    assert tornillo("status").exit_code == 0


@pytest.mark.parametrize("usb", [True, False])
def test_the_doctor_finds_it_too(socket: ScriptedSocket, tmp_path: Path, usb: bool) -> None:
    socket.in_loader = True
    socket.usb = usb
    (tmp_path / "port").touch()
    result = tornillo(*([] if usb else ["--port", str(tmp_path / "port")]), "doctor")
    assert result.exit_code == 1
    assert result.stdout.startswith("NO  firmware: the lathe at ")
    assert "    Try: give it its firmware with `tornillo flash FILE.hex`" in result.stdout
