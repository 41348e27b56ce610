# SPDX-License-Identifier: Apache-2.0
"""Finding the lathe among the ports of Linux, macOS and Windows."""

from pathlib import Path
from types import SimpleNamespace

import pytest
from click.testing import CliRunner
from scripted_chip import ScriptedPort

from tornillo import Lathe
from tornillo.cli import main
from tornillo.errors import PortError
from tornillo.ports import find_port, found_lathes, port_name
from tornillo.protocol import USB_PRODUCT_ID, USB_VENDOR_ID

LINUX = ("/dev/ttyACM0", "/dev/ttyACM1")
MACOS = ("/dev/cu.usbmodem14101", "/dev/cu.usbmodem14201")
WINDOWS = ("COM3", "COM12")
SERIALS = ("TN000001", "TN000002")
OTHERS = (("/dev/ttyS0", None, None), ("/dev/ttyUSB0", 0x0403, 0x6001), ("COM1", None, None))


def entry(name: str, vendor: int | None, product: int | None, serial: str | None) -> object:
    """A port as pyserial lists it."""
    return SimpleNamespace(device=name, vid=vendor, pid=product, serial_number=serial)


def plug_in(
    monkeypatch: pytest.MonkeyPatch, names: tuple[str, ...], serials: tuple[str | None, ...]
) -> None:
    """Let the system have these lathes beside some other ports."""
    ports = [entry(name, vendor, product, None) for name, vendor, product in OTHERS]
    ports += [
        entry(name, USB_VENDOR_ID, USB_PRODUCT_ID, serial)
        for name, serial in zip(names, serials, strict=True)
    ]
    monkeypatch.setattr("serial.tools.list_ports.comports", lambda: ports)


@pytest.mark.parametrize("names", [LINUX, MACOS, WINDOWS])
def test_the_only_lathe_is_found_by_its_usb_id(
    monkeypatch: pytest.MonkeyPatch, names: tuple[str, str]
) -> None:
    plug_in(monkeypatch, names[1:], SERIALS[1:])
    assert find_port() == names[1]
    assert found_lathes() == [(names[1], SERIALS[1])]


def test_no_lathe_is_told_with_the_usb_id(monkeypatch: pytest.MonkeyPatch) -> None:
    plug_in(monkeypatch, (), ())
    for wanted in (None, "TN000001"):
        with pytest.raises(PortError, match="no port has the USB id 1209:0001") as caught:
            find_port(wanted)
        assert "plug in the USB cable" in caught.value.remedy


@pytest.mark.parametrize("names", [LINUX, MACOS, WINDOWS])
def test_several_lathes_are_listed_with_serial_numbers_and_how_to_choose(
    monkeypatch: pytest.MonkeyPatch, names: tuple[str, str]
) -> None:
    plug_in(monkeypatch, names, SERIALS)
    with pytest.raises(PortError) as caught:
        find_port()
    for name, serial in zip(names, SERIALS, strict=True):
        assert f"{name} (serial number {serial})" in str(caught.value)
    first, serial = found_lathes()[0]
    assert f"`tornillo --port {first} ...` or `tornillo --port {serial} ...`" in (
        caught.value.remedy
    )


@pytest.mark.parametrize("serials", [("00000000", "00000000"), (None, None)])
def test_several_lathes_that_look_alike_get_the_advice_to_number_them(
    monkeypatch: pytest.MonkeyPatch, serials: tuple[str | None, str | None]
) -> None:
    plug_in(monkeypatch, LINUX, serials)
    with pytest.raises(PortError, match="more than one lathe found") as caught:
        find_port()
    assert "`tornillo --port /dev/ttyACM0 serial --random`" in caught.value.remedy


@pytest.mark.parametrize("names", [LINUX, MACOS, WINDOWS])
@pytest.mark.parametrize("wanted", ["TN000002", "tn000002"])
def test_a_lathe_is_chosen_by_its_serial_number(
    monkeypatch: pytest.MonkeyPatch, names: tuple[str, str], wanted: str
) -> None:
    plug_in(monkeypatch, names, SERIALS)
    assert find_port(wanted) == names[1]


def test_an_unknown_serial_number_is_refused_naming_the_known_ones(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plug_in(monkeypatch, LINUX, SERIALS)
    with pytest.raises(PortError, match="no lathe has the serial number TN000009") as caught:
        find_port("TN000009")
    assert "/dev/ttyACM1 (serial number TN000002)" in caught.value.remedy


def test_a_serial_number_that_two_lathes_have_does_not_choose(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plug_in(monkeypatch, LINUX, ("00000000", "00000000"))
    with pytest.raises(PortError, match="more than one lathe found"):
        find_port("00000000")


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("/dev/ttyACM0", "/dev/ttyACM0"),
        ("ttyACM0", "/dev/ttyACM0"),
        ("/dev/serial/by-id/usb-Tornillo", "/dev/serial/by-id/usb-Tornillo"),
        ("build/port", "build/port"),
        ("/dev/cu.usbmodem14101", "/dev/cu.usbmodem14101"),
        ("/dev/tty.usbmodem14101", "/dev/cu.usbmodem14101"),
        ("cu.usbmodem14101", "/dev/cu.usbmodem14101"),
        ("tty.usbmodem14101", "/dev/cu.usbmodem14101"),
        ("COM3", "COM3"),
        ("com3:", "COM3"),
        (r"\\.\COM12", "COM12"),
        (r"\\?\com12", "COM12"),
        ("TN000001", None),
        ("COMET", None),
    ],
)
def test_the_port_names_of_every_system_are_known(text: str, name: str | None) -> None:
    assert port_name(text) == name


def test_a_file_beside_us_is_a_port_without_any_slash(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("port").touch()
    assert port_name("port") == "port"


def test_the_command_line_takes_a_serial_number_for_the_port(
    monkeypatch: pytest.MonkeyPatch, port: ScriptedPort
) -> None:
    opened: list[str] = []

    def remember(name: str, *_arguments: object) -> ScriptedPort:
        opened.append(name)
        return port

    plug_in(monkeypatch, WINDOWS, SERIALS)
    monkeypatch.setattr("tornillo.lathe.open_port", remember)
    assert CliRunner().invoke(main, ["--port", "TN000002", "status"]).exit_code == 0
    assert CliRunner().invoke(main, ["--port", r"\\.\COM3", "status"]).exit_code == 0
    with Lathe.open("TN000001") as lathe:
        assert lathe.status().homed
    assert opened == ["COM12", "COM3", "COM3"]
