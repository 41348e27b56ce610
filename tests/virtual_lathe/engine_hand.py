# SPDX-License-Identifier: Apache-2.0
"""A hand in the place of the firmware: drives the serial interface engine as instructions would."""

from __future__ import annotations

from .chip import Chip
from .usb_host import UsbHost

UFRML, UIR, UIE, USTAT, UCON, UADDR, UCFG, UEP0 = (
    0xF66,
    0xF68,
    0xF69,
    0xF6C,
    0xF6D,
    0xF6E,
    0xF6F,
    0xF70,
)
USBEN = 0x08
PIR2, USBIF = 0xFA1, 0x20
TRNIF, STALLIF, IDLEIF, URSTIF, ACTVIF, PKTDIS, SUSPND = 0x08, 0x20, 0x10, 0x01, 0x04, 0x10, 0x02
UOWN, DTS, DTSEN, BSTALL = 0x80, 0x40, 0x08, 0x04
GET_DEVICE = bytes((0x80, 6, 0, 1, 0, 0, 8, 0))
SET_ADDRESS_7 = bytes((0x00, 5, 7, 0, 0, 0, 0, 0))


class Hand:
    """A chip whose firmware is the test, attached, reset and with endpoint 0 and 2 on."""

    def __init__(self, firmware: str, ping_pong: int = 0) -> None:
        """Attach, plug in and reset."""
        self.chip = Chip(firmware)
        self.host = UsbHost(self.chip)
        self.chip.run(1e-4)
        self.chip.write(UCFG, 0x14 | ping_pong)
        self.chip.write(UEP0, 0x16)
        self.chip.write(UEP0 + 2, 0x1E)
        self.chip.write(UIE, 0xFF)
        self.chip.write(UCON, 0x08)
        self.host.plug()
        self.host.reset_bus()
        self.chip.write(UIR, 0)

    def arm(self, endpoint: int, into: bool, address: int, count: int, stat: int) -> None:
        """Hand a descriptor to the engine, status byte last."""
        at = 0x400 + 8 * endpoint + 4 * into
        self.chip.write(at + 1, count)
        self.chip.write(at + 2, address & 0xFF)
        self.chip.write(at + 3, address >> 8)
        self.chip.write(at, stat | UOWN)

    def take_status(self) -> int:
        """Read USTAT and clear TRNIF."""
        status = self.chip.read(USTAT)
        self.chip.write(UIR, self.chip.peek(UIR) & ~TRNIF)
        self.chip.run(1e-6)
        return status

    def flag(self, bit: int) -> bool:
        """Whether a flag of UIR is set."""
        return bool(self.chip.peek(UIR) & bit)
