# SPDX-License-Identifier: Apache-2.0
"""The rows on motion in docs/benchmarks.md."""

from typing import Any

from motion_page import cycle_rows, motion_rows

FOUND: dict[str, Any] = {
    "accuracy_points": 588_496,
    "line_error_max_steps": 0.49987,
    "arc_error_max_steps": 0.503,
    "arc_error_rms_steps": 0.2611,
    "feed_error_max_pct": 0.69,
    "feed_error_max_pct_fast": {"R from 20": 0.7, "R 5 to 20": 3.1},
    "feed_error_max_pct_tiny": 2.5,
    "line_max_rate_hz": 52_402,
    "arc_max_rate_hz": 46_319,
    "arc_max_path_rate": 51_387,
    "jitter_max_us": 1 / 12,
    "jitter_max_us_panel": 1 / 12,
    "hold_latency_steps_by_rate": {"500": 1, "5000": 2},
    "hold_trials": 1_000,
    "hold_steps_lost": 0,
    "lookahead_time_ratio": 1.0064,
    "plateau_takeup_path_error_steps": 0.4937,
    "plateau_takeup_dwell_ms": 0.0,
    "roughing_s_by_start_rate": {"400": 37.2, "97": 39.1},
    "roughing_peer_s": 39.46,
    "motion_cycles": {
        "step_interrupt": {"calls": 10, "mean": 131.6, "worst": 145},
        "interpolate_arc": {"calls": 2, "mean": 900.0, "worst": 1_670, "per_entry": 44.8},
    },
}


def test_both_times_of_the_peers_program_stand_beside_its_own() -> None:
    rows = {what: (ours, peer) for what, ours, peer in motion_rows(FOUND)}
    what = "the peer's roughing program, start/stop at 400, 97 steps/s"
    assert rows[what] == ("37.20 s, 39.10 s", "39.46 s")


def test_the_steps_after_a_hold_are_told_for_every_rate() -> None:
    rows = {what: ours for what, ours, _ in motion_rows(FOUND)}
    told = rows["steps at full speed after a hold is noticed"]
    assert told == "1 at 500 steps/s, 2 at 5,000 steps/s"


def test_a_worst_distance_says_from_how_many_points() -> None:
    assert (
        "distance from a line, worst of 588,496 points",
        "0.500 steps",
        "0.97 steps",
    ) in motion_rows(FOUND)


def test_cycles_are_per_entry_where_entries_are_made() -> None:
    assert cycle_rows(FOUND["motion_cycles"]) == [
        ("cycles: step interrupt, per entry", "132 mean, 145 longest run", ""),
        ("cycles: entries of an arc", "45 mean, 1,670 longest run", ""),
    ]
