# SPDX-License-Identifier: Apache-2.0
"""The keys of the panel: bouncing, repeating, and none where no panel is fitted."""

from __future__ import annotations

import itertools
import random
from functools import partial

import pytest
from simulated.at_the_panel import STARTED_S, AtThePanel
from simulated.bench import Bench
from simulated.processes import on_a_new_chip
from tornillo.protocol import SettingId, State

REPEAT_FIRST_S, REPEAT_NEXT_S = 0.5, 0.1
TRISA, TRISE, ADCON0 = 0xF92, 0xF96, 0xFC2


def entry(panel: AtThePanel) -> int:
    """Number of the entry shown."""
    return panel.bench.chip.variable("entry")


@pytest.mark.parametrize("bounce_ms", [0.5, 5.0, 15.0])
@on_a_new_chip
def test_a_key_that_bounces_counts_once(bounce_ms: float) -> None:
    panel = AtThePanel()
    keys, bench = panel.bench.lathe.panel, panel.bench
    chance = random.Random(7)
    for pressed in range(1, 5):
        for last in ("down", None):
            end = bench.chip.seconds + bounce_ms / 1000
            while bench.chip.seconds < end:
                # On the way the ladder passes voltages of other keys too.
                keys.hold(chance.choice(("down", "up", "ok", "x-in")))
                bench.run(chance.uniform(0.0001, 0.001))
                keys.release()
                bench.run(chance.uniform(0.0001, 0.001))
            if last:
                keys.hold(last)
            bench.run(0.1)
            assert entry(panel) == pressed
    panel.check()


@on_a_new_chip
def test_a_key_that_is_held_comes_again_after_half_a_second_ten_times_a_second() -> None:
    panel = AtThePanel()
    keys, bench = panel.bench.lathe.panel, panel.bench
    keys.hold("down")
    begin = bench.chip.seconds
    times = []

    def came(wanted: int) -> bool:
        return entry(panel) == wanted

    for wanted in range(1, 7):
        bench.wait(partial(came, wanted), timeout=1.0, every=1e-3)
        times.append(bench.chip.seconds - begin)
    keys.release()
    bench.run(1.0)
    assert entry(panel) == 6
    first, *others = [later - earlier for earlier, later in itertools.pairwise(times)]
    assert times[0] < 0.05
    assert first == pytest.approx(REPEAT_FIRST_S, abs=0.01)
    assert others == pytest.approx([REPEAT_NEXT_S] * len(others), abs=0.01)


@on_a_new_chip
def test_of_two_keys_the_lower_one_counts_and_letting_one_go_makes_the_other_count() -> None:
    panel = AtThePanel()
    keys = panel.bench.lathe.panel
    keys.hold("down", "x-in")
    panel.bench.run(0.1)
    assert entry(panel) == 1
    keys.hold("x-in")
    panel.bench.run(0.1)
    assert entry(panel) == 1
    keys.release()


@on_a_new_chip
def test_five_keys_without_back_lead_everywhere_and_back() -> None:
    panel = AtThePanel()
    panel.press("down", "down", "right", "ok")  # part zero, diameter, changing it
    panel.press("left", "left", "left", "left", "up", "left")
    panel.shows("Diameter", "           0.000")  # as it was: LEFT beyond the largest step
    panel.press("left")
    panel.shows("Part zero")
    panel.press("down", "down", "down", "down", "ok", "ok")
    panel.shows("Jog", "Not homed")
    before = panel.bench.position
    panel.press("up")
    panel.waits(State.IDLE, timeout=0.5)
    assert panel.bench.position == (before[0] + 1, before[1])  # 0.01 mm
    panel.press("ok", "left")
    panel.shows("Jog")
    panel.check()


@pytest.mark.parametrize("other", [None, "right", "x-out"])
@on_a_new_chip
def test_a_slide_moves_as_long_as_its_key_is_held_and_no_longer(other: str | None) -> None:
    panel = AtThePanel(settings={"homing_repeats": 1}, stock_diameter_mm=0.1)
    bench = panel.bench
    panel.press("ok")
    panel.waits(State.IDLE)
    panel.press(*["down"] * 6, "ok", "down", "ok", "ok", "ok", "up", "ok")
    bench.lathe.panel.hold("left")
    bench.run(2.0)
    assert bench.is_in(State.MOVING)
    if other is None:
        bench.lathe.panel.release()
    else:
        bench.lathe.panel.hold(other)
    # 25 ms until the key counts, then it brakes from 1,000 to 400 step/s at 8,000 step/s2.
    bench.run(0.025 + 0.075 + 0.05)
    assert not bench.moving
    assert bench.is_in(State.IDLE)
    bench.lathe.panel.release()
    panel.check()


def assert_nothing_is_driven(bench: Bench) -> None:
    """Check that the panel's pins are inputs and the converter is off."""
    assert bench.chip.peek(TRISA) & 0x3F == 0x3F
    assert bench.chip.peek(TRISE) & 0x07 == 0x07


@on_a_new_chip
def test_without_a_panel_a_floating_input_with_noise_moves_nothing_and_no_pin_is_driven() -> None:
    bench = Bench(panel=True)
    assert bench.host.setting(SettingId.PANEL).value == 0
    before = bench.host.settings()
    bench.home()
    place = bench.position
    chance = random.Random(3)
    for _ in range(2000):
        bench.chip.drive_volts("RA0", chance.uniform(0.0, 5.0), 10_000)
        bench.run(0.0005)
        assert_nothing_is_driven(bench)
    # A voltage that stays is a key that is held.
    for volts in (0.0, 1.3, 2.5, 3.8):
        bench.chip.drive_volts("RA0", volts, 10_000)
        bench.run(1.0)
    assert_nothing_is_driven(bench)
    assert bench.chip.peek(ADCON0) == 0
    assert bench.lathe.panel.glass().writes == 0
    assert (bench.state, bench.position) == (State.IDLE, place)
    homed = {SettingId.DEAD_X, SettingId.DEAD_Z, SettingId.HOME_PHASE_X, SettingId.HOME_PHASE_Z}
    changed = [new for old, new in zip(before, bench.host.settings(), strict=True) if old != new]
    assert {setting.id for setting, _ in changed} <= homed


@on_a_new_chip
def test_a_panel_that_is_taken_away_by_its_setting_is_let_go_and_starts_again() -> None:
    panel = AtThePanel()
    bench = panel.bench
    panel.shows("Home", "Not homed")
    bench.set(panel=0)
    bench.run(0.1)
    assert_nothing_is_driven(bench)
    writes = bench.lathe.panel.glass().writes
    panel.press("down")
    assert bench.lathe.panel.glass().writes == writes
    bench.set(panel=2)
    bench.run(STARTED_S)
    panel.shows("Referencia", "Sin referencia")
    panel.check()
