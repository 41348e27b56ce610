# SPDX-License-Identifier: Apache-2.0
"""What `tornillo watch` shows: the status in words and numbers, line by line."""

import math

from tornillo.language import _, later
from tornillo.machine import Machine
from tornillo.plan_report import show_time
from tornillo.protocol import State, StatusFlag
from tornillo.protocol_texts import ALARM_TEXTS
from tornillo.remaining import Remaining
from tornillo.status import Status
from tornillo.units import NM_PER_UNIT, SECONDS_PER_MINUTE, Scale

STATES = {
    State.IDLE: later("waiting"),
    State.HOMING: later("homing"),
    State.RUNNING: later("cutting"),
    State.HOLD: later("held"),
    State.ALARM: later("ALARM"),
    State.PAUSE: later("pausing"),
    State.MOVING: later("moving"),
    State.TOUCHING: later("touching"),
}
#: What the flags of the status are called at the machine.
INPUTS = (
    (StatusFlag.ESTOP, later("emergency stop")),
    (StatusFlag.SWITCH_X, later("limit switch X")),
    (StatusFlag.SWITCH_Z, later("limit switch Z")),
    (StatusFlag.BUTTON_RUN, later("RUN")),
    (StatusFlag.BUTTON_HOLD, later("HOLD")),
    (StatusFlag.BUTTON_STOP, later("STOP")),
)


class Readout:
    """Remembers what one status does not tell: speed, override, the plan of the part."""

    def __init__(self, machine: Machine, units: str) -> None:
        """Positions are shown in `units`, mm or inch, and in steps."""
        self.scale = Scale(units, machine)
        self.percent: int | None = None
        self.remaining: Remaining | None = None
        self._before: Status | None = None
        self._speed = 0.0

    def follow(self, status: Status) -> None:
        """Take the next status into account."""
        before = self._before
        if before is not None and status.uptime_ms > before.uptime_ms:
            seconds = (status.uptime_ms - before.uptime_ms) / 1000
            machine = self.scale.machine
            way = math.hypot(
                (status.x - before.x) * machine.step_x_nm,
                (status.z - before.z) * machine.step_z_nm,
            )
            self._speed = way / NM_PER_UNIT[self.scale.units] / seconds * SECONDS_PER_MINUTE
        began = before is not None and not before.under_way and status.under_way
        if began or not status.under_way:
            self.percent = 100
        elif before is None:
            self.percent = None
        self._before = status

    def place(self, status: Status) -> tuple[float, float]:
        """Diameter and z of the tool from part zero, in units."""
        machine = self.scale.machine
        return (
            self.scale.diameter(status.x - machine.zero_x),
            self.scale.length(status.z - machine.zero_z),
        )

    def rows(self, status: Status, part: str) -> list[tuple[str, str]]:
        """Label and value of every line; `part` is the name of the part."""
        rows = [(_("state"), _(STATES.get(status.state, status.state.name.lower())))]
        if status.state is State.ALARM:
            rows += self._alarm(status)
        rows += self._position(status)
        if part:
            rows.append((_("part"), part))
        if status.under_way:
            rows += self._progress(status)
        dead = _("X {x}, Z {z} steps").format(x=status.dead_x, z=status.dead_z)
        rows.append((_("dead steps"), dead))
        pressed = [_(name) for flag, name in INPUTS if flag in status.flags]
        if pressed:
            rows.append((_("pressed"), ", ".join(pressed)))
        return rows

    def _alarm(self, status: Status) -> list[tuple[str, str]]:
        """What happened and what to do."""
        text = ALARM_TEXTS[status.alarm]
        return [(_("alarm"), str(status.alarm_error())), (_("to do"), _(text.remedy))]

    def _position(self, status: Status) -> list[tuple[str, str]]:
        """Where the tool is."""
        steps = _("X {x}, Z {z} steps").format(x=status.x, z=status.z)
        if not status.homed:
            return [(_("tool"), _("unknown: not homed")), (_("machine"), steps)]
        diameter, z = self.place(status)
        show = self.scale.show
        return [
            (_("diameter"), show(diameter)),
            ("z", show(z)),
            (_("machine"), steps),
            (_("speed"), self._per_minute(self._speed)),
        ]

    def _progress(self, status: Status) -> list[tuple[str, str]]:
        """How far the run is."""
        of = _("{number} of {count}")
        rows = [
            (_("operation"), of.format(number=status.operation, count=status.operations)),
            (_("pass"), of.format(number=status.pass_number, count=status.passes)),
        ]
        known = self.percent
        feed = None if self.remaining is None else self.remaining.feed(status)
        if feed is not None:
            rows.append((_("feed"), self._feed(self.scale.per_minute(feed), known)))
        rows.append((_("override"), _("unknown") if known is None else f"{known} %"))
        rows.append((_("done"), f"{status.permille / 10:.1f} %"))
        if self.remaining is not None:
            left = self.remaining.seconds(status, known or 100)
            rows.append((_("time left"), show_time(left)))
        return rows

    def _feed(self, programmed: float, percent: int | None) -> str:
        """The feed that is wanted, and what the override makes of it."""
        if percent in (None, 100):
            return self._per_minute(programmed)
        assert percent is not None
        made = self._per_minute(programmed * percent / 100)
        return _("{made} of {programmed}").format(
            made=made, programmed=self._per_minute(programmed)
        )

    def _per_minute(self, speed: float) -> str:
        """A speed with its unit."""
        return f"{speed:.3g} {self.scale.units}/min"
