# SPDX-License-Identifier: Apache-2.0
"""The parts of the papers, cut in full on the virtual lathe: errors, times, what was gouged."""

from __future__ import annotations

import statistics
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from measure import BenchError, Figures
from simulated.bench import Bench
from simulated.processes import branch
from tornillo import Part
from tornillo.drives import Drives
from tornillo.machine import Machine
from tornillo.moves import Halt
from tornillo.planning import plan_part
from tornillo.protocol import State
from tornillo.timing import time_plan

EXAMPLES = Path(__file__).resolve().parents[2] / "host-cli" / "examples"
NAMES = (
    "test-bar",
    "stepped-pin",
    "cone",
    "ball-convex",
    "ball-concave",
    "reference-inch",
    "reference-mm",
    "pawn",
    "ring",
    "three-marks",
    "g71-contour",
)
MEAN_ERRORS = ("reference-inch", "reference-mm")
LARGEST_ERRORS = ("pawn",)
TIMEOUT_S = 1500.0
DEAD_X, DEAD_Z = 23, 31
BRANCH_S = 900.0


def shape_figures(names: tuple[str, ...] = NAMES) -> Figures:
    """Each part on a lathe of its own; the keys that the issues name, and a table of all."""
    cut = {name: branch(partial(cut_part, name), BRANCH_S) for name in names}
    found: Figures = {"shapes": cut}
    found |= {f"{name.replace('-', '_')}_least_s": one["least_s"] for name, one in cut.items()}
    for name in MEAN_ERRORS:
        if name in cut:
            found[f"{name.replace('-', '_')}_mean_error_mm"] = cut[name]["mean_error_mm"]
    for name in LARGEST_ERRORS:
        if name in cut:
            found[f"{name}_max_error_mm"] = cut[name]["max_error_mm"]
            found[f"{name}_s"] = cut[name]["seconds"]
    if "reference-inch" in cut:
        found["reference_part_s"] = cut["reference-inch"]["seconds"]
    found["gouge_max_steps"] = max(one["gouge_steps"] for one in cut.values())
    found["crashes"] = sum(one["crashes"] for one in cut.values())
    return found


def cut_part(name: str) -> dict[str, Any]:
    """Cut one example part from RUN to parked, changing tools when the lathe asks for them.

    Raises BenchError when the lathe does not finish it.
    """
    path = EXAMPLES / f"{name}.toml"
    bench = Bench(part=path, backlash_x=DEAD_X, backlash_z=DEAD_Z)
    part, machine = Part.load(path), Machine.load()
    bench.home()
    image = part.steps(machine)
    slot = bench.host.upload(part.image(machine))
    plan = plan_part(image, machine)
    halts = iter([stop.halt for stop in plan.stops])
    start = bench.lathe.seconds
    bench.host.run(slot)
    while True:
        bench.wait(lambda: bench.state is not State.RUNNING, TIMEOUT_S, every=0.05)
        if bench.state is not State.PAUSE:
            break
        if next(halts) is Halt.TOOL:
            bench.lathe.change_tool()
        bench.host.resume()
    seconds = bench.lathe.seconds - start
    if not bench.status().finished:
        raise BenchError(f"{name}: {bench.state.name}, alarm {bench.alarm}")
    return judged(bench, seconds) | planned(plan)


def judged(bench: Bench, seconds: float) -> dict[str, Any]:
    """What has become of the bar."""
    report = bench.lathe.report()
    sizes = report["dimensions"]
    errors = [abs(size["cut_mm"] - size["wanted_mm"]) for size in sizes]
    return {
        "seconds": round(seconds, 1),
        "dimensions": len(sizes),
        "mean_error_mm": round(statistics.fmean(errors), 4),
        "max_error_mm": round(max(errors), 4),
        "max_error_steps": max(abs(size["error_steps"]) for size in sizes),
        "gouge_steps": report["gouge_max_steps"],
        "left_steps": report["left_max_steps"],
        "lost_steps": report["lost_steps"],
        "crashes": len(report["crashes"]),
    }


def planned(plan: Any) -> dict[str, Any]:
    """What the host says beforehand: the time, and the least that cutting takes."""
    drives = replace(Drives.default(), dead_x=DEAD_X, dead_z=DEAD_Z)
    times = time_plan(plan, drives)
    return {"estimate_s": round(times.total, 1), "least_s": round(sum(times.least), 1)}


if __name__ == "__main__":
    for chosen in sys.argv[1:] or NAMES:
        print(chosen, branch(partial(cut_part, chosen), BRANCH_S), flush=True)
