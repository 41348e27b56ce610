# SPDX-License-Identifier: Apache-2.0
"""The verbs settings and zero."""

import json

import pytest
from console import Tornillo
from scripted_chip import IDLE, ScriptedChip

from tornillo.protocol import SETTINGS, Command, ErrorCode, SettingId


def test_settings_are_listed_for_people_and_for_scripts(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    chip.values[SettingId.RAPID_RATE_X] = 777
    text = tornillo("settings").stdout
    assert "rapid_rate_x" in text
    assert "777" in text
    rows = json.loads(tornillo("settings", "--json").stdout)
    assert len(rows) == len(SETTINGS)
    entry = SETTINGS[SettingId.RAPID_RATE_X]
    assert rows[SettingId.RAPID_RATE_X] == {
        "name": "rapid_rate_x",
        "value": 777,
        "unit": "step/s",
        "minimum": entry.minimum,
        "maximum": entry.maximum,
        "meaning": entry.meaning,
    }


def test_one_setting_is_printed_alone_and_explained_beside_it(tornillo: Tornillo) -> None:
    result = tornillo("settings", "get", "zero_z")
    assert result.stdout == "-8000\n"
    assert result.stderr == "zero_z: machine Z of the part's front face, -32000 to 0 steps\n"


def test_a_setting_is_changed_also_to_a_negative_value(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    result = tornillo("settings", "set", "zero_z", "-7000")
    wanted = "zero_z was -8000, is -7000 steps (-32000 to 0 steps)\n"
    assert (result.exit_code, result.stdout) == (0, wanted)
    assert chip.values[SettingId.ZERO_Z] == -7000
    assert tornillo("settings", "set", "ESTOP_FITTED", "0").stdout.endswith("is 0 (0 to 1)\n")


def test_a_value_outside_its_range_is_refused_with_the_range(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    result = tornillo("settings", "set", "home_rate", "10")
    assert result.exit_code == 1
    assert "home_rate cannot be 10 step/s: it goes from 20 to 4000 step/s\n" in result.stderr
    assert "Try: choose a value in this range; now it is 800 step/s" in result.stderr
    assert Command.SETTING_SET not in chip.executed


def test_a_refusal_of_the_lathe_names_the_setting_its_value_and_its_range(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    chip.refusals[Command.SETTING_SET] = bytes([ErrorCode.BUSY])
    result = tornillo("settings", "set", "home_rate", "700")
    assert result.exit_code == 1
    assert "home_rate stays 800 step/s (20 to 4000 step/s): SETTING_SET was" in result.stderr


@pytest.mark.parametrize(
    ("name", "remedy"),
    [("rapid_rate", 'did you mean "rapid_rate_'), ("qqq", "see `tornillo settings`")],
)
@pytest.mark.parametrize("verb", [("get",), ("set", "1")])
def test_an_unknown_setting_is_refused_naming_the_nearest(
    tornillo: Tornillo, name: str, remedy: str, verb: tuple[str, ...]
) -> None:
    result = tornillo("settings", verb[0], name, *verb[1:])
    assert result.exit_code == 1
    assert f'there is no setting "{name}"' in result.stderr
    assert remedy in result.stderr


def test_a_value_that_is_no_number_is_wrong_usage_and_told_the_range(tornillo: Tornillo) -> None:
    result = tornillo("settings", "set", "zero_z", "far")
    assert result.exit_code == 2
    assert "far is no whole number; zero_z goes from -32000 to 0 steps" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "sent", "text"),
    [
        (("x", "--diameter", "25.4"), (0, 1786), "X: the tool stands at diameter 25.40 mm\n"),
        (("x", "--diameter", "1", "--units", "inch"), (0, 1786), "diameter 1.000 inch\n"),
        (("z", "--at", "-1.5"), (1, -211), "Z: the tool stands at z = -1.50 mm\n"),
        (("z", "--at", "0", "--units", "inch"), (1, 0), "z = 0.000 inch\n"),
    ],
)
def test_zero_sends_steps_of_the_connected_machine(
    tornillo: Tornillo,
    chip: ScriptedChip,
    arguments: tuple[str, ...],
    sent: tuple[int, int],
    text: str,
) -> None:
    result = tornillo("zero", *arguments)
    assert result.exit_code == 0
    assert result.stdout.endswith(text)
    assert chip.zeroed == [sent]


def test_the_tool_stands_where_zero_has_said(tornillo: Tornillo, chip: ScriptedChip) -> None:
    chip.status = IDLE._replace(x=-1000, z=-500)
    tornillo("zero", "x", "--diameter", "10")
    tornillo("zero", "z", "--at", "2")
    assert "diameter 9.999 mm, z 1.998 mm" in tornillo("status").stdout


@pytest.mark.parametrize(
    "arguments",
    [("x", "--diameter", "-1"), ("x", "--diameter", "nan"), ("z", "--at", "inf"), ("z",)],
)
def test_zero_refuses_what_is_no_position_as_wrong_usage(
    tornillo: Tornillo, arguments: tuple[str, ...]
) -> None:
    assert tornillo("zero", *arguments).exit_code == 2


def test_zero_far_away_is_refused_by_the_chip(tornillo: Tornillo, chip: ScriptedChip) -> None:
    chip.refusals[Command.ZERO] = bytes([ErrorCode.OUT_OF_RANGE])
    result = tornillo("zero", "z", "--at", "99999")
    assert result.exit_code == 1
    assert "ZERO was refused: a value lies outside its range" in result.stderr
