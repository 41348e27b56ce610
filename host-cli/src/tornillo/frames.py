# SPDX-License-Identifier: Apache-2.0
"""Frames of the link: COBS(seq, code, payload, CRC-16) and a zero byte.

Nothing here waits or touches a port; `tornillo.link` does.
"""

from typing import NamedTuple

from tornillo.protocol import CRC16_INITIAL, CRC16_POLYNOMIAL, FRAME_PAYLOAD_MAX

DELIMITER = b"\0"
LONGEST_BLOCK = 254
HEAD_AND_CRC = 4


class FrameError(ValueError):
    """Bytes that are not a frame."""


class Frame(NamedTuple):
    """One request or response."""

    seq: int
    code: int
    payload: bytes


def _crc_table() -> tuple[int, ...]:
    """The CRC of every single byte."""
    table = []
    for byte in range(256):
        value = byte << 8
        for _ in range(8):
            value = (value << 1) ^ (CRC16_POLYNOMIAL if value & 0x8000 else 0)
        table.append(value & 0xFFFF)
    return tuple(table)


_CRC_TABLE = _crc_table()


def crc16(data: bytes) -> int:
    """CRC-16/CCITT-FALSE of `data`."""
    value = CRC16_INITIAL
    for byte in data:
        value = ((value << 8) & 0xFFFF) ^ _CRC_TABLE[(value >> 8) ^ byte]
    return value


def cobs_encode(data: bytes) -> bytes:
    """`data` with its zero bytes replaced by the distance to the next one."""
    blocks = data.split(DELIMITER)
    encoded = bytearray()
    for position, block in enumerate(blocks):
        rest = block
        while len(rest) >= LONGEST_BLOCK:
            encoded += bytes([LONGEST_BLOCK + 1]) + rest[:LONGEST_BLOCK]
            rest = rest[LONGEST_BLOCK:]
            if not rest and position == len(blocks) - 1:
                return bytes(encoded)
        encoded += bytes([len(rest) + 1]) + rest
    return bytes(encoded)


def cobs_decode(encoded: bytes) -> bytes:
    """Undo `cobs_encode`.

    Raises FrameError for a zero byte or a block that is cut short.
    """
    data = bytearray()
    at = 0
    while at < len(encoded):
        size = encoded[at]
        block = encoded[at + 1 : at + size]
        if size == 0 or len(block) != size - 1 or 0 in block:
            raise FrameError("not COBS")
        data += block
        at += size
        if size <= LONGEST_BLOCK and at < len(encoded):
            data.append(0)
    return bytes(data)


def encode(frame: Frame) -> bytes:
    """The bytes on the wire, with the delimiter.

    Raises FrameError when the payload does not fit a frame.
    """
    if len(frame.payload) > FRAME_PAYLOAD_MAX:
        raise FrameError(f"payload of {len(frame.payload)} bytes, at most {FRAME_PAYLOAD_MAX}")
    body = bytes([frame.seq, frame.code]) + frame.payload
    return cobs_encode(body + crc16(body).to_bytes(2, "little")) + DELIMITER


def decode(encoded: bytes) -> Frame:
    """The frame in `encoded`, which comes without its delimiter.

    Raises FrameError for bad COBS, a wrong length or a wrong CRC.
    """
    body = cobs_decode(encoded)
    if not HEAD_AND_CRC <= len(body) <= FRAME_PAYLOAD_MAX + HEAD_AND_CRC:
        raise FrameError(f"{len(body)} bytes cannot be a frame")
    if crc16(body[:-2]) != int.from_bytes(body[-2:], "little"):
        raise FrameError("wrong CRC")
    return Frame(body[0], body[1], body[2:-2])
