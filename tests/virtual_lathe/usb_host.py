# SPDX-License-Identifier: Apache-2.0
"""The computer at the other end of the cable.

Single transactions, control transfers, the enumeration as Linux does it, and the serial port of
the CDC-ACM device.
"""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum

from .chip import CYCLES_PER_SECOND, Chip
from .native_library import UsbCountsC, library

PACKET_BYTES = 64
SETUP_TRIES = 3
NAK_PAUSE_S = 60e-6
# Between the end of one control transfer and the next a computer runs its driver.
DRIVER_PAUSE_S = 100e-6
CONTROL_TIMEOUT_S = 5.0
DEBOUNCE_S = 0.1
RESET_S = 0.01
RECOVERY_S = 0.01
DEVICE_ADDRESS = 5

GET_DESCRIPTOR, SET_ADDRESS, SET_CONFIGURATION = 6, 5, 9
DEVICE, CONFIGURATION, STRING, QUALIFIER = 1, 2, 3, 6
ENDPOINT_DESCRIPTOR = 5
SET_LINE_CODING, SET_CONTROL_LINE_STATE = 0x20, 0x22
DTR, RTS = 1, 2
US_ENGLISH = 0x0409


class Token(IntEnum):
    """Kinds of transaction, numbered as the packet identifiers."""

    OUT = 1
    IN = 9
    SETUP = 13


class Handshake(IntEnum):
    """How a transaction ended; ``NONE`` is no answer at all."""

    NONE = 0
    ACK = 1
    NAK = 2
    STALL = 3


class UsbError(OSError):
    """The device did not do what was asked; the message says what and when."""


class UsbStall(UsbError):
    """The device answered with STALL."""


class UsbTimeout(UsbError):
    """The device did not answer, or answered NAK for too long."""


@dataclass(frozen=True)
class Result:
    """Outcome of one transaction; ``data`` and ``toggle`` are of the data packet."""

    handshake: Handshake
    data: bytes
    toggle: int


@dataclass
class Description:
    """What the device said about itself."""

    device: bytes = b""
    configuration: bytes = b""
    strings: dict[int, str] = field(default_factory=dict)
    bulk_in: int = 0
    bulk_out: int = 0
    notification: int = 0


class UsbHost:
    """Host controller and cable of a :class:`Chip`.

    Args:
        chip: the chip; create the host before it runs for the first time.
        run_to: how to let time pass, ``chip.run_to`` unless a whole lathe wants to listen.
    """

    def __init__(self, chip: Chip, run_to: Callable[[int], object] | None = None) -> None:
        """Put engine and host behind the chip, with the cable out."""
        self.chip = chip
        self.description = Description()
        self.address = 0
        self.port_open = False
        self._run_to = run_to if run_to is not None else chip.run_to
        self._native = library()
        self._native.vl_usb_attach()

    # -- cable ------------------------------------------------------------------------------------

    def plug(self) -> None:
        """Put the cable in: VBUS appears, frames begin."""
        self._native.vl_usb_plug(1)

    def unplug(self) -> None:
        """Pull the cable, at this very cycle."""
        self._native.vl_usb_plug(0)
        self.port_open = False

    @property
    def connected(self) -> bool:
        """The cable is in and the device has switched its pull-up on."""
        return bool(self._native.vl_usb_connected())

    def reset_bus(self) -> None:
        """Drive a bus reset of 10 ms; the device falls back to address 0."""
        self._native.vl_usb_reset(1)
        self.wait(RESET_S)
        self._native.vl_usb_reset(0)
        self.address = 0
        self.port_open = False

    def suspend(self, on: bool) -> None:
        """Stop the frames, or resume them."""
        self._native.vl_usb_suspend(int(on))

    def wait(self, seconds: float) -> None:
        """Let simulated time pass."""
        self._run_to(self.chip.cycle + round(seconds * CYCLES_PER_SECOND))

    # -- single transactions ------------------------------------------------------------------

    def transaction(
        self,
        token: Token,
        endpoint: int,
        toggle: int = 0,
        data: bytes = b"",
        address: int = -1,
        fresh: bool = False,
    ) -> Result:
        """Make one transaction and return how it ended; no retries.

        Args:
            token: SETUP, IN or OUT.
            endpoint: number without direction bit, 0..15.
            toggle: data toggle sent with SETUP and OUT, 0 or 1.
            data: at most 64 bytes for SETUP and OUT.
            address: device address; -1 for the present one.
            fresh: an OUT packet that was never sent before: dropping it is a mistake.
        """
        target = self.address if address < 0 else address
        self._native.vl_usb_submit(
            int(token), target, endpoint, toggle, data, len(data), int(fresh)
        )
        buffer = (ctypes.c_uint8 * PACKET_BYTES)()
        count = ctypes.c_uint()
        received = ctypes.c_uint()
        while True:
            result = self._native.vl_usb_result(buffer, ctypes.byref(count), ctypes.byref(received))
            if result >= 0:
                return Result(Handshake(result), bytes(buffer[: count.value]), received.value)
            self._run_to(self.chip.cycle + CYCLES_PER_SECOND // 1000)

    def setup(self, data: bytes, endpoint: int = 0) -> Handshake:
        """Send one SETUP packet of 8 bytes."""
        return self.transaction(Token.SETUP, endpoint, 0, data).handshake

    def _persist(self, token: Token, endpoint: int, toggle: int, data: bytes, what: str) -> Result:
        deadline = self.chip.cycle + round(CONTROL_TIMEOUT_S * CYCLES_PER_SECOND)
        silences = 0
        while self.chip.cycle < deadline and silences < SETUP_TRIES:
            result = self.transaction(token, endpoint, toggle, data)
            if result.handshake == Handshake.ACK:
                return result
            if result.handshake == Handshake.STALL:
                raise UsbStall(f"{what}: STALL")
            silences += result.handshake == Handshake.NONE
            self.wait(NAK_PAUSE_S)
        raise UsbTimeout(f"{what}: no answer at cycle {self.chip.cycle}")

    # -- control transfers ------------------------------------------------------------------------

    def control(
        self,
        request_type: int,
        request: int,
        value: int = 0,
        index: int = 0,
        data: bytes = b"",
        length: int = 0,
    ) -> bytes:
        """Make a control transfer on endpoint 0, with retries.

        Args:
            request_type: bit 7 set reads ``length`` bytes, else ``data`` is sent.
            request: bRequest; ``value`` and ``index`` are wValue and wIndex.

        Returns:
            the bytes read, empty for a write.

        Raises:
            UsbStall: the device refused the request.
            UsbTimeout: the device did not answer.
        """
        what = f"request {request_type:#04x} {request:#04x} value {value:#06x}"
        reading = bool(request_type & 0x80)
        count = length if reading else len(data)
        packet = struct.pack("<BBHHH", request_type, request, value, index, count)
        self.wait(DRIVER_PAUSE_S)
        self._persist(Token.SETUP, 0, 0, packet, what)
        if reading and count:
            received = self._control_in(count, what)
            self._persist(Token.OUT, 0, 1, b"", what + ", status")
            return received
        toggle = 1
        for start in range(0, count, self.packet_size):
            self._persist(Token.OUT, 0, toggle, data[start : start + self.packet_size], what)
            toggle ^= 1
        self._check_toggle(self._persist(Token.IN, 0, 0, b"", what + ", status"), 1, what)
        return b""

    def _control_in(self, count: int, what: str) -> bytes:
        received = b""
        toggle = 1
        while len(received) < count:
            result = self._persist(Token.IN, 0, 0, b"", what)
            self._check_toggle(result, toggle, what)
            toggle ^= 1
            received += result.data
            if len(result.data) < self.packet_size:
                break
        if len(received) > count:
            raise UsbError(f"{what}: {len(received)} bytes instead of {count}")
        return received

    @staticmethod
    def _check_toggle(result: Result, toggle: int, what: str) -> None:
        if result.toggle != toggle:
            raise UsbError(f"{what}: DATA{result.toggle} instead of DATA{toggle}")

    @property
    def packet_size(self) -> int:
        """Largest packet of endpoint 0, from the device descriptor once it is known."""
        return self.description.device[7] if len(self.description.device) >= 8 else 8

    # -- enumeration ----------------------------------------------------------------------------

    def enumerate(self, timeout: float = 1.0) -> Description:
        """Wait for the device and configure it as Linux does, cdc-acm driver included.

        Raises:
            UsbError: the device does not appear in ``timeout`` seconds or misbehaves.
        """
        end = self.chip.cycle + round(timeout * CYCLES_PER_SECOND)
        while not self.connected:
            if self.chip.cycle >= end:
                raise UsbTimeout("the device does not switch its pull-up on")
            self.wait(1e-3)
        self.wait(DEBOUNCE_S)
        self.description = found = Description()
        self.reset_bus()
        self.wait(RECOVERY_S)
        found.device = self.control(0x80, GET_DESCRIPTOR, DEVICE << 8, length=8)
        self.reset_bus()
        self.wait(RECOVERY_S)
        self.control(0x00, SET_ADDRESS, DEVICE_ADDRESS)
        self.address = DEVICE_ADDRESS
        self.wait(RECOVERY_S)
        found.device = self.control(0x80, GET_DESCRIPTOR, DEVICE << 8, length=18)
        self._ask_qualifier()
        head = self.control(0x80, GET_DESCRIPTOR, CONFIGURATION << 8, length=9)
        total = int(struct.unpack_from("<H", head, 2)[0])
        found.configuration = self.control(0x80, GET_DESCRIPTOR, CONFIGURATION << 8, length=total)
        self._read_strings()
        self._find_endpoints()
        self.control(0x00, SET_CONFIGURATION, found.configuration[5])
        self.control(0x21, SET_LINE_CODING, data=struct.pack("<IBBB", 9600, 0, 0, 8))
        self.control(0x21, SET_CONTROL_LINE_STATE, 0)
        return found

    def _ask_qualifier(self) -> None:
        """A full-speed device of USB 2.0 has no qualifier and must refuse."""
        if struct.unpack_from("<H", self.description.device, 2)[0] < 0x0200:
            return
        try:
            self.control(0x80, GET_DESCRIPTOR, QUALIFIER << 8, length=10)
        except UsbStall:
            return
        raise UsbError("a full-speed device must refuse the qualifier descriptor")

    def _read_strings(self) -> None:
        found = self.description
        languages = self.control(0x80, GET_DESCRIPTOR, STRING << 8, length=255)
        language = struct.unpack_from("<H", languages, 2)[0] if len(languages) >= 4 else 0
        for index in sorted(set(found.device[14:17]) - {0}):
            raw = self.control(0x80, GET_DESCRIPTOR, STRING << 8 | index, language, length=255)
            found.strings[index] = raw[2 : raw[0]].decode("utf-16-le")

    def _find_endpoints(self) -> None:
        found = self.description
        at = 0
        while at + 2 <= len(found.configuration):
            length, kind = found.configuration[at], found.configuration[at + 1]
            if length < 2:
                raise UsbError(f"descriptor of length {length} in the configuration")
            if kind == ENDPOINT_DESCRIPTOR:
                address, attributes = found.configuration[at + 2 : at + 4]
                if attributes & 3 == 3:
                    found.notification = address & 15
                elif address & 0x80:
                    found.bulk_in = address & 15
                else:
                    found.bulk_out = address & 15
            at += length

    # -- serial port --------------------------------------------------------------------------

    def open_port(self) -> None:
        """Open the serial port as a program does: line coding, DTR and RTS, polling."""
        self.control(0x21, SET_LINE_CODING, data=struct.pack("<IBBB", 115200, 0, 0, 8))
        self.control(0x21, SET_CONTROL_LINE_STATE, DTR | RTS)
        self.poll()
        self.port_open = True

    def poll(self) -> None:
        """Serve the endpoints of :attr:`description` from now on, as an open port has it."""
        found = self.description
        self._native.vl_usb_open(self.address, found.bulk_in, found.bulk_out, found.notification)

    def close_port(self) -> None:
        """Close the serial port: polling stops, DTR falls."""
        self._native.vl_usb_close()
        self.port_open = False
        self.control(0x21, SET_CONTROL_LINE_STATE, 0)

    def send(self, data: bytes) -> int:
        """Queue bytes for the device; returns how many fitted into the queue of 4,096."""
        return int(self._native.vl_usb_write(data, len(data)))

    @property
    def unsent(self) -> int:
        """Bytes queued and not yet taken by the device."""
        return int(self._native.vl_usb_unsent())

    def receive(self, room: int = 4096) -> bytes:
        """Take up to ``room`` bytes that have come from the device."""
        buffer = (ctypes.c_uint8 * max(room, 1))()
        count = self._native.vl_usb_read(buffer, room)
        return bytes(buffer[:count])

    # -- observation ----------------------------------------------------------------------------

    def lose_handshakes(self, count: int) -> None:
        """Fault injection: the handshakes of the next transactions get lost on the bus."""
        self._native.vl_usb_lose_handshakes(count)

    @property
    def mistakes(self) -> list[str]:
        """What the firmware did that the data sheet forbids; empty is right."""
        found: list[str] = []
        text = ctypes.create_string_buffer(200)
        while self._native.vl_usb_mistake(len(found), text, len(text)) == 0:
            found.append(text.value.decode())
        return found

    def report_mistake(self, what: str) -> None:
        """Add something the device did wrong, as the bus sees it, to :attr:`mistakes`."""
        self._native.vl_usb_report_mistake(what.encode())

    @property
    def counts(self) -> dict[str, int]:
        """Frames, transactions, NAKs, STALLs, timeouts, bytes and wrong toggles so far."""
        counts = UsbCountsC()
        self._native.vl_usb_counts(ctypes.byref(counts))
        return {name: int(getattr(counts, name)) for name, *_ in counts._fields_}
