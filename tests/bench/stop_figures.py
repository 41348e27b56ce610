# SPDX-License-Identifier: Apache-2.0
"""How soon emergency stop and limit switches stop the motors."""

from __future__ import annotations

import random
from functools import partial

from measure import BenchError, Figures
from simulated.processes import branch
from simulated.stopping import INPUTS, Stopped, moving_lathe, stop
from virtual_lathe.chip import CYCLES_PER_SECOND

MOMENTS = 40
SEED = 1
US = CYCLES_PER_SECOND / 1e6


def stop_figures() -> Figures:
    """Worst of many moments at 1000 step/s, every input at each, in microseconds."""
    stopped = branch(_measure)
    wrong = [one for one in stopped if one.alarm not in INPUTS.values()]
    if wrong:
        raise BenchError(f"a stop raised another alarm: {wrong[0]}")
    return {
        "estop_latency_us": round(max(one.latency_cycles for one in stopped) / US, 1),
        "estop_total_us": round(max(one.total_cycles for one in stopped) / US),
        "estop_trials": len(stopped),
    }


def _measure() -> list[Stopped]:
    bench = moving_lathe()
    chance = random.Random(SEED)
    stopped = []
    for _ in range(MOMENTS):
        bench.run(chance.uniform(0.02, 0.04))
        stopped += [branch(partial(stop, bench, name)) for name in INPUTS]
    return stopped


def stop_rows(found: Figures) -> list[tuple[str, str, str]]:
    """The rows of docs/benchmarks.md."""
    return [
        (
            f"emergency stop or limit switch, filtered edge to the last step, worst of "
            f"{found['estop_trials']}",
            f"{found['estop_latency_us']:g} us",
            "",
        ),
        (
            "the same from the edge at the pin, filter included",
            f"{found['estop_total_us'] / 1000:.1f} ms",
            "",
        ),
    ]
