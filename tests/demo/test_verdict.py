# SPDX-License-Identifier: Apache-2.0
"""The demo must not call a bad part good."""

from typing import Any

import pytest
from verdict import DeadSteps, faults, table

SCREWS = DeadSteps(23, 31)


def good_report() -> dict[str, Any]:
    """What the virtual lathe reports of a good part."""
    return {
        "lost_steps": 0,
        "crashes": [],
        "gouge_max_steps": 0,
        "dimensions": [
            {"name": "diameter", "wanted_mm": 15.24, "cut_mm": 15.2339, "error_steps": -1}
        ],
    }


def test_a_part_within_one_step_is_good() -> None:
    assert faults(good_report(), SCREWS, SCREWS, 0) == []


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"lost_steps": 2}, "the motors lost 2 steps"),
        ({"gouge_max_steps": 1}, "the tool went 1 steps into the finished part"),
        ({"crashes": [{"kind": "chuck"}]}, "crash: {'kind': 'chuck'}"),
        ({"dimensions": []}, "the report has no dimensions"),
    ],
)
def test_a_bad_part_is_named_with_its_reason(change: dict[str, Any], reason: str) -> None:
    assert faults(good_report() | change, SCREWS, SCREWS, 0) == [reason]


@pytest.mark.parametrize("error", [2, -2])
def test_a_dimension_off_by_two_steps_is_refused(error: int) -> None:
    report = good_report()
    report["dimensions"][0]["error_steps"] = error
    assert faults(report, SCREWS, SCREWS, 0) == [
        f"diameter is 15.2339 mm, not 15.2400: off by {error:+d} steps"
    ]


def test_wrong_dead_steps_are_refused() -> None:
    assert faults(good_report(), DeadSteps(23, 30), SCREWS, 0) == [
        "dead steps of Z: the screw has 31, homing measured 30"
    ]


def test_motor_pins_that_tell_another_profile_are_refused() -> None:
    assert faults(good_report(), SCREWS, SCREWS, 3) == [
        "the motor pins tell another profile at 3 steps of Z"
    ]


def test_the_table_shows_millimetres_and_inches() -> None:
    assert table(good_report()) == [("diameter", "15.2400", "15.2339", "0.60000", "0.59976", "-1")]
