# SPDX-License-Identifier: Apache-2.0
"""The lathe with our firmware, its machine, and the host library at the end of the cable.

Times are simulated seconds, positions machine steps. What must hold during every run is checked
when the test is through: see ``VirtualLathe.checks``. A test that provokes a fault names it with
:meth:`Bench.expect_broken`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from executed.record import RECORDER
from tornillo import Lathe, link
from tornillo.errors import ChipError
from tornillo.protocol import Alarm, Axis, ErrorCode, SettingId, State
from tornillo.status import Status
from virtual_lathe.chip import Chip, Drive, NonVolatile, Reset
from virtual_lathe.lathe import Options, VirtualLathe
from virtual_lathe.machine import AxisName, AxisState

from simulated.processes import at_the_end, in_any_case

#: Slides a few steps from their switches: homing is over in a second.
NEAR = Options(start_x=-30, start_z=-30)
HOMING_TIMEOUT_S = 60.0
#: Longer than from a reset through the boot loader to the first look at the inputs.
START_S = 0.1
#: The hardware stack has 31 levels; the design allows 20.
STACK_LEVELS_ALLOWED = 20
PIE2, CCP2IE = 0xFA0, 0x01
PINS = {"run": "RD4", "hold": "RD5", "stop": "RD6"}


class Bench:
    """A lathe that has just been switched on, cable out."""

    def __init__(self, memory: NonVolatile | None = None, **options: Any) -> None:
        """Switch it on; ``options`` are fields of ``Options``, slides near the switches."""
        self.lathe = VirtualLathe(dataclasses.replace(NEAR, **options), memory)
        self._host: Lathe | None = None
        self._expected: set[str] = set()
        if self.lathe.options.firmware == NEAR.firmware:
            in_any_case(RECORDER.add)
        at_the_end(self.assert_expectations)

    # -- parts ------------------------------------------------------------------------------------

    @property
    def chip(self) -> Chip:
        """The chip."""
        return self.lathe.chip

    @property
    def host(self) -> Lathe:
        """The host library, connected; plugs the cable in the first time."""
        if self._host is None:
            self._host = self.connect()
        return self._host

    def connect(self) -> Lathe:
        """Plug the cable in if it is out, and return a new host library on the port."""
        if not self.lathe.host.connected or not self.lathe.host.port_open:
            self.lathe.plug()
        # The library waits by the wall's clock; here by the simulated one.
        vars(link)["time"] = SimpleNamespace(monotonic=lambda: self.chip.seconds)
        self._host = Lathe(self.lathe.port)
        return self._host

    def unplug(self) -> None:
        """Pull the cable and forget the connection."""
        self.lathe.unplug()
        self._host = None

    def axis(self, name: AxisName | Axis) -> AxisState:
        """The truth about an axis."""
        return self.lathe.machine.axis(AxisName(int(name)))

    # -- state, read from memory so that it costs no time -----------------------------------------

    @property
    def state(self) -> State:
        """The machine's state."""
        return State(self.chip.variable("machine_state"))

    def is_in(self, state: State) -> bool:
        """Whether the machine is in a state now."""
        return self.state is state

    @property
    def alarm(self) -> tuple[Alarm, int]:
        """The alarm and its detail."""
        code = self.chip.variable("machine_alarm")
        return Alarm(code), self.chip.variable("machine_alarm_detail")

    @property
    def homed(self) -> bool:
        """Whether the chip trusts its position."""
        return self.chip.variable("machine_homed") != 0

    @property
    def moving(self) -> bool:
        """Whether steps are due."""
        return bool(self.chip.variable("stream_flags") & 1)

    @property
    def position(self) -> tuple[int, int]:
        """Tool position as the chip counts it, X and Z."""
        return (
            self.chip.variable("position_x", 2, signed=True),
            self.chip.variable("position_z", 2, signed=True),
        )

    def status(self) -> Status:
        """The answer to STATUS."""
        return self.host.status()

    # -- actions ----------------------------------------------------------------------------------

    def run(self, seconds: float) -> None:
        """Let time pass."""
        self.lathe.run(seconds)

    def wait(self, predicate: Callable[[], bool], timeout: float, every: float = 2e-3) -> None:
        """Let time pass until ``predicate()`` holds; fails after ``timeout`` s."""
        assert self.lathe.run_until(predicate, timeout, every), (
            f"still {self.state.name}, alarm {self.alarm}, at {self.position} after {timeout} s"
        )

    def wait_for(self, state: State, timeout: float = HOMING_TIMEOUT_S) -> None:
        """Let time pass until the machine is in ``state``."""
        self.wait(lambda: self.state is state, timeout)

    def press(self, button: str, seconds: float = 0.02) -> None:
        """Press a button for some time and let it go."""
        self.chip.drive(PINS[button], Drive.LOW)
        self.run(seconds)
        self.chip.drive(PINS[button], Drive.OPEN)
        self.run(0.01)

    def home(self) -> None:
        """Home by command and wait for the end, which must be good."""
        self.host.home()
        self.wait(lambda: self.state is not State.HOMING, HOMING_TIMEOUT_S)
        assert self.alarm == (Alarm.NONE, 0)
        assert self.homed

    def set(self, **values: int) -> None:
        """Set settings by name."""
        for name, value in values.items():
            self.host.set_setting(SettingId[name.upper()], value)

    def abort_stream(self) -> None:
        """Do to the step stream what the 1 ms interrupt does when something stops it."""
        chip = self.chip
        chip.write(PIE2, chip.read(PIE2) & ~CCP2IE)
        chip.set_variable("stream_tail", chip.variable("stream_head"))
        chip.set_variable("stream_next", 0)
        chip.set_variable("stream_flags", 0)

    def power_cycle(self, seed: int = 1) -> None:
        """Take the power away for long and bring it back; flash and EEPROM stay."""
        self._host = None
        self.lathe.unplug()
        self.chip.fill_ram(seed)
        self.chip.reset(Reset.POWER_ON)

    def exchange_screw(self, axis: Axis, dead: int, switch_travel: int) -> None:
        """Give an axis other dead steps and another switch; no power. The slide goes near to it."""
        options = self.lathe.machine.options(AxisName(int(axis)))
        options.backlash, options.slack, options.switch_travel = dead, 0, switch_travel
        self.lathe.machine.place(AxisName(int(axis)), NEAR.start_x)

    def refusal(self, action: Callable[[], object]) -> ErrorCode:
        """The error code the chip answers an action with; OK when it does it."""
        try:
            action()
        except ChipError as error:
            return error.code
        return ErrorCode.OK

    # -- judgement --------------------------------------------------------------------------------

    def expect_broken(self, *names: str) -> None:
        """Say which of the persistent expectations this test breaks on purpose."""
        self._expected |= set(names)

    def assert_expectations(self) -> None:
        """Check the persistent expectations."""
        broken = [c for c in self.lathe.broken_checks() if c.name not in self._expected]
        assert broken == []
        assert self.chip.nonvolatile_counts["broken_unlocks"] == 0
        assert self.chip.stack_depth_max <= STACK_LEVELS_ALLOWED
