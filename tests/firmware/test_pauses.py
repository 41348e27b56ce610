# SPDX-License-Identifier: Apache-2.0
"""A run parks and waits: for a pause, for another tool, and after each operation if wanted."""

from __future__ import annotations

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.little_pin import CYLINDER, FACE, TOOL
from simulated.processes import on_a_new_chip
from tornillo.image import Record
from tornillo.protocol import State

PARKED = (-20, -20)
WAIT_S, RUN_S = 0.5, 30.0
OTHER = TOOL._replace(kind=1, name=b"other".ljust(12, b"\0"))


def stops(bench: Bench, step: bool) -> list[int]:
    """Run the selected part; the operations in front of or in which it waited."""
    bench.host.run(step=step)
    found = []
    while True:
        bench.wait(lambda: bench.state is not State.RUNNING, RUN_S)
        if bench.state is not State.PAUSE:
            break
        bench.run(WAIT_S)
        assert bench.state is State.PAUSE
        assert bench.position == PARKED
        found.append(bench.status().operation)
        bench.press("run")
    assert bench.state is State.IDLE
    assert bench.status().permille == 1000
    return found


@pytest.mark.parametrize(
    ("operations", "step", "waits"),
    [
        ((FACE, CYLINDER), False, 0),
        ((FACE, CYLINDER), True, 1),
        ((FACE, little_pin.pause("measure"), CYLINDER), False, 1),
        ((FACE, OTHER, CYLINDER), False, 1),
        ((FACE, little_pin.pause("turn"), OTHER, CYLINDER), False, 1),
        ((little_pin.pause("look"), FACE, OTHER, CYLINDER, little_pin.pause("end")), False, 3),
    ],
)
@on_a_new_chip
def test_a_run_waits_at_park_for_the_run_button(
    operations: tuple[Record, ...], step: bool, waits: int
) -> None:
    bench = little_pin.homed_lathe_with_pin()
    bench.host.upload(little_pin.image("waiting", operations))
    assert len(stops(bench, step)) == waits
