# SPDX-License-Identifier: Apache-2.0
"""The table of docs/benchmarks.md."""

from page import fill
from test_motion_page import FOUND as MOTION

FOUND = {
    "date": "2026-01-31",
    "computer": "Linux",
    "flash_bytes": 16_384,
    "ram_static_bytes": 900,
    "sw_stack_worst_bytes": 100,
    "hw_stack_worst_levels": 19,
    "cli_start_s": 0.123,
    "sim_realtime_factor": 2.5,
    "sim_realtime_factor_idle": 5.0,
    "upload_s": 0.02,
    "upload_30_ops_s": 0.512,
    "upload_30_ops_bytes": 296,
    "link_bytes_per_s": 56_789,
    "homing_s": 5.5,
    "test_bar_s": 63.2,
    "step_jitter_max_cycles": 3,
    "feed_error_ppm": -44.0,
    "stream_low_entries": 80,
    "isr_worst_cycles": 96,
    "low_isr_worst_cycles": 420,
    "estop_latency_us": 7.5,
    "estop_total_us": 4012,
    "estop_trials": 120,
    "homing_spread_steps": 0,
    "dead_step_error_max": 0,
    "power_cut_points": 300,
    "power_cut_failures": 0,
    "eeprom_writes_per_part": 120,
    "eeprom_years": 7.2,
    **MOTION,
    "shapes": {
        "pawn": {
            "seconds": 360.4,
            "estimate_s": 359.8,
            "least_s": 215.2,
            "mean_error_mm": 0.0021,
            "max_error_mm": 0.0061,
            "gouge_steps": 0.486,
            "left_steps": 0.402,
            "crashes": 0,
        }
    },
    "dimensions": [{"name": "diameter", "wanted_mm": 15.24, "cut_mm": 15.2339, "error_steps": -1}],
}


def test_the_table_is_replaced_and_the_text_around_it_stays() -> None:
    page = "# Title\n\n<!-- bench -->\nof yesterday\n<!-- end -->\n\nend\n"
    once = fill(page, FOUND)
    assert once.startswith("# Title\n\n<!-- bench -->\nMeasured on 2026-01-31; Linux.\n")
    assert once.endswith("\n<!-- end -->\n\nend\n")
    assert "of yesterday" not in once
    assert fill(once, FOUND) == once


def test_figures_stand_beside_those_of_the_peer_with_their_units() -> None:
    page = fill("<!-- bench -->\n<!-- end -->\n", FOUND)
    assert "| flash | 16,384 bytes (50 %) | 29,864 bytes (91 %) |" in page
    assert "| RAM, static and worst stack | 1,000 of 2,048 bytes |" in page
    assert "| step interrupt, worst | 96 cycles (8.0 us) |" in page
    assert (
        "power cut at each of 300 points of saving settings and parts: neither old nor new | 0"
        in page
    )
    assert "years at 20 a day, 100,000 writes a byte | 120; 7.2 |" in page
    assert "| test bar, error of the feed | -0.0044 % |" in page
    assert "| upload of 30 operations, 296 bytes, and reading them back | 0.51 s |" in page
    assert "| 37.20 s, 39.10 s | 39.46 s |" in page
    assert "| test bar, diameter | 15.234 mm, error -1 steps |  |" in page
    assert "filtered edge to the last step, worst of 120 | 7.5 us |" in page
    assert "| the same from the edge at the pin, filter included | 4.0 ms |" in page
    assert "| pawn: 360 s, planned 360 s, length of cut by feed 215 s |" in page
    assert "gouge 0.49 steps, left 0.40, crashes 0 | S1: 227 s, largest error 0.10 mm |" in page
