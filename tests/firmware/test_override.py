# SPDX-License-Identifier: Apache-2.0
"""Feed override: the speed of a cut under way, and what it does not touch."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable
from functools import partial
from itertools import pairwise

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import branch, on_a_new_chip
from simulated.watching import Watch
from tornillo.errors import ChipError
from tornillo.protocol import Command, ErrorCode, State
from virtual_lathe.chip import CYCLES_PER_SECOND

Z_PINS = ("RB0", "RB1", "RB2", "RB3")
FEED, LONG = 400, 1000
WITHIN = 0.01
#: The chip multiplies the feed by so many 256ths; it rounds to the nearest.
ROUNDING = 0.5 / 256
#: The speed changes by so much in a tick of the ramp, steps/s; when in one it starts is chance.
SPEED_STEP = 8


def lathe_in_a_long_cut() -> Bench:
    """Return a lathe in the middle of one long cut along the spindle."""
    options = little_pin.OPTIONS | {"stock_length_mm": (LONG + 50) * little_pin.STEP_MM}
    bench = Bench(pull_in=2000.0, **options)
    bench.set(zero_x=little_pin.ZERO_X, zero_z=little_pin.ZERO_Z)
    bench.set(rapid_rate_x=1500, rapid_rate_z=1500)
    bench.lathe.wanted = None
    bench.home()
    part = little_pin.image(
        "long",
        (little_pin.cylinder(0, -LONG, 55),),
        stock_length=LONG + 50,
        stock_front=0,
        finish_allowance=0,
        feed=FEED * 8,
    )
    bench.host.upload(part)
    bench.host.run()
    bench.wait(lambda: bench.position[1] < little_pin.ZERO_Z - 20, 5.0)
    return bench


def speed(bench: Bench, seconds: float) -> float:
    """Return the mean speed of Z over some time, steps/s."""
    bench.chip.log_pins(*Z_PINS)
    bench.run(seconds)
    times = [cycle for cycle, _ in bench.chip.pin_changes()]
    intervals = [after - time for time, after in pairwise(times)]
    assert max(intervals) - min(intervals) <= 2  # each step may be a cycle late
    return CYCLES_PER_SECOND / statistics.fmean(intervals)


@pytest.mark.parametrize("percent", [10, 11, 12, 14, 19, 20, 37, 55, 80, 99, 101, 125, 163, 200])
@on_a_new_chip
def test_the_speed_becomes_the_percentage_of_the_feed_and_comes_back(percent: int) -> None:
    bench = lathe_in_a_long_cut()
    assert speed(bench, 0.1) == pytest.approx(FEED, rel=1e-4)
    bench.host.override(percent)
    bench.run(0.1)
    found = speed(bench, 0.2) / FEED
    assert abs(found - percent / 100) <= ROUNDING + 1e-4
    if percent >= 20:
        assert found == pytest.approx(percent / 100, rel=WITHIN)
    bench.host.override(100)
    bench.run(0.1)
    assert speed(bench, 0.1) == pytest.approx(FEED, rel=1e-4)


@on_a_new_chip
def test_it_may_be_changed_again_and_again_up_and_down() -> None:
    bench = lathe_in_a_long_cut()
    for percent in (150, 200, 60, 25, 180, 50):
        bench.host.override(percent)
        bench.run(0.1)
        assert speed(bench, 0.1) == pytest.approx(FEED * percent / 100, rel=WITHIN)


@on_a_new_chip
def test_the_ramp_to_the_new_speed_is_that_of_the_acceleration() -> None:
    bench = lathe_in_a_long_cut()
    bench.chip.log_pins(*Z_PINS)
    bench.host.override(200)
    bench.run(0.1)
    times = [cycle for cycle, _ in bench.chip.pin_changes()]
    speeds = [CYCLES_PER_SECOND / (after - time) for time, after in pairwise(times)]
    # Never slower again, but for the cycle by which a read of flash delays an interrupt.
    intervals = [after - time for time, after in pairwise(times)]
    assert all(later <= earlier + 2 for earlier, later in pairwise(intervals))
    for (slow, fast), (time, after) in zip(pairwise(speeds), pairwise(times), strict=False):
        # 8,000 step/s^2 in steps of about a millisecond: one more may fall into an interval.
        assert fast - slow <= 8.0 * ((after - time) / 12000 + 1) + 1


@on_a_new_chip
def test_the_feed_never_exceeds_what_the_slides_can_do() -> None:
    bench = lathe_in_a_long_cut()
    bench.host.stop()
    bench.set(rapid_rate_z=600, rapid_rate_x=600)
    bench.host.run()
    bench.wait(lambda: bench.position[1] < little_pin.ZERO_Z - 100, 9.0)
    bench.host.override(200)
    bench.run(0.1)
    assert speed(bench, 0.1) == pytest.approx(600, rel=1e-3)


#: Cuts, and the way out of the facing pass: through what the back edge of the tool has left.
FED = (("X", -65), ("Z", -45), ("Z", 5))


@on_a_new_chip
def test_rapids_keep_their_speed() -> None:
    def rapids(percent: int) -> list[tuple[str, int, int]]:
        bench = little_pin.homed_lathe_with_pin()
        bench.host.upload(little_pin.image("even", finish_feed=400 * 8))
        watch = Watch(bench)
        bench.host.run()
        bench.host.override(percent)
        bench.wait_for(State.IDLE, 60.0)
        strokes = watch.strokes()
        inwards = [s for s in strokes if (s.axis, s.steps) in FED]
        assert all(s.rate == pytest.approx(FEED * percent / 100, rel=WITHIN) for s in inwards)
        return [(s.axis, s.steps, s.rate) for s in strokes if s not in inwards]

    at_half = branch(partial(rapids, 50))
    at_full = branch(partial(rapids, 100))
    assert [stroke[:2] for stroke in at_half] == [stroke[:2] for stroke in at_full]
    for half, full in zip(at_half, at_full, strict=True):
        # A rapid starts from the speed of the cut before it; a short one has no time to forget.
        if abs(half[1]) >= 30:
            slower = math.sqrt(full[2] ** 2 - (FEED**2 - (FEED / 2) ** 2) / 2)
            assert 0.95 * (full[2] if abs(half[1]) >= 60 else slower) <= half[2] <= 1.05 * full[2]
        else:
            assert FEED / 2 < half[2] <= full[2] + SPEED_STEP
    assert max(stroke[2] for stroke in at_half) > 700


@on_a_new_chip
def test_the_next_run_starts_at_100_percent_and_hold_keeps_it() -> None:
    bench = lathe_in_a_long_cut()
    bench.host.override(50)
    bench.run(0.1)
    bench.host.hold()
    bench.run(0.2)
    bench.host.resume()
    bench.run(0.1)
    assert speed(bench, 0.1) == pytest.approx(FEED / 2, rel=WITHIN)
    bench.host.hold()
    bench.run(0.2)
    bench.host.override(75)
    bench.host.resume()
    bench.run(0.1)
    assert speed(bench, 0.1) == pytest.approx(FEED * 3 / 4, rel=WITHIN)
    bench.host.stop()
    bench.host.run()
    bench.wait(lambda: bench.position[1] < little_pin.ZERO_Z - 200, 9.0)
    assert speed(bench, 0.1) == pytest.approx(FEED, rel=1e-4)


@pytest.mark.parametrize("percent", [0, 9, 201, 255])
@on_a_new_chip
def test_a_percentage_outside_its_range_is_refused_by_the_chip(percent: int) -> None:
    bench = lathe_in_a_long_cut()
    send: Callable[[], object] = partial(request_override, bench, percent)
    assert bench.refusal(send) is ErrorCode.OUT_OF_RANGE
    assert speed(bench, 0.1) == pytest.approx(FEED, rel=1e-4)


def request_override(bench: Bench, percent: int) -> None:
    """Send the command past the host's own check."""
    bench.host._request(Command.OVERRIDE, percent)


@on_a_new_chip
def test_without_a_run_it_is_refused() -> None:
    bench = little_pin.lathe_with_pin(start_x=-250)
    with pytest.raises(ChipError) as caught:
        bench.host.override(80)
    assert caught.value.code is ErrorCode.NOT_RUNNING
    bench.host.home()
    assert bench.refusal(lambda: bench.host.override(80)) is ErrorCode.NOT_RUNNING
    bench.wait(lambda: bench.homed, 60.0)
    assert bench.refusal(lambda: bench.host.override(80)) is ErrorCode.NOT_RUNNING
