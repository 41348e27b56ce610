# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Sheet 2: the microcontroller, its clock, USB and the VBUS sense."""

from design import footprints as fp
from design.parts import capacitor, electrolytic, ground, led, resistor, supply
from design.sheet import Sheet

LEFT = {
    "2": "KEY_LADDER",
    "3": "PROBE",
    "4": "LCD_D4",
    "5": "LCD_D5",
    "6": "LCD_D6",
    "7": "LCD_D7",
    "33": "COIL_Z1",
    "34": "COIL_Z2",
    "35": "COIL_Z3",
    "36": "COIL_Z4",
    "37": "LIMIT_X",
    "38": "LIMIT_Z",
    "39": "VBUS_SENSE",
    "40": "PGD",
}
RIGHT = {
    "15": "LED_STATUS",
    "16": "SPARE_RC1",
    "17": "SPINDLE_INDEX",
    "23": "USB_DM",
    "24": "USB_DP",
    "25": "SPINDLE_RELAY",
    "26": "COOLANT_RELAY",
    "19": "COIL_X1",
    "20": "COIL_X2",
    "21": "COIL_X3",
    "22": "COIL_X4",
    "27": "BUTTON_RUN",
    "28": "BUTTON_HOLD",
    "29": "BUTTON_STOP",
    "30": "ESTOP_SENSE",
    "8": "LCD_RS",
    "9": "LCD_E",
    "10": "SPARE_RE2",
    "1": "MCLR",
}


def draw() -> Sheet:
    """Return the sheet."""
    sheet = Sheet(
        "controller",
        "Controller and USB",
        "A3",
        2,
        "PIC18F4550, 20 MHz crystal, USB with ESD protection, VBUS sense",
        "PIC18F4550, 20 MHz, USB, VBUS sense\nR1-R8, C1-C8, D1, Q1, Q2, J1, Y1",
    )
    sheet.place(
        "U1",
        "MCU_Microchip_PIC18:PIC18F4550-IP",
        "PIC18F4550-I/P",
        (165, 90),
        footprint=fp.DIP40,
        ref_at=(8, -27.5, "left"),
        value_at=(8, 27.5, "left"),
    )
    for pin, net in LEFT.items():
        sheet.stub(net, f"U1.{pin}", -5)
    for pin, net in RIGHT.items():
        sheet.stub(net, f"U1.{pin}", 5)
    _supply(sheet)
    _clock(sheet)
    _usb(sheet)
    _vbus_sense(sheet)
    _status(sheet)
    return sheet


def _supply(sheet: Sheet) -> None:
    sheet.wire("U1.11", (163, 58), (165, 58), "U1.32")
    sheet.power("+5V", (163, 58))
    sheet.wire("U1.12", (163, 122), (165, 122), "U1.31")
    sheet.power("GND", (163, 122))
    sheet.frame((22, 20), (118, 54))
    sheet.text("Decoupling: C4 and C5 at the two VDD pins", (24, 24), 1.5)
    capacitor(sheet, "C4", "100n", (32, 40))
    capacitor(sheet, "C5", "100n", (48, 40))
    electrolytic(sheet, "C6", "10u 25V", (64, 40), fp.ELECTROLYTIC_5)
    sheet.wire("C4.1", (32, 34), (94, 34))
    sheet.wire("C4.2", (32, 46), (106, 46))
    for ref in ("C5", "C6"):
        sheet.wire(f"{ref}.1", sheet.off(f"{ref}.1", 0, -3))
        sheet.wire(f"{ref}.2", sheet.off(f"{ref}.2", 0, 3))
    supply(sheet, "+5V", (40, 34), 1)
    ground(sheet, "GND", (40, 46), 1)
    sheet.power("PWR_FLAG", (82, 34))
    sheet.place(
        "TP1",
        "Connector:TestPoint",
        "+5V",
        (94, 34),
        footprint=fp.TEST_POINT,
        ref_at=(1.5, -3, "left"),
        value_at=(1.5, -1.2, "left"),
    )
    sheet.place(
        "TP2",
        "Connector:TestPoint",
        "GND",
        (106, 46),
        footprint=fp.TEST_POINT,
        ref_at=(1.5, -3, "left"),
        value_at=(1.5, -1.2, "left"),
    )


def _clock(sheet: Sheet) -> None:
    sheet.place(
        "Y1",
        "Device:Crystal",
        "20MHz 18pF",
        (112, 82),
        rot=270,
        footprint=fp.CRYSTAL,
        ref_at=(3, -1, "left"),
        value_at=(3, 1, "left"),
    )
    sheet.place(
        "C1",
        "Device:C",
        "22p",
        (100, 79),
        rot=90,
        footprint=fp.CERAMIC,
        ref_at=(-2.6, -2.6, "left"),
        value_at=(0.4, -2.6, "left"),
    )
    capacitor(sheet, "C2", "22p", (100, 85), across=True)
    sheet.wire("U1.14", (128, 80), (128, 79), (112, 79), "C1.2")
    sheet.wire("U1.13", (128, 84), (128, 85), (112, 85), "C2.2")
    sheet.wire("C1.1", (94, 79), (94, 85), "C2.1")
    ground(sheet, "GND", (94, 85))
    sheet.label("OSC2", (121, 79))
    sheet.label("OSC1", (131, 84))


def _usb(sheet: Sheet) -> None:
    sheet.frame((14, 136), (146, 212))
    sheet.text("USB full speed; U2 takes static discharges away from the chip", (16, 140), 1.5)
    sheet.place(
        "J1",
        "Connector:USB_B",
        "USB-B",
        (35, 172),
        footprint=fp.USB_B,
        ref_at=(-4, -9.2, "left"),
        value_at=(-4, -7.4, "left"),
    )
    sheet.place("F1", "Device:Polyfuse", "0.5A", (56, 168), rot=90, footprint=fp.POLYFUSE)
    sheet.wire("J1.1", "F1.1")
    sheet.label("USB_5V", (42, 168))
    sheet.place(
        "U2",
        "Power_Protection:USBLC6-2SC6",
        "USBLC6-2SC6",
        (90, 172),
        footprint=fp.SOT23_6,
        ref_at=(3, -5, "left"),
        value_at=(3, -3.2, "left"),
    )
    sheet.wire("J1.3", "U2.1")
    sheet.wire("J1.2", "U2.3")
    sheet.label("USB_P_IN", (66, 172))
    sheet.label("USB_N_IN", (66, 174))
    sheet.wire("F1.2", (64, 168), (64, 158), (128, 158))
    sheet.wire("U2.5", (90, 158))
    capacitor(sheet, "C7", "1u", (116, 165))
    sheet.wire("C7.1", (116, 158))
    ground(sheet, "GND", "C7.2")
    supply(sheet, "VBUS", (76, 158), 1)
    sheet.power("PWR_FLAG", (128, 158))
    sheet.place(
        "TP4",
        "Connector:TestPoint",
        "VBUS",
        (104, 158),
        footprint=fp.TEST_POINT,
        ref_at=(1.5, -3, "left"),
        value_at=(1.5, -1.2, "left"),
    )
    sheet.stub("USB_DP", "U2.6", 8)
    sheet.stub("USB_DM", "U2.4", 8)
    ground(sheet, "GND", "U2.2")
    ground(sheet, "GND", "J1.4", 1)
    sheet.wire("J1.5", (33, 192), (64, 192))
    sheet.label("SHIELD", (36, 192))
    resistor(sheet, "R2", "1M", (48, 197))
    capacitor(sheet, "C8", "10n", (64, 197))
    sheet.wire("R2.1", (48, 192))
    sheet.wire("C8.1", (64, 192))
    ground(sheet, "GND", "R2.2")
    ground(sheet, "GND", "C8.2")


def _vbus_sense(sheet: Sheet) -> None:
    sheet.frame((196, 136), (312, 186))
    sheet.text("VBUS sense: RB6 is held low while no USB supply is there", (198, 140), 1.5)
    resistor(sheet, "R5", "2k2", (212, 154))
    supply(sheet, "VBUS", "R5.1")
    resistor(sheet, "R6", "1k", (212, 165))
    sheet.wire("R5.2", "R6.1")
    ground(sheet, "GND", "R6.2")
    sheet.place("Q1", "Transistor_BJT:2N3904", "2N3904", (228, 160), footprint=fp.TO92)
    sheet.wire((212, 160), "Q1.2")
    ground(sheet, "GND", "Q1.1", 4)
    resistor(sheet, "R7", "47k", (230, 151))
    supply(sheet, "+5V", "R7.1")
    sheet.wire("R7.2", "Q1.3")
    sheet.place("Q2", "Transistor_BJT:2N3904", "2N3904", (252, 155), footprint=fp.TO92)
    sheet.wire((230, 155), "Q2.2")
    sheet.label("VBUS_OFF", (236, 155))
    ground(sheet, "GND", "Q2.1", 4)
    resistor(sheet, "R8", "1k", (266, 149), across=True)
    sheet.wire("Q2.3", (254, 149), "R8.1")
    sheet.stub("VBUS_SENSE", "R8.2", 6)
    sheet.text("With R8 a programmer on RB6 (PGC) still wins.", (258, 170))


def _status(sheet: Sheet) -> None:
    resistor(sheet, "R1", "680", (252, 62), across=True)
    led(sheet, "D1", "STATUS", (264, 62), "right")
    sheet.to_sheet("LED_STATUS", (244, 62), 180)
    sheet.wire((244, 62), "R1.1")
    sheet.wire("R1.2", "D1.2")
    sheet.wire("D1.1", (270, 62))
    ground(sheet, "GND", (270, 62))
    sheet.wire("U1.18", (220, 84))
    capacitor(sheet, "C3", "470n", (220, 89))
    sheet.wire((220, 84), "C3.1")
    ground(sheet, "GND", "C3.2")
    sheet.label("VUSB", (196, 84))
    sheet.place(
        "TP3",
        "Connector:TestPoint",
        "VUSB",
        (220, 84),
        footprint=fp.TEST_POINT,
        ref_at=(1.5, -3, "left"),
        value_at=(1.5, -1.2, "left"),
    )
    sheet.text(
        "VUSB: the chip's 3.3 V for the USB pins;\nnothing else may draw from it.", (232, 90)
    )
