# SPDX-License-Identifier: Apache-2.0
"""Where the time goes: instruction cycles of each part of the motion pipeline.

Times are from the first instruction of a function to its return, interrupts left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from motion.reference import Line, Segment, arc_between
from motion.rig import Rig
from tornillo.protocol import State
from virtual_lathe.worker import in_new_process

TOSL = 0xFFD
SLICE_CYCLES = 12_000
RATE = 3_000.0


@dataclass
class Cost:
    """Calls of one function, what they took and how many entries they made."""

    calls: int = 0
    cycles: int = 0
    worst: int = 0
    entries: int = 0

    def as_dict(self) -> dict[str, float]:
        """Mean and worst per call, and the mean per entry where entries are made."""
        report: dict[str, float] = {
            "calls": self.calls,
            "mean": round(self.cycles / max(self.calls, 1), 1),
            "worst": self.worst,
        }
        if self.entries:
            report["per_entry"] = round(self.cycles / self.entries, 1)
        return report


class Stopwatch:
    """Measures the functions named, as long as :meth:`run` lets the chip work."""

    def __init__(self, rig: Rig, names: dict[str, str]) -> None:
        """Measure functions; the value is the variable that holds the entries to make, or "".

        A function that the build has put in place of its only call has no address: left out.
        """
        self.rig = rig
        program = rig.symbols.program
        self.at = {program[f"_{name}"]: name for name in names if f"_{name}" in program}
        self.counters = names
        self.costs = {name: Cost() for name in names}
        self.open: dict[int, tuple[str, int, int]] = {}
        for address in self.at:
            rig.chip.set_break(address)

    def _interrupted(self) -> int:
        chip = self.rig.chip
        return chip.interrupt_cost(high=True).total + chip.interrupt_cost(high=False).total

    def _look(self) -> None:
        chip = self.rig.chip
        pc = chip.pc
        if pc in self.open:
            name, start, interrupted = self.open.pop(pc)
            spent = chip.cycle - start - (self._interrupted() - interrupted)
            cost = self.costs[name]
            cost.calls += 1
            cost.cycles += spent
            cost.worst = max(cost.worst, spent)
            if pc not in self.at and not self.rig.asks:
                chip.set_break(pc, False)
        if pc in self.at:
            name = self.at[pc]
            counter = self.counters[name]
            if counter:
                self.costs[name].entries += chip.variable(counter)
            back = chip.read(TOSL) | chip.read(TOSL + 1) << 8
            self.open[back] = name, chip.cycle, self._interrupted()
            chip.set_break(back)

    def run(self, chain: list[Segment]) -> None:
        """Run a chain to its end."""
        rig = self.rig
        rig.start(chain)
        while rig.state not in (State.IDLE, State.ALARM):
            rig.chip.run_to(rig.chip.cycle + SLICE_CYCLES)
            self._look()
            if rig.asks:
                rig.answer()


def _measure() -> dict[str, Any]:
    rig = Rig()
    rig.quick(4_000)
    rig.chip.clear_statistics()
    watch = Stopwatch(
        rig,
        {
            "interpolate_line": "run_batch",
            "interpolate_arc": "run_batch",
            "arc_begin": "",
            "arc_next": "",
            "plan_next": "",
            "ramp_tick": "",
        },
    )
    circle = [arc_between(700, k * 1.5, 1.5, True, RATE) for k in range(4)]
    watch.run([Line(500, -300, RATE), *circle, Line(-200, 700, RATE)])
    step = rig.chip.interrupt_cost(high=True)
    report = {name: cost.as_dict() for name, cost in watch.costs.items() if cost.calls}
    report["step_interrupt"] = {
        "calls": step.entries,
        "mean": round(step.mean, 1),
        "worst": step.worst,
    }
    return {"motion_cycles": report}


def cost() -> dict[str, Any]:
    """Measure the cycles of each part of the pipeline."""
    return in_new_process(_measure)
