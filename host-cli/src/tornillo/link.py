# SPDX-License-Identifier: Apache-2.0
"""Requests and responses over a byte stream, one at a time.

A request is repeated with the same sequence number until its response comes; the chip does
not execute a repeated request again. Frames that do not belong to the request (late answers,
garbage, half frames) are skipped.
"""

import threading
import time
from typing import Protocol

from tornillo.errors import ChipError, LinkError
from tornillo.frames import DELIMITER, Frame, FrameError, decode, encode
from tornillo.protocol import (
    FRAME_RESPONSE_BIT,
    FRAME_TIMEOUT_MS,
    FRAME_TRIES,
    Command,
    ErrorCode,
    Refusal,
)

READ_SLICE_S = 0.02
LONGEST_FRAME = 64
REFUSAL_SIZE = 2


class Transport(Protocol):
    """What the link needs of a port: pyserial's `Serial` has it."""

    timeout: float | None

    def read(self, size: int = 1, /) -> bytes:
        """Return up to `size` bytes, fewer when `timeout` seconds have passed."""

    def write(self, data: bytes, /) -> int | None:
        """Send all of `data`."""


class Link:
    """The host's end of the link; safe to use from several threads."""

    def __init__(self, transport: Transport, timeout_s: float = FRAME_TIMEOUT_MS / 1000) -> None:
        """Use `transport`; wait `timeout_s` for each answer."""
        self._transport = transport
        self._timeout_s = timeout_s
        self._lock = threading.Lock()
        self._seq = 0
        self._received = bytearray()
        self.repeats = 0
        transport.timeout = min(READ_SLICE_S, timeout_s)

    def request(self, command: Command, payload: bytes = b"") -> bytes:
        """Send a request and return the data of its response, without the error byte.

        Raises ChipError when the chip refuses, LinkError when it does not answer.
        """
        with self._lock:
            self._seq = 0 if command is Command.HELLO else (self._seq + 1) & 0xFF
            response = self._exchange(Frame(self._seq, command, payload))
        if not response:
            raise LinkError(
                f"the answer to {command.name} is empty",
                "use the tornillo version that belongs to this firmware",
            )
        if response[0] == ErrorCode.OK:
            return response[1:]
        raise _refused(command, response)

    def _exchange(self, frame: Frame) -> bytes:
        """Send `frame` until its response arrives; return the response's payload."""
        wire = DELIMITER + encode(frame)
        try:
            for attempt in range(FRAME_TRIES):
                self.repeats += attempt > 0
                self._transport.write(wire)
                response = self._response_to(frame)
                if response is not None:
                    return response
        except OSError as error:
            raise LinkError(
                f"the connection was lost: {error}",
                "check the cable and that the lathe has power, then try again; "
                "a part being cut goes on without the computer",
            ) from error
        raise LinkError(
            f"no answer to {Command(frame.code).name} after {FRAME_TRIES} tries",
            "check that the port is the lathe's and that no other program uses it; "
            "unplug and plug in the cable",
        )

    def _response_to(self, request: Frame) -> bytes | None:
        """Wait for the response to `request`; None when the time is over."""
        deadline = time.monotonic() + self._timeout_s
        while time.monotonic() < deadline:
            encoded = self._next_frame(deadline)
            try:
                frame = decode(encoded)
            except FrameError:
                continue
            if frame.seq == request.seq and frame.code == request.code | FRAME_RESPONSE_BIT:
                return frame.payload
        return None

    def _next_frame(self, deadline: float) -> bytes:
        """Bytes up to the next delimiter; empty when the time is over first."""
        while time.monotonic() < deadline:
            byte = self._transport.read(1)
            if byte == DELIMITER:
                encoded = bytes(self._received)
                self._received.clear()
                return encoded
            self._received += byte
            if len(self._received) > LONGEST_FRAME:
                del self._received[:-LONGEST_FRAME]
        return b""


def _refused(command: Command, response: bytes) -> Exception:
    """The exception for an error response."""
    try:
        code = ErrorCode(response[0])
        if code is ErrorCode.INVALID_PART and len(response) > REFUSAL_SIZE:
            return ChipError(command, code, Refusal(response[1]), response[2])
    except ValueError:
        return LinkError(
            f"the chip refused {command.name} with code {response.hex(' ')}, "
            "which this tornillo does not know",
            "use the tornillo version that belongs to this firmware",
        )
    return ChipError(command, code)
