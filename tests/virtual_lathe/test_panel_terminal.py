# SPDX-License-Identifier: Apache-2.0
"""The panel by hand: typed lines in a pipe, single keys on a terminal, a picture at the end."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pexpect
import pytest
from PIL import Image

from virtual_lathe.command import build_parser
from virtual_lathe.panel import KEYS
from virtual_lathe.panel_picture import DARK
from virtual_lathe.panel_terminal import KEYS_OF_TERMINAL, actions

Program = Callable[..., str]
ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT / "tests")}
COMMAND = [sys.executable, "-m", "virtual_lathe", "--no-usb"]


def _run(*arguments: str, typed: str = "") -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*COMMAND, *arguments],
        input=typed,
        capture_output=True,
        text=True,
        env=ENVIRONMENT,
        check=False,
        timeout=60,
    )


def _keys_shown(output: str) -> list[str]:
    """Last letter of the second line of each frame printed."""
    lines = output.splitlines()
    tops = [at for at, line in enumerate(lines) if line == "╭────────────────╮"]
    assert all(lines[at + 3] == "╰────────────────╯" for at in tops)
    return [lines[at + 2][-2] for at in tops]


def test_typed_lines_press_keys_one_after_the_other(program: Program, tmp_path: Path) -> None:
    picture = tmp_path / "glass.png"
    typed = "key down\nkey x-in 0.2\nkey enter\nkey up -1\nstate\n"
    done = _run(
        *("--firmware", program("panel"), "--panel", "--seconds", "0.8"),
        *("--panel-picture", str(picture), "--press", "back@0.6"),
        typed=typed,
    )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[0].startswith("port: ")
    assert "│Diámetro 25.4°  │" in lines
    assert any(line.startswith("t=") for line in lines)
    assert f"no key 'enter': {', '.join(KEYS)}" in lines
    assert "a key is held for 0 to 600 seconds, not -1" in lines
    # The capacitor passes the voltages of other keys on its way: only what stays counts.
    shown = [key for key in _keys_shown(done.stdout) if key in "1785"]
    assert [key for at, key in enumerate(shown) if shown[at - 1 : at] != [key]] == list("187858")
    with Image.open(picture) as image:
        assert bytes.fromhex(DARK[1:]) in image.convert("RGB").tobytes()


def test_without_a_panel_keys_are_refused(program: Program) -> None:
    firmware = program("panel")
    done = _run("--firmware", firmware, "--seconds", "0.05", typed="key up\n")
    assert "no panel is fitted: --panel does it" in done.stdout
    done = _run("--firmware", firmware, "--press", "up@1")
    assert done.returncode == 1
    assert "--press up: no panel is fitted, --panel does it" in done.stderr


def test_a_picture_is_a_png_or_an_svg(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        build_parser().parse_args(["--panel-picture", "glass.pdf"])
    assert "'glass.pdf': a picture is a .png or a .svg" in capsys.readouterr().err


def test_every_key_of_the_panel_has_one_on_the_terminal() -> None:
    assert set(KEYS) < set(KEYS_OF_TERMINAL.values())
    assert actions(b"\x1b[A\x1bOBo\r\x7f\x1bz") == ["up", "down", "x-out", "ok", "back", "back"]


def test_single_keys_on_a_terminal_press_those_of_the_panel(program: Program) -> None:
    command = [*COMMAND[1:], "--firmware", program("panel"), "--panel"]
    child = pexpect.spawn(
        COMMAND[0], command, env=ENVIRONMENT, encoding="utf-8", timeout=30, dimensions=(24, 100)
    )
    child.expect_exact("Diámetro 25.4°")
    child.expect_exact("8│")
    child.expect_exact("Enter OK")
    for sent, number in (("\x1b[B", 1), ("\x1b[C", 3), ("\r", 4), ("o", 6)):
        child.send(sent)
        child.expect_exact(f"{number}│")
        child.expect_exact("8│")
    child.send("t")
    child.expect_exact("tool")
    child.expect_exact("╭──")
    child.send("q")
    child.expect(pexpect.EOF)
    child.close()
    assert child.exitstatus == 0
