# SPDX-License-Identifier: Apache-2.0
"""Ports that do not open: why, and what to do about it; ports that open after a while."""

import errno
import fcntl
import os
import subprocess
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from scripted_chip import ScriptedChip, ScriptedPort
from serial import SerialException

from tornillo import Lathe, holders, opening
from tornillo.errors import PortError, VersionError
from tornillo.holders import Holder
from tornillo.opening import PATIENCE_S, RETRY_S, open_port

DENIED = SerialException(errno.EACCES, "could not open port P: Permission denied")
BUSY = SerialException(errno.EBUSY, "could not open port P: Device or resource busy")
LOCKED = SerialException(errno.EAGAIN, "Could not exclusively lock port P: unavailable")
WINDOWS_BUSY = SerialException("could not open port 'COM3': PermissionError(13, 'denied', None, 5)")
WINDOWS_MISSING = SerialException("could not open port 'COM3': FileNotFoundError(2, 'none')")


class Clock:
    """Time that passes only while somebody sleeps."""

    def __init__(self) -> None:
        """Begin at 0 s."""
        self.now = 0.0

    def sleep(self, seconds: float) -> None:
        """Let time pass."""
        self.now += seconds

    def monotonic(self) -> float:
        """Seconds since the beginning."""
        return self.now

    def time(self) -> float:
        """Seconds, for the age of files: every file here is old."""
        return 4e9 + self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """The clock of the module."""
    clock = Clock()
    monkeypatch.setattr("tornillo.opening.time", clock)
    return clock


@pytest.fixture(autouse=True)
def unknown_holders(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A /proc in which nothing is known, and no rule installed."""
    monkeypatch.setattr("tornillo.holders.PROCESSES", tmp_path / "proc")
    monkeypatch.setattr("tornillo.opening.udev.installed", lambda: False)
    return tmp_path / "proc"


def fail_with(
    monkeypatch: pytest.MonkeyPatch, error: SerialException, times: int = 1_000_000
) -> list[str]:
    """Let pyserial fail so many times, then open; returns the attempts as they are made."""
    tried: list[str] = []

    def attempt(name: str, **_options: object) -> str:
        tried.append(name)
        if len(tried) <= times:
            raise error
        return "opened"

    monkeypatch.setattr("serial.Serial", attempt)
    return tried


@pytest.mark.parametrize(
    ("error", "message", "remedy"),
    [
        (DENIED, "no permission to use P", "udev --install"),
        (BUSY, "P is in use by another program", "ModemManager"),
        (LOCKED, "P is in use by another program", "close the other program"),
        (WINDOWS_BUSY, "P is in use by another program", "close the other program"),
        (SerialException(errno.ENOENT, "No such file"), "there is no port P", "USB id"),
        (WINDOWS_MISSING, "there is no port P", "USB id"),
        (SerialException(errno.EIO, "Input/output error"), "P cannot be opened", "the lathe's"),
    ],
)
def test_a_port_that_does_not_open_is_explained(
    monkeypatch: pytest.MonkeyPatch, error: SerialException, message: str, remedy: str
) -> None:
    fail_with(monkeypatch, error)
    with pytest.raises(PortError, match=message) as caught:
        open_port("P")
    assert remedy in caught.value.remedy


def test_a_port_that_is_not_there_is_told_by_the_real_pyserial(tmp_path: Path) -> None:
    with pytest.raises(PortError, match="there is no port"):
        open_port(str(tmp_path / "ttyNONE"))


def test_the_port_is_opened_for_one_program_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    options: dict[str, object] = {}

    def remember(name: str, **given: object) -> str:
        options.update(given)
        return f"opened {name}"

    monkeypatch.setattr("serial.Serial", remember)
    assert str(open_port("P")) == "opened P"
    assert options == {"exclusive": True, "write_timeout": 0.25}


@pytest.mark.parametrize(("platform", "hint"), [("darwin", "ls -l P"), ("linux", "usermod -aG")])
def test_missing_rights_are_explained_for_the_system(
    monkeypatch: pytest.MonkeyPatch, platform: str, hint: str
) -> None:
    monkeypatch.setattr("sys.platform", platform)
    fail_with(monkeypatch, DENIED)
    with pytest.raises(PortError, match="no permission") as caught:
        open_port("P")
    assert hint in caught.value.remedy


def test_missing_rights_name_the_group_that_has_them(
    monkeypatch: pytest.MonkeyPatch, clock: Clock, tmp_path: Path
) -> None:
    port = tmp_path / "tty"
    port.touch()
    fail_with(monkeypatch, DENIED)
    with pytest.raises(PortError, match=f"the group {port.group()}"):
        open_port(str(port))
    assert clock.now == 0


def test_with_the_rule_installed_the_advice_is_to_plug_in_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("tornillo.opening.udev.installed", lambda: True)
    fail_with(monkeypatch, DENIED)
    with pytest.raises(PortError) as caught:
        open_port("P")
    assert "plug the cable out and in again" in caught.value.remedy


def test_rights_that_the_system_is_just_setting_are_waited_for(
    monkeypatch: pytest.MonkeyPatch, clock: Clock, tmp_path: Path
) -> None:
    port = tmp_path / "tty"
    port.touch()
    monkeypatch.setattr(clock, "time", lambda: port.stat().st_ctime + 0.5)
    tried = fail_with(monkeypatch, DENIED, times=2)
    told: list[str] = []
    assert str(open_port(str(port), told.append)) == "opened"
    assert len(tried) == 3
    assert told == [f"{port} is still being set up by the system; trying for 5 s"]


def hold(proc: Path, number: int, name: str, port: str) -> None:
    """A process in /proc that has `port` open."""
    files = proc / str(number) / "fd"
    files.mkdir(parents=True)
    (proc / str(number) / "comm").write_text(f"{name}\n", encoding="utf-8")
    (files / "0").symlink_to("/dev/null")
    (files / "3").symlink_to(Path(port).resolve())


def test_a_port_that_modem_manager_tries_is_waited_for(
    monkeypatch: pytest.MonkeyPatch, clock: Clock, unknown_holders: Path
) -> None:
    hold(unknown_holders, 77, "ModemManager", "P")
    tried = fail_with(monkeypatch, BUSY, times=3)
    told: list[str] = []
    assert str(open_port("P", told.append)) == "opened"
    assert (len(tried), clock.now) == (4, 3 * RETRY_S)
    assert told == ["P is in use: ModemManager may be trying whether it is a modem; trying for 5 s"]


def test_modem_manager_that_does_not_let_go_is_named_after_five_seconds(
    monkeypatch: pytest.MonkeyPatch, clock: Clock, unknown_holders: Path
) -> None:
    hold(unknown_holders, 77, "ModemManager", "P")
    fail_with(monkeypatch, BUSY)
    with pytest.raises(PortError, match="P is in use by ModemManager") as caught:
        open_port("P")
    assert "udev --install" in caught.value.remedy
    assert PATIENCE_S <= clock.now <= PATIENCE_S + RETRY_S


def test_modem_manager_of_another_user_is_guessed_from_its_name(
    monkeypatch: pytest.MonkeyPatch, clock: Clock, unknown_holders: Path
) -> None:
    hold(unknown_holders, 77, "ModemManager", "other")
    fail_with(monkeypatch, BUSY)
    with pytest.raises(PortError, match="P is in use by another program") as caught:
        open_port("P")
    assert "ModemManager may be trying the port" in caught.value.remedy
    assert clock.now >= PATIENCE_S


def test_another_program_is_named_at_once(
    monkeypatch: pytest.MonkeyPatch, clock: Clock, unknown_holders: Path
) -> None:
    hold(unknown_holders, 42, "screen", "P")
    hold(unknown_holders, 43, "tornillo", "other")
    hold(unknown_holders, os.getpid(), "pytest", "P")
    tried = fail_with(monkeypatch, BUSY)
    with pytest.raises(PortError) as caught:
        open_port("P")
    assert str(caught.value) == "P is in use by another program: screen (process 42)"
    assert caught.value.remedy == "close that program, then try again"
    assert (len(tried), clock.now) == (1, 0)


@pytest.fixture
def locked(tmp_path: Path) -> Iterator[Path]:
    """A file that this process has locked."""
    path = tmp_path / "tty"
    with path.open("wb") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield path


def test_the_lock_of_another_user_tells_the_program(locked: Path, unknown_holders: Path) -> None:
    status = locked.stat()
    device = f"{os.major(status.st_dev):02x}:{os.minor(status.st_dev):02x}"
    lines = [
        "1: POSIX  ADVISORY  WRITE 5 00:01:2 0 EOF",
        f"2: FLOCK  ADVISORY  WRITE 42 {device}:{status.st_ino} 0 EOF",
        f"2: -> FLOCK  ADVISORY  WRITE 43 {device}:{status.st_ino} 0 EOF",
        f"3: FLOCK  ADVISORY  WRITE -1 {device}:{status.st_ino} 0 EOF",
    ]
    unknown_holders.mkdir()
    (unknown_holders / "locks").write_text("\n".join(lines), encoding="utf-8")
    assert holders.holders(str(locked)) == [Holder("unknown", 42)]


def test_files_of_others_that_cannot_be_looked_into_are_left_out(unknown_holders: Path) -> None:
    (unknown_holders / "7").mkdir(parents=True)
    assert holders.holders("P") == []
    assert not holders.modem_manager_runs()


@pytest.mark.parametrize(
    ("told", "found"),
    [("p61\ncscreen\nf3\n", [Holder("screen", 61)]), ("", []), (f"p{os.getpid()}\ncpython\n", [])],
)
def test_macos_is_asked_by_lsof(
    monkeypatch: pytest.MonkeyPatch, told: str, found: list[Holder]
) -> None:
    monkeypatch.setattr("sys.platform", "darwin")
    monkeypatch.setattr("shutil.which", lambda _name: "lsof")
    monkeypatch.setattr("subprocess.run", lambda *_a, **_o: SimpleNamespace(stdout=told))
    assert holders.holders("/dev/cu.usbmodem1") == found


def test_without_lsof_or_its_answer_nothing_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    def hang(*_arguments: object, **_options: object) -> None:
        raise subprocess.TimeoutExpired("lsof", 3)

    monkeypatch.setattr("sys.platform", "darwin")
    monkeypatch.setattr("subprocess.run", hang)
    monkeypatch.setattr("shutil.which", lambda _name: "lsof")
    assert holders.holders("P") == []
    monkeypatch.setattr("shutil.which", lambda _name: None)
    assert holders.holders("P") == []


def test_on_windows_nothing_is_waited_for(monkeypatch: pytest.MonkeyPatch, clock: Clock) -> None:
    monkeypatch.setattr("sys.platform", "win32")
    fail_with(monkeypatch, WINDOWS_BUSY)
    with pytest.raises(PortError, match="COM3 is in use by another program") as caught:
        open_port("COM3")
    assert "ModemManager" not in caught.value.remedy
    assert clock.now == 0


def test_the_port_is_closed_when_something_else_answers(
    monkeypatch: pytest.MonkeyPatch, port: ScriptedPort, chip: ScriptedChip
) -> None:
    chip.protocol = 9
    monkeypatch.setattr("tornillo.lathe.open_port", lambda *_arguments: port)
    with pytest.raises(VersionError, match="speaks protocol 9"):
        Lathe.open("COM3")
    assert port.closed


def test_leaving_the_with_block_closes_the_port(
    monkeypatch: pytest.MonkeyPatch, port: ScriptedPort
) -> None:
    monkeypatch.setattr("tornillo.lathe.open_port", lambda *_arguments: port)
    monkeypatch.setattr("tornillo.lathe.find_port", lambda _wanted: "found")
    with Lathe.open() as lathe:
        assert (lathe.firmware, lathe.serial_number) == ("0.1.0", "T0000001")
        assert not port.closed
    assert port.closed


def test_a_port_of_an_unknown_owner_is_told_without_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def unknown(_path: Path) -> str:
        raise KeyError("uid not found")

    monkeypatch.setattr("pathlib.Path.owner", unknown)
    assert opening._owner("/dev/null") == ""
