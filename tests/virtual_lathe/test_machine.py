# SPDX-License-Identifier: Apache-2.0
"""Motors, screws and switches, driven by writing the coil latches by hand."""

from __future__ import annotations

from collections.abc import Callable

from virtual_lathe.machine import AxisName, AxisOptions, FaultKind
from virtual_lathe.motor_hand import FORWARD, Hand
from virtual_lathe.worker import in_new_process

Program = Callable[[str], str]
WAVE = (1, 8, 2, 4)
HALF = (5, 1, 9, 8, 10, 2, 6, 4)
TRAVEL = 3575


def _backlash(firmware: str) -> list[float]:
    hand = Hand(firmware, AxisOptions(-100, TRAVEL, backlash=23, slack=23))
    places = []
    for count in (10, -23, -1, -9, 23, 5):
        hand.step(count)
        places.append(hand.x.slide)
    assert hand.x.lost_steps == 0
    return places


def test_the_slide_follows_after_the_dead_steps(program: Program) -> None:
    assert in_new_process(_backlash, program("spin")) == [-90, -90, -91, -100, -100, -95]


def _count_to_opening(firmware: str, backlash: int, travel: int) -> tuple[int, int, float]:
    hand = Hand(firmware, AxisOptions(-5, TRAVEL, backlash, backlash, travel))
    closing = 0
    while not hand.pressed:
        hand.step(1)
        closing += 1
    count = 0
    while hand.pressed:
        hand.step(-1)
        count += 1
    return closing, count, hand.x.slide


def test_steps_from_closing_to_opening_are_backlash_and_travel_and_one(program: Program) -> None:
    for backlash, travel in ((0, 0), (1, 0), (23, 0), (23, 14)):
        found = in_new_process(_count_to_opening, program("spin"), backlash, travel)
        assert found == (6 + travel, backlash + travel + 1, 0)


def _patterns(firmware: str) -> list[float]:
    hand = Hand(firmware, AxisOptions(-100, TRAVEL))
    hand.step(8, FORWARD)
    full = hand.x.slide
    hand.step(8, HALF)
    half = hand.x.slide
    hand.set(WAVE[0])
    hand.phase = 0
    hand.step(4, WAVE)
    return [full, half, hand.x.slide, hand.x.lost_steps, hand.x.illegal_patterns]


def test_full_half_and_wave_patterns_turn_the_rotor(program: Program) -> None:
    # 8 full steps, 8 half steps, half a step to the wave ring and 4 full steps there
    assert in_new_process(_patterns, program("spin")) == [-92, -88, -83.5, 0, 0]


def _bad_drives(firmware: str) -> list[tuple[float, int, list[str]]]:
    hand = Hand(firmware, AxisOptions(-100, TRAVEL))
    results = []

    def note() -> None:
        kinds = [fault.kind.name for fault in hand.machine.take_faults()]
        results.append((hand.x.slide, hand.x.lost_steps, sorted(set(kinds))))

    hand.set(3)
    note()
    hand.set(FORWARD[0])
    hand.set(FORWARD[2])
    note()
    hand.set(FORWARD[0])
    hand.machine.take_faults()
    hand.phase = 0
    hand.step(1)
    hand.step(8, FORWARD, 1 / 3000)
    note()
    return results


def test_illegal_sudden_and_fast_patterns_lose_steps(program: Program) -> None:
    illegal, sudden, fast = in_new_process(_bad_drives, program("spin"))
    assert illegal == (-100, 0, ["PATTERN"])
    assert sudden == (-100, 1, ["JUMP", "LOST_STEP"])
    assert fast[1] > 1
    assert fast[2] == ["LOST_STEP"]


def _end_stop(firmware: str) -> tuple[float, int, int, list[FaultKind]]:
    hand = Hand(firmware, AxisOptions(0, TRAVEL))
    hand.step(70)
    kinds = [fault.kind for fault in hand.machine.take_faults()]
    return hand.x.slide, hand.x.end_stops, hand.pressed, kinds[:1]


def test_the_slide_stops_at_the_hard_end(program: Program) -> None:
    slide, hits, pressed, kinds = in_new_process(_end_stop, program("spin"))
    assert slide == 60
    assert hits > 0
    assert pressed == 1
    assert kinds == [FaultKind.END_STOP]


def _power(firmware: str) -> tuple[float, float]:
    hand = Hand(firmware, AxisOptions(-100, TRAVEL))
    hand.machine.set_motor_power(False)
    hand.step(8)
    without = hand.x.slide
    hand.machine.set_motor_power(True)
    hand.step(4)
    return without, hand.x.slide


def test_without_motor_power_nothing_moves(program: Program) -> None:
    assert in_new_process(_power, program("spin")) == (-100, -96)


def _bounce(firmware: str) -> tuple[int, int, int]:
    hand = Hand(firmware, AxisOptions(-5, TRAVEL))
    hand.machine.set_switch_quality(bounce_us=5000, noise_hz=0, seed=3)
    hand.chip.log_pins("RB4")
    hand.step(6)
    hand.chip.run(0.02)
    changes = len(hand.chip.pin_changes())
    hand.machine.break_switch_wire(AxisName.X)
    hand.step(-10)
    hand.chip.run(0.02)
    return changes, hand.pressed, hand.x.pressed


def test_contacts_bounce_and_a_broken_wire_reads_as_pressed(program: Program) -> None:
    changes, pressed, really = in_new_process(_bounce, program("spin"))
    assert changes > 4
    assert (pressed, really) == (1, False)
