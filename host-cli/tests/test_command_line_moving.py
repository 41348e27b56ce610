# SPDX-License-Identifier: Apache-2.0
"""The verbs that move by hand: jog, goto, touch."""

import json
import signal
import threading

import pytest
from click.testing import CliRunner
from console import Tornillo
from moving_chip import MovingChip
from scripted_chip import IDLE

from tornillo.cli import main
from tornillo.errors import AlarmError, ChipError, TornilloError
from tornillo.lathe import Lathe
from tornillo.protocol import Alarm, Axis, Command, ErrorCode, SettingId, State
from tornillo.touching import TouchError, still, touch

#: Half a millimetre in steps of 7.112 um.
HALF_MM = 70
HERE = (IDLE.x, IDLE.z)


@pytest.fixture
def chip(monkeypatch: pytest.MonkeyPatch) -> MovingChip:
    """A homed lathe that moves; nobody waits between two questions."""
    monkeypatch.setattr("tornillo.commands.moving.POLL_S", 0)
    return MovingChip()


@pytest.mark.parametrize(
    ("arguments", "steps", "rate"),
    [
        (("x", "-0.5mm"), (-HALF_MM, 0), 0),
        (("x", "+0.5 mm", "--rate", "50"), (HALF_MM, 0), 50),
        (("z", "0.02inch"), (0, 71), 0),
        (("z", "-40", "--steps"), (0, -40), 0),
        (("x", ".5MM"), (HALF_MM, 0), 0),
    ],
)
def test_jog_moves_by_a_length_or_by_steps(
    tornillo: Tornillo,
    chip: MovingChip,
    arguments: tuple[str, ...],
    steps: tuple[int, int],
    rate: int,
) -> None:
    result = tornillo("jog", *arguments)
    assert result.exit_code == 0, result.stderr
    assert chip.moves == [(Command.JOG, HERE[0] + steps[0], HERE[1] + steps[1])]
    assert chip.rate == rate
    assert result.stdout.startswith("tool at diameter ")
    assert chip.coming == []


def test_jog_before_homing_tells_steps(tornillo: Tornillo, chip: MovingChip) -> None:
    chip.status = IDLE._replace(flags=0)
    result = tornillo("jog", "x", "10", "--steps")
    assert (result.exit_code, result.stdout) == (0, "X -1779, Z -8000 steps; not homed\n")


@pytest.mark.parametrize(
    "arguments",
    [
        ("x", "5"),
        ("x", "5cm"),
        ("x", "far"),
        ("x", "1mm", "--steps"),
        ("x", "0.5", "--steps"),
        ("y", "1mm"),
        ("x", "1mm", "--rate", "0"),
    ],
)
def test_jog_refuses_what_is_no_length_as_wrong_usage(
    tornillo: Tornillo, chip: MovingChip, arguments: tuple[str, ...]
) -> None:
    assert tornillo("jog", *arguments).exit_code == 2
    assert chip.moves == []


@pytest.mark.parametrize(
    "arguments",
    [("jog", "x", "13mm"), ("goto", "--diameter", "51"), ("goto", "--z", "58")],
)
def test_a_place_outside_the_travel_is_refused_with_the_travel(
    tornillo: Tornillo, chip: MovingChip, arguments: tuple[str, ...]
) -> None:
    result = tornillo(*arguments)
    assert result.exit_code == 1
    assert "its travel is -" in result.stderr
    assert chip.moves == []


@pytest.mark.parametrize(
    ("arguments", "place"),
    [
        (("--diameter", "30"), (-3575 + 2109, HERE[1])),
        (("--z", "-2"), (HERE[0], -8000 - 281)),
        (("--diameter", "1", "--z", "0.1", "--units", "inch"), (-3575 + 1786, -8000 + 357)),
    ],
)
def test_goto_goes_to_part_coordinates(
    tornillo: Tornillo, chip: MovingChip, arguments: tuple[str, ...], place: tuple[int, int]
) -> None:
    result = tornillo("goto", *arguments)
    assert result.exit_code == 0, result.stderr
    assert chip.moves == [(Command.GOTO, *place)]


def test_goto_without_a_place_is_wrong_usage(tornillo: Tornillo) -> None:
    assert tornillo("goto").exit_code == 2


@pytest.mark.parametrize(
    ("arguments", "what"), [(("jog", "x", "1mm"), "jog"), (("goto", "--z", "1"), "way")]
)
def test_a_move_that_somebody_stops_is_told(
    tornillo: Tornillo, chip: MovingChip, arguments: tuple[str, ...], what: str
) -> None:
    chip.stops_at = (-1700, -7900)
    result = tornillo(*arguments)
    assert result.exit_code == 1
    assert f"the {what} was stopped before its end" in result.stderr


def test_a_move_that_ends_in_an_alarm_is_told(tornillo: Tornillo, chip: MovingChip) -> None:
    chip.trips = Alarm.LIMIT
    result = tornillo("jog", "x", "1mm")
    assert result.exit_code == 1
    assert "alarm LIMIT of X" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "command"),
    [(("jog", "z", "1mm"), Command.HOLD), (("touch", "x"), Command.STOP)],
)
def test_ctrl_c_brakes_a_move_and_stops_a_touch(
    tornillo: Tornillo, chip: MovingChip, arguments: tuple[str, ...], command: Command
) -> None:
    ident = threading.main_thread().ident
    assert ident is not None

    def press() -> None:
        if chip.status.state in (State.MOVING, State.TOUCHING):
            chip.at_status = lambda: None
            chip.coming = [chip.status] * 1000
            signal.pthread_kill(ident, signal.SIGINT)

    chip.surfaces = [-2000]
    chip.at_status = press
    result = tornillo(*arguments)
    assert result.exit_code == 1
    assert "stopped by Ctrl-C; the position is still known" in result.stderr
    assert command in chip.executed
    assert chip.status.state == State.IDLE


# -- touch ----------------------------------------------------------------------------------------


def test_touch_repeats_from_the_back_off_and_ends_where_it_began(
    tornillo: Tornillo, chip: MovingChip
) -> None:
    chip.surfaces = [-2000, -2001, -2000]
    result = tornillo("touch", "x", "--within", "3mm")
    assert result.exit_code == 0, result.stderr
    end = HERE[0] - 422
    back = [-2000 + 50, -2001 + 50, HERE[0]]
    assert chip.moves == [
        move
        for place in back
        for move in ((Command.TOUCH, end, HERE[1]), (Command.GOTO, place, HERE[1]))
    ]
    # 1575 steps from the axis.
    assert result.stdout == "touched diameter 22.403 mm; the readings differ by 1 steps at most\n"


def test_near_its_start_touch_backs_off_to_its_start_only(
    tornillo: Tornillo, chip: MovingChip
) -> None:
    chip.surfaces = [HERE[0] - 20] * 2
    assert tornillo("touch", "x", "--repeats", "2").exit_code == 0
    assert [x for command, x, _ in chip.moves if command is Command.GOTO] == [HERE[0]] * 2


@pytest.mark.parametrize(
    ("arguments", "surface", "zeroed"),
    [
        # Touched 211 steps further in than the tool stands when the zero is stored.
        (("x", "--diameter", "25.4"), HERE[0] - 211, (0, 1786 + 211)),
        (("x", "--diameter", "1", "--units", "inch"), HERE[0] - 211, (0, 1786 + 211)),
        (("z", "--at", "0"), HERE[1] - 100, (1, 100)),
        (("z", "--at", "-1"), HERE[1] - 100, (1, 100 - 141)),
        (("z", "--at", "0", "--outwards"), HERE[1] + 100, (1, -100)),
    ],
)
def test_touch_stores_part_zero(
    tornillo: Tornillo,
    chip: MovingChip,
    arguments: tuple[str, ...],
    surface: int,
    zeroed: tuple[int, int],
) -> None:
    chip.surfaces = [surface] * 3
    result = tornillo("touch", *arguments)
    assert result.exit_code == 0, result.stderr
    assert chip.zeroed == [zeroed]


def test_what_was_touched_is_told_in_the_new_coordinates(
    tornillo: Tornillo, chip: MovingChip
) -> None:
    chip.surfaces = [-2000] * 3
    assert "touched diameter 19.017 mm" in tornillo("touch", "x", "--diameter", "19.02").stdout


def test_touch_never_searches_beyond_the_soft_limits(tornillo: Tornillo, chip: MovingChip) -> None:
    chip.surfaces = [-100] * 3
    assert tornillo("touch", "x", "--within", "50mm", "--outwards").exit_code == 0
    assert chip.moves[0] == (Command.TOUCH, 0, HERE[1])
    chip.surfaces = [-3000] * 3
    assert tornillo("touch", "x", "--within", "50mm").exit_code == 0
    assert (Command.TOUCH, -3575, HERE[1]) in chip.moves


def test_two_sides_of_a_bar_that_runs_out_give_its_diameter(
    tornillo: Tornillo, chip: MovingChip, monkeypatch: pytest.MonkeyPatch
) -> None:
    chip.surfaces = [*[-2000 + 6] * 3, *[-2000 - 6] * 3]
    runner = CliRunner()
    result = runner.invoke(main, ["touch", "x", "--two-sided"], input="\n")
    assert result.exit_code == 0, result.output
    assert "turn the chuck by hand, half a turn" in result.stderr
    assert "touched diameter 22.403 mm, 6 steps out of centre" in result.stdout


def test_the_other_side_is_not_touched_without_a_word_from_the_user(
    tornillo: Tornillo, chip: MovingChip
) -> None:
    chip.surfaces = [-2000] * 6
    result = CliRunner().invoke(main, ["touch", "x", "--two-sided", "--diameter", "3"], input="")
    assert result.exit_code == 1
    assert len(chip.surfaces) == 3
    assert chip.zeroed == []


def test_touch_prints_everything_as_json(tornillo: Tornillo, chip: MovingChip) -> None:
    chip.surfaces = [-2001, -2000, -2000]
    assert json.loads(tornillo("touch", "x", "--json").stdout) == {
        "axis": "X",
        "position": -2000,
        "positions": [[-2001, -2000, -2000]],
        "spread": 1,
        "eccentricity": 0.0,
        "value": 22.4028,
        "units": "mm",
    }


@pytest.mark.parametrize(
    "arguments",
    [
        ("x", "--at", "0"),
        ("z", "--diameter", "3"),
        ("z", "--two-sided"),
        ("x", "--within", "40"),
        ("x", "--repeats", "10"),
    ],
)
def test_touch_refuses_what_does_not_belong_together(
    tornillo: Tornillo, chip: MovingChip, arguments: tuple[str, ...]
) -> None:
    assert tornillo("touch", *arguments).exit_code == 2
    assert chip.moves == []


def test_no_contact_is_told_and_the_tool_goes_back(tornillo: Tornillo, chip: MovingChip) -> None:
    chip.surfaces = [None]
    result = tornillo("touch", "x", "--within", "1mm", "--diameter", "3")
    assert result.exit_code == 1
    assert "no contact within 141 steps" in result.stderr
    assert "Try: bring the tool nearer" in result.stderr
    assert chip.moves[-1] == (Command.GOTO, *HERE)
    assert chip.zeroed == []


@pytest.mark.parametrize(
    ("code", "text"),
    [
        (ErrorCode.PROBE_CLOSED, "the contact sensor is closed already"),
        (ErrorCode.NOT_FITTED, "the machine has no contact sensor"),
        (ErrorCode.NOT_HOMED, "does not know where its slides are"),
    ],
)
def test_what_the_chip_refuses_is_told(
    tornillo: Tornillo, chip: MovingChip, code: ErrorCode, text: str
) -> None:
    chip.refusals[Command.TOUCH] = bytes([code])
    result = tornillo("touch", "x")
    assert result.exit_code == 1
    assert text in result.stderr


def test_a_search_that_was_stopped_is_told(lathe: Lathe, chip: MovingChip) -> None:
    chip.surfaces = [None]
    chip.stops_at = (HERE[0] - 3, HERE[1])
    with pytest.raises(TouchError, match="the search was stopped"):
        touch(lathe, Axis.X, -50, every=0)


def test_a_contact_that_stays_closed_is_told(lathe: Lathe, chip: MovingChip) -> None:
    chip.surfaces = [-2000] * 3
    chip.stuck = True
    with pytest.raises(TouchError, match="stayed closed"):
        touch(lathe, Axis.X, -500, every=0)


def test_readings_apart_are_refused(lathe: Lathe, chip: MovingChip) -> None:
    chip.surfaces = [-2000, -2003, -2001]
    with pytest.raises(TouchError, match="differ by 3 steps: -2000, -2003, -2001") as caught:
        touch(lathe, Axis.X, -500, every=0)
    assert "spread_max allows 2" in caught.value.remedy
    chip.values[SettingId.SPREAD_MAX] = 3
    chip.surfaces = [-2000, -2003, -2001]
    assert touch(lathe, Axis.X, -500, every=0).position == -2001


def test_repeats_have_a_range(lathe: Lathe) -> None:
    for repeats in (0, 10):
        with pytest.raises(TornilloError, match=f"{repeats} repeats are not possible"):
            touch(lathe, Axis.X, -500, repeats, every=0)


def test_the_library_waits_for_a_move_and_tells_its_alarm(lathe: Lathe, chip: MovingChip) -> None:
    lathe.goto(x=-1800)
    assert still(lathe, 0).position(Axis.X) == -1800
    chip.trips = Alarm.SWITCH_WIRING
    lathe.jog(Axis.Z, -5)
    with pytest.raises(AlarmError, match="alarm SWITCH_WIRING of X"):
        still(lathe, 0)


def test_a_place_that_the_chip_cannot_count_to_is_refused_by_the_library(
    lathe: Lathe, chip: MovingChip
) -> None:
    with pytest.raises(ChipError, match="a value lies outside its range"):
        lathe.goto(x=-40_000)
    with pytest.raises(ChipError, match="a value lies outside its range"):
        lathe.jog(Axis.Z, -30_000)
    assert chip.moves == []


def test_status_shows_the_contact(tornillo: Tornillo, chip: MovingChip) -> None:
    chip.status = IDLE._replace(inputs=0x40)
    assert "contact sensor" in tornillo("status").stdout
    assert json.loads(tornillo("status", "--json").stdout)["inputs"] == ["CONTACT"]
    # Bits that mean nothing to a host are not shown.
    chip.status = IDLE._replace(inputs=0x3F)
    assert json.loads(tornillo("status", "--json").stdout)["inputs"] == []
