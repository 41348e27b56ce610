# SPDX-License-Identifier: Apache-2.0
"""The menus of the panel: every entry in both languages, and what each does."""

from __future__ import annotations

import menu_model
import pytest
from simulated.at_the_panel import ANSWER_S, STARTED_S, STORED_S, AtThePanel
from simulated.processes import on_a_new_chip
from tornillo.protocol import Alarm, Axis, SettingId, State

PANEL = menu_model.load()
MAIN, *SUBMENUS = PANEL.menus
LANGUAGES = {1: 0, 2: 1}  # setting to place in a text


def texts(menu: str, language: int) -> list[str]:
    """First lines of a menu."""
    return [entry.text[language] for entry in PANEL.menus[menu]]


def walk(panel: AtThePanel, count: int) -> list[str]:
    """First lines from the entry shown to the last of the menu, and once more at its end."""
    seen = []
    for _ in range(count + 1):
        seen.append(panel.read()[0])
        panel.press("down")
    return seen


@pytest.mark.parametrize("setting", LANGUAGES)
@on_a_new_chip
def test_every_menu_shows_every_entry_in_order(setting: int) -> None:
    panel = AtThePanel(settings={"panel": setting})
    language = LANGUAGES[setting]
    main = texts(MAIN, language)
    assert walk(panel, len(main)) == [*main, main[-1]]
    for number, entry in reversed(list(enumerate(PANEL.menus[MAIN]))):
        if entry.kind == "menu":
            while panel.read()[0] != main[number]:
                panel.press("up")
            panel.press("ok")
            wanted = texts(str(entry.argument), language)
            assert walk(panel, len(wanted)) == [*wanted, wanted[-1]]
            panel.press("back")
            assert panel.read()[0] == main[number]
    panel.check()


@pytest.mark.parametrize("setting", LANGUAGES)
@on_a_new_chip
def test_every_alarm_tells_what_has_happened_and_the_way_out(setting: int) -> None:
    panel = AtThePanel(settings={"panel": setting})
    language = LANGUAGES[setting]
    ways = PANEL.raw["panel_way"]
    chip = panel.bench.chip
    chip.set_variable("machine_state", State.ALARM)
    for row in PANEL.raw["alarm"].values():
        if row["value"] != Alarm.NONE:
            chip.set_variable("machine_alarm", row["value"])
            for axis in Axis:
                chip.set_variable("machine_alarm_detail", axis)
                text = row["panel"][language]
                if text.endswith(menu_model.AXIS):
                    text = f"{text.removesuffix(menu_model.AXIS):15}{axis.name}"
                panel.shows(text, ways[row["panel_way"]][language])
    chip.set_variable("machine_state", State.IDLE)


def enter(panel: AtThePanel, menu: str, number: int) -> None:
    """Go from the first entry of the main menu to one of a submenu."""
    at = [entry.argument for entry in PANEL.menus[MAIN]].index(menu)
    panel.press(*["down"] * at, "ok", *["down"] * number)


def stored(panel: AtThePanel, setting: SettingId) -> int:
    """A setting as the chip has it."""
    address = panel.bench.chip.symbols.ram("settings") + 2 * setting
    value = panel.bench.chip.peek(address, 2)
    return value - 0x10000 if value & 0x8000 else value


@on_a_new_chip
def test_every_setting_of_the_menu_shows_its_value_and_takes_a_new_one() -> None:
    panel = AtThePanel()
    enter(panel, "settings", 0)
    for entry in PANEL.menus["settings"][1:]:
        panel.press("down")
        setting = SettingId[str(entry.argument).upper()]
        before = stored(panel, setting)
        panel.shows(entry.text[0], f"{before:16}")
        panel.press("ok", "up")
        panel.shows(entry.text[0], f"      1{before + 1:9}")
        assert stored(panel, setting) == before
        panel.press("back")
        panel.shows(entry.text[0], f"{before:16}")
        panel.press("ok", "up", "ok")
        panel.bench.run(STORED_S)
        assert stored(panel, setting) == before + 1
        panel.bench.power_cycle()
        panel.bench.run(STARTED_S)
        enter(panel, "settings", PANEL.menus["settings"].index(entry))
        assert panel.read()[0] == entry.text[0]
        assert stored(panel, setting) == before + 1
    panel.check()


@on_a_new_chip
def test_a_setting_out_of_its_range_is_refused_and_stays() -> None:
    panel = AtThePanel()
    enter(panel, "settings", 1)
    panel.press("ok", "up", "up", "ok")
    panel.shows("0 mm, 1 inch", "Out of range")
    panel.bench.run(ANSWER_S)
    panel.shows("0 mm, 1 inch", f"{0:16}")


@on_a_new_chip
def test_the_language_changes_at_the_machine_and_stays() -> None:
    panel = AtThePanel()
    enter(panel, "settings", 0)
    panel.shows("Language", "English")
    panel.press("ok")
    panel.bench.run(STORED_S)
    panel.shows("Idioma", "Español")
    panel.bench.power_cycle()
    panel.bench.run(STARTED_S)
    panel.shows("Referencia", "Sin referencia")
    panel.check()


@on_a_new_chip
def test_dead_steps_and_spread_are_those_of_the_last_homing() -> None:
    panel = AtThePanel(backlash_x=7, backlash_z=123, settings={"homing_repeats": 1})
    panel.press("ok")
    panel.waits(State.IDLE)
    panel.press(*["down"] * 8)
    status = panel.bench.status()
    assert (status.dead_x, status.dead_z) == (7, 123)
    panel.shows("Dead, spread", "X   7  0Z 123  0")


@on_a_new_chip
def test_inches_are_shown_where_they_are_chosen() -> None:
    panel = AtThePanel(settings={"panel_inch": 1, "homing_repeats": 1})
    panel.press("ok")
    panel.waits(State.IDLE)
    # 3,555 and 7,980 steps of 7.112 um, X as a diameter; the last digit is cut off.
    panel.shows("Home", "X 1.990Z   2.234")
    enter(panel, "part_zero", 0)
    panel.press("ok", "left", "left", "left", "up", "ok", "down", "ok")
    panel.bench.run(STORED_S)
    panel.shows("Set diameter", "X 1.000Z   2.234")
    # 1 inch of diameter is 1,785.7 steps of radius.
    assert stored(panel, SettingId.ZERO_X) == -20 - 1786


@on_a_new_chip
def test_zero_is_set_where_the_tool_stands_and_found_again() -> None:
    panel = AtThePanel(settings={"homing_repeats": 1}, stock_diameter_mm=0.1)
    panel.press("ok")
    panel.waits(State.IDLE)
    enter(panel, "part_zero", 2)
    panel.press("ok")
    panel.bench.run(STORED_S)
    panel.shows("Set Z to 0", "X50.566Z   0.000")
    panel.press("up", "ok")
    panel.bench.run(STORED_S)
    panel.shows("Set diameter", "X 0.000Z   0.000")
    panel.press("back", *["down"] * 4, "ok", "down", "ok", "ok", "up", "ok", "left")
    panel.bench.run(0.3)
    panel.press("down")
    panel.bench.run(0.3)
    panel.press("back", "back", "down")
    assert panel.bench.position == (-20 - 140, -20 - 140)
    panel.shows("Go to zero", "X-1.991Z  -0.995")
    panel.press("ok")
    panel.bench.run(0.1)
    assert panel.bench.is_in(State.MOVING)
    panel.waits(State.IDLE)
    assert panel.bench.position == (-20, -20)
    panel.check()


@on_a_new_chip
def test_a_touch_that_finds_nothing_says_so_and_changes_nothing() -> None:
    panel = AtThePanel(
        settings={"homing_repeats": 1, "probe_fitted": 1}, stock_diameter_mm=0.1, probe=True
    )
    panel.press("ok")
    panel.waits(State.IDLE)
    enter(panel, "part_zero", 4)
    panel.press("ok")
    panel.waits(State.TOUCHING, timeout=0.5)
    panel.waits(State.IDLE)
    panel.shows("Touch face, Z 0", "No contact")
    assert stored(panel, SettingId.ZERO_Z) == -8000
    # The way is not without end.
    assert panel.bench.position == (-20, -20 - 1000)


@on_a_new_chip
def test_what_cannot_be_done_is_answered_in_plain_words() -> None:
    panel = AtThePanel()
    panel.press("down")
    panel.shows("Part", "No part")
    panel.press("down", "ok", "down", "ok")
    panel.shows("Set diameter", "Home first")
    panel.press("down", "down", "ok")
    panel.shows("Touch diameter", "Home first")
    panel.press("back", "down", "down", "down", "ok")
    panel.shows("Resume part", "Home first")
