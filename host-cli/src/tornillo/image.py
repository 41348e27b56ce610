# SPDX-License-Identifier: Apache-2.0
"""The part image: the bytes of a part as the chip stores them, and the steps in them."""

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

from tornillo.language import _
from tornillo.protocol import (
    IMAGE_HEADER,
    MESSAGE_MAX,
    OPERATION_RECORDS,
    ContourRecord,
    CutRecord,
    ImageHeader,
    OperationType,
    PauseRecord,
    PlungeRecord,
    Refusal,
    ToolRecord,
)

RECORD_HEAD_SIZE = 4
CENTRE_UNIT = 256  # of one step, in the centres of arcs
FLAG_INCH = 0x01  # in the flags of the header
Record = ToolRecord | CutRecord | PauseRecord | ContourRecord | PlungeRecord
RECORDS: dict[OperationType, type[Record]] = {
    OperationType.TOOL: ToolRecord,
    OperationType.CUT: CutRecord,
    OperationType.PAUSE: PauseRecord,
    OperationType.CONTOUR: ContourRecord,
    OperationType.PLUNGE: PlungeRecord,
}
OPEN_TYPES = (OperationType.PAUSE, OperationType.CONTOUR)
OPERATIONS = (PauseRecord, ContourRecord, PlungeRecord)
_SEGMENT_HEAD = struct.Struct("<Bhh")


class SegmentKind(IntEnum):
    """First byte of a segment of a contour."""

    LINE = 0
    CONVEX = 1
    CONCAVE = 2


class Segment(NamedTuple):
    """One line or arc; (cz, cx) is the centre from its start in 1/256 step, 0 for a line."""

    kind: SegmentKind
    dz: int
    dx: int
    cz: int = 0
    cx: int = 0


class ImageError(ValueError):
    """Bytes that are not a part image; `refusal` and `operation` as the chip answers them."""

    def __init__(self, refusal: Refusal, operation: int) -> None:
        """Keep the codes."""
        super().__init__(
            _("{refusal} at operation {operation}").format(
                refusal=refusal.name, operation=operation
            )
        )
        self.refusal = refusal
        self.operation = operation


def pack_segments(segments: tuple[Segment, ...]) -> bytes:
    """The bytes of a contour's segments.

    Raises struct.error or OverflowError when a number does not fit its field.
    """
    data = bytearray()
    for segment in segments:
        data += _SEGMENT_HEAD.pack(segment.kind, segment.dx, segment.dz)
        if segment.kind != SegmentKind.LINE:
            data += segment.cx.to_bytes(3, "little", signed=True)
            data += segment.cz.to_bytes(3, "little", signed=True)
    return bytes(data)


def unpack_segments(data: bytes) -> Iterator[Segment]:
    """The segments in the bytes of a contour.

    Raises ValueError at the first one that is cut off or of unknown kind.
    """
    at = 0
    while at < len(data):
        if len(data) < at + _SEGMENT_HEAD.size:
            raise ValueError(_("a segment is cut off"))
        code, dx, dz = _SEGMENT_HEAD.unpack_from(data, at)
        kind = SegmentKind(code)
        at += _SEGMENT_HEAD.size
        if kind is SegmentKind.LINE:
            yield Segment(kind, dz, dx)
            continue
        if len(data) < at + 6:
            raise ValueError(_("an arc is cut off"))
        cx = int.from_bytes(data[at : at + 3], "little", signed=True)
        cz = int.from_bytes(data[at + 3 : at + 6], "little", signed=True)
        at += 6
        yield Segment(kind, dz, dx, cz, cx)


@dataclass(frozen=True)
class PartImage:
    """A part in steps."""

    header: ImageHeader
    records: tuple[Record, ...]

    @property
    def name(self) -> str:
        """The name of the part."""
        return self.header.name.rstrip(b"\0").decode("ascii", "replace")

    @property
    def operations(self) -> tuple[PauseRecord | ContourRecord | PlungeRecord, ...]:
        """The records that are counted: what a person calls an operation."""
        return tuple(record for record in self.records if isinstance(record, OPERATIONS))

    @property
    def inch(self) -> bool:
        """Whether the part was drawn in inch."""
        return bool(self.header.flags & FLAG_INCH)

    def pack(self) -> bytes:
        """The bytes to upload.

        Raises struct.error when a number does not fit its field; `tornillo.rules` says so
        first.
        """
        return IMAGE_HEADER.pack(*self.header) + b"".join(map(pack_record, self.records))

    @property
    def size(self) -> int:
        """Bytes of the image, also of one whose numbers do not fit their fields."""
        return IMAGE_HEADER.size + sum(map(_record_size, self.records))

    @classmethod
    def unpack(cls, data: bytes) -> "PartImage":
        """The part in `data`; only its structure is checked, as the chip checks it.

        Raises ImageError.
        """
        header = unpack_header(data)
        records: list[Record] = []
        at = IMAGE_HEADER.size
        count = 0
        while at < len(data):
            record, size = unpack_record(data, at, count + 1)
            records.append(record)
            count += isinstance(record, OPERATIONS)
            at += size
        if count != header.operation_count:
            raise ImageError(Refusal.OPERATION_COUNT, 0)
        return cls(header, tuple(records))


def record_type(record: Record) -> OperationType:
    """The type byte of a record."""
    return next(kind for kind, cls in RECORDS.items() if isinstance(record, cls))


def _record_size(record: Record) -> int:
    """The bytes that a record takes."""
    tail = len(record[-1]) if isinstance(record, PauseRecord | ContourRecord) else 0
    return OPERATION_RECORDS[record_type(record)].size + tail


def pack_record(record: Record) -> bytes:
    """The bytes of one record."""
    kind = record_type(record)
    layout = OPERATION_RECORDS[kind]
    fields = tuple(record)
    tail = b""
    if isinstance(record, PauseRecord | ContourRecord):
        fields, tail = fields[:-1], record[-1]
    return layout.pack(kind, fields[0], layout.size + len(tail), *fields[1:]) + tail


def unpack_header(data: bytes) -> ImageHeader:
    """The header of an image; raises ImageError when `data` is too short."""
    try:
        return ImageHeader(*IMAGE_HEADER.unpack_from(data))
    except struct.error as error:
        raise ImageError(Refusal.LENGTH, 0) from error


def record_head(data: bytes, at: int, position: int) -> tuple[OperationType, int, int]:
    """Type, kind and size of the record at offset `at`.

    Raises ImageError for operation `position`.
    """
    left = len(data) - at
    if left < RECORD_HEAD_SIZE:
        raise ImageError(Refusal.LENGTH, position)
    code, kind, size = struct.unpack_from("<BBH", data, at)
    if not RECORD_HEAD_SIZE <= size <= left:
        raise ImageError(Refusal.LENGTH, position)
    try:
        return OperationType(code), kind, size
    except ValueError as error:
        raise ImageError(Refusal.OPERATION_TYPE, position) from error


def unpack_record(data: bytes, at: int, position: int) -> tuple[Record, int]:
    """The record at offset `at` and its size; raises ImageError for operation `position`."""
    type_, kind, size = record_head(data, at, position)
    layout = OPERATION_RECORDS[type_]
    longest = layout.size
    if type_ in OPEN_TYPES:
        longest += MESSAGE_MAX if type_ is OperationType.PAUSE else len(data)
    if not layout.size <= size <= longest:
        raise ImageError(Refusal.OPERATION_SIZE, position)
    fields = (kind, *layout.unpack_from(data, at)[3:])
    if type_ in OPEN_TYPES:
        fields = (*fields, data[at + layout.size : at + size])
    return RECORDS[type_](*fields), size
