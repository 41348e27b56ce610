# SPDX-License-Identifier: Apache-2.0
"""Chains on screws with play: the tool, not the screw, is where the chip says."""

from __future__ import annotations

import itertools

from hypothesis import given, settings
from hypothesis import strategies as st
from simulated.processes import on_a_new_chip
from tornillo.protocol import State

from motion.backlash import tool_points
from motion.reference import Arc, Line, Move, Point
from motion.rig import Rig
from motion.strategies import chains, repeatable
from motion.trace import Trace, judge, split

BOUND = 0.51
DEAD = (23, 31)
REPEATABLE = repeatable(12)
PLAY = st.tuples(st.integers(0, 60), st.integers(0, 60))
SIDES = st.tuples(st.booleans(), st.booleans())


def ready(rig: Rig, dead: Point, pulled: tuple[bool, bool]) -> Point:
    """Give the screws play, each taken up towards plus or, if pulled, minus; returns the slack."""
    rig.ready()
    slack = (-dead[0] if pulled[0] else 0, -dead[1] if pulled[1] else 0)
    rig.dead_steps(*dead, *slack)
    return slack


def places(trace: Trace, dead: Point, slack: Point) -> list[Point]:
    """Where the tool has been, each place once while it stands."""
    tool = tool_points(trace.moves, dead, slack)
    return [p for i, p in enumerate(tool) if i == 0 or p != tool[i - 1]]


@on_a_new_chip
def test_the_tool_does_not_leave_the_path_while_dead_steps_are_taken_up() -> None:
    rig = Rig()
    rig.quick(15_000)

    @REPEATABLE
    @given(chain=chains(most=10), dead=PLAY, pulled=SIDES)
    def check(chain: list[Move], dead: Point, pulled: tuple[bool, bool]) -> None:
        slack = ready(rig, dead, pulled)
        trace = rig.follow(chain, 60.0)
        assert trace.counted == (
            sum(m.dx for m in chain) & 0xFFFF,
            sum(m.dz for m in chain) & 0xFFFF,
        )
        visited = split(places(trace, dead, slack), chain)
        for move, part in zip(chain, visited, strict=True):
            assert judge(move, part).worst <= BOUND

    check()


@on_a_new_chip
def test_an_axis_that_turns_twice_in_a_few_steps_keeps_its_position() -> None:
    rig = Rig()
    rig.quick(4_000)
    slack = ready(rig, DEAD, (False, True))
    chain: list[Move] = [
        Arc(-3, -6, -7.3888470880568295, -0.055576455971585226, False, 2_000.0),
        Line(0, 1, 2_000.0),
        Arc(-15, 1, -7.5, 0.5, True, 2_000.0),
    ]
    trace = rig.follow(chain, 5.0)
    assert places(trace, DEAD, slack)[-1] == (-18, -4)


@on_a_new_chip
def test_holds_change_nothing_about_dead_steps() -> None:
    rig = Rig()
    rig.quick(4_000)

    @settings(REPEATABLE, max_examples=8)
    @given(chain=chains(most=8), wait=st.floats(0.02, 0.3))
    def check(chain: list[Move], wait: float) -> None:
        ready(rig, DEAD, (False, True))
        plain = rig.follow(chain, 60.0)
        ready(rig, DEAD, (False, True))
        rig.start(chain)
        rig.run(wait)
        if rig.is_in(State.RUNNING):
            rig.hold()
            rig.run(0.1)
        if rig.is_in(State.HOLD):
            rig.resume()
        rig.finish(60.0)
        assert rig.trace().moves == plain.moves

    check()


@on_a_new_chip
def test_a_stop_anywhere_leaves_the_tools_position_true() -> None:
    rig = Rig()
    rig.quick(4_000)

    @REPEATABLE
    @given(chain=chains(most=8), wait=st.floats(0.0, 0.4))
    def check(chain: list[Move], wait: float) -> None:
        slack = ready(rig, DEAD, (False, True))
        before = rig.position
        rig.start(chain)
        rig.run(wait)
        if rig.is_in(State.RUNNING):
            rig.stop()
        rig.run(0.02)
        x, z = tool_points(rig.trace().moves, DEAD, slack)[-1]
        now = rig.position
        assert ((now[0] - before[0]) & 0xFFFF, (now[1] - before[1]) & 0xFFFF) == (
            x & 0xFFFF,
            z & 0xFFFF,
        )

    check()


@on_a_new_chip
def test_a_ball_is_turned_round_on_its_flat_top_without_a_stand() -> None:
    rig = Rig()
    rig.quick(2_000)
    for radius, towards_z in ((300, False), (300, True), (700, False)):
        for dead in (5, 23):
            side = 1 if towards_z else -1
            slack = ready(rig, (dead, dead), (False, not towards_z))
            move = Arc(0, side * 2 * radius, 0.0, side * float(radius), towards_z, 1_500.0)
            tool = tool_points(rig.follow([move], 20.0).moves, (dead, dead), slack)
            assert judge(move, tool).worst <= BOUND
            stands = sum(a == b for a, b in itertools.pairwise(tool))
            assert stands == 0, (radius, dead)


@on_a_new_chip
def test_a_straight_reversal_takes_up_all_dead_steps_first() -> None:
    rig = Rig()
    rig.quick(2_000)
    ready(rig, DEAD, (False, False))
    trace = rig.follow([Line(40, 0, 1_000.0), Line(-40, 0, 1_000.0)], 5.0)
    assert trace.moves == [(1, 0)] * 40 + [(-1, 0)] * (40 + DEAD[0])
    assert trace.counted == (0, 0)
