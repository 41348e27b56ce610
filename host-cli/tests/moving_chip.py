# SPDX-License-Identifier: Apache-2.0
"""The scripted chip with slides that jog, go and touch."""

from scripted_chip import ScriptedChip, refuse

from tornillo.protocol import (
    REQUESTS,
    Alarm,
    Command,
    ErrorCode,
    SettingId,
    State,
    StatusInput,
)


class MovingChip(ScriptedChip):
    """Each move is seen under way by one STATUS and is over in the next.

    `surfaces`: where the touches find contact, one after the other, None for nowhere. `stops_at`:
    where somebody stops the next moves. `stuck`: the contact does not open again.
    """

    def __init__(self) -> None:
        """Nothing has moved yet."""
        super().__init__()
        self.rate = 0
        self.moves: list[tuple[Command, int, int]] = []
        self.surfaces: list[int | None] = []
        self.stops_at: tuple[int, int] | None = None
        self.trips: Alarm | None = None
        self.stuck = False

    def go(self, command: Command, place: tuple[int, int], inputs: int = 0) -> bytes:
        """Move to a place."""
        travels = (self.values[SettingId.TRAVEL_X], self.values[SettingId.TRAVEL_Z])
        if any(not -travel <= at <= 0 for travel, at in zip(travels, place, strict=True)):
            raise refuse(ErrorCode.OUT_OF_RANGE)
        self.moves.append((command, *place))
        x, z = self.stops_at or place
        state = State.TOUCHING if command is Command.TOUCH else State.MOVING
        self.status = self.status._replace(state=state)
        end = self.status._replace(state=State.IDLE, x=x, z=z, inputs=inputs)
        if self.trips is not None:
            end = end._replace(state=State.ALARM, alarm=self.trips, flags=0)
        self.coming = [self.status, end]
        return b""

    def do_jog(self, payload: bytes) -> bytes:
        """JOG."""
        x, z, self.rate, _patience = REQUESTS[Command.JOG].unpack(payload)
        return self.go(Command.JOG, (x, z))

    def do_goto(self, payload: bytes) -> bytes:
        """GOTO."""
        x, z, self.rate = REQUESTS[Command.GOTO].unpack(payload)
        return self.go(Command.GOTO, (x, z), StatusInput.CONTACT if self.stuck else 0)

    def do_touch(self, payload: bytes) -> bytes:
        """TOUCH."""
        x, z = REQUESTS[Command.TOUCH].unpack(payload)
        surface = self.surfaces.pop(0)
        along_x = x != self.status.x
        if surface is None:
            return self.go(Command.TOUCH, (x, z))
        self.go(Command.TOUCH, (x, z))
        self.coming[-1] = self.coming[-1]._replace(
            x=surface if along_x else x,
            z=z if along_x else surface,
            inputs=StatusInput.TOUCHED | StatusInput.CONTACT,
        )
        return b""

    def do_hold(self, payload: bytes) -> bytes:
        """HOLD: ends a jog or goto; whatever was to come does not."""
        if self.status.state != State.MOVING:
            return super().do_hold(payload)
        self.coming = []
        return self.do_stop(payload)

    def do_stop(self, payload: bytes) -> bytes:
        """STOP: whatever was to come does not."""
        self.coming = []
        return super().do_stop(payload)
