# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Words on the board: names, connector pinouts, revision, licence.

Connectors are named with their use. Any other part's reference goes to the
first place near it where it lies on nothing else; words with a fixed place come first.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from layout.placement import HEIGHT, WIDTH

REVISION = "A"
DATE = "2026-11-20"
Box = tuple[float, float, float, float]

# Words, x, y (mm on the board, centre), size in mm, angle in degrees.
WORDS: list[tuple[str, float, float, float, float]] = [
    ("TORNILLO", 30.0, 19.0, 2.2, 0),
    (f"control board rev {REVISION}  {DATE}", 30.0, 22.4, 1.0, 0),
    ("CERN-OHL-P-2.0", 12.0, 25.0, 1.0, 0),
    ("LOGIC", 78.0, 27.5, 1.4, 0),
    ("MACHINE", 103.0, 31.2, 1.4, 0),
    ("isolation gap", 91.8, 59.0, 1.0, 0),
    ("keep clear", 91.8, 61.0, 1.0, 0),
    ("J2 SUPPLY 5-12V", 188.0, 14.6, 0.8, 90),
    ("+", 174.3, 16.5, 1.4, 0),
    ("-", 174.3, 11.4, 1.4, 0),
    ("J3 E-STOP", 188.0, 25.3, 1.0, 90),
    ("J5 MOTOR Z", 188.0, 46.8, 1.2, 90),
    ("J6 MOTOR X", 188.0, 80.8, 1.2, 90),
    ("J1 USB", 72.0, 132.0, 1.0, 0),
    ("J8 CONTACT", 106.5, 132.4, 0.9, 0),
    ("J9 INDEX", 121.0, 132.4, 0.9, 0),
    ("J7 LIMIT SWITCHES", 141.0, 132.4, 0.9, 0),
    ("J10 OUTPUTS", 163.6, 132.4, 0.9, 0),
    ("J12 LCD", 56.5, 5.0, 1.2, 0),
    ("J13 ICSP", 67.2, 39.6, 0.9, 0),
    ("J14 STEP/DIR", 7.8, 43.6, 1.0, 0),
    ("J11 PANEL", 7.8, 80.9, 1.0, 0),
    ("J15 SPARE", 8.6, 67.4, 0.9, 0),
    ("RUN", 17.2, 127.5, 1.0, 0),
    ("HOLD", 29.2, 127.5, 1.0, 0),
    ("STOP", 41.2, 127.5, 1.0, 0),
    ("RESET", 42.0, 36.0, 0.9, 0),
    ("T5A", 160.2, 7.2, 1.2, 0),
    ("CONTRAST", 24.5, 16.0, 0.9, 0),
    ("STATUS", 7.3, 32.6, 0.9, 0),
    ("MOTOR ON", 152.0, 23.6, 0.8, 0),
    ("SUPPLY ON", 125.0, 31.6, 0.8, 0),
    ("DRIVERS ON", 24.5, 37.0, 0.8, 0),
]
WORDS += [
    (f"{axis}{phase}", 85.3, top + 5.08 * (phase - 1), 0.8, 0)
    for axis, top in (("Z", 32.0), ("X", 66.0))
    for phase in (1, 2, 3, 4)
]
# Connector: words of its pins in order, offset from the pad in mm, size, angle.
PINOUTS: dict[str, tuple[list[str], float, float, float, float]] = {
    "J5": (["COM", "1", "2", "3", "4", "COM"], -7.4, 0.0, 0.9, 0),
    "J6": (["COM", "1", "2", "3", "4", "COM"], -7.4, 0.0, 0.9, 0),
    "J7": (["X", "GND", "Z", "GND"], 0.0, 6.7, 0.9, 0),
    "J8": (["TOOL", "FRAME"], 0.0, 6.7, 0.9, 0),
    "J9": (["5V", "IN", "GND"], 0.0, 6.7, 0.9, 0),
    "J10": (["V+", "SPDL", "V+", "COOL"], 0.0, 6.7, 0.9, 0),
    "J13": (["VPP", "5V", "GND", "PGD", "PGC", ""], 0.0, -3.3, 0.8, 90),
    "J15": (["RC1", "RE2", "5V", "GND"], 3.4, 0.0, 0.8, 0),
    "J12": (["1", *[""] * 14, "16"], 0.0, 2.4, 0.8, 0),
}


class Layer:
    """The silkscreen side that is being filled: what already lies on it."""

    def __init__(self, pcbnew: Any, board: Any, at: Callable[[float, float], Any]) -> None:
        """Take in all pads and drawings of the board."""
        self.pcbnew, self.board, self.at = pcbnew, board, at
        self.taken: list[Box] = []
        self.words: list[Box] = []
        for footprint in board.GetFootprints():
            for pad in footprint.Pads():
                self.taken.append(self.box(pad.GetBoundingBox(), 0.12))
            for item in footprint.GraphicalItems():
                if item.GetLayer() == pcbnew.F_SilkS:
                    self.taken += self.outline(item)

    def box(self, rectangle: Any, margin: float = 0.15) -> Box:
        """Return a rectangle of the board in mm, grown by margin."""
        mm = self.pcbnew.ToMM
        return (
            mm(rectangle.GetLeft()) - margin,
            mm(rectangle.GetTop()) - margin,
            mm(rectangle.GetRight()) + margin,
            mm(rectangle.GetBottom()) + margin,
        )

    def outline(self, item: Any) -> list[Box]:
        """Return boxes that cover a drawing: four edges where it is a frame."""
        left, top, right, bottom = self.box(item.GetBoundingBox())
        kind = item.GetShape() if hasattr(item, "GetShape") else None
        hollow = kind in (self.pcbnew.SHAPE_T_RECT, self.pcbnew.SHAPE_T_CIRCLE)
        if not hollow or item.GetFilledArea() if hasattr(item, "GetFilledArea") else not hollow:
            return [(left, top, right, bottom)]
        edge = 0.45 if kind == self.pcbnew.SHAPE_T_RECT else 0.17 * (right - left) + 0.3
        return [
            (left, top, left + edge, bottom),
            (right - edge, top, right, bottom),
            (left, top, right, top + edge),
            (left, bottom - edge, right, bottom),
        ]

    def free(self, box: Box) -> bool:
        """Tell whether nothing lies in box and it is on the board."""
        x0, y0 = self.pcbnew.ToMM(self.at(0, 0).x), self.pcbnew.ToMM(self.at(0, 0).y)
        x1, y1 = x0 + WIDTH, y0 + HEIGHT
        if box[0] < x0 + 0.4 or box[1] < y0 + 0.4 or box[2] > x1 - 0.4 or box[3] > y1 - 0.4:
            return False
        return not any(
            box[0] < other[2] and other[0] < box[2] and box[1] < other[3] and other[1] < box[3]
            for other in self.taken
        )

    def style(self, text: Any, size: float) -> None:
        """Give a text its size and stroke, readable from below."""
        text.SetTextSize(self.pcbnew.VECTOR2I_MM(size, size))
        text.SetTextThickness(self.pcbnew.FromMM(max(0.12, size * 0.15)))

    def word(self, words: str, position: Any, size: float, angle: float) -> None:
        """Write a word at a place that must be free; raises ValueError if not."""
        text = self.pcbnew.PCB_TEXT(self.board)
        text.SetText(words)
        text.SetLayer(self.pcbnew.F_SilkS)
        self.style(text, size)
        text.SetTextAngleDegrees(angle)
        text.SetPosition(position)
        box = self.box(text.GetBoundingBox(), 0.05)
        if not self.free(box):
            origin = self.at(0, 0)
            x = self.pcbnew.ToMM(position.x - origin.x)
            y = self.pcbnew.ToMM(position.y - origin.y)
            raise ValueError(f"no room on the silkscreen for {words!r} at {x:.1f}, {y:.1f}")
        self.board.Add(text)
        self.taken.append(box)
        self.words.append(box)

    def inside(self, footprint: Any) -> bool:
        """Put a part's reference in the middle of its body, if that is free."""
        left, top, right, bottom = self.box(footprint.GetBoundingBox(False), 0.0)
        return self.settle(footprint, [((left + right) / 2, (top + bottom) / 2)])

    def beside(self, footprint: Any) -> bool:
        """Put a part's reference at the first free place around it."""
        body = self.box(footprint.GetBoundingBox(False), 0.0)
        middle_x, middle_y = (body[0] + body[2]) / 2, (body[1] + body[3]) / 2
        spots = [(middle_x, body[1] - 0.8), (middle_x, body[3] + 0.8)]
        for across in (0.0, -1.5, 1.5, -3.0, 3.0, -5.0, 5.0, -7.0, 7.0):
            for away in (0.8, 1.3, 1.9):
                spots += [
                    (middle_x + across, body[1] - away),
                    (middle_x + across, body[3] + away),
                    (body[0] - away - 0.8, middle_y + across),
                    (body[2] + away + 0.8, middle_y + across),
                ]
        spots += [
            (middle_x + dx, middle_y + dy)
            for dx in (-4, -3, -2, -1, 0, 1, 2, 3, 4)
            for dy in (-4, -3, -2, -1, 0, 1, 2, 3, 4)
        ]
        return self.settle(footprint, spots)

    def settle(self, footprint: Any, spots: list[tuple[float, float]]) -> bool:
        """Put a reference at the first free spot; False if all are taken."""
        text = footprint.Reference()
        self.style(text, 0.8)
        text.SetKeepUpright(True)
        for angle in (0, 90):
            text.SetTextAngleDegrees(angle)
            for x, y in spots:
                text.SetPosition(self.pcbnew.VECTOR2I_MM(x, y))
                box = self.box(text.GetBoundingBox(), 0.05)
                if self.free(box):
                    self.taken.append(box)
                    self.words.append(box)
                    return True
        return False


def write(pcbnew: Any, board: Any, at: Callable[[float, float], Any]) -> list[Box]:
    """Write all words; return the boxes they fill, in mm of the board file.

    at turns mm on the board into board units. Raises ValueError when something
    has no room, naming it.
    """
    layer = Layer(pcbnew, board, at)
    problems = []
    fixed = [(words, at(x, y), size, angle) for words, x, y, size, angle in WORDS]
    for ref, (names, dx, dy, size, angle) in PINOUTS.items():
        footprint = board.FindFootprintByReference(ref)
        for number, name in enumerate(names, 1):
            spot = footprint.FindPadByNumber(str(number)).GetPosition()
            if name:
                fixed.append((name, spot + pcbnew.VECTOR2I_MM(dx, dy), size, angle))
        footprint.Reference().SetVisible(False)
    for ref in ("J1", "J2", "J3", "J11", "J14"):
        board.FindFootprintByReference(ref).Reference().SetVisible(False)
    for words, position, size, angle in fixed:
        try:
            layer.word(words, position, size, angle)
        except ValueError as error:
            problems.append(str(error))
    footprints = sorted(board.GetFootprints(), key=lambda part: part.GetReference())
    outside = [
        part for part in footprints if part.Reference().IsVisible() and not layer.inside(part)
    ]
    layer.taken += [layer.box(part.GetBoundingBox(False), -0.2) for part in footprints]
    problems += [
        f"no room on the silkscreen for {part.GetReference()}"
        for part in outside
        if not layer.beside(part)
    ]
    if problems:
        raise ValueError("\n".join(problems))
    return layer.words
