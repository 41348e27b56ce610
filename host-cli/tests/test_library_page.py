# SPDX-License-Identifier: Apache-2.0
"""The examples of docs/library.md, run as they are printed, and its figures."""

import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from moving_chip import MovingChip
from scripted_chip import IDLE, ScriptedChip, ScriptedPort

from tornillo.errors import PortError
from tornillo.link import REQUEST_S
from tornillo.opening import PATIENCE_S
from tornillo.ports import port_name
from tornillo.protocol import Axis, Command, State

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "library.md").read_text(encoding="utf-8")
EXAMPLES = dict(re.findall(r"<!-- test: (\w+) -->\n```python\n(.*?)```", PAGE, re.DOTALL))
CUTTING = IDLE._replace(state=State.RUNNING, permille=500)


@pytest.fixture(autouse=True)
def plugged(monkeypatch: pytest.MonkeyPatch, port: ScriptedPort) -> None:
    """One lathe is plugged in, and the reader is in the folder of the project."""
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr("tornillo.lathe.find_port", lambda _wanted: "scripted")
    monkeypatch.setattr("tornillo.lathe.open_port", lambda *_arguments: port)


def run(name: str) -> None:
    """Run one example."""
    exec(compile(EXAMPLES[name], f"docs/library.md: {name}", "exec"), {"__name__": name})


def test_every_example_of_the_page_is_run_by_a_test() -> None:
    assert sorted(EXAMPLES) == ["cut", "errors", "move"]
    assert PAGE.count("```python") == len(EXAMPLES)


def test_the_example_cuts_a_part(
    chip: ScriptedChip, port: ScriptedPort, capsys: pytest.CaptureFixture[str]
) -> None:
    states = iter(range(100))

    def go_on() -> None:
        polls = next(states)
        if chip.status.state == State.HOMING:
            chip.status = IDLE
        elif chip.status.state == State.RUNNING:
            chip.status = CUTTING if polls < 8 else IDLE._replace(permille=1000)

    chip.at_status = go_on
    run("cut")
    printed = capsys.readouterr().out.splitlines()
    assert printed[0] == "dead steps: X 23, Z 31"
    assert "RUNNING, 50.0 %" in printed
    assert printed[-1] == "finished"
    assert [code for code in chip.executed if code in (Command.HOME, Command.RUN)] == [
        Command.HOME,
        Command.RUN,
    ]
    assert port.closed


def test_the_example_moves_and_touches(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    chip = MovingChip()
    chip.surfaces = [-1789, -1790, -1789]
    port = ScriptedPort(chip)
    monkeypatch.setattr("tornillo.link.time", SimpleNamespace(monotonic=lambda: port.now))
    monkeypatch.setattr("tornillo.lathe.open_port", lambda *_arguments: port)
    run("move")
    assert capsys.readouterr().out == "-1600\ntouched at -1789, 1 steps apart\n"
    assert chip.zeroed == [(Axis.X, 1786 + 189)]


def test_the_example_tells_every_kind_of_error(
    chip: ScriptedChip,
    port: ScriptedPort,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run("errors")
    assert capsys.readouterr().out == "chip: NOT_RUNNING\n"
    chip.protocol += 1
    run("errors")
    assert capsys.readouterr().out.startswith("version: the firmware 0.1.0 speaks protocol")
    port.unplugged = True
    run("errors")
    assert capsys.readouterr().out.startswith("link: the connection was lost")

    def refuse(*_arguments: object) -> None:
        raise PortError("COM3 is in use", "close it")

    monkeypatch.setattr("tornillo.lathe.open_port", refuse)
    run("errors")
    assert capsys.readouterr().out == "port: COM3 is in use\n"


def test_the_figures_and_port_names_of_the_page_are_those_of_the_library() -> None:
    assert f"(`tornillo.link.REQUEST_S`) | {REQUEST_S:g} s |" in PAGE
    assert f"held for a moment | {PATIENCE_S:g} s and one request" in PAGE
    for name in ("/dev/ttyACM0", "ttyACM0", "/dev/cu.usbmodem14101", "COM3", r"\\.\COM12"):
        assert f"`{name}`" in PAGE
        assert port_name(name) is not None
    assert port_name("TN4KX2QZ") is None
