# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Sheet 3: supply input, emergency stop, the two 5 V rails, power path."""

from design import footprints as fp
from design.parts import (
    capacitor,
    diode,
    electrolytic,
    ground,
    led,
    resistor,
    supply,
    terminal,
    zener,
)
from design.sheet import Sheet


def draw() -> Sheet:
    """Return the sheet."""
    sheet = Sheet(
        "power",
        "Power",
        "A4",
        3,
        "Fuse, reverse polarity, emergency stop, isolated logic supply",
        "5 to 12 V in: fuse, reverse polarity,\nemergency stop, 5 V for both sides",
    )
    _input(sheet)
    _estop(sheet)
    _regulator(sheet)
    _isolated(sheet)
    _estop_sense(sheet)
    return sheet


def _input(sheet: Sheet) -> None:
    sheet.frame((10, 12), (110, 76))
    sheet.text("Supply 5 to 12 V: fuse, reverse polarity (Q4), surge (D4)", (12, 16), 1.5)
    terminal(sheet, "J2", "SUPPLY", 2, (15, 30), mirrored=True)
    sheet.place("F2", "Device:Fuse", "T5A", (28, 30), rot=90, footprint=fp.FUSE_5X20)
    sheet.wire("J2.1", "F2.1")
    sheet.wire("J2.2", (22, 32), (22, 64), (36, 64))
    sheet.label("SUPPLY_N", (24, 64))
    sheet.place(
        "Q4",
        "Transistor_FET:IRLZ44N",
        "IRLZ44N",
        (40, 62),
        rot=90,
        mirror="x",
        footprint=fp.TO220,
        ref_at=(-4, 4.2, "left"),
        value_at=(0.5, 4.2, "left"),
    )
    sheet.wire("Q4.3", (106, 64))
    sheet.wire("F2.2", (116, 30))
    resistor(sheet, "R9", "10k", (40, 36))
    sheet.wire((40, 30), "R9.1")
    sheet.wire("R9.2", "Q4.1")
    sheet.label("REV_GATE", (40, 56), 180)
    zener(sheet, "D3", "9V1", (50, 56), "up", fp.DIODE_1A)
    sheet.wire((40, 50), (50, 50), "D3.1")
    sheet.wire("D3.2", (50, 64))
    zener(sheet, "D4", "P6KE18A", (60, 46), "up", fp.DIODE_TVS_600W)
    electrolytic(sheet, "C10", "2200u 25V", (73, 46), fp.ELECTROLYTIC_16)
    capacitor(sheet, "C11", "100n", (88, 46))
    resistor(sheet, "R11", "1k", (98, 42))
    led(sheet, "D6", "SUPPLY", (98, 54), "down")
    sheet.wire("R11.2", "D6.2")
    for top in ("D4.1", "C10.1", "C11.1", "R11.1"):
        sheet.wire(top, (sheet.point(top)[0], 30))
    for bottom in ("D4.2", "C10.2", "C11.2", "D6.1"):
        sheet.wire(bottom, (sheet.point(bottom)[0], 64))
    ground(sheet, "MGND", (73, 64), 2)
    sheet.power("PWR_FLAG", (106, 64))
    sheet.power("PWR_FLAG", (78, 30))
    sheet.to_sheet("VFUSE", (52, 26), 0)
    sheet.wire((52, 26), (50, 26), (50, 30))


def _estop(sheet: Sheet) -> None:
    sheet.frame((112, 12), (224, 76))
    sheet.text("Emergency stop: the contact carries the motor current", (114, 16), 1.5)
    terminal(sheet, "J3", "E-STOP", 2, (126, 30))
    sheet.wire((116, 30), "J3.1")
    sheet.wire("J3.2", (118, 32), (118, 44), (192, 44))
    electrolytic(sheet, "C12", "220u 25V", (136, 52), fp.ELECTROLYTIC_10)
    capacitor(sheet, "C13", "100n", (154, 52))
    resistor(sheet, "R10", "1k", (168, 49))
    led(sheet, "D5", "MOTOR", (168, 58), "down")
    sheet.wire("R10.2", "D5.2")
    for top in ("C12.1", "C13.1", "R10.1"):
        sheet.wire(top, (sheet.point(top)[0], 44))
    for bottom in ("C12.2", "C13.2", "D5.1"):
        sheet.wire(bottom, (sheet.point(bottom)[0], 64))
    sheet.wire((136, 64), (168, 64))
    ground(sheet, "MGND", (154, 64), 2)
    supply(sheet, "VMOT", (128, 44), 2)
    sheet.power("PWR_FLAG", (182, 44))
    sheet.place(
        "TP7",
        "Connector:TestPoint",
        "VMOT",
        (192, 44),
        footprint=fp.TEST_POINT,
        ref_at=(1.5, -3, "left"),
        value_at=(1.5, -1.2, "left"),
    )
    sheet.place(
        "TP5",
        "Connector:TestPoint",
        "MGND",
        (206, 62),
        footprint=fp.TEST_POINT,
        ref_at=(1.5, -3, "left"),
        value_at=(1.5, -1.2, "left"),
    )
    ground(sheet, "MGND", (206, 62), 2)
    sheet.text("Open contact: no motor, no relay output.", (132, 26))
    sheet.text("The chip stays alive and reads ESTOP_SENSE.", (132, 29))


def _regulator(sheet: Sheet) -> None:
    sheet.frame((10, 80), (84, 116))
    sheet.text("5 V of the machine side", (12, 84), 1.5)
    sheet.place(
        "U3",
        "tornillo:LDO_5V_TO220",
        "LM2940CT-5.0",
        (40, 96),
        footprint=fp.TO220,
        ref_at=(-4, -3.4, "left"),
        value_at=(2, 5.4, "left"),
    )
    sheet.to_sheet("VFUSE", (20, 96), 180)
    sheet.wire((20, 96), "U3.1")
    capacitor(sheet, "C14", "470n", (24, 102))
    sheet.wire("C14.1", (24, 96))
    ground(sheet, "MGND", "C14.2")
    ground(sheet, "MGND", "U3.2", 5)
    sheet.wire("U3.3", (74, 96))
    electrolytic(sheet, "C15", "47u 25V", (60, 102), fp.ELECTROLYTIC_6)
    sheet.wire("C15.1", (60, 96))
    ground(sheet, "MGND", "C15.2")
    supply(sheet, "+5VM", (52, 96), 2)
    sheet.place(
        "TP6",
        "Connector:TestPoint",
        "+5VM",
        (74, 96),
        footprint=fp.TEST_POINT,
        ref_at=(1.5, -3, "left"),
        value_at=(1.5, -1.2, "left"),
    )


def _isolated(sheet: Sheet) -> None:
    sheet.frame((86, 80), (224, 128))
    sheet.text("Logic supply across the isolation gap; power path to USB", (88, 84), 1.5)
    sheet.place(
        "U4",
        "tornillo:DCDC_5V_5V_SIP7",
        "TMV0505S",
        (116, 98),
        footprint=fp.DCDC,
        ref_at=(-6, -5.2, "left"),
        value_at=(-6, 5.4, "left"),
    )
    capacitor(sheet, "C16", "1u", (96, 102))
    sheet.wire("U4.1", (96, 96), "C16.1")
    supply(sheet, "+5VM", (96, 96), 2)
    ground(sheet, "MGND", "C16.2")
    sheet.wire("U4.2", (106, 100))
    ground(sheet, "MGND", (106, 100), 7)
    sheet.wire("U4.7", (168, 96))
    sheet.wire("U4.5", (128, 100))
    ground(sheet, "GND", (128, 100), 7)
    electrolytic(sheet, "C17", "10u 25V", (136, 102), fp.ELECTROLYTIC_5)
    sheet.wire("C17.1", (136, 96))
    ground(sheet, "GND", "C17.2")
    resistor(sheet, "R12", "330", (154, 102))
    sheet.wire("R12.1", (154, 96))
    ground(sheet, "GND", "R12.2")
    sheet.label("V5ISO", (128, 96))
    diode(
        sheet,
        "D7",
        "1N5819",
        (172, 96),
        cathode="right",
        footprint=fp.DIODE_1A,
        symbol="Device:D_Schottky",
    )
    sheet.wire("D7.2", (168, 96))
    sheet.place(
        "Q3",
        "Transistor_FET:AO3401A",
        "AO3401A",
        (168, 108),
        rot=90,
        mirror="x",
        footprint=fp.SOT23,
        ref_at=(-4, 4.4, "left"),
        value_at=(0.5, 4.4, "left"),
    )
    sheet.wire("Q3.1", (168, 96))
    sheet.wire("Q3.3", (162, 110), (162, 114))
    sheet.wire((162, 114), (145, 114))
    sheet.power("VBUS", (145, 114))
    sheet.wire("Q3.2", (186, 110), (186, 96))
    diode(
        sheet,
        "D8",
        "1N5819",
        (174, 119),
        cathode="right",
        footprint=fp.DIODE_1A,
        symbol="Device:D_Schottky",
    )
    sheet.wire("D8.2", (162, 119), (162, 114))
    sheet.wire("D8.1", (186, 119), (186, 110))
    sheet.wire("D7.1", (196, 96))
    sheet.power("+5V", (196, 96))


def _estop_sense(sheet: Sheet) -> None:
    sheet.frame((10, 120), (84, 156))
    sheet.text("Emergency-stop sense: dark = stopped, or wire broken", (12, 124), 1.5)
    sheet.place("U5", "Isolator:LTV-817", "LTV-817", (50, 140), footprint=fp.DIP4)
    resistor(sheet, "R13", "1k", (30, 138), across=True)
    sheet.wire("R13.2", "U5.1")
    sheet.wire("R13.1", (22, 138))
    supply(sheet, "VMOT", (22, 138), 2)
    sheet.wire("U5.2", (42, 142))
    ground(sheet, "MGND", (42, 142))
    sheet.stub("ESTOP_SENSE", "U5.4", 6)
    sheet.wire("U5.3", (58, 142))
    ground(sheet, "GND", (58, 142))
