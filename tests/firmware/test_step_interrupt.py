# SPDX-License-Identifier: Apache-2.0
"""The step interrupt: exact times, orders in the stream, and what it costs."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.planned import Planned
from simulated.processes import on_a_new_chip
from tornillo.protocol import State
from virtual_lathe.chip import CYCLES_PER_SECOND

X_PINS = ("RD0", "RD1", "RD2", "RD3")
CYCLES_PER_MS = CYCLES_PER_SECOND // 1000
#: Acceptance to the end of retfie: leaves 70 cycles of the 240 of the fastest step, 50 kHz.
WORST_CYCLES = 150
PULL_IN = 5000
ACCELERATION, START_RATE = 8000, 400
#: The speed changes in steps of what it gains in 1/1024 s.
SPEED_STEP = ACCELERATION / 1024
#: An interrupt waits for the end of the instruction before it, which may take two cycles.
LATENCY = 1
#: Cycles an order without a time of its own takes, 20 us.
ORDER_CYCLES = 240
END, WAIT, OUTPUT, SIGNAL = 0x80, 0x81, 0x82, 0x83


def seeking_lathe(rate: int) -> Bench:
    """Return a lathe that seeks the switch of X from far away at a rate in steps/s."""
    bench = Bench(pull_in=PULL_IN, start_x=-2400)
    bench.set(home_rate=rate, rapid_rate_x=PULL_IN, rapid_rate_z=PULL_IN)
    bench.set(acceleration=ACCELERATION, start_rate_x=START_RATE)
    return bench


def step_times(bench: Bench) -> list[int]:
    """Return the cycles at which the coils of X have changed since they were logged."""
    return [cycle for cycle, _ in bench.chip.pin_changes()]


def wait(bench: Bench) -> None:
    """Leave the chip alone for a while."""
    bench.run(0.05)


def poll(bench: Bench) -> None:
    """Ask for the status 20 times a second."""
    bench.run(0.05)
    bench.host.status()


def flood(bench: Bench) -> None:
    """Ask for this and that without a pause."""
    bench.host.status()
    bench.host.part(3)
    bench.host.machine()


def ramp_seconds(rate: int) -> float:
    """Return how long the ramp from the start rate up to a rate takes."""
    return max(0, rate - START_RATE) / ACCELERATION


@pytest.mark.parametrize("link", [wait, poll, flood])
@pytest.mark.parametrize(
    ("rate", "steps"), [(20, 40), (37, 60), (183, 200), (184, 200), (999, 600), (4000, 1800)]
)
@on_a_new_chip
def test_steps_come_at_their_exact_time_whatever_usb_does(
    rate: int, steps: int, link: Callable[[Bench], None]
) -> None:
    bench = seeking_lathe(rate)
    planned = Planned(bench)
    bench.host.home()
    ramp = ramp_seconds(rate)
    cruise_steps = steps - ramp * (rate + START_RATE) / 2
    end = bench.chip.seconds + 0.05 + ramp + (cruise_steps + 10) / rate
    while bench.chip.seconds < end:
        link(bench)
    steps_made = planned.steps()
    assert len(steps_made) >= steps
    assert all(abs(step.interval - step.period) <= LATENCY for step in steps_made)
    cruise = CYCLES_PER_SECOND // rate
    slowest = cruise if rate <= START_RATE else CYCLES_PER_SECOND // START_RATE
    assert steps_made[0].period == slowest
    assert {step.period for step in steps_made[-int(cruise_steps) :]} == {cruise}
    assert bench.lathe.interrupt_cost().worst <= WORST_CYCLES


@pytest.mark.parametrize("rate", [999, 4000])
@on_a_new_chip
def test_the_ramp_is_that_of_the_acceleration_over_the_way(rate: int) -> None:
    bench = seeking_lathe(rate)
    planned = Planned(bench)
    bench.host.home()
    bench.run(0.1 + ramp_seconds(rate))
    periods = [step.period for step in planned.steps()]
    speeds = [CYCLES_PER_SECOND / period for period in periods]
    for way, speed in enumerate(speeds):
        # The ideal speed when the step begins. That of the chip changes every speed / 1024 + 1
        # steps, by what an ideal ramp gains on these, and in whole ticks; periods are whole cycles.
        behind = 2 * (int(speed) // 1024 + 1)
        ideal, least = (
            math.sqrt(START_RATE**2 + 2 * ACCELERATION * max(0, steps))
            for steps in (way, way - behind)
        )
        rounding = speed * speed / CYCLES_PER_SECOND
        assert speed <= min(rate, ideal + SPEED_STEP) + rounding
        assert speed >= min(rate, least - SPEED_STEP) - rounding
    assert max(speeds) == pytest.approx(rate, rel=1e-3)
    assert speeds == sorted(speeds)
    # Every change is of whole ticks, to a cycle: nothing else goes into the speed.
    for period, found in zip(periods, speeds, strict=True):
        speed = min(rate, START_RATE + round((found - START_RATE) / SPEED_STEP) * SPEED_STEP)
        assert period == int(CYCLES_PER_SECOND * 256 / int(speed * 256))


def entries_left(bench: Bench) -> list[int]:
    """Cut the stream off from the main loop; return the addresses of the entries in it."""
    # The main loop plans nothing in IDLE: what is in the ring now is all that will come.
    bench.chip.set_variable("machine_state", State.IDLE)
    bench.run(0.001)
    ring = bench.chip.symbols.ram("step_ring")
    at, head = bench.chip.variable("stream_tail"), bench.chip.variable("stream_head")
    return [ring + (at + offset & 0xFF) for offset in range(0, head - at & 0xFF, 2)]


@pytest.mark.parametrize("stretch", [1, 106, 255])
@pytest.mark.parametrize("rate", [50, 800])
@on_a_new_chip
def test_a_stretched_step_takes_longer_by_so_many_256ths(rate: int, stretch: int) -> None:
    bench = seeking_lathe(rate)
    bench.host.home()
    bench.run(ramp_seconds(rate) + 20 / rate)
    left = entries_left(bench)
    for address in left:
        bench.chip.poke(address + 1, stretch)
    bench.chip.log_pins(*X_PINS)
    bench.wait(lambda: not bench.moving, 6.0)
    times = step_times(bench)
    period = CYCLES_PER_SECOND // rate
    longer = period + stretch * period // 256
    assert len(times) > len(left) - 2
    assert all(abs(after - time - longer) <= LATENCY for time, after in list(pairwise(times))[1:])
    assert bench.lathe.interrupt_cost().worst <= WORST_CYCLES


# -- orders ----------------------------------------------------------------------------------------


def lathe_with_orders(*orders: tuple[int, int], rate: int = 400) -> tuple[Bench, int]:
    """Seek, with orders (code, number) in the stream behind a few steps and an end six steps after.

    Return the bench and the number of steps before the orders, counted from now.
    """
    bench = seeking_lathe(rate)
    bench.host.home()
    bench.run(20 / rate)
    left = entries_left(bench)
    bench.chip.log_pins(*X_PINS, "RC6", "RC7")
    for address, (code, number) in zip(left[8:], orders, strict=False):
        bench.chip.poke(address, code)
        bench.chip.poke(address + 1, number)
    bench.chip.poke(left[8 + len(orders) + 6], END)
    return bench, 9  # one entry had been fetched already


@pytest.mark.parametrize("milliseconds", [1, 5, 6, 100, 255])
@on_a_new_chip
def test_a_wait_delays_the_next_step_by_exactly_its_milliseconds(milliseconds: int) -> None:
    rate = 400
    bench, before = lathe_with_orders((WAIT, milliseconds), rate=rate)
    bench.wait(lambda: not bench.moving, 2.0)
    times = step_times(bench)
    intervals = [after - time for time, after in pairwise(times)]
    period = CYCLES_PER_SECOND // rate
    assert len(times) == before + 6
    # A read of flash that has begun is finished first: a cycle.
    waited = intervals.pop(before - 1)
    assert abs(waited - period - milliseconds * CYCLES_PER_MS) <= 1
    assert {interval - period for interval in intervals} <= {-1, 0, 1}
    assert bench.alarm[0] == 0
    assert bench.lathe.interrupt_cost().worst <= WORST_CYCLES


@on_a_new_chip
def test_outputs_switch_the_relays_at_a_time_exact_to_the_cycle() -> None:
    orders = ((OUTPUT, 0x40), (WAIT, 3), (OUTPUT, 0xC0), (OUTPUT, 0x80), (WAIT, 1), (OUTPUT, 0))
    rate = 250
    bench, before = lathe_with_orders(*orders, rate=rate)
    bench.wait(lambda: not bench.moving, 2.0)
    changes = bench.chip.pin_changes()
    relays: list[tuple[int, int]] = []
    steps: list[int] = []
    shown = 0
    for cycle, levels in changes:
        relay = levels >> 16 & 0xC0
        if relay == shown:
            steps.append(cycle)
        else:
            relays.append((cycle, relay))
            shown = relay
    last_step = steps[before - 1]
    assert [relay for _, relay in relays] == [0x40, 0xC0, 0x80, 0]
    at = [cycle - relays[0][0] for cycle, _ in relays]
    first, waited = 3 * CYCLES_PER_MS + ORDER_CYCLES, CYCLES_PER_MS + ORDER_CYCLES
    assert at == [0, first, first + ORDER_CYCLES, first + ORDER_CYCLES + waited]
    # The coils are written first in the interrupt, a relay some instructions later.
    assert 0 <= relays[0][0] - last_step - ORDER_CYCLES < 40
    period = CYCLES_PER_SECOND // rate
    assert steps[before] - last_step == 4 * ORDER_CYCLES + 4 * CYCLES_PER_MS + period


@on_a_new_chip
def test_a_signal_reaches_the_main_loop_at_a_time_exact_to_the_cycle() -> None:
    rate = 400
    bench, before = lathe_with_orders((SIGNAL, 7), (WAIT, 10), (SIGNAL, 213), rate=rate)
    signal = bench.chip.symbols.ram("stream_signal")
    bench.chip.watch_writes(signal, signal)
    bench.wait(lambda: not bench.moving, 2.0)
    times = step_times(bench)
    writes = bench.chip.ram_writes()
    assert [write.value for write in writes] == [7, 213]
    assert 0 <= writes[0].cycle - times[before - 1] - ORDER_CYCLES < 40
    assert writes[1].cycle - writes[0].cycle == 10 * CYCLES_PER_MS + ORDER_CYCLES
    assert bench.chip.variable("stream_signal") == 213


@on_a_new_chip
def test_the_interrupt_costs_no_more_than_its_window_in_a_whole_run() -> None:
    bench = little_pin.homed_lathe_with_pin(backlash_x=7, backlash_z=12)
    bench.host.run()
    while bench.is_in(State.RUNNING):
        bench.host.status()
    cost = bench.lathe.interrupt_cost()
    assert cost.entries > 500
    assert cost.worst <= WORST_CYCLES
    little_pin.assert_cut_exactly(bench)
