# SPDX-License-Identifier: Apache-2.0
"""Reads the wanted shape from a part file, without any code of the host program or firmware.

Lengths become steps by exact arithmetic; what a drawing leaves to be worked out (arcs, corners)
is worked out here. Keys that say how to cut and not what (``cut``, feeds) are not looked at.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

from .corners import Vertex, chain
from .shape import Arc, Line, Point, Segment
from .tool import RIGHT_HAND, Tool
from .wanted import (
    Cylinder,
    Face,
    Groove,
    Nominal,
    Operation,
    PartOff,
    Pause,
    Turned,
    WantedPart,
    nearest_step,
)

__all__ = [
    "Cylinder",
    "Face",
    "Groove",
    "Nominal",
    "Operation",
    "PartOff",
    "Pause",
    "Turned",
    "WantedPart",
    "read_part",
]

NM = {"mm": 1_000_000, "inch": 25_400_000}
#: ``order = "auto"``: these first, in this order, then the rest as written.
AUTOMATIC = ("face", "cylinder", "cone", "arc")
TIP = 3


@dataclass(frozen=True)
class _Reader:
    """Turns entries of the file into operations."""

    unit_nm: int
    step_x_nm: int
    step_z_nm: int
    tools: dict[str, Tool]

    # -- lengths ----------------------------------------------------------------------------------

    def z(self, value: Any) -> float:
        """Steps of Z of a length."""
        return float(Fraction(value) * self.unit_nm / self.step_z_nm)

    def x(self, diameter: Any) -> float:
        """Steps of radius of a diameter."""
        return float(Fraction(diameter) * self.unit_nm / self.step_x_nm / 2)

    def round_length(self, value: Any) -> float:
        """Steps of a length that counts in both directions, such as a radius.

        Raises:
            ValueError: the steps of X and Z differ, circles would not be round.
        """
        if self.step_x_nm != self.step_z_nm and value:
            raise ValueError("arcs are only modelled for equal steps of X and Z")
        return self.z(value)

    def point(self, entry: dict[str, Any]) -> Point:
        """A place: ``z`` and ``diameter``."""
        return Point(self.z(entry["z"]), self.x(entry["diameter"]))

    # -- operations -------------------------------------------------------------------------------

    def face(self, entry: dict[str, Any]) -> Face:
        """A flat end."""
        z, inner = self.z(entry["z"]), self.x(entry.get("diameter", 0))
        nominal = Nominal(inner, z)
        return Face(nearest_step(z), nearest_step(inner), nominal, _tool(entry))

    def cylinder(self, entry: dict[str, Any]) -> Cylinder:
        """A diameter from one z to another."""
        start, end = (self.z(z) for z in entry["z"])
        radius = self.x(entry["diameter"])
        return Cylinder(
            nearest_step(start),
            nearest_step(end),
            nearest_step(radius),
            Nominal(radius, self.z(entry["z"][0] - entry["z"][1]), start),
            _tool(entry),
        )

    def cone(self, entry: dict[str, Any]) -> Turned:
        """A straight line between two places."""
        return self._turned(entry, (Line(self.point(entry["start"]), self.point(entry["end"])),))

    def arc(self, entry: dict[str, Any]) -> Turned:
        """An arc between two places, given by its radius, its centre or a third point."""
        start, end = self.point(entry["start"]), self.point(entry["end"])
        if "radius" in entry:
            arc = Arc.of_radius(start, end, self.round_length(entry["radius"]))
        elif "center" in entry:
            self.round_length(1)
            arc = Arc.around(start, end, self.point(entry["center"]))
        else:
            self.round_length(1)
            arc = Arc.via(start, end, self.point(entry["via"]))
        return self._turned(entry, (arc,))

    def profile(self, entry: dict[str, Any]) -> Turned:
        """A chain of lines and arcs."""
        return self._turned(entry, chain([self._vertex(point) for point in entry["points"]]))

    def _vertex(self, entry: dict[str, Any]) -> Vertex:
        radius, centre = entry.get("radius"), entry.get("center")
        if centre is not None:
            self.round_length(1)
        return Vertex(
            self.point(entry),
            None if radius is None else self.round_length(radius),
            None if centre is None else self.point(centre),
            self.round_length(entry.get("corner", 0)),
            self.round_length(entry.get("chamfer", 0)),
        )

    def _turned(self, entry: dict[str, Any], segments: tuple[Segment, ...]) -> Turned:
        facing = entry.get("roughing") == "facing"
        return Turned(entry["type"], segments, _tool(entry), facing)

    def groove(self, entry: dict[str, Any]) -> Groove:
        """A groove with square walls."""
        start, end = (self.z(z) for z in entry["z"])
        return Groove(start, end, self.x(entry["diameter"]), _tool(entry))

    def part_off(self, entry: dict[str, Any]) -> PartOff:
        """The end of the part; behind it a slit as wide as the tool."""
        name = _tool(entry)
        tool = self.tools.get(name) if name else next(iter(self.tools.values()), None)
        if tool is None or tool.width <= 0:
            raise ValueError("part-off needs a tool with a width")
        z, radius = self.z(entry["z"]), self.x(entry.get("diameter", 0))
        return PartOff(z, radius, tool.width, name)

    def pause(self, entry: dict[str, Any]) -> Pause:
        """A stop, with what the operator is told."""
        return Pause(str(entry.get("message", "")), _tool(entry))


def _tool(entry: dict[str, Any]) -> str:
    return str(entry.get("tool", ""))


def _read_tools(entries: list[dict[str, Any]], reader: _Reader) -> dict[str, Tool]:
    tools = {}
    for entry in entries:
        if entry.get("orientation", TIP) != TIP:
            raise ValueError(f"tool {entry['name']!r}: only orientation {TIP} is modelled")
        offset = entry.get("offset", {})
        tools[entry["name"]] = Tool(
            name=entry["name"],
            hand=entry.get("hand", RIGHT_HAND.hand),
            front_clearance=float(entry.get("front_clearance", RIGHT_HAND.front_clearance)),
            back_clearance=float(entry.get("back_clearance", RIGHT_HAND.back_clearance)),
            nose=reader.round_length(entry.get("nose_radius", 0)),
            width=reader.z(entry.get("width", 0)),
            offset_x=reader.x(offset.get("diameter", 0)),
            offset_z=reader.z(offset.get("z", 0)),
        )
    return tools


def _order(entry: dict[str, Any]) -> int:
    kind = entry["type"]
    return AUTOMATIC.index(kind) if kind in AUTOMATIC else len(AUTOMATIC)


def read_part(path: Path | str, step_x_nm: int = 7112, step_z_nm: int = 7112) -> WantedPart:
    """Read a part file.

    Raises:
        ValueError: the file holds something this model does not know, or that cannot be made.
        KeyError: something needed is missing.
    """
    with Path(path).open("rb") as file:
        table = tomllib.load(file, parse_float=Decimal)
    if table["part"].get("path", "surface") == "tip":
        raise ValueError("a file of tool coordinates does not say what the part looks like")
    reader = _Reader(NM[table["part"]["units"]], step_x_nm, step_z_nm, {})
    reader.tools.update(_read_tools(table.get("tool", []), reader))
    kinds: dict[str, Callable[[dict[str, Any]], Operation]] = {
        "face": reader.face,
        "cylinder": reader.cylinder,
        "cone": reader.cone,
        "arc": reader.arc,
        "profile": reader.profile,
        "groove": reader.groove,
        "part-off": reader.part_off,
        "drill": reader.pause,
        "pause": reader.pause,
    }
    entries = table.get("operation", [])
    if table["part"].get("order", "written") == "auto":
        entries = sorted(entries, key=_order)
    operations: list[Operation] = []
    for entry in entries:
        if entry["type"] not in kinds:
            raise ValueError(f"operation {entry['type']!r} is not modelled here")
        operations.append(kinds[entry["type"]](entry))
    stock = table["stock"]
    return WantedPart(
        nearest_step(reader.x(stock["diameter"])),
        nearest_step(reader.z(stock["length"])),
        nearest_step(reader.z(stock.get("allowance", 0))),
        tuple(operations),
        reader.tools,
    )
