# SPDX-License-Identifier: Apache-2.0
"""The times of the steps follow from the moves alone: not from USB, not from when it began."""

from __future__ import annotations

import random
from itertools import count

from hypothesis import given
from hypothesis import strategies as st
from simulated.processes import on_a_new_chip
from tornillo.frames import Frame, encode
from tornillo.protocol import Command, State

from motion.reference import Arc, Line, Move, Output, Segment, Signal, Wait
from motion.rig import MotionFault, Rig
from motion.strategies import arcs, lines, repeatable
from motion.trace import Trace

#: 1.0 us, the bound of the jitter. An interrupt waits for the end of the instruction before it.
JITTER_CYCLES = 12
#: How long the port is closed now and then, and how often the chip is asked when it is open.
OUT_S, ASK_S = 0.01, 2e-4
TIMEOUT_S = 60.0
REPEATABLE = repeatable(10)
ASKED = (Command.HELLO, Command.STATUS, Command.PART_INFO, Command.SETTING_GET)


def ramped() -> Rig:
    """A rig with the cable, and with ramps."""
    rig = Rig(usb=True)
    rig.settle(
        acceleration=8_000,
        start_rate_x=400,
        start_rate_z=300,
        rapid_rate_x=3_000,
        rapid_rate_z=4_000,
    )
    return rig


def in_silence(rig: Rig, chain: list[Segment]) -> Trace:
    """Follow a chain with the cable out."""
    rig.host.unplug()
    return rig.follow(chain, TIMEOUT_S)


def in_noise(rig: Rig, chain: list[Segment], seed: int) -> Trace:
    """Follow a chain while the chip is asked without a pause, and the cable is pulled."""
    chance = random.Random(seed)
    numbers = count()
    rig.run(chance.random() * 2e-3)  # any phase of the chip's millisecond
    rig.start(chain)
    while not rig.is_in(State.IDLE):
        if rig.is_in(State.ALARM):
            raise MotionFault(f"alarm {rig.chip.variable('machine_alarm')}")
        if not rig.host.connected:
            rig.host.plug()
            rig.host.enumerate()
            rig.host.open_port()
        end = rig.chip.seconds + chance.random() * 0.2
        while rig.chip.seconds < end and not rig.is_in(State.IDLE):
            rig.host.receive()
            command = chance.choice(ASKED)
            payload = b"\0" if command in (Command.PART_INFO, Command.SETTING_GET) else b""
            rig.host.send(b"\0" + encode(Frame(next(numbers) & 0xFF, command, payload)))
            rig.run(chance.random() * ASK_S)
        rig.host.unplug()
        rig.run(chance.random() * OUT_S)
    return rig.trace()


def difference(one: Trace, other: Trace) -> int:
    """The largest difference between the times of the same steps, in cycles since the first."""
    assert one.moves == other.moves
    shift = one.times[0] - other.times[0]
    return max(abs(a - b - shift) for a, b in zip(one.times, other.times, strict=True))


def moves() -> st.SearchStrategy[Move]:
    """Cuts and rapids at rates of a lathe, with ramps at either end."""
    return st.one_of(lines(300), arcs(smallest=30.0, largest=3_000.0, longest=300.0))


def slow(move: Move, rate: int, rapid: bool) -> Move:
    """The move at a rate of a lathe."""
    if isinstance(move, Arc):
        return Arc(move.dx, move.dz, move.cx, move.cz, move.towards_z, float(rate))
    return Line(move.dx, move.dz, float(rate), rapid)


def segments() -> st.SearchStrategy[Segment]:
    """Moves, rests and orders."""
    return st.one_of(
        st.builds(slow, moves(), st.sampled_from((250, 700, 1_100, 3_000)), st.booleans()),
        st.builds(slow, moves(), st.integers(20, 2_500), st.booleans()),
        st.builds(Wait, st.integers(1, 30)),
        st.sampled_from((Output(0x40), Output(0), Signal(3))),
    )


@on_a_new_chip
def test_the_times_of_all_steps_are_the_same_whatever_usb_does() -> None:
    rig = ramped()

    @REPEATABLE
    @given(chain=st.lists(segments(), min_size=3, max_size=20), seed=st.integers(0, 10_000))
    def check(chain: list[Segment], seed: int) -> None:
        chain = [Line(0, 20, 400.0), *chain]
        rig.ready().dead_steps(7, 12)
        quiet = in_silence(rig, chain)
        rig.dead_steps(7, 12)
        assert difference(quiet, in_noise(rig, chain, seed)) <= JITTER_CYCLES

    check()
