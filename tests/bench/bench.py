# SPDX-License-Identifier: Apache-2.0
"""`make bench`: measure, write build/bench/bench.json and the table in docs/benchmarks.md."""

import datetime
import json
import platform
import sys
from pathlib import Path

from calibration_page import calibration_figures
from link_figures import link_figures
from measure import BenchError, Figures, command_line, cut_test_bar, sizes
from motion_figures import motion_figures
from page import fill
from safety_figures import safety_figures
from shape_figures import shape_figures
from stop_figures import stop_figures

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "build" / "bench" / "bench.json"
PAGE = ROOT / "docs" / "benchmarks.md"


def figures() -> Figures:
    """Everything that is measured, with the date and the computer."""
    # These run in copies of this process, which must not have a chip of its own yet.
    link, shapes, stops = link_figures(), shape_figures(), stop_figures()
    calibration, safety = calibration_figures(), safety_figures()
    bar = cut_test_bar()
    motion = motion_figures()
    worst = max(bar["isr_worst_cycles"], motion["isr_worst_cycles"])
    return {
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "computer": f"{platform.system()} {platform.machine()}, Python {platform.python_version()}",
        **sizes(),
        **command_line(),
        **bar,
        **link,
        **stops,
        **calibration,
        **motion,
        **shapes,
        **safety,
        "isr_worst_cycles": worst,
    }


def main() -> int:
    """Measure and write; return the exit code."""
    try:
        found = figures()
    except BenchError as error:
        print(f"bench: {error}", file=sys.stderr)
        return 1
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    PAGE.write_text(fill(PAGE.read_text(encoding="utf-8"), found), encoding="utf-8")
    for key, value in found.items():
        print(f"{key:26} {value}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
