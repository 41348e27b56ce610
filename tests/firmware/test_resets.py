# SPDX-License-Identifier: Apache-2.0
"""Resets of every kind: the cause is told, and nothing moves afterwards."""

from __future__ import annotations

import random
from functools import partial

import pytest
from simulated import little_pin
from simulated.bench import START_S, Bench
from simulated.processes import branch, on_a_new_chip
from tornillo.protocol import ErrorCode, ResetCause, State
from virtual_lathe.chip import CYCLES_PER_SECOND, NonVolatile, Reset

STACK_POINTER = 0xFFC
BRANCH_TO_ITSELF = b"\xff\xd7"
COILS = ("RB0", "RB1", "RB2", "RB3", "RD0", "RD1", "RD2", "RD3")


def assert_quiet_after_reset(bench: Bench, cause: ResetCause) -> None:
    """Check that the chip has started anew: no current, no motion, not homed."""
    bench.chip.log_pins(*COILS)
    bench.run(0.1)
    assert bench.chip.pin_changes() == []
    assert (bench.chip.port("B") & 15, bench.chip.port("D") & 15) == (0, 0)
    assert bench.is_in(State.IDLE)
    assert not bench.homed
    bench.connect()
    assert bench.status().reset_cause is cause
    assert bench.status().uptime_ms < 1000


def running_lathe() -> Bench:
    """Return a lathe that is cutting."""
    bench = little_pin.homed_lathe_with_pin()
    bench.expect_broken("coil pattern legal", "at most one full step at a time", "no step lost")
    bench.host.run()
    bench.run(0.2)
    assert bench.moving
    return bench


@pytest.mark.parametrize(
    ("kind", "cause"),
    [
        (Reset.POWER_ON, ResetCause.POWER_ON),
        (Reset.BROWN_OUT, ResetCause.BROWN_OUT),
        (Reset.WATCHDOG, ResetCause.WATCHDOG),
        (Reset.MCLR, ResetCause.MCLR),
    ],
)
@on_a_new_chip
def test_a_reset_in_mid_cut_is_told_by_its_cause_and_stops_everything(
    kind: Reset, cause: ResetCause
) -> None:
    bench = running_lathe()
    bench.lathe.unplug()
    bench.chip.reset(kind)
    bench.run(0.001)
    assert_quiet_after_reset(bench, cause)
    bench.home()
    bench.host.run()
    bench.run(0.1)
    assert bench.is_in(State.RUNNING)


@on_a_new_chip
def test_a_main_loop_that_hangs_is_ended_by_the_watchdog_within_half_a_second() -> None:
    bench = running_lathe()
    bench.lathe.unplug()
    hung_at = bench.chip.seconds
    memory = bench.chip.save()
    at = bench.chip.symbols.code("machine_poll")
    hung = memory.flash[:at] + BRANCH_TO_ITSELF + memory.flash[at + 2 :]
    bench.chip.restore(NonVolatile(hung, memory.eeprom))
    bench.wait(lambda: len(bench.chip.resets) > 1, 0.5)
    bench.chip.restore(memory)
    assert bench.chip.resets[-1][1] is Reset.WATCHDOG
    assert bench.chip.seconds - hung_at > 0.1
    bench.run(0.001)
    assert_quiet_after_reset(bench, ResetCause.WATCHDOG)


@on_a_new_chip
def test_a_stack_overflow_is_told_by_its_cause() -> None:
    bench = running_lathe()
    bench.lathe.unplug()
    # The next instruction but few is a call.
    assert bench.chip.run_to_address(bench.chip.symbols.code("machine_poll"))
    bench.chip.write(STACK_POINTER, 30)
    bench.wait(lambda: len(bench.chip.resets) > 1, 0.1, 1e-4)
    bench.chip.clear_statistics()
    assert bench.chip.resets[-1][1] in (Reset.STACK_FULL, Reset.STACK_EMPTY)
    bench.run(0.001)
    assert_quiet_after_reset(bench, ResetCause.STACK)


#: Operations and passes of the little pin, in order.
PLACES = [(1, 1), (2, 1), (2, 2), (2, 3), (2, 4)]
NOTHING = (0, 0)


def could_be_told(mark: int) -> set[tuple[int, int]]:
    """What may be told as completed last at a mark of the path: 1 the way to the part, 7 home.

    The place before it, or, until that has been written, the one before that.
    """
    done = max(0, mark - 2)
    told = {*PLACES[max(0, done - 2) : done]}
    return told | {NOTHING} if done < 2 or done == len(PLACES) else told


def cycles_until_idle(bench: Bench) -> int:
    """Let the motion end; return how long that took."""
    begun = bench.chip.cycle
    bench.wait_for(State.IDLE)
    return bench.chip.cycle - begun - CYCLES_PER_SECOND // 100  # what the waiting has added


@pytest.mark.parametrize(("moving", "moments"), [("homing", 60), ("running", 140)])
@on_a_new_chip
def test_a_brown_out_at_any_moment_of_motion_ends_it_and_is_told(moving: str, moments: int) -> None:
    chance = random.Random(moments)
    if moving == "homing":
        bench = Bench(start_x=-200, start_z=-300)
        bench.host.home()
    else:
        bench = little_pin.homed_lathe_with_pin()
        bench.host.run()
    bench.expect_broken("coil pattern legal", "at most one full step at a time", "no step lost")
    start = bench.chip.cycle
    lasts = branch(partial(cycles_until_idle, bench))

    def brown_out(could: set[tuple[int, int]]) -> None:
        bench.unplug()
        bench.chip.reset(Reset.BROWN_OUT)
        bench.run(0.001)
        assert_quiet_after_reset(bench, ResetCause.BROWN_OUT)
        assert bench.refusal(bench.host.run) is ErrorCode.NOT_HOMED
        begun = bench.host.progress()
        told = NOTHING if begun is None else (begun.operation, begun.pass_number)
        assert told in could, f"{told} is told, not one of {could}"

    moved = 0
    for cycle in sorted(chance.randrange(lasts) for _ in range(moments)):
        bench.lathe.run_to(max(start + cycle, bench.chip.cycle))
        moved += bench.moving
        assert bench.state in (State.HOMING, State.RUNNING)
        could = {NOTHING}
        if moving == "running":
            could = could_be_told(bench.chip.variable("path_mark"))
        branch(partial(brown_out, could))
    assert moved > moments / 2


@pytest.mark.parametrize("seed", range(3))
@on_a_new_chip
def test_whatever_is_in_ram_at_power_on_the_chip_starts_the_same(seed: int) -> None:
    bench = Bench()
    bench.run(START_S)
    bench.power_cycle(seed)
    assert_quiet_after_reset(bench, ResetCause.POWER_ON)
    assert bench.host.settings()
    bench.home()
