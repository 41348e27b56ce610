# SPDX-License-Identifier: Apache-2.0
"""The answer to STATUS with names instead of numbers."""

from dataclasses import dataclass

from tornillo.errors import AlarmError, LinkError
from tornillo.language import _
from tornillo.protocol import (
    PERMILLE_DONE,
    SLOT_NONE,
    Alarm,
    Axis,
    HomedAxis,
    MachineWarning,
    ResetCause,
    State,
    StatusData,
    StatusFlag,
    StatusInput,
)
from tornillo.protocol_texts import ALARM_TEXTS, WARNING_TEXTS

AXIS_ALARMS = frozenset(
    {
        Alarm.HOME_NOT_FOUND,
        Alarm.HOME_NOT_RELEASED,
        Alarm.LIMIT,
        Alarm.WRONG_SWITCH,
        Alarm.DEAD_STEPS_SPREAD,
        Alarm.STOPPED_HOMING,
        Alarm.HOME_OPENED_LATE,
        Alarm.PHASE_DRIFT,
        Alarm.SWITCH_WIRING,
    }
)
#: The other bits mean nothing to a host.
KNOWN_INPUTS = sum(StatusInput)


@dataclass(frozen=True)
class Status:
    """What the machine is doing.

    `x`, `z`: tool in machine steps. `dead_x`, `dead_z`: steps. `slot`: the running or selected
    part, None for none. `operation`, `pass_number`: from 1, 0 for none. `permille`: progress
    of the run, 1000 after a finished one. `spread_x`, `spread_z`: how much the counts of the last
    homing differed, steps.
    """

    state: State
    alarm: Alarm
    alarm_axis: Axis | None
    flags: StatusFlag
    x: int
    z: int
    dead_x: int
    dead_z: int
    slot: int | None
    operation: int
    operations: int
    pass_number: int
    passes: int
    permille: int
    reset_cause: ResetCause
    bad_frames: int
    uptime_ms: int
    stream_low: int
    spread_x: int
    spread_z: int
    homed_axes: HomedAxis
    warnings: MachineWarning
    inputs: StatusInput

    @classmethod
    def from_data(cls, data: StatusData) -> "Status":
        """Name the numbers; raises LinkError for one that this tornillo does not know."""
        values = data._asdict()
        detail = values.pop("alarm_detail")
        try:
            alarm = Alarm(data.alarm)
            values["state"] = State(data.state)
            values["reset_cause"] = ResetCause(data.reset_cause)
            axis = Axis(detail) if alarm in AXIS_ALARMS else None
        except ValueError as error:
            raise LinkError(
                _("the status of the lathe is unknown to this tornillo: {error}").format(
                    error=error
                ),
                _("use the tornillo version that belongs to this firmware"),
            ) from error
        values["alarm"] = alarm
        values["flags"] = StatusFlag(data.flags)
        values["inputs"] = StatusInput(data.inputs & KNOWN_INPUTS)
        values["homed_axes"] = HomedAxis(data.homed_axes)
        values["warnings"] = MachineWarning(data.warnings)
        values["slot"] = None if data.slot == SLOT_NONE else data.slot
        return cls(alarm_axis=axis, **values)

    @property
    def homed(self) -> bool:
        """Whether the position is trusted."""
        return StatusFlag.HOMED in self.flags

    @property
    def finished(self) -> bool:
        """Whether the machine stands still after a part was cut to its end."""
        return self.state is State.IDLE and self.permille == PERMILLE_DONE

    @property
    def moving(self) -> bool:
        """Whether the machine is homing, cutting, touching or on its way to a place."""
        return self.state in (State.HOMING, State.RUNNING, State.MOVING, State.TOUCHING)

    @property
    def contact(self) -> bool:
        """Whether the contact sensor is closed; never without one."""
        return StatusInput.CONTACT in self.inputs

    def position(self, axis: Axis) -> int:
        """Where the tool is on one axis, machine steps."""
        return self.x if axis is Axis.X else self.z

    @property
    def under_way(self) -> bool:
        """Whether a run has begun and not ended: it cuts, is held or pauses."""
        return self.state in (State.RUNNING, State.HOLD, State.PAUSE)

    @property
    def advice(self) -> list[str]:
        """The warnings in words, each with what to do about it."""
        texts = [WARNING_TEXTS[warning] for warning in MachineWarning if warning in self.warnings]
        return [f"{_(text.cause)}; {_(text.remedy)}" for text in texts]

    def alarm_error(self) -> AlarmError:
        """The alarm in words, with what to do about it."""
        text = ALARM_TEXTS[self.alarm]
        axis = (
            _(" of {alarm_axis}").format(alarm_axis=self.alarm_axis.name)
            if self.alarm_axis is not None
            else ""
        )
        return AlarmError(
            _("alarm {alarm}{axis}: {cause}").format(
                alarm=self.alarm.name, axis=axis, cause=_(text.cause)
            ),
            _(text.remedy),
        )
