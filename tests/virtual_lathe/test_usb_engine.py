# SPDX-License-Identifier: Apache-2.0
"""The model of the serial interface engine, with the test in the place of the firmware."""

from __future__ import annotations

from collections.abc import Callable

from virtual_lathe.engine_hand import (
    ACTVIF,
    BSTALL,
    DTS,
    DTSEN,
    GET_DEVICE,
    IDLEIF,
    PIR2,
    PKTDIS,
    STALLIF,
    SUSPND,
    TRNIF,
    UADDR,
    UCON,
    UEP0,
    UIR,
    UOWN,
    URSTIF,
    USBIF,
    Hand,
)
from virtual_lathe.usb_host import Handshake, Token
from virtual_lathe.worker import in_new_process

Program = Callable[[str], str]


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
