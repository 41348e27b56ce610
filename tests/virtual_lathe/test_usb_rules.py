# SPDX-License-Identifier: Apache-2.0
"""Every mistake that firmware can make with the engine is found; each is made here on purpose."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from virtual_lathe.engine_hand import (
    ACTVIF,
    BSTALL,
    DTS,
    DTSEN,
    GET_DEVICE,
    PKTDIS,
    SET_ADDRESS_7,
    STALLIF,
    SUSPND,
    TRNIF,
    UADDR,
    UCFG,
    UCON,
    UEP0,
    UFRML,
    UIR,
    UOWN,
    USBEN,
    USTAT,
    Hand,
)
from virtual_lathe.usb_host import Token
from virtual_lathe.worker import in_new_process

Program = Callable[[str], str]
OUT_0, IN_0, OUT_2, IN_2 = 0x400, 0x404, 0x410, 0x414
LONG_S = 0.03


def read_status_without_a_transaction(hand: Hand) -> None:
    hand.chip.read(USTAT)


def clear_trnif_unread(hand: Hand) -> None:
    hand.arm(2, True, 0x440, 8, DTSEN)
    hand.host.transaction(Token.IN, 2)
    hand.chip.write(UIR, hand.chip.peek(UIR) & ~TRNIF)


def write_an_owned_buffer(hand: Hand) -> None:
    hand.arm(2, True, 0x440, 8, DTSEN)
    hand.chip.write(0x447, 1)


def read_an_owned_buffer(hand: Hand) -> None:
    hand.arm(2, False, 0x440, 8, DTSEN)
    hand.chip.read(0x440)


def write_an_owned_count(hand: Hand) -> None:
    hand.arm(2, True, 0x440, 8, DTSEN)
    hand.chip.write(IN_2 + 1, 4)


def take_an_owned_descriptor_back(hand: Hand) -> None:
    hand.arm(2, True, 0x440, 8, DTSEN)
    hand.chip.write(IN_2, 0)


def put_a_buffer_below_the_ram(hand: Hand) -> None:
    hand.arm(2, False, 0x3F0, 64, DTSEN)


def put_a_buffer_beyond_the_ram(hand: Hand) -> None:
    hand.arm(2, False, 0x7C1, 64, DTSEN)


def put_a_buffer_over_the_descriptors(hand: Hand) -> None:
    hand.arm(2, False, 0x417, 8, DTSEN)


def give_one_buffer_twice(hand: Hand) -> None:
    hand.arm(2, True, 0x440, 8, DTSEN)
    hand.arm(2, False, 0x447, 8, DTSEN)


def send_more_than_a_packet(hand: Hand) -> None:
    hand.arm(2, True, 0x440, 65, DTSEN)


def receive_into_too_small_a_buffer(hand: Hand) -> None:
    hand.arm(2, False, 0x440, 8, DTSEN)
    hand.host.transaction(Token.OUT, 2, 0, bytes(9))


def expect_the_wrong_toggle(hand: Hand) -> None:
    hand.arm(2, False, 0x440, 8, DTSEN | DTS)
    hand.host.transaction(Token.OUT, 2, 0, b"new", fresh=True)


def send_the_wrong_toggle(hand: Hand) -> None:
    hand.host.description.bulk_in = 2
    hand.host.poll()
    hand.arm(2, True, 0x440, 8, DTSEN | DTS)
    hand.chip.run(0.002)


def hand_over_without_toggles(hand: Hand) -> None:
    hand.arm(2, True, 0x440, 8, 0)


def hand_over_for_ever(hand: Hand) -> None:
    hand.arm(2, True, 0x440, 8, DTSEN | 0x20)


def switch_an_endpoint_on_without_handshakes(hand: Hand) -> None:
    hand.chip.write(UEP0 + 1, 0x02)


def set_the_address_early(hand: Hand) -> None:
    hand.arm(0, False, 0x420, 16, DTSEN)
    hand.host.setup(SET_ADDRESS_7)
    hand.chip.write(UADDR, 7)


def finish_set_address(hand: Hand) -> None:
    """SET_ADDRESS up to the end of its status stage."""
    hand.arm(0, False, 0x420, 16, DTSEN)
    hand.host.setup(SET_ADDRESS_7)
    hand.take_status()
    hand.arm(0, True, 0x430, 0, DTSEN | DTS)
    hand.chip.write(UCON, hand.chip.peek(UCON) & ~PKTDIS)
    hand.host.transaction(Token.IN, 0)


def set_the_address_late(hand: Hand) -> None:
    finish_set_address(hand)
    hand.chip.run(0.0021)
    hand.chip.write(UADDR, 7)


def set_another_address(hand: Hand) -> None:
    finish_set_address(hand)
    hand.chip.write(UADDR, 8)
    hand.chip.write(UADDR, 7)


def leave_the_stall_set(hand: Hand) -> None:
    hand.arm(2, True, 0x440, 0, BSTALL)
    hand.host.transaction(Token.IN, 2)
    hand.chip.write(UIR, hand.chip.peek(UIR) & ~STALLIF)
    hand.chip.write(UCON, hand.chip.peek(UCON) & ~USBEN)
    hand.chip.write(UEP0 + 2, hand.chip.peek(UEP0 + 2))
    hand.chip.write(IN_2, 0)
    hand.chip.write(UCON, USBEN)
    hand.arm(2, True, 0x440, 8, DTSEN)
    hand.host.transaction(Token.IN, 2)


def forget_to_take_the_next_setup(hand: Hand) -> None:
    hand.chip.run(LONG_S)
    hand.host.setup(GET_DEVICE)


def leave_packets_disabled(hand: Hand) -> None:
    hand.arm(0, False, 0x420, 16, DTSEN)
    hand.host.setup(GET_DEVICE)
    hand.chip.run(LONG_S)
    hand.host.transaction(Token.IN, 0)


def suspend_a_busy_bus(hand: Hand) -> None:
    hand.chip.run(LONG_S)
    hand.chip.write(UCON, USBEN | SUSPND)


def change_the_configuration_while_on(hand: Hand) -> None:
    hand.chip.write(UCFG, 0x15)


def write_a_read_only_register(hand: Hand) -> None:
    hand.chip.write(UFRML, 1)


MISTAKES: dict[Callable[[Hand], None], str] = {
    read_status_without_a_transaction: "USTAT read without TRNIF",
    clear_trnif_unread: "TRNIF cleared before USTAT was read",
    write_an_owned_buffer: "0x447 written while the engine owns it: buffer of endpoint 2 IN",
    read_an_owned_buffer: "0x440 read while the engine owns it: buffer of endpoint 2 OUT",
    write_an_owned_count: "0x415 written while the engine owns it: descriptor of endpoint 2 IN",
    take_an_owned_descriptor_back: "descriptor 0x414 written (0x88 -> 0x00) while",
    put_a_buffer_below_the_ram: "descriptor 0x410: buffer 0x3f0 + 64 is outside",
    put_a_buffer_beyond_the_ram: "descriptor 0x410: buffer 0x7c1 + 64 is outside",
    put_a_buffer_over_the_descriptors: "descriptor 0x410: buffer 0x417 + 8 is outside",
    give_one_buffer_twice: "descriptor 0x410: its buffer is also that of 0x414",
    send_more_than_a_packet: "descriptor 0x414: 65 bytes are more than a packet",
    receive_into_too_small_a_buffer: "descriptor 0x410: packet of 9 bytes for a buffer of 8",
    expect_the_wrong_toggle: "descriptor 0x410 drops a new packet",
    send_the_wrong_toggle: "IN packet with the wrong data toggle",
    hand_over_without_toggles: "descriptor 0x414: handed over without DTSEN",
    hand_over_for_ever: "descriptor 0x414: KEN or INCDIS is set",
    switch_an_endpoint_on_without_handshakes: "endpoint 1 gives no handshakes",
    set_the_address_early: "UADDR written before the status stage",
    set_the_address_late: "UADDR is 0 and not 7, 2 ms after SET_ADDRESS",
    set_another_address: "UADDR set to 8, which nobody asked for",
    leave_the_stall_set: "endpoint 2: EPSTALL is still set after the halt",
    forget_to_take_the_next_setup: "SETUP not answered",
    leave_packets_disabled: "PKTDIS is still set",
    suspend_a_busy_bus: "SUSPND set although the bus is not idle",
    change_the_configuration_while_on: "UCFG changed while the module is on",
    write_a_read_only_register: "write to read-only register 0xf66",
}


def _found(firmware: str, make: Callable[[Hand], None]) -> list[str]:
    hand = Hand(firmware)
    before = hand.host.mistakes
    make(hand)
    return before + [text.split(": ", 1)[1] for text in hand.host.mistakes]


@pytest.mark.parametrize("make", MISTAKES, ids=lambda make: make.__name__)
def test_a_mistake_of_the_firmware_is_found(program: Program, make: Callable[[Hand], None]) -> None:
    found = in_new_process(_found, program("spin"), make)
    assert len(found) == 1, found
    assert found[0].startswith(MISTAKES[make])


def _allowed(firmware: str) -> list[str]:
    hand = Hand(firmware)
    finish_set_address(hand)
    hand.chip.run(0.0019)
    hand.chip.write(UADDR, 7)
    hand.chip.run(0.001)
    hand.arm(2, False, 0x440, 8, DTSEN)
    hand.host.reset_bus()
    hand.chip.write(OUT_2, 0)
    hand.host.suspend(True)
    hand.chip.run(0.004)
    hand.chip.write(UCON, USBEN | SUSPND)
    return hand.host.mistakes


def test_what_the_data_sheet_allows_is_no_mistake(program: Program) -> None:
    assert in_new_process(_allowed, program("spin")) == []


def _stall_not_yet_told(firmware: str) -> list[str]:
    hand = Hand(firmware)
    hand.arm(2, True, 0x440, 0, BSTALL)
    hand.arm(2, False, 0x480, 8, DTSEN)
    hand.host.transaction(Token.IN, 2)
    hand.host.transaction(Token.OUT, 2, 0, bytes(8))
    return hand.host.mistakes


def test_a_stall_that_the_firmware_has_not_been_told_of_is_no_mistake(program: Program) -> None:
    assert in_new_process(_stall_not_yet_told, program("spin")) == []


def _activity(firmware: str) -> list[bool]:
    hand = Hand(firmware)
    hand.host.suspend(True)
    hand.chip.run(0.004)
    hand.chip.write(UCON, USBEN | SUSPND)
    hand.host.suspend(False)
    flags = []
    for action in (lambda: None, lambda: hand.chip.write(UCON, USBEN), lambda: hand.chip.run(1e-5)):
        action()
        hand.chip.write(UIR, 0)
        flags.append(hand.flag(ACTVIF))
    return flags


def test_activity_cannot_be_cleared_before_the_clock_is_back(program: Program) -> None:
    assert in_new_process(_activity, program("spin")) == [True, True, False]


def _ping_pong(firmware: str) -> list[str]:
    return Hand(firmware, ping_pong=1).host.mistakes


def test_ping_pong_modes_are_refused_loudly(program: Program) -> None:
    assert any("ping-pong" in text for text in in_new_process(_ping_pong, program("spin")))


def _twice_owned(firmware: str) -> bool:
    hand = Hand(firmware)
    hand.arm(0, False, 0x420, 16, DTSEN)
    hand.host.setup(GET_DEVICE)
    hand.chip.write(IN_0, 0)
    return not hand.host.mistakes and not hand.chip.peek(OUT_0) & UOWN


def test_descriptors_may_be_changed_while_packets_are_disabled(program: Program) -> None:
    assert in_new_process(_twice_owned, program("spin"))
