# SPDX-License-Identifier: Apache-2.0
"""The table of docs/benchmarks.md."""

import re

from measure import Figures
from motion_page import motion_rows
from safety_page import safety_rows
from shape_page import shape_rows
from stop_figures import stop_rows
from tornillo import __version__

MARKER = re.compile(r"(<!-- bench -->\n).*?(<!-- end -->)", re.DOTALL)
CYCLES_PER_US = 12
FLASH, RAM = 32_768, 2_048

Row = tuple[str, str, str]


def _cycles(cycles: int) -> str:
    """Cycles, and what they are in microseconds."""
    return f"{cycles} cycles ({cycles / CYCLES_PER_US:.1f} us)"


def rows(found: Figures) -> list[Row]:
    """What was measured, ours, and the peer's figure where there is one."""
    ram = found["ram_static_bytes"] + found["sw_stack_worst_bytes"]
    flash = found["flash_bytes"]
    jitter = found["step_jitter_max_cycles"]
    return [
        ("flash", f"{flash:,} bytes ({100 * flash / FLASH:.0f} %)", "29,864 bytes (91 %)"),
        (
            "RAM, static and worst stack",
            f"{ram:,} of {RAM:,} bytes",
            "1,948 of 2,048 bytes (peak seen)",
        ),
        ("hardware stack, worst path", f"{found['hw_stack_worst_levels']} of 31 levels", ""),
        (
            "step interrupt, worst",
            _cycles(found["isr_worst_cycles"]),
            "506 (one axis) to 583 cycles (arc), own time",
        ),
        ("low-priority interrupt, worst", _cycles(found["low_isr_worst_cycles"]), ""),
        (
            "test bar, step times in the cut, status 10 times a second: most off the plan",
            _cycles(jitter),
            "7 to 11 us peak to peak",
        ),
        (
            "test bar, error of the feed",
            f"{found['feed_error_ppm'] / 1e4:+.4f} %",
            "-0.025 to -0.10 %",
        ),
        (
            "fewest steps waiting in the queue while moving",
            f"{found['stream_low_entries']} of 127",
            "",
        ),
        ("homing both axes, dead steps measured three times", f"{found['homing_s']:.1f} s", ""),
        ("upload of the test bar, checked and verified", f"{found['upload_s']:.2f} s", ""),
        (
            f"upload of 30 operations, {found['upload_30_ops_bytes']} bytes, and reading them back",
            f"{found['upload_30_ops_s']:.2f} s",
            "",
        ),
        (
            "frames of full length, each answered, bytes a second to the chip",
            f"{found['link_bytes_per_s']:,}",
            "",
        ),
        ("test bar, RUN to parked, 4 passes", f"{found['test_bar_s']:.1f} s", ""),
        *(
            (
                f"test bar, {entry['name']}",
                f"{entry['cut_mm']:.3f} mm, error {entry['error_steps']:+g} steps",
                "",
            )
            for entry in found["dimensions"]
        ),
        *stop_rows(found),
        *motion_rows(found),
        *safety_rows(found),
        *shape_rows(found),
        ("* `sim_realtime_factor`, cutting", f"{found['sim_realtime_factor']:.1f}", ""),
        ("* `sim_realtime_factor_idle`", f"{found['sim_realtime_factor_idle']:.1f}", ""),
        ("* start of the command line, median of 10", f"{found['cli_start_s']:.2f} s", ""),
    ]


def fill(page: str, found: Figures) -> str:
    """`page` with its table written anew."""
    lines = [
        f"Measured on {found['date']}; {found['computer']}.",
        "",
        f"| what | Tornillo {__version__} | grbl 1.1h |",
        "|---|---|---|",
        *(f"| {what} | {ours} | {peers} |" for what, ours, peers in rows(found)),
    ]
    table = "\n".join(lines)
    return MARKER.sub(lambda marks: f"{marks[1]}{table}\n{marks[2]}", page)
