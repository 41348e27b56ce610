# SPDX-License-Identifier: Apache-2.0
"""A small model of the chip behind a serial port, for tests of the host alone.

It stores, selects and judges parts and answers as the protocol page says; it does not cut.
Faults are set by the test: lost or damaged answers, refusals, a pulled cable.
"""

from collections.abc import Callable
from struct import Struct

from serial import SerialTimeoutException

from tornillo.errors import ChipError
from tornillo.frames import Frame, FrameError, crc16, decode, encode
from tornillo.machine import Machine
from tornillo.opening import WRITE_TIMEOUT_S
from tornillo.protocol import (
    FRAME_RESPONSE_BIT,
    IMAGE_HEADER,
    OVERRIDE_MAX,
    OVERRIDE_MIN,
    PART_IMAGE_MAX,
    PART_SLOTS,
    PART_UNIT,
    PROTOCOL_VERSION,
    REQUESTS,
    RESPONSES,
    SETTINGS,
    SLOT_NONE,
    UPLOAD_PIECE_MAX,
    Alarm,
    Axis,
    Command,
    ErrorCode,
    HelloData,
    HomedAxis,
    ImageHeader,
    ProgressData,
    ResetCause,
    RunFlag,
    SettingId,
    State,
    StatusData,
    StatusFlag,
)
from tornillo.rules import verdict

IDLE = StatusData(
    state=State.IDLE,
    alarm=Alarm.NONE,
    alarm_detail=0,
    flags=StatusFlag.HOMED,
    x=-1789,
    z=-8000,
    dead_x=23,
    dead_z=31,
    slot=SLOT_NONE,
    operation=0,
    operations=0,
    pass_number=0,
    passes=0,
    permille=0,
    reset_cause=ResetCause.POWER_ON,
    bad_frames=0,
    uptime_ms=1000,
    stream_low=4,
    spread_x=0,
    spread_z=1,
    homed_axes=HomedAxis.X | HomedAxis.Z,
    warnings=0,
    inputs=0,
)
NOTHING_BEGUN = ProgressData(slot=SLOT_NONE, crc=0, operation=0, pass_number=0)


def refuse(code: ErrorCode, command: Command = Command.STATUS) -> ChipError:
    """The refusal that a command of the model raises."""
    return ChipError(command, code)


def units(image: bytes) -> int:
    """Units of the store that an image takes."""
    return -(-(len(image) + 64) // PART_UNIT)


class ScriptedChip:
    """What the chip knows, and the faults of the test."""

    def __init__(self) -> None:
        """An idle, homed lathe without parts."""
        self.values = {entry.id: entry.default for entry in SETTINGS}
        self.slots: dict[int, bytes] = {}
        self.selected = SLOT_NONE
        self.status = IDLE
        self.coming: list[StatusData] = []
        self.at_status: Callable[[], None] = lambda: None
        self.protocol = PROTOCOL_VERSION
        self.firmware = (0, 1, 0)
        self.serial = b"T0000001"
        self.ranges: dict[SettingId, tuple[int, int]] = {}
        self.busy_at: SettingId | None = None
        self.unknown: set[Command] = set()
        self.refusals: dict[Command, bytes] = {}
        self.wrong_crc = False
        self.executed: list[Command] = []
        self.feed_percent = 100
        self.step = False
        self.resumed = False
        self.progress = NOTHING_BEGUN
        self.homed_axes = 0
        self.zeroed: list[tuple[int, int]] = []
        self.upload: bytearray | None = None
        self.wanted = (0, 0)

    def execute(self, command: Command, payload: bytes) -> bytes:
        """Run one request and return the response payload."""
        self.executed.append(command)
        if command in self.unknown:
            return bytes([ErrorCode.UNKNOWN_COMMAND])
        if command in self.refusals:
            return self.refusals[command]
        try:
            answer = getattr(self, f"do_{command.name.lower()}")(payload)
        except ChipError as error:
            detail = () if error.reason is None else (error.reason, error.operation)
            return bytes([error.code, *detail])
        return b"\0" + bytes(answer)

    def machine(self) -> Machine:
        """What HELLO tells."""
        data = HelloData(*RESPONSES[Command.HELLO].unpack(self.do_hello(b"")))
        spindle = self.values[SettingId.SPINDLE_MIN], self.values[SettingId.SPINDLE_MAX]
        return Machine.from_hello(data, *spindle)

    def do_hello(self, _payload: bytes) -> bytes:
        """HELLO."""
        v = self.values
        return RESPONSES[Command.HELLO].pack(
            *(self.protocol, *self.firmware, PART_SLOTS, PART_IMAGE_MAX),
            *(v[SettingId.STEP_X_NM], v[SettingId.STEP_Z_NM]),
            *(v[SettingId.TRAVEL_X], v[SettingId.TRAVEL_Z]),
            *(v[SettingId.ZERO_X], v[SettingId.ZERO_Z]),
            self.serial,
            min(v[SettingId.RAPID_RATE_X], v[SettingId.RAPID_RATE_Z]),
        )

    def do_status(self, _payload: bytes) -> bytes:
        """STATUS; each one brings the next of `coming`, after `at_status()`."""
        self.at_status()
        if self.coming:
            self.status = self.coming.pop(0)
        return RESPONSES[Command.STATUS].pack(*self.status)

    def do_home(self, payload: bytes) -> bytes:
        """HOME."""
        self.homed_axes = payload[0]
        self.status = self.status._replace(state=State.HOMING)
        return b""

    def do_run(self, payload: bytes) -> bytes:
        """RUN."""
        slot = self.selected if payload[0] == SLOT_NONE else payload[0]
        self.resumed = bool(payload[1] & RunFlag.RESUME)
        if self.resumed:
            slot = self.progress.slot
            if slot == SLOT_NONE:
                raise refuse(ErrorCode.NOTHING_TO_RESUME)
        if slot not in self.slots:
            raise refuse(ErrorCode.NO_PART)
        self.status = self.status._replace(state=State.RUNNING, slot=slot)
        self.feed_percent = 100
        self.step = bool(payload[1] & RunFlag.STEP)
        return b""

    def do_progress(self, _payload: bytes) -> bytes:
        """PROGRESS."""
        return RESPONSES[Command.PROGRESS].pack(*self.progress)

    def do_hold(self, _payload: bytes) -> bytes:
        """HOLD."""
        if self.status.state != State.RUNNING:
            raise refuse(ErrorCode.NOT_RUNNING)
        self.status = self.status._replace(state=State.HOLD)
        return b""

    def do_resume(self, _payload: bytes) -> bytes:
        """RESUME."""
        if self.status.state not in (State.HOLD, State.PAUSE):
            raise refuse(ErrorCode.NOT_RUNNING)
        self.status = self.status._replace(state=State.RUNNING)
        return b""

    def do_override(self, payload: bytes) -> bytes:
        """OVERRIDE."""
        if not OVERRIDE_MIN <= payload[0] <= OVERRIDE_MAX:
            raise refuse(ErrorCode.OUT_OF_RANGE)
        if self.status.state not in (State.RUNNING, State.HOLD):
            raise refuse(ErrorCode.NOT_RUNNING)
        self.feed_percent = payload[0]
        return b""

    def do_stop(self, _payload: bytes) -> bytes:
        """STOP."""
        self.status = self.status._replace(state=State.IDLE)
        return b""

    def do_reset(self, _payload: bytes) -> bytes:
        """RESET."""
        self.status = self.status._replace(state=State.IDLE, alarm=Alarm.NONE)
        return b""

    def do_zero(self, payload: bytes) -> bytes:
        """ZERO."""
        axis, value = REQUESTS[Command.ZERO].unpack(payload)
        self.zeroed.append((axis, value))
        here = self.status.x if axis == Axis.X else self.status.z
        setting = SettingId.ZERO_X if axis == Axis.X else SettingId.ZERO_Z
        self.values[setting] = here - value
        return b""

    def room(self, length: int) -> int:
        """The first of enough free units side by side."""
        taken = {
            unit for slot, image in self.slots.items() for unit in range(slot, slot + units(image))
        }
        needed = units(bytes(length))
        for slot in range(PART_SLOTS - needed + 1):
            if taken.isdisjoint(range(slot, slot + needed)):
                return slot
        raise refuse(ErrorCode.STORE_FULL)

    def do_upload_begin(self, payload: bytes) -> bytes:
        """UPLOAD_BEGIN."""
        self.wanted = REQUESTS[Command.UPLOAD_BEGIN].unpack(payload)
        self.room(self.wanted[0])
        self.upload = bytearray()
        return b""

    def do_upload_data(self, payload: bytes) -> bytes:
        """UPLOAD_DATA."""
        offset = int.from_bytes(payload[:2], "little")
        if self.upload is None:
            raise refuse(ErrorCode.NO_UPLOAD)
        if offset != len(self.upload) or offset % UPLOAD_PIECE_MAX:
            raise refuse(ErrorCode.BAD_OFFSET)
        self.upload += payload[2:]
        return b""

    def do_upload_commit(self, _payload: bytes) -> bytes:
        """UPLOAD_COMMIT."""
        if self.upload is None:
            raise refuse(ErrorCode.NO_UPLOAD)
        image = bytes(self.upload)
        if (len(image), crc16(image)) != self.wanted:
            raise refuse(ErrorCode.CRC_MISMATCH)
        found = verdict(image, self.machine())
        if found is not None:
            code, command = ErrorCode.INVALID_PART, Command.UPLOAD_COMMIT
            raise ChipError(command, code, found.refusal, found.operation)
        slot = self.room(len(image))
        self.slots[slot] = image
        crc = crc16(image) ^ self.wrong_crc
        return RESPONSES[Command.UPLOAD_COMMIT].pack(slot, crc)

    def do_part_info(self, payload: bytes) -> bytes:
        """PART_INFO."""
        slot = payload[0]
        image = self.slots.get(slot)
        if image is None:
            return bytes(RESPONSES[Command.PART_INFO].size)
        header = ImageHeader(*IMAGE_HEADER.unpack_from(image))
        return RESPONSES[Command.PART_INFO].pack(
            *(1, slot == self.selected, slot + 1, len(image), crc16(image)),
            *(header.operation_count, header.name),
        )

    def do_part_read(self, payload: bytes) -> bytes:
        """PART_READ."""
        slot, offset = REQUESTS[Command.PART_READ].unpack(payload)
        return self.slots[slot][offset : offset + UPLOAD_PIECE_MAX]

    def do_part_select(self, payload: bytes) -> bytes:
        """PART_SELECT."""
        self.selected = payload[0]
        return b""

    def do_part_delete(self, payload: bytes) -> bytes:
        """PART_DELETE."""
        del self.slots[payload[0]]
        return b""

    def do_setting_get(self, payload: bytes) -> bytes:
        """SETTING_GET."""
        entry = SETTINGS[payload[0]]
        value = self.values[entry.id]
        low, high = self.ranges.get(entry.id, (entry.minimum, entry.maximum))
        return RESPONSES[Command.SETTING_GET].pack(value, low, high)

    def do_setting_set(self, payload: bytes) -> bytes:
        """SETTING_SET."""
        number, value = Struct("<Bi").unpack(payload)
        if number == self.busy_at:
            raise refuse(ErrorCode.BUSY)
        self.values[SettingId(number)] = value
        return b""

    def do_serial_set(self, payload: bytes) -> bytes:
        """SERIAL_SET."""
        if self.status.state in (State.HOMING, State.RUNNING, State.HOLD, State.PAUSE):
            raise refuse(ErrorCode.BUSY)
        self.serial = payload
        return b""


class ScriptedPort:
    """A serial port with the chip behind it; has what `tornillo.link.Transport` asks for.

    `now` is its clock in seconds: only waiting for an answer that does not come takes time, and
    each write its `write_seconds`, a blocked one as long as a real port.
    """

    def __init__(self, chip: ScriptedChip) -> None:
        """Connect `chip`."""
        self.chip = chip
        self.timeout: float | None = None
        self.now = 0.0
        self.closed = False
        self.unplugged = False
        self.blocked_writes = 0
        self.write_seconds = 0.0
        self.lose_answers = 0
        self.damage_answers = 0
        self.noise = b""
        self.requests: list[Frame] = []
        self._previous: tuple[Frame, bytes] | None = None
        self._incoming = bytearray()
        self._outgoing = bytearray()

    def read(self, size: int = 1, /) -> bytes:
        """Take from the answers."""
        if self.unplugged:
            raise OSError("device disconnected")
        if not self._outgoing and self.timeout is not None:
            self.now += self.timeout
        data = bytes(self._outgoing[:size])
        del self._outgoing[:size]
        return data

    @property
    def in_waiting(self) -> int:
        """Bytes that can be read at once."""
        return len(self._outgoing)

    def write(self, data: bytes, /) -> int:
        """Give requests to the chip; half of one when the write is blocked."""
        if self.unplugged:
            raise OSError("device disconnected")
        if self.blocked_writes:
            self.blocked_writes -= 1
            self.now += WRITE_TIMEOUT_S
            self._incoming += data[: len(data) // 2]
            raise SerialTimeoutException("Write timeout")
        self.now += self.write_seconds
        self._incoming += data
        while b"\0" in self._incoming:
            encoded, _, rest = self._incoming.partition(b"\0")
            self._incoming = bytearray(rest)
            self._receive(bytes(encoded))
        return len(data)

    def inject(self, data: bytes) -> None:
        """Let the host receive `data` next."""
        self._outgoing += data

    def close(self) -> None:
        """Remember that the host closed the port."""
        self.closed = True

    def _receive(self, encoded: bytes) -> None:
        """Answer one frame as the chip does."""
        try:
            frame = decode(encoded)
        except FrameError:
            return
        self.requests.append(frame)
        if self._previous is not None and self._previous[0] == frame:
            payload = self._previous[1]
        else:
            payload = self.chip.execute(Command(frame.code), frame.payload)
            self._previous = None if frame.code == Command.HELLO else (frame, payload)
        if self.lose_answers > 0:
            self.lose_answers -= 1
            return
        answer = bytearray(encode(Frame(frame.seq, frame.code | FRAME_RESPONSE_BIT, payload)))
        if self.damage_answers > 0:
            self.damage_answers -= 1
            answer[2] ^= 0x55
        self._outgoing += self.noise + answer
