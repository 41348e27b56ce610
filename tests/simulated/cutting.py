# SPDX-License-Identifier: Apache-2.0
"""A part file cut in full on the virtual lathe, next to what the host has planned for it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from tornillo import Part
from tornillo.drives import Drives
from tornillo.image import PartImage
from tornillo.moves import Halt
from tornillo.planning import plan_part
from tornillo.timing import time_plan

from simulated.bench import Bench
from simulated.queued import Listener, Queued

EXAMPLES = Path(__file__).parents[2] / "host-cli" / "examples"
DEAD_X, DEAD_Z = 23, 31
STEP_MM = 7112e-6


@dataclass(frozen=True)
class Cut:
    """What came of it.

    ``report`` is that of the virtual lathe, ``seconds`` the simulated time of the run without its
    pauses, ``estimated`` the host's estimate of that, ``least`` the length of the cuts over their
    feeds. ``as_planned`` tells that every move was the planned one.
    """

    report: dict[str, Any]
    seconds: float
    estimated: float
    least: float
    as_planned: bool

    @property
    def errors(self) -> dict[str, float]:
        """How far each dimension is off the drawing, in steps."""
        return {entry["name"]: entry["error_steps"] for entry in self.report["dimensions"]}

    @property
    def mean_error_mm(self) -> float:
        """The mean of what the dimensions are off, whatever the sign."""
        errors = self._errors_mm()
        return sum(errors) / len(errors)

    @property
    def max_error_mm(self) -> float:
        """What the worst dimension is off, whatever the sign."""
        return max(self._errors_mm())

    def _errors_mm(self) -> list[float]:
        return [
            abs(entry["cut_mm"] - entry["wanted_mm"])
            if "cut_mm" in entry
            else abs(entry["error_steps"]) * STEP_MM
            for entry in self.report["dimensions"]
        ]

    def assert_good(self) -> None:
        """Check that the part is the one drawn, and that nothing happened that must not."""
        report = self.report
        assert self.errors
        assert {name: e for name, e in self.errors.items() if abs(e) > 1.0} == {}
        assert report["gouge_max_steps"] <= 0.5
        assert report["left_max_steps"] <= 1.0
        assert (report["crashes"], report["lost_steps"]) == ([], 0)
        assert {name: broken for name, broken in report["checks"].items() if broken} == {}
        assert self.as_planned
        assert abs(self.estimated / self.seconds - 1) <= 0.03


def cut_file(path: Path) -> Cut:
    """Upload a part file, home, and run it to its end; pauses are gone on from at once."""
    bench = Bench(part=path, backlash_x=DEAD_X, backlash_z=DEAD_Z)
    bench.set(homing_repeats=1)
    bench.home()
    machine = bench.host.machine()
    image = Part.load(path).image(machine)
    plan = plan_part(PartImage.unpack(image), machine)
    stops = iter(plan.stops)

    def at_pause() -> None:
        if next(stops).halt is Halt.TOOL:
            bench.lathe.change_tool()

    drives = replace(Drives.default(), dead_x=DEAD_X, dead_z=DEAD_Z)
    timing = time_plan(plan, drives)
    listener = Listener(bench, at_pause)
    listener.follow(2 * timing.total, bench.host.upload(image))
    wanted = [[Queued.planned(move) for move in chain] for chain in plan.chains()]
    return Cut(
        bench.lathe.report(),
        sum(listener.seconds),
        timing.total,
        sum(timing.least),
        listener.chains == wanted,
    )
