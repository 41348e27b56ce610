#!/usr/bin/python3
# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Runs the spice benches and the motor calculation; fails when one does not hold.

    run.py [--plots FOLDER] [--update]

--plots also draws the pictures and the table of figures for the build guide;
--update writes motor_limits.json anew. Prints one line for each bench.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import motor_limits
from bench import Result, simulate

RATES = (100, 200, 400, 800, 1000, 1500, 2000)
Rows = list[tuple[str, float, Result]]

# What drives the winding: name, and the parameters that differ.
DRIVERS: dict[str, dict[str, float]] = {
    "MOSFET, 18 V clamp, 12 V and ballast": {},
    "MOSFET, 18 V clamp, 5 V": {"vm": 5, "ballast": 0.001},
    "MOSFET, plain diode, 5 V": {"vm": 5, "ballast": 0.001, "vz": 0.01},
    "TIP120, plain diode, 5 V": {"vm": 5, "ballast": 0.001, "vz": 0.01, "stage": 0},
}
# Loosely coupled halves: what the clamp must take when little flux is shared.
LOOSE = {"k": 0.3}
CLAMPS = (0.01, 5.0, 10.0, 18.0, 24.0, 33.0)


def winding(rate: float, **changed: float) -> Result:
    """Run the winding bench; add how long currents take to go and to come.

    decay: from switching off until the winding's own current is at a tenth.
    reversal: from switching the other half off until the current that
    magnetises the core has reached half its final value. Each is missing when
    it does not happen while the winding is off, or on.
    """
    result, rows = simulate("winding", {"rate": rate, **changed}, waves=("i(L1)", "i(L2)"))
    values = {"vm": 12.0, "r": 5.0, "ballast": 3.3, **changed}
    final = values["vm"] / (values["r"] + values["ballast"])
    off, on = 18 / rate, 20 / rate
    before = [row[1] for row in rows if off - 0.1 / rate < row[0] < off]
    gone = [row[0] for row in rows if row[0] > off and row[1] < 0.1 * max(before)]
    come = [row[0] for row in rows if on < row[0] < on + 2 / rate and row[1] + row[2] > 0.5 * final]
    extra = {}
    if gone:
        extra["decay"] = gone[0] - off
    if come:
        extra["reversal"] = come[0] - on
    return Result({**result.values, **extra}, result.complaint)


def winding_sweep() -> Rows:
    """Run every driver at every rate."""
    return [
        (name, float(rate), winding(rate, **changed))
        for name, changed in DRIVERS.items()
        for rate in RATES
    ]


def clamp_sweep() -> list[tuple[float, Result]]:
    """Run the fitted driver with other clamps, halves loosely coupled, 800 steps/s."""
    return [(volts, winding(800, vz=volts, limit=200, **LOOSE)) for volts in CLAMPS]


def without_diode() -> Result:
    """Run the thesis' circuit: TIP120 and no free-wheel diode; it must fail."""
    return simulate(
        "winding", {"vm": 5, "ballast": 0.001, "vz": 0.01, "stage": 0, "diode": 0, **LOOSE}
    )[0]


def input_pulses() -> list[tuple[float, Result]]:
    """Run the input filters with pulses of 1 to 10 us."""
    return [(us, simulate("inputs", {"width": us * 1e-6})[0]) for us in (1.0, 2.0, 5.0, 10.0)]


OPTOS: dict[str, dict[str, float]] = {
    "typical": {},
    "lowest gain, CTR 50 %": {"ctr": 0.5},
    "slowest: 18 us at 100 ohm": {"tf": 40e-9, "cbc": 20e-12, "trmax": 22, "tfmax": 22},
    "highest gain, CTR 600 %": {"ctr": 6},
}


def opto_cases() -> list[tuple[str, Result]]:
    """Run the coupler's bench over the spread of the data sheet."""
    return [(name, simulate("opto", changed)[0]) for name, changed in OPTOS.items()]


def power_cases() -> list[tuple[str, Result]]:
    """Run the supply bench at both ends of the supply range."""
    return [(f"{volts:g} V", simulate("power", {"vsup": volts})[0]) for volts in (5.0, 12.0)]


def complaints(rows: Rows) -> list[str]:
    """Return what the winding sweep says against the chosen driver."""
    names = list(DRIVERS)[:: len(DRIVERS) - 1]
    found = [
        f"{name} at {rate:g} steps/s: {result.complaint}"
        for name, rate, result in rows
        if result.complaint
    ]
    for rate in RATES:
        at = {name: result.values for name, r, result in rows if r == rate}
        chosen, thesis = (at[name] for name in names)
        if chosen["ptransistor"] > 0.5:
            found.append(f"the MOSFET loses more than 0.5 W at {rate} steps/s")
        if chosen["irms"] < thesis["irms"]:
            found.append(f"less current than the thesis' driver at {rate} steps/s")
    return found


def main(arguments: list[str]) -> int:
    """Run everything; return the exit status."""
    parser = argparse.ArgumentParser(description="Run the spice benches.")
    parser.add_argument("--plots", type=Path)
    parser.add_argument("--update", action="store_true")
    wanted = parser.parse_args(arguments)
    rows, clamps, bare = winding_sweep(), clamp_sweep(), without_diode()
    pulses, optos, power = input_pulses(), opto_cases(), power_cases()
    limits = motor_limits.text()
    if wanted.update:
        motor_limits.committed().write_text(limits, encoding="utf-8")
    kept = motor_limits.committed()
    benches = {
        "winding": complaints(rows),
        "clamp": [
            f"{volts:g} V: {result.complaint}" for volts, result in clamps if result.complaint
        ],
        "no diode": [] if bare.complaint else ["the bench did not see the missing diode"],
        "inputs": [f"{us:g} us: {result.complaint}" for us, result in pulses if result.complaint],
        "opto": [f"{name}: {result.complaint}" for name, result in optos if result.complaint],
        "power": [f"{name}: {result.complaint}" for name, result in power if result.complaint],
        "motor limits": []
        if kept.is_file() and kept.read_text(encoding="utf-8") == limits
        else ["motor_limits.json is not what the calculation gives: run.py --update"],
    }
    for name, found in benches.items():
        print(f"{name}: {'; '.join(found) or 'ok'}")
    if wanted.plots:
        import plots

        plots.write(wanted.plots, rows, clamps, bare, pulses, optos, power)
    return 1 if any(benches.values()) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
