# SPDX-License-Identifier: Apache-2.0
"""The dialogue with the boot loader: one packet asks, one answers, one at a time.

docs/protocol.md, section "The boot loader", has the bytes. A request that is not answered, or
arrives damaged, is repeated; each may be executed twice without harm. Nothing is known about
the port but what `tornillo.link.Transport` says, so a test may put anything in its place.
"""

import time
from collections.abc import Callable
from enum import IntEnum
from struct import Struct
from typing import NamedTuple

from tornillo.errors import LoaderError
from tornillo.frames import crc16
from tornillo.language import _, later
from tornillo.link import READ_SLICE_S, Transport
from tornillo.protocol import FRAME_TIMEOUT_MS, FRAME_TRIES

#: Version of this dialogue.
LOADER_VERSION = 1
#: Bytes of one request to read or to write.
PIECE = 32
LONGEST_ANSWER = 64
HEAD = Struct("<BH")
ANSWER_HEAD = 2
CRC_BYTES = 2
#: A line on which nothing came for so long, in seconds, has no late answer left.
QUIET_S = 0.05
#: The address of requests that need none.
NOWHERE = 0


class LoaderCommand(IntEnum):
    """First byte of a request and of its answer."""

    IDENTIFY = ord("I")
    WRITE = ord("W")
    READ = ord("R")
    GO = ord("G")


class LoaderResult(IntEnum):
    """Second byte of an answer."""

    DONE = 0
    DAMAGED = 1
    UNKNOWN_COMMAND = 2
    BAD_ADDRESS = 3
    NOT_KEPT = 4
    NOT_WHOLE = 5


class Identity(NamedTuple):
    """What the loader tells about chip and program; the program ends before `end`."""

    version: int
    board: int
    first: int
    end: int
    whole: bool


IDENTITY = Struct("<BBHH?")


#: What a result means, and what a person does next.
EXPLAINED = {
    LoaderResult.DAMAGED: (
        later("requests arrive damaged"),
        later("use another USB cable or port, away from motor cables"),
    ),
    LoaderResult.NOT_KEPT: (
        later("the chip's memory does not keep what was written"),
        later("try again; if it stays, the supply is weak or the chip is worn out"),
    ),
    LoaderResult.NOT_WHOLE: (
        later("the program in the chip is not whole"),
        later("write it again with the same command"),
    ),
}


class LoaderRefusedError(LoaderError):
    """The loader said no; `result` why."""

    def __init__(self, command: LoaderCommand, result: int) -> None:
        """Keep the result, and put it into words."""
        found = next((EXPLAINED[known] for known in EXPLAINED if known == result), None)
        cause, remedy = found or (
            later("result {result}, which has no meaning for this tornillo"),
            later("use the tornillo version that belongs to this boot loader"),
        )
        super().__init__(
            _("the boot loader refused {command}: {cause}").format(
                command=command.name, cause=_(cause).format(result=int(result))
            ),
            _(remedy),
        )
        self.result = result


class Loader:
    """The boot loader at the other end of a port."""

    def __init__(
        self,
        transport: Transport,
        timeout_s: float = FRAME_TIMEOUT_MS / 1000,
        clock: Callable[[], float] | None = None,
    ) -> None:
        """Talk over `transport`; wait `timeout_s` for each answer, in the seconds of `clock`."""
        self._transport = transport
        self._timeout_s = timeout_s
        self.clock = clock or time.monotonic
        self.repeats = 0
        transport.timeout = min(READ_SLICE_S, timeout_s)

    def identify(self, tries: int = FRAME_TRIES) -> Identity:
        """What the loader tells; raises LoaderError when nothing answers as a loader does."""
        data = self._ask(LoaderCommand.IDENTIFY, NOWHERE, answer=IDENTITY.size, tries=tries)
        return Identity(*IDENTITY.unpack(data))

    def write(self, address: int, data: bytes) -> None:
        """Write PIECE bytes, erasing the block first when it begins at `address`."""
        self._ask(LoaderCommand.WRITE, address, data)

    def read(self, address: int) -> bytes:
        """PIECE bytes from `address` on."""
        return self._ask(LoaderCommand.READ, address, answer=PIECE)

    def go(self) -> None:
        """Start the program; raises LoaderRefusedError when it is not whole."""
        self._ask(LoaderCommand.GO, NOWHERE)

    def close(self) -> None:
        """Close the port, if it can be closed."""
        close = getattr(self._transport, "close", None)
        if close is not None:
            close()

    def _ask(
        self,
        command: LoaderCommand,
        address: int,
        data: bytes = b"",
        answer: int = 0,
        tries: int = FRAME_TRIES,
    ) -> bytes:
        """Send a request until it is answered with `answer` bytes of data; return them.

        Raises LoaderRefusedError when the loader says no, LoaderError when it does not answer or
        the port is gone.
        """
        body = HEAD.pack(command, address) + data
        packet = body + crc16(body).to_bytes(CRC_BYTES, "little")
        result: int | None = None
        try:
            for number in range(tries):
                self.repeats += number > 0
                result, found = self._exchange(packet, command, answer)
                if number > 0 or result == LoaderResult.DAMAGED:
                    self._forget_late_answers()
                if result not in (None, LoaderResult.DAMAGED):
                    break
        except OSError as error:
            raise LoaderError(
                _("the connection was lost: {error}").format(error=error),
                _("check the cable and that the lathe has power, then type the same command again"),
            ) from error
        if result is None:
            raise LoaderError(
                _("the boot loader does not answer {command} after {tries} tries").format(
                    command=command.name, tries=tries
                ),
                _("plug the cable out and in again, then type the same command again"),
            )
        if result != LoaderResult.DONE:
            raise LoaderRefusedError(command, result)
        return found

    def _exchange(
        self, packet: bytes, command: LoaderCommand, size: int
    ) -> tuple[int | None, bytes]:
        """Send a packet and wait for its answer; None when there is none in time."""
        from serial import SerialTimeoutException

        end = self.clock() + self._timeout_s
        try:
            self._transport.write(packet)
        except SerialTimeoutException:
            return None, b""
        received = b""
        while self.clock() < end:
            received += self._transport.read(self._waiting())
            found = _answer(received, command, size)
            if found is not None:
                return found
        return None, b""

    def _waiting(self) -> int:
        """How many bytes to ask for: those that are there, or the first that comes."""
        waiting = getattr(self._transport, "in_waiting", 0)
        return min(max(waiting, 1), LONGEST_ANSWER)

    def _forget_late_answers(self) -> None:
        """Drop what comes until nothing more does: answers to earlier tries of a request."""
        end = self.clock() + self._timeout_s
        quiet = self.clock() + QUIET_S
        while self.clock() < min(end, quiet):
            if self._transport.read(self._waiting()):
                quiet = self.clock() + QUIET_S


def _answer(received: bytes, command: int, size: int) -> tuple[int, bytes] | None:
    """Result and data of the answer in `received`, wherever it begins; None when it is not whole.

    `size` bytes of data come with the result DONE, none with any other.
    """
    for start in range(len(received) - ANSWER_HEAD):
        if received[start] != command:
            continue
        result = received[start + 1]
        whole = ANSWER_HEAD + (size if result == LoaderResult.DONE else 0)
        packet = received[start : start + whole + CRC_BYTES]
        if len(packet) == whole + CRC_BYTES and crc16(packet[:whole]) == int.from_bytes(
            packet[whole:], "little"
        ):
            return result, packet[ANSWER_HEAD:whole]
    return None


def answers(transport: Transport) -> bool:
    """Whether a boot loader is at the other end; asked twice, half a second at most."""
    try:
        Loader(transport).identify(tries=2)
    except LoaderError:
        return False
    return True
