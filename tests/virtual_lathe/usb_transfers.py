# SPDX-License-Identifier: Apache-2.0
"""A host controller: whole transfers, made of transactions, any number waiting at a time.

One queue for each endpoint and direction, served in turn, one transaction each; an endpoint that
says NAK is asked again after a pause. Data toggles are kept here and begin anew as the requests
demand that a driver sends. Status is 0 or a negative errno, as Linux has it.
"""

from __future__ import annotations

import errno
import struct
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum

from .chip import CYCLES_PER_SECOND
from .usb_host import Handshake, Result, Token, UsbHost

SILENCES_MAX = 3
BULK_PAUSE_CYCLES = CYCLES_PER_SECOND // 8000
CYCLES_PER_FRAME = CYCLES_PER_SECOND // 1000
STANDARD_TO_DEVICE, STANDARD_TO_INTERFACE, STANDARD_TO_ENDPOINT = 0x00, 0x01, 0x02
CLEAR_FEATURE, SET_CONFIGURATION, SET_INTERFACE = 1, 9, 11
ENDPOINT_HALT = 0


class Stage(Enum):
    """Where a control transfer is; all others are in ``DATA`` for their whole life."""

    SETUP = 0
    DATA = 1
    STATUS = 2


@dataclass(eq=False)
class Transfer:
    """One transfer.

    Args:
        endpoint: number without direction bit; ``into`` is the direction of the data, True for IN.
        data: what goes to the device.
        length: how many bytes are wanted from it.
        setup: the eight bytes of a control transfer, else empty.
        interval: milliseconds between two questions to an interrupt endpoint, 0 for bulk.
        zero_packet: end data that fill their last packet with an empty one.
        short_is_error: fewer bytes than wanted are an error.
    """

    endpoint: int
    into: bool
    data: bytes = b""
    length: int = 0
    setup: bytes = b""
    interval: int = 0
    zero_packet: bool = False
    short_is_error: bool = False
    status: int = 0
    received: bytearray = field(default_factory=bytearray)
    sent: int = 0
    stage: Stage = Stage.DATA
    silences: int = 0
    repeated: bool = False

    def __post_init__(self) -> None:
        """A control transfer begins with its SETUP."""
        if self.setup:
            self.stage = Stage.SETUP

    @property
    def count(self) -> int:
        """Bytes moved so far."""
        return len(self.received) if self.into else self.sent

    @property
    def has_data(self) -> bool:
        """Whether a control transfer has a data stage."""
        return bool(self.length if self.into else self.data)


Pipe = tuple[int, bool]


class HostController:
    """Runs transfers on the bus of a :class:`UsbHost` while simulated time goes on.

    Args:
        host: the cable and its transactions.
        done: called with each transfer that has ended, except those taken back.
        run_to: how to let time pass to a cycle.
    """

    def __init__(
        self,
        host: UsbHost,
        done: Callable[[Transfer], None],
        run_to: Callable[[int], object],
    ) -> None:
        """Begin with nothing to do."""
        self._host = host
        self._done = done
        self._run_to = run_to
        self._queues: dict[Pipe, deque[Transfer]] = {}
        self._toggles: dict[Pipe, int] = {}
        self._next_try: dict[Pipe, int] = {}
        self._sizes: dict[Pipe, int] = {}
        self._interfaces: dict[Pipe, int] = {}

    def begin(self, configuration: bytes) -> None:
        """Forget all transfers and toggles; the sizes of packets are in the configuration."""
        for known in (self._queues, self._toggles, self._next_try, self._sizes):
            known.clear()
        at = interface = 0
        while at + 2 <= len(configuration) and configuration[at] >= 2:
            if configuration[at + 1] == 4:
                interface = configuration[at + 2]
            elif configuration[at + 1] == 5:
                address, size = configuration[at + 2], configuration[at + 4 : at + 6]
                pipe = address & 15, bool(address & 0x80)
                self._sizes[pipe] = int.from_bytes(size, "little") & 0x7FF
                self._interfaces[pipe] = interface
            at += configuration[at]

    def submit(self, transfer: Transfer) -> None:
        """Queue a transfer behind those of its endpoint."""
        pipe = self._pipe(transfer)
        if transfer.endpoint and pipe not in self._sizes:
            transfer.status = -errno.ENOENT
            self._done(transfer)
            return
        self._queues.setdefault(pipe, deque()).append(transfer)

    def cancel(self, transfer: Transfer) -> bool:
        """Take a transfer back; False when it has ended already."""
        queue = self._queues.get(self._pipe(transfer), deque())
        if transfer not in queue:
            return False
        queue.remove(transfer)
        return True

    @property
    def waiting(self) -> int:
        """Transfers that have not ended."""
        return sum(len(queue) for queue in self._queues.values())

    def run(self, until: int) -> None:
        """Run transactions and simulated time up to a cycle."""
        chip = self._host.chip
        while chip.cycle < until:
            now = chip.cycle
            busy = [pipe for pipe, queue in self._queues.items() if queue]
            due = [pipe for pipe in busy if self._next_try.get(pipe, 0) <= now]
            for pipe in due:
                self._transaction(pipe)
            if not due:
                times = [self._next_try[pipe] for pipe in busy]
                self._run_to(min([until, *times]))

    # -- one transaction --------------------------------------------------------------------------

    @staticmethod
    def _pipe(transfer: Transfer) -> Pipe:
        return (0, False) if transfer.endpoint == 0 else (transfer.endpoint, transfer.into)

    def _packet_size(self, pipe: Pipe) -> int:
        return self._sizes[pipe] if pipe[0] else self._host.packet_size

    def _transaction(self, pipe: Pipe) -> None:
        transfer = self._queues[pipe][0]
        token, toggle, data = self._next_packet(pipe, transfer)
        fresh = token == Token.OUT and not transfer.repeated
        result = self._host.transaction(token, pipe[0], toggle, data, fresh=fresh)
        if result.handshake == Handshake.ACK:
            transfer.silences = 0
            transfer.repeated = False
            self._next_try[pipe] = 0
            if token == Token.IN:
                self._received(pipe, transfer, toggle, result)
            else:
                self._sent(pipe, transfer, token, data)
            return
        if result.handshake == Handshake.STALL:
            self._end(pipe, -errno.EPIPE)
            return
        if result.handshake == Handshake.NONE:
            transfer.repeated = True
            transfer.silences += 1
            if transfer.silences == SILENCES_MAX:
                self._end(pipe, -errno.EPROTO)
        self._next_try[pipe] = self._host.chip.cycle + self._pause(transfer)

    @staticmethod
    def _pause(transfer: Transfer) -> int:
        """Cycles to the next try: for an interrupt endpoint the power of two below its interval."""
        if not transfer.interval:
            return BULK_PAUSE_CYCLES
        frames = 1 << (min(transfer.interval, 32).bit_length() - 1)
        return frames * CYCLES_PER_FRAME

    def _next_packet(self, pipe: Pipe, transfer: Transfer) -> tuple[Token, int, bytes]:
        """Token, data toggle (for IN the one that is expected) and data."""
        if transfer.stage == Stage.SETUP:
            return Token.SETUP, 0, transfer.setup
        if transfer.stage == Stage.STATUS:
            to_device = transfer.into and transfer.has_data
            return (Token.OUT if to_device else Token.IN), 1, b""
        toggle = self._toggles.get(pipe, 0)
        if transfer.into:
            return Token.IN, toggle, b""
        size = self._packet_size(pipe)
        return Token.OUT, toggle, transfer.data[transfer.sent : transfer.sent + size]

    def _received(self, pipe: Pipe, transfer: Transfer, toggle: int, result: Result) -> None:
        if result.toggle != toggle:
            where = f"endpoint {pipe[0]} IN"
            self._host.report_mistake(f"{where}: DATA{result.toggle} instead of DATA{toggle}")
            self._next_try[pipe] = self._host.chip.cycle + self._pause(transfer)
            return
        if transfer.stage == Stage.STATUS:
            self._end(pipe, -errno.EOVERFLOW if result.data else 0)
            return
        self._toggles[pipe] = toggle ^ 1
        transfer.received += result.data
        if len(transfer.received) > transfer.length:
            del transfer.received[transfer.length :]
            self._end(pipe, -errno.EOVERFLOW)
        elif len(transfer.received) == transfer.length or len(result.data) < self._packet_size(
            pipe
        ):
            self._data_over(pipe, transfer)

    def _sent(self, pipe: Pipe, transfer: Transfer, token: Token, data: bytes) -> None:
        if token == Token.SETUP:
            self._toggles[pipe] = 1
            transfer.stage = Stage.DATA if transfer.has_data else Stage.STATUS
            return
        if transfer.stage == Stage.STATUS:
            short = transfer.short_is_error and len(transfer.received) < transfer.length
            self._end(pipe, -errno.EREMOTEIO if short else 0)
            return
        self._toggles[pipe] = self._toggles.get(pipe, 0) ^ 1
        transfer.sent += len(data)
        size = self._packet_size(pipe)
        full = bool(data) and len(data) == size
        if transfer.sent == len(transfer.data) and not (transfer.zero_packet and full):
            self._data_over(pipe, transfer)

    def _data_over(self, pipe: Pipe, transfer: Transfer) -> None:
        if transfer.setup:
            transfer.stage = Stage.STATUS
            return
        short = transfer.short_is_error and transfer.into
        missing = len(transfer.received) < transfer.length
        self._end(pipe, -errno.EREMOTEIO if short and missing else 0)

    def _end(self, pipe: Pipe, status: int) -> None:
        transfer = self._queues[pipe].popleft()
        transfer.status = status
        if transfer.setup and status == 0:
            self._follow(transfer.setup)
        self._done(transfer)

    def _follow(self, setup: bytes) -> None:
        """Begin toggles anew where the request made the device do it."""
        kind, request, value, index, _ = struct.unpack("<BBHHH", setup)
        if (kind, request) == (STANDARD_TO_ENDPOINT, CLEAR_FEATURE) and value == ENDPOINT_HALT:
            self._toggles[index & 15, bool(index & 0x80)] = 0
        elif (kind, request) == (STANDARD_TO_DEVICE, SET_CONFIGURATION):
            self._toggles = {}
        elif (kind, request) == (STANDARD_TO_INTERFACE, SET_INTERFACE):
            for pipe, interface in self._interfaces.items():
                if interface == index:
                    self._toggles[pipe] = 0
