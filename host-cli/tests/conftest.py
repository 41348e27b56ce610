# SPDX-License-Identifier: Apache-2.0
"""What the tests of the host share: a scripted lathe, the command line, part texts."""

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from click.testing import CliRunner, Result
from console import Tornillo
from hex_files import firmware_file, program
from hypothesis import settings
from scripted_chip import ScriptedChip, ScriptedPort
from scripted_loader import ScriptedSocket

from tornillo import language
from tornillo.cli import main
from tornillo.lathe import Lathe
from tornillo.machine import Machine

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"

settings.register_profile("tornillo", deadline=None)
settings.load_profile("tornillo")


@pytest.fixture(autouse=True)
def _english(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Whoever runs the tests, the program speaks English unless a test asks for more."""
    monkeypatch.setenv("LANGUAGE", "en")
    monkeypatch.setenv("TORNILLO_LANG", "en")
    language.use("en")
    yield
    language.use("en")


@pytest.fixture
def chip() -> ScriptedChip:
    """An idle, homed lathe without parts."""
    return ScriptedChip()


@pytest.fixture
def port(chip: ScriptedChip, monkeypatch: pytest.MonkeyPatch) -> ScriptedPort:
    """The port of `chip`, whose clock is the one of the link."""
    port = ScriptedPort(chip)
    clock = SimpleNamespace(monotonic=lambda: port.now)
    monkeypatch.setattr("tornillo.link.time", clock)
    monkeypatch.setattr("tornillo.loader.time", clock)
    return port


@pytest.fixture
def socket(monkeypatch: pytest.MonkeyPatch) -> ScriptedSocket:
    """A lathe in a USB socket, with a firmware that may be replaced, and its clock."""
    socket = ScriptedSocket()
    socket.loader.put(program((0, 1, 0)))

    def sleep(seconds: float) -> None:
        socket.now += seconds

    clock = SimpleNamespace(monotonic=lambda: socket.now, sleep=sleep)
    for module in ("link", "loader", "flashing"):
        monkeypatch.setattr(f"tornillo.{module}.time", clock)
    monkeypatch.setattr("serial.tools.list_ports.comports", socket.comports)
    monkeypatch.setattr("tornillo.versions.holders", lambda _port: [])
    for module in ("flashing", "lathe"):
        monkeypatch.setattr(f"tornillo.{module}.open_port", socket.open)
    return socket


@pytest.fixture
def new(tmp_path: Path) -> Path:
    """The file of firmware 0.2.0."""
    return firmware_file(tmp_path)


@pytest.fixture
def lathe(port: ScriptedPort) -> Lathe:
    """The library connected to `port`."""
    return Lathe(port)


@pytest.fixture
def machine() -> Machine:
    """The machine file that comes with tornillo."""
    return Machine.load()


@pytest.fixture
def tornillo(port: ScriptedPort, monkeypatch: pytest.MonkeyPatch) -> Tornillo:
    """Run the command line; every port it opens is `port`."""
    monkeypatch.setattr("tornillo.lathe.find_port", lambda _wanted: "scripted")
    monkeypatch.setattr("tornillo.lathe.open_port", lambda *_arguments: port)
    monkeypatch.setattr("tornillo.commands.following.POLL_S", 0)

    def run(*arguments: str | Path, typed: str = "") -> Result:
        return CliRunner().invoke(main, [str(argument) for argument in arguments], input=typed)

    return run


@pytest.fixture
def test_bar() -> Path:
    """The part file of the paper's test bar."""
    return EXAMPLES / "test-bar.toml"


@pytest.fixture
def stepped_pin() -> Path:
    """The metric example."""
    return EXAMPLES / "stepped-pin.toml"


@pytest.fixture
def loaded(tornillo: Tornillo, chip: ScriptedChip, test_bar: Path) -> ScriptedChip:
    """A chip with the test bar stored and selected."""
    tornillo("upload", test_bar)
    chip.selected = 0
    return chip
