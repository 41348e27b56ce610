# SPDX-License-Identifier: Apache-2.0
"""The reference part of paper S0 on a machine whose limit switches have travel.

What homing counts from a switch closing to opening is the backlash and the travel of the switch.
Left in, the travel is taken up at every reversal, so that after one in + direction the tool stands
that much farther out than the lathe believes. What it does to a part depends on which way the tool
came when part zero was taken.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

from tornillo import Part
from tornillo.protocol import Axis, State

from simulated.bench import Bench
from simulated.cutting import DEAD_X, DEAD_Z, EXAMPLES

PART = EXAMPLES / "reference-inch.toml"
SWITCH_TRAVEL = 14
#: In front of the bar and beside it, where the tool is when its place is measured.
MEASURED_AT, FROM = -600, 100
TIMEOUT_S = 400.0


class Zero(Enum):
    """How the tool came to the place where part zero was taken."""

    INWARDS = "inwards, as from touching the bar"
    OUTWARDS = "outwards, as from withdrawing until it is free"


@dataclass(frozen=True)
class Size:
    """A dimension as drawn and as cut, mm, and how far it is off, mm."""

    name: str
    wanted: float
    cut: float

    @property
    def error(self) -> float:
        """Above 0: too large."""
        return self.cut - self.wanted


def cut_reference(zero: Zero, setting: int) -> list[Size]:
    """Home with a setting of the switch travel, take part zero, cut the part, measure it."""
    bench = Bench(
        part=PART,
        backlash_x=DEAD_X,
        backlash_z=DEAD_Z,
        switch_travel_x=SWITCH_TRAVEL,
        switch_travel_z=SWITCH_TRAVEL,
    )
    bench.set(homing_repeats=1, switch_travel_x=setting, switch_travel_z=setting)
    bench.home()
    _take_zero(bench, zero)
    slot = bench.host.upload(Part.load(PART).image(bench.host.machine()))
    bench.host.run(slot)
    bench.wait(lambda: bench.state is not State.RUNNING, TIMEOUT_S, every=0.05)
    assert bench.status().finished, bench.alarm
    return [_size(entry) for entry in bench.lathe.report()["dimensions"] if "cut_mm" in entry]


def _take_zero(bench: Bench, zero: Zero) -> None:
    """Bring the tool to a place, measure where it is, and tell the lathe."""
    options = bench.lathe.options
    if zero is Zero.OUTWARDS:
        _go(bench, x=MEASURED_AT - FROM)
    _go(bench, x=MEASURED_AT)
    bench.host.zero(Axis.X, round(bench.axis(Axis.X).slide - options.part_zero_x))
    _go(bench, z=MEASURED_AT)
    bench.host.zero(Axis.Z, round(bench.axis(Axis.Z).slide - options.part_zero_z))


def _go(bench: Bench, **place: int) -> None:
    bench.host.goto(**place)
    bench.wait_for(State.IDLE)


def _size(entry: dict[str, Any]) -> Size:
    return Size(entry["name"], entry["wanted_mm"], entry["cut_mm"])
