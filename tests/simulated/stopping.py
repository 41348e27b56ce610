# SPDX-License-Identifier: Apache-2.0
"""How soon the motors stop: from an input's edge, and from its filtered edge."""

from __future__ import annotations

from dataclasses import dataclass

from tornillo.protocol import Alarm, Axis
from virtual_lathe.machine import AxisName

from simulated.bench import Bench
from simulated.standing import COILS

#: What stops them, and the alarm it raises far from the switches.
INPUTS = {
    "estop": Alarm.ESTOP,
    "limit x": Alarm.LIMIT,
    "limit z": Alarm.SWITCH_WIRING,
}
#: Bits of inputs_state, firmware/panel/inputs.h.
MASKS = {"limit x": 0x01, "limit z": 0x02, "estop": 0x04}


@dataclass(frozen=True)
class Stopped:
    """From the filtered edge, and from the edge at the pin, to the last change of a coil."""

    latency_cycles: int
    total_cycles: int
    alarm: Alarm


def moving_lathe() -> Bench:
    """Return a lathe on a long way at 1000 step/s, Z more than 400 steps from its switch."""
    bench = Bench(stock_diameter_mm=0.1)
    bench.expect_broken("no step lost", "coil pattern legal")
    bench.set(homing_repeats=1)
    bench.home()
    bench.host.goto(z=-3000)
    bench.wait(lambda: bench.axis(Axis.Z).slide < -450, 2.0)
    return bench


def stop(bench: Bench, name: str) -> Stopped:
    """Close one of the inputs and measure."""
    filtered = bench.chip.symbols.ram("inputs_state")
    bench.chip.watch_writes(filtered, filtered)
    bench.chip.log_pins(*COILS)
    edge = bench.chip.cycle
    if name == "estop":
        bench.lathe.press("estop")
    else:
        bench.lathe.machine.break_switch_wire(AxisName.X if name == "limit x" else AxisName.Z)
    bench.run(0.02)
    seen = next(w.cycle for w in bench.chip.ram_writes() if w.value & MASKS[name])
    last = max(cycle for cycle, _ in bench.chip.pin_changes())
    return Stopped(max(0, last - seen), last - edge, bench.alarm[0])
