# SPDX-License-Identifier: Apache-2.0
"""`tornillo jog` without more: the pad of the connected lathe."""

import pytest
from console import Tornillo
from pressed import PressedKeys
from scripted_chip import IDLE, ScriptedChip

from tornillo.jogging import SILENCE_MS
from tornillo.protocol import REQUESTS, Command, SettingId, State


def test_the_pad_moves_the_connected_lathe_by_keys(
    tornillo: Tornillo, chip: ScriptedChip, monkeypatch: pytest.MonkeyPatch
) -> None:
    sent: list[tuple[int, ...]] = []

    def jog(payload: bytes) -> bytes:
        sent.append(REQUESTS[Command.JOG].unpack(payload))
        return b""

    monkeypatch.setattr(chip, "do_jog", jog, raising=False)
    monkeypatch.setattr("tornillo.commands.jog_pad.on_terminals", lambda: True)
    keys = PressedKeys("s", "s", "left", None, "c", "r", "up", "q")
    monkeypatch.setattr("tornillo.commands.jog_pad.keyboard", lambda: keys)
    chip.values[SettingId.RAPID_RATE_X] = 5000
    chip.values[SettingId.RAPID_RATE_Z] = 5000
    result = tornillo("jog")
    assert result.exit_code == 0, result.output
    # 0.1 mm towards the chuck at 10 ms a step; then X to the end of its travel, no faster than
    # it can be stopped.
    assert sent == [
        (IDLE.x, IDLE.z - 14, 100, SILENCE_MS),
        (0, IDLE.z, 1000, SILENCE_MS),
    ]
    assert chip.executed[-1] is Command.HOLD
    assert "X (diameter)" in result.stdout


def test_the_pad_needs_a_terminal_and_a_distance_an_axis(tornillo: Tornillo) -> None:
    result = tornillo("jog")
    assert result.exit_code == 2
    assert "moving by keys needs a terminal" in result.stderr
    result = tornillo("jog", "x")
    assert result.exit_code == 2
    assert "say how far, like -0.5mm" in result.stderr


def test_ctrl_c_at_the_pad_holds_the_slides(
    tornillo: Tornillo, chip: ScriptedChip, monkeypatch: pytest.MonkeyPatch
) -> None:
    def press(_look: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("tornillo.commands.jog_pad.on_terminals", lambda: True)
    monkeypatch.setattr("tornillo.commands.jog_pad.keyboard", lambda: PressedKeys(then=press))
    chip.status = IDLE._replace(state=State.MOVING)
    result = tornillo("jog")
    assert result.exit_code == 1
    assert Command.HOLD in chip.executed
    assert chip.executed[-1] is Command.STOP
