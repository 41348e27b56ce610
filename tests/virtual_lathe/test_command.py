# SPDX-License-Identifier: Apache-2.0
"""The command line: options, port, buttons typed while it runs, report."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from virtual_lathe.command import build_parser

Program = Callable[[str], str]
ROOT = Path(__file__).resolve().parents[2]


def test_a_nose_radius_may_be_given_and_a_negative_one_is_refused(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert build_parser().parse_args([]).nose_radius is None
    assert build_parser().parse_args(["--nose-radius", "0.4"]).nose_radius == 0.4
    with pytest.raises(SystemExit):
        build_parser().parse_args(["--nose-radius", "-0.4"])
    assert "a nose radius is 0 or more" in capsys.readouterr().err


def test_buttons_are_pressed_at_times_and_unknown_ones_refused() -> None:
    arguments = build_parser().parse_args(["--press", "run@5.0", "--press", "estop@7"])
    assert arguments.press == [("run", 5.0), ("estop", 7.0)]
    with pytest.raises(SystemExit):
        build_parser().parse_args(["--press", "bell@5"])


def test_the_command_prints_the_port_obeys_and_reports(program: Program, tmp_path: Path) -> None:
    report, link, memory = tmp_path / "r.json", tmp_path / "port", tmp_path / "memory.bin"
    command = [sys.executable, "-m", "virtual_lathe", "--firmware", program("memories")]
    command += ["--report", str(report), "--port-link", str(link), "--eeprom-file", str(memory)]
    command += ["--seconds", "0.2", "--no-usb"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "tests")}
    done = subprocess.run(
        command,
        input="state\nwhistle\n",
        capture_output=True,
        text=True,
        env=environment,
        check=True,
        timeout=60,
    )
    lines = done.stdout.splitlines()
    assert lines[0] == f"port: {link}"
    assert any(line.startswith("t=") for line in lines)
    assert "not understood: whistle" in lines
    found = json.loads(report.read_text(encoding="utf-8"))
    assert found["virtual_seconds"] == pytest.approx(0.2, abs=0.01)
    assert (found["lost_steps"], found["crashes"], found["usb_errors"]) == (0, [], [])
    assert found["profile"][0][1] == pytest.approx(25.4, abs=0.02)
    assert memory.read_bytes()[0x8000 + 0x21] == 0x5A
    assert not link.exists()
