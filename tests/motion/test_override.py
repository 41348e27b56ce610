# SPDX-License-Identifier: Apache-2.0
"""The feed override on the chip, given by the host while the path is followed."""

from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as st
from simulated.processes import on_a_new_chip
from tornillo.protocol import State
from virtual_lathe.chip import CYCLES_PER_SECOND

from motion.reference import Line, Move
from motion.rig import Rig
from motion.strategies import chains, repeatable
from motion.trace import Trace

FEED, RAPID, TOP = 1_000.0, 2_500.0, 3_000
# The bound of the feed: 2 %.
REPEATABLE = repeatable(6)


def ready() -> Rig:
    """A rig with USB and settings with ramps."""
    rig = Rig(usb=True)
    rig.settle(
        acceleration=20_000,
        start_rate_x=400,
        start_rate_z=400,
        rapid_rate_x=TOP,
        rapid_rate_z=TOP,
    )
    return rig


def rate_of_last(trace: Trace, steps: int) -> float:
    """Mean rate of the last steps, in steps/s."""
    taken = trace.times[-1] - trace.times[-1 - steps]
    return steps * CYCLES_PER_SECOND / taken


def rate_at(rig: Rig, percent: int, move: Move) -> float:
    """Rate in the middle of a move after an override."""
    lathe = rig.connect()
    rig.start([move])
    lathe.override(percent)
    rig.run(0.4)
    rate = rate_of_last(rig.trace(), 20)
    rig.stop()
    return rate


@on_a_new_chip
def test_an_override_changes_the_feed_by_its_percentage() -> None:
    rig = ready()
    for percent in (10, 50, 73, 100, 149, 200):
        rate = rate_at(rig, percent, Line(0, -8_000, FEED))
        assert math.isclose(rate, FEED * percent / 100.0, rel_tol=0.02), percent


@on_a_new_chip
def test_an_override_never_exceeds_the_maximum_of_the_axis() -> None:
    rig = ready()
    assert math.isclose(rate_at(rig, 200, Line(-8_000, 0, 2_000.0)), TOP, rel_tol=5e-3)


@on_a_new_chip
def test_an_override_leaves_rapids_alone() -> None:
    rig = ready()
    for percent in (10, 200):
        rate = rate_at(rig, percent, Line(0, -8_000, RAPID, rapid=True))
        assert math.isclose(rate, RAPID, rel_tol=5e-3)


@on_a_new_chip
def test_overrides_change_when_steps_come_and_never_which() -> None:
    rig = ready()

    @REPEATABLE
    @given(
        chain=chains(most=8),
        changes=st.lists(st.tuples(st.floats(0.0, 0.1), st.integers(10, 200)), max_size=6),
    )
    def check(chain: list[Move], changes: list[tuple[float, int]]) -> None:
        plain = rig.ready().follow(chain, 60.0)
        lathe = rig.connect()
        rig.start(chain)
        for pause, percent in changes:
            rig.run(pause)
            if not rig.is_in(State.RUNNING):
                break
            lathe.override(percent)
        if rig.is_in(State.RUNNING):
            lathe.override(100)
        rig.finish(120.0)
        assert rig.trace().moves == plain.moves

    check()
