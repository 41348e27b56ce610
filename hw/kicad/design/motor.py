# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Sheet 4: eight winding drivers behind opto-couplers, four for each motor."""

from design import footprints as fp
from design.parts import capacitor, diode, ground, led, network, resistor, supply, terminal, zener
from design.sheet import Sheet

OPTO_PINS = (
    ("1", "2", "16", "15"),
    ("3", "4", "14", "13"),
    ("5", "6", "12", "11"),
    ("7", "8", "10", "9"),
)
GATE_PINS = (("1", "2"), ("3", "4"), ("5", "6"), ("9", "8"))
ROW = 16


def draw() -> Sheet:
    """Return the sheet."""
    sheet = Sheet(
        "motor",
        "Motor drive",
        "A3",
        4,
        "Opto-coupler, Schmitt gate, MOSFET, diode to a common clamp",
        "Two unipolar motors, eight windings,\nopto-coupler to MOSFET and clamp",
    )
    _axis(
        sheet,
        "Z",
        40,
        first=20,
        opto="U6",
        gate="U8",
        terminal_ref="J5",
        clamp="D41",
        networks=("RN1", "RN2"),
    )
    _axis(
        sheet,
        "X",
        138,
        first=30,
        opto="U7",
        gate="U9",
        terminal_ref="J6",
        clamp="D42",
        networks=("RN3", "RN4"),
    )
    _gate_supply(sheet)
    sheet.text(
        "D41, D42: the energy of a winding goes from its diode through the clamp\n"
        "into VMOT. 18 V was chosen by simulation (docs/board/spice.md).",
        (232, 104),
    )
    sheet.text(
        "Q11 to Q24: TIP120 fits the same pads (base, collector, emitter\n"
        "in place of gate, drain, source); the 470 ohm then feeds its base.",
        (232, 112),
    )
    sheet.text(
        "A coupler without light leaves its gate's input high, so the\n"
        "winding is off: broken wire, dead chip and reset are all safe.",
        (232, 120),
    )
    return sheet


def _axis(
    sheet: Sheet,
    axis: str,
    top: int,
    *,
    first: int,
    opto: str,
    gate: str,
    terminal_ref: str,
    clamp: str,
    networks: tuple[str, str],
) -> None:
    rows = [top + ROW * index for index in range(4)]
    sheet.text(f"Motor {axis}", (14, top - 14), 2.5)
    pull_up, pull_down = networks
    network(sheet, pull_up, "3k3", (84, top - 12))
    supply(sheet, "+5VM", f"{pull_up}.1", 1)
    network(sheet, pull_down, "10k", (134, rows[3] + 14), flipped=True)
    ground(sheet, "MGND", f"{pull_down}.1", 1)
    for index, row in enumerate(rows):
        _channel(sheet, axis, index, row, first + index + 1, opto, gate)
        sheet.wire(f"{pull_up}.{index + 2}", (80 + 2 * index, row))
        sheet.wire(f"{pull_down}.{index + 2}", (138 - 2 * index, row))
    sheet.wire((176, top - 11), (176, rows[3] - 8))
    zener(sheet, clamp, "1.5KE18A", (176, top - 14), "down", fp.DIODE_TVS_1500W)
    supply(sheet, "VMOT", f"{clamp}.2", 1)
    sheet.label(f"CLAMP_{axis}", (176, rows[3] - 10), 90)
    _terminal(sheet, axis, top, rows, terminal_ref)


def _channel(
    sheet: Sheet, axis: str, index: int, row: int, number: int, opto: str, gate: str
) -> None:
    phase = index + 1
    resistor(sheet, f"R{number}", "330", (34, row), across=True)
    led(sheet, f"D{number}", f"{axis}{phase}", (44, row), "right")
    sheet.to_sheet(f"COIL_{axis}{phase}", (28, row), 180)
    sheet.wire((28, row), f"R{number}.1")
    sheet.wire(f"R{number}.2", f"D{number}.2")
    sheet.place(opto, "Isolator:LTV-847", "LTV-847", (60, row + 2), unit=phase, footprint=fp.DIP16)
    anode, cathode, collector, emitter = (f"{opto}.{pin}" for pin in OPTO_PINS[index])
    sheet.wire(f"D{number}.1", anode)
    sheet.wire(cathode, sheet.off(cathode, -3, 0))
    ground(sheet, "GND", sheet.off(cathode, -3, 0), 1)
    sheet.wire(emitter, sheet.off(emitter, 3, 0))
    ground(sheet, "MGND", sheet.off(emitter, 3, 0), 1)
    sheet.place(
        gate,
        "74xx:74HC14",
        "74HC14",
        (106, row),
        unit=phase,
        footprint=fp.DIP14,
        ref_at=(-2.4, -3.2, "left"),
        value_at=(-2, 3.2, "left"),
    )
    sheet.wire(collector, f"{gate}.{GATE_PINS[index][0]}")
    sheet.label(f"{axis}{phase}_OFF", (90, row))
    resistor(sheet, f"R{number + 60}", "470", (122, row), across=True)
    sheet.wire(f"{gate}.{GATE_PINS[index][1]}", f"R{number + 60}.1")
    transistor = f"Q{(number // 10 - 1) * 10 + phase}"
    sheet.place(transistor, "Transistor_FET:IRLZ44N", "IRLZ44N", (150, row), footprint=fp.TO220)
    sheet.wire(f"R{number + 60}.2", f"{transistor}.1")
    sheet.label(f"GATE_{axis}{phase}", (139, row))
    ground(sheet, "MGND", f"{transistor}.3", 1)
    diode(
        sheet, f"D{number + 50}", "UF4004", (168, row - 8), cathode="right", footprint=fp.DIODE_1A
    )
    sheet.wire(f"{transistor}.2", (162, row - 4), (162, row - 8), f"D{number + 50}.2")
    sheet.wire(f"D{number + 50}.1", (176, row - 8))


def _terminal(sheet: Sheet, axis: str, top: int, rows: list[int], ref: str) -> None:
    terminal(sheet, ref, f"MOTOR {axis}", 6, (214, top + 20))
    bends = (200, 196, 196, 200)
    for index, row in enumerate(rows):
        pin = f"{ref}.{index + 2}"
        sheet.wire(
            (162, row - 4), (bends[index], row - 4), (bends[index], sheet.point(pin)[1]), pin
        )
        sheet.label(f"{axis}_PH{index + 1}", (180, row - 4))
    sheet.wire(f"{ref}.1", (206, top + 16))
    supply(sheet, "VMOT", (206, top + 16), 2)
    sheet.wire(f"{ref}.6", (206, top + 26), (206, top + 28))
    sheet.power("VMOT", (206, top + 28), 180)


def _gate_supply(sheet: Sheet) -> None:
    sheet.frame((230, 20), (316, 62))
    sheet.text("Supply of the Schmitt gates", (232, 24), 1.5)
    for index, (gate, cap) in enumerate((("U8", "C18"), ("U9", "C19"))):
        x = 246 + 40 * index
        sheet.place(
            gate,
            "74xx:74HC14",
            "74HC14",
            (x, 42),
            unit=7,
            footprint=fp.DIP14,
            ref_at=(-8, -1, "left"),
            value_at=(-11, 1, "left"),
        )
        supply(sheet, "+5VM", f"{gate}.14", 2)
        ground(sheet, "MGND", f"{gate}.7", 2)
        capacitor(sheet, cap, "100n", (x + 14, 42))
        sheet.wire(f"{cap}.1", (x + 14, 31), (x, 31))
        sheet.wire(f"{cap}.2", (x + 14, 53), (x, 53))
    sheet.place(
        "U9",
        "74xx:74HC14",
        "74HC14",
        (262, 80),
        unit=6,
        footprint=fp.DIP14,
        ref_at=(-2.4, -3.2, "left"),
        value_at=(-2, 3.2, "left"),
    )
    sheet.wire("U9.13", (250, 80))
    ground(sheet, "MGND", (250, 80))
    sheet.nc("U9.12")
    sheet.text("spare gate", (258, 74))
