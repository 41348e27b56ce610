# SPDX-License-Identifier: Apache-2.0
"""Part files: what a person writes, checked and turned into a part image.

part = Part.load("test-bar.toml")
part.check(Machine.load())          # raises PartError with file, line and remedy
data = part.image(Machine.load())   # the bytes for the chip
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

from tornillo.errors import PartError
from tornillo.image import Operation, PartImage
from tornillo.machine import Machine
from tornillo.protocol import (
    IMAGE_FORMAT,
    NAME_LENGTH,
    CylinderRecord,
    FaceRecord,
    ImageHeader,
    Refusal,
)
from tornillo.protocol_texts import REFUSAL_TEXTS
from tornillo.rules import NAME, Violation, check
from tornillo.toml_source import Place, Source, Table
from tornillo.units import NM_PER_UNIT, Scale

BYTE_MAX = 255
LENGTH_MAX = 1e6


@dataclass(frozen=True)
class Stock:
    """Raw material in file units.

    `length` is free in front of the chuck, counted from the finished face; `allowance` is raw
    material in front of that face.
    """

    diameter: float
    length: float
    allowance: float


@dataclass(frozen=True)
class Cut:
    """Cutting data in file units, feeds per minute."""

    depth_of_cut: float
    finish_allowance: float
    feed: float
    finish_feed: float
    retract: float


@dataclass(frozen=True)
class Face:
    """Cut the end of the part flat at `z`, down to `diameter`."""

    z: float
    diameter: float
    type: ClassVar[str] = "face"

    @classmethod
    def read(cls, table: Table) -> "Face":
        """Take the keys of this type."""
        return cls(table.number("z"), table.number("diameter", default=0.0))

    def record(self, scale: Scale) -> Operation:
        """The operation in steps."""
        return FaceRecord(scale.z_steps(self.z), scale.radius_steps(self.diameter))


@dataclass(frozen=True)
class Cylinder:
    """Turn to `diameter` from `z_start` towards the chuck to `z_end`."""

    z_start: float
    z_end: float
    diameter: float
    type: ClassVar[str] = "cylinder"

    @classmethod
    def read(cls, table: Table) -> "Cylinder":
        """Take the keys of this type."""
        return cls(*table.pair("z"), table.number("diameter"))

    def record(self, scale: Scale) -> Operation:
        """The operation in steps."""
        return CylinderRecord(
            scale.z_steps(self.z_start),
            scale.z_steps(self.z_end),
            scale.radius_steps(self.diameter),
        )


AnyOperation = Face | Cylinder
OPERATION_CLASSES: dict[str, type[Face] | type[Cylinder]] = {
    kind.type: kind for kind in (Face, Cylinder)
}


@dataclass(frozen=True)
class Part:
    """One part file."""

    name: str
    units: str
    stock: Stock
    cut: Cut
    operations: tuple[AnyOperation, ...]
    source: Source = field(repr=False, compare=False)

    @classmethod
    def load(cls, path: str | Path) -> "Part":
        """Read a part file.

        Raises PartError when it cannot be read or understood.
        """
        try:
            text = Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
            raise PartError(
                f"{path}: the file cannot be read: {reason}", "check its name and place"
            ) from error
        return cls.parse(text, str(path))

    @classmethod
    def parse(cls, text: str, name: str = "part.toml") -> "Part":
        """Read the text of a part file; messages call it `name`.

        Raises PartError when it cannot be understood.
        """
        source = Source(name, text)
        top = Table(source, (), source.values, "the file")
        title, units = _read_title(top.table("part"))
        stock = _read_stock(top.table("stock"))
        cut = _read_cut(top.table("cut"))
        entries = top.tables("operation")
        top.finish()
        operations = tuple(
            _read_operation(source, position, entry) for position, entry in enumerate(entries)
        )
        return cls(title, units, stock, cut, operations, source)

    def steps(self, machine: Machine) -> PartImage:
        """The part in steps of `machine`, rounded, not checked."""
        scale = Scale(self.units, machine)
        header = ImageHeader(
            format=IMAGE_FORMAT,
            operation_count=min(len(self.operations), BYTE_MAX),
            flags=0,
            reserved=0,
            name=self.name.encode("ascii").ljust(NAME_LENGTH, b"\0"),
            step_x_nm=machine.step_x_nm,
            step_z_nm=machine.step_z_nm,
            stock_radius=scale.radius_steps(self.stock.diameter),
            stock_length=scale.z_steps(self.stock.length),
            stock_front=scale.z_steps(self.stock.allowance),
            depth_of_cut=scale.x_steps(self.cut.depth_of_cut),
            finish_allowance=scale.x_steps(self.cut.finish_allowance),
            feed=scale.feed(self.cut.feed),
            finish_feed=scale.feed(self.cut.finish_feed),
            retract=scale.x_steps(self.cut.retract),
            reserved_end=0,
        )
        return PartImage(header, tuple(op.record(scale) for op in self.operations))

    def problems(self, machine: Machine) -> Iterator[PartError]:
        """Everything that `machine` would refuse, the chip's answer first."""
        for violation in check(self.steps(machine), Scale(self.units, machine)):
            yield self._explain(violation)

    def check(self, machine: Machine) -> None:
        """Raise PartError for the first thing that `machine` would refuse."""
        for problem in self.problems(machine):
            raise problem

    def image(self, machine: Machine) -> bytes:
        """The bytes that the chip of `machine` stores.

        Raises PartError when the machine would refuse them.
        """
        self.check(machine)
        return self.steps(machine).pack()

    def describe(self, position: int) -> str:
        """Number and type of an operation, counted from 1."""
        return f"operation {position} ({self.operations[position - 1].type})"

    def _explain(self, violation: Violation) -> PartError:
        """A broken rule in words, with the line to correct."""
        text = REFUSAL_TEXTS[violation.refusal]
        place: Place = tuple(violation.key.split("."))
        what = ""
        if violation.operation:
            place = ("operation", violation.operation - 1, violation.key)
            what = f"{self.describe(violation.operation)}: "
        remedy = text.remedy
        if violation.refusal is Refusal.EMPTY_CUT and violation.key == "z":
            remedy = _empty_cut_remedy(self.operations[violation.operation - 1])
        return self.source.error(place, f"{what}{text.cause}: {violation.detail}", remedy)


def _empty_cut_remedy(operation: AnyOperation) -> str:
    """What to do about an operation that has nothing to cut along z."""
    if isinstance(operation, Face):
        return "give the raw material in front of the face as `allowance` in [stock]"
    return "write z as [free end, end towards the chuck]; towards the chuck z gets smaller"


def _read_title(table: Table) -> tuple[str, str]:
    """Name and units."""
    name = table.text("name")
    if not NAME.fullmatch(name.encode("utf-8")) or "\0" in name:
        remedy = REFUSAL_TEXTS[Refusal.NAME].remedy
        table.refuse("name", f'{table.title}: the name "{name}" cannot be used', remedy)
    units = table.text("units", tuple(NM_PER_UNIT))
    table.finish()
    return name, units


def _positive(table: Table, key: str, default: float | None = None) -> float:
    """A number above 0 (or equal to its default)."""
    value = table.number(key, default)
    if value != default and not 0 < value < LENGTH_MAX:
        table.refuse(key, f"{table.title}: {key} cannot be {value:g}", "give a number above 0")
    return value


def _read_stock(table: Table) -> Stock:
    """The raw material."""
    stock = Stock(
        diameter=_positive(table, "diameter"),
        length=_positive(table, "length"),
        allowance=_positive(table, "allowance", default=0.0),
    )
    table.finish()
    return stock


def _read_cut(table: Table) -> Cut:
    """The cutting data."""
    depth = _positive(table, "depth_of_cut")
    feed = _positive(table, "feed")
    cut = Cut(
        depth_of_cut=depth,
        finish_allowance=_positive(table, "finish_allowance", default=0.0),
        feed=feed,
        finish_feed=_positive(table, "finish_feed", default=feed),
        retract=_positive(table, "retract"),
    )
    table.finish()
    return cut


def _read_operation(source: Source, position: int, entry: object) -> AnyOperation:
    """One operation of any type."""
    table = Table(source, ("operation", position), entry, f"operation {position + 1}")
    kind = OPERATION_CLASSES[table.text("type", tuple(OPERATION_CLASSES))]
    table.title = f"operation {position + 1} ({kind.type})"
    operation = kind.read(table)
    table.finish()
    return operation
