# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C in any verb is a controlled hold that says what happened."""

import os
import signal
from pathlib import Path

import pytest
from console import Tornillo
from scripted_chip import IDLE, ScriptedChip, ScriptedPort

from tornillo.protocol import Command, State


def press_once(chip: ScriptedChip) -> None:
    """Ctrl-C at the next status; later ones come as usual."""

    def press() -> None:
        chip.at_status = lambda: None
        raise KeyboardInterrupt

    chip.at_status = press


@pytest.mark.parametrize(
    ("state", "after", "message"),
    [
        (State.RUNNING, State.HOLD, "held by Ctrl-C at operation 2 of 3; nothing is lost"),
        (State.HOMING, State.IDLE, "homing was stopped"),
        (State.HOLD, State.HOLD, "interrupted; the run stands still and nothing is lost"),
        (State.PAUSE, State.PAUSE, "interrupted; the run stands still and nothing is lost"),
        (State.IDLE, State.IDLE, "interrupted; the lathe was not cutting"),
        (State.ALARM, State.ALARM, "interrupted; the lathe was not cutting"),
    ],
)
def test_ctrl_c_brings_every_state_to_a_stand(
    tornillo: Tornillo, chip: ScriptedChip, state: State, after: State, message: str
) -> None:
    chip.status = IDLE._replace(state=state, operation=2, operations=3)
    press_once(chip)
    result = tornillo("status")
    assert result.exit_code == 1
    assert f"Error: {message}\n" in result.stderr
    assert "\nTry: " in result.stderr
    assert chip.status.state is after


def test_a_second_ctrl_c_does_not_break_off_the_hold(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    def press_again() -> None:
        os.kill(os.getpid(), signal.SIGINT)
        chip.at_status = lambda: None

    def press() -> None:
        chip.at_status = press_again
        raise KeyboardInterrupt

    chip.status = IDLE._replace(state=State.RUNNING)
    chip.at_status = press
    result = tornillo("status")
    assert result.exit_code == 1
    assert "held by Ctrl-C" in result.stderr
    assert chip.status.state is State.HOLD
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_ctrl_c_without_a_link_says_to_press_hold(
    tornillo: Tornillo, chip: ScriptedChip, port: ScriptedPort
) -> None:
    def pull() -> None:
        port.unplugged = True
        raise KeyboardInterrupt

    chip.at_status = pull
    result = tornillo("status")
    assert result.exit_code == 1
    assert "interrupted, but the lathe did not hear of it" in result.stderr
    assert "Try: press HOLD at the lathe" in result.stderr


def test_ctrl_c_without_a_lathe_just_ends(
    tornillo: Tornillo, monkeypatch: pytest.MonkeyPatch, test_bar: Path
) -> None:
    def press(_path: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("tornillo.part.Part.load", press)
    result = tornillo("check", test_bar)
    assert result.exit_code == 1
    assert "Error: interrupted\n" in result.stderr


def test_an_interrupted_upload_stores_nothing(
    tornillo: Tornillo, chip: ScriptedChip, test_bar: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def press(_payload: bytes) -> bytes:
        raise KeyboardInterrupt

    monkeypatch.setattr(chip, "do_upload_data", press)
    result = tornillo("upload", test_bar)
    assert result.exit_code == 1
    assert chip.slots == {}
    assert Command.UPLOAD_COMMIT not in chip.executed
