# SPDX-License-Identifier: Apache-2.0
"""Frames on the chip: cut up, joined, damaged, repeated."""

from __future__ import annotations

import struct

import pytest
from simulated.processes import on_a_new_chip
from tornillo.frames import Frame, cobs_encode, crc16, encode
from tornillo.protocol import FRAME_PAYLOAD_MAX, Command, ErrorCode, SettingId

from firmware.usb_bench import UsbBench

SILENCE_S = 0.01
BAD_FRAMES_AT, UPTIME_AT = 25, 27


def bad_frames(bench: UsbBench, seq: int) -> int:
    """The counter of refused frames, from STATUS."""
    return int(struct.unpack_from("<H", bench.ask(seq, Command.STATUS), BAD_FRAMES_AT)[0])


def assert_silence(bench: UsbBench) -> None:
    """Nothing comes from the chip for a while."""
    bench.host.wait(SILENCE_S)
    assert bench.host.receive() == b""


@on_a_new_chip
def test_hello_is_answered() -> None:
    bench = UsbBench(b"TN-00042").open()
    bench.send_raw(b"\0")
    answer = bench.ask(0, Command.HELLO)
    assert answer[0] == ErrorCode.OK
    assert b"TN-00042" in answer


@on_a_new_chip
def test_a_frame_may_come_byte_by_byte() -> None:
    bench = UsbBench().open()
    request = encode(Frame(1, Command.SETTING_GET, bytes([SettingId.STEP_X_NM])))
    bench.send_raw(*(request[i : i + 1] for i in range(len(request))))
    (answer,) = bench.receive_raw()
    assert struct.unpack_from("<Bi", answer.payload) == (ErrorCode.OK, 7112)


@on_a_new_chip
def test_several_frames_may_come_in_one_packet() -> None:
    bench = UsbBench().open()
    requests = [encode(Frame(seq, Command.STATUS, b"")) for seq in (1, 2, 3, 4)]
    together = b"".join(requests)
    assert len(together) <= 64
    bench.send_raw(together)
    assert [frame.seq for frame in bench.receive_raw(4)] == [1, 2, 3, 4]


@pytest.mark.parametrize("cut", range(1, 14))
@on_a_new_chip
def test_packets_may_be_cut_anywhere(cut: int) -> None:
    bench = UsbBench().open()
    stream = b"".join(encode(Frame(seq, Command.STATUS, b"")) for seq in (1, 2))
    bench.send_raw(stream[:cut], stream[cut:])
    assert [frame.seq for frame in bench.receive_raw(2)] == [1, 2]


@on_a_new_chip
def test_zeros_between_frames_are_ignored() -> None:
    bench = UsbBench().open()
    bench.send_raw(bytes(64), bytes(7))
    assert bad_frames(bench, 1) == 0


@on_a_new_chip
def test_the_longest_frame_is_taken_and_one_byte_more_is_not() -> None:
    bench = UsbBench().open()
    for filler in (b"\0", b"\x01", b"\xff"):
        payload = filler * FRAME_PAYLOAD_MAX
        assert bench.ask(1, 0x7F, payload)[0] == ErrorCode.UNKNOWN_COMMAND
        body = bytes([2, 0x7F]) + payload + b"\x55"
        long = cobs_encode(body + crc16(body).to_bytes(2, "little")) + b"\0"
        bench.send_raw(*(long[i : i + 64] for i in range(0, len(long), 64)))
        assert_silence(bench)
    assert bad_frames(bench, 3) == 3


@pytest.mark.parametrize("length", range(0, 4))
@on_a_new_chip
def test_a_body_too_short_for_a_frame_is_refused(length: int) -> None:
    bench = UsbBench().open()
    bench.send_raw(cobs_encode(bytes(range(1, length + 1))) + b"\0")
    assert_silence(bench)
    assert bad_frames(bench, 1) == 1


@on_a_new_chip
def test_every_single_wrong_bit_is_noticed() -> None:
    bench = UsbBench().open()
    request = encode(Frame(7, Command.STATUS, b""))
    for bit in range(8 * (len(request) - 1)):
        damaged = bytearray(request)
        damaged[bit // 8] ^= 1 << bit % 8
        bench.send_raw(bytes(damaged) + b"\0")
        bench.host.wait(0.002)
        assert bench.host.receive() == b"", f"bit {bit} was not noticed"
    assert bad_frames(bench, 8) >= 8 * (len(request) - 1)


@on_a_new_chip
def test_a_damaged_frame_that_is_sent_again_is_answered() -> None:
    bench = UsbBench().open()
    request = bytearray(encode(Frame(5, Command.STATUS, b"")))
    request[2] ^= 0x10
    bench.send_raw(bytes(request))
    assert_silence(bench)
    assert bad_frames(bench, 5) == 1


@on_a_new_chip
def test_the_chip_finds_its_place_again_after_garbage() -> None:
    bench = UsbBench().open()
    bench.send_raw(bytes(range(1, 65)), b"\xff" * 64, b"\x80" * 10, b"\0")
    bench.receive_raw(timeout=SILENCE_S)
    assert bench.ask(1, Command.STATUS)[0] == ErrorCode.OK


@on_a_new_chip
def test_a_repeated_request_gets_the_same_bytes_and_is_not_executed_again() -> None:
    bench = UsbBench().open()
    first = bench.ask(1, Command.STATUS)
    bench.host.wait(0.1)
    assert bench.ask(1, Command.STATUS) == first  # the uptime too: nothing was executed
    second = bench.ask(2, Command.STATUS)
    assert second[UPTIME_AT:] != first[UPTIME_AT:]


@on_a_new_chip
def test_a_new_request_with_an_old_seq_is_executed() -> None:
    bench = UsbBench().open()
    assert bench.ask(1, Command.SETTING_GET, bytes([SettingId.STEP_X_NM]))[1:5] == struct.pack(
        "<i", 7112
    )
    assert bench.ask(1, Command.SETTING_GET, bytes([SettingId.TRAVEL_X]))[1:5] == struct.pack(
        "<i", 3575
    )


@on_a_new_chip
def test_hello_is_executed_every_time() -> None:
    bench = UsbBench().open()
    before = bench.ask(0, Command.HELLO)
    serial = bench.chip.symbols.ram("usb_serial_descriptor") + 2
    bench.chip.poke(serial, ord("Z"))
    after = bench.ask(0, Command.HELLO)
    assert after != before
    assert b"Z0000000" in after


@on_a_new_chip
def test_a_reply_lost_with_the_cable_is_repeated_to_the_same_request() -> None:
    bench = UsbBench().open()
    request = encode(Frame(3, Command.STATUS, b""))
    first = bench.ask(3, Command.STATUS)
    bench.host.unplug()
    bench.chip.run(0.1)
    bench.open()
    bench.send_raw(b"\0" + request)
    (again,) = bench.receive_raw()
    assert again.payload == first
