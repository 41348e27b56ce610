# SPDX-License-Identifier: Apache-2.0
"""How fast the firmware can go, and how exact in time it is, with a computer asking for status.

Rates are entries of the step stream per second: steps of the axis that moves more.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from typing import Any

from motion.reference import Line, Segment, arc_between
from motion.rig import MotionFault, Rig
from motion.trace import judge_all
from tornillo.frames import Frame, encode
from tornillo.protocol import Command, State
from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.panel import KEYS, Panel
from virtual_lathe.worker import in_new_process

STATUS_HZ = 20
JITTER_STATUS_HZ = 100
HIGH_VECTOR = 0x0008
CCPR2L, TMR1L = 0xFBB, 0xFCE
START_RATE = 20_000
# Beyond the range of the setting, so that the ramp does not limit what is measured.
ACCELERATION = 60_000
TOP = 65_000
HIGHEST = 64_000
RESOLUTION = 500
SETTLED = 0.01
CYCLES_PER_US = 12
JITTER_RATE = 5_000
SLICE_CYCLES = 12_000
# The panel: its setting by number, the time it takes to start, and how long a key is down and up.
PANEL, ENGLISH, PANEL_STARTED_S = 34, 1, 0.7
KEY_SLICES = 60


class Poller:
    """Asks for the status at a steady rate and counts the answers."""

    def __init__(self, rig: Rig, hertz: int) -> None:
        """Ask ``hertz`` times a second from now on."""
        self.rig = rig
        self.interval = CYCLES_PER_SECOND // hertz
        self.next = rig.chip.cycle
        self.sent = 0
        self.answers = 0

    def poll(self) -> None:
        """Send a request when it is time to, and take what has come."""
        host = self.rig.host
        assert host is not None
        self.answers += host.receive().count(0)
        if self.rig.chip.cycle >= self.next:
            self.next += self.interval
            self.sent += 1
            host.send(b"\0" + encode(Frame(self.sent & 0xFF, Command.STATUS, b"")))


def hello(rig: Rig) -> None:
    """Begin a conversation as a program does."""
    assert rig.host is not None
    rig.host.send(b"\0" + encode(Frame(0, Command.HELLO, b"")))
    rig.run(0.02)
    rig.host.receive()


def arc_chain(rate: float, turns: int) -> list[Segment]:
    """Circles of radius 700 in quarters of a turn and a bit, one after the other."""
    quarters = [arc_between(700, k * math.pi / 2, math.pi / 2, True, rate) for k in range(4)]
    return [quarters[k % 4] for k in range(4 * turns)]


def line_chain(rate: float, entries: int) -> list[Segment]:
    """Two-axis lines of slope 0.7, one behind the other; the chip's 16 bits may wrap."""
    return [Line(14_000, -20_000, rate)] * max(1, entries // 20_000)


def sustained(rig: Rig, chain: Sequence[Segment], rate: float) -> tuple[float, float]:
    """Run a chain at a path rate while status is polled.

    Returns:
        entries/s and path steps/s in the second half of the chain; (0, 0) when the stream ran
        dry, an answer is missing or the path rate is more than 1 % off.
    """
    poller = Poller(rig, STATUS_HZ)
    rig.start(chain)
    while rig.state not in (State.IDLE, State.ALARM):
        poller.poll()
        rig.run(1e-3)
    trace = rig.trace()
    if rig.state == State.ALARM or poller.answers < poller.sent - 1:
        rig.recover()
        return 0.0, 0.0
    first, last = len(trace.times) // 2, int(len(trace.times) * 0.95)
    seconds = (trace.times[last] - trace.times[first]) / CYCLES_PER_SECOND
    lengths = [length for _, judged in judge_all(trace, chain) for length in judged.lengths]
    path_rate = sum(lengths[first + 1 : last + 1]) / seconds
    if abs(path_rate / rate - 1.0) > SETTLED:
        return 0.0, 0.0
    return (last - first) / seconds, path_rate


def highest(rig: Rig, chain_of: Callable[[float], Sequence[Segment]]) -> tuple[float, float]:
    """The highest rate that is sustained, to about 500 path steps/s: entries/s, path steps/s."""
    low, high = START_RATE, HIGHEST
    best = (0.0, 0.0)
    while high - low > RESOLUTION:
        rate = (low + high) // 2
        rig.quick(rate, ACCELERATION, top=TOP)
        found = sustained(rig, chain_of(rate), rate)
        if found[0] > 0.0:
            low, best = rate, found
        else:
            high = rate
    return best


class Fingers:
    """Somebody who presses all keys of the panel, one after the other."""

    def __init__(self, rig: Rig) -> None:
        """Fit a panel and let its display start."""
        self.panel = Panel(rig.chip, rig.run)
        rig.chip.poke(rig.symbols.ram("settings") + 2 * PANEL, ENGLISH)
        rig.run(PANEL_STARTED_S)
        self.slices = 0

    def move(self) -> None:
        """Called once a millisecond."""
        self.slices += 1
        key, phase = divmod(self.slices, 2 * KEY_SLICES)
        if phase == 0:
            self.panel.hold(KEYS[key % len(KEYS)])
        elif phase == KEY_SLICES:
            self.panel.release()


def worst_lateness(
    rig: Rig, chain: Sequence[Segment], fingers: Fingers | None = None
) -> tuple[float, int]:
    """Run a chain with busy USB and compare each step with the time computed for it.

    The computed time is the compare value that raised the step interrupt; the real one is when
    the coils change. A delay that is the same for every step does not count.

    Returns:
        largest less smallest delay in microseconds, and the number of steps.
    """
    chip = rig.chip
    offset = (chip.read(TMR1L) | chip.read(TMR1L + 1) << 8) - chip.cycle
    poller = Poller(rig, JITTER_STATUS_HZ)
    rig.start(chain)
    planned: list[int] = []
    chip.set_break(HIGH_VECTOR)
    slice_end = chip.cycle
    while rig.state not in (State.IDLE, State.ALARM):
        if chip.cycle >= slice_end:
            poller.poll()
            if fingers is not None:
                fingers.move()
            slice_end = chip.cycle + SLICE_CYCLES
        chip.run_to(slice_end)
        if chip.pc == HIGH_VECTOR:
            late = (chip.cycle + offset - chip.peek(CCPR2L, 2)) & 0xFFFF
            planned.append(chip.cycle - late)
        elif rig.asks:
            rig.answer()
    chip.set_break(HIGH_VECTOR, False)
    times = rig.trace().times
    if rig.state == State.ALARM or poller.answers < poller.sent - 1:
        raise MotionFault("the chain failed while its times were taken")
    delays = [step - planned[bisect_right(planned, step) - 1] for step in times]
    return (max(delays) - min(delays)) / CYCLES_PER_US, len(delays)


def _measure() -> dict[str, Any]:
    rig = Rig(usb=True)
    hello(rig)
    rig.chip.clear_statistics()
    line = highest(rig, lambda rate: line_chain(rate, 60_000))
    arc = highest(rig, lambda rate: arc_chain(rate, 8))
    rig.quick(JITTER_RATE)
    jitters = [
        worst_lateness(rig, [Line(-4_000, 2_900, JITTER_RATE)]),
        worst_lateness(rig, arc_chain(JITTER_RATE, 1)),
    ]
    cost = rig.chip.interrupt_cost(high=True)
    return {
        "line_max_rate_hz": round(line[0]),
        "line_max_path_rate": round(line[1]),
        "arc_max_rate_hz": round(arc[0]),
        "arc_max_path_rate": round(arc[1]),
        "jitter_max_us": max(jitter for jitter, _ in jitters),
        "jitter_steps": sum(steps for _, steps in jitters),
        "isr_worst_cycles": cost.worst,
        "isr_mean_cycles": round(cost.mean, 1),
    }


def _measure_panel() -> dict[str, Any]:
    rig = Rig(usb=True)
    hello(rig)
    fingers = Fingers(rig)
    rig.quick(JITTER_RATE)
    jitters = [
        worst_lateness(rig, [Line(-4_000, 2_900, JITTER_RATE)], fingers),
        worst_lateness(rig, arc_chain(JITTER_RATE, 1), fingers),
    ]
    if fingers.panel.mistakes or not fingers.panel.lines()[0].strip():
        raise MotionFault("the panel was not in use")
    return {"jitter_max_us_panel": max(jitter for jitter, _ in jitters)}


def rates() -> dict[str, Any]:
    """Measure rates, exactness in time and the cost of the step interrupt."""
    return in_new_process(_measure) | in_new_process(_measure_panel)
