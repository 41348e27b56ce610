# SPDX-License-Identifier: Apache-2.0
"""What the main loop planned for each step, next to what the step interrupt made of it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from simulated.bench import Bench

LOG_ROOM = 65536
X_PINS = ("RD0", "RD1", "RD2", "RD3")


@dataclass(frozen=True)
class PlannedStep:
    """The time after one step: its begin, its length, and the period planned then; cycles."""

    cycle: int
    interval: int
    period: int


class Planned:
    """Follows the period handed to the step interrupt, and the coils of X; begin at rest.

    Now and then the interrupt that makes a step takes over the period that stands in
    ``stream_period``, and notes in ``ramp_count`` that it has; that is then the time until the
    next step, where no stretch applies.
    """

    def __init__(self, bench: Bench) -> None:
        """Listen from now on."""
        symbols = bench.chip.symbols
        self._bench = bench
        self._taken = symbols.ram("ramp_count")
        self._period = symbols.ram("stream_period")
        self._bytes = bytearray(bench.chip.peek(self._period + i) for i in range(3))
        bench.chip.watch_writes(*sorted((self._taken, self._period)))
        bench.chip.log_pins(*X_PINS)

    def steps(self) -> list[PlannedStep]:
        """Return every step of X so far, but for the windings' being switched on before it."""
        times = [cycle for cycle, _ in self._bench.chip.pin_changes()]
        writes = self._bench.chip.ram_writes()
        assert len(writes) < LOG_ROOM
        period, at, found = 0, 0, []
        for cycle, following in pairwise(times[1:]):
            while at < len(writes) and writes[at].cycle < following:
                address, value = writes[at].address, writes[at].value
                if address == self._taken:
                    period = int.from_bytes(self._bytes, "little")
                elif 0 <= address - self._period < 3:
                    self._bytes[address - self._period] = value
                at += 1
            found.append(PlannedStep(cycle, following - cycle, period))
        return found
