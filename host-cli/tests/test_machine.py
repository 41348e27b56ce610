# SPDX-License-Identifier: Apache-2.0
"""Machine files, and finding and opening the port."""

import errno
from pathlib import Path
from types import SimpleNamespace

import pytest
from scripted_chip import ScriptedChip, ScriptedPort
from serial import SerialException

from tornillo.errors import LinkError, MachineError, PortError
from tornillo.lathe import Lathe
from tornillo.machine import Machine
from tornillo.ports import find_port, open_port
from tornillo.protocol import SETTINGS, SettingId

MACHINES = Path(__file__).resolve().parents[1] / "machines"


def test_the_shipped_machine_has_the_defaults_of_the_firmware(machine: Machine) -> None:
    defaults = {entry.id: entry.default for entry in SETTINGS}
    assert machine.step_x_nm == defaults[SettingId.STEP_X_NM]
    assert machine.step_z_nm == defaults[SettingId.STEP_Z_NM]
    assert machine.travel_x == defaults[SettingId.TRAVEL_X]
    assert machine.travel_z == defaults[SettingId.TRAVEL_Z]
    assert machine.zero_x == defaults[SettingId.ZERO_X]
    assert machine.zero_z == defaults[SettingId.ZERO_Z]
    assert machine.max_rate == defaults[SettingId.RAPID_RATE_X]
    assert (machine.spindle_min_rpm, machine.spindle_max_rpm) == (100, 3800)


def test_a_machine_file_can_be_named_by_its_path(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    text = (MACHINES / "otmt-co.toml").read_text(encoding="utf-8")
    path.write_text(text.replace("x_nm = 7112", "x_nm = 1778"), encoding="utf-8")
    assert Machine.load(str(path)).step_x_nm == 1778


def test_an_unknown_machine_is_refused_naming_the_known_ones() -> None:
    with pytest.raises(MachineError, match="machine otmt") as caught:
        Machine.load("otmt")
    assert "otmt-co" in caught.value.remedy


@pytest.mark.parametrize("text", ["[step]\nx_nm = 7.5", "[step]\nx_nm = true", "step = 3", ""])
def test_a_machine_file_without_whole_numbers_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(MachineError, match=r"\[step\] x_nm must be a whole number"):
        Machine.load(str(path))


def test_a_connected_machine_is_the_one_that_hello_tells(lathe: Lathe, chip: ScriptedChip) -> None:
    chip.values[SettingId.RAPID_RATE_Z] = 700
    chip.values[SettingId.ZERO_Z] = -9000
    machine = lathe.machine()
    assert (machine.max_rate, machine.zero_z, machine.step_x_nm) == (700, -9000, 7112)


def plug_in(monkeypatch: pytest.MonkeyPatch, *ports: tuple[str, int, int]) -> None:
    """Let the system have these ports: name, vendor, product."""
    found = [
        SimpleNamespace(device=name, vid=vid, pid=pid, serial_number=f"S{name[-1]}")
        for name, vid, pid in ports
    ]
    monkeypatch.setattr("serial.tools.list_ports.comports", lambda: found)


def test_the_port_is_found_by_its_usb_id(monkeypatch: pytest.MonkeyPatch) -> None:
    plug_in(monkeypatch, ("/dev/ttyS0", 0, 0), ("/dev/ttyACM1", 0x1209, 1))
    assert find_port() == "/dev/ttyACM1"


def test_no_lathe_and_several_lathes_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    plug_in(monkeypatch)
    with pytest.raises(PortError, match="no lathe found: no port has the USB id 1209:0001"):
        find_port()
    plug_in(monkeypatch, ("COM3", 0x1209, 1), ("COM4", 0x1209, 1))
    with pytest.raises(PortError, match=r"COM3 \(serial number S3\), COM4") as caught:
        find_port()
    assert "--port" in caught.value.remedy


@pytest.mark.parametrize(
    ("error", "message", "remedy"),
    [
        (SerialException(errno.EACCES, "Permission denied"), "no permission to use P", "dialout"),
        (SerialException("PermissionError(13, 'Access is denied.')"), "no permission", "close the"),
        (SerialException(errno.EBUSY, "Device or resource busy"), "P is in use", "ModemManager"),
        (SerialException("Could not exclusively lock port P"), "P is in use", "ModemManager"),
        (SerialException(errno.ENOENT, "No such file"), "there is no port P", "USB id"),
        (SerialException("FileNotFoundError(2)"), "there is no port P", "USB id"),
        (SerialException(errno.EIO, "Input/output error"), "P cannot be opened", "the lathe's"),
    ],
)
def test_a_port_that_does_not_open_is_explained(
    monkeypatch: pytest.MonkeyPatch, error: SerialException, message: str, remedy: str
) -> None:
    def fail(*_arguments: object, **_options: object) -> None:
        raise error

    monkeypatch.setattr("serial.Serial", fail)
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
    assert options["exclusive"] is True


def test_the_port_is_closed_when_something_else_answers(
    monkeypatch: pytest.MonkeyPatch, port: ScriptedPort, chip: ScriptedChip
) -> None:
    chip.protocol = 9
    monkeypatch.setattr("tornillo.lathe.open_port", lambda _name: port)
    with pytest.raises(LinkError, match="speaks protocol 9, this tornillo speaks 1") as caught:
        Lathe.open("P")
    assert "update the firmware" in caught.value.remedy
    assert port.closed


def test_leaving_the_with_block_closes_the_port(
    monkeypatch: pytest.MonkeyPatch, port: ScriptedPort
) -> None:
    monkeypatch.setattr("tornillo.lathe.open_port", lambda _name: port)
    monkeypatch.setattr("tornillo.lathe.find_port", lambda: "found")
    with Lathe.open() as lathe:
        assert (lathe.firmware, lathe.serial_number) == ("0.1.0", "T0000001")
        assert not port.closed
    assert port.closed
