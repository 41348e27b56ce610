# SPDX-License-Identifier: Apache-2.0
"""The rules of a part image, as the chip applies them and in its order.

`check` judges a part in steps, `verdict` the bytes of an image. The chip repeats all of it on
its own; these rules only tell a person earlier and with better words.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

from tornillo.image import (
    FLAG_INCH,
    OPERATIONS,
    ImageError,
    PartImage,
    Record,
    record_head,
    unpack_header,
    unpack_record,
)
from tornillo.language import _
from tornillo.machine import Machine
from tornillo.material import Material
from tornillo.protocol import (
    FEED_MIN,
    FEED_UNIT,
    IMAGE_FORMAT,
    IMAGE_HEADER,
    OPERATIONS_MAX,
    PART_IMAGE_MAX,
    POSITION_MAX,
    RETRACT_MAX,
    SPRING_MAX,
    STOCK_FRONT_MAX,
    WIDTH_MAX,
    ContourRecord,
    CutRecord,
    ImageHeader,
    OperationType,
    PauseRecord,
    PlungeRecord,
    Refusal,
    ToolRecord,
)
from tornillo.rules_shape import Found, Ground, contour_rules, plunge_rules
from tornillo.units import Scale

NAME = re.compile(rb"[a-z0-9-]{1,16}\0*")
TOOL_KIND_MAX = 15
#: The chip counts no further: there are too many already.
OPERATION_LAST = OPERATIONS_MAX + 2
PAUSE_KIND_MAX = 1
FIELD_MAX = 0xFFFF
FIRST_TYPES = (OperationType.TOOL, OperationType.CUT)


class Violation(NamedTuple):
    """A broken rule.

    `operation` is 0 for the part as a whole, `record` the index of the record, -1 for the
    header. `key` says what it is about: a key of the part file, or start.x, end.z and the like
    of a contour. `detail` has the numbers in words.
    """

    refusal: Refusal
    operation: int
    record: int
    key: str
    detail: str


def check(image: PartImage, scale: Scale) -> Iterator[Violation]:
    """Every rule that `image` breaks on the machine of `scale`, the chip's answer first.

    At most one for each contour and plunge. Not whether the records are as many as the header
    says.
    """
    broken = list(header_rules(image.header, scale))
    if image.size > PART_IMAGE_MAX:
        detail = _("{size} bytes, at most {part_image_max}").format(
            size=image.size, part_image_max=PART_IMAGE_MAX
        )
        yield Violation(Refusal.LENGTH, 0, -1, "operation", detail)
    yield from broken
    if any(violation.refusal is Refusal.STOCK for violation in broken):
        return
    judge = _Judge(image.header, scale)
    for record in image.records:
        yield from judge.rules(record)


def verdict(data: bytes, machine: Machine) -> Violation | None:
    """The first rule that the image `data` breaks on `machine`, as the chip would answer."""
    scale = Scale("mm", machine)
    try:
        if len(data) > PART_IMAGE_MAX:
            raise ImageError(Refusal.LENGTH, 0)
        header = unpack_header(data)
        for violation in header_rules(header, scale):
            return violation
        return _records_verdict(data, _Judge(header, scale))
    except ImageError as error:
        return Violation(error.refusal, error.operation, -1, "", "")


def _records_verdict(data: bytes, judge: "_Judge") -> Violation | None:
    """The first rule that a record of `data` breaks; raises ImageError for its structure."""
    at = IMAGE_HEADER.size
    while at < len(data):
        kind, _, _ = record_head(data, at, judge.operation)
        if judge.index < len(FIRST_TYPES) and kind is not FIRST_TYPES[judge.index]:
            raise ImageError(Refusal.ORDER, judge.operation)
        record, size = unpack_record(data, at, judge.operation)
        for violation in judge.rules(record):
            return violation
        at += size
    if judge.operation - 1 != judge.header.operation_count:
        raise ImageError(Refusal.OPERATION_COUNT, 0)
    return None


class _Judge:
    """Goes through the records of a part in their order."""

    def __init__(self, header: ImageHeader, scale: Scale) -> None:
        """Before the first record."""
        self.header = header
        self.scale = scale
        self.material = Material(header.stock_radius, header.stock_front)
        self.tool: ToolRecord | None = None
        self.index = 0
        self.operation = 1

    def rules(self, record: Record) -> Iterator[Violation]:
        """The rules that the next record breaks, in the chip's order."""
        for found in self._found(record):
            yield Violation(found.refusal, self.operation, self.index, found.key, found.detail)
        self.index += 1
        self.operation = min(OPERATION_LAST, self.operation + isinstance(record, OPERATIONS))

    def _found(self, record: Record) -> Iterator[Found]:
        """What is wrong with one record."""
        if isinstance(record, ToolRecord):
            self.tool = record
            return _tool_rules(record, self.header, self.scale)
        if isinstance(record, CutRecord):
            return _cut_rules(record, self.header, self.scale)
        if isinstance(record, PauseRecord):
            return _pause_rules(record)
        assert self.tool is not None  # a part begins with its tool
        ground = Ground(self.header, self.scale, self.tool, self.material)
        return self._shape_rules(record, ground)

    def _shape_rules(self, record: ContourRecord | PlungeRecord, ground: Ground) -> Iterator[Found]:
        """What is wrong with a cut; a good one is taken from the material."""
        if isinstance(record, ContourRecord):
            return contour_rules(record, ground)
        return plunge_rules(record, ground)


def header_rules(header: ImageHeader, scale: Scale) -> Iterator[Violation]:
    """The rules of the header, in the chip's order."""

    def broken(refusal: Refusal, key: str, detail: str) -> Violation:
        return Violation(refusal, 0, -1, key, detail)

    machine = scale.machine
    if header.format != IMAGE_FORMAT or header.flags & ~FLAG_INCH or header.reserved:
        yield broken(Refusal.FORMAT, "", _("format {format}").format(format=header.format))
    if not NAME.fullmatch(header.name):
        yield broken(Refusal.NAME, "part.name", repr(header.name.decode("latin-1")))
    if (header.step_x_nm, header.step_z_nm) != (machine.step_x_nm, machine.step_z_nm):
        yield broken(
            Refusal.STEP_SIZE,
            "",
            _("{step_x_nm} and {step_z_nm} nm").format(
                step_x_nm=header.step_x_nm, step_z_nm=header.step_z_nm
            ),
        )
    yield from (broken(Refusal.STOCK, *found) for found in _stock(header, scale))
    if not 1 <= header.operation_count <= OPERATIONS_MAX:
        yield broken(
            Refusal.OPERATION_COUNT,
            "operation",
            _("{operation_count} operations").format(operation_count=header.operation_count),
        )
    if not 1 <= header.retract <= RETRACT_MAX:
        yield broken(
            Refusal.RETRACT, "cut.retract", _("{retract} steps").format(retract=header.retract)
        )
    yield from (broken(Refusal.OUTSIDE_TRAVEL, *found) for found in _clear(header, scale, 0, 0))


def _stock(header: ImageHeader, scale: Scale) -> Iterator[tuple[str, str]]:
    """Stock sizes outside their range."""
    if not 1 <= header.stock_radius <= POSITION_MAX:
        yield "stock.diameter", scale.show_diameter(header.stock_radius)
    if not 1 <= header.stock_length <= POSITION_MAX:
        yield (
            "stock.length",
            _("length {stock_length}").format(
                stock_length=scale.show(scale.length(header.stock_length))
            ),
        )
    if not 0 <= header.stock_front <= STOCK_FRONT_MAX:
        yield (
            "stock.allowance",
            _("allowance {stock_front}").format(
                stock_front=scale.show(scale.length(header.stock_front))
            ),
        )


def _clear(
    header: ImageHeader, scale: Scale, offset_x: int, offset_z: int
) -> Iterator[tuple[str, str]]:
    """Where a tool with these offsets cannot get clear of the stock."""
    machine = scale.machine
    room_x, room_z = -machine.zero_x - offset_x, -machine.zero_z - offset_z
    need_x = header.stock_radius + header.retract
    need_z = header.stock_front + 2 * header.retract
    if need_x > room_x:
        yield (
            "stock.diameter",
            _("clear of the stock means {need_x}, the slide ends at {room_x}").format(
                need_x=scale.show_diameter(need_x), room_x=scale.show_diameter(room_x)
            ),
        )
    if need_z > room_z:
        yield (
            "stock.allowance",
            _("clear of the stock means {need_z}, the slide ends at {room_z}").format(
                need_z=scale.show_z(need_z), room_z=scale.show_z(room_z)
            ),
        )


def _tool_rules(tool: ToolRecord, header: ImageHeader, scale: Scale) -> Iterator[Found]:
    """The rules of TOOL."""
    if not 0 <= tool.kind <= TOOL_KIND_MAX:
        yield Found(Refusal.FORMAT, "tool", _("tool number {kind}").format(kind=tool.kind))
    if tool.width > WIDTH_MAX:
        yield Found(
            Refusal.FORMAT,
            "width",
            _("{width} steps, at most {width_max}").format(width=tool.width, width_max=WIDTH_MAX),
        )
    if tool.below > WIDTH_MAX:
        yield Found(
            Refusal.FORMAT,
            "nose_radius",
            _("{below} steps, at most {width_max}").format(below=tool.below, width_max=WIDTH_MAX),
        )
    zeros = scale.machine.zero_x + tool.offset_x, scale.machine.zero_z + tool.offset_z
    if not all(-POSITION_MAX <= zero <= 0 for zero in zeros):
        yield Found(
            Refusal.OUTSIDE_TRAVEL,
            "offset",
            _("part zero {zeros} steps from the switches").format(zeros=zeros),
        )
    elif tool.offset_x or tool.offset_z:
        for _key, detail in _clear(header, scale, tool.offset_x, tool.offset_z):
            yield Found(Refusal.OUTSIDE_TRAVEL, "offset", detail)


def _pause_rules(record: PauseRecord) -> Iterator[Found]:
    """The rules of PAUSE."""
    if not 0 <= record.kind <= PAUSE_KIND_MAX:
        yield Found(Refusal.FORMAT, "message", _("kind {kind}").format(kind=record.kind))


def _cut_rules(cut: CutRecord, header: ImageHeader, scale: Scale) -> Iterator[Found]:
    """The rules of CUT."""
    if not 0 <= cut.kind <= SPRING_MAX:
        yield Found(
            Refusal.FORMAT, "spring_passes", _("{kind} spring passes").format(kind=cut.kind)
        )
    if not 1 <= cut.depth_of_cut <= header.stock_radius:
        detail = _("{depth_of_cut} steps, the stock has {stock_radius}").format(
            depth_of_cut=cut.depth_of_cut, stock_radius=header.stock_radius
        )
        yield Found(Refusal.DEPTH_OF_CUT, "depth_of_cut", detail)
    if cut.finish_allowance > cut.depth_of_cut:
        detail = _("{finish_allowance} steps, the depth of cut is {depth_of_cut}").format(
            finish_allowance=cut.finish_allowance, depth_of_cut=cut.depth_of_cut
        )
        yield Found(Refusal.ALLOWANCE, "finish_allowance", detail)
    fastest = min(scale.machine.max_rate * FEED_UNIT, FIELD_MAX)
    for key, feed in (("feed", cut.feed), ("finish_feed", cut.finish_feed)):
        if not FEED_MIN <= feed <= fastest:
            feed_range = _("{feed_min} to {fastest}").format(
                feed_min=scale.show_feed(FEED_MIN), fastest=scale.show_feed(fastest)
            )
            detail = _("{feed}, the machine feeds {feed_range}").format(
                feed=scale.show_feed(feed), feed_range=feed_range
            )
            yield Found(Refusal.FEED, key, detail)
    yield from _spindle(cut.spindle, scale.machine)


def _spindle(speed: int, machine: Machine) -> Iterator[Found]:
    """A spindle speed that the machine does not have."""
    slowest, fastest = machine.spindle_min_rpm, machine.spindle_max_rpm
    if not speed or slowest is None or fastest is None:
        return
    if not slowest <= speed <= fastest:
        detail = _("{speed} rev/min, the machine turns {slowest} to {fastest}").format(
            speed=speed, slowest=slowest, fastest=fastest
        )
        yield Found(Refusal.SPINDLE, "spindle", detail)
