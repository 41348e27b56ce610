# SPDX-License-Identifier: Apache-2.0
"""Calibration on virtual machines whose backlash and switch travel are known."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import pytest
import tornillo.commands.calibrate as verbs
from click.testing import CliRunner
from simulated import little_pin
from simulated.bench import Bench
from simulated.cutting import EXAMPLES
from simulated.processes import on_a_new_chip
from tornillo import Lathe, Part
from tornillo.calibration import Known, Programme, Ways, from_ways
from tornillo.cli import main
from tornillo.protocol import Axis, SettingId, State

STEP_UM = 7.112
FORWARD, BACK = 1050, 950


def tornillo(bench: Bench, *arguments: str) -> Any:
    """Run a command on the bench and return what it prints for scripts."""

    @contextmanager
    def connected() -> Iterator[Lathe]:
        yield bench.host

    vars(verbs)["connected"] = connected
    vars(verbs)["POLL_S"] = 0.0
    done = CliRunner().invoke(main, [*arguments, "--json"], catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    return json.loads(done.stdout)


def gauge(bench: Bench, axis: Axis, _question: str, _units: str) -> float:
    """What a dial gauge on the slide shows, micrometres."""
    return 5000.0 - bench.axis(axis).slide * STEP_UM


@pytest.mark.parametrize(
    ("axis", "backlash", "travel"),
    [(Axis.X, 0, 60), (Axis.X, 200, 60), (Axis.Z, 23, 14)],
)
@on_a_new_chip
def test_the_dial_gauge_finds_the_travel_of_the_switch_and_then_homing_the_backlash(
    axis: Axis, backlash: int, travel: int
) -> None:
    name = axis.name.lower()
    options: dict[str, Any] = {f"backlash_{name}": backlash, f"switch_travel_{name}": travel}
    bench = Bench(**options)
    bench.set(homing_repeats=1)
    bench.home()

    def dead() -> int:
        status = bench.status()
        return status.dead_x if axis is Axis.X else status.dead_z

    assert dead() == backlash + travel
    vars(verbs)["ask"] = partial(gauge, bench, axis)
    found = tornillo(
        bench, "calibrate", "gauge", name, "--rounds", "2", "--steps", "100", "--store"
    )
    assert found["backlash_steps"] == {"mean": backlash, "sigma": 0, "three_sigma": 0}
    assert found["recommended"] == ({f"switch_travel_{name}": travel} if travel else {})
    bench.home()
    assert dead() == backlash


@pytest.mark.parametrize(("backlash", "travel", "setting"), [(9, 14, 0)])
@on_a_new_chip
def test_the_contact_sensor_finds_the_same_and_leaves_the_setting_until_it_is_stored(
    backlash: int, travel: int, setting: int
) -> None:
    options = little_pin.OPTIONS | {"probe": True}
    bench = Bench(backlash_x=backlash, switch_travel_x=travel, **options)
    bench.set(zero_x=little_pin.ZERO_X, zero_z=little_pin.ZERO_Z, probe_fitted=1)
    bench.set(homing_repeats=1, switch_travel_x=setting)
    bench.home()
    bench.host.goto(z=-80)  # beside the bar
    bench.wait_for(State.IDLE)
    found = tornillo(bench, "calibrate", "contact", "x", "--rounds", "2", "--within", "40")
    assert found["backlash_steps"] == {"mean": backlash, "sigma": 0, "three_sigma": 0}
    assert found["switch_travel_steps"] == travel
    wanted = {} if travel == setting else {"switch_travel_x": travel}
    assert found["recommended"] == wanted
    assert bench.host.setting(SettingId.SWITCH_TRAVEL_X).value == setting
    assert bench.status().dead_x == backlash + travel - setting
    bench.set(**found["recommended"])
    bench.home()
    assert bench.status().dead_x == backlash


def cut_marks(bench: Bench) -> Ways:
    """Cut the three marks and measure them as a person would."""
    slot = bench.host.upload(Part.load(EXAMPLES / "three-marks.toml").image(bench.host.machine()))
    bench.host.run(slot)
    bench.wait(lambda: bench.state is not State.RUNNING, 200.0, every=0.05)
    bench.lathe.change_tool()
    bench.host.resume()
    bench.wait(lambda: bench.state is not State.RUNNING, 200.0, every=0.05)
    cut = {entry["name"]: entry["cut_mm"] for entry in bench.lathe.report()["dimensions"]}
    places = [1000 * cut[f"groove {number} z"] for number in (1, 2, 3)]
    return Ways(places[0] - places[1], places[2] - places[1])


@on_a_new_chip
def test_three_marks_cut_with_too_large_dead_steps_tell_the_travel_of_the_switch() -> None:
    bench = Bench(
        part=EXAMPLES / "three-marks.toml", backlash_x=23, backlash_z=31, switch_travel_z=14
    )
    bench.set(homing_repeats=1)
    bench.home()
    assert bench.status().dead_z == 45
    ways = cut_marks(bench)
    assert ways.first == pytest.approx(FORWARD * STEP_UM, abs=0.5)
    assert ways.second == pytest.approx((BACK + 14) * STEP_UM, abs=0.5)
    found = from_ways([ways], Programme(FORWARD, BACK), Known(Axis.Z, 7112, 45, 0))
    assert found.values == {SettingId.SWITCH_TRAVEL_Z: 14}
    assert found.backlash.mean == pytest.approx(31, abs=0.1)
