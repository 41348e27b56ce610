# SPDX-License-Identifier: Apache-2.0
"""The device appears when the cable goes in, and says who it is.

The descriptors are read by the package usb-protocol, a parser made elsewhere.
"""

from __future__ import annotations

import importlib

import pytest
from simulated.processes import on_a_new_chip
from tornillo.protocol import USB_PRODUCT_ID, USB_VENDOR_ID, Command, ErrorCode

from firmware.usb_bench import CYCLES_PER_MS, UsbBench

standard = importlib.import_module("usb_protocol.types.descriptors.standard")
cdc = importlib.import_module("usb_protocol.types.descriptors.cdc")

UCON, USBEN = 0xF6D, 0x08
INTERFACE, ENDPOINT, CLASS_SPECIFIC = 4, 5, 0x24


def pieces(configuration: bytes) -> list[bytes]:
    """Cut a configuration into its descriptors."""
    found = []
    while configuration:
        found.append(configuration[: configuration[0]])
        configuration = configuration[configuration[0] :]
    return found


@on_a_new_chip
def test_linux_enumeration_succeeds_without_a_mistake_of_the_firmware() -> None:
    bench = UsbBench().open()
    assert bench.configuration() == 1


@on_a_new_chip
def test_device_descriptor_is_understood_by_another_parser() -> None:
    bench = UsbBench().enumerate()
    device = standard.DeviceDescriptor.parse(bench.host.description.device)
    assert (device.idVendor, device.idProduct) == (USB_VENDOR_ID, USB_PRODUCT_ID)
    assert device.bcdUSB == 2.0
    assert (device.bDeviceClass, device.bDeviceSubclass, device.bDeviceProtocol) == (2, 2, 0)
    assert device.bMaxPacketSize0 == 16
    assert device.bNumConfigurations == 1


@on_a_new_chip
def test_configuration_descriptor_is_understood_by_another_parser() -> None:
    raw = UsbBench().enumerate().host.description.configuration
    configuration = standard.ConfigurationDescriptor.parse(raw)
    assert configuration.wTotalLength == len(raw)
    assert configuration.bNumInterfaces == 2
    assert configuration.bmAttributes == 0xC0
    assert configuration.bMaxPower == 50

    parts = pieces(raw)
    interfaces = [standard.InterfaceDescriptor.parse(p) for p in parts if p[1] == INTERFACE]
    assert [
        (i.bInterfaceNumber, i.bInterfaceClass, i.bInterfaceSubclass, i.bInterfaceProtocol)
        for i in interfaces
    ] == [(0, 2, 2, 0), (1, 0x0A, 0, 0)]
    assert [i.bNumEndpoints for i in interfaces] == [1, 2]

    endpoints = [standard.EndpointDescriptor.parse(p) for p in parts if p[1] == ENDPOINT]
    assert [(e.bEndpointAddress, e.bmAttributes, e.wMaxPacketSize) for e in endpoints] == [
        (0x81, 3, 16),
        (0x02, 2, 64),
        (0x82, 2, 64),
    ]


@on_a_new_chip
def test_class_descriptors_are_understood_by_another_parser() -> None:
    raw = UsbBench().enumerate().host.description.configuration
    header, call, acm, union = (p for p in pieces(raw) if p[1] == CLASS_SPECIFIC)
    assert header[3:] == b"\x20\x01"
    assert cdc.HeaderDescriptor.parse(header).bLength == 5
    assert cdc.CallManagementFunctionalDescriptor.parse(call).bDataInterface == 1
    assert cdc.ACMFunctionalDescriptor.parse(acm).bmCapabilities == 6
    parsed = cdc.UnionFunctionalDescriptor.parse(union)
    assert (parsed.bControlInterface, parsed.bSubordinateInterface0) == (0, 1)


@on_a_new_chip
def test_strings_are_understood_by_another_parser() -> None:
    bench = UsbBench(b"TN-00042").enumerate()
    device = standard.DeviceDescriptor.parse(bench.host.description.device)
    indices = (device.iManufacturer, device.iProduct, device.iSerialNumber)
    texts = [
        standard.StringDescriptor.parse(
            bench.host.control(0x80, 6, 0x0300 | index, 0x0409, length=255)
        ).bString
        for index in indices
    ]
    assert texts == ["Tornillo", "Tornillo lathe", "TN-00042"]
    languages = bench.host.control(0x80, 6, 0x0300, length=255)
    assert list(standard.StringLanguageDescriptor.parse(languages).wLANGID) == [0x0409]


@pytest.mark.parametrize(
    ("stored", "shown"),
    [
        pytest.param(b"\xff" * 8, "00000000", id="blank"),
        pytest.param(b"\0" * 8, "00000000", id="zero"),
        pytest.param(b"TN,00042", "TN000042", id="comma"),
        pytest.param(b"TN 00042", "TN000042", id="space"),
        pytest.param(b"TN0004\xff\xff", "TN000400", id="too short"),
        pytest.param(b"!~\x7f\x20AZaz", "!~00AZaz", id="ends of the range"),
    ],
)
@on_a_new_chip
def test_a_character_that_hosts_refuse_reads_as_0(stored: bytes, shown: str) -> None:
    bench = UsbBench(stored).enumerate()
    assert bench.host.description.strings[3] == shown


@on_a_new_chip
def test_the_serial_number_is_set_shown_at_once_and_kept() -> None:
    bench = UsbBench().open()
    assert bench.ask(1, Command.SERIAL_SET, b"TN-00042") == bytes([ErrorCode.OK])
    assert b"TN-00042" in bench.ask(0, Command.HELLO)
    assert bench.enumerate().host.description.strings[3] == "TN-00042"
    assert bench.chip.save().eeprom[0xF0:0xF8] == b"TN-00042"
    bench.open()
    for wrong in (b"", b"TN-0042", b"TN-000042"):
        assert bench.ask(2, Command.SERIAL_SET, wrong) == bytes([ErrorCode.BAD_LENGTH])


@on_a_new_chip
def test_the_engine_is_off_without_a_cable() -> None:
    bench = UsbBench()
    bench.chip.run(0.5)
    assert bench.chip.peek(UCON) == 0
    assert not bench.host.connected


@on_a_new_chip
def test_the_device_appears_50_ms_after_the_cable_went_in() -> None:
    bench = UsbBench()
    bench.chip.run(0.2)
    plugged = bench.chip.cycle
    bench.host.plug()
    assert bench.chip.run_until(lambda: bench.host.connected, timeout=0.1, every=1e-5)
    delay = bench.chip.cycle - plugged
    assert 49 * CYCLES_PER_MS <= delay <= 51 * CYCLES_PER_MS


@on_a_new_chip
def test_a_bouncing_plug_does_not_make_the_device_appear() -> None:
    bench = UsbBench()
    bench.chip.run(0.2)
    for _ in range(10):
        bench.host.plug()
        bench.chip.run(0.045)
        assert not bench.host.connected
        bench.host.unplug()
        bench.chip.run(0.002)


@on_a_new_chip
def test_the_engine_is_off_6_ms_after_the_cable_was_pulled() -> None:
    bench = UsbBench().open()
    bench.host.unplug()
    bench.chip.run(0.003)
    assert bench.chip.peek(UCON) & USBEN
    bench.chip.run(0.003)
    assert bench.chip.peek(UCON) == 0


@on_a_new_chip
def test_the_device_comes_back_after_every_replug() -> None:
    bench = UsbBench().open()
    for seconds in (0.002, 0.01, 0.2):
        bench.host.unplug()
        bench.chip.run(seconds)
        bench.open()
        assert bench.ask(1, 1)[0] == 0
