# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Places the common parts, so that a sheet reads as a circuit."""

from __future__ import annotations

from design import footprints as fp
from design.sheet import Part, Point, Sheet


def resistor(
    sheet: Sheet,
    ref: str,
    value: str,
    at: Point,
    *,
    across: bool = False,
    footprint: str = fp.RESISTOR,
) -> Part:
    """Place a resistor: upright, or across with pin 1 on the left."""
    return sheet.place(ref, "Device:R", value, at, rot=90 if across else 0, footprint=footprint)


def capacitor(
    sheet: Sheet,
    ref: str,
    value: str,
    at: Point,
    *,
    across: bool = False,
    footprint: str = fp.CERAMIC,
) -> Part:
    """Place a ceramic or film capacitor: upright, or across."""
    return sheet.place(ref, "Device:C", value, at, rot=90 if across else 0, footprint=footprint)


def electrolytic(sheet: Sheet, ref: str, value: str, at: Point, footprint: str) -> Part:
    """Place an electrolytic capacitor, plus up."""
    return sheet.place(ref, "Device:C_Polarized", value, at, footprint=footprint)


def diode(
    sheet: Sheet,
    ref: str,
    value: str,
    at: Point,
    *,
    cathode: str,
    footprint: str,
    symbol: str = "Device:D",
) -> Part:
    """Place a diode, zener or LED; cathode says where its cathode points."""
    rot = {"left": 0, "down": 90, "right": 180, "up": 270}[cathode]
    return sheet.place(ref, symbol, value, at, rot=rot, footprint=footprint)


def led(sheet: Sheet, ref: str, value: str, at: Point, cathode: str) -> Part:
    """Place a 3 mm LED."""
    return diode(sheet, ref, value, at, cathode=cathode, footprint=fp.LED_3MM, symbol="Device:LED")


def zener(sheet: Sheet, ref: str, value: str, at: Point, cathode: str, footprint: str) -> Part:
    """Place a zener or a one-way transient suppressor."""
    return diode(
        sheet, ref, value, at, cathode=cathode, footprint=footprint, symbol="Device:D_Zener"
    )


def network(sheet: Sheet, ref: str, value: str, at: Point, *, flipped: bool = False) -> Part:
    """Place a network of four resistors with a common pin; flipped has its taps up."""
    return sheet.place(
        ref,
        "Device:R_Network04",
        value,
        at,
        rot=180 if flipped else 0,
        footprint=fp.NETWORK_5,
        ref_at=(6 if flipped else 4, -1, "left"),
        value_at=(6 if flipped else 4, 1, "left"),
    )


def ground(sheet: Sheet, net: str, pin: Point | str, drop: int = 2) -> None:
    """Lead a pin down to a ground symbol."""
    end = sheet.off(pin, 0, drop)
    sheet.wire(pin, end)
    sheet.power(net, end)


def supply(sheet: Sheet, net: str, pin: Point | str, rise: int = 2) -> None:
    """Lead a pin up to a supply symbol."""
    end = sheet.off(pin, 0, -rise)
    sheet.wire(pin, end)
    sheet.power(net, end)


def terminal(
    sheet: Sheet, ref: str, value: str, ways: int, at: Point, *, mirrored: bool = False
) -> Part:
    """Place a screw terminal; mirrored has its wires on the right."""
    top = {2: -1, 3: -3, 4: -3, 6: -5}[ways]
    return sheet.place(
        ref,
        f"Connector:Screw_Terminal_01x0{ways}",
        value,
        at,
        mirror="y" if mirrored else "",
        footprint=fp.SCREW.format(ways),
        ref_at=(-2, top - 2.8, "left"),
        value_at=(-2, top - 1.2, "left"),
    )
