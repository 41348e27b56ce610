# SPDX-License-Identifier: Apache-2.0
"""The verbs about motion: home, run, hold, resume, override, stop, reset, status."""

import json
import signal
import sys
import threading

import pytest
from console import Tornillo
from scripted_chip import IDLE, ScriptedChip, ScriptedPort

from tornillo.protocol import (
    Alarm,
    Command,
    ErrorCode,
    MachineWarning,
    ResetCause,
    State,
    StatusData,
    StatusFlag,
)

CUTTING = IDLE._replace(
    state=State.RUNNING, slot=0, operation=1, operations=2, pass_number=1, passes=4, permille=100
)
NEXT_PASS = CUTTING._replace(pass_number=2, permille=350)
FINISHED = IDLE._replace(slot=0, permille=1000)


def interrupt_when(chip: ScriptedChip, coming: int) -> None:
    """Press Ctrl-C when only `coming` states of the chip are still to come."""
    main = threading.main_thread().ident
    assert main is not None

    def press() -> None:
        if len(chip.coming) == coming:
            chip.at_status = lambda: None
            signal.pthread_kill(main, signal.SIGINT)

    chip.at_status = press


def test_home_waits_for_the_end_and_tells_the_dead_steps(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    homing = IDLE._replace(state=State.HOMING, flags=0)
    chip.coming = [homing, homing, IDLE]
    result = tornillo("home")
    assert result.exit_code == 0
    assert result.stdout == "homed; dead steps: X 23, Z 31; spread: X 0, Z 1\n"
    assert "Warning" not in result.stderr
    assert chip.coming == []
    assert chip.homed_axes == 3


@pytest.mark.parametrize(
    ("axis", "bit", "found"),
    [
        ("x", 1, "homed; dead steps: X 23; spread: X 0\n"),
        ("z", 2, "homed; dead steps: Z 31; spread: Z 1\n"),
    ],
)
def test_home_of_one_axis_tells_the_chip_and_shows_that_axis(
    tornillo: Tornillo, chip: ScriptedChip, axis: str, bit: int, found: str
) -> None:
    chip.coming = [IDLE]
    result = tornillo("home", "--axis", axis)
    assert (result.exit_code, result.stdout) == (0, found)
    assert chip.homed_axes == bit


def test_home_warns_of_dead_steps_that_have_changed(tornillo: Tornillo, chip: ScriptedChip) -> None:
    chip.coming = [IDLE._replace(warnings=MachineWarning.DEAD_Z)]
    result = tornillo("home")
    assert result.exit_code == 0
    assert "Warning: the dead steps of Z are not what the homing before found" in result.stderr
    assert "look for a loose coupling, nut or screw of Z" in result.stderr
    assert "dead steps of X" not in result.stderr


def test_home_tells_why_it_failed(tornillo: Tornillo, chip: ScriptedChip) -> None:
    failed = IDLE._replace(state=State.ALARM, alarm=Alarm.HOME_NOT_FOUND, alarm_detail=1)
    chip.coming = [failed]
    result = tornillo("home")
    assert result.exit_code == 1
    assert "alarm HOME_NOT_FOUND of Z: the slide travelled its whole way" in result.stderr
    assert "Try: check that the slide moves" in result.stderr


def test_ctrl_c_while_homing_stops_the_slides(tornillo: Tornillo, chip: ScriptedChip) -> None:
    chip.coming = 2 * [IDLE._replace(state=State.HOMING)]
    interrupt_when(chip, 0)
    result = tornillo("home")
    assert result.exit_code == 1
    assert "homing was stopped" in result.stderr
    assert Command.STOP in chip.executed
    assert chip.status.state == State.IDLE


def test_run_starts_the_part_of_that_name(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    result = tornillo("run", "test-bar")
    assert result.exit_code == 0
    assert "running" in result.stdout
    assert loaded.status.state == State.RUNNING


def test_run_without_a_name_starts_the_selected_part(
    tornillo: Tornillo, loaded: ScriptedChip, port: ScriptedPort
) -> None:
    assert tornillo("run").exit_code == 0
    assert port.requests[-1].payload == b"\xff\0"


def test_run_step_by_step_tells_the_chip(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    assert tornillo("run", "--step").exit_code == 0
    assert loaded.step


def test_run_of_an_unknown_part_is_refused(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    result = tornillo("run", "other")
    assert result.exit_code == 1
    assert "no part called 'other' is stored in the lathe" in result.stderr
    assert Command.RUN not in loaded.executed


def test_run_follow_prints_each_pass_once_and_the_end(
    tornillo: Tornillo, loaded: ScriptedChip
) -> None:
    loaded.coming = [CUTTING, CUTTING, NEXT_PASS, FINISHED]
    result = tornillo("run", "--follow")
    assert (result.exit_code, result.stdout) == (0, "finished\n")
    assert result.stderr.splitlines() == [
        " 10.0 %  operation 1 of 2, pass 1 of 4",
        " 35.0 %  operation 1 of 2, pass 2 of 4",
        "100.0 %  finished",
    ]


def test_run_follow_waits_through_a_hold(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    loaded.coming = [CUTTING._replace(passes=0), CUTTING._replace(state=State.HOLD), FINISHED]
    result = tornillo("run", "--follow")
    assert result.exit_code == 0
    assert " 10.0 %  operation 1 of 2\n" in result.stderr
    assert "pass 1 of 4, held" in result.stderr


def test_run_follow_shows_a_bar_on_a_terminal(
    tornillo: Tornillo, loaded: ScriptedChip, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tornillo.commands.following.on_terminal", lambda: True)
    loaded.coming = [CUTTING, FINISHED]
    result = tornillo("run", "--follow")
    assert result.exit_code == 0
    assert "100.0 %" in result.stderr


@pytest.mark.parametrize(
    ("end", "message", "remedy"),
    [
        (
            IDLE._replace(state=State.ALARM, alarm=Alarm.LIMIT, alarm_detail=0),
            "alarm LIMIT of X: a limit switch closed",
            "check part zero and stock",
        ),
        (
            IDLE._replace(state=State.ALARM, alarm=Alarm.STREAM_DRY),
            "alarm STREAM_DRY: the steps were not computed in time",
            "report",
        ),
        (IDLE, "the run was stopped before its end", "start it again"),
    ],
)
def test_run_follow_exits_with_1_when_the_part_is_not_finished(
    tornillo: Tornillo, loaded: ScriptedChip, end: StatusData, message: str, remedy: str
) -> None:
    loaded.coming = [CUTTING, end]
    result = tornillo("run", "--follow")
    assert (result.exit_code, result.stdout) == (1, "")
    assert message in result.stderr
    assert remedy in result.stderr


def test_ctrl_c_while_following_holds_and_says_how_to_go_on(
    tornillo: Tornillo, loaded: ScriptedChip
) -> None:
    loaded.coming = [CUTTING, NEXT_PASS]
    interrupt_when(loaded, 0)
    result = tornillo("run", "--follow")
    assert result.exit_code == 1
    assert loaded.status.state == State.HOLD
    assert "held by Ctrl-C at operation 1 of 2, pass 2 of 4; nothing is lost" in result.stderr
    assert "tornillo resume --follow" in result.stderr
    assert "tornillo stop" in result.stderr


def test_ctrl_c_after_the_run_has_ended_says_so(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    loaded.coming = [CUTTING]
    interrupt_when(loaded, 0)
    loaded.refusals[Command.HOLD] = bytes([ErrorCode.NOT_RUNNING])
    result = tornillo("run", "--follow")
    assert result.exit_code == 1
    assert "interrupted; the lathe was not cutting" in result.stderr


def test_ctrl_c_tells_when_the_hold_itself_was_refused(
    tornillo: Tornillo, loaded: ScriptedChip
) -> None:
    loaded.coming = [CUTTING]
    interrupt_when(loaded, 0)
    loaded.refusals[Command.HOLD] = bytes([ErrorCode.UNKNOWN_COMMAND])
    result = tornillo("run", "--follow")
    assert result.exit_code == 1
    assert "HOLD was refused" in result.stderr


def test_a_pulled_cable_while_following_is_told_and_the_part_goes_on(
    tornillo: Tornillo, loaded: ScriptedChip, port: ScriptedPort
) -> None:
    def pull() -> None:
        port.unplugged = not loaded.coming

    loaded.coming = [CUTTING]
    loaded.at_status = pull
    result = tornillo("run", "--follow")
    assert result.exit_code == 1
    assert "the connection was lost" in result.stderr
    assert "goes on without the computer" in result.stderr


def test_hold_resume_and_stop_do_what_they_say(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    tornillo("run")
    assert "held" in tornillo("hold").stdout
    assert loaded.status.state == State.HOLD
    assert "running" in tornillo("resume").stdout
    assert loaded.status.state == State.RUNNING
    assert tornillo("stop").stdout == "stopped\n"
    assert loaded.status.state == State.IDLE


def test_resume_can_follow_to_the_end(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    tornillo("run")
    tornillo("hold")
    loaded.coming = [NEXT_PASS, FINISHED]
    assert tornillo("resume", "--follow").stdout == "finished\n"


@pytest.mark.parametrize("verb", ["hold", "resume"])
def test_hold_and_resume_without_a_run_are_refused(tornillo: Tornillo, verb: str) -> None:
    result = tornillo(verb)
    assert result.exit_code == 1
    assert "no part is being cut" in result.stderr


@pytest.mark.parametrize("percent", [10, 100, 200])
def test_override_changes_the_feed_of_the_run(
    tornillo: Tornillo, loaded: ScriptedChip, percent: int
) -> None:
    tornillo("run")
    result = tornillo("override", str(percent))
    assert result.exit_code == 0
    assert result.stdout == f"feed now {percent} %; back with `tornillo override 100`\n"
    assert loaded.feed_percent == percent
    tornillo("hold")
    assert tornillo("override", "55").exit_code == 0
    assert (loaded.feed_percent, loaded.status.state) == (55, State.HOLD)


@pytest.mark.parametrize("percent", [-20, 0, 9, 201, 256, 100000])
def test_override_outside_its_range_is_refused_before_it_is_sent(
    tornillo: Tornillo, loaded: ScriptedChip, percent: int
) -> None:
    tornillo("run")
    result = tornillo("override", str(percent))
    assert (result.exit_code, result.stdout) == (1, "")
    assert f"Error: a feed of {percent} % is not possible" in result.stderr
    assert "Try: choose 10 to 200 percent" in result.stderr
    assert Command.OVERRIDE not in loaded.executed


def test_override_without_a_run_is_refused(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    result = tornillo("override", "80")
    assert (result.exit_code, result.stdout) == (1, "")
    assert "no part is being cut" in result.stderr
    assert "Try: start one with `tornillo run PART`" in result.stderr
    assert loaded.feed_percent == 100


@pytest.mark.parametrize("arguments", [(), ("fast",), ("80", "90"), ("80.5",)])
def test_override_takes_one_whole_number(tornillo: Tornillo, arguments: tuple[str, ...]) -> None:
    assert tornillo("override", *arguments).exit_code == 2


def test_reset_acknowledges_and_says_what_is_next(tornillo: Tornillo, chip: ScriptedChip) -> None:
    chip.status = IDLE._replace(state=State.ALARM, alarm=Alarm.ESTOP, flags=0)
    assert tornillo("reset").stdout == "no alarm; home next: `tornillo home`\n"
    chip.status = IDLE
    assert tornillo("reset").stdout == "no alarm\n"


def test_reset_tells_the_alarm_that_came_back(tornillo: Tornillo, chip: ScriptedChip) -> None:
    chip.coming = [IDLE._replace(state=State.ALARM, alarm=Alarm.ESTOP)]
    result = tornillo("reset")
    assert result.exit_code == 1
    assert "alarm ESTOP: the emergency stop was pressed" in result.stderr


def test_status_of_an_idle_lathe(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    loaded.status = IDLE._replace(slot=0)
    lines = dict(line.split("  ", 1) for line in tornillo("status").stdout.splitlines())
    assert lines["state"].strip() == "idle"
    assert lines["tool"].strip() == "diameter 25.404 mm, z 0.000 mm"
    assert lines["machine"].strip() == "X -1789, Z -8000 steps"
    assert lines["dead steps"].strip() == "X 23, Z 31; spread X 0, Z 1"
    assert lines["last start"].strip() == "power-on"
    assert "unfinished" not in lines
    assert lines["part"].strip() == "test-bar (slot 0)"
    assert lines["firmware"].strip() == "0.1.0, serial number T0000001"


def test_status_of_a_run_tells_the_progress(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    loaded.status = NEXT_PASS._replace(slot=5)
    text = tornillo("status").stdout
    assert "35.0 %, operation 1 of 2, pass 2 of 4" in text
    assert "? (slot 5)" in text


def test_status_of_an_alarm_tells_cause_remedy_and_what_is_pressed(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    chip.status = IDLE._replace(
        state=State.ALARM,
        alarm=Alarm.ESTOP,
        flags=StatusFlag.ESTOP | StatusFlag.SWITCH_Z,
        reset_cause=ResetCause.BROWN_OUT,
    )
    text = tornillo("status").stdout
    assert "alarm ESTOP: the emergency stop was pressed; make the machine safe" in text
    assert "emergency stop, limit switch Z" in text
    assert "unknown: not homed" in text
    assert "brown-out" in text


def test_status_for_scripts_has_every_field(tornillo: Tornillo, loaded: ScriptedChip) -> None:
    loaded.status = NEXT_PASS
    values = json.loads(tornillo("status", "--json").stdout)
    assert values["state"] == "RUNNING"
    assert values["alarm"] == "NONE"
    assert values["alarm_axis"] is None
    assert values["flags"] == ["HOMED"]
    assert (values["x"], values["z"], values["permille"]) == (-1789, -8000, 350)
    assert (values["part"], values["homed"], values["finished"]) == ("test-bar", True, False)
    assert values["part_z_mm"] == 0.0
    loaded.status = IDLE._replace(state=State.ALARM, alarm=Alarm.LIMIT, alarm_detail=1)
    values = json.loads(tornillo("status", "--json").stdout)
    assert (values["alarm"], values["alarm_axis"], values["part"]) == ("LIMIT", "Z", None)


@pytest.mark.parametrize(
    ("verb", "command"),
    [
        (("home",), Command.HOME),
        (("run",), Command.RUN),
        (("hold",), Command.HOLD),
        (("resume",), Command.RESUME),
        (("override", "80"), Command.OVERRIDE),
        (("stop",), Command.STOP),
        (("reset",), Command.RESET),
        (("status",), Command.STATUS),
        (("parts",), Command.PART_INFO),
        (("settings",), Command.SETTING_GET),
        (("zero", "z", "--at", "0"), Command.ZERO),
    ],
)
@pytest.mark.parametrize("code", [ErrorCode.BUSY, ErrorCode.ALARM, ErrorCode.NOT_HOMED])
def test_every_verb_passes_a_refusal_on_with_its_remedy(
    tornillo: Tornillo,
    chip: ScriptedChip,
    verb: tuple[str, ...],
    command: Command,
    code: ErrorCode,
) -> None:
    chip.refusals[command] = bytes([code])
    result = tornillo(*verb)
    assert (result.exit_code, result.stdout) == (1, "")
    assert f"Error: {command.name} was refused: " in result.stderr
    assert "\nTry: " in result.stderr


def test_the_bar_is_shown_only_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    from tornillo.commands.progress import on_terminal

    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert on_terminal()
