# SPDX-License-Identifier: Apache-2.0
"""Power cut at every instruction that writes EEPROM or flash: what is left is old or new."""

from __future__ import annotations

from collections.abc import Callable

from simulated import little_pin, power_cuts
from simulated.bench import Bench
from simulated.power_cuts import Action, every_cut, failures, moments
from simulated.processes import on_a_new_chip
from tornillo.protocol import State


def assert_old_then_new(
    bench: Bench, action: Action, look: Callable[[Bench], object], every: int = 1
) -> int:
    """Make every cut; first all leave the old, then all the new. Return how many leave the new."""
    before, left, after = every_cut(bench, action, look, every)
    assert failures(before, left, after) == 0
    switch = left.index(after)
    assert left == [before] * switch + [after] * (len(left) - switch)
    return len(left) - switch


@on_a_new_chip
def test_every_cut_of_a_settings_save_leaves_the_old_settings_or_the_new() -> None:
    bench = Bench()
    bench.set(home_rate=600)
    bench.set(zero_x=-1111)
    bench.set(zero_z=-2222)
    # The version, written last, is what makes the record one.
    assert assert_old_then_new(bench, power_cuts.save_settings, power_cuts.settings) == 1


@on_a_new_chip
def test_cuts_of_the_first_save_on_a_blank_chip_leave_the_defaults_or_the_new() -> None:
    bench = Bench()
    assert len(moments(bench, power_cuts.save_settings)) > 3 * 30
    # The benchmark makes all of them.
    assert assert_old_then_new(bench, power_cuts.save_settings, power_cuts.settings, 17) == 1


@on_a_new_chip
def test_every_cut_of_a_replacement_leaves_the_old_part_or_the_new_selected_and_intact() -> None:
    bench = little_pin.lathe_with_pin()
    assert assert_old_then_new(bench, power_cuts.commit_part, power_cuts.parts) > 3


@on_a_new_chip
def test_every_cut_of_the_first_part_leaves_no_part_or_that_part() -> None:
    bench = Bench(**little_pin.OPTIONS)
    bench.set(zero_x=little_pin.ZERO_X, zero_z=little_pin.ZERO_Z)
    assert assert_old_then_new(bench, power_cuts.commit_part, power_cuts.parts) > 1


def finish_the_run(bench: Bench) -> None:
    """Go on until the part is finished."""
    bench.wait_for(State.IDLE)


@on_a_new_chip
def test_every_cut_of_a_record_of_progress_leaves_that_pass_or_the_one_before() -> None:
    bench = little_pin.homed_lathe_with_pin()
    bench.host.run()
    bench.wait(lambda: bench.status().pass_number == 2, 5.0)
    bench.run(0.05)  # what tells that the first one is complete has been written
    bench.expect_broken("at most one full step at a time", "no step lost")
    left: list[tuple[int, int] | None] = [
        power_cuts.left_by(bench, finish_the_run, progress, cycle)
        for cycle in moments(bench, finish_the_run)
    ]
    # In order, never back: a record is the one before until its last byte is there.
    assert list(dict.fromkeys(left)) == [(2, 1), (2, 2), (2, 3), (2, 4), NOTHING]
    assert [ORDER.index(one) for one in left] == sorted(ORDER.index(one) for one in left)


NOTHING = (0, 0)
ORDER: list[tuple[int, int] | None] = [(2, 1), (2, 2), (2, 3), (2, 4), NOTHING]


def progress(bench: Bench) -> tuple[int, int]:
    """Operation and pass completed last."""
    begun = bench.host.progress()
    return NOTHING if begun is None else (begun.operation, begun.pass_number)
