# SPDX-License-Identifier: Apache-2.0
"""All figures of the motion, each group on a simulated chip of its own; four minutes."""

from __future__ import annotations

from typing import Any

from motion_accuracy import accuracy
from motion_cost import cost
from motion_holds import holds
from motion_programs import programs
from motion_rates import rates

DIGITS = 4


def rounded(value: Any) -> Any:
    """The same with numbers of at most four decimals."""
    if isinstance(value, float):
        return round(value, DIGITS)
    if isinstance(value, dict):
        return {key: rounded(entry) for key, entry in value.items()}
    return value


def motion_figures() -> dict[str, Any]:
    """Measure accuracy, rates, holds, programs and cycles; keys as in the table of the page.

    ``isr_worst_cycles`` is the worst of all of them.
    """
    found: dict[str, Any] = {}
    worst = 0
    for group in (accuracy, rates, holds, programs, cost):
        part = group()
        worst = max(worst, part.get("isr_worst_cycles", 0))
        found |= part
    worst = max(worst, found["motion_cycles"]["step_interrupt"]["worst"])
    return {key: rounded(value) for key, value in found.items()} | {"isr_worst_cycles": worst}


if __name__ == "__main__":
    for name, figure in motion_figures().items():
        print(f"{name:34} {figure}")
