# SPDX-License-Identifier: Apache-2.0
"""A chip in a socket that is lathe and boot loader by turns, for tests of the host alone.

The loader answers as the protocol page says and keeps what is written; the lathe is a
`ScriptedChip`. Faults are set by the test.
"""

from collections.abc import Callable
from types import SimpleNamespace

from scripted_chip import ScriptedChip, ScriptedPort, refuse
from serial import SerialException, SerialTimeoutException

from tornillo.errors import PortError
from tornillo.firmware_file import BLOCK, ENDS, ERASED, FIRST, Header
from tornillo.frames import crc16
from tornillo.loader import PIECE, LoaderCommand, LoaderResult
from tornillo.opening import WRITE_TIMEOUT_S, Notify
from tornillo.protocol import (
    LOADER_MAGIC,
    REQUESTS,
    USB_LOADER_PRODUCT_ID,
    USB_PRODUCT_ID,
    USB_VENDOR_ID,
    Command,
    ErrorCode,
    State,
)

PACKET = 64
AWAY_S = 1.0
HEAD = 3


class ScriptedLoader:
    """Flash and requests of the boot loader."""

    def __init__(self) -> None:
        """An erased chip."""
        self.flash = bytearray([ERASED]) * 0x8000
        self.version, self.board, self.first, self.end = 1, 1, FIRST, 0x8000
        self.at_write: Callable[[int], None] = lambda _address: None
        self.not_kept = 0
        self.weak: dict[int, int] = {}
        self.results: dict[LoaderCommand, int] = {}
        self.written: list[int] = []
        self.asked: list[bytes] = []

    def put(self, code: bytes) -> None:
        """Let `code` be the program."""
        self.flash[FIRST : FIRST + len(code)] = code

    @property
    def header(self) -> Header:
        """What the program tells about itself."""
        return Header.unpack(bytes(self.flash[FIRST:]))

    @property
    def whole(self) -> bool:
        """Whether the program may be started."""
        crc, end = self.header.crc, self.header.end
        return end in ENDS and crc16(bytes(self.flash[FIRST + 2 : end])) == crc

    def answer(self, packet: bytes) -> bytes:
        """What is answered to one packet."""
        self.asked.append(packet)
        body, crc = packet[:-2], int.from_bytes(packet[-2:], "little")
        if len(packet) == PACKET or crc16(body) != crc:
            result, data = int(LoaderResult.DAMAGED), b""
        else:
            address = int.from_bytes(body[1:HEAD], "little")
            result, data = self._execute(body[0], address, body[HEAD:])
        answer = bytes([packet[0], result]) + data
        return answer + crc16(answer).to_bytes(2, "little")

    def _execute(self, code: int, address: int, data: bytes) -> tuple[int, bytes]:
        """Result and data of a request."""
        if code in self.results:
            return self.results[LoaderCommand(code)], b""
        if code == LoaderCommand.IDENTIFY:
            ends = self.first.to_bytes(2, "little") + self.end.to_bytes(2, "little")
            return 0, bytes([self.version, self.board]) + ends + bytes([self.whole])
        if code == LoaderCommand.GO:
            return (0 if self.whole else int(LoaderResult.NOT_WHOLE)), b""
        if not FIRST <= address < self.end or address % PIECE:
            return int(LoaderResult.BAD_ADDRESS), b""
        if code == LoaderCommand.READ:
            piece = bytearray(self.flash[address : address + PIECE])
            if self.weak.get(address, 0) > 0:
                self.weak[address] -= 1
                piece[5] ^= 1
            return 0, bytes(piece)
        return self._write(address, data), b""

    def _write(self, address: int, data: bytes) -> int:
        """Erase and write; a program that is only written in part has no header."""
        self.at_write(address)
        self.written.append(address)
        if address >= FIRST + BLOCK:
            self._erase(FIRST)
        if address % BLOCK == 0:
            self._erase(address)
        if self.not_kept:
            self.not_kept -= 1
            return int(LoaderResult.NOT_KEPT)
        self.flash[address : address + PIECE] = data
        return 0

    def _erase(self, address: int) -> None:
        """Erase the block that begins at `address`."""
        self.flash[address : address + BLOCK] = bytes([ERASED]) * BLOCK


class ChangingChip(ScriptedChip):
    """A lathe that can go into its boot loader."""

    def __init__(self, socket: "ScriptedSocket") -> None:
        """Sit in `socket`."""
        super().__init__()
        self.socket = socket

    def do_loader(self, payload: bytes) -> bytes:
        """LOADER."""
        if REQUESTS[Command.LOADER].unpack(payload) != (LOADER_MAGIC,):
            raise refuse(ErrorCode.OUT_OF_RANGE, Command.LOADER)
        if self.status.state not in (State.IDLE, State.ALARM):
            raise refuse(ErrorCode.BUSY, Command.LOADER)
        self.socket.change(into_loader=True)
        return b""


class ScriptedSocket:
    """A socket and the chip in it. `now` is the clock of everything, in seconds.

    `usb`: the port is one that USB knows, which goes and comes back with the chip; else it is a
    pseudo-terminal, which stays, and keeps what is written to it while the chip is away.
    """

    def __init__(self) -> None:
        """A lathe at /dev/ttyACM0."""
        self.chip = ChangingChip(self)
        self.loader = ScriptedLoader()
        self.port = "/dev/ttyACM0"
        self.usb = True
        self.location: str | None = "1-2:1.0"
        self.others: list[object] = []
        self.now = 0.0
        self.in_loader = False
        self.away_s = AWAY_S
        self.unplugged = False
        self.lose_answers = 0
        self.damage_requests = 0
        self.blocked_writes = 0
        self.after_open: Callable[[], None] = lambda: None
        self.refuse_to_open: dict[bool, Exception] = {}
        self.opened: list[str] = []
        self.outgoing = bytearray()
        self.coming = bytearray()
        self._back_at = 0.0
        self._lathe = ScriptedPort(self.chip)
        self.comings = 0

    def change(self, into_loader: bool) -> None:
        """Leave the bus and come back as the other one."""
        self.in_loader = into_loader
        self._back_at = self.now + self.away_s
        self.comings += 1
        if not into_loader:
            major, minor, patch, self.chip.protocol = self.loader.flash[FIRST + 17 : FIRST + 21]
            self.chip.firmware = (major, minor, patch)

    @property
    def present(self) -> bool:
        """Whether the chip is on the bus."""
        return not self.unplugged and self.now >= self._back_at

    def comports(self) -> list[object]:
        """The ports as pyserial lists them."""
        if not (self.usb and self.present):
            return self.others
        product = USB_LOADER_PRODUCT_ID if self.in_loader else USB_PRODUCT_ID
        serial = None if self.in_loader else self.chip.serial.decode()
        return [entry(self.port, product, serial, self.location), *self.others]

    def open(self, name: str, _notify: Notify | None = None) -> "SocketPort":
        """Open the port, as `tornillo.opening.open_port` does."""
        if self.in_loader in self.refuse_to_open:
            raise self.refuse_to_open[self.in_loader]
        if self.usb and name != self.port:
            raise PortError(f"there is no port {name}", "check the name")
        self.opened.append(name)
        self.after_open()
        self.outgoing.clear()
        return SocketPort(self)

    def deliver(self, data: bytes = b"") -> None:
        """Give the chip what is for it, when it is there."""
        self.coming += data
        if not self.present:
            return
        while self.coming:
            packet = bytes(self.coming[:PACKET])
            del self.coming[:PACKET]
            answer = self._answered(packet)
            if self.lose_answers > 0 and answer:
                self.lose_answers -= 1
            else:
                self.outgoing += answer

    def _answered(self, packet: bytes) -> bytes:
        """The answer of whoever is there now."""
        if not self.in_loader:
            self._lathe.write(packet)
            return self._lathe.read(PACKET)
        if self.damage_requests:
            self.damage_requests -= 1
            packet = packet[:1] + bytes([packet[1] ^ 4]) + packet[2:]
        answer = self.loader.answer(packet)
        if answer[:2] == bytes([LoaderCommand.GO, 0]):
            self.change(into_loader=False)
        return answer


class SocketPort:
    """An open port; has what `tornillo.link.Transport` asks for."""

    def __init__(self, socket: ScriptedSocket) -> None:
        """Open it for the chip as it is now."""
        self.timeout: float | None = None
        self.closed = False
        self._socket = socket
        self._comings = socket.comings

    def _check(self) -> None:
        """Raise as pyserial does when the chip has left the bus."""
        socket = self._socket
        gone = socket.unplugged or (socket.usb and socket.comings != self._comings)
        if gone and not socket.outgoing:
            raise SerialException("device disconnected")

    @property
    def in_waiting(self) -> int:
        """Bytes that can be read at once."""
        return len(self._socket.outgoing)

    def read(self, size: int = 1, /) -> bytes:
        """Take from the answers."""
        self._socket.deliver()
        self._check()
        if not self._socket.outgoing:
            self._socket.now += self.timeout or 0.0
        data = bytes(self._socket.outgoing[:size])
        del self._socket.outgoing[:size]
        return data

    def write(self, data: bytes, /) -> int:
        """Give a request to the chip."""
        self._check()
        if self._socket.blocked_writes:
            self._socket.blocked_writes -= 1
            self._socket.now += WRITE_TIMEOUT_S
            raise SerialTimeoutException("Write timeout")
        self._socket.deliver(data)
        return len(data)

    def close(self) -> None:
        """Remember that the host closed the port."""
        self.closed = True


def entry(port: str, product: int, serial: str | None, location: str | None) -> object:
    """One of our chips as pyserial lists its port."""
    return SimpleNamespace(
        device=port, vid=USB_VENDOR_ID, pid=product, serial_number=serial, location=location
    )
