# SPDX-License-Identifier: Apache-2.0
"""Requests sent faster than they are answered, and answers fetched slower than they are made."""

from __future__ import annotations

import pytest
from simulated.processes import on_a_new_chip
from tornillo.frames import Frame, decode, encode
from tornillo.protocol import FRAME_PAYLOAD_MAX, Command, ErrorCode, SettingId
from virtual_lathe.usb_host import Handshake, Token

from firmware.usb_bench import UsbBench

REQUESTS = 200
POLL_S, QUIET_S, LIMIT_S = 1e-3, 0.05, 30.0
#: One request is answered, the next waits in the packet buffer; the third is not taken.
TAKEN_AHEAD = 2


def requests(count: int) -> list[Frame]:
    """Requests of every length, each with a seq of its own."""
    made = []
    for number in range(count):
        filler = bytes([number & 0xFF]) * (number % (FRAME_PAYLOAD_MAX + 1))
        code = (Command.STATUS, Command.SETTING_GET, 0x7F)[number % 3]
        payload = (b"", bytes([number % len(SettingId)]), filler)[number % 3]
        made.append(Frame(number & 0xFF, code, payload))
    return made


def assert_answers(stream: bytes, asked: list[Frame]) -> None:
    """One answer to each request, in order, none invented."""
    answers = [decode(part) for part in stream.split(b"\0")[:-1]]
    expected = [(frame.seq, frame.code | 0x80) for frame in asked]
    assert [(frame.seq, frame.code) for frame in answers] == expected
    for answer in answers:
        unknown = answer.code == 0x7F | 0x80
        assert answer.payload[0] == (ErrorCode.UNKNOWN_COMMAND if unknown else ErrorCode.OK)


@pytest.mark.parametrize("packet", [1, 7, 64])
@on_a_new_chip
def test_a_flood_of_requests_is_answered_one_by_one_and_none_is_lost(packet: int) -> None:
    bench = UsbBench().open()
    asked = requests(REQUESTS)
    stream = b"".join(encode(frame) for frame in asked)
    answers = b""
    while answers.count(0) < len(asked):
        while stream and bench.host.send(stream[:packet]):
            stream = stream[packet:]
        bench.host.wait(POLL_S)
        answers += bench.host.receive()
        assert bench.chip.seconds < LIMIT_S
    bench.host.wait(QUIET_S)
    assert_answers(answers + bench.host.receive(), asked)


@on_a_new_chip
def test_a_chip_whose_answers_nobody_fetches_takes_no_more_and_forgets_nothing() -> None:
    bench = UsbBench().enumerate()
    asked = requests(12)
    waiting = [encode(frame) for frame in asked]
    most_taken = 0
    answers = b""
    for number in range(len(asked)):
        while waiting and bench.packet(Token.OUT, waiting[0]).handshake == Handshake.ACK:
            waiting.pop(0)
        bench.host.wait(QUIET_S)
        most_taken = max(most_taken, len(asked) - len(waiting) - number)
        result = bench.packet(Token.IN)
        assert result.handshake == Handshake.ACK
        answers += result.data
    assert most_taken == TAKEN_AHEAD
    assert bench.packet(Token.IN).handshake == Handshake.NAK
    assert_answers(answers, asked)
