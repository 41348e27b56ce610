# SPDX-License-Identifier: Apache-2.0
"""Measurements of one test bar on the virtual lathe, in this process, and of the build."""

import json
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

from tornillo import Lathe, Part
from tornillo.protocol import FEED_UNIT, PERMILLE_DONE, CutRecord, State
from tornillo.status import Status
from virtual_lathe import decode_vcd
from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.lathe import Options, VirtualLathe

ROOT = Path(__file__).resolve().parents[2]
PART = ROOT / "host-cli" / "examples" / "test-bar.toml"
SIZES = ROOT / "build" / "firmware" / "size.json"
DEAD_X, DEAD_Z = 23, 31
POLL_S = 0.1
IDLE_S = 5.0
CLI_STARTS = 10
NS_PER_SECOND = 1_000_000_000

Figures = dict[str, Any]


class BenchError(Exception):
    """The lathe did not do what is to be measured."""


class Stopwatch:
    """Simulated and wall-clock seconds since it was made."""

    def __init__(self, lathe: VirtualLathe) -> None:
        """Start."""
        self._lathe = lathe
        self._simulated = lathe.seconds
        self._wall = time.monotonic()

    def simulated(self) -> float:
        """Simulated seconds."""
        return self._lathe.seconds - self._simulated

    def factor(self) -> float:
        """Simulated seconds for each second on the wall."""
        return self.simulated() / (time.monotonic() - self._wall)


def sizes() -> Figures:
    """Bytes and stack levels as the build has written them."""
    found = json.loads(SIZES.read_text(encoding="utf-8"))
    keys = ("flash_bytes", "ram_static_bytes", "sw_stack_worst_bytes", "hw_stack_worst_levels")
    return {key: found[key] for key in keys}


def command_line() -> Figures:
    """Seconds until `tornillo --help` is done: median of ten."""
    command = [str(Path(sys.executable).with_name("tornillo")), "--help"]
    times = []
    for _ in range(CLI_STARTS):
        start = time.monotonic()
        subprocess.run(command, check=True, capture_output=True)
        times.append(time.monotonic() - start)
    return {"cli_start_s": round(statistics.median(times), 3)}


def cut_test_bar() -> Figures:
    """Upload, home and cut the test bar as the command line does.

    Raises BenchError when it does not come to its end.
    """
    part = Part.load(PART)
    lathe = VirtualLathe(Options(part=PART, backlash_x=DEAD_X, backlash_z=DEAD_Z))
    lathe.plug()
    figures: Figures = {}
    watch = Stopwatch(lathe)
    lathe.run(IDLE_S)
    figures["sim_realtime_factor_idle"] = round(watch.factor(), 2)
    with tempfile.TemporaryDirectory() as folder, Lathe(lathe.port) as chip:
        watch = Stopwatch(lathe)
        image = part.image(chip.machine())
        slot = chip.upload(image)
        figures["upload_s"] = round(watch.simulated(), 3)
        watch = Stopwatch(lathe)
        chip.home()
        _follow(lathe, chip, State.HOMING)
        figures["homing_s"] = round(watch.simulated(), 2)
        trace = Path(folder) / "trace.vcd"
        lathe.chip.open_vcd(trace)
        watch = Stopwatch(lathe)
        chip.run(slot)
        status = _follow(lathe, chip, State.RUNNING)
        figures["test_bar_s"] = round(watch.simulated(), 2)
        figures["sim_realtime_factor"] = round(watch.factor(), 2)
        lathe.chip.close_vcd()
        if status.permille != PERMILLE_DONE:
            raise BenchError(f"the test bar was not finished: {status}")
        _, cut, *_ = part.steps(chip.machine()).records
        assert isinstance(cut, CutRecord)
        figures |= _speed(trace, cut.feed)
    figures["stream_low_entries"] = status.stream_low
    figures["isr_worst_cycles"] = lathe.chip.interrupt_cost(high=True).worst
    figures["low_isr_worst_cycles"] = lathe.chip.interrupt_cost(high=False).worst
    figures["dimensions"] = lathe.report()["dimensions"]
    broken = lathe.broken_checks()
    if broken:
        raise BenchError(f"the run broke expectations: {broken}")
    return figures


def _follow(lathe: VirtualLathe, chip: Lathe, state: State) -> Status:
    """Ask for the status ten times a second until `state` has ended."""
    while (status := chip.status()).state is state:
        lathe.run(POLL_S)
    return status


def _speed(trace: Path, feed: int) -> Figures:
    """Regularity and mean error of the cutting speed behind its ramps; `feed` in 1/8 step/s.

    Planned is a whole number of cycles for each step, begun anew with each move.
    """
    period = CYCLES_PER_SECOND * FEED_UNIT // feed
    late: list[int] = []
    means: list[float] = []
    for move in _moves(trace):
        intervals = [after - before for before, after in pairwise(move)]
        even = [n for n, interval in enumerate(intervals) if abs(interval - period) < period // 200]
        if len(even) < 100:
            continue
        cruise = move[even[0] : even[-1] + 2]
        late += [at - cruise[0] - number * period for number, at in enumerate(cruise)]
        means.append(statistics.mean(intervals[even[0] : even[-1] + 1]))
    if not means:
        raise BenchError("no cutting move found in the trace")
    wanted = CYCLES_PER_SECOND * FEED_UNIT / feed
    return {
        "step_jitter_max_cycles": max(abs(cycles) for cycles in late),
        "feed_error_ppm": round((wanted / statistics.mean(means) - 1) * 1e6, 1),
    }


def _moves(trace: Path) -> Iterator[list[int]]:
    """The cycles of the steps of each move towards the chuck, dead steps included."""
    move: list[int] = []
    for nanoseconds, axis, direction in decode_vcd.steps(trace):
        if (axis, direction) == ("Z", -1):
            move.append(round(nanoseconds * CYCLES_PER_SECOND / NS_PER_SECOND))
        elif move:
            yield move
            move = []
    if move:
        yield move
