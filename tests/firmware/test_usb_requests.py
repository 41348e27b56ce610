# SPDX-License-Identifier: Apache-2.0
"""Control requests: USB 2.0 chapter 9 and the serial port's class, right and wrong ones."""

from __future__ import annotations

import struct

import pytest
from simulated.processes import on_a_new_chip
from tornillo.frames import Frame, decode, encode
from tornillo.protocol import Command
from virtual_lathe.usb_host import Handshake, Token

from firmware.usb_bench import DEVICE_DESCRIPTOR, GET_DESCRIPTOR, UsbBench

GET_STATUS, CLEAR_FEATURE, SET_FEATURE, SET_ADDRESS = 0, 1, 3, 5
SET_CONFIGURATION, GET_INTERFACE, SET_INTERFACE = 9, 10, 11
SET_LINE_CODING, GET_LINE_CODING, SET_CONTROL_LINE_STATE, SEND_BREAK = 0x20, 0x21, 0x22, 0x23
HALT = 0
CONFIGURATION_DESCRIPTOR = 0x0200
UCON, UADDR, SUSPND = 0xF6D, 0xF6E, 0x02
UEP2, EPSTALL = 0xF72, 0x01


def setup_packet(request_type: int, request: int, value: int, length: int) -> bytes:
    """Eight bytes of a SETUP, wIndex 0."""
    return struct.pack("<BBHHH", request_type, request, value, 0, length)


@on_a_new_chip
def test_status_of_device_interfaces_and_endpoints_is_reported() -> None:
    host = UsbBench().enumerate().host
    assert host.control(0x80, GET_STATUS, length=2) == b"\x01\x00"  # self-powered
    for interface in (0, 1):
        assert host.control(0x81, GET_STATUS, index=interface, length=2) == b"\0\0"
    for endpoint in (0x00, 0x80, 0x81, 0x02, 0x82):
        assert host.control(0x82, GET_STATUS, index=endpoint, length=2) == b"\0\0"


@on_a_new_chip
def test_configuration_and_interface_can_be_set_and_read() -> None:
    bench = UsbBench().enumerate()
    assert bench.configuration() == 1
    bench.host.control(0x00, SET_CONFIGURATION, 0)
    assert bench.configuration() == 0
    bench.host.control(0x00, SET_CONFIGURATION, 1)
    for interface in (0, 1):
        bench.host.control(0x01, SET_INTERFACE, 0, interface)
        assert bench.host.control(0x81, GET_INTERFACE, 0, interface, length=1) == b"\0"


REFUSED = {
    "remote wake-up": (0x00, SET_FEATURE, 1, 0, 0),
    "clear remote wake-up": (0x00, CLEAR_FEATURE, 1, 0, 0),
    "test mode": (0x00, SET_FEATURE, 2, 0x0100, 0),
    "interface feature": (0x01, SET_FEATURE, 0, 0, 0),
    "halt endpoint 0": (0x02, SET_FEATURE, HALT, 0, 0),
    "halt an endpoint that is not there": (0x02, SET_FEATURE, HALT, 0x83, 0),
    "halt with a high index": (0x02, SET_FEATURE, HALT, 0x0182, 0),
    "halt endpoint 1 OUT": (0x02, SET_FEATURE, HALT, 0x01, 0),
    "unknown endpoint feature": (0x02, SET_FEATURE, 1, 0x82, 0),
    "status of interface 2": (0x81, GET_STATUS, 0, 2, 2),
    "status of endpoint 3": (0x82, GET_STATUS, 0, 0x03, 2),
    "status of something else": (0x83, GET_STATUS, 0, 0, 2),
    "address above 127": (0x00, SET_ADDRESS, 128, 0, 0),
    "configuration 2": (0x00, SET_CONFIGURATION, 2, 0, 0),
    "configuration 0x0101": (0x00, SET_CONFIGURATION, 0x0101, 0, 0),
    "setting 1": (0x01, SET_INTERFACE, 1, 0, 0),
    "interface 2": (0x01, SET_INTERFACE, 0, 2, 0),
    "setting of interface 2": (0x81, GET_INTERFACE, 0, 2, 1),
    "set descriptor": (0x00, 7, DEVICE_DESCRIPTOR, 0, 18),
    "synch frame": (0x82, 12, 0, 0x82, 2),
    "device qualifier": (0x80, GET_DESCRIPTOR, 0x0600, 0, 10),
    "configuration descriptor 1": (0x80, GET_DESCRIPTOR, 0x0201, 0, 9),
    "device descriptor 1": (0x80, GET_DESCRIPTOR, 0x0101, 0, 18),
    "string 4": (0x80, GET_DESCRIPTOR, 0x0304, 0x0409, 255),
    "report descriptor": (0x81, GET_DESCRIPTOR, 0x2200, 0, 64),
    "interface descriptor": (0x80, GET_DESCRIPTOR, 0x0400, 0, 9),
    "reserved standard request 2": (0x00, 2, 0, 0, 0),
    "reserved standard request 4": (0x80, 4, 0, 0, 1),
    "encapsulated command": (0x21, 0x00, 0, 0, 8),
    "encapsulated response": (0xA1, 0x01, 0, 0, 8),
    "line coding of interface 1": (0xA1, GET_LINE_CODING, 0, 1, 7),
    "line coding of 6 bytes": (0x21, SET_LINE_CODING, 0, 0, 6),
    "line coding of 263 bytes": (0x21, SET_LINE_CODING, 0, 0, 263),
    "line state of the device": (0x20, SET_CONTROL_LINE_STATE, 0, 0, 0),
    "line state to the host": (0xA2, SET_CONTROL_LINE_STATE, 0, 0, 0),
    "line coding of an endpoint": (0xA2, GET_LINE_CODING, 0, 0, 7),
    "unknown class request": (0x21, 0x24, 0, 0, 0),
    "vendor read": (0xC0, 1, 0, 0, 4),
    "vendor write": (0x40, 1, 0, 0, 4),
    "vendor without data": (0x40, 1, 0, 0, 0),
    "reserved type": (0x60, 1, 0, 0, 0),
}


@pytest.mark.parametrize("request_", REFUSED.values(), ids=REFUSED.keys())
@on_a_new_chip
def test_an_unsupported_request_is_stalled_and_the_next_one_served(
    request_: tuple[int, int, int, int, int],
) -> None:
    bench = UsbBench().enumerate()
    assert bench.refuses(*request_)
    assert bench.configuration() == 1


@on_a_new_chip
def test_before_configuration_only_endpoint_0_exists() -> None:
    bench = UsbBench().enumerate()
    bench.host.control(0x00, SET_CONFIGURATION, 0)
    assert bench.refuses(0x82, GET_STATUS, 0, 0x82, 2)
    assert bench.refuses(0x81, GET_STATUS, 0, 0, 2)
    assert bench.refuses(0x81, GET_INTERFACE, 0, 0, 1)
    assert bench.refuses(0x02, SET_FEATURE, HALT, 0x02)
    assert bench.refuses(0x21, SET_CONTROL_LINE_STATE, 1)
    assert bench.packet(Token.IN, tries=1).handshake == Handshake.NONE
    assert bench.packet(Token.OUT, b"x", tries=1).handshake == Handshake.NONE
    assert bench.host.control(0x82, GET_STATUS, index=0, length=2) == b"\0\0"


@pytest.mark.parametrize("length", [0, 1, 8, 15, 16, 17, 18, 19, 32, 64, 255, 4096])
@on_a_new_chip
def test_a_descriptor_is_cut_to_what_the_host_asks_for(length: int) -> None:
    host = UsbBench().enumerate().host
    device = host.control(0x80, GET_DESCRIPTOR, DEVICE_DESCRIPTOR, length=length)
    assert device == host.description.device[:length]
    whole = host.control(0x80, GET_DESCRIPTOR, CONFIGURATION_DESCRIPTOR, length=length)
    assert whole == host.description.configuration[:length]


@pytest.mark.parametrize("address", [0x81, 0x02, 0x82], ids=hex)
@on_a_new_chip
def test_a_halted_endpoint_stalls_until_the_halt_is_cleared(address: int) -> None:
    bench = UsbBench().enumerate()
    token = Token.IN if address & 0x80 else Token.OUT
    bench.host.control(0x02, SET_FEATURE, HALT, address)
    assert bench.host.control(0x82, GET_STATUS, index=address, length=2) == b"\x01\0"
    for _ in range(3):
        result = bench.host.transaction(token, address & 15, 0, b"")
        assert result.handshake == Handshake.STALL
    for other in {0x81, 0x02, 0x82} - {address}:
        assert bench.host.control(0x82, GET_STATUS, index=other, length=2) == b"\0\0"
    bench.host.control(0x02, CLEAR_FEATURE, HALT, address)
    assert bench.host.control(0x82, GET_STATUS, index=address, length=2) == b"\0\0"
    assert bench.host.transaction(token, address & 15, 0, b"").handshake != Handshake.STALL


@pytest.mark.parametrize("how", ["clear halt", "set interface", "set configuration"])
@on_a_new_chip
def test_the_data_toggles_start_again_at_data0(how: str) -> None:
    bench = UsbBench().enumerate()
    assert bench.packet(Token.OUT, b"\0").handshake == Handshake.ACK  # now DATA1 is due
    if how == "clear halt":
        bench.host.control(0x02, CLEAR_FEATURE, HALT, 0x02)
    elif how == "set interface":
        bench.host.control(0x01, SET_INTERFACE, 0, 1)
    else:
        bench.host.control(0x00, SET_CONFIGURATION, 1)
    bench.toggles[Token.OUT] = 0
    bench.packet(Token.OUT, encode(Frame(1, Command.STATUS, b"")))
    assert decode(bench.packet(Token.IN).data[:-1]).seq == 1


@on_a_new_chip
def test_no_stall_gets_lost_however_soon_it_follows_another() -> None:
    bench = UsbBench().enumerate()
    bench.host.control(0x02, SET_FEATURE, HALT, 0x82)
    for gap in range(0, 240):
        assert bench.host.transaction(Token.IN, 2).handshake == Handshake.STALL
        bench.chip.run_to(bench.chip.cycle + gap)
        assert bench.host.transaction(Token.IN, 2).handshake == Handshake.STALL
        bench.host.wait(0.0003)
        assert not bench.chip.peek(UEP2) & EPSTALL, f"{gap} cycles later"
    bench.host.control(0x02, CLEAR_FEATURE, HALT, 0x82)


@on_a_new_chip
def test_a_reply_that_waits_survives_a_halt_and_is_sent_as_data0() -> None:
    bench = UsbBench().enumerate()
    bench.packet(Token.OUT, encode(Frame(1, Command.STATUS, b"")))
    bench.host.wait(0.005)
    bench.host.control(0x02, SET_FEATURE, HALT, 0x82)
    assert bench.packet(Token.IN).handshake == Handshake.STALL
    bench.host.control(0x02, CLEAR_FEATURE, HALT, 0x82)
    reply = bench.packet(Token.IN)
    assert decode(reply.data[:-1]).code == Command.STATUS | 0x80


@on_a_new_chip
def test_the_new_address_holds_after_the_status_stage_and_not_before() -> None:
    bench = UsbBench().enumerate()
    bench.host.reset_bus()
    bench.host.wait(0.01)
    bench.begin(setup_packet(0x00, SET_ADDRESS, 9, 0))
    assert bench.chip.peek(UADDR) == 0
    status = bench.host.transaction(Token.IN, 0)
    assert (status.handshake, status.data, status.toggle) == (Handshake.ACK, b"", 1)
    bench.host.wait(0.002)
    assert bench.chip.peek(UADDR) == 9
    assert bench.host.transaction(Token.IN, 0, address=0).handshake == Handshake.NONE
    bench.host.address = 9
    assert bench.configuration() == 0


@on_a_new_chip
def test_address_0_leads_back_to_the_default_state() -> None:
    bench = UsbBench().enumerate()
    bench.host.control(0x00, SET_CONFIGURATION, 0)
    bench.host.control(0x00, SET_ADDRESS, 0)
    bench.host.wait(0.002)
    bench.host.address = 0
    assert bench.chip.peek(UADDR) == 0
    assert bench.refuses(0x00, SET_CONFIGURATION, 1)
    bench.host.control(0x00, SET_ADDRESS, 11)
    bench.host.wait(0.002)
    bench.host.address = 11
    bench.host.control(0x00, SET_CONFIGURATION, 1)
    assert bench.configuration() == 1


@on_a_new_chip
def test_set_address_without_its_status_stage_changes_nothing() -> None:
    bench = UsbBench().enumerate()
    bench.host.control(0x00, SET_CONFIGURATION, 0)
    bench.begin(setup_packet(0x00, SET_ADDRESS, 9, 0))
    bench.host.control(0x00, SET_CONFIGURATION, 0)
    assert bench.configuration() == 0
    assert bench.chip.peek(UADDR) == bench.host.address


@pytest.mark.parametrize("packets", [0, 1, 2, 3])
@on_a_new_chip
def test_a_read_that_the_host_gives_up_does_not_disturb_the_next(packets: int) -> None:
    bench = UsbBench().enumerate()
    bench.begin(setup_packet(0x80, GET_DESCRIPTOR, CONFIGURATION_DESCRIPTOR, 67))
    for _ in range(packets):
        bench.host.wait(0.0005)
        assert bench.host.transaction(Token.IN, 0).handshake == Handshake.ACK
    device = bench.host.control(0x80, GET_DESCRIPTOR, DEVICE_DESCRIPTOR, length=18)
    assert device == bench.host.description.device


@on_a_new_chip
def test_a_write_after_a_read_that_was_given_up_is_carried_out() -> None:
    bench = UsbBench().enumerate()
    bench.begin(setup_packet(0x80, GET_DESCRIPTOR, CONFIGURATION_DESCRIPTOR, 67))
    coding = b"\x01\x02\x03\x04\x05\x06\x07"
    bench.host.control(0x21, SET_LINE_CODING, data=coding)
    assert bench.host.control(0xA1, GET_LINE_CODING, length=7) == coding


@on_a_new_chip
def test_data_that_fill_their_last_packet_end_with_an_empty_one() -> None:
    bench = UsbBench().enumerate()
    bench.begin(setup_packet(0x80, GET_DESCRIPTOR, CONFIGURATION_DESCRIPTOR, 255))
    bench.chip.set_variable("usb_left", 16)  # as if the descriptor had 32 bytes
    for size in (16, 16, 0):
        result = bench.host.transaction(Token.IN, 0)
        assert (result.handshake, len(result.data)) == (Handshake.ACK, size)
        bench.host.wait(0.0005)
    assert bench.host.transaction(Token.OUT, 0, 1, b"").handshake == Handshake.ACK
    bench.host.wait(0.0005)
    assert bench.configuration() == 1


@on_a_new_chip
def test_a_host_may_end_a_read_early_with_its_status_stage() -> None:
    bench = UsbBench().enumerate()
    bench.begin(setup_packet(0x80, GET_DESCRIPTOR, CONFIGURATION_DESCRIPTOR, 67))
    bench.host.transaction(Token.IN, 0)
    bench.host.wait(0.0005)
    assert bench.host.transaction(Token.OUT, 0, 1, b"").handshake == Handshake.ACK
    bench.host.wait(0.0005)
    assert bench.configuration() == 1


@on_a_new_chip
def test_a_setup_right_after_a_setup_counts() -> None:
    bench = UsbBench().enumerate()
    for _ in range(5):
        bench.begin(setup_packet(0x80, GET_DESCRIPTOR, DEVICE_DESCRIPTOR, 18))
    assert bench.configuration() == 1


@on_a_new_chip
def test_lost_handshakes_lose_and_double_nothing() -> None:
    bench = UsbBench().enumerate()
    host = bench.host
    for lost in (1, 2, 1, 2):
        host.lose_handshakes(lost)
        configuration = host.control(0x80, GET_DESCRIPTOR, CONFIGURATION_DESCRIPTOR, length=67)
        assert configuration == host.description.configuration


@on_a_new_chip
def test_line_coding_is_kept_and_given_back() -> None:
    bench = UsbBench()
    bench.host.plug()
    bench.host.enumerate()
    for coding in (b"\x80\x25\0\0\0\0\x08", b"\x01\x02\x03\x04\x05\x06\x07"):
        bench.host.control(0x21, SET_LINE_CODING, data=coding)
        assert bench.host.control(0xA1, GET_LINE_CODING, length=7) == coding
    assert bench.host.control(0xA1, GET_LINE_CODING, length=3) == coding[:3]


@on_a_new_chip
def test_line_coding_cut_short_is_refused_and_the_old_one_kept() -> None:
    bench = UsbBench().enumerate()
    old = bench.host.control(0xA1, GET_LINE_CODING, length=7)
    bench.begin(setup_packet(0x21, SET_LINE_CODING, 0, 7))
    assert bench.host.transaction(Token.OUT, 0, 1, b"\x01\x02\x03").handshake == Handshake.ACK
    bench.host.wait(0.0005)
    assert bench.host.transaction(Token.IN, 0).handshake == Handshake.STALL
    assert bench.host.control(0xA1, GET_LINE_CODING, length=7) == old


@on_a_new_chip
def test_line_state_and_break_are_accepted() -> None:
    bench = UsbBench().enumerate()
    for state in (0, 1, 2, 3):
        bench.host.control(0x21, SET_CONTROL_LINE_STATE, state)
        assert bench.chip.variable("usb_line_state") == state
    bench.host.control(0x21, SEND_BREAK, 0xFFFF)
    bench.host.control(0x21, SEND_BREAK, 0)


@on_a_new_chip
def test_a_bus_reset_in_the_middle_of_anything_leads_to_the_default_state() -> None:
    bench = UsbBench().enumerate()
    unfinished = [
        setup_packet(0x80, GET_DESCRIPTOR, CONFIGURATION_DESCRIPTOR, 67),
        setup_packet(0x21, SET_LINE_CODING, 0, 7),
        setup_packet(0x00, SET_ADDRESS, 77, 0),
        setup_packet(0xC0, 1, 0, 4),
    ]
    for setup in unfinished:
        bench.begin(setup)
        bench.host.reset_bus()
        assert bench.chip.peek(UADDR) == 0
        bench.enumerate()
        assert bench.configuration() == 1


@on_a_new_chip
def test_the_device_sleeps_on_an_idle_bus_and_wakes_with_everything_kept() -> None:
    bench = UsbBench().open()
    for _ in range(3):
        bench.host.suspend(True)
        bench.chip.run(0.01)
        assert bench.chip.peek(UCON) & SUSPND
        bench.host.suspend(False)
        bench.chip.run(0.002)
        assert not bench.chip.peek(UCON) & SUSPND
        assert bench.configuration() == 1
        assert bench.ask(1, 1)[0] == 0


@on_a_new_chip
def test_a_reset_wakes_a_sleeping_device() -> None:
    bench = UsbBench().enumerate()
    bench.host.suspend(True)
    bench.chip.run(0.05)
    bench.host.suspend(False)
    bench.enumerate()
    assert bench.configuration() == 1
