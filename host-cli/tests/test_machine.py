# SPDX-License-Identifier: Apache-2.0
"""Machine files, and the machine that the chip describes."""

from pathlib import Path

import pytest
from scripted_chip import ScriptedChip

from tornillo.errors import MachineError
from tornillo.lathe import Lathe
from tornillo.machine import Machine
from tornillo.protocol import SETTINGS, SettingId

MACHINES = Path(__file__).resolve().parents[1] / "machines"


def test_the_shipped_machine_has_the_defaults_of_the_firmware(machine: Machine) -> None:
    defaults = {entry.id: entry.default for entry in SETTINGS}
    assert machine.step_x_nm == defaults[SettingId.STEP_X_NM]
    assert machine.step_z_nm == defaults[SettingId.STEP_Z_NM]
    assert machine.travel_x == defaults[SettingId.TRAVEL_X]
    assert machine.travel_z == defaults[SettingId.TRAVEL_Z]
    assert machine.zero_x == defaults[SettingId.ZERO_X]
    assert machine.zero_z == defaults[SettingId.ZERO_Z]
    assert machine.max_rate == defaults[SettingId.RAPID_RATE_X]
    assert (machine.spindle_min_rpm, machine.spindle_max_rpm) == (100, 3800)


def test_a_machine_file_can_be_named_by_its_path(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    text = (MACHINES / "otmt-co.toml").read_text(encoding="utf-8")
    path.write_text(text.replace("step_x_nm = 7112", "step_x_nm = 1778"), encoding="utf-8")
    assert Machine.load(str(path)).step_x_nm == 1778


def test_an_unknown_machine_is_refused_naming_the_known_ones() -> None:
    with pytest.raises(MachineError, match="machine otmt") as caught:
        Machine.load("otmt")
    assert "otmt-co" in caught.value.remedy


def test_a_machine_file_with_too_few_settings_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text("[settings]\nstep_x_nm = 7112", encoding="utf-8")
    with pytest.raises(MachineError, match=r"\[settings\] step_z_nm is missing"):
        Machine.load(str(path))


def test_a_connected_machine_is_the_one_that_hello_tells(lathe: Lathe, chip: ScriptedChip) -> None:
    chip.values[SettingId.RAPID_RATE_Z] = 700
    chip.values[SettingId.ZERO_Z] = -9000
    machine = lathe.machine()
    assert (machine.max_rate, machine.zero_z, machine.step_x_nm) == (700, -9000, 7112)
