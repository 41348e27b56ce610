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
    FAR_STEPS,
    LATE_S,
    RELEASED_S,
    SILENCE_MS,
    SPEEDS_MS,
    STOPPED_WITHIN_S,
    JogPad,
    fastest,
)
from tornillo.machine import Machine
from tornillo.protocol import SETTINGS, Axis, Command, ErrorCode, SettingId, State, StatusFlag
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
        self.homed = True
        self.jogs: list[tuple[Axis, int, int]] = []
        self.holds = 0
        self.clock_ms = 0.0
        self._heard_ms = 0.0
        self._way = 0
        self._rate = 0

    def jog(self, axis: Axis, steps: int, rate: int = 0, patience_ms: int = 0) -> None:
        """Begin."""
        assert patience_ms == SILENCE_MS
        if self.refused is not None:
            raise ChipError(Command.HOLD, self.refused)
        assert self.moving is None
        self.jogs.append((axis, steps, rate))
        self.moving, self._way, self._rate = axis, steps, rate
        self._heard_ms = self.clock_ms

    def hold(self) -> None:
        """Stand."""
        self.holds += 1
        self.moving = None

    def status(self) -> Status:
        """Homed, and where the slides are."""
        self._heard_ms = self.clock_ms
        known = Status.from_data(IDLE)
        state = State.IDLE if self.moving is None else State.HOMING
        flags = known.flags if self.homed else StatusFlag(0)
        return replace(known, state=state, flags=flags, x=self.at[Axis.X], z=self.at[Axis.Z])

    def run(self, milliseconds: float) -> None:
        """Let time pass."""
        lasting = min(milliseconds, self._heard_ms + SILENCE_MS - self.clock_ms)
        self.clock_ms += milliseconds
        if self.moving is None:
            return
        moved = min(abs(self._way), round(self._rate * lasting / 1000))
        sign = 1 if self._way > 0 else -1
        self.at[self.moving] += sign * moved
        self._way -= sign * moved
        if self._way == 0 or lasting < milliseconds:
            self.moving = None


@pytest.fixture
def slides() -> Slides:
    """Slides in the middle of their travel."""
    return Slides()


@pytest.fixture
def pad(slides: Slides, machine: Machine) -> JogPad:
    """A pad for them in millimetres."""
    scale = Scale("mm", machine)
    return JogPad(slides, scale, rapid=900, most=1000, now=lambda: slides.clock_ms / 1000)


def press(pad: JogPad, *keys: str) -> None:
    """Press keys one after the other."""
    for key in keys:
        use_key(pad, key, pad.mover.status())


def wait(pad: JogPad, slides: Slides, milliseconds: float) -> None:
    """Let time pass without a key, as the screen does."""
    end = slides.clock_ms + milliseconds
    while slides.clock_ms < end:
        slides.run(max(1.0, min(LOOK_MS, 1000 * pad.patience_s)))
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
    assert slides.jogs == [(axis, sign, 100)]
    wait(pad, slides, 90)
    assert slides.at[axis] == before + sign


def test_a_long_slow_step_goes_to_its_end(pad: JogPad, slides: Slides) -> None:
    press(pad, "s", "s", "s", "left")
    assert slides.jogs == [(Axis.Z, -141, 100)]
    wait(pad, slides, 2000)
    assert slides.at[Axis.Z] == -8141
    assert slides.holds == 0


def test_repeats_of_the_key_do_not_add_steps_to_one_under_way(pad: JogPad, slides: Slides) -> None:
    press(pad, "s", "s", "left", "left", "left")
    wait(pad, slides, 500)
    assert slides.at[Axis.Z] == -8014


def test_a_held_key_moves_to_the_end_of_the_travel_and_its_release_stops(
    pad: JogPad, slides: Slides
) -> None:
    press(pad, "c", "1", "enter")
    for _ in range(50):
        press(pad, "left")
        slides.run(40)
    assert slides.moving is Axis.Z
    assert slides.jogs == [(Axis.Z, -16072 + 8000, 1000)]
    released, here = slides.clock_ms - 40, slides.at[Axis.Z] + 40
    wait(pad, slides, 300)
    assert slides.moving is None
    assert slides.holds == 1
    assert here - slides.at[Axis.Z] <= 1000 * RELEASED_S + LOOK_MS
    assert released < slides.clock_ms


@pytest.mark.parametrize(("key", "steps"), [("right", 8000), ("up", 1789), ("down", 1789 - 3575)])
def test_the_way_ends_with_the_travel(pad: JogPad, slides: Slides, key: str, steps: int) -> None:
    press(pad, "c", key)
    assert slides.jogs[0][1] == steps


def test_without_homing_there_is_no_end_but_the_release(pad: JogPad, slides: Slides) -> None:
    slides.homed = False
    press(pad, "c", "right")
    assert slides.jogs[0][1] == FAR_STEPS
    slides.homed, slides.at[Axis.X] = True, 0
    press(pad, " ", "up")
    assert len(slides.jogs) == 1  # it stands at the end already


def test_a_lost_link_stops_by_the_chip_alone(pad: JogPad, slides: Slides) -> None:
    press(pad, "s", "s", "s", "left")
    slides.run(10_000)  # nobody asks any more
    assert slides.moving is None
    assert slides.at[Axis.Z] == -8000 - 100 * SILENCE_MS // 1000


def test_braking_fits_into_what_the_dead_man_leaves(machine: Machine) -> None:
    start = SETTINGS[SettingId.START_RATE_Z].default
    acceleration = SETTINGS[SettingId.ACCELERATION].default
    most = fastest(start, acceleration)
    assert most >= 1000  # a millisecond a step, the fastest of paper S0, is allowed
    assert SILENCE_MS / 1000 + (most - start) / acceleration < STOPPED_WITHIN_S
    assert RELEASED_S + LATE_S + (most - start) / acceleration <= STOPPED_WITHIN_S


def test_any_other_key_ends_a_continuous_move_at_once(pad: JogPad, slides: Slides) -> None:
    press(pad, "c", "left")
    press(pad, "right")
    assert (slides.moving, slides.holds) == (None, 1)
    press(pad, "left", " ")
    assert (slides.moving, slides.holds) == (None, 2)
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
    slides.homed = False
    screen = shown(pad, slides.status())
    assert "not homed, -1789 steps" in screen
    assert "as long as the key is held" in screen


def test_a_refusal_of_the_chip_is_shown(pad: JogPad, slides: Slides) -> None:
    slides.refused = ErrorCode.OUT_OF_RANGE
    press(pad, "left")
    assert "a value lies outside its range" in pad.message


def test_the_pad_ends_with_q_and_with_standing_slides(pad: JogPad, slides: Slides) -> None:
    show_pad(pad, PressedKeys("c", "left", None, "q"))
    assert slides.jogs[-1][1] < -8000
    assert slides.moving is None
    assert slides.holds >= 1
