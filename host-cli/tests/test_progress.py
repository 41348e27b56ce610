# SPDX-License-Identifier: Apache-2.0
"""Bars for what may take longer than a second, on a terminal alone; JSON for scripts."""

import json
from pathlib import Path

import pytest
from console import Tornillo
from scripted_chip import IDLE, ScriptedChip

from tornillo.protocol import State

PAWN = Path(__file__).resolve().parents[1] / "examples" / "pawn.dxf"


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Messages go to a terminal; files to a folder of the test."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tornillo.commands.progress.on_terminal", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("FORCE_COLOR", "1")


@pytest.mark.usefixtures("terminal")
@pytest.mark.parametrize(
    ("words", "text"),
    [
        (("check", "BAR"), "checking"),
        (("plan", "BAR"), "planning"),
        (("draw", "BAR", "-o", "bar.svg"), "drawing"),
        (("upload", "BAR"), "checking"),
        (("import-dxf", str(PAWN), "-o", "p.toml", "--back-clearance", "52"), "reading the"),
        (("home",), "homing"),
    ],
)
def test_what_takes_longer_shows_a_bar_on_a_terminal(
    tornillo: Tornillo,
    chip: ScriptedChip,
    test_bar: Path,
    words: tuple[str, ...],
    text: str,
) -> None:
    chip.coming = [IDLE._replace(state=State.HOMING), IDLE]
    result = tornillo(*(test_bar if word == "BAR" else word for word in words))
    assert result.exit_code == 0
    assert f"{text}" in result.stderr
    assert "\N{BOX DRAWINGS HEAVY HORIZONTAL}" in result.stderr


def test_no_bar_goes_to_a_file(tornillo: Tornillo, test_bar: Path) -> None:
    result = tornillo("check", test_bar)
    assert result.stderr == ""


def test_check_tells_scripts_its_verdict(
    tornillo: Tornillo, test_bar: Path, tmp_path: Path
) -> None:
    result = tornillo("check", test_bar, "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout) == {
        "name": "test-bar",
        "machine": "otmt-co",
        "operations": 1,
        "bytes": 91,
        "problems": [],
        "notes": [],
    }
    wrong = tmp_path / "wrong.toml"
    text = test_bar.read_text(encoding="utf-8").replace("diameter = 0.600", "diameter = 1.2")
    wrong.write_text(text, encoding="utf-8")
    result = tornillo("check", wrong, "--json")
    assert result.exit_code == 1
    found = json.loads(result.stdout)
    assert found["bytes"] is None
    assert "wrong.toml:31: operation 1 (cylinder)" in found["problems"][0]["message"]
    assert found["problems"][0]["remedy"]


def test_upload_and_serial_tell_scripts_what_they_did(tornillo: Tornillo, test_bar: Path) -> None:
    uploaded = json.loads(tornillo("upload", test_bar, "--json").stdout)
    assert uploaded == {"name": "test-bar", "slot": 0, "bytes": 91, "verified": True}
    assert json.loads(tornillo("serial", "--json").stdout)["serial_number"] == "T0000001"
    changed = json.loads(tornillo("serial", "LATHE-07", "--json").stdout)
    assert changed == {"serial_number": "LATHE-07", "before": "T0000001"}
