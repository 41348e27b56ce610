# SPDX-License-Identifier: Apache-2.0
"""Exports the simulated device over USB/IP: a Linux machine with ``vhci-hcd`` attaches it.

The other machine's kernel is the host then, with its own drivers. It asks in transfers, which the
model of a host controller runs on the simulated bus; simulated time runs on all the while. One
machine at a time can have the device.
"""

from __future__ import annotations

import errno
import select
import socket
from collections.abc import Callable

from .chip import CYCLES_PER_SECOND
from .usb_host import DEVICE_ADDRESS, RECOVERY_S, SET_ADDRESS, UsbError, UsbHost
from .usb_transfers import HostController, Transfer
from .usbip_messages import (
    BUS_ID_BYTES,
    MESSAGE_BYTES,
    OPERATION,
    Answer,
    Code,
    Command,
    Exported,
    Flag,
    MessageError,
    Request,
    parse_message,
    parse_operation,
    reply_import,
    reply_list,
    return_submit,
    return_unlink,
)

BUS_ID, BUS, NUMBER = "1-1", 1, 2
#: How long transfers run before the sockets are looked at again, in cycles.
SLICE_CYCLES = CYCLES_PER_SECOND // 2000
CHUNK = 65536


class Client:
    """One connection: bytes that wait on both sides, and whether it has imported the device."""

    def __init__(self, connection: socket.socket) -> None:
        """Take a connection over."""
        connection.setblocking(False)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.connection = connection
        self.received = b""
        self.to_send = b""
        self.imported = False
        self.closing = False
        self.transfers: dict[int, tuple[Request, Transfer]] = {}

    def take(self, count: int) -> bytes | None:
        """Remove ``count`` received bytes; None when there are fewer."""
        if len(self.received) < count:
            return None
        taken, self.received = self.received[:count], self.received[count:]
        return taken

    def exchange(self) -> None:
        """Send and receive what goes without waiting."""
        try:
            if self.to_send:
                self.to_send = self.to_send[self.connection.send(self.to_send) :]
            chunk = self.connection.recv(CHUNK)
            self.closing = self.closing or not chunk
            self.received += chunk
        except BlockingIOError:
            return
        except OSError:
            self.closing = True


class Exporter:
    """The server end of USB/IP for the device behind a :class:`UsbHost`.

    Args:
        host: the cable; the device must not be used through it in other ways.
        address: host name and port to listen on; port 0 takes a free one, see :attr:`port`.
        run_to: how to let simulated time pass to a cycle.

    Raises:
        OSError: the address cannot be listened on.
    """

    def __init__(
        self, host: UsbHost, address: tuple[str, int], run_to: Callable[[int], object]
    ) -> None:
        """Listen."""
        self._host = host
        self._controller = HostController(host, self._ended, run_to)
        self._run_to = run_to
        self._clients: list[Client] = []
        self._owner: Client | None = None
        self._server = socket.create_server(address)
        self._server.setblocking(False)
        self.port = int(self._server.getsockname()[1])
        self.refused: list[str] = []

    def run(self, until: int) -> None:
        """Serve the clients and the bus up to a cycle."""
        chip = self._host.chip
        while chip.cycle < until:
            self.serve()
            end = min(until, chip.cycle + SLICE_CYCLES)
            if self._owner is None:
                self._run_to(end)
            else:
                self._controller.run(end)

    def serve(self) -> None:
        """Take new connections, read and answer messages, send what is finished."""
        if select.select([self._server], [], [], 0)[0]:
            self._clients.append(Client(self._server.accept()[0]))
        for client in list(self._clients):
            client.exchange()
            try:
                self._read(client)
            except MessageError as error:
                self.refused.append(str(error))
                client.closing = True
            unplugged = client.imported and not self._host.connected
            if client.closing or unplugged:
                self._drop(client)

    def close(self) -> None:
        """Drop all clients and listen no longer."""
        for client in list(self._clients):
            self._drop(client)
        self._server.close()

    # -- clients ----------------------------------------------------------------------------------

    def _drop(self, client: Client) -> None:
        self._clients.remove(client)
        client.connection.close()
        if client is self._owner:
            self._owner = None
            self._controller.begin(b"")

    def _read(self, client: Client) -> None:
        while self._read_message(client) if client.imported else self._read_operation(client):
            pass

    def _read_operation(self, client: Client) -> bool:
        if len(client.received) < OPERATION.size:
            return False
        code = parse_operation(client.received[: OPERATION.size])
        if code == Code.REQUEST_LIST:
            client.take(OPERATION.size)
            exported = self._describe()
            client.to_send += reply_list([exported] if exported is not None else [])
            return True
        raw = client.take(OPERATION.size + BUS_ID_BYTES)
        if raw is None:
            return False
        bus_id = raw[OPERATION.size :].split(b"\0")[0].decode("ascii", "replace")
        self._import(client, bus_id)
        return True

    def _describe(self) -> Exported | None:
        """What the device says about itself; None while there is none to export."""
        host = self._host
        if not host.connected:
            return None
        if not host.description.configuration:
            try:
                host.enumerate()
            except UsbError as error:
                self.refused.append(str(error))
                return None
        found = host.description
        return Exported(BUS_ID, BUS, NUMBER, found.device, found.configuration)

    def _import(self, client: Client, bus_id: str) -> None:
        if bus_id != BUS_ID or not self._host.connected:
            client.to_send += reply_import(Answer.NO_DEVICE)
            return
        if self._owner is not None:
            client.to_send += reply_import(Answer.BUSY)
            return
        device = self._describe()
        if device is None or not self._reset():
            client.to_send += reply_import(Answer.DEVICE_ERROR)
            return
        client.to_send += reply_import(Answer.OK, device)
        client.imported = True
        self._owner = client
        self._controller.begin(device.configuration)

    def _reset(self) -> bool:
        """Bring the device to the address state, as its new host expects; False when it fails."""
        host = self._host
        try:
            host.reset_bus()
            host.wait(RECOVERY_S)
            host.control(0x00, SET_ADDRESS, DEVICE_ADDRESS)
        except UsbError as error:
            self.refused.append(str(error))
            return False
        host.address = DEVICE_ADDRESS
        host.wait(RECOVERY_S)
        return True

    # -- transfers --------------------------------------------------------------------------------

    def _read_message(self, client: Client) -> bool:
        if len(client.received) < MESSAGE_BYTES:
            return False
        request = parse_message(client.received[:MESSAGE_BYTES])
        raw = client.take(MESSAGE_BYTES + request.following)
        if raw is None:
            return False
        if request.device != BUS << 16 | NUMBER:
            raise MessageError(f"device {request.device:#x}, not {BUS << 16 | NUMBER:#x}")
        if request.command == Command.UNLINK:
            self._unlink(client, request)
        else:
            self._submit(client, request, raw[MESSAGE_BYTES:])
        return True

    def _submit(self, client: Client, request: Request, data: bytes) -> None:
        if request.isochronous:
            client.to_send += return_submit(request, -errno.EINVAL, b"", 0)
            return
        transfer = Transfer(
            request.endpoint,
            request.into,
            data=data,
            length=request.length if request.into else 0,
            setup=request.setup if request.endpoint == 0 else b"",
            interval=request.interval if request.endpoint else 0,
            zero_packet=bool(request.flags & Flag.ZERO_PACKET),
            short_is_error=bool(request.flags & Flag.SHORT_NOT_OK),
        )
        client.transfers[request.seqnum] = request, transfer
        self._controller.submit(transfer)

    def _unlink(self, client: Client, request: Request) -> None:
        entry = client.transfers.get(request.victim)
        taken_back = entry is not None and self._controller.cancel(entry[1])
        if taken_back:
            del client.transfers[request.victim]
        client.to_send += return_unlink(request, -errno.ECONNRESET if taken_back else 0)

    def _ended(self, transfer: Transfer) -> None:
        client = self._owner
        if client is None:
            return
        for seqnum, (request, known) in client.transfers.items():
            if known is transfer:
                del client.transfers[seqnum]
                data = bytes(transfer.received) if transfer.into else b""
                client.to_send += return_submit(request, transfer.status, data, transfer.count)
                return
