# SPDX-License-Identifier: Apache-2.0
"""Everything together: chip, cable, machine and workpiece, as tests and the command use it."""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from .chip import CYCLES_PER_SECOND, Chip, Drive, InterruptCost, NonVolatile, Stop
from .configuration import wrong_words
from .machine import AxisName, AxisOptions, Fault, FaultKind, Machine, Move
from .motor import PULL_IN, PULL_OUT
from .panel import TYPICAL_KHZ, Panel
from .part import WantedPart, read_part
from .report import write_report
from .serial_port import SerialPort
from .toolbox import Toolbox
from .usb_host import UsbHost
from .workpiece import SAME_STEP_CYCLES, Stock, Workpiece

BUTTONS = {"run": "RD4", "hold": "RD5", "stop": "RD6"}
ESTOP_PIN = "RD7"
PRESS_S = 0.1
SLICE_S = 0.02
#: With a contact sensor: as often as the firmware may look at it.
PROBE_SLICE_S = 0.001
STEP_NM = 7112
# The bar when nobody says anything: 1.000 inch thick, 2.000 inch free, in steps.
BAR_RADIUS, BAR_LENGTH = 1786, 7143
TRAVEL = {AxisName.X: 3575, AxisName.Z: 16072}
DEFAULT_FIRMWARE = Path(__file__).resolve().parents[2] / "build" / "firmware" / "tornillo.hex"


@dataclass
class Options:
    """The virtual machine. Lengths in full steps unless the name says mm.

    ``start_x`` and ``start_z`` are the slides' places when power comes; ``seed`` decides how much
    of the backlash is taken up then. ``cut_rate_limit`` is the fastest feed in steps/s that is
    not a crash. ``isr_limit`` is the longest high-priority interrupt allowed, in cycles.
    ``nose_radius_mm`` is that of every turning tool, else the part file says it; ``tool`` is the
    one in the holder at first, else the one the part needs first.
    ``dry_symbol`` names a variable of the firmware and ``dry_mask`` its bits that are set when the
    step stream has run dry; an empty name checks nothing. With ``probe`` the contact sensor is
    wired: RA1 is low while tool and work touch; what the tool has cut counts as gone after 1 ms.
    With ``panel`` display and keys are wired; ``panel_khz`` is the display's own clock.
    """

    firmware: Path = DEFAULT_FIRMWARE
    part: Path | None = None
    stock_diameter_mm: float | None = None
    stock_length_mm: float | None = None
    stock_allowance_mm: float | None = None
    nose_radius_mm: float | None = None
    tool: str = ""
    backlash_x: int = 0
    backlash_z: int = 0
    switch_travel_x: int = 0
    switch_travel_z: int = 0
    start_x: int = -400
    start_z: int = -900
    part_zero_x: int = -3575
    part_zero_z: int = -8000
    pull_in: float = PULL_IN
    pull_out: float = PULL_OUT
    acceleration: float = 0.0
    cut_rate_limit: float = 900.0
    isr_limit: int = 0
    dry_symbol: str = ""
    dry_mask: int = 0xFF
    probe: bool = False
    panel: bool = False
    panel_khz: float = TYPICAL_KHZ
    bounce_us: int = 0
    noise_hz: int = 0
    seed: int = 1
    usb: bool = True


@dataclass(frozen=True)
class Check:
    """A persistent expectation: its name and what broke it (empty = kept)."""

    name: str
    broken: tuple[str, ...]


def _settled(moves: list[Move], cycle: int) -> tuple[list[Move], list[Move]]:
    """Divide moves at a cycle, but what both slides do in one step is not torn apart."""
    at = sum(move.cycle <= cycle for move in moves)
    while 0 < at < len(moves) and moves[at].cycle - moves[at - 1].cycle < SAME_STEP_CYCLES:
        at -= 1
    return moves[:at], moves[at:]


class VirtualLathe:
    """A lathe with firmware in it, just switched on; time stands still until it is told to run."""

    def __init__(self, options: Options | None = None, memory: NonVolatile | None = None) -> None:
        """Build the lathe; ``memory`` is what an earlier one has kept."""
        self.options = options if options is not None else Options()
        self.chip = Chip(self.options.firmware)
        if memory is not None:
            self.chip.restore(memory)
        self.host = UsbHost(self.chip, self.run_to)
        self.port = SerialPort(self.host)
        self.machine = Machine(self._axis_options(AxisName.X), self._axis_options(AxisName.Z))
        self.machine.set_switch_quality(
            self.options.bounce_us, self.options.noise_hz, self.options.seed
        )
        self.wanted: WantedPart | None = (
            read_part(self.options.part) if self.options.part is not None else None
        )
        nose = self.options.nose_radius_mm
        self.toolbox = Toolbox(self.wanted, None if nose is None else nose * 1e6 / STEP_NM)
        if self.wanted is not None and nose is not None:
            self.wanted = replace(self.wanted, tools=self.toolbox.tools)
        self.workpiece = Workpiece(
            self._stock(),
            self.options.part_zero_x,
            self.options.part_zero_z,
            self.options.cut_rate_limit,
            self.toolbox.named(self.options.tool) if self.options.tool else self.toolbox.first,
        )
        if self.options.probe:
            self.workpiece.connect_probe()
        self._panel = (
            Panel(self.chip, self.run, self.options.panel_khz) if self.options.panel else None
        )
        self._held: list[Move] = []
        self.faults: list[Fault] = []
        self._furthest: dict[AxisName, tuple[float, float]] = {}
        self._timed: list[tuple[int, Callable[[], None]]] = []
        self._dry_at: list[str] = []
        self.wall_start = time.monotonic()
        self.chip.drive(ESTOP_PIN, Drive.LOW)
        for pin in BUTTONS.values():
            self.chip.drive(pin, Drive.OPEN)

    def _axis_options(self, name: AxisName) -> AxisOptions:
        options = self.options
        if name == AxisName.X:
            start, backlash, travel = options.start_x, options.backlash_x, options.switch_travel_x
        else:
            start, backlash, travel = options.start_z, options.backlash_z, options.switch_travel_z
        return AxisOptions(
            start=start,
            travel=TRAVEL[name],
            backlash=backlash,
            slack=random.Random(options.seed + int(name)).randint(0, backlash),
            switch_travel=travel,
            pull_in=options.pull_in,
            pull_out=options.pull_out,
            acceleration=options.acceleration,
        )

    def _stock(self) -> Stock:
        """The raw bar: as the options say, else as the part file says, else 1 by 2 inch."""
        part = self.wanted
        given = self.options

        def steps(mm: float | None, other: int) -> int:
            return other if mm is None else round(mm * 1e6 / STEP_NM)

        half = given.stock_diameter_mm
        return Stock(
            steps(None if half is None else half / 2, part.stock_radius if part else BAR_RADIUS),
            steps(given.stock_length_mm, part.length if part else BAR_LENGTH),
            steps(given.stock_allowance_mm, part.front if part else 0),
        )

    # -- time -------------------------------------------------------------------------------------

    @property
    def symbols(self) -> Any:
        """Addresses of firmware variables and functions by name."""
        return self.chip.symbols

    @property
    def seconds(self) -> float:
        """Simulated seconds since power-on."""
        return self.chip.seconds

    def run_to(self, cycle: int) -> Stop:
        """Run to a cycle; slides cut, timed actions happen on the way."""
        slice_s = PROBE_SLICE_S if self.options.probe else SLICE_S
        while True:
            now = self.chip.cycle
            self._run_timed(now)
            slice_end = min(cycle, now + round(slice_s * CYCLES_PER_SECOND))
            if self._timed:
                slice_end = min(slice_end, max(now + 1, self._timed[0][0]))
            reason = self.chip.run_to(slice_end)
            self._collect()
            if reason != Stop.CYCLE or self.chip.cycle >= cycle:
                return reason

    def run(self, seconds: float) -> None:
        """Let simulated time pass."""
        self.run_to(self.chip.cycle + round(seconds * CYCLES_PER_SECOND))

    def run_until(self, predicate: Callable[[], bool], timeout: float, every: float = 5e-3) -> bool:
        """Run until ``predicate()`` holds; False when ``timeout`` simulated seconds passed."""
        end = self.chip.cycle + round(timeout * CYCLES_PER_SECOND)
        while not predicate():
            if self.chip.cycle >= end:
                return False
            self.run_to(min(end, self.chip.cycle + round(every * CYCLES_PER_SECOND)))
        return True

    def at(self, seconds: float, action: Callable[[], None]) -> None:
        """Do something at a simulated time."""
        self._timed.append((round(seconds * CYCLES_PER_SECOND), action))
        self._timed.sort(key=lambda entry: entry[0])

    def _run_timed(self, now: int) -> None:
        while self._timed and self._timed[0][0] <= now:
            self._timed.pop(0)[1]()

    def _collect(self) -> None:
        moves = self._held + self.machine.take_moves()
        moves, self._held = _settled(moves, self.chip.cycle - SAME_STEP_CYCLES)
        self.workpiece.cut(moves)
        places = {AxisName.X: [m.x for m in moves], AxisName.Z: [m.z for m in moves]}
        for name, values in places.items():
            if values:
                low, high = self._furthest.get(name, (values[0] / 2, values[0] / 2))
                self._furthest[name] = min(low, min(values) / 2), max(high, max(values) / 2)
        self.faults += self.machine.take_faults()
        symbol = self.options.dry_symbol
        if symbol and not self._dry_at and self.chip.variable(symbol) & self.options.dry_mask:
            self._dry_at.append(f"seen at cycle {self.chip.cycle}")

    @property
    def panel(self) -> Panel:
        """Display and keys.

        Raises:
            RuntimeError: none is fitted.
        """
        if self._panel is None:
            raise RuntimeError("no panel is fitted: Options(panel=True) does it")
        return self._panel

    # -- hands ------------------------------------------------------------------------------------

    def press(self, button: str) -> None:
        """Do what a hand can do.

        ``run``, ``hold`` and ``stop`` are pressed for 0.1 s, ``estop`` stays in until
        ``release``; ``unplug`` and ``plug`` move the cable.

        Raises:
            ValueError: no such button.
        """
        if button in BUTTONS:
            self.chip.drive(BUTTONS[button], Drive.LOW)
            self.at(self.seconds + PRESS_S, lambda: self.chip.drive(BUTTONS[button], Drive.OPEN))
        elif button in ("estop", "release"):
            pushed = button == "estop"
            self.machine.set_motor_power(not pushed)
            self.chip.drive(ESTOP_PIN, Drive.OPEN if pushed else Drive.LOW)
        elif button == "plug":
            self.host.plug()
        elif button == "unplug":
            self.host.unplug()
        else:
            raise ValueError(f"no button {button!r}: run, hold, stop, estop, release")

    def plug(self) -> None:
        """Put the USB cable in and wait until the host has opened the serial port."""
        self.host.plug()
        self.host.enumerate()
        self.host.open_port()

    def unplug(self) -> None:
        """Pull the USB cable."""
        self.host.unplug()

    def change_tool(self, name: str = "") -> str:
        """Put a tool of the part into the holder, or the next one it needs; return its name.

        The slides should stand clear of the work, as they do when the machine waits for it.

        Raises:
            ValueError: no such tool.
        """
        tool = self.toolbox.named(name) if name else self.toolbox.after()
        self._collect()
        self.workpiece.change_tool(tool)
        return tool.name

    # -- judgement --------------------------------------------------------------------------------

    def lost_steps(self, name: AxisName) -> int:
        """Steps the motor of an axis has lost."""
        state = self.machine.axis(name)
        return max(state.lost_steps, round(abs(state.commanded - state.rotor)))

    def interrupt_cost(self) -> InterruptCost:
        """Cost of the step interrupt so far."""
        return self.chip.interrupt_cost(high=True)

    def checks(self) -> list[Check]:
        """Evaluate the expectations that must hold during every run."""
        by_kind: dict[FaultKind, list[str]] = {kind: [] for kind in FaultKind}
        for fault in self.faults:
            by_kind[fault.kind].append(f"{fault.axis.name} at cycle {fault.cycle}: {fault.value}")
        outside = [
            f"{name.name} {low:g}..{high:g}"
            for name, (low, high) in self._furthest.items()
            if low < -TRAVEL[name]
        ]
        cost = self.interrupt_cost()
        slow = [f"{cost.worst} cycles at cycle {cost.worst_at}"]
        kept = self.options.isr_limit == 0 or cost.worst <= self.options.isr_limit
        return [
            Check("coil pattern legal", tuple(by_kind[FaultKind.PATTERN])),
            Check("at most one full step at a time", tuple(by_kind[FaultKind.JUMP])),
            Check("no step lost", tuple(by_kind[FaultKind.LOST_STEP])),
            Check("no hard end touched", tuple(by_kind[FaultKind.END_STOP])),
            Check("slides inside the travel", tuple(outside)),
            Check("no crash", tuple(str(crash) for crash in self.workpiece.crashes)),
            Check("USB used by the book", tuple(self.host.mistakes)),
            Check("display by the book", tuple(self._panel.mistakes if self._panel else ())),
            Check("configuration words suit the board", tuple(self._wrong_words())),
            Check("step stream never dry", tuple(self._dry_at)),
            Check("step interrupt inside its window", () if kept else tuple(slow)),
        ]

    def _wrong_words(self) -> list[str]:
        hex_file = self.options.firmware
        return wrong_words(hex_file) if hex_file.suffix.lower() == ".hex" else []

    def broken_checks(self) -> list[Check]:
        """Return the expectations that did not hold."""
        return [check for check in self.checks() if check.broken]

    def report(self) -> dict[str, Any]:
        """Return the report as the contract wants it, for JSON."""
        self._collect()
        self.workpiece.cut(self._held)
        self._held = []
        return write_report(self, STEP_NM)
