# SPDX-License-Identifier: Apache-2.0
"""What the machine knows for sure: homing on bad switches, dead steps, cuts of power, wear."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from measure import BenchError, Figures
from simulated import homings, little_pin, power_cuts
from simulated.bench import Bench
from simulated.power_cuts import Action
from simulated.processes import branch
from tornillo import Part
from tornillo.machine import Machine
from tornillo.protocol import State

PART = Path(__file__).resolve().parents[2] / "host-cli" / "examples" / "reference-inch.toml"
TIMEOUT_S = 1500.0
BRANCH_S = 900.0
#: Least endurance of a byte of the EEPROM by the data sheet (D120), and a diligent owner.
WRITES_OF_A_BYTE = 100_000
PARTS_A_YEAR = 20 * 250
#: Records in the ring of progress, and bytes of one; the last is its sequence number.
PLACES, RECORD = 9, 7


def safety_figures() -> Figures:
    """Each on a lathe of its own."""
    errors = branch(partial(homings.dead_step_errors, homings.PAIRS), BRANCH_S)
    return {
        "homing_spread_steps": branch(homings.spread, BRANCH_S),
        "dead_step_error_max": max(abs(error) for error in errors),
        **cut_power(),
        **branch(wear, BRANCH_S),
    }


def cut_power() -> Figures:
    """Cut it at every instruction that writes: settings and parts, on a used and a new chip."""
    cases = (
        (partial(settings_lathe, used=True), power_cuts.save_settings, power_cuts.settings),
        (partial(settings_lathe, used=False), power_cuts.save_settings, power_cuts.settings),
        (little_pin.lathe_with_pin, power_cuts.commit_part, power_cuts.parts),
        (partial(settings_lathe, used=True), power_cuts.commit_part, power_cuts.parts),
    )
    counts = [branch(partial(_count, *case), BRANCH_S) for case in cases]
    return {
        "power_cut_points": sum(points for points, _ in counts),
        "power_cut_failures": sum(failed for _, failed in counts),
    }


def settings_lathe(used: bool) -> Bench:
    """A lathe set up for the little pin, or fresh from the box."""
    bench = Bench(**little_pin.OPTIONS)
    if used:
        bench.set(zero_x=little_pin.ZERO_X, zero_z=little_pin.ZERO_Z)
    return bench


def _count(
    lathe: Callable[[], Bench],
    action: Action,
    look: Callable[[Bench], object],
) -> tuple[int, int]:
    before, left, after = power_cuts.every_cut(lathe(), action, look)
    return len(left), power_cuts.failures(before, left, after)


def wear() -> Figures:
    """Bytes of EEPROM that the reference part writes on a new chip, and the years they last."""
    bench = Bench(part=PART, backlash_x=23, backlash_z=31)
    bench.home()
    slot = bench.host.upload(Part.load(PART).image(Machine.load()))
    sequence = bench.chip.symbols.ram("progress_record") + RECORD - 1
    writes, records = bench.chip.nonvolatile_counts["eeprom_writes"], bench.chip.peek(sequence)
    bench.host.run(slot)
    bench.wait(lambda: bench.state is not State.RUNNING, TIMEOUT_S, every=0.05)
    if not bench.status().finished:
        raise BenchError(f"{PART.name}: {bench.state.name}, alarm {bench.alarm}")
    writes = bench.chip.nonvolatile_counts["eeprom_writes"] - writes
    records = (bench.chip.peek(sequence) - records) % 256
    # A record writes each of its bytes at most once, and a place is used once in a round.
    return {
        "eeprom_writes_per_part": writes,
        "eeprom_years": round(WRITES_OF_A_BYTE * PLACES / records / PARTS_A_YEAR, 1),
    }
