# SPDX-License-Identifier: Apache-2.0
"""What the USB and frame tests share: the firmware on a simulated chip with a USB host.

Times are simulated seconds, cycles are instruction cycles. That the firmware makes no mistake with
the USB engine and never restarts is checked at the end of every test.
"""

from __future__ import annotations

from pathlib import Path

from executed.record import RECORDER
from simulated.processes import at_the_end, in_any_case
from tornillo.frames import Frame, decode, encode
from virtual_lathe.chip import Chip, NonVolatile
from virtual_lathe.usb_host import Handshake, Result, Token, UsbHost, UsbStall

FIRMWARE = Path(__file__).resolve().parents[2] / "build" / "firmware" / "tornillo.hex"
SERIAL_AT = 0xF0
CYCLES_PER_MS = 12_000
ANSWER_TIMEOUT_S = 1.0
GET_DESCRIPTOR = 6
GET_CONFIGURATION = 8
DEVICE_DESCRIPTOR = 0x0100


class UsbBench:
    """A chip with the firmware and a host at the other end of a cable that is not in yet.

    Args:
        serial: the eight bytes of EEPROM where the serial number belongs; blank by default.
        firmware: another build than the usual one.
    """

    def __init__(self, serial: bytes = b"\xff" * 8, firmware: Path = FIRMWARE) -> None:
        """Load the firmware into a chip that has just been powered on."""
        self.chip = Chip(firmware)
        kept = self.chip.save()
        after = SERIAL_AT + len(serial)
        eeprom = kept.eeprom[:SERIAL_AT] + serial + kept.eeprom[after:]
        self.chip.restore(NonVolatile(kept.flash, eeprom))
        self.host = UsbHost(self.chip)
        self.toggles = {Token.IN: 0, Token.OUT: 0}
        if firmware == FIRMWARE:
            in_any_case(RECORDER.add)
        at_the_end(self.assert_no_mistakes)

    def enumerate(self) -> UsbBench:
        """Put the cable in if it is out, and configure the device as Linux does."""
        self.host.plug()
        self.host.enumerate()
        self.toggles = {Token.IN: 0, Token.OUT: 0}
        return self

    def open(self) -> UsbBench:
        """Enumerate and open the serial port."""
        self.enumerate()
        self.host.open_port()
        return self

    def assert_no_mistakes(self) -> None:
        """The firmware has done nothing that the data sheet forbids, and never restarted."""
        mistakes = self.host.mistakes
        assert not mistakes, mistakes
        assert len(self.chip.resets) == 1, self.chip.resets

    # -- control transfers ------------------------------------------------------------------------

    def refuses(
        self, request_type: int, request: int, value: int = 0, index: int = 0, length: int = 0
    ) -> bool:
        """Whether a request is stalled; the next one must be served in any case."""
        data = bytes(0 if request_type & 0x80 else length)
        try:
            self.host.control(request_type, request, value, index, data, length)
        except UsbStall:
            refused = True
        else:
            refused = False
        device = self.host.control(0x80, GET_DESCRIPTOR, DEVICE_DESCRIPTOR, length=18)
        assert device == self.host.description.device
        return refused

    def begin(self, setup: bytes) -> None:
        """Send a SETUP packet, up to three times as host controllers do, and leave it at that.

        The chip takes none while the packet before it still waits for the interrupt.
        """
        for _ in range(3):
            if self.host.setup(setup) == Handshake.ACK:
                break
            self.host.wait(5e-5)
        else:
            raise AssertionError(f"no answer to SETUP {setup.hex()}")
        self.host.wait(0.0005)

    def configuration(self) -> int:
        """GET_CONFIGURATION."""
        return self.host.control(0x80, GET_CONFIGURATION, length=1)[0]

    # -- packets on the data endpoints, port closed ------------------------------------------------

    def packet(self, token: Token, data: bytes = b"", tries: int = 50) -> Result:
        """One packet on endpoint 2, again while the device says NAK; keeps the toggles."""
        for _ in range(tries):
            result = self.host.transaction(token, 2, self.toggles[token], data)
            if result.handshake != Handshake.NAK:
                break
            self.host.wait(1e-4)
        if result.handshake == Handshake.ACK:
            if token == Token.IN:
                assert result.toggle == self.toggles[token]
            self.toggles[token] ^= 1
        return result

    # -- frames, port open ---------------------------------------------------------------------

    def send_raw(self, *packets: bytes) -> None:
        """Send each of ``packets`` as a packet of its own."""
        for data in packets:
            self.host.send(data)
            while self.host.unsent:
                self.host.wait(1e-4)

    def receive_raw(self, frames: int = 1, timeout: float = ANSWER_TIMEOUT_S) -> list[Frame]:
        """Return the frames that arrive until there are ``frames`` or the time is over."""
        received = b""
        end = self.chip.cycle + round(timeout * 1000 * CYCLES_PER_MS)
        while received.count(0) < frames and self.chip.cycle < end:
            self.host.wait(1e-4)
            received += self.host.receive()
        return [decode(part) for part in received.split(b"\0")[:-1]]

    def ask(self, seq: int, code: int, payload: bytes = b"") -> bytes:
        """Send a request, check seq and code of the response, return its payload."""
        self.send_raw(encode(Frame(seq, code, payload)))
        (answer,) = self.receive_raw()
        assert answer.seq == seq
        assert answer.code == code | 0x80
        return answer.payload
