# SPDX-License-Identifier: Apache-2.0
"""Part files: what a person writes, checked and turned into a part image.

part = Part.load("test-bar.toml")
part.check(Machine.load())          # raises PartError with file, line and remedy
data = part.image(Machine.load())   # the bytes for the chip
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from tornillo.compile import Compiled, compile_part
from tornillo.cutting import Cut, read_cut
from tornillo.errors import PartError
from tornillo.explain import explain
from tornillo.image import PartImage
from tornillo.language import _
from tornillo.machine import Machine
from tornillo.operations import Context, Operation, in_auto_order, read_operation
from tornillo.protocol import Refusal
from tornillo.protocol_texts import REFUSAL_TEXTS
from tornillo.rules import NAME, check
from tornillo.stock import Stock
from tornillo.toml_source import Source, Table
from tornillo.tools import Tool, read_tools
from tornillo.units import NM_PER_UNIT, Scale

ORDERS = ("written", "auto")
PATHS = ("contour", "tip")


@dataclass(frozen=True)
class Part:
    """One part file. `operations` are in the order of the file, `ordered` in that of cutting.

    `tip`: the file holds paths of the tool's tip, as a download does, not the part's contour.
    """

    name: str
    units: str
    stock: Stock
    cut: Cut
    tools: tuple[Tool, ...]
    operations: tuple[Operation, ...]
    ordered: tuple[Operation, ...]
    tip: bool
    source: Source = field(repr=False, compare=False)

    @classmethod
    def load(cls, path: str | Path) -> "Part":
        """Read a part file.

        Raises PartError when it cannot be read or understood.
        """
        try:
            text = Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or _("it is not UTF-8 text")
            raise PartError(
                _("{path}: the file cannot be read: {reason}").format(path=path, reason=reason),
                _("check its name and place"),
            ) from error
        return cls.parse(text, str(path))

    @classmethod
    def parse(cls, text: str, name: str = "part.toml") -> "Part":
        """Read the text of a part file; messages call it `name`.

        Raises PartError when it cannot be understood.
        """
        source = Source(name, text)
        top = Table(source, (), source.values, _("the file"))
        title, units, order, tip = _read_title(top.table("part"))
        stock = _read_stock(top.table("stock"))
        cut = read_cut(top.table("cut"))
        tools = read_tools(source, top.tables("tool", needed=False))
        entries = top.tables("operation")
        top.finish()
        context = Context(units, stock.diameter / 2, tip, tools, cut)
        operations = tuple(
            read_operation(source, position, entry, context)
            for position, entry in enumerate(entries)
        )
        ordered = in_auto_order(operations) if order == "auto" else operations
        return cls(title, units, stock, cut, tools, operations, ordered, tip, source)

    def compiled(self, machine: Machine) -> Compiled:
        """The part in steps of `machine`, with what was found on the way, not checked."""
        scale = Scale(self.units, machine)
        return compile_part(self.name, self.stock, self.ordered, self.tip, scale)

    def steps(self, machine: Machine) -> PartImage:
        """The part in steps of `machine`, rounded, not checked.

        Raises PartError for a shape that the tool cannot cut.
        """
        compiled = self.compiled(machine)
        for fault in compiled.faults:
            raise self.source.error(fault.place, fault.message, fault.remedy)
        return compiled.image

    def problems(self, machine: Machine) -> Iterator[PartError]:
        """Everything that `machine` would refuse.

        First what is wrong with the part as a whole; then what the tools cannot cut, which only
        the host can see, or else what the chip would refuse operation by operation.
        """
        compiled = self.compiled(machine)
        violations = list(check(compiled.image, Scale(self.units, machine)))
        whole = [violation for violation in violations if violation.record < 0]
        for violation in whole:
            yield explain(violation, compiled, self.source)
        if any(violation.refusal is Refusal.STOCK for violation in whole):
            return
        for fault in compiled.faults:
            yield self.source.error(fault.place, fault.message, fault.remedy)
        told: set[str] = set()
        for violation in violations:
            if violation.record >= 0 and not compiled.faults:
                error = explain(violation, compiled, self.source)
                if str(error) not in told:
                    yield error
                told.add(str(error))

    def notes(self, machine: Machine) -> tuple[str, ...]:
        """What will be left standing although the part is accepted, one sentence each."""
        return self.compiled(machine).notes

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
        """Number in the file and type of the operation that is cut as number `position`."""
        return self.ordered[position - 1].title


def _read_title(table: Table) -> tuple[str, str, str, bool]:
    """Name, units, order, and whether the file holds paths of the tip."""
    name = table.text("name")
    if not NAME.fullmatch(name.encode("utf-8")) or "\0" in name:
        remedy = _(REFUSAL_TEXTS[Refusal.NAME].remedy)
        table.refuse(
            "name",
            _('{title}: the name "{name}" cannot be used').format(title=table.title, name=name),
            remedy,
        )
    units = table.text("units", tuple(NM_PER_UNIT))
    order = table.text("order", ORDERS, default=ORDERS[0])
    tip = table.text("path", PATHS, default=PATHS[0]) == "tip"
    table.finish()
    return name, units, order, tip


def _read_stock(table: Table) -> Stock:
    """The raw material."""
    stock = Stock(
        diameter=table.positive("diameter"),
        length=table.positive("length"),
        allowance=table.positive("allowance", default=0.0),
    )
    table.finish()
    return stock
