# SPDX-License-Identifier: Apache-2.0
"""A part that grows answer by answer: what has been said so far, as the text of a part file.

`tornillo new` asks; this keeps, writes and judges. Lengths are in the units of the part.
"""

import math
from dataclasses import dataclass, field

from tornillo.contour import Point
from tornillo.errors import TornilloError
from tornillo.machine import Machine
from tornillo.part import Part

Value = float | str | tuple[float, float] | dict[str, float] | list[dict[str, float]]
#: Something that is there so that stock alone can be read and drawn: a face in the air.
NOTHING_YET = '[[operation]]\ntype = "pause"\nmessage = "-"\n'
PLUNGING = ("groove", "part-off")
GROOVING_TOOL = "grooving"


@dataclass
class Draft:
    """Title, stock, cutting data, tools and operations as they are answered."""

    title: dict[str, Value] = field(default_factory=dict)
    stock: dict[str, Value] = field(default_factory=dict)
    cut: dict[str, Value] = field(default_factory=dict)
    tools: list[dict[str, Value]] = field(default_factory=list)
    operations: list[dict[str, Value]] = field(default_factory=list)

    @property
    def units(self) -> str:
        """The unit of all lengths."""
        return str(self.title["units"])

    def text(self) -> str:
        """The part file."""
        blocks = [
            _table("[part]", self.title),
            _table("[stock]", self.stock),
            _table("[cut]", self.cut),
            *(_table("[[tool]]", tool) for tool in self.tools if self._used(tool)),
            *(_table("[[operation]]", operation) for operation in self.operations),
        ]
        return "\n".join(blocks)

    def _used(self, tool: dict[str, Value]) -> bool:
        """Whether a tool is the first, or an operation names it."""
        named = {operation.get("tool") for operation in self.operations}
        return tool is self.tools[0] or tool["name"] in named

    def drawn(self) -> Part:
        """The part as far as it is known, for its picture; raises PartError."""
        text = self.text() if self.operations else f"{self.text()}\n{NOTHING_YET}"
        return Part.parse(text, "the new part")

    def problem(self, machine: Machine) -> TornilloError | None:
        """The first reason why the part cannot be made like this; None when it can."""
        try:
            self.drawn().check(machine)
        except TornilloError as error:
            return error
        return None


def _table(head: str, values: dict[str, Value]) -> str:
    """One table of the file."""
    return "".join([f"{head}\n", *(f"{key} = {_toml(value)}\n" for key, value in values.items())])


def _toml(value: Value) -> str:
    """A value as TOML writes it."""
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return f'"{escaped}"'
    if isinstance(value, tuple):
        return f"[{', '.join(map(_toml, value))}]"
    if isinstance(value, list):
        rows = "".join(f"  {_toml(point)},\n" for point in value)
        return f"[\n{rows}]"
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {_toml(entry)}' for key, entry in value.items())} }}"
    return repr(value) if isinstance(value, int) else f"{float(f'{value:.6g}')!r}"


def marks(operation: dict[str, Value]) -> list[Point]:
    """The places that a half-told operation has named; without a diameter a line across."""
    found: list[Point] = []
    for value in operation.values():
        if isinstance(value, tuple):
            found += [Point(z, math.nan) for z in value]
        elif isinstance(value, dict) and "z" in value:
            found.append(_place(value))
        elif isinstance(value, list):
            found += map(_place, value)
    z = operation.get("z")
    if isinstance(z, float | int):
        found.append(Point(float(z), math.nan))
    return found


def _place(value: dict[str, float]) -> Point:
    """A place of the file."""
    return Point(value["z"], value.get("diameter", math.nan) / 2)
