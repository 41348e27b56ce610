# SPDX-License-Identifier: Apache-2.0
"""The report of a plan as aligned text."""

from collections.abc import Iterator, Sequence

from tornillo.image import SegmentKind
from tornillo.language import _, later, plural
from tornillo.moves import Halt, Move, Pass, Place, Role, Stop
from tornillo.plan_report import PlanReport, show_time
from tornillo.units import DECIMALS

HALTS = {
    Halt.PAUSE: later("pause, RUN goes on"),
    Halt.DRILL: later("drill by hand, RUN goes on"),
    Halt.TOOL: later("tool change, RUN goes on"),
    Halt.END: later("the end, parked"),
}
#: The lathe waits once for a pause and the change of tool behind it.
WITH_IT = later("change the tool too")
ROLES = {
    Role.ROUGHING: later("roughing"),
    Role.FACING: later("facing"),
    Role.SMOOTHING: later("along the contour"),
    Role.FINISHING: later("finishing"),
    Role.SPRING: later("spring pass"),
    Role.PLUNGING: later("plunge"),
}


def table(rows: Sequence[Sequence[str]], left: Sequence[int]) -> Iterator[str]:
    """Rows of equal length with aligned columns; those in `left` begin at the left edge."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    for row in rows:
        cells = (
            cell.ljust(width) if column in left else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        yield "  ".join(cells).rstrip()


class PlanText:
    """Writes a report in the units of the part file."""

    def __init__(self, report: PlanReport) -> None:
        """Write about `report`."""
        self.report = report
        self.digits: int = DECIMALS[report.part.units] + 1

    def lines(self, with_moves: bool) -> Iterator[str]:
        """The whole text; every move instead of every pass when wanted."""
        report = self.report
        yield _("{part}, lengths in {units}").format(part=report.part.name, units=report.part.units)
        yield ""
        yield from self._moves() if with_moves else self._passes()
        yield ""
        yield from self._operations()
        yield ""
        yield from self._totals()

    def _length(self, value: float) -> str:
        return f"{value:.{self.digits}f}"

    def _place(self, place: Place) -> tuple[str, str]:
        z, x = place
        scale = self.report.scale
        return self._length(scale.length(z)), self._length(scale.diameter(x))

    def _what(self, stroke: Pass) -> str:
        """What a pass is for."""
        if stroke.role is Role.SMOOTHING:
            return _("{roles}, leaves {stroke}").format(
                roles=_(ROLES[stroke.role]), stroke=self._length(self.report.depth(stroke))
            )
        return _(ROLES[stroke.role])

    def _passes(self) -> Iterator[str]:
        """One line for each pass or stop."""
        rows = [
            (
                _("op"),
                _("pass"),
                "",
                _("from z"),
                _("diameter"),
                _("to z"),
                _("diameter"),
                _("depth"),
                _("time"),
            )
        ]
        report = self.report
        waits = False
        for step, seconds in zip(report.plan.steps, report.timing.steps, strict=True):
            time = f"{seconds:.1f} s"
            parked, waits = waits, isinstance(step, Stop)
            if isinstance(step, Stop):
                together = parked and step.halt is Halt.TOOL
                what = _(WITH_IT if together else HALTS[step.halt])
                what += f": {step.text}" if step.text else ""
                rows.append(("", "", what, "", "", "", "", "", time))
                continue
            along = step.role in (Role.SMOOTHING, Role.FINISHING, Role.SPRING)
            depth = "" if along else self._length(report.depth(step))
            start, end = (self._place(place) for place in step.stroke)
            number, pass_ = str(step.operation), str(step.number)
            rows.append((number, pass_, self._what(step), *start, *end, depth, time))
        yield from table(rows, left=(2,))

    def _moves(self) -> Iterator[str]:
        """One line for each move."""
        rows = [
            (
                _("op"),
                _("pass"),
                "",
                _("to z"),
                _("diameter"),
                _("feed"),
                _("centre z"),
                _("diameter"),
            )
        ]
        for step in self.report.plan.steps:
            for move in step.moves:
                number = str(step.number) if isinstance(step, Pass) else ""
                rows.append((str(step.operation or ""), number, *self._move(move)))
        yield from table(rows, left=(2,))

    def _move(self, move: Move) -> tuple[str, str, str, str, str, str]:
        """Kind, end, feed and centre."""
        scale = self.report.scale
        feed = _("rapid") if move.rapid else f"{scale.per_minute(move.feed):.4g}"
        centre = ("", "")
        if move.kind is not SegmentKind.LINE:
            z, x = move.start[0] + move.cz / 256, move.start[1] + move.cx / 256
            centre = self._length(z * scale.length(1)), self._length(x * scale.diameter(1))
        return (move.kind.name.lower(), *self._place(move.end), feed, *centre)

    def _operations(self) -> Iterator[str]:
        """One line for each operation."""
        rows = [(_("operation"), _("tool"), _("passes"), _("time"), _("in the cut"))]
        for operation in self.report.operations():
            passes = str(operation.passes) if operation.tool else ""
            times = show_time(operation.seconds), show_time(operation.feeding)
            if not operation.tool:
                times = ("", "")
            rows.append((operation.title, operation.tool, passes, *times))
        yield from table(rows, left=(0, 1))

    def _totals(self) -> Iterator[str]:
        """The part as a whole."""
        report = self.report
        timing = report.timing
        rows = [
            (_("passes"), str(len(report.plan.passes))),
            (
                _("time"),
                _("about {total}{waits}").format(
                    total=show_time(timing.total), waits=self._waits()
                ),
            ),
            (
                _("in the cut"),
                _("{feeding}, {share:.0%} of the time").format(
                    feeding=show_time(sum(timing.feeding)), share=timing.share
                ),
            ),
            (
                _("at least"),
                _("{least}, length of cut by feed").format(least=show_time(sum(timing.least))),
            ),
            (_("steps"), f"X {report.steps_x:,}, Z {report.steps_z:,}"),
        ]
        yield from table(rows, left=(0, 1))

    def _waits(self) -> str:
        """What the estimate does not contain."""
        found = []
        changes, pauses = self.report.tool_changes, self.report.pauses
        if changes:
            text = plural("{count} tool change", "{count} tool changes", changes)
            found.append(text.format(count=changes))
        if pauses:
            found.append(plural("{count} pause", "{count} pauses", pauses).format(count=pauses))
        return _(", without {found}").format(found=_(" and ").join(found)) if found else ""
