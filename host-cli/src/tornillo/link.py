# SPDX-License-Identifier: Apache-2.0
"""Requests and responses over a byte stream, one at a time.

A request is repeated with the same sequence number until its response comes; the chip does
not execute a repeated request again. Frames that do not belong to the request (late answers,
garbage, half frames) are skipped.

A request takes REQUEST_S at most, whatever the line does: that is one time-out more than its
tries need, for writing that is held up.
"""

import threading
import time
from typing import Protocol

from tornillo.errors import ChipError, LinkError, NoAnswerError
from tornillo.frames import DELIMITER, Frame, FrameError, decode, encode
from tornillo.language import _
from tornillo.protocol import (
    FRAME_RESPONSE_BIT,
    FRAME_TIMEOUT_MS,
    FRAME_TRIES,
    Command,
    ErrorCode,
    Refusal,
)

REQUEST_S = (FRAME_TRIES + 1) * FRAME_TIMEOUT_MS / 1000
READ_SLICE_S = 0.02
LONGEST_FRAME = 64
REFUSAL_SIZE = 2


class Transport(Protocol):
    """What the link needs of a port: pyserial's `Serial` has it.

    An attribute `in_waiting`, the number of bytes that can be read at once, makes it faster; a
    method `close` is called by `Link.close`.
    """

    timeout: float | None

    def read(self, size: int = 1, /) -> bytes:
        """Return up to `size` bytes, fewer when `timeout` seconds have passed."""

    def write(self, data: bytes, /) -> int | None:
        """Send all of `data`."""


class Link:
    """The host's end of the link; safe to use from several threads."""

    def __init__(self, transport: Transport, timeout_s: float = FRAME_TIMEOUT_MS / 1000) -> None:
        """Use `transport`; wait `timeout_s` for each answer, and six times that in all."""
        self._transport = transport
        self._timeout_s = timeout_s
        self._lock = threading.Lock()
        self._seq = 0
        self._received = bytearray()
        self._closed = False
        self.repeats = 0
        self.heard = 0
        transport.timeout = min(READ_SLICE_S, timeout_s)

    def request(self, command: Command, payload: bytes = b"") -> bytes:
        """Send a request and return the data of its response, without the error byte.

        Raises ChipError when the chip refuses, NoAnswerError when it does not answer, LinkError
        when the connection is lost or closed. A request of another thread that is under way
        comes to its end first.
        """
        with self._lock:
            if self._closed:
                raise LinkError(_("the port has been closed"), _("open the lathe again"))
            self._seq = 0 if command is Command.HELLO else (self._seq + 1) & 0xFF
            response = self._exchange(Frame(self._seq, command, payload))
        if not response:
            raise LinkError(
                _("the answer to {command} is empty").format(command=command.name),
                _("use the tornillo version that belongs to this firmware"),
            )
        if response[0] == ErrorCode.OK:
            return response[1:]
        raise _refused(command, response)

    def close(self) -> None:
        """Close the port when the request under way has come to its end."""
        with self._lock:
            self._closed = True
            close = getattr(self._transport, "close", None)
            if close is not None:
                close()

    def _exchange(self, frame: Frame) -> bytes:
        """Send `frame` until its response arrives; return the response's payload."""
        wire = DELIMITER + encode(frame)
        self.heard = 0
        last_try = time.monotonic() + FRAME_TRIES * self._timeout_s
        end = last_try + self._timeout_s
        tries = 0
        try:
            while tries < FRAME_TRIES and time.monotonic() < last_try:
                self.repeats += tries > 0
                tries += 1
                if not self._written(wire):
                    continue
                response = self._response_to(frame, min(time.monotonic() + self._timeout_s, end))
                if response is not None:
                    return response
        except OSError as error:
            raise LinkError(
                _("the connection was lost: {error}").format(error=error),
                _(
                    "check the cable and that the lathe has power, then try again; a part "
                    "being cut goes on without the computer"
                ),
            ) from error
        raise NoAnswerError(
            _("no answer to {name} after {tries} tries").format(
                name=Command(frame.code).name, tries=tries
            ),
            _(
                "check that the port is the lathe's and that no other program uses it; "
                "unplug and plug in the cable; a part being cut goes on without the "
                "computer"
            ),
            self.heard,
        )

    def _written(self, wire: bytes) -> bool:
        """Send `wire`; False when the port does not take it in its own time.

        The delimiter in front of the next try ends what a half-written one left.
        """
        try:
            self._transport.write(wire)
        except OSError as error:
            if _timed_out(error):
                return False
            raise
        return True

    def _response_to(self, request: Frame, deadline: float) -> bytes | None:
        """Wait for the response to `request`; None when the time is over."""
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
        while DELIMITER not in self._received:
            if time.monotonic() >= deadline:
                return b""
            del self._received[:-LONGEST_FRAME]
            waiting = getattr(self._transport, "in_waiting", 0)
            found = self._transport.read(min(max(waiting, 1), LONGEST_FRAME))
            self.heard += len(found)
            self._received += found
        encoded, _, rest = self._received.partition(DELIMITER)
        self._received = rest
        return bytes(encoded)


def _timed_out(error: OSError) -> bool:
    """Whether a port has given up writing because the other side takes nothing."""
    from serial import SerialTimeoutException

    return isinstance(error, SerialTimeoutException)


def _refused(command: Command, response: bytes) -> Exception:
    """The exception for an error response."""
    try:
        code = ErrorCode(response[0])
        if code is ErrorCode.INVALID_PART and len(response) > REFUSAL_SIZE:
            return ChipError(command, code, Refusal(response[1]), response[2])
    except ValueError:
        return LinkError(
            _(
                "the chip refused {command} with code {hex}, which this tornillo does not know"
            ).format(command=command.name, hex=response.hex(" ")),
            _("use the tornillo version that belongs to this firmware"),
        )
    return ChipError(command, code)
