# SPDX-License-Identifier: Apache-2.0
"""The operations of a part file: what each type says, as exact geometry in file units."""

from collections.abc import Callable
from dataclasses import dataclass

from tornillo.contour import Element, Line, Point
from tornillo.cutting import Cut, read_overrides
from tornillo.language import _
from tornillo.profiles import read_arc, read_points
from tornillo.protocol import MESSAGE_MAX
from tornillo.toml_source import Source, Table
from tornillo.tools import Tool, named

ROUGHING = ("shortest", "along", "facing")


@dataclass(frozen=True)
class Contour:
    """A chain from the free end towards the chuck; `keys` name its start and its end."""

    elements: tuple[Element, ...]
    keys: tuple[str, str] = ("points", "points")


@dataclass(frozen=True)
class Plunge:
    """A groove from `front` to `back`, or the back face of a part at `back`."""

    front: float
    back: float
    diameter: float


@dataclass(frozen=True)
class Pause:
    """What the operator is told."""

    message: str


Shape = Contour | Plunge | Pause


@dataclass(frozen=True)
class Operation:
    """One operation; `position` is its number in the file, from 0."""

    type: str
    shape: Shape
    tool: Tool
    cut: Cut
    roughing: str
    position: int

    @property
    def title(self) -> str:
        """Number and type for messages."""
        return _("operation {position} ({type})").format(position=self.position + 1, type=self.type)


@dataclass(frozen=True)
class Context:
    """What an operation is read with: `tip` when the file holds paths of the tool's tip."""

    units: str
    stock_radius: float
    tip: bool
    tools: tuple[Tool, ...]
    cut: Cut


def _contour_type(
    read: Callable[[Table, Context], Shape],
) -> Callable[[Table, Context], Shape]:
    """A type whose contour a file of tip paths may also give by its points."""

    def either(table: Table, context: Context) -> Shape:
        if context.tip and table.has("points"):
            return Contour(read_points(table, context.tip))
        return read(table, context)

    return either


@_contour_type
def _read_face(table: Table, context: Context) -> Shape:
    """Cut flat at z, down to a diameter."""
    z = table.number("z")
    inner = table.number("diameter", 0.0) / 2
    if inner >= context.stock_radius:
        table.refuse(
            "diameter",
            _("{title}: the operation has nothing to cut: the stock is not larger").format(
                title=table.title
            ),
            _("make the cut smaller than the stock"),
        )
    line = Line(Point(z, inner), Point(z, context.stock_radius))
    return Contour((line,), ("diameter", "z"))


@_contour_type
def _read_cylinder(table: Table, context: Context) -> Shape:
    """Turn to a diameter from z to z."""
    start, end = table.pair("z")
    radius = table.number("diameter") / 2
    _in_order(table, "z", start, end, _("[free end, end towards the chuck]"))
    return Contour((Line(Point(start, radius), Point(end, radius)),), ("diameter", "z"))


@_contour_type
def _read_cone(table: Table, context: Context) -> Shape:
    """Turn from one diameter to another."""
    start, end = table.point("start"), table.point("end")
    _in_order(table, "end", start.z, end.z, _("the start at the free end"))
    return Contour((Line(start, end),), ("start", "end"))


@_contour_type
def _read_arc(table: Table, context: Context) -> Shape:
    """Turn along an arc."""
    start, end = table.point("start"), table.point("end")
    _in_order(table, "end", start.z, end.z, _("the start at the free end"))
    arc = read_arc(table, start, end, exact=context.tip)
    if isinstance(arc, Line):
        table.refuse(
            "",
            _("{title}: radius is missing").format(title=table.title),
            _("add a line like radius = 5.0, above 0 convex, below 0 concave; or center, or via"),
        )
    return Contour((arc,), ("start", "end"))


def _read_profile(table: Table, context: Context) -> Shape:
    """Turn along a chain."""
    return Contour(read_points(table, context.tip))


def _read_groove(table: Table, context: Context) -> Shape:
    """Plunge to a diameter between two walls."""
    front, back = table.pair("z")
    if front < back:
        _in_order(table, "z", front, back, _("[free end, end towards the chuck]"))
    return Plunge(front, back, table.number("diameter"))


def _read_part_off(table: Table, context: Context) -> Shape:
    """Plunge behind the part; `z` is its back face."""
    z = table.number("z")
    return Plunge(z, z, table.number("diameter", 0.0))


def _read_drill(table: Table, context: Context) -> Shape:
    """A pause that tells what to drill."""
    said = table.text("message", default="")
    if context.tip and not table.has("diameter"):
        return Pause(_message(table, said))
    diameter, depth = table.positive("diameter"), table.positive("depth")
    text = f"drill {diameter:g} x {depth:g} {context.units}"
    return Pause(_message(table, f"{text}: {said}" if said else text))


def _read_pause(table: Table, context: Context) -> Shape:
    """A pause with a message."""
    return Pause(_message(table, table.text("message")))


READERS: dict[str, Callable[[Table, Context], Shape]] = {
    "face": _read_face,
    "cylinder": _read_cylinder,
    "cone": _read_cone,
    "arc": _read_arc,
    "profile": _read_profile,
    "groove": _read_groove,
    "part-off": _read_part_off,
    "drill": _read_drill,
    "pause": _read_pause,
}
PAUSES = ("drill", "pause")
#: The order of cutting when the file says order = "auto"; what is not named stays behind.
AUTO_ORDER = ("face", "cylinder", "cone", "arc")


def read_operation(source: Source, position: int, entry: object, context: Context) -> Operation:
    """One operation of any type; raises PartError."""
    table = Table(
        source,
        ("operation", position),
        entry,
        _("operation {position}").format(position=position + 1),
    )
    kind = table.text("type", tuple(READERS))
    table.title = _("operation {position} ({kind})").format(position=position + 1, kind=kind)
    tool, cut, roughing = context.tools[0], context.cut, ROUGHING[0]
    if kind not in PAUSES:
        if table.has("tool"):
            tool = named(context.tools, table.text("tool"), table)
        cut = read_overrides(table, context.cut)
        roughing = table.text("roughing", ROUGHING, default=ROUGHING[0])
    shape = READERS[kind](table, context)
    table.finish()
    return Operation(kind, shape, tool, cut, roughing, position)


def in_auto_order(operations: tuple[Operation, ...]) -> tuple[Operation, ...]:
    """Faces, cylinders, cones, arcs, then the others; each kind as written."""

    def rank(operation: Operation) -> int:
        return AUTO_ORDER.index(operation.type) if operation.type in AUTO_ORDER else len(AUTO_ORDER)

    return tuple(sorted(operations, key=rank))


def _in_order(table: Table, key: str, start: float, end: float, how: str) -> None:
    """Refuse a cut that does not lead towards the chuck."""
    if start <= end:
        table.refuse(
            key,
            _("{title}: the operation has nothing to cut: from z = {start:g} to {end:g}").format(
                title=table.title, start=start, end=end
            ),
            _("write {how}; towards the chuck z gets smaller").format(how=how),
        )


def _message(table: Table, text: str) -> str:
    """A text that the chip can keep."""
    if not text.isascii() or not text.isprintable():
        table.refuse(
            "message",
            _("{title}: the message has characters that the lathe does not know").format(
                title=table.title
            ),
            _("use ASCII letters, digits and signs"),
        )
    if len(text) > MESSAGE_MAX:
        table.refuse(
            "message",
            _('{title}: the message "{text}" has {text2} characters').format(
                title=table.title, text=text, text2=len(text)
            ),
            _(
                "use at most {message_max}, those about diameter and depth of a drill included"
            ).format(message_max=MESSAGE_MAX),
        )
    return text
