# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Copper laid by hand before the router: USB pair, crystal, windings, supply.

Points are mm from the board's top left corner, or pads ("J5.2"). The router
does not touch these tracks.
"""

from __future__ import annotations

from layout.placement import ROWS_X, ROWS_Z

Point = tuple[float, float] | str
Track = tuple[str, str, float, list[Point]]

USB_WIDTH = 0.3

TRACKS: list[Track] = [
    ("USB_DP", "F.Cu", USB_WIDTH, ["U1.24", (57.25, 90.63), "U2.6"]),
    ("USB_DM", "F.Cu", USB_WIDTH, ["U1.23", (57.8, 92.62), (57.8, 97.5), (59.15, 98.85), "U2.4"]),
    ("USB_P_IN", "F.Cu", USB_WIDTH, ["U2.1", (57.25, 118.5), "J1.3"]),
    ("USB_N_IN", "F.Cu", USB_WIDTH, ["U2.3", "J1.2"]),
    # supply: terminal, fuse, reverse-polarity transistor, emergency stop
    ("Net-(J2-Pin_1)", "F.Cu", 3.0, ["J2.1", (179.0, 16.5), (171.5, 9.0), "F2.1"]),
    ("SUPPLY_N", "B.Cu", 3.0, ["J2.2", (168.5, 11.42), (166.54, 13.38), (166.54, 14.6)]),
    ("SUPPLY_N", "B.Cu", 1.6, [(166.54, 14.6), "Q4.2"]),
    (
        "VFUSE",
        "F.Cu",
        3.0,
        [
            "F2.2",
            (146.8, 7.2),
            (144.0, 10.0),
            (144.0, 19.0),
            (146.0, 21.0),
            (172.0, 21.0),
            (178.8, 27.8),
            "J3.1",
        ],
    ),
    ("VFUSE", "F.Cu", 1.5, ["R9.1", (144.0, 14.0)]),
    ("VFUSE", "F.Cu", 1.5, ["C11.1", (144.0, 23.0), (146.0, 21.0)]),
    ("VFUSE", "F.Cu", 3.0, [(144.0, 16.0), (133.5, 16.0), "C10.1"]),
    ("MGND", "B.Cu", 1.8, ["Q4.3", (169.08, 19.8), (168.08, 20.8)]),
    (
        "MGND",
        "B.Cu",
        3.0,
        [(168.08, 20.8), (167.08, 21.8), (142.0, 21.8), (139.0, 18.8), (139.0, 14.0), "C10.2"],
    ),
    ("VMOT", "B.Cu", 3.0, ["J3.2", (176.3, 22.72), (175.0, 24.02), (175.0, 92.0)]),
]


def _motor(
    axis: str, rows: dict[int, float], diodes: int, clamp: str, terminal: str, transistors: int
) -> list[Track]:
    tracks: list[Track] = []
    for phase, y in rows.items():
        net, anode = f"{axis}_PH{phase}", f"D{diodes + phase}.2"
        drain = (142.54, y + 2.9)
        tracks.append(
            (net, "F.Cu", 1.6, [f"Q{transistors + phase}.2", drain, (148.94, y + 2.9), anode])
        )
        tracks.append(
            (
                net,
                "F.Cu",
                2.0,
                [
                    anode,
                    (154.84, y + 3.0),
                    (169.5, y + 3.0),
                    _entry(rows, phase, y),
                    f"{terminal}.{phase + 1}",
                ],
            )
        )
    tracks.append((f"CLAMP_{axis}", "B.Cu", 2.0, [f"D{diodes + phase}.1" for phase in rows]))
    tracks.append(
        (f"CLAMP_{axis}", "B.Cu", 2.0, [f"D{diodes + 3}.1", (163.0, rows[3] - 1.0), f"{clamp}.1"])
    )
    tracks.append(("VMOT", "B.Cu", 2.0, [f"{clamp}.2", (175.0, rows[4] + 22.24)]))
    tracks.append(("VMOT", "B.Cu", 3.0, [(175.0, rows[1] + 1.5), f"{terminal}.1"]))
    tracks.append(("VMOT", "B.Cu", 3.0, [(175.0, rows[4] + 0.1), f"{terminal}.6"]))
    return tracks


def _entry(rows: dict[int, float], phase: int, y: float) -> Point:
    """Return where a winding's track turns level with its terminal pin."""
    level = rows[1] + 1.5 - 5.08 * phase
    return (169.5 + abs(level - y - 3.0), level)


TRACKS += _motor("Z", ROWS_Z, 70, "D41", "J5", 10)
TRACKS += _motor("X", ROWS_X, 80, "D42", "J6", 20)
