# SPDX-License-Identifier: Apache-2.0
"""The device in each of its states (USB 2.0, 9.1 and 9.4), and that nothing gets stuck."""

from __future__ import annotations

import random

import pytest
from simulated.processes import on_a_new_chip
from tornillo.frames import Frame, encode
from tornillo.protocol import Command, ErrorCode
from virtual_lathe.chip import Drive
from virtual_lathe.usb_host import Handshake, Token

from firmware.test_usb_requests import setup_packet
from firmware.usb_bench import DEVICE_DESCRIPTOR, GET_DESCRIPTOR, UsbBench

UCON, UADDR, USBEN = 0xF6D, 0xF6E, 0x08
SERVED, REFUSED = False, True
#: Request with type, request, value, index and length; refused in default, address, configured.
REQUESTS = {
    "get device descriptor": ((0x80, 6, 0x0100, 0, 18), SERVED, SERVED, SERVED),
    "get configuration descriptor": ((0x80, 6, 0x0200, 0, 67), SERVED, SERVED, SERVED),
    "get string": ((0x80, 6, 0x0302, 0x0409, 255), SERVED, SERVED, SERVED),
    "get status of the device": ((0x80, 0, 0, 0, 2), SERVED, SERVED, SERVED),
    "get status of endpoint 0": ((0x82, 0, 0, 0, 2), SERVED, SERVED, SERVED),
    "get status of an interface": ((0x81, 0, 0, 1, 2), REFUSED, REFUSED, SERVED),
    "get status of endpoint 0x82": ((0x82, 0, 0, 0x82, 2), REFUSED, REFUSED, SERVED),
    "clear the halt of endpoint 0": ((0x02, 1, 0, 0, 0), SERVED, SERVED, SERVED),
    "clear the halt of endpoint 0x02": ((0x02, 1, 0, 0x02, 0), REFUSED, REFUSED, SERVED),
    "halt endpoint 0x81": ((0x02, 3, 0, 0x81, 0), REFUSED, REFUSED, SERVED),
    "set remote wake-up": ((0x00, 3, 1, 0, 0), REFUSED, REFUSED, REFUSED),
    "get configuration": ((0x80, 8, 0, 0, 1), SERVED, SERVED, SERVED),
    "set configuration 0": ((0x00, 9, 0, 0, 0), REFUSED, SERVED, SERVED),
    "set configuration 1": ((0x00, 9, 1, 0, 0), REFUSED, SERVED, SERVED),
    "set address while configured": ((0x00, 5, 128, 0, 0), REFUSED, REFUSED, REFUSED),
    "get interface": ((0x81, 10, 0, 1, 1), REFUSED, REFUSED, SERVED),
    "set interface": ((0x01, 11, 0, 1, 0), REFUSED, REFUSED, SERVED),
    "set line coding": ((0x21, 0x20, 0, 0, 7), REFUSED, REFUSED, SERVED),
    "get line coding": ((0xA1, 0x21, 0, 0, 7), REFUSED, REFUSED, SERVED),
    "set line state": ((0x21, 0x22, 3, 0, 0), REFUSED, REFUSED, SERVED),
    "send break": ((0x21, 0x23, 0, 0, 0), REFUSED, REFUSED, SERVED),
    "set descriptor": ((0x00, 7, 0x0100, 0, 18), REFUSED, REFUSED, REFUSED),
    "vendor request": ((0xC0, 1, 0, 0, 4), REFUSED, REFUSED, REFUSED),
}
STATES = ("default", "address", "configured")


def device_in(state: str) -> UsbBench:
    """A device in one of the states, its descriptors read."""
    bench = UsbBench().enumerate()
    if state == "default":
        bench.host.reset_bus()
        bench.host.wait(0.01)
    elif state == "address":
        bench.host.control(0x00, 9, 0)
    return bench


def sleep(bench: UsbBench, seconds: float = 0.006) -> None:
    """Suspend the bus for a while and wake the device."""
    bench.host.suspend(True)
    bench.host.wait(seconds)
    assert bench.host.transaction(Token.IN, 0).handshake == Handshake.NONE
    bench.host.suspend(False)
    bench.host.wait(0.002)


@pytest.mark.parametrize("asleep", [False, True], ids=["awake", "after sleeping"])
@pytest.mark.parametrize("state", STATES)
@on_a_new_chip
def test_each_request_is_served_or_refused_as_the_state_demands(state: str, asleep: bool) -> None:
    bench = device_in(state)
    for name, (request, *refused) in REQUESTS.items():
        if asleep:
            sleep(bench)
        assert bench.refuses(*request) == refused[STATES.index(state)], name
        if name.startswith("set configuration") and state != "default":
            bench.host.control(0x00, 9, int(state == "configured"))


@pytest.mark.parametrize("state", STATES)
@on_a_new_chip
def test_sleep_keeps_address_and_configuration(state: str) -> None:
    bench = device_in(state)
    before = bench.chip.peek(UADDR)
    sleep(bench, 0.05)
    assert bench.chip.peek(UADDR) == before == bench.host.address
    assert bench.configuration() == int(state == "configured")


@pytest.mark.parametrize("state", STATES)
@on_a_new_chip
def test_a_bus_reset_leads_to_the_default_state_from_everywhere(state: str) -> None:
    bench = device_in(state)
    bench.host.reset_bus()
    bench.host.wait(0.01)
    assert bench.chip.peek(UADDR) == 0
    assert bench.refuses(0x00, 9, 1)
    assert bench.packet(Token.IN, tries=1).handshake == Handshake.NONE


@pytest.mark.parametrize("how", ["clear halt", "halt and clear", "set interface", "configure"])
@pytest.mark.parametrize("endpoint", [0x81, 0x02, 0x82], ids=hex)
@on_a_new_chip
def test_every_endpoint_starts_again_at_data0(endpoint: int, how: str) -> None:
    bench = UsbBench().enumerate()
    exchange(bench, endpoint, 0)
    if how == "halt and clear":
        bench.host.control(0x02, 3, 0, endpoint)
    if "clear" in how:
        bench.host.control(0x02, 1, 0, endpoint)
    elif how == "set interface":
        bench.host.control(0x01, 11, 0, int(endpoint != 0x81))
    else:
        bench.host.control(0x00, 9, 1)
    exchange(bench, endpoint, 0)


def exchange(bench: UsbBench, endpoint: int, toggle: int) -> None:
    """Move one packet through an endpoint, with the toggle that is due."""
    if endpoint == 0x02:
        bench.host.wait(0.001)
        sent = bench.host.transaction(Token.OUT, 2, toggle, b"\0", fresh=True)
        assert sent.handshake == Handshake.ACK
        return
    if endpoint == 0x82:
        bench.chip.set_variable("usb_sending", 5)
    else:
        bench.chip.set_variable("usb_notify", 1)
    bench.configuration()  # whatever: the interrupt looks at both
    result = bench.host.transaction(Token.IN, endpoint & 15)
    assert (result.handshake, result.toggle) == (Handshake.ACK, toggle)


@pytest.mark.parametrize("stages", [0, 1, 2], ids=["setup only", "data", "data twice"])
@on_a_new_chip
def test_a_write_that_the_host_gives_up_does_not_disturb_the_next(stages: int) -> None:
    bench = UsbBench().enumerate()
    old = bench.host.control(0xA1, 0x21, length=7)
    bench.begin(setup_packet(0x21, 0x20, 0, 7))
    for _ in range(stages):
        assert bench.host.transaction(Token.OUT, 0, 1, b"\x01" * 7).handshake == Handshake.ACK
        bench.host.wait(0.0005)
    kept = bench.host.control(0xA1, 0x21, length=7)
    assert kept == (b"\x01" * 7 if stages else old)
    assert bench.configuration() == 1


@on_a_new_chip
def test_more_data_than_there_are_are_not_sent() -> None:
    bench = UsbBench().enumerate()
    bench.begin(setup_packet(0x80, GET_DESCRIPTOR, DEVICE_DESCRIPTOR, 64))
    sizes = []
    for _ in range(4):
        result = bench.host.transaction(Token.IN, 0)
        sizes.append(len(result.data) if result.handshake == Handshake.ACK else None)
        bench.host.wait(0.0005)
    assert sizes == [16, 2, None, None]
    assert bench.configuration() == 1


@on_a_new_chip
def test_data_for_a_request_without_data_do_no_harm() -> None:
    bench = UsbBench().enumerate()
    bench.begin(setup_packet(0x00, 9, 1, 0))
    bench.host.transaction(Token.OUT, 0, 1, bytes(16))
    bench.host.wait(0.0005)
    assert bench.configuration() == 1


@pytest.mark.parametrize("seed", [1, 2, 3])
@on_a_new_chip
def test_a_bus_reset_at_any_moment_is_survived(seed: int) -> None:
    bench = UsbBench().open()
    chance = random.Random(seed)
    for _ in range(12):
        bench.host.send(encode(Frame(chance.randrange(1, 256), Command.STATUS, b"")) * 8)
        bench.host.wait(chance.random() * 2e-3)
        if chance.random() < 0.5:
            bench.host.setup(setup_packet(0x80, GET_DESCRIPTOR, 0x0200, 67))
            bench.host.wait(chance.random() * 1e-4)
        bench.host.reset_bus()
        bench.host.wait(0.01)
        assert bench.chip.peek(UADDR) == 0
        bench.open()
        bench.host.receive()
        assert bench.ask(0, Command.HELLO)[0] == ErrorCode.OK


@on_a_new_chip
def test_a_board_without_vbus_sense_is_always_attached() -> None:
    bench = UsbBench()
    bench.chip.drive("RB6", Drive.OPEN)
    bench.chip.run(0.2)
    assert bench.chip.peek(UCON) & USBEN
