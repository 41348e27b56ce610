# SPDX-License-Identifier: Apache-2.0
"""The part image: the bytes of a part as the chip stores them, and the steps in them."""

import struct
from dataclasses import dataclass

from tornillo.protocol import (
    IMAGE_HEADER,
    OPERATION_RECORDS,
    CylinderRecord,
    FaceRecord,
    ImageHeader,
    OperationType,
    Refusal,
)

RECORD_HEAD_SIZE = 4
Operation = FaceRecord | CylinderRecord
RECORDS: dict[OperationType, type[FaceRecord] | type[CylinderRecord]] = {
    OperationType.FACE: FaceRecord,
    OperationType.CYLINDER: CylinderRecord,
}
SMALLEST_RECORD = min(record.size for record in OPERATION_RECORDS.values())


class ImageError(ValueError):
    """Bytes that are not a part image; `refusal` and `operation` as the chip answers them."""

    def __init__(self, refusal: Refusal, operation: int) -> None:
        """Keep the codes."""
        super().__init__(f"{refusal.name} at operation {operation}")
        self.refusal = refusal
        self.operation = operation


@dataclass(frozen=True)
class PartImage:
    """A part in steps."""

    header: ImageHeader
    operations: tuple[Operation, ...]

    @property
    def name(self) -> str:
        """The name of the part."""
        return self.header.name.rstrip(b"\0").decode("ascii", "replace")

    def pack(self) -> bytes:
        """The bytes to upload.

        Raises struct.error when a number does not fit its field; `tornillo.rules` says so
        first.
        """
        data = bytearray(IMAGE_HEADER.pack(*self.header))
        for operation in self.operations:
            kind = operation_type(operation)
            record = OPERATION_RECORDS[kind]
            data += record.pack(kind, record.size, 0, 0, *operation)
        return bytes(data)

    @classmethod
    def unpack(cls, data: bytes) -> "PartImage":
        """The part in `data`; only its structure is checked, as the chip checks it.

        Raises ImageError.
        """
        header = unpack_header(data)
        operations = []
        at = IMAGE_HEADER.size
        for position in range(1, header.operation_count + 1):
            operation = unpack_operation(data, at, position)
            operations.append(operation)
            at += OPERATION_RECORDS[operation_type(operation)].size
        if at != len(data):
            raise ImageError(Refusal.LENGTH, 0)
        return cls(header, tuple(operations))


def operation_type(operation: Operation) -> OperationType:
    """The type byte of an operation."""
    return next(kind for kind, record in RECORDS.items() if isinstance(operation, record))


def unpack_header(data: bytes) -> ImageHeader:
    """The header of an image; raises ImageError when `data` is too short."""
    try:
        return ImageHeader(*IMAGE_HEADER.unpack_from(data))
    except struct.error as error:
        raise ImageError(Refusal.LENGTH, 0) from error


def unpack_operation(data: bytes, at: int, position: int) -> Operation:
    """The record at offset `at`, number `position` of the part; raises ImageError."""
    if len(data) < at + SMALLEST_RECORD:
        raise ImageError(Refusal.LENGTH, position)
    code, size, flags, reserved = data[at : at + RECORD_HEAD_SIZE]
    try:
        kind = OperationType(code)
    except ValueError as error:
        raise ImageError(Refusal.OPERATION_TYPE, position) from error
    record = OPERATION_RECORDS[kind]
    if size != record.size:
        raise ImageError(Refusal.OPERATION_SIZE, position)
    if len(data) < at + size:
        raise ImageError(Refusal.LENGTH, position)
    if flags or reserved:
        raise ImageError(Refusal.FORMAT, position)
    fields = record.unpack_from(data, at)[RECORD_HEAD_SIZE:]
    return RECORDS[kind](*fields)
