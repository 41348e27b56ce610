# SPDX-License-Identifier: Apache-2.0
"""Numbers shared with the chip: frames, commands, codes, part image, settings.

Generated from protocol.toml by generate_protocol.py: do not edit.
"""

from enum import IntEnum, IntFlag
from struct import Struct
from typing import NamedTuple

PROTOCOL_VERSION = 3
FIRMWARE_VERSION = "0.1.0"
USB_VENDOR_ID = 0x1209
USB_PRODUCT_ID = 0x0001
USB_LOADER_PRODUCT_ID = 0x0002
FRAME_PAYLOAD_MAX = 56
FRAME_TIMEOUT_MS = 250
FRAME_TRIES = 5
FRAME_RESPONSE_BIT = 0x80
CRC16_POLYNOMIAL = 0x1021
CRC16_INITIAL = 0xFFFF
CRC16_CHECK = 0x29B1
#: units of the part store; a part takes one to ten, its slot is the first
PART_SLOTS = 10
#: bytes of one unit, 64 of them for its header when it is a part's first
PART_UNIT = 256
#: no slot; in RUN: the selected part
SLOT_NONE = 255
#: bytes of a part image
PART_IMAGE_MAX = 2496
#: bytes of one UPLOAD_DATA or PART_READ piece
UPLOAD_PIECE_MAX = 32
#: operations of one part
OPERATIONS_MAX = 64
#: characters of a part name
NAME_LENGTH = 16
#: characters of the serial number
SERIAL_LENGTH = 8
#: steps, largest length or radius in a part image: the chip counts in 16 bits
POSITION_MAX = 32000
#: 1/8 step/s, slowest feed: 4 step/s
FEED_MIN = 32
#: feed units of one step/s
FEED_UNIT = 8
#: percent, slowest feed override
OVERRIDE_MIN = 10
#: percent, fastest feed override
OVERRIDE_MAX = 200
#: characters of a tool name
TOOL_NAME_LENGTH = 12
#: characters of a message of PAUSE
MESSAGE_MAX = 32
#: most spring passes
SPRING_MAX = 9
#: slope of one X step per Z step
SLOPE_UNIT = 256
#: slope of an edge that can follow a square shoulder
SLOPE_ANY = 65535
#: bits of a contour's kind that tell what it is
CONTOUR_KIND = 15
#: bit of a contour's kind: roughed in facing direction
CONTOUR_FACING = 128
#: steps, largest retract: sums with it stay below 16 bits
RETRACT_MAX = 8000
#: steps, most raw material in front of z = 0
STOCK_FRONT_MAX = 8000
#: steps, widest grooving tool
WIDTH_MAX = 8000
#: steps, largest radius of an arc
RADIUS_MAX = 32000
#: what LOADER must carry: no other request becomes one by a damaged byte
LOADER_MAGIC = 21580
#: progress of a finished run
PERMILLE_DONE = 1000


class Command(IntEnum):
    """Code byte of a request."""

    HELLO = 0x01
    STATUS = 0x02
    HOME = 0x03
    RUN = 0x04
    HOLD = 0x05
    RESUME = 0x06
    STOP = 0x07
    RESET = 0x08
    ZERO = 0x09
    OVERRIDE = 0x0A
    JOG = 0x0B
    GOTO = 0x0C
    TOUCH = 0x0D
    LOADER = 0x0E
    PROGRESS = 0x0F
    UPLOAD_BEGIN = 0x10
    UPLOAD_DATA = 0x11
    UPLOAD_COMMIT = 0x12
    PART_INFO = 0x13
    PART_READ = 0x14
    PART_SELECT = 0x15
    PART_DELETE = 0x16
    SETTING_GET = 0x20
    SETTING_SET = 0x21
    SERIAL_SET = 0x22


class Axis(IntEnum):
    """The two slides."""

    X = 0
    Z = 1


class State(IntEnum):
    """What the machine is doing."""

    IDLE = 0
    HOMING = 1
    RUNNING = 2
    HOLD = 3
    ALARM = 4
    PAUSE = 5
    MOVING = 6
    TOUCHING = 7


class StatusFlag(IntFlag):
    """Bits of the flags in STATUS."""

    HOMED = 0x01
    SWITCH_X = 0x02
    SWITCH_Z = 0x04
    ESTOP = 0x08
    BUTTON_RUN = 0x10
    BUTTON_HOLD = 0x20
    BUTTON_STOP = 0x40
    MOTION = 0x80


class HomedAxis(IntFlag):
    """Axes in HOME and STATUS."""

    X = 0x01
    Z = 0x02


class MachineWarning(IntFlag):
    """Bits of the warnings in STATUS."""

    DEAD_X = 0x01
    DEAD_Z = 0x02


class RunFlag(IntFlag):
    """Bits of the flags in RUN."""

    STEP = 0x01
    RESUME = 0x02


class Alarm(IntEnum):
    """Why the machine stopped."""

    NONE = 0
    HOME_NOT_FOUND = 1
    HOME_NOT_RELEASED = 2
    LIMIT = 3
    ESTOP = 4
    STREAM_DRY = 5
    WRONG_SWITCH = 6
    SETTINGS_LOST = 7
    STOPPED_HOMING = 8
    DEAD_STEPS_SPREAD = 9
    PATH = 11
    HOME_OPENED_LATE = 12
    PHASE_DRIFT = 13
    SWITCH_WIRING = 14
    PROBE_UNEXPECTED = 15


class StatusInput(IntFlag):
    """Bits of the inputs in STATUS."""

    CONTACT = 0x40
    TOUCHED = 0x80


class ResetCause(IntEnum):
    """Why the chip last started."""

    POWER_ON = 1
    BROWN_OUT = 2
    WATCHDOG = 3
    MCLR = 4
    STACK = 5
    SOFTWARE = 6


class ErrorCode(IntEnum):
    """First payload byte of every response."""

    OK = 0
    UNKNOWN_COMMAND = 1
    BAD_LENGTH = 2
    BUSY = 3
    NOT_HOMED = 4
    ALARM = 5
    NO_PART = 6
    INVALID_PART = 7
    OUT_OF_RANGE = 8
    NOT_RUNNING = 9
    BAD_OFFSET = 10
    NO_UPLOAD = 11
    CRC_MISMATCH = 12
    STORE_FULL = 13
    FLASH_FAILED = 14
    ESTOP = 15
    PROBE_CLOSED = 16
    NOT_FITTED = 17
    NOTHING_TO_RESUME = 18
    WRONG_WAY = 19


class Refusal(IntEnum):
    """Why a part is refused."""

    FORMAT = 1
    LENGTH = 2
    NAME = 3
    STEP_SIZE = 4
    STOCK = 5
    DEPTH_OF_CUT = 6
    FEED = 7
    RETRACT = 8
    OPERATION_COUNT = 9
    OPERATION_TYPE = 10
    OPERATION_SIZE = 11
    OUTSIDE_STOCK = 12
    OUTSIDE_TRAVEL = 13
    EMPTY_CUT = 14
    BLOCKED = 15
    ALLOWANCE = 16
    ORDER = 17
    TOOL = 18
    ARC = 19
    BACK_EDGE = 20
    FRONT_EDGE = 21
    DIRECTION = 22
    SPINDLE = 23


class OperationType(IntEnum):
    """First byte of an operation record."""

    TOOL = 1
    CUT = 2
    PAUSE = 3
    CONTOUR = 4
    PLUNGE = 5


class SettingId(IntEnum):
    """Settings by their number."""

    STEP_X_NM = 0
    STEP_Z_NM = 1
    TRAVEL_X = 2
    TRAVEL_Z = 3
    ZERO_X = 4
    ZERO_Z = 5
    HOME_RATE = 6
    LATCH_RATE = 7
    RAPID_RATE_X = 8
    RAPID_RATE_Z = 9
    SWITCH_TRAVEL_X = 10
    SWITCH_TRAVEL_Z = 11
    COIL_MODE = 12
    ESTOP_FITTED = 13
    INVERT_X = 14
    INVERT_Z = 15
    DEAD_MAX = 16
    DEAD_X = 17
    DEAD_Z = 18
    HOMING_REPEATS = 19
    SPREAD_MAX = 20
    ACCELERATION = 21
    START_RATE_X = 22
    START_RATE_Z = 23
    IDLE_MS = 24
    PULSE_US = 25
    SPINDLE_MIN = 26
    SPINDLE_MAX = 27
    PROBE_FITTED = 28
    TOUCH_BACK_OFF = 29
    HOME_PHASE_X = 30
    HOME_PHASE_Z = 31
    DEAD_JUMP = 32
    DRIFT_MAX = 33
    PANEL = 34
    PANEL_INCH = 35


#: Request payloads; UPLOAD_DATA is followed by its bytes.
REQUESTS = {
    Command.HELLO: Struct("<"),
    Command.STATUS: Struct("<"),
    Command.HOME: Struct("<B"),
    Command.RUN: Struct("<BB"),
    Command.HOLD: Struct("<"),
    Command.RESUME: Struct("<"),
    Command.STOP: Struct("<"),
    Command.RESET: Struct("<"),
    Command.ZERO: Struct("<Bi"),
    Command.OVERRIDE: Struct("<B"),
    Command.JOG: Struct("<iiHH"),
    Command.GOTO: Struct("<iiH"),
    Command.TOUCH: Struct("<ii"),
    Command.LOADER: Struct("<H"),
    Command.PROGRESS: Struct("<"),
    Command.UPLOAD_BEGIN: Struct("<HH"),
    Command.UPLOAD_DATA: Struct("<H"),
    Command.UPLOAD_COMMIT: Struct("<"),
    Command.PART_INFO: Struct("<B"),
    Command.PART_READ: Struct("<BH"),
    Command.PART_SELECT: Struct("<B"),
    Command.PART_DELETE: Struct("<B"),
    Command.SETTING_GET: Struct("<B"),
    Command.SETTING_SET: Struct("<Bi"),
    Command.SERIAL_SET: Struct("<8s"),
}
#: Response data after the error byte; PART_READ answers bytes alone.
RESPONSES = {
    Command.HELLO: Struct("<BBBBBHIIIIii8sH"),
    Command.STATUS: Struct("<BBBBiiHHBBBBBHBHIBBBBBB"),
    Command.HOME: Struct("<"),
    Command.RUN: Struct("<"),
    Command.HOLD: Struct("<"),
    Command.RESUME: Struct("<"),
    Command.STOP: Struct("<"),
    Command.RESET: Struct("<"),
    Command.ZERO: Struct("<"),
    Command.OVERRIDE: Struct("<"),
    Command.JOG: Struct("<"),
    Command.GOTO: Struct("<"),
    Command.TOUCH: Struct("<"),
    Command.LOADER: Struct("<"),
    Command.PROGRESS: Struct("<BHBB"),
    Command.UPLOAD_BEGIN: Struct("<"),
    Command.UPLOAD_DATA: Struct("<"),
    Command.UPLOAD_COMMIT: Struct("<BH"),
    Command.PART_INFO: Struct("<BBHHHB16s"),
    Command.PART_READ: Struct("<"),
    Command.PART_SELECT: Struct("<"),
    Command.PART_DELETE: Struct("<"),
    Command.SETTING_GET: Struct("<iii"),
    Command.SETTING_SET: Struct("<"),
    Command.SERIAL_SET: Struct("<"),
}
#: Header of a part image.
IMAGE_HEADER = Struct("<BBBB16sHHHHHH")
IMAGE_FORMAT = 2
#: Records: type, kind, size of the whole, then the closed fields of the type.
OPERATION_RECORDS = {
    OperationType.TOOL: Struct("<BBH12sHHHHHhh"),
    OperationType.CUT: Struct("<BBHHHHHHH"),
    OperationType.PAUSE: Struct("<BBH"),
    OperationType.CONTOUR: Struct("<BBHhh"),
    OperationType.PLUNGE: Struct("<BBHhhh"),
}


class HelloData(NamedTuple):
    """Response data of HELLO."""

    protocol: int
    firmware_major: int
    firmware_minor: int
    firmware_patch: int
    slots: int
    image_max: int
    step_x_nm: int
    step_z_nm: int
    travel_x: int
    travel_z: int
    zero_x: int
    zero_z: int
    serial: bytes
    max_rate: int


class StatusData(NamedTuple):
    """Response data of STATUS."""

    state: int
    alarm: int
    alarm_detail: int
    flags: int
    x: int
    z: int
    dead_x: int
    dead_z: int
    slot: int
    operation: int
    operations: int
    pass_number: int
    passes: int
    permille: int
    reset_cause: int
    bad_frames: int
    uptime_ms: int
    stream_low: int
    spread_x: int
    spread_z: int
    homed_axes: int
    warnings: int
    inputs: int


class ProgressData(NamedTuple):
    """Response data of PROGRESS."""

    slot: int
    crc: int
    operation: int
    pass_number: int


class UploadCommitData(NamedTuple):
    """Response data of UPLOAD_COMMIT."""

    slot: int
    crc: int


class PartInfoData(NamedTuple):
    """Response data of PART_INFO."""

    present: int
    selected: int
    generation: int
    length: int
    crc: int
    operations: int
    name: bytes


class SettingGetData(NamedTuple):
    """Response data of SETTING_GET."""

    value: int
    minimum: int
    maximum: int


class ImageHeader(NamedTuple):
    """Header of a part image."""

    format: int
    operation_count: int
    flags: int
    reserved: int
    name: bytes
    step_x_nm: int
    step_z_nm: int
    stock_radius: int
    stock_length: int
    stock_front: int
    retract: int


class ToolRecord(NamedTuple):
    """Another tool for what follows; kind is its number, from 0.

    Not the first: the lathe parks and waits for RUN.
    """

    kind: int
    name: bytes
    nose: int
    below: int
    width: int
    back: int
    front: int
    offset_x: int
    offset_z: int


class CutRecord(NamedTuple):
    """Cutting data for what follows; kind is the number of spring passes, 0 to 9."""

    kind: int
    depth_of_cut: int
    finish_allowance: int
    feed: int
    finish_feed: int
    spindle: int
    peck: int


class PauseRecord(NamedTuple):
    """Park and wait for RUN; kind 0 a message, 1 a drill to be used by hand."""

    kind: int
    message: bytes


class ContourRecord(NamedTuple):
    """Rough and finish a contour.

    kind: 0 face, 1 cylinder, 2 cone, 3 arc, 4 profile; + 128 to rough in facing direction.
    segments: kind u8 (0 line, 1 convex arc, 2 concave arc), dx i16, dz i16, and for an arc the
    centre from its start, cx i24, cz i24, in 1/256 step.
    """

    kind: int
    z: int
    x: int
    segments: bytes


class PlungeRecord(NamedTuple):
    """Cut straight in with a tool of a width.

    kind: 0 groove, 1 part off. z is that of the tool's corner on the chuck's side.
    """

    kind: int
    z_high: int
    z_low: int
    x: int


class Setting(NamedTuple):
    """One setting with its default, range and unit."""

    id: SettingId
    default: int
    minimum: int
    maximum: int
    unit: str
    meaning: str


SETTINGS = (
    Setting(SettingId.STEP_X_NM, 7112, 100, 32000, "nm", "one step of X"),
    Setting(SettingId.STEP_Z_NM, 7112, 100, 32000, "nm", "one step of Z"),
    Setting(SettingId.TRAVEL_X, 3575, 100, 32000, "steps", "travel of X from its limit switch"),
    Setting(SettingId.TRAVEL_Z, 16072, 100, 32000, "steps", "travel of Z from its limit switch"),
    Setting(SettingId.ZERO_X, -3575, -32000, 0, "steps", "machine X of the spindle axis"),
    Setting(SettingId.ZERO_Z, -8000, -32000, 0, "steps", "machine Z of the part's front face"),
    Setting(SettingId.HOME_RATE, 800, 20, 4000, "step/s", "speed towards the limit switches"),
    Setting(SettingId.LATCH_RATE, 50, 20, 100, "step/s", "speed of slow approaches and touches"),
    Setting(SettingId.RAPID_RATE_X, 1000, 20, 32000, "step/s", "rapid speed of X"),
    Setting(SettingId.RAPID_RATE_Z, 1000, 20, 32000, "step/s", "rapid speed of Z"),
    Setting(SettingId.SWITCH_TRAVEL_X, 0, 0, 200, "steps", "slide way, switch X closed to open"),
    Setting(SettingId.SWITCH_TRAVEL_Z, 0, 0, 200, "steps", "slide way, switch Z closed to open"),
    Setting(SettingId.COIL_MODE, 0, 0, 3, "", "0 two phases on, 1 wave, 2 half, 3 step/dir"),
    Setting(SettingId.ESTOP_FITTED, 1, 0, 1, "", "1 when the emergency-stop sense is wired"),
    Setting(SettingId.INVERT_X, 0, 0, 1, "", "1 turns motor X the other way"),
    Setting(SettingId.INVERT_Z, 0, 0, 1, "", "1 turns motor Z the other way"),
    Setting(SettingId.DEAD_MAX, 300, 0, 1000, "steps", "most dead steps that homing accepts"),
    Setting(SettingId.DEAD_X, -1, -1, 1000, "steps", "dead steps of X, last measured; -1 never"),
    Setting(SettingId.DEAD_Z, -1, -1, 1000, "steps", "dead steps of Z, last measured; -1 never"),
    Setting(SettingId.HOMING_REPEATS, 3, 1, 9, "", "measurements per axis; the median counts"),
    Setting(SettingId.SPREAD_MAX, 2, 0, 50, "steps", "largest spread of these measurements"),
    Setting(SettingId.ACCELERATION, 8000, 1100, 32000, "step/s2", "acceleration along the path"),
    Setting(SettingId.START_RATE_X, 400, 20, 4000, "step/s", "X starts, stops and turns at it"),
    Setting(SettingId.START_RATE_Z, 400, 20, 4000, "step/s", "Z starts, stops and turns at it"),
    Setting(SettingId.IDLE_MS, -1, -1, 32000, "ms", "coils off so long after a move; -1 never"),
    Setting(SettingId.PULSE_US, 5, 5, 60, "us", "step pulse in coil mode 3"),
    Setting(SettingId.SPINDLE_MIN, 100, 0, 32000, "rev/min", "slowest spindle speed"),
    Setting(SettingId.SPINDLE_MAX, 3800, 1, 32000, "rev/min", "fastest spindle speed"),
    Setting(SettingId.PROBE_FITTED, 0, 0, 1, "", "1 when the tool-to-work contact sensor is wired"),
    Setting(SettingId.TOUCH_BACK_OFF, 50, 1, 1000, "steps", "way back between two touches"),
    Setting(SettingId.HOME_PHASE_X, -1, -1, 7, "", "coil phase where switch X opens; -1 none"),
    Setting(SettingId.HOME_PHASE_Z, -1, -1, 7, "", "coil phase where switch Z opens; -1 none"),
    Setting(SettingId.DEAD_JUMP, 5, 0, 1000, "steps", "change of the dead steps that is reported"),
    Setting(SettingId.DRIFT_MAX, 1, 0, 50, "steps", "most that a home position may have moved"),
    Setting(SettingId.PANEL, 0, 0, 2, "", "display and keys: 0 none, 1 English, 2 Spanish"),
    Setting(SettingId.PANEL_INCH, 0, 0, 1, "", "1: the panel shows inches, 0: millimetres"),
)
