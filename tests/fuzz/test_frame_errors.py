# SPDX-License-Identifier: Apache-2.0
"""Every single wrong bit and every burst up to 16 bits in a frame is noticed, here and on the chip.

A burst is a run of up to 16 bits, in the order of the CRC, of which the first and the last are
wrong. The CRC covers what is between the framing bytes (COBS), and notices all of them there. A
burst that hits a framing byte joins or cuts blocks far away, which no CRC of 16 bits can notice
without exception: for those the fraction is bounded, 1 in 65,536 being what chance gives. (The
packets of USB have a CRC of their own, below all this.)
"""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest
from simulated.processes import on_a_new_chip
from tornillo.frames import Frame, FrameError, cobs_encode, crc16, decode
from tornillo.protocol import REQUESTS, Command

from fuzz.target import Target, frame

BURST_BITS = 16
PIECE = REQUESTS[Command.UPLOAD_DATA].pack(32) + bytes((i * 37 + 11) % 255 + 1 for i in range(32))
FRAMES = {
    "no payload": Frame(1, Command.STATUS, b""),
    "zeros in it": Frame(7, Command.SETTING_SET, REQUESTS[Command.SETTING_SET].pack(2, 3575)),
    "a piece of a part": Frame(3, Command.UPLOAD_DATA, PIECE),
    "the longest": Frame(200, 0x55, bytes((i * 91 + 5) % 256 for i in range(56))),
}


def body_of(sent: Frame) -> bytes:
    """What the CRC covers, and the CRC."""
    data = bytes((sent.seq, sent.code)) + sent.payload
    return data + crc16(data).to_bytes(2, "little")


def difference(body: bytes, bit: int) -> int:
    """How far one wrong bit, counted from the end, puts computed and received CRC apart."""
    wrong = (int.from_bytes(body, "big") ^ 1 << bit).to_bytes(len(body), "big")
    return crc16(wrong[:-2]) ^ int.from_bytes(wrong[-2:], "little")


@pytest.mark.parametrize("sent", FRAMES.values(), ids=FRAMES.keys())
def test_the_host_notices_every_burst(sent: Frame) -> None:
    # The CRC is linear: what a burst does is the sum of what its bits do.
    body = body_of(sent)
    bits = [difference(body, bit) for bit in range(8 * len(body))]
    # The CRC goes low byte first, so its bits come in another order than they are computed.
    order = [*range(8, 16), *range(8), *range(16, 8 * len(body))]
    in_order = [bits[i] for i in order]
    for first in range(len(in_order)):
        window = in_order[first : first + BURST_BITS]
        sums = {window[0]}
        for one in window[1:]:
            assert 0 not in sums
            sums |= {value ^ one for value in sums}
        assert 0 not in sums


@pytest.mark.parametrize("sent", FRAMES.values(), ids=FRAMES.keys())
def test_the_host_notices_every_wrong_bit_on_the_wire(sent: Frame) -> None:
    wire = cobs_encode(body_of(sent))
    for bit in range(8 * len(wire)):
        assert survivors(wire, 1 << bit) == []


def survivors(wire: bytes, wrong: int) -> list[Frame]:
    """The frames that a receiver takes from a damaged one."""
    damaged = (int.from_bytes(wire, "big") ^ wrong).to_bytes(len(wire), "big")
    found = []
    for chunk in damaged.split(b"\0"):
        try:
            found.append(decode(chunk))
        except FrameError:
            continue
    return found


def test_a_burst_over_framing_bytes_is_noticed_as_well_as_chance_allows() -> None:
    chance = random.Random(6)
    tries, missed = 200_000, 0
    wires = [cobs_encode(body_of(sent)) for sent in FRAMES.values()]
    for _ in range(tries):
        wire = chance.choice(wires)
        pattern = chance.getrandbits(BURST_BITS) | 1
        missed += bool(survivors(wire, pattern << chance.randrange(8 * len(wire) - BURST_BITS)))
    assert missed <= 4 * tries / 65_536


def bursts(size: int, chance: random.Random) -> Iterator[int]:
    """At every position and of every length: the ends alone, all bits, and some between."""
    for first in range(8 * size):
        for length in range(1, min(BURST_BITS, 8 * size - first) + 1):
            ends = 1 | 1 << (length - 1)
            for pattern in {ends, (1 << length) - 1, ends | chance.getrandbits(length)}:
                yield pattern << first


@pytest.mark.parametrize("sent", FRAMES.values(), ids=FRAMES.keys())
@on_a_new_chip
def test_the_chip_notices_bursts_at_every_position(sent: Frame) -> None:
    target = Target()
    target.check_alive()
    bench, chip = target.bench, target.bench.chip
    body = body_of(sent)
    before = chip.variable("frame_bad_frames", 2)
    damaged = []
    for wrong in bursts(len(body) - 2, random.Random(6)):
        data = (int.from_bytes(body[:-2], "big") ^ wrong).to_bytes(len(body) - 2, "big")
        damaged.append(cobs_encode(data + body[-2:]) + b"\0")
    for start in range(0, len(damaged), 50):
        chunk = damaged[start : start + 50]
        bench.send_raw(b"".join(chunk))
        bench.host.wait(0.02)
        while chip.variable("usb_received"):
            bench.host.wait(0.001)
        assert chip.variable("frame_bad_frames", 2) == before + len(chunk)
        before += len(chunk)
        if before > 60_000:
            before = 0
            chip.set_variable("frame_bad_frames", 0, 2)
    assert bench.host.receive() == b""
    target.check()


@on_a_new_chip
def test_the_chip_and_the_host_compute_the_same_crc() -> None:
    target = Target()
    target.check_alive()
    bench = target.bench
    chance = random.Random(7)
    for size in range(57):
        payload = chance.randbytes(size)
        answer = bench.ask(size + 1, 0x7F, payload)
        assert len(answer) == 1
    damaged = bytearray(frame(1, Command.STATUS))
    damaged[1] ^= 1
    bench.send_raw(bytes(damaged))
    assert bench.receive_raw(timeout=0.01) == []
