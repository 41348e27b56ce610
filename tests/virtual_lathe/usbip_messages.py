# SPDX-License-Identifier: Apache-2.0
"""The messages of USB/IP, as the Linux documentation of the protocol (version 1.1.1) has them.

Everything is big-endian, except the eight bytes of a SETUP packet, which are those of the bus.
Nothing here touches a socket.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

VERSION = 0x0111
BUS_ID_BYTES = 32
PATH_BYTES = 256
ISO_PACKET_BYTES = 16
NO_PACKETS = 0xFFFFFFFF
FULL_SPEED = 2
#: Longest transfer that is taken: far more than any driver of a serial port asks for.
TRANSFER_MAX = 1 << 20

OPERATION = struct.Struct(">HHI")  # version, code, status
HEADER = struct.Struct(">IIIII")  # command, seqnum, devid, direction, endpoint
SUBMIT = struct.Struct(">IIIII8s")  # flags, length, start frame, packets, interval, setup
RETURN = struct.Struct(">iiIII8x")  # status, length, start frame, packets, errors
UNLINK = struct.Struct(">I24x")  # seqnum of what is to be taken back
UNLINKED = struct.Struct(">i24x")  # status
MESSAGE_BYTES = HEADER.size + SUBMIT.size
_DEVICE = struct.Struct(f">{PATH_BYTES}s{BUS_ID_BYTES}sIII HHH BBBBBB")


class Code(IntEnum):
    """Operations before a device is imported."""

    REQUEST_IMPORT = 0x8003
    REPLY_IMPORT = 0x0003
    REQUEST_LIST = 0x8005
    REPLY_LIST = 0x0005


class Answer(IntEnum):
    """Status of a reply to an operation."""

    OK = 0
    BUSY = 2
    DEVICE_ERROR = 3
    NO_DEVICE = 4


class Command(IntEnum):
    """Messages while a device is imported."""

    SUBMIT = 1
    UNLINK = 2
    RETURN_SUBMIT = 3
    RETURN_UNLINK = 4


class Flag(IntEnum):
    """Bits of transfer_flags that the host controller has to know."""

    SHORT_NOT_OK = 0x01
    ZERO_PACKET = 0x40


class MessageError(ValueError):
    """Bytes that are no message of the protocol; the connection cannot go on."""


class Request(NamedTuple):
    """CMD_SUBMIT without its data, or CMD_UNLINK with ``victim``."""

    command: Command
    seqnum: int
    device: int
    into: bool
    endpoint: int
    flags: int = 0
    length: int = 0
    packets: int = 0
    interval: int = 0
    setup: bytes = b""
    victim: int = 0

    @property
    def isochronous(self) -> bool:
        """Whether packet descriptors follow."""
        return self.packets not in (0, NO_PACKETS)

    @property
    def following(self) -> int:
        """Bytes that follow the message."""
        if self.command != Command.SUBMIT:
            return 0
        data = 0 if self.into else self.length
        return data + (ISO_PACKET_BYTES * self.packets if self.isochronous else 0)


@dataclass(frozen=True)
class Exported:
    """What the list of devices says about one; the descriptors are those of the bus."""

    bus_id: str
    bus: int
    number: int
    device: bytes
    configuration: bytes

    def packed(self) -> bytes:
        """Return the description of 312 bytes."""
        vendor, product, release = struct.unpack_from("<HHH", self.device, 8)
        return _DEVICE.pack(
            f"/sys/devices/virtual_lathe/{self.bus_id}".encode(),
            self.bus_id.encode(),
            self.bus,
            self.number,
            FULL_SPEED,
            vendor,
            product,
            release,
            *self.device[4:7],
            self.configuration[5],
            self.device[17],
            self.configuration[4],
        )

    def interfaces(self) -> bytes:
        """Return class, subclass and protocol of every interface, four bytes each."""
        found = b""
        at = 0
        while at + 2 <= len(self.configuration) and self.configuration[at] >= 2:
            if self.configuration[at + 1] == 4 and self.configuration[at + 3] == 0:
                found += self.configuration[at + 5 : at + 8] + b"\0"
            at += self.configuration[at]
        return found


def reply_list(devices: Iterable[Exported]) -> bytes:
    """Return OP_REP_DEVLIST."""
    known = list(devices)
    body = b"".join(device.packed() + device.interfaces() for device in known)
    return (
        OPERATION.pack(VERSION, Code.REPLY_LIST, Answer.OK) + struct.pack(">I", len(known)) + body
    )


def reply_import(answer: Answer, device: Exported | None = None) -> bytes:
    """Return OP_REP_IMPORT; the device follows only when the answer is OK."""
    body = device.packed() if device is not None and answer == Answer.OK else b""
    return OPERATION.pack(VERSION, Code.REPLY_IMPORT, answer) + body


def parse_operation(head: bytes) -> Code:
    """Return the code of an operation's first eight bytes.

    Raises:
        MessageError: another version of the protocol, or no such operation.
    """
    version, code, _ = OPERATION.unpack(head)
    if version != VERSION:
        raise MessageError(f"USB/IP version {version:#06x}, not {VERSION:#06x}")
    if code not in (Code.REQUEST_IMPORT, Code.REQUEST_LIST):
        raise MessageError(f"unknown operation {code:#06x}")
    return Code(code)


def parse_message(raw: bytes) -> Request:
    """Return the request in the 48 bytes of a message.

    Raises:
        MessageError: no such command, or a length that no driver asks for.
    """
    command, seqnum, device, direction, endpoint = HEADER.unpack_from(raw)
    if direction > 1 or endpoint > 15:
        raise MessageError(f"direction {direction}, endpoint {endpoint}")
    if command == Command.UNLINK:
        (victim,) = UNLINK.unpack_from(raw, HEADER.size)
        return Request(
            Command.UNLINK, seqnum, device, bool(direction), endpoint, victim=int(victim)
        )
    if command != Command.SUBMIT:
        raise MessageError(f"unknown command {command}")
    flags, length, _, packets, interval, setup = SUBMIT.unpack_from(raw, HEADER.size)
    if length > TRANSFER_MAX or (packets != NO_PACKETS and packets > 1024):
        raise MessageError(f"transfer of {length} bytes, {packets} packets")
    into = bool(setup[0] & 0x80) if endpoint == 0 and length else bool(direction)
    return Request(
        Command.SUBMIT, seqnum, device, into, endpoint, flags, length, packets, interval, setup
    )


def return_submit(request: Request, status: int, data: bytes, count: int) -> bytes:
    """Return RET_SUBMIT: 0 or a negative errno, data that were read, bytes that were moved."""
    head = HEADER.pack(Command.RETURN_SUBMIT, request.seqnum, 0, 0, 0)
    return head + RETURN.pack(status, count, 0, 0, 0) + data


def return_unlink(request: Request, status: int) -> bytes:
    """Return RET_UNLINK: -ECONNRESET when the transfer was taken back, 0 when it had ended."""
    return HEADER.pack(Command.RETURN_UNLINK, request.seqnum, 0, 0, 0) + UNLINKED.pack(status)
