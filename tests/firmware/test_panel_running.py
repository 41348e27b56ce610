# SPDX-License-Identifier: Apache-2.0
"""The panel while a part is cut: pauses, override, and steps that come in time."""

from __future__ import annotations

import pytest
from motion.reference import Line
from motion.rig import Rig
from simulated import little_pin
from simulated.at_the_panel import STARTED_S, AtThePanel
from simulated.little_pin import CYLINDER, FACE, TOOL
from simulated.processes import on_a_new_chip
from tornillo.image import Record
from tornillo.protocol import OVERRIDE_MAX, OVERRIDE_MIN, SettingId, State
from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.panel import KEYS, Panel

OTHER = TOOL._replace(kind=1, name=b"parting".ljust(12, b"\0"))
MESSAGE = "turn the work round, then RUN"
HALF_S = 2.048  # one half of a long message, then the other
RUN_S = 30.0
TOSL, TOSH = 0xFFD, 0xFFE


def homed(*operations: Record) -> AtThePanel:
    """A homed lathe with a part of these records, the menu at Run."""
    panel = AtThePanel(
        little_pin.image("pin", operations),
        settings={
            "homing_repeats": 1,
            "zero_x": little_pin.ZERO_X,
            "zero_z": little_pin.ZERO_Z,
        },
        **little_pin.OPTIONS,
    )
    panel.press("ok")
    panel.waits(State.IDLE)
    panel.press("down", "down", "down")
    panel.shows("Run", "pin")
    return panel


@on_a_new_chip
def test_a_pause_shows_its_message_in_two_halves() -> None:
    panel = homed(FACE, little_pin.pause(MESSAGE), CYLINDER)
    panel.press("ok")
    panel.waits(State.PAUSE, RUN_S)
    seen = {panel.read()[1]}
    assert panel.lines[0] == "2/3 0/0    Pause"
    panel.bench.run(HALF_S)
    seen.add(panel.lines[1])
    assert seen == {MESSAGE[:16].rstrip(), MESSAGE[16:]}
    panel.bench.press("run")
    panel.waits(State.IDLE, RUN_S)
    panel.check()


@on_a_new_chip
def test_a_change_of_tool_names_the_tool() -> None:
    panel = homed(FACE, OTHER, little_pin.CUT, CYLINDER)
    panel.press("ok")
    panel.waits(State.PAUSE, RUN_S)
    panel.shows(panel.read()[0], "parting")
    assert panel.lines[0].endswith("Pause")
    panel.bench.press("run")
    panel.waits(State.IDLE, RUN_S)


@on_a_new_chip
def test_a_part_by_steps_waits_after_each_operation() -> None:
    panel = homed(FACE, CYLINDER)
    panel.press("down")
    panel.shows("Run by steps", "pin")
    panel.press("ok")
    panel.waits(State.PAUSE, RUN_S)
    assert panel.read()[0].endswith("Pause")
    assert panel.lines[1].startswith("X")  # no message: where the tool is
    panel.bench.press("run")
    panel.waits(State.IDLE, RUN_S)
    panel.shows("Run by steps", "Finished")


@on_a_new_chip
def test_a_part_is_resumed_after_a_stop() -> None:
    panel = homed(FACE, CYLINDER)
    panel.press("ok")
    panel.bench.wait(lambda: panel.bench.chip.variable("progress_record") != 0, RUN_S)
    panel.bench.run(0.5)
    panel.bench.press("stop")
    panel.waits(State.IDLE)
    panel.press("down", "down")
    panel.shows("Resume part", "pin")
    panel.press("ok")
    assert panel.bench.is_in(State.RUNNING)
    panel.waits(State.IDLE, RUN_S)
    panel.shows("Resume part", "Finished")


@pytest.mark.parametrize(("key", "last"), [("up", OVERRIDE_MAX), ("down", OVERRIDE_MIN)])
@on_a_new_chip
def test_the_override_ends_at_its_limits(key: str, last: int) -> None:
    panel = homed(FACE, CYLINDER)
    panel.press("ok")
    panel.bench.press("hold")
    panel.waits(State.HOLD)
    percent = 100
    for _ in range(11):
        panel.press(key)
        percent = max(OVERRIDE_MIN, min(OVERRIDE_MAX, percent + (10 if key == "up" else -10)))
        assert panel.read()[0].endswith(f"{percent:3}%")
        scale = panel.bench.chip.variable("ramp_scale", 2)
        assert scale == pytest.approx(256 * percent / 100, abs=1)
    assert percent == last


@on_a_new_chip
def test_the_main_loop_is_never_kept_for_more_than_two_milliseconds() -> None:
    panel = homed(FACE, CYLINDER)
    chip = panel.bench.chip
    panel.press("ok")
    panel.press("up")
    begin = chip.symbols.code("panel_poll")
    worst = 0
    for _ in range(60):
        assert chip.run_to_address(begin)
        entered = chip.cycle
        assert chip.run_to_address(chip.read(TOSL) | chip.read(TOSH) << 8)
        worst = max(worst, chip.cycle - entered)
        assert panel.bench.is_in(State.RUNNING)
    assert 0.5 < worst / CYCLES_PER_SECOND * 1000 < 2.0


@pytest.mark.parametrize("rate", [5_000, 15_000, 25_000])
@on_a_new_chip
def test_the_queue_never_runs_dry_while_the_panel_writes_at_high_rates(rate: int) -> None:
    rig = Rig(usb=True)
    panel = Panel(rig.chip, rig.run)
    rig.chip.poke(rig.symbols.ram("settings") + 2 * SettingId.PANEL, 2)
    rig.run(STARTED_S)
    rig.quick(rate)
    rig.start([Line(-28_000, 20_000, rate), Line(28_000, -20_000, rate)])
    turn = 0
    while rig.state is State.RUNNING:
        panel.hold(KEYS[turn % 2])  # changes of the override, which show on the display
        rig.run(0.06)
        panel.release()
        rig.run(0.06)
        turn += 1
    assert rig.state is State.IDLE
    assert turn > 10
    assert rig.chip.variable("stream_low") > 20
    assert panel.mistakes == []
