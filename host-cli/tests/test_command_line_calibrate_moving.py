# SPDX-License-Identifier: Apache-2.0
"""The verbs calibrate gauge and contact: ways, questions, what is stored and restored."""

from collections.abc import Callable

import pytest
from console import Tornillo
from moving_chip import MovingChip
from scripted_chip import IDLE

from tornillo.protocol import Command, ErrorCode, SettingId, State, StatusInput

STEP_MM = 7.112e-3
HERE = (-20, -8000)


class HomingChip(MovingChip):
    """Homing finds `count` steps of which the setting switch_travel_x is no backlash.

    The contact opens `opens_after` steps of X beyond the place of the last touch; `set_to` are
    the switch travels that were stored.
    """

    def __init__(self) -> None:
        """Stand beside the switch of X, homed."""
        super().__init__()
        self.count = 37
        self.opens_after = 24
        self.touched_at = 0
        self.status = IDLE._replace(x=HERE[0], z=HERE[1], dead_x=37)
        self.set_to: list[int] = []

    def do_home(self, _payload: bytes) -> bytes:
        """HOME."""
        dead = max(0, self.count - self.values[SettingId.SWITCH_TRAVEL_X])
        end = self.status._replace(state=State.IDLE, x=-20, z=-20, dead_x=dead, inputs=0)
        self.status = self.status._replace(state=State.HOMING)
        self.coming = [self.status, end]
        return b""

    def do_setting_set(self, payload: bytes) -> bytes:
        """SETTING_SET."""
        if payload[0] == SettingId.SWITCH_TRAVEL_X:
            self.set_to.append(int.from_bytes(payload[1:], "little"))
        return super().do_setting_set(payload)

    def do_touch(self, payload: bytes) -> bytes:
        """TOUCH."""
        self.touched_at = self.surfaces[0] or 0
        return super().do_touch(payload)

    def do_goto(self, payload: bytes) -> bytes:
        """GOTO."""
        answer = super().do_goto(payload)
        end = self.coming[-1]
        closed = self.touched_at != 0 and end.x - self.touched_at < self.opens_after
        self.coming[-1] = end._replace(inputs=StatusInput.CONTACT if closed else 0)
        return answer

    def do_status(self, payload: bytes) -> bytes:
        """STATUS; the clock goes on."""
        answer = super().do_status(payload)
        self.status = self.status._replace(uptime_ms=self.status.uptime_ms + 20)
        return answer


@pytest.fixture
def chip(monkeypatch: pytest.MonkeyPatch) -> HomingChip:
    """A homed lathe; nobody waits between two questions."""
    monkeypatch.setattr("tornillo.commands.calibrate.POLL_S", 0)
    return HomingChip()


def readings(backlash: int, dead: int, rounds: int, step_mm: float = STEP_MM) -> str:
    """What a gauge shows, mm: start, 1000 steps further, back."""
    back = 5 - (1000 - (1000 + dead - backlash)) * step_mm
    return f"{5:.5f}\n{5 - 1000 * step_mm:.5f}\n{back:.5f}\n" * rounds


def test_the_gauge_is_asked_for_at_three_places_a_round_and_the_travel_is_stored(
    tornillo: Tornillo, chip: HomingChip
) -> None:
    result = tornillo(
        "calibrate", "gauge", "x", "--rounds", "2", "--store", typed=readings(23, 37, 2)
    )
    assert result.exit_code == 0, result.stderr
    places = [x for _, x, _ in chip.moves]
    assert places == [-20, -320, -1320, -320, -20, -320, -1320, -320, -20]
    assert {(command, z) for command, _, z in chip.moves} == {(Command.GOTO, HERE[1])}
    assert "round 2 of 2: reading 1000 steps further [mm]" in result.stderr
    assert "mean 23.0 steps, 3 sigma 0.0 steps" in result.stdout
    assert "recommended switch_travel_x 14 steps (0 to 200 steps)" in result.stdout
    assert chip.values[SettingId.SWITCH_TRAVEL_X] == 14
    assert "home again" in result.stderr


def test_a_way_that_the_slide_does_not_have_is_refused_before_it_moves(
    tornillo: Tornillo, chip: HomingChip
) -> None:
    result = tornillo("calibrate", "gauge", "x", "--steps", "3400")
    assert result.exit_code == 1
    assert "the slide has 3555 steps of way left, 3700 are needed" in result.stderr
    assert chip.moves == []


def test_the_contact_is_measured_with_no_dead_steps_taken_up_and_the_setting_comes_back(
    tornillo: Tornillo, chip: HomingChip
) -> None:
    chip.surfaces = [-300, -300]
    result = tornillo("calibrate", "contact", "x", "--rounds", "2")
    assert result.exit_code == 0, result.stderr
    assert chip.set_to == [37, 0]
    assert chip.executed.count(Command.HOME) == 2
    assert (Command.GOTO, *HERE) in chip.moves  # back to the work after homing
    assert "mean 23.0 steps, 3 sigma 0.0 steps" in result.stdout
    assert "recommended switch_travel_x 14" in result.stdout
    assert "store it: tornillo settings set switch_travel_x 14" in result.stderr
    assert chip.values[SettingId.SWITCH_TRAVEL_X] == 0
    assert chip.status.dead_x == 37


def test_a_block_fits_the_size_of_a_step_too(tornillo: Tornillo, chip: HomingChip) -> None:
    chip.surfaces = [-600, -600, -100]
    result = tornillo(
        "calibrate", "contact", "x", "--rounds", "1", "--block", "3.6", "--store", typed="\n\n"
    )
    assert result.exit_code == 0, result.stderr
    assert "take the block away, then press Enter" in result.stderr
    assert "put the block on the work, then press Enter" in result.stderr
    assert chip.values[SettingId.STEP_X_NM] == 7200
    assert chip.values[SettingId.SWITCH_TRAVEL_X] == 14


@pytest.mark.parametrize("block", ["0", "-1", "thick"])
def test_a_block_without_thickness_is_wrong_usage(
    tornillo: Tornillo, chip: HomingChip, block: str
) -> None:
    result = tornillo("calibrate", "contact", "x", "--block", block)
    assert result.exit_code == 2
    assert chip.moves == []


def lose_the_work(chip: HomingChip) -> None:
    """No contact comes."""
    chip.surfaces = [None]


def keep_contact(chip: HomingChip) -> None:
    """The contact does not open in time."""
    chip.surfaces, chip.opens_after = [-1500], 5000


def have_no_sensor(chip: HomingChip) -> None:
    """The chip says so."""
    chip.refusals[Command.TOUCH] = bytes([ErrorCode.NOT_FITTED])


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        (lose_the_work, "no contact was found"),
        (keep_contact, "the contact stayed closed over 1100 steps"),
        (have_no_sensor, "the machine has no contact sensor"),
    ],
)
def test_whatever_goes_wrong_the_setting_comes_back(
    tornillo: Tornillo, chip: HomingChip, fault: Callable[[HomingChip], None], message: str
) -> None:
    chip.values[SettingId.SWITCH_TRAVEL_X] = 5
    chip.status = chip.status._replace(dead_x=32)
    fault(chip)
    result = tornillo("calibrate", "contact", "x")
    assert result.exit_code == 1
    assert message in result.stderr
    assert chip.set_to == [37, 5]
    assert chip.values[SettingId.SWITCH_TRAVEL_X] == 5
