# SPDX-License-Identifier: Apache-2.0
"""A day's work by the keys of the panel alone, no computer near the lathe."""

from __future__ import annotations

import re

import pytest
from simulated.at_the_panel import ANSWER_S, AtThePanel
from simulated.cutting import EXAMPLES
from simulated.processes import on_a_new_chip
from tornillo.protocol import Alarm, Axis, SettingId, State
from virtual_lathe.machine import AxisName

CONE = EXAMPLES / "cone.toml"
#: Where the spindle's axis is, and what the lathe has been told before it is touched off.
ZERO_X, WRONG_ZERO_X = -3575, -3500
#: Dead steps that homing finds.
DEAD_X, DEAD_Z = 7, 12
DIAMETER = 25.4
SWITCH_Z = 0x02  # of the chip's inputs
POSITION = re.compile(r"X *(-?\d+\.\d{3}) ?Z *(-?\d+\.\d{3})$")
RUNNING = re.compile(r"1/1 ([1-6])/6( +\d?\d:\d\d)?$")


def lathe() -> AtThePanel:
    """A lathe with a bar in it, and two parts in its memory, the cone not the newest."""
    return AtThePanel(
        CONE,
        EXAMPLES / "ring.toml",
        settings={"homing_repeats": 1, "probe_fitted": 1, "zero_x": WRONG_ZERO_X},
        part=CONE,
        probe=True,
        backlash_x=DEAD_X,
        backlash_z=DEAD_Z,
    )


def position(text: str) -> tuple[float, float]:
    """X as a diameter, and Z, as the display tells them."""
    found = POSITION.match(text)
    assert found is not None, text
    return float(found[1]), float(found[2])


def home(panel: AtThePanel) -> None:
    """Home, the first entry of the menu."""
    panel.shows("Home", "Not homed")
    panel.press("ok")
    panel.bench.run(0.2)
    assert panel.lines[0] == "Homing"
    panel.waits(State.IDLE)
    assert panel.bench.homed
    # 3,500 - 20 and 8,000 - 20 steps of 7.112 um.
    panel.shows("Home", "X49.499Z  56.753")


def choose(panel: AtThePanel) -> None:
    """Choose the cone."""
    panel.press("down")
    panel.shows("Part", "ring")
    panel.press("ok")
    panel.shows("Part", "cone")


def approach(panel: AtThePanel) -> None:
    """Jog beside the bar: Z as long as the key is down, then X by steps of a millimetre."""
    panel.press("down", "down", "down", "down", "down")
    panel.shows("Jog")
    panel.press("ok", "down", "ok", "ok")
    panel.shows("Step", "           1.000")
    panel.press("ok")
    panel.shows("Step", "Continuous")
    panel.press("up", "ok")
    panel.hold("left", 8.2)
    assert panel.bench.is_in(State.MOVING)
    panel.waits(State.IDLE, timeout=0.5)
    beside = panel.bench.position[1]
    assert -8500 < beside < -8050
    panel.press("ok", "down", "ok", "ok", "ok")
    panel.shows("Step", "           1.000")
    panel.press("up", "ok")
    for _ in range(11):
        panel.press("x-in")
        panel.bench.run(0.2)
    # 1 mm is 140 whole steps of 7.112 um.
    assert panel.bench.position == (-20 - 11 * 140, beside)
    panel.press("back", "left")
    panel.shows("Jog")


def touch_off(panel: AtThePanel) -> None:
    """Type the diameter of the bar and let the tool feel it."""
    panel.press("up", "up", "up", "up")
    panel.shows("Part zero")
    panel.press("right")
    panel.shows("Diameter", "           0.000")
    panel.press("ok", "left", "left", "left", "left")
    panel.shows("Diameter", " 10.000    0.000")
    panel.press("up", "up", "right", *["up"] * 6, "down", "right", *["up"] * 4)
    panel.shows("Diameter", "  0.100   25.400")
    panel.press("ok")
    panel.shows("Diameter", "          25.400")
    panel.press("down", "down", "down")
    assert panel.read()[0] == "Touch diameter"
    panel.press("ok")
    panel.bench.run(0.2)
    assert panel.lines[0] == "Touching"
    panel.waits(State.IDLE)
    panel.shows("Touch diameter", "Zero set")
    panel.bench.run(ANSWER_S)
    x, _ = position(panel.lines[1])
    assert x == pytest.approx(DIAMETER, abs=0.015)  # a step is 0.014 of diameter
    panel.press("back")


def run(panel: AtThePanel) -> None:
    """Cut the part, with a hold and an override on the way."""
    bench = panel.bench
    panel.press("down")
    panel.shows("Run", "cone")
    panel.press("ok")
    bench.run(5.0)
    first, second = panel.lines
    assert RUNNING.match(first)
    assert position(second)
    bench.press("hold")
    bench.run(0.5)
    panel.shows("1/1 1/6    Hold", panel.read()[1])
    still = bench.position
    panel.press("up", "up")
    panel.shows("1/1 1/6     120%", panel.read()[1])
    bench.run(ANSWER_S)
    assert panel.lines[0] == "1/1 1/6    Hold"
    assert bench.position == still
    bench.press("run")
    passes = set()
    told: list[int] = []
    while not bench.is_in(State.IDLE):
        bench.run(0.1)
        if found := RUNNING.match(panel.lines[0]):
            passes.add(int(found[1]))
            if found[2]:
                minutes, seconds = found[2].split(":")
                told.append(60 * int(minutes) + int(seconds))
    # The levels end on the cone, each earlier: one of them may be too short to be read.
    assert {1, 2, 3, 6} <= passes <= {1, 2, 3, 4, 5, 6}
    assert told
    assert told[0] > 10
    assert told[-1] < told[0]
    panel.shows("Run", "Finished")
    bench.run(ANSWER_S)
    panel.shows("Run", "cone")


def limit_and_recovery(panel: AtThePanel) -> None:
    """A slide stands on its switch; the panel says so, and leads out of it."""
    bench = panel.bench
    bench.lathe.machine.place(AxisName.Z, 3)
    panel.waits(State.ALARM, timeout=0.5)
    assert bench.alarm == (Alarm.LIMIT, Axis.Z)
    panel.shows("Limit switch   Z", "OK, jog away")
    panel.press("down")  # no menu as long as there is an alarm
    panel.shows("Limit switch   Z", "OK, jog away")
    panel.press("ok")
    assert bench.is_in(State.IDLE)
    panel.shows("Run", "cone")
    panel.press("ok")
    panel.shows("Run", "Home first")
    bench.run(ANSWER_S)
    panel.press("down", "down", "down", "ok", "ok")
    panel.shows("Jog", "Not homed")
    panel.press("right")
    bench.run(0.2)
    panel.shows("Jog", "Other way")
    bench.run(ANSWER_S)
    panel.press("left")
    panel.waits(State.IDLE)
    assert bench.chip.variable("inputs_state") & SWITCH_Z == 0
    panel.press("ok", "back", *["up"] * 6)
    panel.shows("Home", "Not homed")
    panel.press("ok")
    panel.waits(State.IDLE)
    assert bench.homed


@on_a_new_chip
def test_a_whole_session_needs_nothing_but_the_keys() -> None:
    panel = lathe()
    home(panel)
    choose(panel)
    approach(panel)
    touch_off(panel)
    settings = panel.bench.chip.symbols.ram("settings")
    zero = panel.bench.chip.peek(settings + 2 * SettingId.ZERO_X, 2) - 0x10000
    assert zero == pytest.approx(ZERO_X, abs=1)
    run(panel)
    report = panel.bench.lathe.report()
    errors = [abs(entry["error_steps"]) for entry in report["dimensions"]]
    assert errors
    assert max(errors) <= 1.0
    limit_and_recovery(panel)
    panel.check()
