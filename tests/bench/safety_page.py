# SPDX-License-Identifier: Apache-2.0
"""The rows of docs/benchmarks.md about homing, cuts of power and wear."""

from measure import Figures


def safety_rows(found: Figures) -> list[tuple[str, str, str]]:
    """What was measured, ours; the peer stores and measures nothing of the kind."""
    return [
        (
            "10 homings, switches bounce 5 ms, 10,000 pulses a second of 1 to 10 us: spread",
            f"{found['homing_spread_steps']} steps",
            "",
        ),
        (
            "dead steps 0 to 200 behind switches with 0 to 60 steps of travel: largest error",
            f"{found['dead_step_error_max']} steps",
            "",
        ),
        (
            f"power cut at each of {found['power_cut_points']} points of saving settings and "
            "parts: neither old nor new",
            str(found["power_cut_failures"]),
            "",
        ),
        (
            "EEPROM: bytes written by reference-inch; years at 20 a day, 100,000 writes a byte",
            f"{found['eeprom_writes_per_part']}; {found['eeprom_years']}",
            "",
        ),
    ]
