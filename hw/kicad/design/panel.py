# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Sheet 6: run, hold and stop buttons, key ladder, LCD."""

from design import footprints as fp
from design.parts import capacitor, ground, network, resistor, supply
from design.sheet import Sheet

BUTTONS = (
    ("RUN", "SW2", "R61", "C31"),
    ("HOLD", "SW3", "R62", "C32"),
    ("STOP", "SW4", "R63", "C33"),
)
LADDER = (("R65", "330"), ("R66", "390"), ("R67", "620"), ("R68", "910"))
PANEL_PINS = {
    "3": "PB_RUN",
    "4": "PB_HOLD",
    "5": "PB_STOP",
    "6": "KEY1",
    "7": "KEY2",
    "8": "KEY3",
    "9": "KEY4",
    "10": "KEY5",
}
LCD_PINS = {
    "4": "LCD_RS",
    "6": "LCD_E",
    "11": "LCD_D4",
    "12": "LCD_D5",
    "13": "LCD_D6",
    "14": "LCD_D7",
}


def draw() -> Sheet:
    """Return the sheet."""
    sheet = Sheet(
        "panel",
        "Panel",
        "A4",
        6,
        "Buttons and keys to ground; LCD HD44780, 4 bits",
        "Run, hold, stop, five keys, LCD",
    )
    _buttons(sheet)
    _ladder(sheet)
    _connector(sheet)
    _lcd(sheet)
    return sheet


def _buttons(sheet: Sheet) -> None:
    sheet.text("Run, hold, stop: on the board and on the panel", (12, 14), 1.5)
    network(sheet, "RN6", "10k", (38, 24))
    supply(sheet, "+5V", "RN6.1", 1)
    for index, (name, button, series, cap) in enumerate(BUTTONS):
        row = 38 + 20 * index
        sheet.place(
            button,
            "Switch:SW_Push",
            name,
            (22, row),
            footprint=fp.BUTTON,
            ref_at=(-4, -3.4, "left"),
            value_at=(0, -3.4, "left"),
        )
        sheet.wire(f"{button}.1", (15, row))
        ground(sheet, "GND", (15, row), 1)
        resistor(sheet, series, "1k", (58, row), across=True)
        sheet.wire(f"{button}.2", f"{series}.1")
        sheet.label(f"PB_{name}", (43, row))
        sheet.wire(f"RN6.{index + 2}", (34 + 2 * index, row))
        capacitor(sheet, cap, "100n", (66, row + 5))
        sheet.wire(f"{cap}.1", (66, row))
        ground(sheet, "GND", f"{cap}.2", 1)
        sheet.wire(f"{series}.2", (72, row))
        sheet.to_sheet(f"BUTTON_{name}", (72, row), 0)
    sheet.wire("RN6.5", (40, 96), (44, 96))
    sheet.to_sheet("ESTOP_SENSE", (44, 96), 0)


def _ladder(sheet: Sheet) -> None:
    sheet.text("Five keys on one analogue input", (96, 14), 1.5)
    resistor(sheet, "R64", "2k2", (122, 25))
    supply(sheet, "+5V", "R64.1", 1)
    above = "R64.2"
    for index, (ref, value) in enumerate(LADDER):
        node = (122, 32 + 12 * index)
        resistor(sheet, ref, value, (122, node[1] + 6))
        sheet.wire(above, node)
        sheet.wire(node, f"{ref}.1")
        sheet.wire(node, (126, node[1]))
        sheet.label(f"KEY{index + 1}", (126, node[1]))
        above = f"{ref}.2"
    sheet.wire(above, (122, 80), (126, 80))
    sheet.label("KEY5", (126, 80))
    resistor(sheet, "R69", "1k", (112, 32), across=True)
    sheet.wire("R69.2", (122, 32))
    sheet.wire("R69.1", (102, 32))
    sheet.to_sheet("KEY_LADDER", (102, 32), 180)
    capacitor(sheet, "C34", "100n", (106, 38))
    sheet.wire("C34.1", (106, 32))
    ground(sheet, "GND", "C34.2", 1)


def _connector(sheet: Sheet) -> None:
    sheet.text("Panel connector", (94, 96), 1.5)
    sheet.place(
        "J11",
        "Connector_Generic:Conn_02x05_Odd_Even",
        "PANEL",
        (118, 112),
        footprint=fp.IDC_10,
        ref_at=(-1, -6.4, "left"),
        value_at=(-1, 6.6, "left"),
    )
    sheet.wire("J11.1", (110, 108), (110, 106))
    sheet.power("+5V", (110, 106))
    sheet.wire("J11.2", (140, 108))
    ground(sheet, "GND", (140, 108), 2)
    for pin, net in PANEL_PINS.items():
        step = -4 if int(pin) % 2 else 4
        sheet.wire(f"J11.{pin}", sheet.off(f"J11.{pin}", step, 0))
        sheet.label(net, sheet.off(f"J11.{pin}", step, 0), 180 if step < 0 else 0)


def _lcd(sheet: Sheet) -> None:
    sheet.text("LCD 16x2, HD44780, write only", (158, 14), 1.5)
    sheet.place(
        "J12",
        "Connector_Generic:Conn_01x16",
        "LCD",
        (214, 60),
        footprint=fp.HEADER.format(16),
        ref_at=(-1, -17.2, "left"),
        value_at=(-1, 19, "left"),
    )
    for pin, net in LCD_PINS.items():
        sheet.wire(f"J12.{pin}", sheet.off(f"J12.{pin}", -8, 0))
        sheet.to_sheet(net, sheet.off(f"J12.{pin}", -8, 0), 180)
    sheet.nc("J12.7", "J12.8", "J12.9", "J12.10")
    sheet.wire("J12.1", (206, 46), (206, 36))
    sheet.power("GND", (206, 36), 180)
    sheet.wire("J12.5", (206, 54))
    sheet.power("GND", (206, 54), 270)
    sheet.wire("J12.16", (208, 76))
    ground(sheet, "GND", (208, 76), 2)
    sheet.wire("J12.2", (202, 48), (202, 38))
    sheet.wire((168, 38), (202, 38))
    supply(sheet, "+5V", (186, 38), 2)
    capacitor(sheet, "C35", "100n", (168, 44))
    sheet.wire("C35.1", (168, 38))
    ground(sheet, "GND", "C35.2", 1)
    sheet.place(
        "RV1",
        "Device:R_Potentiometer_Trim",
        "10k",
        (182, 46),
        footprint=fp.TRIMMER,
        ref_at=(-2, -1, "right"),
        value_at=(-2, 1, "right"),
    )
    sheet.wire("RV1.1", (182, 38))
    ground(sheet, "GND", "RV1.3", 1)
    sheet.wire("RV1.2", (190, 46), (190, 50), "J12.3")
    sheet.label("LCD_VO", (191, 50))
    resistor(sheet, "R70", "100", (186, 74), across=True)
    sheet.wire("R70.2", "J12.15")
    sheet.wire("R70.1", (178, 74))
    supply(sheet, "+5V", (178, 74), 2)
    sheet.text("LCD backlight", (170, 80))
