# SPDX-License-Identifier: Apache-2.0
"""The device exported over USB/IP, with a client in the place of the other machine's kernel."""

from __future__ import annotations

import errno
import socket
import struct

import pytest
from simulated.processes import at_the_end, on_a_new_chip
from tornillo.frames import Frame, decode, encode
from tornillo.protocol import USB_PRODUCT_ID, USB_VENDOR_ID, Command

from virtual_lathe.chip import CYCLES_PER_SECOND, Chip
from virtual_lathe.lathe import DEFAULT_FIRMWARE
from virtual_lathe.usb_host import UsbHost
from virtual_lathe.usbip import BUS, BUS_ID, NUMBER, Exporter

DEVICE_BYTES, MESSAGE_BYTES = 312, 48
SUBMIT, UNLINK, RETURN_SUBMIT, RETURN_UNLINK = 1, 2, 3, 4
SHORT_NOT_OK, ZERO_PACKET = 1, 0x40
GET_DEVICE = bytes((0x80, 6, 0, 1, 0, 0, 18, 0))
SET_CONFIGURATION_1 = bytes((0, 9, 1, 0, 0, 0, 0, 0))
VENDOR_READ = bytes((0xC0, 1, 0, 0, 0, 0, 4, 0))
STATUS_FRAME = encode(Frame(1, Command.STATUS, b""))


class Client:
    """A machine that speaks USB/IP with the exporter; simulated time passes while it waits."""

    def __init__(self, exporter: Exporter, chip: Chip) -> None:
        """Connect."""
        self._exporter = exporter
        self._chip = chip
        self._socket = socket.create_connection(("127.0.0.1", exporter.port))
        self._socket.setblocking(False)
        self._seqnum = 0

    def pass_time(self, seconds: float = 1e-3) -> None:
        """Let the exporter work."""
        self._exporter.run(self._chip.cycle + round(seconds * CYCLES_PER_SECOND))

    def send(self, data: bytes) -> None:
        """Send bytes as they are."""
        self._socket.sendall(data)

    def receive(self, count: int, tries: int = 2000) -> bytes:
        """Return ``count`` bytes, fewer when the connection has been closed."""
        found = b""
        for _ in range(tries):
            try:
                chunk = self._socket.recv(count - len(found))
            except BlockingIOError:
                self.pass_time()
                continue
            found += chunk
            if not chunk or len(found) == count:
                return found
        raise AssertionError(f"{len(found)} of {count} bytes have come")

    def is_closed(self) -> bool:
        """Whether the exporter has hung up."""
        self.pass_time()
        return self.receive(1) == b""

    def attach(self, bus_id: str = BUS_ID) -> int:
        """Import the device; returns the status, 0 when it is ours."""
        self.send(struct.pack(">HHI32s", 0x0111, 0x8003, 0, bus_id.encode()))
        _, code, status = struct.unpack(">HHI", self.receive(8))
        assert code == 3
        if status == 0:
            self.receive(DEVICE_BYTES)
        return int(status)

    def submit(
        self,
        endpoint: int,
        into: bool,
        *,
        setup: bytes = bytes(8),
        length: int = 0,
        data: bytes = b"",
        flags: int = 0,
        packets: int = 0,
        device: int = BUS << 16 | NUMBER,
    ) -> int:
        """Send CMD_SUBMIT; returns its number."""
        self._seqnum += 1
        count = length if into else len(data)
        head = struct.pack(">IIIII", SUBMIT, self._seqnum, device, int(into), endpoint)
        self.send(head + struct.pack(">IIIII8s", flags, count, 0, packets, 0, setup) + data)
        return self._seqnum

    def answer(self, into: bool) -> tuple[int, int, int, bytes]:
        """Wait for RET_SUBMIT: number, status, bytes moved, data."""
        head = self.receive(MESSAGE_BYTES)
        command, seqnum, _, _, _ = struct.unpack_from(">IIIII", head)
        assert command == RETURN_SUBMIT
        status, count = struct.unpack_from(">ii", head, 20)
        return seqnum, status, count, self.receive(count) if into and count else b""

    def unlink(self, seqnum: int) -> int:
        """Take a transfer back; returns the status."""
        self._seqnum += 1
        device = BUS << 16 | NUMBER
        self.send(struct.pack(">IIIII I24x", UNLINK, self._seqnum, device, 0, 0, seqnum))
        head = self.receive(MESSAGE_BYTES)
        command, number, _, _, _ = struct.unpack_from(">IIIII", head)
        assert (command, number) == (RETURN_UNLINK, self._seqnum)
        return int(struct.unpack_from(">i", head, 20)[0])

    def control(self, setup: bytes, length: int = 0) -> tuple[int, bytes]:
        """Make a control transfer: status and data."""
        into = bool(setup[0] & 0x80)
        self.submit(0, into, setup=setup, length=length)
        _, status, _, data = self.answer(into)
        return status, data


class Exported:
    """A device with its cable in, exported; the firmware may make no mistake."""

    def __init__(self) -> None:
        """Switch it on."""
        self.chip = Chip(DEFAULT_FIRMWARE)
        self.host = UsbHost(self.chip)
        self.exporter = Exporter(self.host, ("127.0.0.1", 0), self.chip.run_to)
        self.host.plug()
        self.chip.run(0.2)
        at_the_end(self._check)

    def _check(self) -> None:
        assert self.host.mistakes == []

    def client(self) -> Client:
        """Another machine."""
        return Client(self.exporter, self.chip)

    def attached(self) -> Client:
        """A machine that has imported and configured the device."""
        client = self.client()
        assert client.attach() == 0
        assert client.control(SET_CONFIGURATION_1) == (0, b"")
        return client


@on_a_new_chip
def test_the_device_is_listed_with_its_interfaces() -> None:
    client = Exported().client()
    client.send(struct.pack(">HHI", 0x0111, 0x8005, 0))
    listed = client.receive(8 + 4 + DEVICE_BYTES + 8)
    assert listed[:12] == struct.pack(">HHII", 0x0111, 5, 0, 1)
    device = listed[12:]
    assert device[256:].startswith(BUS_ID.encode() + b"\0")
    fields = struct.unpack_from(">III HHH BBBBBB", device, 288)
    assert fields == (1, 2, 2, USB_VENDOR_ID, USB_PRODUCT_ID, 0x0100, 2, 2, 0, 1, 1, 2)
    assert device[DEVICE_BYTES:] == bytes((2, 2, 0, 0, 0x0A, 0, 0, 0))


@on_a_new_chip
def test_nothing_is_listed_or_given_while_the_cable_is_out() -> None:
    exported = Exported()
    exported.host.unplug()
    client = exported.client()
    client.send(struct.pack(">HHI", 0x0111, 0x8005, 0))
    assert client.receive(12) == struct.pack(">HHII", 0x0111, 5, 0, 0)
    assert client.attach() == 4


@on_a_new_chip
def test_one_machine_at_a_time_has_the_device() -> None:
    exported = Exported()
    first, second = exported.client(), exported.client()
    assert second.attach("2-1") == 4
    assert first.attach() == 0
    assert second.attach() == 2
    first.send(b"")
    assert first.control(GET_DEVICE, 18)[1][:2] == b"\x12\x01"


@on_a_new_chip
def test_control_transfers_succeed_and_are_refused() -> None:
    client = Exported().attached()
    status, device = client.control(GET_DEVICE, 18)
    assert (status, len(device)) == (0, 18)
    assert client.control(VENDOR_READ, 4) == (-errno.EPIPE, b"")
    coding = b"\x80\x25\0\0\0\0\x08"
    client.submit(0, False, setup=bytes((0x21, 0x20, 0, 0, 0, 0, 7, 0)), data=coding)
    assert client.answer(into=False)[1:3] == (0, 7)
    assert client.control(bytes((0xA1, 0x21, 0, 0, 0, 0, 7, 0)), 7) == (0, coding)


@on_a_new_chip
def test_bulk_transfers_go_both_ways_at_the_same_time() -> None:
    client = Exported().attached()
    reading = client.submit(2, True, length=64)
    writing = client.submit(2, False, data=STATUS_FRAME)
    sent = client.answer(into=False)
    assert sent[:3] == (writing, 0, len(STATUS_FRAME))
    seqnum, status, _, reply = client.answer(into=True)
    assert (seqnum, status) == (reading, 0)
    assert decode(reply[:-1]).code == Command.STATUS | 0x80


@on_a_new_chip
def test_a_long_transfer_is_cut_into_packets() -> None:
    client = Exported().attached()
    client.submit(2, False, data=bytes(200), flags=ZERO_PACKET)
    assert client.answer(into=False)[1:3] == (0, 200)
    client.submit(2, False, data=bytes(128), flags=ZERO_PACKET)
    assert client.answer(into=False)[1:3] == (0, 128)
    client.submit(2, False, data=STATUS_FRAME)
    client.answer(into=False)
    client.submit(2, True, length=1024)
    assert decode(client.answer(into=True)[3][:-1]).seq == 1


@on_a_new_chip
def test_the_notification_comes_by_the_interrupt_endpoint() -> None:
    client = Exported().attached()
    client.submit(1, True, length=16, flags=SHORT_NOT_OK)
    _, status, count, news = client.answer(into=True)
    assert (status, count, news[:2]) == (-errno.EREMOTEIO, 10, b"\xa1\x20")


@on_a_new_chip
def test_a_waiting_transfer_is_taken_back_and_a_finished_one_is_not() -> None:
    client = Exported().attached()
    waiting = client.submit(2, True, length=64)
    client.pass_time(0.01)
    assert client.unlink(waiting) == -errno.ECONNRESET
    finished = client.submit(0, True, setup=GET_DEVICE, length=18)
    client.answer(into=True)
    assert client.unlink(finished) == 0
    assert client.unlink(999) == 0


@on_a_new_chip
def test_unknown_endpoints_and_isochronous_transfers_are_refused() -> None:
    client = Exported().attached()
    client.submit(5, True, length=8)
    assert client.answer(into=True)[1] == -errno.ENOENT
    client.submit(2, True, length=64, packets=1)
    client.send(bytes(16))
    assert client.answer(into=True)[1] == -errno.EINVAL


@on_a_new_chip
def test_toggles_begin_anew_with_the_configuration_and_the_halt() -> None:
    client = Exported().attached()
    for begin in (SET_CONFIGURATION_1, bytes((2, 1, 0, 0, 2, 0, 0, 0))):
        client.submit(2, False, data=b"\0")
        assert client.answer(into=False)[1] == 0
        assert client.control(begin) == (0, b"")
        client.submit(2, False, data=STATUS_FRAME)
        client.answer(into=False)
        client.submit(2, True, length=64)
        assert decode(client.answer(into=True)[3][:-1]).code == Command.STATUS | 0x80


@on_a_new_chip
def test_the_connection_ends_with_the_cable_and_the_device_is_free_again() -> None:
    exported = Exported()
    client = exported.attached()
    client.submit(2, True, length=64)
    exported.host.unplug()
    assert client.is_closed()
    exported.host.plug()
    exported.chip.run(0.2)
    assert exported.client().attach() == 0


@pytest.mark.parametrize(
    "garbage",
    [
        struct.pack(">HHI", 0x0100, 0x8005, 0),
        struct.pack(">HHI", 0x0111, 0x8001, 0),
    ],
    ids=["another version", "no such operation"],
)
@on_a_new_chip
def test_garbage_before_the_import_ends_the_connection(garbage: bytes) -> None:
    exported = Exported()
    client = exported.client()
    client.send(garbage)
    assert client.is_closed()
    assert exported.client().attach() == 0


@pytest.mark.parametrize("words", [(9, 1, 0x10002, 0, 0), (1, 1, 7, 0, 0), (1, 1, 0x10002, 2, 0)])
@on_a_new_chip
def test_garbage_after_the_import_ends_the_connection(words: tuple[int, ...]) -> None:
    exported = Exported()
    client = exported.attached()
    client.send(struct.pack(">IIIII", *words) + bytes(28))
    assert client.is_closed()
    assert len(exported.exporter.refused) == 1
    assert exported.client().attach() == 0
