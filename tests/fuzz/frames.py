# SPDX-License-Identifier: Apache-2.0
"""Frames that are right, damaged, too long, too short, cut, joined or no frames at all.

What the chip must do with each is told by the host's own decoder: answer a frame that is whole
and right, count and drop what is not. Frames that would move the lathe by right are not sent.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field
from pathlib import Path

from tornillo.frames import Frame, FrameError, cobs_encode, crc16, decode
from tornillo.protocol import (
    FRAME_PAYLOAD_MAX,
    FRAME_RESPONSE_BIT,
    REQUESTS,
    Command,
    SettingId,
)
from virtual_lathe.usb_host import UsbError

from fuzz.target import HANG_S, Broken, Target, frame

CORPUS = Path(__file__).with_name("corpus") / "frames.txt"
BATCH = 40
ALIVE_EVERY = 5000
POLL_S = 5e-4
#: Commands that the chip is only asked for when damaged: they move it, or take long.
NOT_BY_RIGHT = {Command.HOME, Command.JOG}
#: Of right frames with these codes most are left out, because they write flash or EEPROM.
SLOW = {
    Command.UPLOAD_BEGIN, Command.UPLOAD_DATA, Command.UPLOAD_COMMIT, Command.PART_SELECT,
    Command.PART_DELETE, Command.SETTING_SET, Command.SERIAL_SET,
}  # fmt: skip


def corpus() -> list[bytes]:
    """The cases kept in the tree: bytes on the wire, delimiters included."""
    lines = CORPUS.read_text(encoding="utf-8").splitlines()
    return [bytes.fromhex(line.split("#")[0]) for line in lines if line.split("#")[0].strip()]


@dataclass
class Counts:
    """Frames sent, and how many of them were right."""

    frames: int = 0
    right: int = 0


@dataclass
class Expected:
    """What the chip must do with the bytes sent so far; the decoder's state goes on."""

    rest: bytes = b""
    answered: tuple[int, int] | None = None
    last_reply: bytes = b""
    right: list[tuple[Frame, bool]] = field(default_factory=list)
    bad: int = 0

    def take(self, stream: bytes) -> None:
        """Follow the bytes as the chip receives them."""
        *chunks, self.rest = (self.rest + stream).split(b"\0")
        for chunk in chunks:
            if not chunk:
                continue
            try:
                found = decode(chunk)
            except FrameError:
                self.bad += 1
                continue
            key = found.seq, crc16(bytes((found.seq, found.code)) + found.payload)
            repeated = key == self.answered and found.code != Command.HELLO
            self.answered = key
            self.right.append((found, repeated))


class FrameFuzzer:
    """Sends frames to a target whose port is open; the same seed sends the same bytes."""

    def __init__(self, target: Target, seed: int) -> None:
        """Open the port and find the chip ready."""
        self._target = target
        self._host = target.bench.host
        self._chance = random.Random(seed)
        self._corpus = corpus()
        self._tail = b""
        self._begin()
        self.counts = Counts()

    def _begin(self) -> None:
        self._target.check_alive()
        self._target.bench.chip.set_variable("frame_bad_frames", 0, 2)
        self._tail = b""
        hello = crc16(bytes((0, Command.HELLO)))
        self._expected = Expected(answered=(0, hello))

    def run(self, frames: int) -> None:
        """Send so many frames more.

        Raises:
            Broken: with the bytes of the batch that did it.
        """
        end = self.counts.frames + frames
        while self.counts.frames < end:
            pieces = [self.piece() for _ in range(min(BATCH, end - self.counts.frames))]
            self.play(pieces)
            if self.counts.frames % ALIVE_EVERY < BATCH:
                self._begin()

    def play(self, pieces: list[bytes]) -> None:
        """Send pieces of a stream and compare what the chip does with what it must do."""
        self.counts.frames += len(pieces)
        expected = self._expected
        stream = b"".join(pieces)
        expected.take(stream)
        self.counts.right += len(expected.right)
        try:
            replies = self._exchange(stream, len(expected.right))
            self._compare(replies)
            self._target.check()
        except (Broken, UsbError) as broken:
            where = f"frame {self.counts.frames}: {' '.join(piece.hex() for piece in pieces)}"
            raise Broken(f"{broken}\nbefore {where}") from broken

    def _exchange(self, stream: bytes, replies: int) -> list[bytes]:
        """Send and wait until everything is taken and answered; the replies."""
        host, chip = self._host, self._target.bench.chip
        received = b""
        deadline = chip.seconds + HANG_S
        while stream or host.unsent or received.count(0) < replies:
            stream = stream[host.send(stream) :]
            host.wait(POLL_S)
            more = host.receive()
            received += more
            if more:
                deadline = chip.seconds + HANG_S
            if chip.seconds > deadline:
                raise Broken(
                    f"{received.count(0)} of {replies} replies, {host.unsent} bytes unsent"
                )
        host.wait(POLL_S)
        while chip.variable("usb_received"):
            host.wait(POLL_S)
            if chip.seconds > deadline:
                raise Broken("the chip does not take the last packet")
        received += host.receive()
        return received.split(b"\0")[:-1]

    def _compare(self, replies: list[bytes]) -> None:
        expected = self._expected
        if len(replies) != len(expected.right):
            raise Broken(f"{len(replies)} replies instead of {len(expected.right)}")
        for raw, (sent, repeated) in zip(replies, expected.right, strict=True):
            reply = decode(raw)
            if (reply.seq, reply.code) != (sent.seq, sent.code | FRAME_RESPONSE_BIT):
                raise Broken(f"{sent} was answered by {reply}")
            if repeated and raw != expected.last_reply:
                raise Broken(f"the repeated {sent} got another answer")
            expected.last_reply = raw
        chip = self._target.bench.chip
        bad = chip.variable("frame_bad_frames", 2)
        if bad != min(expected.bad, 0xFFFF):
            raise Broken(f"{bad} bad frames counted instead of {expected.bad}")
        chip.set_variable("frame_bad_frames", 0, 2)
        expected.bad = 0
        expected.right.clear()

    # -- making pieces -----------------------------------------------------------------------------

    def piece(self) -> bytes:
        """Bytes for one frame, or what takes its place; never one that moves the lathe."""
        while True:
            chance = self._chance
            what = chance.random()
            if what < 0.25:
                piece = self._right()
            elif what < 0.65:
                piece = self._damaged(self._right())
            elif what < 0.8:
                piece = self._false()
            elif what < 0.9:
                piece = self._damaged(chance.choice(self._corpus))
            else:
                piece = self._garbage()
            if self._may_be_sent(piece):
                return piece

    def _may_be_sent(self, piece: bytes) -> bool:
        for chunk in (self._pending() + piece).split(b"\0"):
            try:
                found = decode(chunk) if chunk else None
            except FrameError:
                continue
            if found is None:
                continue
            if found.code in NOT_BY_RIGHT:
                return False
            if found.code in SLOW and self._chance.random() > 0.01:
                return False
        self._tail = (self._pending() + piece).rsplit(b"\0", 1)[-1]
        return True

    def _pending(self) -> bytes:
        """What of the pieces made so far has no delimiter yet."""
        return self._tail

    def _right(self) -> bytes:
        """A frame that is right, with a likely or a random code and payload."""
        chance = self._chance
        code = chance.choice(list(Command)) if chance.random() < 0.8 else chance.randrange(256)
        size = REQUESTS[Command(code)].size if code in list(Command) else chance.randrange(57)
        payload = chance.choice([bytes(size), chance.randbytes(size), b"\xff" * size])
        if code == Command.SETTING_GET:
            payload = bytes([chance.randrange(len(SettingId) + 2)])
        if chance.random() < 0.1:
            payload = chance.randbytes(chance.randrange(FRAME_PAYLOAD_MAX + 1))
        return frame(chance.randrange(256), code, payload)

    def _damaged(self, piece: bytes) -> bytes:
        """A piece with something wrong: bits, bursts, bytes lost, doubled, put in or cut off."""
        chance = self._chance
        data = bytearray(piece)
        at = chance.randrange(len(data))
        what = chance.randrange(8)
        if what == 0:
            data[at] ^= 1 << chance.randrange(8)
        elif what == 1:
            burst = (chance.randrange(1 << 16) | 1) << chance.randrange(8)
            for i, wrong in enumerate(burst.to_bytes(3, "little")):
                if at + i < len(data):
                    data[at + i] ^= wrong
        elif what == 2:
            del data[at]
        elif what == 3:
            data.insert(at, data[at])
        elif what == 4:
            data.insert(at, 0)
        elif what == 5:
            del data[at:]
        elif what == 6:
            data[0] = chance.randrange(256)
        else:
            data[at:at] = chance.randbytes(chance.randrange(1, 70))
        return bytes(data)

    def _false(self) -> bytes:
        """A body that is encoded well and is no frame: wrong CRC or wrong length."""
        chance = self._chance
        body = chance.randbytes(chance.choice([0, 1, 2, 3, 4, 59, 60, 61, 62, 63, 64, 120, 253]))
        if chance.random() < 0.5:
            body += crc16(body).to_bytes(2, "little")
        return cobs_encode(body) + b"\0"

    def _garbage(self) -> bytes:
        chance = self._chance
        size = chance.randrange(1, 100)
        kinds = [chance.randbytes(size), bytes(size % 9 + 1), b"\xff" * size, b"\x01" * size]
        return chance.choice(kinds) + chance.choice([b"", b"\0"])
