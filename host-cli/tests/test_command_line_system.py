# SPDX-License-Identifier: Apache-2.0
"""The verbs about the connection: the serial number, the udev rule in a system of its own."""

import re
import stat
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest
from click.testing import CliRunner
from console import Tornillo
from scripted_chip import IDLE, ScriptedChip, ScriptedPort

from tornillo import udev
from tornillo.cli import main
from tornillo.commands.system import random_number
from tornillo.errors import TornilloError
from tornillo.protocol import (
    SERIAL_LENGTH,
    USB_LOADER_PRODUCT_ID,
    USB_PRODUCT_ID,
    USB_VENDOR_ID,
    Command,
    State,
)

RULE = Path(udev.__file__).parent / udev.RULE_FILE
PLACE = "etc/udev/rules.d/60-tornillo.rules"


def test_serial_shows_the_number(tornillo: Tornillo, chip: ScriptedChip) -> None:
    assert tornillo("serial").stdout == "T0000001\n"
    assert Command.SERIAL_SET not in chip.executed


def test_serial_changes_the_number(tornillo: Tornillo, chip: ScriptedChip) -> None:
    result = tornillo("serial", "LATHE-07")
    assert (result.exit_code, result.stdout) == (0, "serial number was T0000001, is LATHE-07\n")
    assert "when the cable is plugged in again" in result.stderr
    assert chip.serial == b"LATHE-07"


def test_serial_can_choose_a_number(tornillo: Tornillo, chip: ScriptedChip) -> None:
    assert tornillo("serial", "--random").exit_code == 0
    assert re.fullmatch(rb"TN[2-9A-Z]{6}", chip.serial)
    numbers = {random_number() for _ in range(1000)}
    assert len(numbers) > 990
    assert {len(number) for number in numbers} == {SERIAL_LENGTH}


def test_serial_takes_a_number_or_chooses_one(tornillo: Tornillo) -> None:
    assert tornillo("serial", "LATHE-07", "--random").exit_code == 2


def test_serial_refuses_what_cannot_be_a_number(tornillo: Tornillo, chip: ScriptedChip) -> None:
    result = tornillo("serial", "lathe 7")
    assert result.exit_code == 1
    assert "Try: choose 8 letters, digits or signs" in result.stderr
    assert "like TN-00042" in result.stderr
    assert chip.serial == b"T0000001"


def test_serial_is_not_changed_while_the_lathe_moves(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    chip.status = IDLE._replace(state=State.RUNNING)
    result = tornillo("serial", "LATHE-07")
    assert result.exit_code == 1
    assert "SERIAL_SET was refused: the lathe is moving" in result.stderr


def test_udev_prints_the_rule() -> None:
    result = CliRunner().invoke(main, ["udev"])
    assert (result.exit_code, result.stdout) == (0, RULE.read_text(encoding="utf-8"))


def test_the_rule_matches_lathe_and_loader_sets_the_rights_and_sends_modem_manager_away() -> None:
    lines = udev.rule().replace("\\\n", "").splitlines()
    rules = {line.split(",")[0]: line for line in lines if line.startswith("SUBSYSTEM")}
    products = f"{USB_PRODUCT_ID:04x}|{USB_LOADER_PRODUCT_ID:04x}"
    ids = (f'{{idVendor}}=="{USB_VENDOR_ID:04x}"', f'{{idProduct}}=="{products}"')
    assert set(rules) == {'SUBSYSTEM=="usb"', 'SUBSYSTEM=="tty"'}
    for rule in rules.values():
        assert all(part in rule for part in ids)
        assert 'ENV{ID_MM_DEVICE_IGNORE}="1"' in rule
    assert 'ENV{ID_MM_PORT_IGNORE}="1"' in rules['SUBSYSTEM=="tty"']
    for right in ('GROUP="dialout"', 'MODE="0660"', 'TAG+="uaccess"'):
        assert right in rules['SUBSYSTEM=="tty"']


def test_the_rule_comes_before_those_that_it_must_precede() -> None:
    # 73-seat-late.rules gives out `uaccess`, 77-mm-*.rules are ModemManager's.
    assert int(udev.RULE_FILE.split("-")[0]) < 73


def test_udev_installs_the_rule_in_the_system_at_root(tmp_path: Path) -> None:
    assert not udev.installed(tmp_path)
    result = CliRunner().invoke(main, ["udev", "--install", "--root", str(tmp_path)])
    assert result.exit_code == 0
    assert f"{tmp_path / PLACE} written" in result.stdout
    assert (tmp_path / PLACE).read_text(encoding="utf-8") == udev.rule()
    assert udev.installed(tmp_path)


def test_an_old_rule_is_replaced(tmp_path: Path) -> None:
    place = tmp_path / PLACE
    place.parent.mkdir(parents=True)
    place.write_text("# old\n", encoding="utf-8")
    assert not udev.installed(tmp_path)
    udev.install(tmp_path)
    assert udev.installed(tmp_path)


def test_without_rights_the_line_with_sudo_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_arguments: object, **_options: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("pathlib.Path.write_text", refuse)
    result = CliRunner().invoke(main, ["udev", "--install", "--root", str(tmp_path)])
    assert result.exit_code == 1
    assert "this user may not write" in result.stderr
    assert 'Try: type `sudo "$(command -v tornillo)" udev --install`' in result.stderr


def test_a_place_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "etc").touch()
    with pytest.raises(TornilloError, match=r"cannot be written: Not a directory"):
        udev.install(tmp_path)


def test_on_other_systems_there_is_nothing_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.platform", "darwin")
    with pytest.raises(TornilloError, match="only Linux has udev"):
        udev.install(tmp_path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("found", ["/sbin/udevadm", None])
def test_in_the_running_system_udev_is_told_to_read_its_rules(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, found: str | None
) -> None:
    ran: list[list[str]] = []

    def run(command: list[str], **_options: object) -> SimpleNamespace:
        ran.append(command)
        return SimpleNamespace(returncode=0)

    monkeypatch.setattr("tornillo.udev.ROOT", tmp_path)
    monkeypatch.setattr("shutil.which", lambda _name: found)
    monkeypatch.setattr("subprocess.run", run)
    (tmp_path / PLACE).parent.mkdir(parents=True)
    path = udev.install(tmp_path)
    reload = [["control", "--reload"], ["trigger", "--subsystem-match=tty"]]
    assert ran == ([["/sbin/udevadm", *words] for words in reload] if found else [])
    assert stat.S_ISREG(path.stat().st_mode)


def test_a_computer_without_udev_is_told_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tornillo.udev.ROOT", tmp_path)
    monkeypatch.setattr("shutil.which", lambda _name: None)
    with pytest.raises(TornilloError, match="this computer has no udev"):
        udev.install(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_why_it_takes_longer_is_told_on_the_way(
    tornillo: Tornillo, port: ScriptedPort, monkeypatch: pytest.MonkeyPatch
) -> None:
    def open_late(_name: str, notify: Callable[[str], None]) -> ScriptedPort:
        notify("COM3 is in use; trying for 5 s")
        return port

    monkeypatch.setattr("tornillo.lathe.open_port", open_late)
    result = tornillo("serial")
    assert (result.stdout, result.stderr) == ("T0000001\n", "COM3 is in use; trying for 5 s\n")
