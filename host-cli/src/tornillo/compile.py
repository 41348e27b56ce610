# SPDX-License-Identifier: Apache-2.0
"""From the operations of a part file to the records of a part image, in steps."""

from dataclasses import dataclass
from typing import NamedTuple

from tornillo.finished import FinishedPart
from tornillo.grid import Grid, path_segments
from tornillo.image import FLAG_INCH, PartImage, Record, Segment, pack_segments
from tornillo.language import _
from tornillo.material import Chain, chain_of
from tornillo.operations import Contour, Operation, Pause, Plunge
from tornillo.protocol import (
    CONTOUR_FACING,
    FEED_MIN,
    IMAGE_FORMAT,
    NAME_LENGTH,
    POSITION_MAX,
    ContourRecord,
    CutRecord,
    ImageHeader,
    PauseRecord,
    PlungeRecord,
    Refusal,
    ToolRecord,
)
from tornillo.protocol_texts import REFUSAL_TEXTS
from tornillo.roughing import never_falls
from tornillo.stock import Stock
from tornillo.tip import Fault, Reach, edge_faults, fault, tip_of
from tornillo.tool_records import tool_record
from tornillo.units import NM_PER_UNIT, Scale

BYTE_MAX = 255
FIELD_MAX = 0xFFFF
KINDS = ("face", "cylinder", "cone", "arc", "profile")
PLUNGES = ("groove", "part-off")
PAUSES = ("pause", "drill")


class Origin(NamedTuple):
    """Where a record comes from; `kind` is "tool", "cut" or "operation"."""

    kind: str
    operation: Operation


@dataclass(frozen=True)
class Compiled:
    """A part in steps. `origins` belong to the records of the image, one each.

    `faults`: what the tools cannot cut; those operations are not in the image. `notes`: what
    will be left standing, one sentence each.
    """

    image: PartImage
    origins: tuple[Origin, ...]
    faults: tuple[Fault, ...]
    notes: tuple[str, ...]


class Cutting(NamedTuple):
    """The path of one contour in steps."""

    z: int
    x: int
    segments: tuple[Segment, ...]


def compile_part(
    name: str, stock: Stock, ordered: tuple[Operation, ...], tip: bool, scale: Scale
) -> Compiled:
    """The part whose operations are cut in this order; `tip`: they are paths of the tip."""
    header = ImageHeader(
        format=IMAGE_FORMAT,
        operation_count=min(len(ordered), BYTE_MAX),
        flags=FLAG_INCH if scale.units == "inch" else 0,
        reserved=0,
        name=name.encode("ascii").ljust(NAME_LENGTH, b"\0"),
        step_x_nm=scale.machine.step_x_nm,
        step_z_nm=scale.machine.step_z_nm,
        stock_radius=scale.radius_steps(stock.diameter),
        stock_length=scale.z_steps(stock.length),
        stock_front=scale.z_steps(stock.allowance),
        retract=scale.x_steps(ordered[0].cut.retract),
    )
    compiler = _Compiler(header, ordered, tip, scale)
    compiler.trace_contours(FinishedPart(ordered, stock.diameter / 2, stock.allowance))
    return compiler.run()


class _Compiler:
    """Turns one operation after the other into records."""

    def __init__(
        self, header: ImageHeader, ordered: tuple[Operation, ...], tip: bool, scale: Scale
    ) -> None:
        """Before the first operation."""
        self.header = header
        self.ordered = ordered
        self.tip = tip
        self.scale = scale
        unit = NM_PER_UNIT[scale.units]
        self.grid = Grid(unit / header.step_z_nm, unit / header.step_x_nm)
        self.cuttings: dict[int, Cutting] = {}
        self.free_fronts: dict[int, bool] = {}
        self.records: list[Record] = []
        self.origins: list[Origin] = []
        self.faults: list[Fault] = []
        self.notes: list[str] = []

    def trace_contours(self, finished: FinishedPart) -> None:
        """Find the path of the tip for every contour."""
        for operation in self.ordered:
            if not isinstance(operation.shape, Contour):
                continue
            cutting, faults, notes = self._traced(operation, finished)
            self.faults += faults
            self.notes += notes
            if cutting is not None:
                self.cuttings[operation.position] = cutting
                self.free_fronts[operation.position] = not self.tip and finished.free_front(
                    operation
                )

    def _traced(
        self, operation: Operation, finished: FinishedPart
    ) -> tuple[Cutting | None, list[Fault], list[str]]:
        """The path of one contour, what is wrong with it and what it leaves."""
        assert isinstance(operation.shape, Contour)
        path, faults, notes = list(operation.shape.elements), list[Fault](), list[str]()
        if not self.tip and not operation.tool.width:
            faults = edge_faults(operation, self.scale)
            if not faults:
                reach = Reach(self._least_x(operation))
                around = finished.around(operation)
                path, faults, notes = tip_of(operation, around, reach, self.scale)
        if not faults:
            faults = self._too_far(operation)
        if faults:
            return None, faults, notes
        (z, x), segments = path_segments(path, self.grid, exact=self.tip)
        if not segments:
            text = REFUSAL_TEXTS[Refusal.EMPTY_CUT]
            message = _("{cause}: it is shorter than a step").format(cause=_(text.cause))
            return None, [fault(operation, 0, message, _(text.remedy))], []
        return Cutting(z, x, segments), [], notes

    def _least_x(self, operation: Operation) -> float:
        """The smallest radius that the tip reaches."""
        machine = self.scale.machine
        offset = self.scale.x_steps(operation.tool.offset_x)
        return (-machine.travel_x - machine.zero_x - offset) / self.grid.x

    def _too_far(self, operation: Operation) -> list[Fault]:
        """Places that the chip cannot count to."""
        assert isinstance(operation.shape, Contour)
        text = REFUSAL_TEXTS[Refusal.OUTSIDE_STOCK]
        for element in operation.shape.elements:
            for at in (element.start, element.end):
                if max(map(abs, self.grid.rounded(at))) > POSITION_MAX:
                    message = _("{cause}: z = {z:g}, diameter {x:g}").format(
                        cause=_(text.cause), z=at.z, x=2 * at.x
                    )
                    return [fault(operation, element.place, message, _(text.remedy))]
        return []

    def run(self) -> Compiled:
        """Make the records."""
        tools = self._tools()
        cut = next((op for op in self.ordered if not isinstance(op.shape, Pause)), self.ordered[0])
        for operation in self.ordered:
            if isinstance(operation.shape, Contour) and operation.position not in self.cuttings:
                continue
            pause = isinstance(operation.shape, Pause)
            cut = cut if pause else operation
            tool = tools[cut.tool.name]
            facing = self._facing(operation, tool)
            if not pause or not self.records:
                self._state(tool, Origin("tool", cut))
                self._state(self._cut_record(cut, facing), Origin("cut", cut))
            self._emit(self._record(operation, facing), Origin("operation", operation))
        image = PartImage(self.header, tuple(self.records))
        return Compiled(image, tuple(self.origins), tuple(self.faults), tuple(self.notes))

    def _tools(self) -> dict[str, ToolRecord]:
        """The records of all tools that are used, numbered by their first use."""
        used: dict[str, list[Operation]] = {}
        for operation in self.ordered:
            if not isinstance(operation.shape, Pause):
                used.setdefault(operation.tool.name, []).append(operation)
        if not used:
            used = {self.ordered[0].tool.name: [self.ordered[0]]}
        records = {}
        for number, (name, operations) in enumerate(used.items()):
            segments = [
                segment
                for operation in operations
                if operation.position in self.cuttings
                for segment in self.cuttings[operation.position].segments
            ]
            needed = [] if self.tip else segments
            records[name] = tool_record(number, operations[0].tool, needed, self.scale)
        return records

    def _emit(self, record: Record, origin: Origin) -> None:
        """Append a record."""
        self.records.append(record)
        self.origins.append(origin)

    def _state(self, record: ToolRecord | CutRecord, origin: Origin) -> None:
        """Append a record unless it is the one that is valid already."""
        same = [old for old in self.records if type(old) is type(record)]
        if not same or same[-1] != record:
            self._emit(record, origin)

    def _cut_record(self, operation: Operation, facing: bool) -> CutRecord:
        """The cutting data of an operation."""
        cut, scale = operation.cut, self.scale
        steps = scale.z_steps if facing else scale.x_steps
        return CutRecord(
            kind=cut.spring_passes,
            depth_of_cut=min(steps(cut.depth_of_cut), FIELD_MAX),
            finish_allowance=min(scale.x_steps(cut.finish_allowance), FIELD_MAX),
            feed=scale.feed(cut.feed),
            finish_feed=scale.feed(cut.finish_feed),
            spindle=cut.spindle,
            peck=min(scale.x_steps(cut.peck), POSITION_MAX),
        )

    def _record(self, operation: Operation, facing: bool) -> Record:
        """The operation itself."""
        shape = operation.shape
        if isinstance(shape, Pause):
            return PauseRecord(PAUSES.index(operation.type), shape.message.encode("ascii"))
        if isinstance(shape, Plunge):
            return self._plunge(operation, shape)
        return self._contour(operation, facing)

    def _contour(self, operation: Operation, facing: bool) -> ContourRecord:
        """The path of a contour."""
        cutting = self.cuttings[operation.position]
        kind = KINDS.index(operation.type) | (CONTOUR_FACING if facing else 0)
        return ContourRecord(kind, cutting.z, cutting.x, pack_segments(cutting.segments))

    def _plunge(self, operation: Operation, shape: Plunge) -> PlungeRecord:
        """A groove, or the parting behind a part."""
        scale = self.scale
        width = scale.z_steps(operation.tool.width)
        high = scale.z_steps(shape.front) - width
        low = high if operation.type == "part-off" else scale.z_steps(shape.back)
        x = scale.radius_steps(shape.diameter)
        if operation.type == "part-off" and x == 0 and not self.tip:
            nose = scale.x_steps(operation.tool.nose_radius)
            x = max(-nose, min(0, round(self._least_x(operation) * self.grid.x)))
        return PlungeRecord(PLUNGES.index(operation.type), high, low, x)

    def _facing(self, operation: Operation, tool: ToolRecord) -> bool:
        """Whether a contour is roughed in facing direction."""
        if not isinstance(operation.shape, Contour):
            return False
        chain = chain_of(*self.cuttings[operation.position])
        if operation.roughing == "facing" or operation.type == "face":
            self._must_face(operation, chain)
            return True
        if operation.roughing == "along" or not self.free_fronts[operation.position]:
            return False
        return never_falls(chain) and self._faster_facing(operation, tool)

    def _faster_facing(self, operation: Operation, tool: ToolRecord) -> bool:
        """Whether roughing in facing direction takes less time.

        With cutting data that the rules refuse anyway there is nothing to compare.
        """
        from tornillo.roughing_time import facing_is_shorter

        along, facing = (self._cut_record(operation, way) for way in (False, True))
        for cut in (along, facing):
            if cut.depth_of_cut < 1 or min(cut.feed, cut.finish_feed) < FEED_MIN:
                return False
        records = (*self.records, tool, along)
        return facing_is_shorter(self.header, records, self._contour(operation, True), facing)

    def _must_face(self, operation: Operation, chain: Chain) -> None:
        """Note why a contour cannot be roughed in facing direction, if so."""
        if self.tip or operation.type == "face":
            return
        where = ("operation", operation.position, "roughing")
        if not never_falls(chain):
            message = _("a contour that falls cannot be roughed in facing direction")
        elif not self.free_fronts[operation.position]:
            message = _("in facing direction the tool would cut what is in front of the contour")
        else:
            return
        self.faults.append(
            Fault(where, f"{operation.title}: {message}", _('write roughing = "along"'))
        )
