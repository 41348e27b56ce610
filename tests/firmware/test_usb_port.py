# SPDX-License-Identifier: Apache-2.0
"""The serial port: bytes in both directions, nobody waiting for anybody, nothing lost."""

from __future__ import annotations

import pytest
from simulated.processes import on_a_new_chip
from tornillo.frames import Frame, decode, encode
from tornillo.protocol import Command, ErrorCode
from virtual_lathe.serial_port import SerialPort
from virtual_lathe.usb_host import Handshake, Token, UsbError

from firmware.usb_bench import UsbBench

SET_CONTROL_LINE_STATE = 0x22
INTERRUPT_WORST_CYCLES = 600  # 50 us: the millisecond's own work and a control request


def status(seq: int) -> bytes:
    """A STATUS request as it goes over the wire."""
    return encode(Frame(seq, Command.STATUS, b""))


@on_a_new_chip
def test_the_port_says_that_it_is_ready_once_after_configuration() -> None:
    bench = UsbBench().enumerate()
    bench.host.wait(0.001)
    news = bench.host.transaction(Token.IN, 1)
    assert news.data == bytes([0xA1, 0x20, 0, 0, 0, 0, 2, 0, 3, 0])
    bench.host.wait(0.001)
    assert bench.host.transaction(Token.IN, 1).handshake == Handshake.NAK


@on_a_new_chip
def test_the_host_is_told_to_wait_while_a_reply_has_not_been_fetched() -> None:
    bench = UsbBench().enumerate()
    assert bench.packet(Token.OUT, status(1)).handshake == Handshake.ACK
    bench.host.wait(0.01)
    assert bench.packet(Token.OUT, status(2)).handshake == Handshake.ACK
    bench.host.wait(0.01)
    refused = bench.packet(Token.OUT, status(3))
    assert refused.handshake == Handshake.NAK
    assert [decode(bench.packet(Token.IN).data[:-1]).seq for _ in range(2)] == [1, 2]
    assert bench.packet(Token.OUT, status(3)).handshake == Handshake.ACK
    assert decode(bench.packet(Token.IN).data[:-1]).seq == 3


@on_a_new_chip
def test_many_requests_sent_at_once_are_all_answered_in_order() -> None:
    bench = UsbBench().open()
    sequence = list(range(1, 101))
    bench.host.send(b"".join(status(seq) for seq in sequence))
    assert [frame.seq for frame in bench.receive_raw(100)] == sequence


@on_a_new_chip
def test_empty_packets_are_harmless() -> None:
    bench = UsbBench().enumerate()
    for _ in range(3):
        assert bench.packet(Token.OUT, b"").handshake == Handshake.ACK
        bench.host.wait(0.001)
    bench.packet(Token.OUT, status(9))
    assert decode(bench.packet(Token.IN).data[:-1]).seq == 9


@on_a_new_chip
def test_a_reply_nobody_fetched_is_dropped_when_the_port_is_closed() -> None:
    bench = UsbBench().enumerate()
    bench.host.control(0x21, SET_CONTROL_LINE_STATE, 3)
    bench.packet(Token.OUT, status(1))
    bench.host.wait(0.01)
    bench.host.control(0x21, SET_CONTROL_LINE_STATE, 0)
    bench.host.control(0x21, SET_CONTROL_LINE_STATE, 3)
    assert bench.packet(Token.IN, tries=5).handshake == Handshake.NAK
    bench.packet(Token.OUT, status(2))
    assert decode(bench.packet(Token.IN).data[:-1]).seq == 2


@on_a_new_chip
def test_a_program_that_never_raises_dtr_is_served() -> None:
    bench = UsbBench().enumerate()
    bench.packet(Token.OUT, status(1))
    assert decode(bench.packet(Token.IN).data[:-1]).seq == 1


@on_a_new_chip
def test_a_request_whose_ack_got_lost_is_taken_once() -> None:
    bench = UsbBench().enumerate()
    bench.host.wait(0.005)  # until a packet is taken
    for seq in (1, 2, 3):
        toggle = (seq - 1) % 2
        bench.host.lose_handshakes(1)
        lost = bench.host.transaction(Token.OUT, 2, toggle, status(seq))
        assert lost.handshake == Handshake.NONE
        bench.host.wait(0.01)
        again = bench.host.transaction(Token.OUT, 2, toggle, status(seq))
        assert again.handshake == Handshake.ACK
        assert decode(bench.packet(Token.IN).data[:-1]).seq == seq
        assert bench.packet(Token.IN, tries=5).handshake == Handshake.NAK


@on_a_new_chip
def test_a_reply_whose_ack_got_lost_is_sent_again_with_the_same_toggle() -> None:
    bench = UsbBench().enumerate()
    for seq in (1, 2, 3):
        bench.packet(Token.OUT, status(seq))
        bench.host.wait(0.01)
        bench.host.lose_handshakes(1)
        lost = bench.host.transaction(Token.IN, 2)
        again = bench.packet(Token.IN)
        assert (again.data, again.toggle) == (lost.data, lost.toggle)
        assert decode(again.data[:-1]).seq == seq
        assert bench.packet(Token.IN, tries=5).handshake == Handshake.NAK


@pytest.mark.parametrize("sent", range(0, 8))
@on_a_new_chip
def test_the_cable_may_be_pulled_at_any_byte_of_a_request(sent: int) -> None:
    bench = UsbBench().open()
    if sent:
        bench.send_raw(status(1)[:sent])
    bench.host.unplug()
    bench.chip.run(0.05)
    bench.open()
    bench.send_raw(b"\0")
    bench.receive_raw(2, timeout=0.01)
    assert bench.ask(2, Command.HELLO)[0] == ErrorCode.OK


@on_a_new_chip
def test_a_cable_pulled_before_the_reply_was_fetched_leaves_nothing_behind() -> None:
    bench = UsbBench().enumerate()
    bench.packet(Token.OUT, status(1))
    bench.host.unplug()
    bench.chip.run(0.1)
    bench.enumerate()
    assert bench.packet(Token.IN, tries=5).handshake == Handshake.NAK
    bench.packet(Token.OUT, status(2))
    assert decode(bench.packet(Token.IN).data[:-1]).seq == 2


@on_a_new_chip
def test_the_port_may_be_closed_and_opened_again() -> None:
    bench = UsbBench().enumerate()
    for seq in range(1, 6):
        bench.host.control(0x21, SET_CONTROL_LINE_STATE, 3)
        bench.packet(Token.OUT, status(seq))
        assert decode(bench.packet(Token.IN).data[:-1]).seq == seq
        bench.host.control(0x21, SET_CONTROL_LINE_STATE, 0)
        bench.host.wait(0.01)


@on_a_new_chip
def test_a_program_sees_the_cable_go() -> None:
    bench = UsbBench().open()
    port = SerialPort(bench.host)
    bench.host.unplug()
    with pytest.raises(UsbError, match="gone"):
        port.read(1)


@on_a_new_chip
def test_the_interrupt_stays_within_its_bound_for_every_kind_of_traffic() -> None:
    bench = UsbBench().open()
    bench.chip.clear_statistics()
    bench.host.control(0x80, 6, 0x0200, length=67)
    for index in range(4):
        bench.host.control(0x80, 6, 0x0300 | index, 0x0409, length=255)
    bench.host.control(0x21, 0x20, data=bytes(7))
    bench.host.control(0xA1, 0x21, length=7)
    assert bench.ask(1, Command.STATUS)[0] == ErrorCode.OK
    assert bench.chip.interrupt_cost(high=False).worst <= INTERRUPT_WORST_CYCLES
