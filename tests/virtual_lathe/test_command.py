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


PART = """
[part]
name = "grooved"
units = "mm"
[stock]
diameter = 10.0
length = 20.0
[[tool]]
name = "right"
nose_radius = 0.2
[[tool]]
name = "groover"
width = 1.0
[[operation]]
type = "cylinder"
z = [0.0, -8.0]
diameter = 8.0
[[operation]]
type = "groove"
z = [-3.0, -5.0]
diameter = 6.0
tool = "groover"
"""


def test_tools_are_changed_by_name_or_in_turn(program: Program, tmp_path: Path) -> None:
    report, part = tmp_path / "r.json", tmp_path / "part.toml"
    part.write_text(PART, encoding="utf-8")
    command = [sys.executable, "-m", "virtual_lathe", "--firmware", program("memories")]
    command += ["--report", str(report), "--part", str(part), "--nose-radius", "0.4"]
    command += ["--seconds", "0.2", "--no-usb"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "tests")}
    done = subprocess.run(
        command,
        input="tool next\ntool next\ntool saw\ntool right\nstate\n",
        capture_output=True,
        text=True,
        env=environment,
        check=True,
        timeout=60,
    )
    answers = [line for line in done.stdout.splitlines() if "tool" in line]
    assert answers[:4] == [
        "tool: groover",
        "the part needs no other tool",
        "no tool 'saw': right, groover",
        "tool: right",
    ]
    assert answers[4].endswith("tool=right")
    found = json.loads(report.read_text(encoding="utf-8"))
    assert (found["tool"], found["nose_radius_mm"]) == ("right", 0.4)
    assert found["gouge_max_steps"] == 0
    assert found["left_max_steps"] > 100
    names = [entry["name"] for entry in found["dimensions"]]
    assert names == [
        *("cylinder 1 diameter", "cylinder 1 length"),
        *("groove 1 diameter", "groove 1 width", "groove 1 z"),
    ]
    assert found["angles"] == found["circles"] == []
