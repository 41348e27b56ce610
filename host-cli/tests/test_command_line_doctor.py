# SPDX-License-Identifier: Apache-2.0
"""The doctor: every finding, good and bad, and the inputs pressed one by one."""

import json

import pytest
from click.testing import Result
from console import Tornillo
from pressed import PressedKeys
from scripted_chip import IDLE, ScriptedChip, ScriptedPort

from tornillo.errors import PortError
from tornillo.protocol import Alarm, Command, SettingId, State, StatusFlag


def findings(result: Result) -> dict[str, dict[str, object]]:
    """What was found, by what was looked at; the last of each."""
    return {entry["what"]: entry for entry in json.loads(result.stdout)}


def test_a_sound_lathe_gets_a_clean_bill(tornillo: Tornillo) -> None:
    result = tornillo("doctor")
    assert result.exit_code == 0
    assert [line.split(":")[0] for line in result.stdout.splitlines()] == [
        "ok  port",
        "ok  firmware",
        "ok  link",
        "ok  settings",
        "ok  state",
    ]
    found = findings(tornillo("doctor", "--json"))
    assert all(entry["good"] for entry in found.values())
    assert found["settings"]["text"] == "all as delivered"


def test_no_lathe_is_a_finding_too(tornillo: Tornillo, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(_wanted: object) -> str:
        raise PortError("no lathe found", "plug in the USB cable")

    monkeypatch.setattr("tornillo.lathe.find_port", none)
    result = tornillo("doctor")
    assert result.exit_code == 1
    assert result.stdout == "NO  port: no lathe found\n    Try: plug in the USB cable\n"


def test_another_protocol_is_a_finding_of_the_firmware(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    chip.protocol += 1
    result = tornillo("doctor")
    assert result.exit_code == 1
    assert "NO  firmware: the firmware 0.1.0 speaks protocol" in result.stdout


def test_another_firmware_version_is_told(tornillo: Tornillo, chip: ScriptedChip) -> None:
    chip.firmware = (0, 2, 0)
    assert "NO  firmware: 0.2.0, tornillo 0.1.0" in tornillo("doctor").stdout


def test_a_link_that_damages_frames_is_told(tornillo: Tornillo, chip: ScriptedChip) -> None:
    chip.status = IDLE._replace(bad_frames=7)
    result = tornillo("doctor")
    assert "NO  link: an answer takes" in result.stdout
    assert "7 damaged frames since it was switched on" in result.stdout
    assert "use another USB cable or port" in result.stdout


def test_a_lathe_that_does_not_answer_is_told(
    tornillo: Tornillo, chip: ScriptedChip, port: ScriptedPort
) -> None:
    def pull() -> None:
        port.unplugged = True

    chip.at_status = pull
    result = tornillo("doctor")
    assert result.exit_code == 1
    assert "NO  link: the connection was lost" in result.stdout


@pytest.mark.parametrize(
    ("setting", "value", "text"),
    [
        (SettingId.HOME_RATE, 10, "home_rate is 10, outside 20 to 4000"),
        (SettingId.ZERO_X, -4000, "part zero of X lies behind the end of its travel"),
        (SettingId.ZERO_Z, -20000, "part zero of Z lies behind the end of its travel"),
        (SettingId.START_RATE_Z, 2000, "Z starts faster than its rapid speed"),
        (SettingId.ESTOP_FITTED, 0, "the emergency stop is not sensed"),
    ],
)
def test_settings_that_contradict_each_other_are_told(
    tornillo: Tornillo, chip: ScriptedChip, setting: SettingId, value: int, text: str
) -> None:
    chip.values[setting] = value
    result = tornillo("doctor")
    assert result.exit_code == 1
    assert f"NO  settings: {text}" in result.stdout
    assert f"changed: {setting.name.lower()}" in result.stdout


def test_alarms_and_runs_are_told(tornillo: Tornillo, chip: ScriptedChip) -> None:
    chip.status = IDLE._replace(state=State.ALARM, alarm=Alarm.LIMIT, alarm_detail=0)
    assert "NO  state: alarm LIMIT of X" in tornillo("doctor").stdout
    chip.status = IDLE._replace(state=State.HOLD)
    result = tornillo("doctor")
    assert "NO  state: it is moving or held" in result.stdout
    assert "or `tornillo stop`" in result.stdout


class Hands:
    """Presses and releases, look by look, what the doctor asks for; `dead` inputs do nothing."""

    def __init__(self, chip: ScriptedChip, *dead: StatusFlag) -> None:
        """Wait for the doctor."""
        self.chip = chip
        self.dead = dead
        self.order = [
            StatusFlag.ESTOP,
            StatusFlag.SWITCH_X,
            StatusFlag.SWITCH_Z,
            StatusFlag.BUTTON_RUN,
            StatusFlag.BUTTON_HOLD,
            StatusFlag.BUTTON_STOP,
        ]
        self.pressed: list[StatusFlag] = []

    def look(self, _number: int) -> None:
        """One look of the doctor at the keys: press the next, or release it."""
        now = self.chip.status
        if now.flags:
            state = now.state
            if self.pressed[-1] is StatusFlag.BUTTON_STOP:
                state = State.IDLE
            self.chip.status = now._replace(flags=0, state=state)
            return
        flag = self.order.pop(0)
        if flag in self.dead:
            return
        self.pressed.append(flag)
        alarm = flag is StatusFlag.ESTOP
        state = State.ALARM if alarm else now.state
        self.chip.status = now._replace(
            flags=flag, state=state, alarm=Alarm.ESTOP if alarm else now.alarm
        )


@pytest.fixture
def hands(chip: ScriptedChip, monkeypatch: pytest.MonkeyPatch) -> Hands:
    """A person at a lathe that is not homed, who presses what is asked for."""
    chip.status = IDLE._replace(flags=0)
    hands = Hands(chip)
    at_the_lathe(monkeypatch, PressedKeys(*100 * [None], then=hands.look))
    return hands


def at_the_lathe(monkeypatch: pytest.MonkeyPatch, keys: PressedKeys) -> None:
    """Let the doctor believe that a person stands there, whose keys are `keys`."""
    monkeypatch.setattr("tornillo.commands.doctor.on_terminals", lambda: True)
    monkeypatch.setattr("tornillo.commands.doctor.keyboard", lambda: keys)


def test_the_inputs_are_tried_one_by_one_under_the_alarm_of_the_emergency_stop(
    tornillo: Tornillo, chip: ScriptedChip, hands: Hands
) -> None:
    result = tornillo("doctor")
    assert result.exit_code == 0, result.output
    names = "emergency stop", "limit switch X", "limit switch Z", "RUN", "HOLD", "STOP"
    lines = result.stdout.splitlines()[6:]
    assert lines == [f"ok  {name}: pressed and released" for name in names]
    assert len(hands.pressed) == 6
    assert {Command.RUN, Command.HOME, Command.RESET}.isdisjoint(chip.executed)


def test_run_is_not_tried_where_it_would_start_the_lathe(
    tornillo: Tornillo, chip: ScriptedChip, hands: Hands
) -> None:
    chip.values[SettingId.ESTOP_FITTED] = 0
    for flag in (StatusFlag.ESTOP, StatusFlag.BUTTON_RUN):
        hands.order.remove(flag)
    result = tornillo("doctor")
    assert "RUN is not tried: without an alarm it would start the lathe" in result.stdout
    assert "ok  HOLD: pressed and released" in result.stdout


def test_a_switch_that_is_not_seen_is_told(
    tornillo: Tornillo, chip: ScriptedChip, hands: Hands, monkeypatch: pytest.MonkeyPatch
) -> None:
    hands.dead = (StatusFlag.SWITCH_X,)
    monkeypatch.setattr("tornillo.commands.doctor.PATIENCE_S", 0.0)
    result = tornillo("doctor")
    assert result.exit_code == 1
    assert "NO  emergency stop: was not seen" in result.stdout
    assert "check the switch and its wires" in result.stdout


def test_an_input_that_is_pressed_already_is_told(
    tornillo: Tornillo, chip: ScriptedChip, monkeypatch: pytest.MonkeyPatch
) -> None:
    chip.status = IDLE._replace(flags=StatusFlag.SWITCH_X)
    at_the_lathe(monkeypatch, PressedKeys("s", "q"))
    result = tornillo("doctor")
    assert result.exit_code == 1
    assert "NO  limit switch X: reads as pressed before anybody touched it" in result.stdout
    assert "emergency stop:" not in result.stdout
    assert "limit switch Z:" not in result.stdout


def test_a_standing_alarm_is_told_at_the_end(
    tornillo: Tornillo, chip: ScriptedChip, hands: Hands, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = PressedKeys(None, None, "q", then=lambda look: hands.look(look) if look < 3 else None)
    at_the_lathe(monkeypatch, keys)
    result = tornillo("doctor")
    assert "An alarm stands now: `tornillo reset`, then `tornillo home`" in result.stdout


def test_a_lathe_that_moves_is_not_asked_for_its_buttons(
    tornillo: Tornillo, chip: ScriptedChip, monkeypatch: pytest.MonkeyPatch
) -> None:
    chip.status = IDLE._replace(state=State.RUNNING)
    at_the_lathe(monkeypatch, PressedKeys())
    assert "Now the inputs" not in tornillo("doctor").stdout
