# SPDX-License-Identifier: Apache-2.0
"""The verb calibrate, marks: readings typed or from a file, figures printed, values stored."""

import json
from pathlib import Path

import pytest
from console import Tornillo
from scripted_chip import IDLE, ScriptedChip

from tornillo.protocol import Command, SettingId, StatusFlag

S2 = Path(__file__).resolve().parents[1] / "examples" / "s2-marks.txt"
OFFLINE = ("--machine", "otmt-co", "--forward", "1050", "--back", "1050", "--units", "um")


def test_the_readings_of_paper_s2_are_evaluated_without_a_lathe(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    result = tornillo("calibrate", "marks", "z", "--readings", S2, *OFFLINE)
    assert result.exit_code == 0
    assert "axis Z, 20 measurements\n" in result.stdout
    assert "mean 1884.3 nm, 3 sigma 17.2 nm, of the mean 3.9; set is 7112" in result.stdout
    assert "mean 345.27 um, 3 sigma 23.36 um, of the mean 5.22\n" in result.stdout
    assert "mean 183.2 steps, 3 sigma 12.4 steps, of the mean 2.8; the lathe" in result.stdout
    assert "recommended step_z_nm 1884 nm (100 to 32000 nm)\n" in result.stdout
    assert "the travel of the switch is not known" in result.stdout
    assert chip.executed == []


def test_scripts_get_every_figure(tornillo: Tornillo) -> None:
    result = tornillo("calibrate", "marks", "z", "--readings", S2, *OFFLINE, "--json")
    found = json.loads(result.stdout)
    assert found["axis"] == "Z"
    assert found["measurements"] == 20
    assert found["step_nm"]["mean"] == pytest.approx(1884.34, abs=0.01)
    assert found["backlash_um"]["mean"] == pytest.approx(345.27, abs=0.01)
    assert found["backlash_um"]["sigma"] == pytest.approx(7.79, abs=0.01)
    assert found["dead_steps"] == 183
    assert found["recommended"] == {"step_z_nm": 1884}


def measured(backlash: int, dead: int) -> str:
    """What is typed for one specimen on a screw of 7.112 um a step, in mm."""
    return f"{1050 * 7.112e-3:.4f}\n{(950 + dead - backlash) * 7.112e-3:.4f}\n\n"


def test_typed_readings_separate_the_travel_of_the_switch_and_are_stored_when_wanted(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    chip.status = IDLE._replace(dead_z=45)
    chip.values[SettingId.STEP_Z_NM] = 7112
    result = tornillo("calibrate", "marks", "z", typed=measured(31, 45))
    assert "specimen 1: mark 1 to 2 [mm]" in result.stderr
    assert "specimen 2: mark 1 to 2 [mm, nothing to end]" in result.stderr
    assert "the lathe takes up 45" in result.stdout
    assert "switch      14 steps of travel; set is 0" in result.stdout
    assert "recommended switch_travel_z 14 steps (0 to 200 steps)" in result.stdout
    assert "store it: tornillo settings set switch_travel_z 14" in result.stderr
    assert Command.SETTING_SET not in chip.executed
    stored = tornillo("calibrate", "marks", "z", "--store", typed=measured(31, 45))
    assert "switch_travel_z was 0, is 14 steps (0 to 200 steps)" in stored.stderr
    assert "home again" in stored.stderr
    assert chip.values[SettingId.SWITCH_TRAVEL_Z] == 14
    assert chip.values[SettingId.STEP_Z_NM] == 7112


def test_right_settings_are_said_to_be_right(tornillo: Tornillo, chip: ScriptedChip) -> None:
    chip.values[SettingId.SWITCH_TRAVEL_X] = 14
    result = tornillo("calibrate", "marks", "x", "--store", typed=measured(23, 23))
    assert "recommended nothing: the settings are right" in result.stdout
    assert "(one measurement: no deviation known)" in result.stdout
    assert Command.SETTING_SET not in chip.executed


def test_what_is_no_number_is_asked_for_again_and_a_comma_is_understood(
    tornillo: Tornillo,
) -> None:
    typed = "seven\n\n7,4676\nnan\n6,7564\n\n"
    result = tornillo("calibrate", "marks", "x", typed=typed)
    assert result.exit_code == 0
    assert "'seven' is no number; type a length in mm" in result.stderr
    assert "'nan' is no number" in result.stderr
    assert "axis X, 1 measurements" in result.stdout


def test_a_lathe_that_is_not_homed_cannot_tell_its_dead_steps(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    chip.status = IDLE._replace(flags=StatusFlag(0))
    result = tornillo("calibrate", "marks", "z", "--readings", S2)
    assert result.exit_code == 1
    assert "not homed" in result.stderr


@pytest.mark.parametrize("line", ["7.4", "7.4 six", "1 2 3"])
def test_a_line_that_holds_no_two_lengths_is_named(
    tornillo: Tornillo, tmp_path: Path, line: str
) -> None:
    path = tmp_path / "measured.txt"
    path.write_text(f"# my readings\n7.4676 6.7564\n{line}\n", encoding="utf-8")
    result = tornillo("calibrate", "marks", "z", "--readings", path, *OFFLINE[:2])
    assert result.exit_code == 1
    assert f"{path}:3: '{line}' are no two lengths" in result.stderr


def test_a_file_that_is_not_there_is_refused(tornillo: Tornillo, tmp_path: Path) -> None:
    result = tornillo("calibrate", "marks", "z", "--readings", tmp_path / "no.txt", *OFFLINE[:2])
    assert result.exit_code == 1
    assert "cannot read" in result.stderr


def test_a_machine_file_cannot_be_stored_to_and_must_have_what_is_needed(
    tornillo: Tornillo, tmp_path: Path
) -> None:
    result = tornillo("calibrate", "marks", "z", "--readings", S2, *OFFLINE, "--store")
    assert result.exit_code == 2
    path = tmp_path / "half.toml"
    path.write_text("[settings]\nstep_z_nm = 7112\n", encoding="utf-8")
    result = tornillo("calibrate", "marks", "z", "--readings", S2, "--machine", path)
    assert result.exit_code == 1
    assert "[settings] switch_travel_z is missing" in result.stderr
