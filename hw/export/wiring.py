# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Draws what is wired to which terminal, from the netlist.

The words for each wire are kept by hand with the net they belong to; a net
that is not on that pin is an error, so the drawing cannot lie.
"""

from __future__ import annotations

import html
from pathlib import Path
from xml.etree import ElementTree

Wire = tuple[str, str, str]

# Connector: title, and for each pin the net it must have, wire and far end.
CONNECTORS: dict[str, tuple[str, list[Wire]]] = {
    "J2": (
        "Supply, 12 V 5 A (or 5 V 5 A)",
        [("*", "red 1 mm2", "supply +"), ("SUPPLY_N", "black 1 mm2", "supply -")],
    ),
    "J3": (
        "Emergency stop, normally closed",
        [("VFUSE", "1 mm2", "stop button 11"), ("VMOT", "1 mm2", "stop button 12")],
    ),
    "J5": (
        "Motor Z (along the bed)",
        [
            ("VMOT", "0.75 mm2", "3.3 ohm 25 W, then common"),
            ("Z_PH1", "0.5 mm2", "winding 1"),
            ("Z_PH2", "0.5 mm2", "winding 2"),
            ("Z_PH3", "0.5 mm2", "winding 3"),
            ("Z_PH4", "0.5 mm2", "winding 4"),
            ("VMOT", "", "spare, same as 1"),
        ],
    ),
    "J6": (
        "Motor X (cross slide)",
        [
            ("VMOT", "0.75 mm2", "3.3 ohm 25 W, then common"),
            ("X_PH1", "0.5 mm2", "winding 1"),
            ("X_PH2", "0.5 mm2", "winding 2"),
            ("X_PH3", "0.5 mm2", "winding 3"),
            ("X_PH4", "0.5 mm2", "winding 4"),
            ("VMOT", "", "spare, same as 1"),
        ],
    ),
    "J7": (
        "Limit switches, normally closed",
        [
            ("SW_X", "screened pair", "switch X: common"),
            ("MGND", "", "switch X: NC contact"),
            ("SW_Z", "screened pair", "switch Z: common"),
            ("MGND", "", "switch Z: NC contact"),
        ],
    ),
    "J8": (
        "Contact sensor",
        [
            ("TOOL", "0.25 mm2", "insulated tool or probe"),
            ("FRAME", "0.25 mm2", "bare metal of the headstock"),
        ],
    ),
    "J9": (
        "Spindle index sensor, 5 V open collector",
        [
            ("+5VM", "0.25 mm2", "sensor +"),
            ("INDEX_IN", "0.25 mm2", "sensor output"),
            ("MGND", "0.25 mm2", "sensor -"),
        ],
    ),
    "J10": (
        "Outputs, 0.5 A each",
        [
            ("VMOT", "0.5 mm2", "spindle relay coil +"),
            ("SPINDLE_OUT", "0.5 mm2", "spindle relay coil -"),
            ("VMOT", "0.5 mm2", "coolant relay coil +"),
            ("COOLANT_OUT", "0.5 mm2", "coolant relay coil -"),
        ],
    ),
    "J11": (
        "Panel, ribbon cable",
        [
            ("+5V", "", "panel supply"),
            ("GND", "", "common of all buttons and keys"),
            ("PB_RUN", "", "RUN button"),
            ("PB_HOLD", "", "HOLD button"),
            ("PB_STOP", "", "STOP button"),
            ("KEY1", "", "key UP"),
            ("KEY2", "", "key DOWN"),
            ("KEY3", "", "key LEFT"),
            ("KEY4", "", "key RIGHT"),
            ("KEY5", "", "key OK"),
        ],
    ),
    "J14": (
        "Step and direction, for outside drivers",
        [
            ("+5V", "", "drivers' opto supply"),
            ("GND", "", "drivers' ground"),
            ("STEP_Z", "", "Z step"),
            ("DIR_Z", "", "Z direction"),
            ("ENABLE_Z", "", "Z enable"),
            ("STEP_X", "", "X step"),
            ("DIR_X", "", "X direction"),
            ("ENABLE_X", "", "X enable"),
            ("+5V", "", ""),
            ("GND", "", ""),
        ],
    ),
    "J13": (
        "In-circuit programming",
        [
            ("MCLR", "", "VPP, pin 1 of the programmer"),
            ("+5V", "", "supply"),
            ("GND", "", "ground"),
            ("PGD", "", "data"),
            ("VBUS_SENSE", "", "clock (PGC)"),
            ("nothing", "", "open"),
        ],
    ),
    "J12": (
        "LCD 16x2, HD44780",
        [
            ("GND", "", "VSS"),
            ("+5V", "", "VDD"),
            ("LCD_VO", "", "VO, contrast"),
            ("LCD_RS", "", "RS"),
            ("GND", "", "R/W, write only"),
            ("LCD_E", "", "E"),
            ("nothing", "", "D0, open"),
            ("nothing", "", "D1, open"),
            ("nothing", "", "D2, open"),
            ("nothing", "", "D3, open"),
            ("LCD_D4", "", "D4"),
            ("LCD_D5", "", "D5"),
            ("LCD_D6", "", "D6"),
            ("LCD_D7", "", "D7"),
            ("*", "", "backlight anode, through 100 ohm"),
            ("GND", "", "backlight cathode"),
        ],
    ),
}
COLUMNS = (("J2", "J3", "J5", "J6"), ("J7", "J8", "J9", "J10", "J13"), ("J11", "J14", "J12"))
WIDTH, LINE = 430, 18


def _nets(netlist: Path) -> dict[tuple[str, str], str]:
    found = {}
    for net in ElementTree.parse(netlist).iterfind(".//net"):
        if net.get("name", "").startswith("unconnected-"):
            continue
        for node in net.iter("node"):
            found[node.get("ref", ""), node.get("pin", "")] = net.get("name", "").rsplit("/", 1)[-1]
    return found


def write(netlist: Path, target: Path) -> None:
    """Draw the wiring; raises ValueError where words and netlist disagree."""
    nets = _nets(netlist)
    body, bottom = [], 0
    for column, refs in enumerate(COLUMNS):
        x, y = 10 + column * (WIDTH + 20), 50
        for ref in refs:
            title, wires = CONNECTORS[ref]
            height = LINE * len(wires) + 34
            body.append(
                f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{height}" rx="4" '
                'fill="#f7f7f2" stroke="#444"/>'
            )
            body.append(_text(x + 8, y + 17, f"{ref}  {title}", bold=True))
            for index, (net, wire, end) in enumerate(wires):
                real = nets.get((ref, str(index + 1)), "nothing")
                if net not in ("*", real):
                    raise ValueError(f"{ref}.{index + 1} is {real}, the drawing says {net}")
                line = y + 38 + LINE * index
                body.append(
                    f'<rect x="{x + 8}" y="{line - 12}" width="22" height="15" fill="#3a7d44"/>'
                )
                body.append(_text(x + 13, line, str(index + 1), colour="white"))
                shown = {"J2": "SUPPLY_P", "J12": "LCD_LED"}[ref] if net == "*" else real
                body.append(_text(x + 38, line, shown))
                body.append(
                    f'<line x1="{x + 140}" y1="{line - 4}" x2="{x + 170}" '
                    f'y2="{line - 4}" stroke="#b00" stroke-width="2"/>'
                )
                body.append(_text(x + 178, line, ": ".join(word for word in (end, wire) if word)))
            y += height + 14
        bottom = max(bottom, y)
    width = len(COLUMNS) * (WIDTH + 20)
    target.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {bottom}" width="{width}" '
        f'height="{bottom}" font-family="sans-serif" font-size="12">\n'
        f'<rect width="{width}" height="{bottom}" fill="white"/>\n'
        + _text(10, 28, "Tornillo control board: what goes to which terminal", bold=True, size=18)
        + "\n"
        + "\n".join(body)
        + "\n</svg>\n",
        encoding="utf-8",
    )


def _text(
    x: int, y: int, words: str, *, bold: bool = False, colour: str = "black", size: int = 12
) -> str:
    weight = ' font-weight="bold"' if bold else ""
    return (
        f'<text x="{x}" y="{y}" font-size="{size}" fill="{colour}"{weight}>'
        f"{html.escape(words)}</text>"
    )
