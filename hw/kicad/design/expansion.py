# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Sheet 7: reset, programming, step and direction for outside drivers."""

from design import footprints as fp
from design.parts import capacitor, ground, resistor, supply
from design.sheet import Sheet

STEP_INPUTS = ("COIL_Z1", "COIL_Z2", "COIL_Z3", "COIL_X1", "COIL_X2", "COIL_X3")
STEP_OUTPUTS = ("STEP_Z", "DIR_Z", "ENABLE_Z", "STEP_X", "DIR_X", "ENABLE_X")
BUFFER_IN = ("2", "3", "4", "5", "6", "7")
BUFFER_OUT = ("18", "17", "16", "15", "14", "13")
BENDS = (74, 76, 78, 78, 76, 74)
HEADER_PINS = ("3", "4", "5", "6", "7", "8")


def draw() -> Sheet:
    """Return the sheet."""
    sheet = Sheet(
        "expansion",
        "Programming and expansion",
        "A4",
        7,
        "Reset, ICSP, step and direction header, spare pins, mounting holes",
        "Reset, ICSP, step and direction,\nspare pins, mounting holes",
    )
    _reset(sheet)
    _icsp(sheet)
    _step_direction(sheet)
    _mechanics(sheet)
    return sheet


def _reset(sheet: Sheet) -> None:
    sheet.frame((10, 10), (84, 62))
    sheet.text("Reset", (12, 14), 1.5)
    resistor(sheet, "R3", "10k", (30, 24))
    supply(sheet, "+5V", "R3.1", 1)
    sheet.wire("R3.2", (30, 32))
    resistor(sheet, "R4", "1k", (50, 32), across=True)
    sheet.wire((20, 32), "R4.1")
    sheet.wire("R4.2", (58, 32))
    sheet.to_sheet("MCLR", (58, 32), 0)
    sheet.label("RESET", (36, 32))
    sheet.place(
        "SW1",
        "Switch:SW_Push",
        "RESET",
        (20, 40),
        rot=90,
        footprint=fp.BUTTON,
        ref_at=(2, -1, "left"),
        value_at=(2, 1, "left"),
    )
    sheet.wire("SW1.2", (20, 32))
    ground(sheet, "GND", "SW1.1", 2)
    capacitor(sheet, "C9", "100n", (42, 39))
    sheet.wire("C9.1", (42, 32))
    ground(sheet, "GND", "C9.2", 2)
    sheet.text("R4 keeps C9 and the button off the programmer's 12 V", (12, 58))


def _icsp(sheet: Sheet) -> None:
    sheet.frame((88, 10), (152, 62))
    sheet.text("In-circuit programming (PICkit order)", (90, 14), 1.5)
    sheet.place(
        "J13",
        "Connector_Generic:Conn_01x06",
        "ICSP",
        (138, 32),
        footprint=fp.HEADER.format(6),
        ref_at=(-1, -6.4, "left"),
        value_at=(-1, 8.6, "left"),
    )
    for pin, net in (("1", "MCLR"), ("4", "PGD"), ("5", "VBUS_SENSE")):
        sheet.stub(net, f"J13.{pin}", -8)
    sheet.wire("J13.2", (120, 30), (120, 26))
    sheet.power("+5V", (120, 26))
    sheet.wire("J13.3", (112, 32), (112, 46))
    sheet.power("GND", (112, 46))
    sheet.nc("J13.6")
    sheet.text("VBUS_SENSE is RB6 = PGC", (122, 52))


def _step_direction(sheet: Sheet) -> None:
    sheet.frame((10, 66), (156, 130))
    sheet.text("Step and direction for outside drivers; link JP1 to switch it on", (12, 70), 1.5)
    sheet.place(
        "U12",
        "74xx:74HCT541",
        "74HCT541",
        (58, 98),
        footprint=fp.DIP20,
        ref_at=(2, -14.6, "left"),
        value_at=(2, 14.8, "left"),
    )
    for pin, net in zip(BUFFER_IN, STEP_INPUTS, strict=True):
        sheet.stub(net, f"U12.{pin}", -6)
    sheet.wire("U12.8", (46, 100), (46, 102))
    sheet.wire("U12.9", (46, 102))
    sheet.wire((46, 102), (44, 102))
    sheet.power("GND", (44, 102), 270)
    sheet.wire("U12.1", (46, 106), (46, 108))
    sheet.wire("U12.19", (30, 108))
    resistor(sheet, "R77", "10k", (34, 115))
    sheet.wire("R77.1", (34, 108))
    sheet.wire("R77.2", (34, 120))
    sheet.power("+5V", (34, 120), 180)
    sheet.label("DRIVERS_OFF", (36, 108))
    sheet.place(
        "JP1",
        "Jumper:Jumper_2_Open",
        "DRIVERS",
        (26, 108),
        rot=180,
        footprint=fp.HEADER.format(2),
        ref_at=(-4, -2.6, "left"),
        value_at=(-4, 3.2, "left"),
    )
    sheet.wire("JP1.2", (20, 108))
    ground(sheet, "GND", (20, 108), 2)
    supply(sheet, "+5V", "U12.20", 1)
    ground(sheet, "GND", "U12.10", 1)
    sheet.nc("U12.12", "U12.11")
    for index, (pin, net, bend) in enumerate(zip(BUFFER_OUT, STEP_OUTPUTS, BENDS, strict=True)):
        ref, row = f"R{71 + index}", 82 + 4 * index
        sheet.place(
            ref,
            "Device:R",
            "100",
            (88, row),
            rot=90,
            footprint=fp.RESISTOR,
            ref_at=(-3.2, -1.6, "left"),
            value_at=(0.4, -1.6, "left"),
        )
        start = sheet.point(f"U12.{pin}")
        sheet.wire(start, (bend, start[1]), (bend, row), f"{ref}.1")
        sheet.wire(f"{ref}.2", (96, row))
        sheet.label(net, (96, row))
    _step_header(sheet)
    capacitor(sheet, "C36", "100n", (88, 118))
    supply(sheet, "+5V", "C36.1", 1)
    ground(sheet, "GND", "C36.2", 1)


def _step_header(sheet: Sheet) -> None:
    sheet.place(
        "J14",
        "Connector_Generic:Conn_02x05_Odd_Even",
        "STEP/DIR",
        (126, 116),
        footprint=fp.IDC_10,
        ref_at=(-1, -6.4, "left"),
        value_at=(-1, 6.6, "left"),
    )
    for pin, net in zip(HEADER_PINS, STEP_OUTPUTS, strict=True):
        step = -3 if int(pin) % 2 else 3
        sheet.wire(f"J14.{pin}", sheet.off(f"J14.{pin}", step, 0))
        sheet.label(net, sheet.off(f"J14.{pin}", step, 0), 180 if step < 0 else 0)
    sheet.wire("J14.1", (118, 112), (118, 110))
    sheet.power("+5V", (118, 110))
    sheet.wire("J14.9", (114, 120), (114, 122))
    sheet.power("+5V", (114, 122), 180)
    sheet.wire("J14.2", (146, 112))
    sheet.power("GND", (146, 112), 90)
    sheet.wire("J14.10", (140, 120), (140, 122))
    sheet.power("GND", (140, 122))


def _mechanics(sheet: Sheet) -> None:
    sheet.frame((156, 10), (224, 62))
    sheet.text("Spare pins", (158, 14), 1.5)
    sheet.place(
        "J15",
        "Connector_Generic:Conn_01x04",
        "SPARE",
        (206, 30),
        footprint=fp.HEADER.format(4),
        ref_at=(-1, -4.4, "left"),
        value_at=(-1, 6.6, "left"),
    )
    sheet.stub("SPARE_RC1", "J15.1", -8)
    sheet.stub("SPARE_RE2", "J15.2", -8)
    sheet.wire("J15.3", (178, 32), (178, 30))
    sheet.power("+5V", (178, 30))
    sheet.wire("J15.4", (190, 34))
    ground(sheet, "GND", (190, 34), 2)
    sheet.text("M3 holes", (158, 46), 1.5)
    for index in range(4):
        sheet.place(
            f"H{index + 1}",
            "Mechanical:MountingHole",
            "M3",
            (162 + 10 * index, 54),
            footprint=fp.HOLE_M3,
            ref_at=(-1, -3, "left"),
            value_at=(-1, 3, "left"),
        )
