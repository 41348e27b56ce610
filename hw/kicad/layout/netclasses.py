# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Net classes: which nets are logic and which machine, and how wide.

The side of a net follows from the parts it touches: a net that reaches a
machine-side pin belongs to the machine. The class names start with the side,
which is what the isolation rule in tornillo.kicad_dru looks at.
"""

from __future__ import annotations

# Parts that stand across the gap, and their pins on the machine side.
BRIDGES: dict[str, frozenset[str]] = {
    "U4": frozenset({"1", "2"}),
    "U5": frozenset({"1", "2"}),
    "U6": frozenset(str(pin) for pin in range(9, 17)),
    "U7": frozenset(str(pin) for pin in range(9, 17)),
    "U10": frozenset(str(pin) for pin in range(1, 9)),
    "U11": frozenset({"5", "6", "7", "8"}),
}
MOTOR = ("_PH", "CLAMP_")
SUPPLY = ("VFUSE", "VMOT", "SUPPLY_N", "Net-(J2-Pin_1)")

# Name: track width, clearance, via diameter, via drill, in mm.
CLASSES: dict[str, tuple[float, float, float, float]] = {
    "Default": (0.3, 0.25, 0.8, 0.4),
    "Logic": (0.3, 0.25, 0.8, 0.4),
    "LogicPower": (0.6, 0.25, 0.9, 0.5),
    "LogicUsb": (0.3, 0.25, 0.8, 0.4),
    "Machine": (0.4, 0.3, 0.8, 0.4),
    "MachinePower": (0.6, 0.3, 0.9, 0.5),
    "MachineMotor": (2.0, 0.4, 1.2, 0.6),
    "MachineSupply": (1.5, 0.4, 1.2, 0.6),
}


def machine_side(pins: list[tuple[str, str]], machine_parts: frozenset[str]) -> bool:
    """Tell whether a net, given as (reference, pin) pairs, is on the machine side.

    Raises ValueError for a net that touches both sides.
    """
    sides = {pin in BRIDGES[ref] if ref in BRIDGES else ref in machine_parts for ref, pin in pins}
    if len(sides) != 1:
        raise ValueError(f"net crosses the isolation gap: {pins}")
    return sides.pop()


def class_of(net: str, machine: bool) -> str:
    """Return the class of a net from its name and side."""
    if machine:
        if net in SUPPLY or net.rsplit("/", 1)[-1] in SUPPLY:
            return "MachineSupply"
        if any(word in net for word in MOTOR):
            return "MachineMotor"
        return "MachinePower" if net in ("+5VM", "MGND") else "Machine"
    if net in ("USB_DP", "USB_DM") or net.endswith(("USB_P_IN", "USB_N_IN")):
        return "LogicUsb"
    if net in ("+5V", "GND", "VBUS") or net.endswith(("V5ISO", "USB_5V")):
        return "LogicPower"
    return "Logic"
