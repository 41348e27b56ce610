# SPDX-License-Identifier: Apache-2.0
"""What the command line says of parts that were not finished, and of what has changed."""

import json

import pytest
from console import Tornillo
from scripted_chip import IDLE, ScriptedChip

from tornillo.protocol import (
    Command,
    ErrorCode,
    HomedAxis,
    MachineWarning,
    ProgressData,
    SettingId,
    State,
)


def test_run_resume_tells_the_chip_and_the_place(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    loaded.progress = ProgressData(slot=0, crc=0x1234, operation=2, pass_number=3)
    result = tornillo("run", "--resume")
    assert result.exit_code == 0
    assert "going on behind operation 2, pass 3" in result.stderr
    assert loaded.resumed
    assert not loaded.step
    assert loaded.status.state == State.RUNNING


@pytest.mark.parametrize("arguments", [("run", "--resume"), ("run", "test-bar", "--resume")])
def test_run_resume_with_nothing_begun_is_refused(
    tornillo: Tornillo, loaded: ScriptedChip, arguments: tuple[str, ...]
) -> None:
    result = tornillo(*arguments)
    assert result.exit_code == 1
    assert "no part, or not this one, was begun and not finished" in result.stderr
    assert Command.RUN not in loaded.executed


def test_run_resume_of_another_part_than_the_one_begun_is_refused(
    tornillo: Tornillo, loaded: ScriptedChip
) -> None:
    loaded.progress = ProgressData(slot=3, crc=0x1234, operation=2, pass_number=3)
    assert tornillo("run", "test-bar", "--resume").exit_code == 1
    assert Command.RUN not in loaded.executed


def test_run_of_a_part_made_for_other_step_sizes_says_so(
    tornillo: Tornillo, loaded: ScriptedChip
) -> None:
    loaded.values[SettingId.STEP_X_NM] = 6000
    loaded.refusals[Command.RUN] = bytes([ErrorCode.INVALID_PART])
    result = tornillo("run")
    assert result.exit_code == 1
    assert "the step size was changed since these parts were stored: test-bar" in result.stderr
    loaded.values[SettingId.STEP_X_NM] = 7112
    assert "the chip refuses the part" in tornillo("run").stderr


def test_status_tells_an_unfinished_part_and_warnings(
    tornillo: Tornillo, loaded: ScriptedChip
) -> None:
    loaded.status = IDLE._replace(warnings=MachineWarning.DEAD_X)
    loaded.progress = ProgressData(slot=0, crc=0x1234, operation=2, pass_number=0)
    text = tornillo("status").stdout
    assert "test-bar, completed up to operation 2; home, then `tornillo run --resume`" in text
    assert "the dead steps of X are not what the homing before found" in text
    found = json.loads(tornillo("status", "--json").stdout)
    assert found["unfinished"] == {"slot": 0, "crc": 0x1234, "operation": 2, "pass_number": 0}
    assert (found["warnings"], found["homed_axes"]) == (["DEAD_X"], ["X", "Z"])


def test_status_tells_which_axis_is_homed(tornillo: Tornillo, chip: ScriptedChip) -> None:
    chip.status = IDLE._replace(flags=0, homed_axes=HomedAxis.Z)
    assert "unknown: not homed, only Z" in tornillo("status").stdout
