# SPDX-License-Identifier: Apache-2.0
"""Whether a demo is good, and why not."""

from typing import Any, NamedTuple

MM_PER_INCH = 25.4
TOLERANCE_STEPS = 1


class DeadSteps(NamedTuple):
    """Dead steps of both axes."""

    x: int
    z: int


def faults(
    report: dict[str, Any], measured: DeadSteps, screws: DeadSteps, pins_differ: int
) -> list[str]:
    """Everything that is not as it must be, one sentence each.

    `report` is that of the virtual lathe, `measured` what homing found, `screws` what the
    virtual screws have, `pins_differ` at how many steps of Z the profile decoded from the motor
    pins differs from the report.
    """
    found = [
        f"{entry['name']} is {entry['cut_mm']:.4f} mm, not {entry['wanted_mm']:.4f}: off by "
        f"{entry['error_steps']:+g} steps"
        for entry in report["dimensions"]
        if abs(entry["error_steps"]) > TOLERANCE_STEPS
    ]
    if not report["dimensions"]:
        found.append("the report has no dimensions")
    if report["lost_steps"] != 0:
        found.append(f"the motors lost {report['lost_steps']} steps")
    if report["gouge_max_steps"] != 0:
        found.append(f"the tool went {report['gouge_max_steps']} steps into the finished part")
    found += [f"crash: {crash}" for crash in report["crashes"]]
    found += [
        f"dead steps of {axis}: the screw has {has}, homing measured {got}"
        for axis, has, got in zip("XZ", screws, measured, strict=True)
        if has != got
    ]
    if pins_differ:
        found.append(f"the motor pins tell another profile at {pins_differ} steps of Z")
    return found


def table(report: dict[str, Any]) -> list[tuple[str, ...]]:
    """Name, wanted and cut in mm, wanted and cut in inch, error in steps; texts for printing."""
    return [
        (
            entry["name"],
            f"{entry['wanted_mm']:.4f}",
            f"{entry['cut_mm']:.4f}",
            f"{entry['wanted_mm'] / MM_PER_INCH:.5f}",
            f"{entry['cut_mm'] / MM_PER_INCH:.5f}",
            f"{entry['error_steps']:+g}",
        )
        for entry in report["dimensions"]
    ]
