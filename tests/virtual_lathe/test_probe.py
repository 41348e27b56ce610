# SPDX-License-Identifier: Apache-2.0
"""The contact sensor: closed exactly where tool and metal touch."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.machine import AxisOptions
from virtual_lathe.motor_hand import Hand
from virtual_lathe.tool import Tool
from virtual_lathe.worker import in_new_process
from virtual_lathe.workpiece import Stock, Workpiece

Program = Callable[[str], str]
PIN = "RA1"
RADIUS, ZERO_X, ZERO_Z = 60, -100, -500
BESIDE, AT_THE_FACE = -600, -500
POINT = Tool()
ROUND = Tool(nose=40.0)
OFFSET = Tool(offset_x=7.0)


def lathe(firmware: str, z: int, tool: Tool, backlash: int = 0) -> tuple[Hand, Workpiece]:
    """Return a lathe with a bar and the sensor wired, X 70 steps outside of the axis."""
    hand = Hand(firmware, AxisOptions(-30, 3575, backlash=backlash), z)
    work = Workpiece(Stock(RADIUS, 200), ZERO_X, ZERO_Z, tool=tool)
    work.connect_probe()
    return hand, work


def _closes_at(firmware: str, z: int, tool: Tool) -> tuple[float, float]:
    """Return the slide's X when the contact closes on the way in, and opens on the way out."""
    hand, _ = lathe(firmware, z, tool)
    while hand.chip.level(PIN):
        hand.step(-1)
    closed = hand.x.slide
    hand.step(-1)
    assert hand.chip.level(PIN) == 0
    while not hand.chip.level(PIN):
        hand.step(1)
    return closed, hand.x.slide


@pytest.mark.parametrize(
    ("z", "tool", "above"),
    [
        (BESIDE, POINT, 0.0),
        (BESIDE, ROUND, 0.0),
        (BESIDE, OFFSET, 7.0),
        # The nose's centre stands 40, 20 and 8 steps in front of the bar's sharp corner.
        (AT_THE_FACE, ROUND, -40.0),
        (AT_THE_FACE - 20, ROUND, math.sqrt(40**2 - 20**2) - 40),
        (AT_THE_FACE - 32, ROUND, math.sqrt(40**2 - 8**2) - 40),
    ],
)
def test_it_closes_where_the_outline_of_the_tool_meets_the_metal(
    program: Program, z: int, tool: Tool, above: float
) -> None:
    closed, opened = in_new_process(_closes_at, program("spin"), z, tool)
    assert closed == ZERO_X + math.floor(RADIUS + above + 1e-6)
    assert opened == closed + 1


def _before_the_face(firmware: str) -> int:
    hand, _ = lathe(firmware, AT_THE_FACE + 1, POINT)
    hand.step(-60)
    return hand.chip.level(PIN)


def test_in_front_of_the_face_there_is_nothing_to_touch(program: Program) -> None:
    assert in_new_process(_before_the_face, program("spin")) == 1


def _dead_steps(firmware: str) -> list[int]:
    hand, _ = lathe(firmware, BESIDE, POINT, backlash=9)
    levels = []
    for count in (-9, -1, 9, 1):
        hand.step(count)
        levels.append(hand.chip.level(PIN))
    return levels


def test_it_is_the_slide_that_counts_and_not_the_screw(program: Program) -> None:
    # The nut was last pulled in negative direction: only the way back has dead steps.
    assert in_new_process(_dead_steps, program("spin")) == [1, 0, 0, 1]


def _what_is_cut(firmware: str) -> list[int]:
    hand, work = lathe(firmware, BESIDE, POINT)
    levels = []
    for count in (-30, 5, 5, -10):
        hand.step(count)
        work.cut(hand.machine.take_moves())
        levels.append(hand.chip.level(PIN))
    return levels


def test_what_the_tool_has_cut_is_gone_and_it_rests_on_what_is_left(program: Program) -> None:
    assert in_new_process(_what_is_cut, program("spin")) == [0, 1, 1, 0]


def _another_tool(firmware: str) -> list[int]:
    hand, work = lathe(firmware, BESIDE, POINT)
    hand.step(-9)
    levels = [hand.chip.level(PIN)]
    for tool in (OFFSET, Tool(offset_x=-1.0)):
        work.change_tool(tool)
        levels.append(hand.chip.level(PIN))
    return levels


def test_another_tool_touches_elsewhere(program: Program) -> None:
    assert in_new_process(_another_tool, program("spin")) == [1, 0, 1]


def _bounce(firmware: str) -> tuple[int, float, int]:
    hand, _ = lathe(firmware, BESIDE, POINT)
    hand.machine.set_switch_quality(bounce_us=5000, noise_hz=0, seed=3)
    hand.step(-9)
    hand.chip.log_pins(PIN)
    hand.step(-1, seconds=0.02)
    changes = [cycle for cycle, _ in hand.chip.pin_changes()]
    return len(changes), (changes[-1] - changes[0]) / CYCLES_PER_SECOND, hand.chip.level(PIN)


def test_it_bounces_as_long_as_the_switches_do(program: Program) -> None:
    changes, seconds, level = in_new_process(_bounce, program("spin"))
    assert changes > 4
    assert 0.001 < seconds <= 0.005
    assert level == 0


def _short(firmware: str) -> list[int]:
    hand = Hand(firmware, AxisOptions(-30, 3575))
    levels = [hand.chip.level(PIN)]
    for shorted in (True, False):
        hand.machine.short_probe(shorted)
        levels.append(hand.chip.level(PIN))
    return levels


def test_without_a_sensor_the_pin_is_pulled_up_and_a_short_pulls_it_down(
    program: Program,
) -> None:
    assert in_new_process(_short, program("spin")) == [1, 0, 1]
