# SPDX-License-Identifier: Apache-2.0
"""How well homing measures: spread on bad switches, dead steps against the truth."""

from __future__ import annotations

from tornillo.protocol import Alarm, Axis, ErrorCode, State

from simulated.bench import Bench

HOMINGS = 10
BOUNCE_US, PULSES_HZ = 5000, 10_000
DEAD_X, DEAD_Z = 23, 31
PARK = -20
#: Dead steps of the screw and travel of the switch, steps.
PAIRS = (
    (0, 0), (1, 14), (7, 60), (23, 30), (50, 0), (75, 45),
    (100, 14), (120, 60), (150, 5), (175, 30), (199, 1), (200, 60),
)  # fmt: skip


def spread(homings: int = HOMINGS, seed: int = 1) -> int:
    """Return the largest spread of some homings on switches that bounce, on wires with pulses.

    It counts what the chip reports, and how much zero and dead steps differ from the truth.
    """
    bench = Bench(
        backlash_x=DEAD_X, backlash_z=DEAD_Z, bounce_us=BOUNCE_US, noise_hz=PULSES_HZ, seed=seed
    )
    worst = 0
    for _ in range(homings):
        bench.home()
        status = bench.status()
        slides = (bench.axis(axis).slide - PARK for axis in Axis)
        found = (status.spread_x, status.spread_z, status.dead_x - DEAD_X, status.dead_z - DEAD_Z)
        worst = max(worst, *(int(abs(value)) for value in (*found, *slides)))
    return worst


def dead_step_errors(pairs: tuple[tuple[int, int], ...]) -> list[int]:
    """Return measured less true dead steps, X with each pair and Z with it from the other end.

    The setting of the switch travel is right, as after a calibration.
    """
    bench = Bench()
    bench.expect_broken("at most one full step at a time", "no step lost")
    bench.set(drift_max=50)  # screws are exchanged between two homings
    errors = []
    for (dead_x, travel_x), (dead_z, travel_z) in zip(pairs, reversed(pairs), strict=True):
        truth = {Axis.X: (dead_x, travel_x), Axis.Z: (dead_z, travel_z)}
        bench.power_cycle()
        for axis, (dead, travel) in truth.items():
            bench.exchange_screw(axis, dead, travel)
        bench.set(switch_travel_x=travel_x, switch_travel_z=travel_z)
        bench.home()
        status = bench.status()
        errors += [status.dead_x - dead_x, status.dead_z - dead_z]
    return errors


def assert_alarm_and_recovery(bench: Bench, alarm: Alarm, axis: Axis) -> None:
    """Wait for the alarm; nothing goes on without RESET, and homing works after it."""
    bench.wait_for(State.ALARM)
    assert bench.alarm == (alarm, axis)
    assert not bench.status().homed
    bench.run(0.1)
    assert not bench.moving
    assert bench.refusal(bench.host.home) is ErrorCode.ALARM
    assert bench.refusal(bench.host.run) is ErrorCode.ALARM
    bench.host.reset()
    assert bench.state is State.IDLE
    assert bench.refusal(bench.host.run) is ErrorCode.NOT_HOMED
