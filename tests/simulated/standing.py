# SPDX-License-Identifier: Apache-2.0
"""Coming to a stand: what a hold may still do, and that nothing moves after it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from tornillo.protocol import State, StatusFlag
from virtual_lathe.chip import CYCLES_PER_SECOND

from simulated.bench import Bench

COILS = ("RB0", "RB1", "RB2", "RB3", "RD0", "RD1", "RD2", "RD3")
#: Both ports are written by one interrupt, this many cycles apart at most.
SAME_STEP = 10
#: A rest between two segments is longer than any interval of the little pin: 10 ms.
REST_CYCLES = 120_000
#: The entry whose time is set already, and the one of which the speed is being worked out.
LATENCY_STEPS = 2


@dataclass(frozen=True)
class Limits:
    """The settings that braking depends on: steps/s^2 and steps/s."""

    acceleration: int = 8000
    start_rate: int = 400

    def braking_steps(self, speed: float) -> float:
        """Return the entries between a hold at a speed and the last step.

        The ramp's own way in steps of about a millisecond, and the latency.
        """
        above = max(0.0, speed**2 - self.start_rate**2)
        return above / (2 * self.acceleration) + speed / 1000 + LATENCY_STEPS


def entries(changes: list[tuple[int, int]]) -> list[int]:
    """Return the times of the entries of the stream that changed coils, both axes as one."""
    times = [cycle for cycle, _ in changes]
    return times[:1] + [after for time, after in pairwise(times) if after - time > SAME_STEP]


def assert_nothing_moves(bench: Bench, seconds: float = 0.05) -> None:
    """Check that no coil changes for some time."""
    bench.chip.log_pins(*COILS)
    bench.run(seconds)
    assert bench.chip.pin_changes() == []


class Holds:
    """Holds of a run, each followed from the cycle at which the state changes; begin at rest."""

    def __init__(self, bench: Bench, limits: Limits) -> None:
        """Listen to the state and the coils from now on."""
        self._bench = bench
        self._limits = limits
        state = bench.chip.symbols.ram("machine_state")
        bench.chip.watch_writes(state, state)
        bench.chip.log_pins(*COILS)

    def come_to_a_stand(self) -> int:
        """Wait until a hold has brought the lathe to a stand; return the entries that took.

        Checks that it brakes at once, ever slower, within the braking distance, and that nothing
        moves as soon as the status says so.
        """
        bench = self._bench
        timeout = bench.chip.seconds + 0.5
        while StatusFlag.MOTION in bench.status().flags:
            assert bench.chip.seconds < timeout
        assert bench.is_in(State.HOLD)
        held = [w.cycle for w in bench.chip.ram_writes() if w.value == State.HOLD][-1]
        times = entries(bench.chip.pin_changes())
        assert_nothing_moves(bench, 0.03)
        before = [time for time in times if time <= held]
        after = [time for time in times if time > held]
        intervals = [then - time for time, then in pairwise(before[-2:] + after)]
        # Where a slide turns back it rests, and has no speed to brake from.
        if len(before) >= 2 and after and max(intervals) < REST_CYCLES:
            speed = CYCLES_PER_SECOND / (before[-1] - before[-2])
            # While it still gains speed, the last millisecond's gain comes on top.
            speed += 2 * self._limits.acceleration / 1000
            allowed = self._limits.braking_steps(speed)
            assert len(after) <= allowed, intervals
            braking = intervals[1 + LATENCY_STEPS :]
            assert braking == sorted(braking)
        return len(after)
