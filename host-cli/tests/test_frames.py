# SPDX-License-Identifier: Apache-2.0
"""Frames: COBS, CRC-16 and what is not a frame."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tornillo.frames import Frame, FrameError, cobs_decode, cobs_encode, crc16, decode, encode
from tornillo.protocol import CRC16_CHECK, FRAME_PAYLOAD_MAX

frames = st.builds(
    Frame, st.integers(0, 255), st.integers(0, 255), st.binary(max_size=FRAME_PAYLOAD_MAX)
)


def crc16_bit_by_bit(data: bytes) -> int:
    """The definition of CRC-16/CCITT-FALSE, one bit at a time."""
    value = 0xFFFF
    for byte in data:
        for bit in range(7, -1, -1):
            top = (value >> 15) ^ (byte >> bit & 1)
            value = (value << 1 & 0xFFFF) ^ (0x1021 if top else 0)
    return value


def test_the_crc_has_the_check_value_of_its_definition() -> None:
    assert crc16(b"123456789") == CRC16_CHECK == 0x29B1


@given(st.binary(max_size=100))
def test_the_table_driven_crc_equals_the_bitwise_one(data: bytes) -> None:
    assert crc16(data) == crc16_bit_by_bit(data)


@pytest.mark.parametrize(
    ("plain", "encoded"),
    [
        (b"", b"\x01"),
        (b"\0", b"\x01\x01"),
        (b"\0\0", b"\x01\x01\x01"),
        (b"\x11\x22\0\x33", b"\x03\x11\x22\x02\x33"),
        (b"\x11\0\0\0", b"\x02\x11\x01\x01\x01"),
        (bytes(range(1, 255)), b"\xff" + bytes(range(1, 255))),
        (bytes(range(1, 256)), b"\xff" + bytes(range(1, 255)) + b"\x02\xff"),
        (b"\0" + bytes(range(1, 255)), b"\x01\xff" + bytes(range(1, 255))),
        (bytes(range(1, 255)) + b"\0", b"\xff" + bytes(range(1, 255)) + b"\x01\x01"),
    ],
)
def test_cobs_encodes_the_known_examples(plain: bytes, encoded: bytes) -> None:
    assert cobs_encode(plain) == encoded
    assert cobs_decode(encoded) == plain


@given(st.binary(max_size=700))
def test_cobs_gives_back_what_was_encoded_without_a_zero_on_the_way(data: bytes) -> None:
    encoded = cobs_encode(data)
    assert 0 not in encoded
    assert cobs_decode(encoded) == data


@pytest.mark.parametrize("encoded", [b"\x05\x11", b"\x00\x11", b"\x03\x11\x00"])
def test_cobs_refuses_blocks_cut_short_and_zeros(encoded: bytes) -> None:
    with pytest.raises(FrameError):
        cobs_decode(encoded)


@given(frames)
def test_a_frame_survives_the_wire_and_fits_a_usb_packet(frame: Frame) -> None:
    wire = encode(frame)
    assert len(wire) <= 62
    assert wire[-1:] == b"\0"
    assert 0 not in wire[:-1]
    assert decode(wire[:-1]) == frame


@given(frames, st.data())
def test_a_frame_with_one_flipped_bit_is_refused(frame: Frame, data: st.DataObject) -> None:
    wire = bytearray(encode(frame)[:-1])
    bit = data.draw(st.integers(0, len(wire) * 8 - 1))
    wire[bit // 8] ^= 1 << bit % 8
    with pytest.raises(FrameError):
        decode(bytes(wire))


def test_a_payload_that_does_not_fit_is_refused() -> None:
    with pytest.raises(FrameError, match="57 bytes"):
        encode(Frame(0, 1, bytes(57)))


def test_a_body_without_a_code_is_not_a_frame() -> None:
    with pytest.raises(FrameError, match="3 bytes"):
        decode(cobs_encode(b"abc"))
