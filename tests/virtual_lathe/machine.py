# SPDX-License-Identifier: Apache-2.0
"""Motors, screws, slides and switches of the lathe; the work is done in native/machine.cc."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from enum import IntEnum

from .motor import PULL_IN, PULL_OUT
from .native_library import AxisSetupC, AxisStateC, FaultC, MoveC, library

BATCH = 4096


class AxisName(IntEnum):
    """The two axes, numbered as in the link protocol."""

    X = 0
    Z = 1


class FaultKind(IntEnum):
    """What can go wrong between coil pattern and slide."""

    PATTERN = 0
    JUMP = 1
    LOST_STEP = 2
    END_STOP = 3


@dataclass
class AxisOptions:
    """One axis; lengths in full steps, rates in full steps/s.

    ``start`` is the slide's place when power comes, 0 at the release point of its switch.
    ``slack`` is how much of the backlash is taken up (0 = the nut was last pulled in negative
    direction, ``backlash`` = in positive direction). The motor starts at up to ``pull_in``; with
    an ``acceleration`` it goes on to ``pull_out``.
    """

    start: int
    travel: int
    backlash: int = 0
    slack: int = 0
    switch_travel: int = 0
    switch_broken: bool = False
    beyond: int = 60
    pull_in: float = PULL_IN
    pull_out: float = PULL_OUT
    acceleration: float = 0.0


@dataclass(frozen=True)
class AxisState:
    """Truth about an axis; positions in full steps, halves are possible."""

    slide: float
    slack: float
    rotor: float
    commanded: float
    steps: int
    lost_steps: int
    illegal_patterns: int
    jumps: int
    end_stops: int
    fastest: float
    pressed: bool


@dataclass(frozen=True)
class Move:
    """Both slides after a movement of one of them, in half steps."""

    cycle: int
    x: int
    z: int


@dataclass(frozen=True)
class Fault:
    """Something the motors could not or should not do; ``value`` as in ``enum vl_fault_kind``."""

    cycle: int
    axis: AxisName
    kind: FaultKind
    value: int


class Machine:
    """The mechanics behind the coil pins of the chip of this process."""

    def __init__(self, x: AxisOptions, z: AxisOptions) -> None:
        """Connect motors and switches to the pins of the chip."""
        self._native = library()
        self._options = {AxisName.X: x, AxisName.Z: z}
        self._native.vl_machine_attach()
        for name, options in self._options.items():
            self._setup(name, options)

    def _setup(self, name: AxisName, options: AxisOptions) -> None:
        setup = AxisSetupC(
            slide=options.start,
            backlash=options.backlash,
            slack=options.slack,
            switch_travel=options.switch_travel,
            switch_broken=int(options.switch_broken),
            stop_plus=options.switch_travel + options.beyond,
            stop_minus=-options.travel - options.beyond,
            pull_in=options.pull_in,
            pull_out=options.pull_out,
            acceleration=options.acceleration,
        )
        self._native.vl_axis_setup(int(name), ctypes.byref(setup))

    def axis(self, name: AxisName) -> AxisState:
        """Return the truth about an axis."""
        state = AxisStateC()
        self._native.vl_axis_read(int(name), ctypes.byref(state))
        return AxisState(
            state.slide / 2,
            state.slack / 2,
            state.rotor / 2,
            state.commanded / 2,
            int(state.steps),
            int(state.lost_steps),
            int(state.illegal_patterns),
            int(state.jumps),
            int(state.end_stops),
            float(state.fastest),
            bool(state.pressed),
        )

    def options(self, name: AxisName) -> AxisOptions:
        """Return what the axis was set up with."""
        return self._options[name]

    def break_switch_wire(self, name: AxisName, broken: bool = True) -> None:
        """Break or mend the wire of a limit switch: a broken one reads as pressed."""
        self._native.vl_switch_broken(int(name), int(broken), self._options[name].switch_travel)

    def short_probe(self, shorted: bool = True) -> None:
        """Connect tool and work by a chip or a chafed wire, or no longer."""
        self._native.vl_probe_short(int(shorted))

    def place(self, name: AxisName, start: int) -> None:
        """Put a slide somewhere else by hand, the rotor turned to where pattern 5 holds it."""
        self._options[name].start = start
        self._setup(name, self._options[name])

    def set_motor_power(self, on: bool) -> None:
        """Switch the motor supply; without it the rotors stay where they are."""
        self._native.vl_motor_power(int(on))

    def set_switch_quality(self, bounce_us: int = 0, noise_hz: int = 0, seed: int = 1) -> None:
        """Make the switches worse.

        Contacts bounce for ``bounce_us`` after each change; ``noise_hz`` pulses of 1 to 10 us per
        second come on their lines.
        """
        self._native.vl_switch_quality(bounce_us, noise_hz, seed)

    def take_moves(self) -> list[Move]:
        """Return and forget the movements of the slides so far."""
        entries = (MoveC * BATCH)()
        moves: list[Move] = []
        while count := self._native.vl_moves(entries, BATCH):
            moves += [Move(e.cycle, e.x, e.z) for e in entries[:count]]
        return moves

    def take_faults(self) -> list[Fault]:
        """Return and forget what went wrong so far."""
        entries = (FaultC * BATCH)()
        count = self._native.vl_faults(entries, BATCH)
        return [
            Fault(e.cycle, AxisName(e.axis), FaultKind(e.kind), e.value) for e in entries[:count]
        ]
