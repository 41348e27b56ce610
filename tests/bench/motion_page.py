# SPDX-License-Identifier: Apache-2.0
"""Rows on motion for the table of docs/benchmarks.md."""

from __future__ import annotations

from typing import Any

Row = tuple[str, str, str]
PARTS = {
    "step_interrupt": "step interrupt, per entry",
    "interpolate_line": "entries of a line",
    "interpolate_arc": "entries of an arc",
    "arc_begin": "begin of an arc",
    "arc_next": "begin of an octant",
    "plan_next": "plan of a segment",
    "ramp_tick": "ramp, each new speed",
}


def motion_rows(found: dict[str, Any]) -> list[Row]:
    """What was measured, ours, and the peer's figure where there is one."""
    fast = found["feed_error_max_pct_fast"]
    starts = found["roughing_s_by_start_rate"]
    return [
        (
            f"distance from a line, worst of {found['accuracy_points']:,} points",
            f"{found['line_error_max_steps']:.3f} steps",
            "0.97 steps",
        ),
        (
            "distance from an arc, R 5 to 60,000, worst",
            f"{found['arc_error_max_steps']:.3f} steps",
            "1.0 to 3.1 steps",
        ),
        ("distance from an arc, rms", f"{found['arc_error_rms_steps']:.3f} steps", ""),
        (
            "feed over 16 steps, worst: lines; arcs from R 8 to 3,000 steps/s, from R 20 to 12,000",
            f"{found['feed_error_max_pct']:.2f} %",
            "",
        ),
        (
            "the same on smaller arcs: R 5 to 8 to 3,000 steps/s, R 5 to 20 at 12,000",
            f"{found['feed_error_max_pct_tiny']:.2f} %, {fast['R 5 to 20']:.2f} %",
            "",
        ),
        (
            "highest rate on a two-axis line, status 20 times a second, steps/s of the faster axis",
            f"{found['line_max_rate_hz']:,}",
            "36,000 (status 5 times a second)",
        ),
        (
            "highest rate on an arc, R 700, status 20 times a second: steps/s, path steps/s",
            f"{found['arc_max_rate_hz']:,}, {found['arc_max_path_rate']:,}",
            "29,000 to 40,000",
        ),
        (
            "step times at 5,000 steps/s, both axes, status 100 times a second: "
            "largest difference from planned",
            f"{found['jitter_max_us']:.2f} us",
            "7 to 11 us peak to peak",
        ),
        (
            "the same with the panel in use, a key pressed every 0.12 s",
            f"{found['jitter_max_us_panel']:.2f} us",
            "",
        ),
        (
            "steps at full speed after a hold is noticed",
            ", ".join(
                f"{count} at {int(rate):,} steps/s"
                for rate, count in found["hold_latency_steps_by_rate"].items()
            ),
            "79 to 99 ms late",
        ),
        (
            f"steps lost in {found['hold_trials']:,} holds at random moments",
            f"{found['hold_steps_lost']}",
            "none",
        ),
        (
            "profile of 60 tangent segments, time over the least possible",
            f"{found['lookahead_time_ratio']:.4f}",
            "",
        ),
        (
            "ball of R 300 with 23 dead steps: distance from the path, time at a stand",
            f"{found['plateau_takeup_path_error_steps']:.3f} steps, "
            f"{found['plateau_takeup_dwell_ms']:.1f} ms",
            "no backlash handling",
        ),
        (
            "the peer's roughing program, start/stop at "
            + ", ".join(f"{start}" for start in starts)
            + " steps/s",
            ", ".join(f"{seconds:.2f} s" for seconds in starts.values()),
            f"{found['roughing_peer_s']:.2f} s",
        ),
        *cycle_rows(found["motion_cycles"]),
    ]


def cycle_rows(parts: dict[str, dict[str, float]]) -> list[Row]:
    """Cycles of each part of the pipeline: per entry where it makes entries, else per call."""
    rows: list[Row] = []
    for name, what in PARTS.items():
        if name not in parts:
            continue
        part = parts[name]
        mean = part.get("per_entry", part["mean"])
        rows.append((f"cycles: {what}", f"{mean:,.0f} mean, {part['worst']:,.0f} longest run", ""))
    return rows
