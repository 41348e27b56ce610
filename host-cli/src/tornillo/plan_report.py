# SPDX-License-Identifier: Apache-2.0
"""A plan in words and numbers of the part file: what `tornillo plan` shows."""

from collections.abc import Iterator
from dataclasses import dataclass

from tornillo.drives import Drives
from tornillo.image import SegmentKind
from tornillo.language import _
from tornillo.machine import Machine
from tornillo.moves import Halt, Move, Pass, Place, Plan, Role, Stop
from tornillo.part import Part
from tornillo.planning import plan_part
from tornillo.timing import Timing, axis_steps, time_plan
from tornillo.units import Scale

Row = dict[str, object]
WAITING = (Halt.PAUSE, Halt.DRILL)


@dataclass(frozen=True)
class OperationSummary:
    """One operation: `title` as in messages, times in seconds."""

    number: int
    title: str
    tool: str
    passes: int
    seconds: float
    feeding: float


class PlanReport:
    """The plan of a part on a machine, with its times."""

    def __init__(self, part: Part, machine: Machine, drives: Drives) -> None:
        """Plan `part`, which must be valid, as `machine` with these `drives` will cut it."""
        self.part = part
        self.scale = Scale(part.units, machine)
        self.plan: Plan = plan_part(part.steps(machine), machine)
        self.timing: Timing = time_plan(self.plan, drives)
        self.steps_x, self.steps_z = axis_steps(self.plan.moves)

    @property
    def tool_changes(self) -> int:
        """How often the lathe waits for another tool."""
        return sum(stop.halt is Halt.TOOL for stop in self.plan.stops)

    @property
    def pauses(self) -> int:
        """How often it waits for the operator, tool changes not counted."""
        return sum(stop.halt in WAITING for stop in self.plan.stops)

    def operations(self) -> Iterator[OperationSummary]:
        """What each operation takes; the way to the parking place counts for the one before."""
        steps = list(zip(self.plan.steps, self.timing.steps, self.timing.feeding, strict=True))
        for number, operation in enumerate(self.part.ordered, start=1):
            mine = [entry for entry in steps if entry[0].operation == number]
            paused = any(isinstance(step, Stop) and step.halt in WAITING for step, _, _ in mine)
            yield OperationSummary(
                number,
                operation.title,
                "" if paused else operation.tool.name,
                sum(isinstance(step, Pass) for step, _, _ in mine),
                sum(seconds for _, seconds, _ in mine),
                sum(feeding for _, _, feeding in mine),
            )

    def passes(self) -> Iterator[Row]:
        """One row for each pass and stop, lengths in file units, times in seconds."""
        for step, seconds in zip(self.plan.steps, self.timing.steps, strict=True):
            if isinstance(step, Stop):
                yield {
                    "operation": step.operation,
                    "stop": step.halt.value,
                    "text": step.text,
                    "seconds": round(seconds, 2),
                }
                continue
            start, end = step.stroke
            yield {
                "operation": step.operation,
                "pass": step.number,
                "role": step.role.value,
                "from": self.place(start),
                "to": self.place(end),
                "depth": self.depth(step),
                "seconds": round(seconds, 2),
            }

    def moves(self) -> Iterator[Row]:
        """One row for each move."""
        for step in self.plan.steps:
            for move in step.moves:
                row: Row = {"operation": step.operation}
                if isinstance(step, Pass):
                    row["pass"] = step.number
                yield row | self._move(move)

    def _move(self, move: Move) -> Row:
        """A move in file units."""
        row: Row = {
            "kind": move.kind.name.lower(),
            "from": self.place(move.start),
            "to": self.place(move.end),
            "feed": None if move.rapid else round(self.scale.per_minute(move.feed), 4),
        }
        if move.kind is not SegmentKind.LINE:
            centre = move.start[0] + move.cz / 256, move.start[1] + move.cx / 256
            row["center"] = {
                "z": round(self.scale.length(1) * centre[0], 5),
                "diameter": round(self.scale.diameter(1) * centre[1], 5),
            }
        return row

    def place(self, place: Place) -> dict[str, float]:
        """A place in file units."""
        z, x = place
        return {"z": round(self.scale.length(z), 5), "diameter": round(self.scale.diameter(x), 5)}

    def depth(self, stroke: Pass) -> float:
        """The depth of a pass, or what it keeps from the contour, in file units."""
        if stroke.role is Role.FACING:
            return round(self.scale.length(stroke.depth), 5)
        return round(self.scale.diameter(stroke.depth) / 2, 5)

    def json(self, with_moves: bool) -> Row:
        """Everything, for scripts."""
        found: Row = {
            "name": self.part.name,
            "units": self.part.units,
            "passes": len(self.plan.passes),
            "seconds": round(self.timing.total, 2),
            "seconds_in_cut": round(sum(self.timing.feeding), 2),
            "seconds_at_least": round(sum(self.timing.least), 2),
            "share_in_cut": round(self.timing.share, 4),
            "steps": {"x": self.steps_x, "z": self.steps_z},
            "tool_changes": self.tool_changes,
            "pauses": self.pauses,
            "operations": [vars(operation) for operation in self.operations()],
            "list": list(self.passes()),
        }
        if with_moves:
            found["moves"] = list(self.moves())
        return found


def show_time(seconds: float) -> str:
    """A time as a person says it."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    if whole < 3600:
        return _("{whole} min {whole2:02d} s").format(whole=whole // 60, whole2=whole % 60)
    return _("{whole} h {whole2:02d} min").format(whole=whole // 3600, whole2=whole % 3600 // 60)
