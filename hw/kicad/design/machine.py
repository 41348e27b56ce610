# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Sheet 5: limit switches, index, contact sensor, and the two outputs."""

from design import footprints as fp
from design.parts import capacitor, diode, ground, network, resistor, supply, terminal
from design.sheet import Sheet


def draw() -> Sheet:
    """Return the sheet."""
    sheet = Sheet(
        "machine",
        "Inputs and outputs",
        "A3",
        5,
        "Everything that comes from the machine crosses the isolation gap",
        "Limit switches, spindle index, contact\nsensor, spindle and coolant outputs",
    )
    network(sheet, "RN5", "10k", (126, 26))
    supply(sheet, "+5V", "RN5.1", 1)
    _limits(sheet)
    _index(sheet)
    _probe(sheet)
    _output(
        sheet,
        "SPINDLE_RELAY",
        40,
        resistors=("R51", "R53", "R55"),
        transistor="Q6",
        clamp="D51",
        unit=1,
        pins=("1", "2", "8", "7"),
    )
    _output(
        sheet,
        "COOLANT_RELAY",
        84,
        resistors=("R52", "R54", "R56"),
        transistor="Q7",
        clamp="D52",
        unit=2,
        pins=("3", "4", "6", "5"),
    )
    _output_terminal(sheet)
    return sheet


def _switch(
    sheet: Sheet,
    net: str,
    row: int,
    numbers: tuple[str, str, str, str],
    value: str,
    gate: tuple[str, int, str, str],
    unit: int,
    pins: tuple[str, str, str, str],
    pull_up: str,
) -> None:
    """Draw one filtered input: pull-up, RC, Schmitt gate, coupler."""
    up, series, cap, light = numbers
    ref, gate_unit, gate_in, gate_out = gate
    resistor(sheet, up, pull_up, (34, row - 5))
    sheet.wire(f"{up}.2", (34, row))
    supply(sheet, "+5VM", f"{up}.1", 1)
    resistor(sheet, series, "10k", (46, row), across=True)
    capacitor(sheet, cap, value, (58, row + 5))
    sheet.wire(f"{series}.2", (58, row))
    sheet.wire(f"{cap}.1", (58, row))
    ground(sheet, "MGND", f"{cap}.2", 1)
    sheet.place(
        ref,
        "74xx:74HC14",
        "74HC14",
        (74, row),
        unit=gate_unit,
        footprint=fp.DIP14,
        ref_at=(-2.4, -3.2, "left"),
        value_at=(-2, 3.2, "left"),
    )
    sheet.wire((58, row), f"{ref}.{gate_in}")
    resistor(sheet, light, "1k", (90, row), across=True)
    sheet.wire(f"{ref}.{gate_out}", f"{light}.1")
    _coupler(sheet, net, row, light, unit, pins)


def _coupler(
    sheet: Sheet, net: str, row: int, light: str, unit: int, pins: tuple[str, str, str, str]
) -> None:
    sheet.place("U10", "Isolator:LTV-847", "LTV-847", (108, row + 2), unit=unit, footprint=fp.DIP16)
    anode, cathode, collector, emitter = (f"U10.{pin}" for pin in pins)
    sheet.wire(f"{light}.2", anode)
    sheet.wire(cathode, sheet.off(cathode, -3, 0))
    ground(sheet, "MGND", sheet.off(cathode, -3, 0), 1)
    sheet.wire(emitter, sheet.off(emitter, 3, 0))
    ground(sheet, "GND", sheet.off(emitter, 3, 0), 1)
    sheet.wire(collector, (136, row))
    sheet.to_sheet(net, (136, row), 0)
    tap = f"RN5.{unit + 1}"
    sheet.wire(tap, (sheet.point(tap)[0], row))


def _limits(sheet: Sheet) -> None:
    sheet.text("Limit switches, normally closed: open contact or broken wire = 1", (12, 24), 1.5)
    terminal(sheet, "J7", "LIMITS", 4, (14, 56), mirrored=True)
    sheet.wire("J7.1", (24, 54), (24, 50), (43, 50))
    sheet.wire("J7.3", (24, 58), (24, 84), (43, 84))
    sheet.wire("J7.2", (21, 56), (21, 60))
    sheet.wire("J7.4", (21, 60))
    ground(sheet, "MGND", (21, 60), 2)
    sheet.label("SW_X", (26, 50))
    sheet.label("SW_Z", (26, 84))
    _switch(
        sheet,
        "LIMIT_X",
        50,
        ("R41", "R42", "C21", "R43"),
        "22n",
        ("U9", 5, "11", "10"),
        1,
        ("1", "2", "16", "15"),
        "1k",
    )
    _switch(
        sheet,
        "LIMIT_Z",
        84,
        ("R44", "R45", "C22", "R46"),
        "22n",
        ("U8", 5, "11", "10"),
        2,
        ("3", "4", "14", "13"),
        "1k",
    )


def _index(sheet: Sheet) -> None:
    sheet.text("Spindle index: open-collector sensor, low = mark", (12, 100), 1.5)
    terminal(sheet, "J9", "INDEX", 3, (14, 116), mirrored=True)
    sheet.wire("J9.1", (24, 114), (24, 111))
    sheet.power("+5VM", (24, 111))
    sheet.wire("J9.2", (43, 116))
    sheet.wire("J9.3", (21, 118))
    ground(sheet, "MGND", (21, 118), 2)
    sheet.label("INDEX_IN", (24, 116))
    _switch(
        sheet,
        "SPINDLE_INDEX",
        116,
        ("R47", "R48", "C23", "R49"),
        "4n7",
        ("U8", 6, "13", "12"),
        4,
        ("7", "8", "10", "9"),
        "3k3",
    )


def _probe(sheet: Sheet) -> None:
    sheet.text(
        "Contact sensor: 66 kohm in series, so a live spindle frame at 230 V\n"
        "drives 3.5 mA at most",
        (12, 142),
        1.5,
    )
    terminal(sheet, "J8", "CONTACT", 2, (14, 160), mirrored=True)
    resistor(sheet, "R57", "33k 1W", (30, 160), across=True, footprint=fp.RESISTOR_1W)
    sheet.wire("J8.1", "R57.1")
    sheet.label("TOOL", (20, 160))
    resistor(sheet, "R58", "33k 1W", (30, 172), across=True, footprint=fp.RESISTOR_1W)
    sheet.wire("J8.2", (22, 162), (22, 172), "R58.1")
    sheet.label("FRAME", (22, 170), 90)
    sheet.wire("R58.2", (38, 172))
    ground(sheet, "MGND", (38, 172))
    sheet.place("Q5", "Transistor_BJT:2N3906", "2N3906", (74, 160), mirror="x", footprint=fp.TO92)
    sheet.wire("R57.2", "Q5.2")
    resistor(sheet, "R59", "47k", (44, 155))
    capacitor(sheet, "C24", "22n", (54, 155))
    diode(sheet, "D61", "1N4148", (64, 155), cathode="up", footprint=fp.DIODE_SIGNAL)
    for top, bottom in (("R59.1", "R59.2"), ("C24.1", "C24.2"), ("D61.1", "D61.2")):
        sheet.wire(top, (sheet.point(top)[0], 150))
        sheet.wire(bottom, (sheet.point(bottom)[0], 160))
    sheet.wire((44, 150), (76, 150), "Q5.1")
    supply(sheet, "+5VM", (76, 150), 1)
    resistor(sheet, "R60", "1k5", (90, 166), across=True)
    sheet.wire("Q5.3", (76, 166), "R60.1")
    _coupler(sheet, "PROBE", 166, "R60", 3, ("5", "6", "12", "11"))


def _output(
    sheet: Sheet,
    net: str,
    row: int,
    *,
    resistors: tuple[str, str, str],
    transistor: str,
    clamp: str,
    unit: int,
    pins: tuple[str, str, str, str],
) -> None:
    light, base, pull_down = resistors
    sheet.to_sheet(net, (180, row), 180)
    resistor(sheet, light, "470", (188, row), across=True)
    sheet.wire((180, row), f"{light}.1")
    sheet.place("U11", "Isolator:LTV-827", "LTV-827", (206, row + 2), unit=unit, footprint=fp.DIP8)
    anode, cathode, collector, emitter = (f"U11.{pin}" for pin in pins)
    sheet.wire(f"{light}.2", anode)
    sheet.wire(cathode, sheet.off(cathode, -3, 0))
    ground(sheet, "GND", sheet.off(cathode, -3, 0), 1)
    sheet.wire(collector, sheet.off(collector, 4, 0))
    supply(sheet, "+5VM", sheet.off(collector, 4, 0), 2)
    resistor(sheet, base, "1k", (224, row + 4), across=True)
    sheet.wire(emitter, f"{base}.1")
    sheet.place(transistor, "Transistor_BJT:BC337", "BC337-40", (246, row + 4), footprint=fp.TO92)
    sheet.wire(f"{base}.2", f"{transistor}.2")
    resistor(sheet, pull_down, "10k", (234, row + 9))
    sheet.wire(f"{pull_down}.1", (234, row + 4))
    ground(sheet, "MGND", f"{pull_down}.2", 1)
    ground(sheet, "MGND", f"{transistor}.3", 2)
    diode(sheet, clamp, "1N4007", (260, row - 8), cathode="up", footprint=fp.DIODE_1A)
    supply(sheet, "VMOT", f"{clamp}.1", 1)
    sheet.wire(f"{clamp}.2", (260, row - 2))
    sheet.wire(f"{transistor}.1", (248, row - 2), (270, row - 2))
    sheet.label(f"{net.partition('_')[0]}_OUT", (262, row - 2))


def _output_terminal(sheet: Sheet) -> None:
    sheet.text(
        "Outputs: low side, 0.5 A, for a relay coil or solid-state relay;\n"
        "fed from VMOT, so the emergency stop drops them too",
        (176, 22),
        1.5,
    )
    terminal(sheet, "J10", "OUTPUTS", 4, (296, 62))
    sheet.wire((270, 38), (282, 38), (282, 62), "J10.2")
    sheet.wire((270, 82), (282, 82), (282, 66), "J10.4")
    sheet.wire("J10.1", (286, 60))
    sheet.wire("J10.3", (286, 64))
    sheet.wire((286, 64), (286, 60))
    supply(sheet, "VMOT", (286, 60), 2)
