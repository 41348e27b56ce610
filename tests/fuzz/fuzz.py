# SPDX-License-Identifier: Apache-2.0
"""`make fuzz`: the long run, its counts kept in build/fuzz/fuzz.json and docs/benchmarks.md."""

from __future__ import annotations

import argparse
import datetime
import json
import multiprocessing
import re
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from fuzz.frames import FrameFuzzer
from fuzz.target import Broken, Target
from fuzz.transfers import TransferFuzzer
from fuzz.unplugs import Unplugs

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "build" / "fuzz" / "fuzz.json"
PAGE = ROOT / "docs" / "benchmarks.md"
MARKER = re.compile(r"(<!-- fuzz -->\n).*?(<!-- end of fuzz -->)", re.DOTALL)
SLICE = 20_000
MILLION = 1_000_000
UNPLUGS = 500
Outcome = dict[str, int | float | str]


def fuzz_transfers(count: int, seed: int) -> Outcome:
    """Make ``count`` transfers; ``broken`` in the outcome says what went wrong, if anything."""
    target = Target()
    fuzzer = TransferFuzzer(target, seed)
    broken = ""
    start = time.monotonic()
    try:
        while fuzzer.counts.transfers < count:
            fuzzer.run(min(SLICE, count - fuzzer.counts.transfers))
            show("transfers", fuzzer.counts.transfers, start)
        fuzzer.check_alive()
    except Broken as error:
        broken = str(error)
    return {
        "usb_fuzz_transfers": fuzzer.counts.transfers,
        "usb_fuzz_accidents": fuzzer.counts.accidents,
        "usb_fuzz_simulated_s": round(target.bench.chip.seconds, 1),
        "usb_fuzz_wall_s": round(time.monotonic() - start, 1),
        "broken": broken,
    }


def fuzz_frames(count: int, seed: int) -> Outcome:
    """Send ``count`` frames; as above."""
    target = Target()
    fuzzer = FrameFuzzer(target, seed)
    broken = ""
    start = time.monotonic()
    try:
        while fuzzer.counts.frames < count:
            fuzzer.run(min(SLICE, count - fuzzer.counts.frames))
            show("frames", fuzzer.counts.frames, start)
        target.check_alive()
    except Broken as error:
        broken = str(error)
    return {
        "frame_fuzz_frames": fuzzer.counts.frames,
        "frame_fuzz_right": fuzzer.counts.right,
        "frame_fuzz_simulated_s": round(target.bench.chip.seconds, 1),
        "frame_fuzz_wall_s": round(time.monotonic() - start, 1),
        "broken": broken,
    }


def pull_cables(count: int, seed: int) -> Outcome:
    """Pull the cable ``count`` times; as above."""
    unplugs = Unplugs(seed)
    broken = ""
    try:
        unplugs.upload(count * 3 // 10)
        unplugs.status(count * 2 // 10)
        unplugs.run(count - unplugs.moments)
    except Broken as error:
        broken = str(error)
    return {
        "usb_unplugs": unplugs.moments,
        "usb_unplug_runs": unplugs.runs,
        "usb_unplug_shift_cycles": unplugs.worst_cycles,
        "broken": broken,
    }


def show(what: str, done: int, start: float) -> None:
    """Print how far it is, on a line that is overwritten on a terminal."""
    rate = done / (time.monotonic() - start)
    end = "\r" if sys.stdout.isatty() else "\n"
    if sys.stdout.isatty() or done % (SLICE * 10) == 0:
        print(f"fuzz: {done:,} {what}, {rate:,.0f} a second   ", end=end, flush=True)


def fill(page: str, found: Outcome) -> str:
    """``page`` with the counts of a run."""
    rows = [
        f"Run on {found['date']} with seed {found['seed']}, firmware of {found['commit']}.",
        "No hang, no reset, no motion, no write outside the RAM that well-formed requests make it",
        "write, no mistake with the USB engine.",
        "",
        "| what | count |",
        "|---|---|",
        f"| `usb_fuzz_transfers` | {found['usb_fuzz_transfers']:,} |",
        f"| bus resets, sleeps and pulled cables among them | {found['usb_fuzz_accidents']:,} |",
        f"| `frame_fuzz_frames` | {found['frame_fuzz_frames']:,} |",
        f"| of these right and answered | {found['frame_fuzz_right']:,} |",
        f"| `usb_unplugs`: cable pulled in upload, status, run | {found['usb_unplugs']:,} |",
        f"| runs with it, each step compared with one without | {found['usb_unplug_runs']} |",
        f"| largest difference of a step's time | {found['usb_unplug_shift_cycles']} cycles |",
        f"| simulated time, transfers and frames | {simulated(found):,.0f} s |",
    ]
    return MARKER.sub(lambda marks: f"{marks[1]}{chr(10).join(rows)}\n{marks[2]}", page)


def simulated(found: Outcome) -> float:
    """Simulated seconds of both parts."""
    return float(found["usb_fuzz_simulated_s"]) + float(found["frame_fuzz_simulated_s"])


def commit() -> str:
    """The commit the firmware is of, with a plus when files have changed since."""
    command = ["git", "describe", "--always", "--dirty=+"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.strip() or "unknown"


def main(argv: list[str] | None = None) -> int:
    """Run both parts side by side; returns the exit code."""
    parser = argparse.ArgumentParser(prog="make fuzz", description=__doc__)
    parser.add_argument("--transfers", type=int, default=MILLION)
    parser.add_argument("--frames", type=int, default=MILLION)
    parser.add_argument("--unplugs", type=int, default=UNPLUGS)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args(argv)
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(2, mp_context=context, max_tasks_per_child=1) as pool:
        parts = [
            pool.submit(fuzz_transfers, arguments.transfers, arguments.seed),
            pool.submit(fuzz_frames, arguments.frames, arguments.seed),
            pool.submit(pull_cables, arguments.unplugs, arguments.seed),
        ]
        outcomes = [part.result() for part in parts]
    found: Outcome = {
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "seed": arguments.seed,
        "commit": commit(),
    }
    broken = [str(outcome.pop("broken")) for outcome in outcomes]
    for outcome in outcomes:
        found |= outcome
    found["broken"] = "\n".join(text for text in broken if text)
    OUT.parent.mkdir(parents=True, exist_ok=True)
    OUT.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    for key, value in found.items():
        print(f"{key:26} {value}")
    if found["broken"]:
        return 1
    asked = (arguments.transfers, arguments.frames, arguments.unplugs)
    if all(count >= least for count, least in zip(asked, (MILLION, MILLION, UNPLUGS), strict=True)):
        PAGE.write_text(fill(PAGE.read_text(encoding="utf-8"), found), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
