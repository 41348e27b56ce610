# SPDX-License-Identifier: Apache-2.0
"""Moving by keys, against slides that move and a dead-man that counts simulated time."""

from dataclasses import replace

import pytest
from pressed import PressedKeys
from rich.console import Console
from scripted_chip import IDLE

from tornillo.commands.jog_pad import frame, show_pad, use_key
from tornillo.errors import ChipError
from tornillo.jogging import (
    DEADMAN_MS,
    FAR_STEPS,
    RENEW_S,
    SPEEDS_MS,
    STOPPED_WITHIN_S,
    JogPad,
    fastest,
)
from tornillo.machine import Machine
from tornillo.protocol import SETTINGS, Axis, Command, ErrorCode, SettingId, State
from tornillo.status import Status
from tornillo.units import Scale

LOOK_MS = 30


class Slides:
    """Two slides as the chip moves them, without ramps; `run` lets milliseconds pass."""

    def __init__(self) -> None:
        """Stand in the middle."""
        self.at = {Axis.X: -1789, Axis.Z: -8000}
        self.moving: Axis | None = None
        self.refused: ErrorCode | None = None
        self.jogs: list[tuple[Axis, int, int, int]] = []
        self.stops = 0
        self._way = 0.0
        self._rate = 0
        self._alive_ms = 0.0

    def jog(self, axis: Axis, steps: int, rate: int, deadman_ms: int = 0) -> None:
        """Begin, or renew."""
        if self.refused is not None:
            raise ChipError(Command.HOLD, self.refused)
        self.jogs.append((axis, steps, rate, deadman_ms))
        if self.moving is None:
            self.moving, self._way, self._rate = axis, steps, rate
        assert self.moving is axis
        self._alive_ms = deadman_ms

    def stop(self) -> None:
        """Stand."""
        self.stops += 1
        self.moving = None

    def status(self) -> Status:
        """Homed, and where the slides are."""
        known = Status.from_data(IDLE)
        state = State.IDLE if self.moving is None else State.HOMING
        return replace(known, state=state, x=self.at[Axis.X], z=self.at[Axis.Z])

    def run(self, milliseconds: float) -> None:
        """Let time pass."""
        if self.moving is None:
            return
        lasting = min(milliseconds, self._alive_ms)
        way = min(abs(self._way), self._rate * lasting / 1000)
        moved = round(way)
        sign = 1 if self._way > 0 else -1
        self.at[self.moving] += sign * moved
        self._way -= sign * moved
        self._alive_ms -= milliseconds
        if self._way == 0 or self._alive_ms <= 0:
            self.moving = None


@pytest.fixture
def slides() -> Slides:
    """Slides in the middle of their travel."""
    return Slides()


@pytest.fixture
def pad(slides: Slides, machine: Machine) -> JogPad:
    """A pad for them in millimetres."""
    return JogPad(slides, Scale("mm", machine), rapid=900, most=1000)


def press(pad: JogPad, *keys: str) -> None:
    """Press keys one after the other."""
    for key in keys:
        use_key(pad, key, pad.mover.status())


def wait(pad: JogPad, slides: Slides, looks: int) -> None:
    """Let looks without a key pass."""
    for _ in range(looks):
        slides.run(LOOK_MS)
        use_key(pad, None, slides.status())


@pytest.mark.parametrize(
    ("key", "axis", "sign"),
    [("left", Axis.Z, -1), ("right", Axis.Z, 1), ("up", Axis.X, 1), ("down", Axis.X, -1)],
)
def test_an_arrow_makes_one_step_its_way(
    pad: JogPad, slides: Slides, key: str, axis: Axis, sign: int
) -> None:
    before = slides.at[axis]
    press(pad, key)
    assert slides.jogs == [(axis, sign, 100, DEADMAN_MS)]
    wait(pad, slides, 3)
    assert slides.at[axis] == before + sign


def test_a_long_slow_step_is_kept_alive_to_its_end_and_not_beyond(
    pad: JogPad, slides: Slides
) -> None:
    press(pad, "s", "s", "s", "left")
    assert slides.jogs[0] == (Axis.Z, -141, 100, DEADMAN_MS)
    wait(pad, slides, 60)
    assert slides.at[Axis.Z] == -8141
    assert slides.moving is None
    sent = len(slides.jogs)
    wait(pad, slides, 10)
    assert len(slides.jogs) == sent
    assert all(abs(steps) / 100 > RENEW_S for _, steps, _, _ in slides.jogs[1:])


def test_repeats_of_the_key_do_not_add_steps_to_one_under_way(pad: JogPad, slides: Slides) -> None:
    press(pad, "s", "s", "left", "left", "left")
    wait(pad, slides, 20)
    assert slides.at[Axis.Z] == -8014


def test_a_held_key_moves_on_and_its_release_stops_within_the_dead_mans_time(
    pad: JogPad, slides: Slides
) -> None:
    press(pad, "c", "1", "enter")
    for _ in range(50):
        press(pad, "left")
        slides.run(40)
    assert slides.moving is Axis.Z
    assert slides.jogs[0] == (Axis.Z, -FAR_STEPS, 1000, DEADMAN_MS)
    here = slides.at[Axis.Z]
    wait(pad, slides, 10)
    assert slides.moving is None
    assert here - slides.at[Axis.Z] <= 1000 * DEADMAN_MS / 1000


def test_a_lost_link_stops_the_same_way(pad: JogPad, slides: Slides) -> None:
    press(pad, "s", "s", "s", "left")
    slides.run(10_000)  # nobody asks or renews any more
    assert slides.moving is None
    assert slides.at[Axis.Z] == -8000 - 100 * DEADMAN_MS // 1000


def test_braking_fits_into_what_the_dead_man_leaves(machine: Machine) -> None:
    start = SETTINGS[SettingId.START_RATE_Z].default
    acceleration = SETTINGS[SettingId.ACCELERATION].default
    most = fastest(start, acceleration)
    assert most >= 1000  # a millisecond a step, the fastest of paper S0, is allowed
    assert DEADMAN_MS / 1000 + (most - start) / acceleration < STOPPED_WITHIN_S


def test_any_other_key_ends_a_continuous_move_at_once(pad: JogPad, slides: Slides) -> None:
    press(pad, "c", "left")
    press(pad, "right")
    assert (slides.moving, slides.stops) == (None, 1)
    press(pad, "left", " ")
    assert (slides.moving, slides.stops) == (None, 2)
    assert pad.message == "stopped"


def test_speeds_are_chosen_by_keys_in_milliseconds_or_units(pad: JogPad) -> None:
    assert (pad.ms_per_step, pad.rate) == (10, 100)
    assert pad.per_minute == pytest.approx(42.67, abs=0.01)
    press(pad, "+")
    assert pad.ms_per_step == 8
    press(pad, *20 * ["-"])
    assert (pad.ms_per_step, pad.rate) == (255, 3)
    press(pad, *20 * ["+"])
    assert (pad.ms_per_step, pad.rate) == (SPEEDS_MS[0], 1000)
    press(pad, "4", "2", "enter")
    assert pad.ms_per_step == 42
    press(pad, "1", "2", "0", "m")
    assert pad.ms_per_step == 4
    press(pad, "2", "5", "6", "enter")
    assert "type 1 to 255 milliseconds a step" in pad.message
    press(pad, "9", "9", "9", "m")
    assert "type 1.67 to 427 mm/min, then m" in pad.message
    press(pad, "m")
    assert "then m" in pad.message
    assert pad.ms_per_step == 4


def test_rapid_is_limited_to_what_stops_in_time(slides: Slides, machine: Machine) -> None:
    pad = JogPad(slides, Scale("inch", machine), rapid=5000, most=1016)
    press(pad, "r")
    assert pad.rate == 1016
    press(pad, "r")
    assert pad.rate == 100


def test_the_screen_shows_both_axes_in_units_and_steps(
    pad: JogPad, slides: Slides, machine: Machine
) -> None:
    def shown(pad: JogPad, status: Status) -> str:
        console = Console(width=100)
        with console.capture() as captured:
            console.print(frame(pad, status))
        return captured.get()

    screen = shown(pad, slides.status())
    assert "X (diameter)  25.40 mm, -1789 steps" in screen
    assert "Z             0.00 mm, -8000 steps" in screen
    assert "moves by      one step" in screen
    assert "speed         10 ms a step, 42.7 mm/min" in screen
    press(pad, "s", "r", "7")
    screen = shown(pad, slides.status())
    assert "moves by      0.01 mm" in screen
    assert "speed         rapid, 384 mm/min" in screen
    assert screen.rstrip().endswith("7")
    press(pad, "c")
    lost = replace(slides.status(), flags=type(slides.status().flags)(0))
    screen = shown(pad, lost)
    assert "not homed, -1789 steps" in screen
    assert "as long as the key is held" in screen


def test_a_refusal_of_the_chip_is_shown(pad: JogPad, slides: Slides) -> None:
    slides.refused = ErrorCode.OUT_OF_RANGE
    press(pad, "left")
    assert "a value lies outside its range" in pad.message


def test_the_pad_ends_with_q_and_with_standing_slides(pad: JogPad, slides: Slides) -> None:
    show_pad(pad, PressedKeys("c", "left", None, "q"))
    assert slides.jogs[-1][1] == -FAR_STEPS
    assert slides.moving is None
    assert slides.stops >= 1
