# SPDX-License-Identifier: Apache-2.0
"""Settings saved to a machine file and loaded from one."""

import random
import tomllib
from pathlib import Path

import pytest
from console import Tornillo
from scripted_chip import ScriptedChip

from tornillo.errors import MachineError
from tornillo.machine import Machine
from tornillo.machine_file import file_text, load_file, read_file
from tornillo.protocol import SETTINGS, Command, ErrorCode, SettingId


def any_values(seed: int) -> dict[SettingId, int]:
    """A value inside the range of every setting."""
    dice = random.Random(seed)
    return {entry.id: dice.randint(entry.minimum, entry.maximum) for entry in SETTINGS}


@pytest.mark.parametrize("seed", range(5))
def test_what_was_saved_comes_back(
    tornillo: Tornillo, chip: ScriptedChip, tmp_path: Path, seed: int
) -> None:
    path = tmp_path / "mine.toml"
    chip.values = any_values(seed)
    saved = dict(chip.values)
    assert tornillo("settings", "save", path).exit_code == 0
    chip.values = {entry.id: entry.default for entry in SETTINGS}
    result = tornillo("settings", "load", path)
    assert result.exit_code == 0
    assert chip.values == saved
    differing = sum(saved[entry.id] != entry.default for entry in SETTINGS)
    assert f"{len(SETTINGS)} settings of {path}: {differing} changed and stored" in result.stdout


def test_a_saved_file_has_every_setting_with_its_unit_range_and_meaning(
    tornillo: Tornillo, tmp_path: Path
) -> None:
    path = tmp_path / "mine.toml"
    tornillo("settings", "save", path)
    text = path.read_text(encoding="utf-8")
    for entry in SETTINGS:
        line = next(line for line in text.splitlines() if line.startswith(entry.id.name.lower()))
        unit = f"{entry.unit}, " if entry.unit else ""
        assert line.endswith(f"# {unit}{entry.minimum} to {entry.maximum}: {entry.meaning}")
    assert tomllib.loads(text)["machine"]["source"] == "read from lathe T0000001, firmware 0.1.0"


def test_a_file_is_not_written_over_unasked(tornillo: Tornillo, tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("precious", encoding="utf-8")
    result = tornillo("settings", "save", path)
    assert result.exit_code == 1
    assert "is there already" in result.stderr
    assert path.read_text(encoding="utf-8") == "precious"
    assert tornillo("settings", "save", path, "--force").exit_code == 0
    assert load_file(str(path))


def test_a_file_that_cannot_be_written_is_told(tornillo: Tornillo, tmp_path: Path) -> None:
    result = tornillo("settings", "save", tmp_path / "nowhere" / "mine.toml")
    assert result.exit_code == 1
    assert "cannot write" in result.stderr


def test_only_what_differs_is_stored_and_every_change_is_told_with_its_range(
    tornillo: Tornillo, chip: ScriptedChip, tmp_path: Path
) -> None:
    path = tmp_path / "some.toml"
    path.write_text("[settings]\nhome_rate = 700\nspread_max = 2\n", encoding="utf-8")
    result = tornillo("settings", "load", path)
    assert result.stdout == (
        "home_rate was 800, is 700 step/s (20 to 4000 step/s)\n"
        f"2 settings of {path}: 1 changed and stored\n"
    )
    assert chip.executed.count(Command.SETTING_SET) == 1


@pytest.mark.parametrize(
    ("text", "message", "remedy"),
    [
        ("[settings]\nhome_rat = 7", ':2: unknown setting "home_rat"', 'mean "home_rate"?'),
        ("[settings]\n\nqqq = 7", ':3: unknown setting "qqq"', "see `tornillo settings`"),
        ("[setting]\nhome_rate = 7", ':1: unknown table "setting"', 'mean "settings"?'),
        ("[step]\nx_nm = 7", ':1: unknown table "step"', "use [machine] and [settings]"),
        ("[settings]\nhome_rate = 7.5", ":2: home_rate must be a whole", "20 to 4000 step/s"),
        ("[settings]\nhome_rate = true", ":2: home_rate must be a whole", "20 to 4000 step/s"),
        ("[settings]\nhome_rate = 19", ":2: home_rate cannot be 19 step/s", "20 to 4000 step/s"),
        ("[settings]\ncoil_mode = 4", ":2: coil_mode cannot be 4", "0 to 3"),
        ("", ":1: the table [settings] is missing", "tornillo settings save"),
        ("settings = 3", ":1: the table [settings] is missing", "tornillo settings save"),
        ("home_rate 7", ":1: this is not TOML", "look for a missing"),
    ],
)
def test_a_wrong_file_is_refused_with_line_and_remedy_and_nothing_is_stored(
    tornillo: Tornillo, tmp_path: Path, text: str, message: str, remedy: str
) -> None:
    before = tornillo("settings", "--json").stdout
    path = tmp_path / "bad.toml"
    path.write_text(text, encoding="utf-8")
    result = tornillo("settings", "load", path)
    assert result.exit_code == 1
    assert message in result.stderr
    assert remedy in result.stderr
    assert tornillo("settings", "--json").stdout == before


def test_a_value_that_this_chip_does_not_take_changes_nothing(
    tornillo: Tornillo, chip: ScriptedChip, tmp_path: Path
) -> None:
    path = tmp_path / "mine.toml"
    chip.ranges[SettingId.SPREAD_MAX] = (0, 10)
    path.write_text("[settings]\nhome_rate = 700\nspread_max = 20\n", encoding="utf-8")
    result = tornillo("settings", "load", path)
    assert result.exit_code == 1
    assert "spread_max cannot be 20 steps: it goes from 0 to 10 steps; nothing" in result.stderr
    assert Command.SETTING_SET not in chip.executed


def test_a_refusal_in_mid_load_says_how_much_is_stored(
    tornillo: Tornillo, chip: ScriptedChip, tmp_path: Path
) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("[settings]\nhome_rate = 700\nlatch_rate = 60\n", encoding="utf-8")
    chip.busy_at = SettingId.LATCH_RATE
    result = tornillo("settings", "load", path)
    assert result.exit_code == 1
    assert "latch_rate stays 50 step/s (20 to 100 step/s)" in result.stderr
    assert "1 of 2 changes are stored" in result.stderr
    assert chip.values[SettingId.HOME_RATE] == 700


def test_a_memory_that_does_not_keep_a_value_is_noticed(
    tornillo: Tornillo, chip: ScriptedChip, tmp_path: Path
) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("[settings]\nhome_rate = 700\n", encoding="utf-8")
    chip.refusals[Command.SETTING_SET] = bytes([ErrorCode.OK])
    result = tornillo("settings", "load", path)
    assert result.exit_code == 1
    assert "home_rate is 800 in the lathe, not 700" in result.stderr


def test_another_step_size_names_the_stored_parts_that_it_makes_useless(
    tornillo: Tornillo, test_bar: Path
) -> None:
    assert tornillo("upload", test_bar).exit_code == 0
    assert "refused until" not in tornillo("settings", "set", "home_rate", "700").stderr
    result = tornillo("settings", "set", "step_x_nm", "7000")
    assert "refused until uploaded again: test-bar" in result.stderr
    assert tornillo("settings", "set", "step_x_nm", "7112").stderr == ""


def test_a_missing_file_is_refused_naming_the_machines_that_there_are(tornillo: Tornillo) -> None:
    result = tornillo("settings", "load", "otmt")
    assert result.exit_code == 1
    assert "otmt-co" in result.stderr


def test_the_machine_that_comes_with_tornillo_restores_the_defaults(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    chip.values = any_values(7)
    assert tornillo("settings", "load", "otmt-co").exit_code == 0
    assert chip.values == {entry.id: entry.default for entry in SETTINGS}


def test_a_saved_file_is_a_machine_to_check_parts_against() -> None:
    values = any_values(3)
    machine = Machine.from_settings(read_file(file_text(values, "any", ""), "any"), "any")
    assert machine.step_x_nm == values[SettingId.STEP_X_NM]
    rates = values[SettingId.RAPID_RATE_X], values[SettingId.RAPID_RATE_Z]
    assert machine.max_rate == min(rates)


def test_a_name_with_quotes_is_kept() -> None:
    text = file_text({}, 'my "lathe"', "a\\b")
    assert tomllib.loads(text)["machine"] == {"name": 'my "lathe"', "source": "a\\b"}


def test_a_machine_needs_the_settings_that_parts_depend_on() -> None:
    with pytest.raises(MachineError, match=r"\[settings\] step_z_nm is missing"):
        Machine.from_settings({SettingId.STEP_X_NM: 7112}, "half")
