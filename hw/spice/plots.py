# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Draws the benches' pictures and writes their figures as a table for the guide."""

from __future__ import annotations

import importlib
import json
from pathlib import Path
from typing import Any

import motor_limits
from bench import Result, simulate

matplotlib: Any = importlib.import_module("matplotlib")
matplotlib.use("svg")
matplotlib.rcParams.update(
    {
        "svg.hashsalt": "tornillo",
        "font.size": 9,
        "axes.grid": True,
        "grid.alpha": 0.4,
        "savefig.bbox": "tight",
    }
)
pyplot: Any = importlib.import_module("matplotlib.pyplot")

SWITCHED: dict[str, dict[str, float]] = {
    "MOSFET, 18 V clamp, 12 V and ballast": {},
    "MOSFET, plain diode, 5 V": {"vm": 5.0, "ballast": 0.001, "vz": 0.01},
    "TIP120, plain diode, 5 V": {"vm": 5.0, "ballast": 0.001, "vz": 0.01, "stage": 0.0},
}

COUPLERS: dict[str, dict[str, float]] = {
    "typical": {},
    "slowest": {"tf": 40e-9, "cbc": 20e-12, "trmax": 22.0, "tfmax": 22.0},
}


def save(figure: Any, target: Path) -> None:
    """Write a picture without a date, so that equal figures give equal files."""
    figure.savefig(target, metadata={"Date": None})
    pyplot.close(figure)


def _column(rows: list[list[float]], index: int, scale: float = 1.0) -> list[float]:
    return [row[index] * scale for row in rows]


def winding_waves(folder: Path) -> None:
    """Draw current and drain voltage of one winding at 800 steps/s."""
    figure, (upper, lower) = pyplot.subplots(2, 1, figsize=(7, 5), sharex=True)
    for name, changed in SWITCHED.items():
        _, rows = simulate(
            "winding", {"rate": 800.0, **changed}, waves=("v(d1)", "i(L1)", "i(L2)"), start=0.02
        )
        times = [(row[0] - 0.02) * 1e3 for row in rows]
        upper.plot(times, [row[2] + row[3] for row in rows], label=name)
        lower.plot(times, _column(rows, 1), label=name)
    upper.set_ylabel("current that magnetises, A")
    lower.set_ylabel("drain or collector, V")
    lower.set_xlabel("time, ms (800 steps/s)")
    lower.set_xlim(0, 10)
    upper.legend(fontsize=8)
    save(figure, folder / "winding-waves.svg")


def winding_sweep(folder: Path, rows: list[tuple[str, float, Result]]) -> None:
    """Draw effective current and losses against the step rate."""
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.6))
    for name in dict.fromkeys(name for name, _, _ in rows):
        rates = [rate for n, rate, _ in rows if n == name]
        left.plot(
            rates, [r.values["irms"] for n, _, r in rows if n == name], marker="o", label=name
        )
        right.plot(
            rates,
            [r.values["ptransistor"] * 1e3 for n, _, r in rows if n == name],
            marker="o",
            label=name,
        )
    left.set_ylabel("effective phase current, A")
    right.set_ylabel("loss in one transistor, mW")
    right.set_yscale("log")
    for axis in (left, right):
        axis.set_xlabel("steps/s")
    left.legend(fontsize=7)
    save(figure, folder / "winding-sweep.svg")


def clamp_choice(folder: Path, clamps: list[tuple[float, Result]]) -> None:
    """Draw what the clamp voltage changes, halves loosely coupled."""
    figure, left = pyplot.subplots(figsize=(6, 3.4))
    volts = [volt for volt, _ in clamps]
    left.plot(volts, [r.values["decay"] * 1e6 for _, r in clamps], "o-", color="tab:blue")
    left.set_xlabel("clamp, V above the supply")
    left.set_ylabel("decay of the winding's current to 10 %, us", color="tab:blue")
    right = left.twinx()
    right.grid(False)
    right.plot(volts, [r.values["vpeak"] for _, r in clamps], "s-", color="tab:red")
    right.axhline(55, color="tab:red", linestyle=":")
    right.set_ylabel("peak at the drain, V (dotted: limit 55 V)", color="tab:red")
    save(figure, folder / "clamp.svg")


def opto_waves(folder: Path) -> None:
    """Draw the coupler's switching in the board's circuit."""
    figure, axis = pyplot.subplots(figsize=(7, 3.2))
    for name, changed in COUPLERS.items():
        _, rows = simulate("opto", changed, waves=("v(off)",))
        axis.plot(_column(rows, 0, 1e6), _column(rows, 1), label=name)
    axis.axvspan(20, 1020, color="0.92", label="pin high")
    axis.axhline(3.5, color="k", linestyle=":")
    axis.axhline(1.0, color="k", linestyle=":")
    axis.set_xlim(0, 1100)
    axis.set_xlabel("time, us")
    axis.set_ylabel("input of the Schmitt gate, V")
    axis.legend(fontsize=8)
    save(figure, folder / "opto.svg")


def input_waves(folder: Path) -> None:
    """Draw the limit filter: a 10 us pulse and a real press."""
    figure, axis = pyplot.subplots(figsize=(7, 3.2))
    _, rows = simulate("inputs", waves=("v(na)", "v(nb)", "v(nc)"))
    for index, name in (
        (1, "closed contact, opens for 10 us"),
        (2, "open contact, spike of 10 us"),
        (3, "switch pressed for good"),
    ):
        axis.plot([row[0] * 1e3 - 1 for row in rows], _column(rows, index), label=name)
    axis.axhspan(1.9, 3.5, color="0.92", label="thresholds of the 74HC14")
    axis.set_xlim(-0.2, 1.5)
    axis.set_xlabel("time, ms")
    axis.set_ylabel("input of the Schmitt gate, V")
    axis.legend(fontsize=8)
    save(figure, folder / "inputs.svg")


def power_waves(folder: Path) -> None:
    """Draw the change of supply and the emergency stop."""
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.4))
    _, rows = simulate("power", waves=("v(vdd)", "v(iso)", "v(ovdd)", "v(mclr)"))
    times = _column(rows, 0, 1e3)
    for index, name in (
        (1, "+5V, USB takes over"),
        (2, "V5ISO"),
        (3, "+5V, nothing left"),
        (4, "MCLR"),
    ):
        left.plot(times, _column(rows, index), label=name)
    left.axhline(4.33, color="k", linestyle=":")
    left.set_xlim(0, 12)
    left.set_xlabel("time, ms (supply lost at 5 ms)")
    left.set_ylabel("V")
    left.legend(fontsize=7)
    _, rows = simulate("power", waves=("v(vmot)", "v(sense)", "v(vmot2)", "v(sense2)"))
    for index, name in (
        (1, "VMOT, windings off"),
        (2, "sense, windings off"),
        (3, "VMOT, a winding on"),
        (4, "sense, a winding on"),
    ):
        right.plot(_column(rows, 0, 1e3), _column(rows, index), label=name)
    right.set_xscale("log")
    right.set_xlim(1, 1500)
    right.set_xlabel("time, ms (stop pressed at 5 ms)")
    right.legend(fontsize=7)
    save(figure, folder / "power.svg")


def figures(
    rows: list[tuple[str, float, Result]],
    clamps: list[tuple[float, Result]],
    bare: Result,
    pulses: list[tuple[float, Result]],
    optos: list[tuple[str, Result]],
    power: list[tuple[str, Result]],
) -> str:
    """Return the figures of all benches as Markdown tables."""
    out = [
        "# Spice figures",
        "",
        "Written by `make hw-plots` from the benches in `hw/spice/`; "
        "[spice.md](spice.md) explains them.",
        "",
        "## Winding driver",
        "",
        "| driver | steps/s | peak at drain V | peak current A | effective phase current A | "
        "own winding to 10 % us | reversal to 50 % us | transistor mW | clamp mW |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for name, rate, result in rows:
        v = result.values
        out.append(
            f"| {name} | {rate:g} | {v['vpeak']:.1f} | {v['ipeak']:.2f} | "
            f"{v['irms']:.2f} | {_time(v.get('decay'))} | "
            f"{_time(v.get('reversal'))} | "
            f"{v['ptransistor'] * 1e3:.0f} | {v['pclamp'] * 1e3:.0f} |"
        )
    out += [
        "",
        "## Clamp, halves loosely coupled (k = 0.3), 12 V and ballast, 800 steps/s",
        "",
        "| clamp V | peak at drain V | decay to 10 % us | clamp mW |",
        "|---|---|---|---|",
    ]
    out += [
        f"| {volts:g} | {r.values['vpeak']:.1f} | {r.values['decay'] * 1e6:.0f} | "
        f"{r.values['pclamp'] * 1e3:.0f} |"
        for volts, r in clamps
    ]
    out += [
        "",
        f"Without any diode (the thesis' circuit): {bare.values['vpeak']:.0f} V at a part "
        "rated 60 V.",
        "",
        "## Opto-coupler",
        "",
        "| case | rise at 100 ohm us | fall us | on us | off us | difference us |",
        "|---|---|---|---|---|---|",
    ]
    out += [
        f"| {name} | "
        + " | ".join(
            f"{r.values[key] * 1e6:.1f}" for key in ("trise", "tfall", "ton", "toff", "skew")
        )
        + " |"
        for name, r in optos
    ]
    out += [
        "",
        "## Input filters",
        "",
        "| pulse us | closed limit contact rises to V | "
        "open one falls to V | index falls to V | index rises to V |",
        "|---|---|---|---|---|",
    ]
    out += [
        f"| {us:g} | "
        + " | ".join(f"{r.values[key]:.2f}" for key in ("opening", "closing", "noindex", "inindex"))
        + " |"
        for us, r in pulses
    ]
    last = pulses[-1][1].values
    out += [
        "",
        f"A real press is seen after {last['pressed'] * 1e6:.0f} us, a tool contact after "
        f"{last['contact'] * 1e6:.0f} us. Mains of 230 V between tool and frame drives "
        f"{last['imax'] * 1e3:.1f} mA at its peak, {last['pseries']:.2f} W in each of R57 and "
        "R58.",
        "",
        "## Supply, reset, emergency stop",
        "",
        "| supply | +5V from converter | lowest while USB takes over | lost at 5 A in Q4 | "
        "stop seen, windings off | stop seen, one on | hold-up without supply |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, result in power:
        v = result.values
        out.append(
            f"| {name} | {v['vddext']:.2f} V | {v['vddusb']:.2f} V | "
            f"{abs(v['vq4']) * 1e3:.0f} mV | {v['tstop'] * 1e3:.0f} ms | "
            f"{v['tstopon'] * 1e3:.1f} ms | {v['holdup'] * 1e6:.0f} us |"
        )
    out += [
        "",
        "## Motor limits",
        "",
        "| driver and load | pull-in steps/s | pull-out steps/s |",
        "|---|---|---|",
    ]
    limits = json.loads(motor_limits.committed().read_text(encoding="utf-8"))
    out += [
        f"| {name} | {speed['pull_in']} | {speed['pull_out']} |"
        for name, speed in limits["by_driver"].items()
    ]
    return "\n".join(out) + "\n"


def _time(seconds: float | None) -> str:
    return "not reached" if seconds is None else f"{seconds * 1e6:.0f}"


def write(
    folder: Path,
    rows: list[tuple[str, float, Result]],
    clamps: list[tuple[float, Result]],
    bare: Result,
    pulses: list[tuple[float, Result]],
    optos: list[tuple[str, Result]],
    power: list[tuple[str, Result]],
) -> None:
    """Write all pictures and figures.md into a folder."""
    winding_waves(folder)
    winding_sweep(folder, rows)
    clamp_choice(folder, clamps)
    opto_waves(folder)
    input_waves(folder)
    power_waves(folder)
    (folder / "figures.md").write_text(
        figures(rows, clamps, bare, pulses, optos, power), encoding="utf-8"
    )
