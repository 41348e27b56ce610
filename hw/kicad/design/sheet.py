# SPDX-License-Identifier: CERN-OHL-P-2.0
"""One schematic sheet: parts, wires and labels placed by script.

Positions are counted in steps of 1.27 mm from the top left corner of the
paper, y downwards. A pin is named "R1.2"; a wire is a row of pins and points
and turns a corner (across first, then down) where two of them are not in
line. All identifiers are derived from names, so equal input gives equal files.
"""

from __future__ import annotations

import copy
import uuid
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from design import library
from design.sexpr import Atom, atom, children

STEP = 1.27
SPACE = uuid.UUID("6a3f3b0e-6f0e-5d0a-9d0b-4f4d8f5d7a10")
ROOT_UUID = str(uuid.uuid5(SPACE, "root"))
Point = tuple[int, int]
Box = tuple[float, float, float, float]


def name_uuid(*names: object) -> str:
    """Return an identifier that depends on the names alone."""
    return str(uuid.uuid5(SPACE, "/".join(str(name) for name in names)))


@dataclass
class Part:
    """A placed unit of a symbol."""

    ref: str
    symbol: library.Symbol
    value: str
    at: Point
    rot: int
    mirror: str
    unit: int
    footprint: str
    fields: dict[str, str]
    ref_at: tuple[float, float, str] | None
    value_at: tuple[float, float, str] | None
    on_board: bool = True

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Return the sheet position, in steps, of a library point in mm."""
        px, py = x / STEP, -y / STEP
        for _ in range(self.rot // 90):
            px, py = py, -px
        if self.mirror == "x":
            py = -py
        if self.mirror == "y":
            px = -px
        return self.at[0] + px, self.at[1] + py

    def pin(self, number: str) -> Point:
        """Return where the pin's wire starts; raises KeyError for no such pin."""
        for pin in self.symbol.pins:
            if pin.number == number and pin.unit in (0, self.unit):
                x, y = self.place(pin.x, pin.y)
                return round(x), round(y)
        raise KeyError(f"{self.ref} has no pin {number} in unit {self.unit}")

    def body(self) -> Box:
        """Return the box of the drawn body, in steps."""
        corners = [
            self.place(box[i], box[j])
            for unit, box in self.symbol.boxes.items()
            if unit in (0, self.unit)
            for i, j in ((0, 1), (2, 3))
        ]
        xs, ys = [c[0] for c in corners], [c[1] for c in corners]
        if not xs:
            return (self.at[0], self.at[1], self.at[0], self.at[1])
        return min(xs), min(ys), max(xs), max(ys)


@dataclass
class Sheet:
    """A sheet being drawn; write.py turns it into a file."""

    name: str
    title: str
    paper: str
    page: int
    comment: str
    summary: str
    parts: list[Part] = field(default_factory=list)
    segments: list[tuple[Point, Point]] = field(default_factory=list)
    labels: list[tuple[str, str, Point, int, str]] = field(default_factory=list)
    no_connects: list[Point] = field(default_factory=list)
    texts: list[tuple[str, Point, float]] = field(default_factory=list)
    frames: list[tuple[Point, Point]] = field(default_factory=list)
    _power_count: int = 0

    @property
    def uuid(self) -> str:
        """Identifier of the sheet symbol on the root sheet."""
        return name_uuid("sheet", self.name)

    def place(
        self,
        ref: str,
        lib_id: str,
        value: str,
        at: Point,
        *,
        rot: int = 0,
        mirror: str = "",
        unit: int = 1,
        footprint: str = "",
        ref_at: tuple[float, float, str] | None = None,
        value_at: tuple[float, float, str] | None = None,
        **fields: str,
    ) -> Part:
        """Place a part.

        ref_at and value_at move its texts: dx, dy in steps from its centre,
        and left, right or center.
        """
        part = Part(
            ref,
            library.load(lib_id),
            value,
            at,
            rot,
            mirror,
            unit,
            footprint,
            fields,
            ref_at,
            value_at,
        )
        self.parts.append(part)
        return part

    def power(self, net: str, at: Point | str, rot: int = 0) -> None:
        """Place a power symbol of the net; rot 180 turns it upside down."""
        self._power_count += 1
        symbols = {
            "GND": "power:GND",
            "+5V": "power:+5V",
            "VBUS": "power:VBUS",
            "PWR_FLAG": "power:PWR_FLAG",
        }
        lib_id = symbols.get(net, f"tornillo:{net}")
        ref = f"#{'FLG' if net == 'PWR_FLAG' else 'PWR'}{self.page}{self._power_count:02d}"
        self.parts.append(
            Part(
                ref,
                library.load(lib_id),
                net,
                self.point(at),
                rot,
                "",
                1,
                "",
                {},
                None,
                None,
                False,
            )
        )

    def point(self, where: Point | str) -> Point:
        """Return a position: a point as it is, or the place of a pin."""
        if not isinstance(where, str):
            return where
        ref, number = where.rsplit(".", 1)
        for part in self.parts:
            if part.ref == ref:
                try:
                    return part.pin(number)
                except KeyError:
                    continue
        raise KeyError(f"sheet {self.name} has no pin {where}")

    def off(self, where: Point | str, dx: int, dy: int) -> Point:
        """Return the point dx, dy steps away from a pin or point."""
        x, y = self.point(where)
        return x + dx, y + dy

    def wire(self, *stops: Point | str) -> None:
        """Draw a wire through pins and points."""
        points = [self.point(stop) for stop in stops]
        for start, end in pairwise(points):
            corner = (end[0], start[1])
            for a, b in ((start, corner), (corner, end)):
                if a != b:
                    self.segments.append((a, b))

    def label(self, net: str, at: Point | str, rot: int = 0) -> None:
        """Name a wire on this sheet; rot 0 reads to the right of at, 180 to its left."""
        self.labels.append(("label", net, self.point(at), rot, ""))

    def to_sheet(self, net: str, at: Point | str, rot: int = 0, shape: str = "passive") -> None:
        """Put a global label: the net goes on under this name on other sheets."""
        self.labels.append(("global_label", net, self.point(at), rot, shape))

    def stub(self, net: str, pin: str, dx: int, shape: str = "passive") -> None:
        """Lead a pin out by dx steps and end in a global label."""
        end = self.off(pin, dx, 0)
        self.wire(pin, end)
        self.to_sheet(net, end, 0 if dx > 0 else 180, shape)

    def nc(self, *pins: str) -> None:
        """Mark pins as left open on purpose."""
        self.no_connects += [self.point(pin) for pin in pins]

    def text(self, words: str, at: Point, size: float = 1.27) -> None:
        """Write a note; at is its left end, size in mm."""
        self.texts.append((words, at, size))

    def frame(self, corner: Point, opposite: Point) -> None:
        """Draw a dashed frame around a group of parts."""
        self.frames.append((corner, opposite))


def split_wires(sheet: Sheet) -> tuple[list[tuple[Point, Point]], list[Point]]:
    """Cut wires where others end on them; return the pieces and the junctions."""
    pins = [
        part.pin(pin.number)
        for part in sheet.parts
        for pin in part.symbol.pins
        if pin.unit in (0, part.unit)
    ]
    ends = {p for segment in sheet.segments for p in segment} | set(pins)
    pieces: set[tuple[Point, Point]] = set()
    for a, b in sheet.segments:
        inside = sorted(p for p in ends | {a, b} if _on(p, a, b))
        pieces |= set(pairwise(inside))
    meet: dict[Point, int] = {}
    for p in [p for piece in pieces for p in piece] + pins:
        meet[p] = meet.get(p, 0) + 1
    wired = {p for piece in pieces for p in piece}
    return sorted(pieces), sorted(p for p, n in meet.items() if n > 2 and p in wired)


def _on(p: Point, a: Point, b: Point) -> bool:
    cross = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
    return (
        cross == 0
        and min(a[0], b[0]) <= p[0] <= max(a[0], b[0])
        and min(a[1], b[1]) <= p[1] <= max(a[1], b[1])
    )


def text_places(part: Part) -> list[tuple[str, str, float, float, str]]:
    """Return (field, text, x, y, justify) of a part's visible texts, in steps."""
    if part.ref.startswith("#"):
        return _power_text(part)
    left, top, right, bottom = part.body()
    x, y = part.at
    pins = [pin for pin in part.symbol.pins if pin.unit in (0, part.unit)]
    tall = bottom - top > right - left
    if len(pins) == 3 and part.rot == 0:
        tall = True
    elif len(pins) == 2:
        tall = part.pin(pins[0].number)[0] == part.pin(pins[1].number)[0]
    if len(pins) <= 3 and tall:
        ref = (right + 0.8 - x, (top + bottom) / 2 - y - 1, "left")
        value = (right + 0.8 - x, (top + bottom) / 2 - y + 1, "left")
    elif len(pins) <= 3:
        ref = ((left + right) / 2 - x, top - y - 1.2, "center")
        value = ((left + right) / 2 - x, bottom - y + 1.2, "center")
    else:
        ref = (left - x, top - y - 1.2, "left")
        value = (left - x, bottom - y + 1.2, "left")
    ref, value = part.ref_at or ref, part.value_at or value
    return [
        ("Reference", part.ref, x + ref[0], y + ref[1], ref[2]),
        ("Value", part.value, x + value[0], y + value[1], value[2]),
    ]


def _power_text(part: Part) -> list[tuple[str, str, float, float, str]]:
    x, y = part.at
    down = part.value in ("GND", "MGND")
    sign = 1 if down else -1
    if part.rot == 180:
        sign = -sign
    if part.rot in (90, 270):
        side = -1 if (part.rot == 90) != down else 1
        return [("Value", part.value, x + 3.2 * side, y, "left" if side > 0 else "right")]
    return [("Value", part.value, x, y + (3.6 if down else 3.0) * sign, "center")]


def embedded(symbol: library.Symbol) -> list[Any]:
    """Return the symbol's node for a sheet's lib_symbols."""
    return copy.deepcopy(symbol.node)


def effects(size: float = 1.27, justify: Iterable[str] = (), hide: bool = False) -> list[Any]:
    """Return the (effects ...) of a text."""
    node: list[Any] = [Atom("effects"), [Atom("font"), [Atom("size"), atom(size), atom(size)]]]
    words = [Atom(word) for word in justify if word != "center"]
    if words:
        node.append([Atom("justify"), *words])
    if hide:
        node.append([Atom("hide"), Atom("yes")])
    return node


def has_pins(node: list[Any]) -> bool:
    """Tell whether a symbol node draws any pin."""
    return any(children(unit, "pin") for unit in children(node, "symbol"))
