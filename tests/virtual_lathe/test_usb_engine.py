# SPDX-License-Identifier: Apache-2.0
"""The model of the serial interface engine, with the test in the place of the firmware.

``Hand`` writes registers and descriptors as instructions would; the host makes transactions.
"""

from __future__ import annotations

from collections.abc import Callable

from virtual_lathe.chip import Chip
from virtual_lathe.usb_host import Handshake, Token, UsbHost
from virtual_lathe.worker import in_new_process

Program = Callable[[str], str]
UIR, UIE, USTAT, UCON, UADDR, UCFG, UEP0 = 0xF68, 0xF69, 0xF6C, 0xF6D, 0xF6E, 0xF6F, 0xF70
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


def _setup_packet(firmware: str) -> list[object]:
    hand = Hand(firmware)
    before = hand.host.setup(GET_DEVICE)
    hand.arm(0, False, 0x420, 16, DTSEN)
    hand.arm(0, True, 0x430, 4, DTSEN | DTS)
    interrupt = hand.chip.peek(PIR2) & USBIF
    hand.chip.write(PIR2, 0)
    after = hand.host.setup(GET_DEVICE)
    seen = bytes(hand.chip.peek(0x420 + i) for i in range(8))
    waiting = hand.host.transaction(Token.IN, 0).handshake
    return [
        before,
        after,
        seen == GET_DEVICE,
        hand.chip.peek(0x400),
        hand.chip.peek(0x401),
        bool(hand.chip.peek(UCON) & PKTDIS),
        waiting,
        interrupt,
        hand.chip.peek(PIR2) & USBIF,
        hand.take_status(),
        hand.host.mistakes,
    ]


def test_a_setup_packet_is_stored_and_stops_packet_processing(program: Program) -> None:
    found = in_new_process(_setup_packet, program("spin"))
    assert found == [
        Handshake.NONE,
        Handshake.ACK,
        True,
        13 << 2,
        8,
        True,
        Handshake.NAK,
        USBIF,
        USBIF,
        0x00,
        [],
    ]


def _in_and_out(firmware: str) -> list[object]:
    hand = Hand(firmware)
    results: list[object] = [hand.host.transaction(Token.IN, 2).handshake]
    for i in range(3):
        hand.chip.write(0x440 + i, 0x61 + i)
    hand.arm(2, True, 0x440, 3, DTSEN | DTS)
    got = hand.host.transaction(Token.IN, 2)
    results += [got.handshake, got.data, got.toggle, hand.take_status()]
    hand.arm(2, False, 0x480, 64, DTSEN)
    results.append(hand.host.transaction(Token.OUT, 2, 1, b"lost").handshake)
    results.append(bool(hand.chip.peek(0x410) & UOWN))
    results.append(hand.host.transaction(Token.OUT, 2, 0, b"kept").handshake)
    results.append(bytes(hand.chip.peek(0x480 + i) for i in range(hand.chip.peek(0x411))))
    results += [hand.take_status(), hand.host.transaction(Token.OUT, 2, 1, b"x").handshake]
    return [*results, hand.host.mistakes]


def test_bulk_packets_go_both_ways_with_their_toggles(program: Program) -> None:
    assert in_new_process(_in_and_out, program("spin")) == [
        Handshake.NAK,
        Handshake.ACK,
        b"abc",
        1,
        0x14,
        Handshake.ACK,
        True,
        Handshake.ACK,
        b"kept",
        0x10,
        Handshake.NAK,
        [],
    ]


def _fifo(firmware: str) -> list[object]:
    hand = Hand(firmware)
    handshakes = []
    for _ in range(5):
        hand.arm(2, True, 0x440, 1, DTSEN)
        handshakes.append(hand.host.transaction(Token.IN, 2).handshake)
    statuses = [hand.take_status() for _ in range(4)]
    return [handshakes, statuses, hand.flag(TRNIF)]


def test_four_transactions_wait_in_the_status_fifo_and_the_fifth_is_refused(
    program: Program,
) -> None:
    acknowledged, refused = [Handshake.ACK] * 4, Handshake.NAK
    expected = [[*acknowledged, refused], [0x14] * 4, False]
    assert in_new_process(_fifo, program("spin")) == expected


def _stall(firmware: str) -> list[object]:
    hand = Hand(firmware)
    hand.arm(2, True, 0x440, 1, BSTALL)
    handshake = hand.host.transaction(Token.IN, 2).handshake
    return [handshake, hand.flag(STALLIF), hand.chip.peek(UEP0 + 2) & 1]


def test_bstall_is_answered_with_stall(program: Program) -> None:
    assert in_new_process(_stall, program("spin")) == [Handshake.STALL, True, 1]


def _lost_handshake(firmware: str) -> list[object]:
    hand = Hand(firmware)
    hand.arm(2, True, 0x440, 1, DTSEN)
    hand.host.lose_handshakes(1)
    hand.host.transaction(Token.IN, 2)
    owned = bool(hand.chip.peek(0x414) & UOWN)
    again = hand.host.transaction(Token.IN, 2).handshake
    return [owned, again, bool(hand.chip.peek(0x414) & UOWN)]


def test_a_packet_whose_acknowledgement_got_lost_is_sent_again(program: Program) -> None:
    assert in_new_process(_lost_handshake, program("spin")) == [True, Handshake.ACK, False]


def _idle_and_resume(firmware: str) -> list[object]:
    hand = Hand(firmware)
    hand.host.suspend(True)
    hand.chip.run(0.0021)
    early = hand.flag(IDLEIF)
    hand.chip.run(0.002)
    late = hand.flag(IDLEIF)
    hand.chip.write(UCON, 0x08 | SUSPND)
    hand.chip.write(UIR, 0)
    hand.host.suspend(False)
    active = hand.flag(ACTVIF)
    hand.chip.write(UCON, 0x08)
    hand.chip.write(UADDR, 7)
    hand.host.reset_bus()
    return [early, late, active, hand.flag(URSTIF), hand.chip.peek(UADDR)]


def test_idle_resume_and_reset_are_noticed(program: Program) -> None:
    assert in_new_process(_idle_and_resume, program("spin")) == [False, True, True, True, 0]


def _mistakes(firmware: str) -> list[str]:
    hand = Hand(firmware)
    hand.chip.read(USTAT)
    hand.arm(2, True, 0x440, 8, DTSEN)
    hand.chip.write(0x442, 1)
    hand.chip.write(0x414, 0)
    hand.arm(2, False, 0x3F0, 64, DTSEN)
    hand.chip.write(0x410, 0)
    hand.arm(0, False, 0x420, 16, DTSEN)
    hand.host.setup(SET_ADDRESS_7)
    hand.chip.write(UADDR, 7)
    hand.chip.write(UCFG, 0x15)
    return [text.split(": ", 1)[1] for text in hand.host.mistakes]


def test_mistakes_of_the_firmware_are_listed(program: Program) -> None:
    found = in_new_process(_mistakes, program("spin"))
    expected = (
        "USTAT read without TRNIF",
        "0x442 written while the engine owns it",
        "descriptor 0x414 written",
        "descriptor 0x410: buffer 0x3f0",
        "descriptor 0x410 written",
        "UADDR written before the status stage",
        "UCFG changed while the module is on",
    )
    assert len(found) == len(expected), found
    assert all(text.startswith(start) for text, start in zip(found, expected, strict=True)), found


def _ping_pong(firmware: str) -> list[str]:
    return Hand(firmware, ping_pong=1).host.mistakes


def test_ping_pong_modes_are_refused_loudly(program: Program) -> None:
    assert any("ping-pong" in text for text in in_new_process(_ping_pong, program("spin")))
