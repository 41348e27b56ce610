# SPDX-License-Identifier: Apache-2.0
"""The live view: what it shows, what its keys do, and how long it says a run still takes."""

import json
from pathlib import Path

import pytest
from console import Tornillo
from pressed import PressedKeys
from rich.console import Console
from scripted_chip import IDLE, ScriptedChip, ScriptedPort

from tornillo.commands.watch import View
from tornillo.drives import Drives
from tornillo.lathe import Lathe
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.plan_report import PlanReport
from tornillo.protocol import Alarm, Command, ErrorCode, State, StatusData, StatusFlag
from tornillo.remaining import Remaining
from tornillo.status import Status

CUTTING = IDLE._replace(
    state=State.RUNNING,
    slot=0,
    operation=1,
    operations=1,
    pass_number=2,
    passes=4,
    permille=300,
    flags=StatusFlag.HOMED | StatusFlag.MOTION,
)


@pytest.fixture
def loaded(chip: ScriptedChip, test_bar: Path) -> ScriptedChip:
    """A lathe with the test bar in slot 0."""
    chip.slots[0] = Part.load(test_bar).image(chip.machine())
    return chip


def shown(view: View, status: StatusData) -> str:
    """The frame of a status as plain text."""
    known = Status.from_data(status)
    view.readout.follow(known)
    console = Console(width=110, force_terminal=False)
    with console.capture() as captured:
        console.print(view.frame(known, 110))
    return captured.get()


def test_the_view_tells_where_the_tool_is_and_what_is_cut(
    lathe: Lathe, loaded: ScriptedChip
) -> None:
    view = View(lathe, "inch")
    shown(view, IDLE)
    frame = shown(view, CUTTING._replace(uptime_ms=2000, z=-8100))
    for line in (
        "state       cutting",
        "diameter    1.000 inch",
        "z           -0.028 inch",
        "machine     X -1789, Z -8100 steps",
        "speed       1.68 inch/min",
        "part        test-bar",
        "operation   1 of 1",
        "pass        2 of 4",
        "feed        9 inch/min",
        "override    100 %",
        "done        30.0 %",
        "dead steps  X 23, Z 31 steps",
    ):
        assert line in frame, frame
    assert "time left" in frame
    assert "V" in frame
    assert "h hold" in frame


def test_the_part_is_drawn_beside_with_the_tool_at_its_place(
    lathe: Lathe, loaded: ScriptedChip
) -> None:
    view = View(lathe, "mm")
    near = shown(view, CUTTING).splitlines()
    far = shown(view, CUTTING._replace(z=-8000 - 7143)).splitlines()
    at = [next(line.rindex("V") for line in frame if "V" in line) for frame in (near, far)]
    # 2 inches of 2.1 lie between the places; 64 columns are there, 2 of them for the chuck.
    assert at[0] - at[1] == pytest.approx(62 * 2 / 2.1, abs=3)
    assert shown(view, CUTTING._replace(flags=StatusFlag(0))).count("V") == 0


def test_alarms_pauses_and_pressed_inputs_are_told(lathe: Lathe, loaded: ScriptedChip) -> None:
    view = View(lathe, "mm")
    alarm = IDLE._replace(
        state=State.ALARM, alarm=Alarm.LIMIT, alarm_detail=1, flags=StatusFlag.SWITCH_Z
    )
    frame = shown(view, alarm)
    assert "state       ALARM" in frame
    assert "alarm LIMIT of Z: a limit switch" in frame
    assert "check part zero and stock" in frame
    assert "limit switch Z" in frame
    assert "unknown: not homed" in frame
    pause = shown(view, CUTTING._replace(state=State.PAUSE))
    assert "waits for   step by step: look at it" in pause


def test_keys_hold_resume_and_change_the_feed(lathe: Lathe, loaded: ScriptedChip) -> None:
    view = View(lathe, "mm")
    shown(view, IDLE)
    loaded.status = CUTTING

    def press(key: str) -> str:
        status = lathe.status()
        view.readout.follow(status)
        view.press(key, status)
        return view.message

    assert press("-") == "feed now 90 %"
    assert press("-") == "feed now 80 %"
    assert loaded.feed_percent == 80
    assert "feed        183 mm/min of 229 mm/min" in shown(view, CUTTING)
    assert press("+") == "feed now 90 %"
    assert press("0") == "feed now 100 %"
    view.readout.percent = 10
    assert press("-") == "feed now 10 %"
    assert press("h") == "held; r goes on"
    assert loaded.executed[-1:] == [Command.HOLD]
    assert press("r") == "going on"
    assert loaded.executed[-1:] == [Command.RESUME]
    assert press("x") == "going on"
    loaded.refusals[Command.HOLD] = bytes([ErrorCode.NOT_RUNNING])
    assert "HOLD was refused" in press("h")


def test_an_override_given_before_the_watch_began_is_not_invented(
    lathe: Lathe, loaded: ScriptedChip
) -> None:
    view = View(lathe, "mm")
    assert "override    unknown" in shown(view, CUTTING)


def test_a_part_that_cannot_be_understood_leaves_the_rest(
    lathe: Lathe, loaded: ScriptedChip
) -> None:
    view = View(lathe, "mm")
    loaded.slots[0] = loaded.slots[0][:40]
    frame = shown(view, CUTTING)
    assert "state       cutting" in frame
    assert "time left" not in frame


def test_the_time_left_is_that_of_the_plan(test_bar: Path, machine: Machine) -> None:
    part, drives = Part.load(test_bar), Drives.usual(machine)
    plan = PlanReport(part, machine, drives)
    remaining = Remaining(part.steps(machine), machine, drives)

    def left(status: StatusData, percent: int = 100) -> float:
        return remaining.seconds(Status.from_data(status), percent)

    start = CUTTING._replace(operation=0, pass_number=0)
    assert left(start) == pytest.approx(plan.timing.total)
    second = sum(plan.timing.steps[1:])
    assert left(CUTTING._replace(uptime_ms=10_000)) == pytest.approx(second)
    assert left(CUTTING._replace(uptime_ms=12_000)) == pytest.approx(second - 2)
    held = CUTTING._replace(uptime_ms=20_000, state=State.HOLD)
    assert left(held) == pytest.approx(second - 2)
    half = sum(plan.timing.feeding[1:])
    assert left(held, 50) == pytest.approx(second - 2 + half)
    assert left(CUTTING._replace(permille=1000)) == 0
    assert remaining.feed(Status.from_data(IDLE)) is None


def test_watch_runs_until_q_and_leaves_the_run_alone(
    tornillo: Tornillo, loaded: ScriptedChip, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = PressedKeys(None, "+", "q")
    on_a_terminal(monkeypatch, keys)
    loaded.status = CUTTING
    result = tornillo("watch")
    assert result.exit_code == 0
    assert keys.looks == 3
    assert loaded.feed_percent == 110
    assert loaded.status.state is State.RUNNING
    assert "cutting" in result.stdout


def on_a_terminal(monkeypatch: pytest.MonkeyPatch, keys: PressedKeys) -> None:
    """Let the view believe that a person sits there, whose keys are `keys`."""
    monkeypatch.setattr("tornillo.commands.watch.on_terminals", lambda: True)
    monkeypatch.setattr("tornillo.commands.watch.keyboard", lambda: keys)


def test_ctrl_c_in_watch_holds_the_run(
    tornillo: Tornillo, loaded: ScriptedChip, monkeypatch: pytest.MonkeyPatch
) -> None:
    def press(_look: int) -> None:
        raise KeyboardInterrupt

    on_a_terminal(monkeypatch, PressedKeys(then=press))
    loaded.status = CUTTING
    result = tornillo("watch")
    assert result.exit_code == 1
    assert "held by Ctrl-C at operation 1 of 1, pass 2 of 4; nothing is lost" in result.stderr
    assert loaded.status.state is State.HOLD


def test_a_cable_pulled_while_watching_is_told(
    tornillo: Tornillo,
    loaded: ScriptedChip,
    port: ScriptedPort,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def pull(_look: int) -> None:
        port.unplugged = True

    on_a_terminal(monkeypatch, PressedKeys(None, None, then=pull))
    result = tornillo("watch")
    assert result.exit_code == 1
    assert "the connection was lost" in result.stderr


def test_scripts_get_a_status_a_line(
    tornillo: Tornillo, loaded: ScriptedChip, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks: list[float] = []

    def sleep(seconds: float) -> None:
        looks.append(seconds)
        if len(looks) == 3:
            raise KeyboardInterrupt

    monkeypatch.setattr("tornillo.commands.watch.time.sleep", sleep)
    result = tornillo("watch", "--json", "--every", "1")
    assert result.exit_code == 1
    lines = [json.loads(line) for line in result.stdout.splitlines()]
    assert [line["state"] for line in lines] == ["IDLE"] * 3
    assert looks == [1.0] * 3


def test_watch_without_a_terminal_is_wrong_usage(tornillo: Tornillo) -> None:
    result = tornillo("watch")
    assert result.exit_code == 2
    assert "watch needs a terminal; scripts use --json" in result.stderr
