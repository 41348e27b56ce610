# SPDX-License-Identifier: Apache-2.0
"""From a DXF file to the text of a part file.

task = Import(Path("pawn.dxf"), View(), Machine.load())
text = task.part_text(Cutting(stock_diameter=19.0))
"""

from dataclasses import dataclass
from pathlib import Path

from tornillo.dxf.chain import join
from tornillo.dxf.contour import Contour, profile
from tornillo.dxf.curves import Segment
from tornillo.dxf.entities import Reader, Reading, open_drawing, unit_of
from tornillo.dxf.options import DEFAULTS, MM_PER_INCH, Cutting, View
from tornillo.dxf.paper import Paper, number
from tornillo.dxf.part_text import part_text, stock_for
from tornillo.dxf.section import Half, take_half
from tornillo.errors import DrawingError
from tornillo.language import _
from tornillo.machine import Machine
from tornillo.units import NM_PER_UNIT

MM_PER = {
    "inch": 25.4, "foot": 304.8, "mil": 0.0254,
    "um": 0.001, "mm": 1.0, "cm": 10.0, "dm": 100.0, "m": 1000.0,
}  # fmt: skip
INCH_FAMILY = ("inch", "foot", "mil")
HALF_STEP = 0.5
# Of the part image: the centre of an arc lies at most 2^15 steps away, and the segments have
# what its 960 bytes leave for them.
LARGEST_RADIUS_STEPS = 32_000
LINE_BYTES, ARC_BYTES, ROOM_BYTES = 5, 11, 860
MOST_SEGMENTS = 400


@dataclass(frozen=True)
class Units:
    """The drawing's unit, the units of the part file, and one unit of the drawing in those."""

    drawn: str
    written: str
    factor: float


class Import:
    """One drawing on its way to a part; what has been read so far can be shown in a picture."""

    def __init__(self, path: Path, view: View, machine: Machine) -> None:
        """Nothing is read yet."""
        self.path = path
        self.view = view
        self.machine = machine
        self.reading: Reading | None = None
        self.half: Half | None = None
        self.contour: Contour | None = None
        self.paper: Paper | None = None
        self.remarks: list[str] = []

    def part_text(self, cutting: Cutting) -> str:
        """The part file.

        Raises DrawingError when the drawing cannot be turned on the machine.
        """
        document = open_drawing(self.path)
        units = self._units(unit_of(document))
        paper = self._paper(units)
        self.paper = paper
        reading = Reader(document, paper.file, self.view.layers).read(paper.tolerance)
        self.reading = reading
        segments, center_lines = (
            [segment.mapped(paper.turn, paper.upright) for segment in found]
            for found in (reading.segments, reading.center_lines)
        )
        if len(segments) > MOST_SEGMENTS:
            self._too_many(len(segments))
        view = self.view
        half = take_half(segments, center_lines, paper, view.axis, view.half)
        self.half = half
        contour = profile(join(half.pieces, paper), half, view, paper, cutting.tool)
        self._check_size(contour, cutting, units)
        self.contour = contour
        self.remarks = [self._unit_remark(units), half.remark, *contour.remarks]
        self.remarks += self._left_out() + _long(contour)
        return part_text(contour, cutting, units.written, self.path, self.remarks)

    def _units(self, named: str) -> Units:
        """The units of drawing and part file.

        Raises DrawingError when neither the drawing nor a person says them.
        """
        drawn = self.view.units or named
        if not drawn:
            raise DrawingError(
                _("{path}: the drawing does not say its units ($INSUNITS)").format(path=self.path),
                _("say them with --units mm or --units inch"),
            )
        written = "inch" if drawn in INCH_FAMILY else "mm"
        factor = MM_PER[drawn] / (MM_PER_INCH if written == "inch" else 1.0)
        return Units(drawn, written, factor * self.view.scale)

    def _paper(self, units: Units) -> Paper:
        """How the drawing is measured."""
        view = self.view
        step = self.machine.step_z_nm / NM_PER_UNIT[units.written]
        tolerance = HALF_STEP * step if view.tolerance is None else view.tolerance
        snap = DEFAULTS[units.written].snap if view.snap is None else view.snap
        return Paper(
            file=str(self.path),
            units=units.written,
            factor=units.factor,
            tolerance=tolerance / units.factor,
            snap=snap / units.factor,
            largest_radius=LARGEST_RADIUS_STEPS * step,
            upright=view.spindle == "y",
        )

    def _check_size(self, contour: Contour, cutting: Cutting, units: Units) -> None:
        """Refuse a part that the machine cannot reach around: often the units are wrong."""
        machine, written = self.machine, units.written
        stock = stock_for(contour, cutting, written)
        z_room = (machine.travel_z + machine.zero_z) * machine.step_z_nm / NM_PER_UNIT[written]
        x_room = -machine.zero_x * machine.step_x_nm / NM_PER_UNIT[written]
        x_need = stock.diameter / 2 + stock.retract
        if contour.length <= z_room and x_need <= x_room:
            return
        fits = min(z_room / contour.length, (x_room - stock.retract) / (stock.diameter / 2))
        remedy = _("check the units (now {drawn}) with --units").format(drawn=units.drawn)
        if fits > 0:
            smaller = number(self.view.scale * fits, 2 if fits > 0.1 else 4)
            remedy += _(", or make the part smaller with --scale {smaller}").format(smaller=smaller)
        raise DrawingError(
            _(
                "{path}: the part is {length} {written} long and {largest_diameter} "
                "{written} thick; {machine} reaches {z_room} {written} along and {x_room} "
                "{written} from the axis, retract included"
            ).format(
                path=self.path,
                length=number(contour.length, 2),
                written=written,
                largest_diameter=number(contour.largest_diameter, 2),
                machine=machine.name,
                z_room=number(z_room, 2),
                x_room=number(x_room, 2),
            ),
            remedy,
        )

    def _too_many(self, count: int) -> None:
        """Refuse a drawing that is not one outline."""
        raise DrawingError(
            _(
                "{path}: {count} lines and arcs are too many for an outline, at most "
                "{most_segments}"
            ).format(path=self.path, count=count, most_segments=MOST_SEGMENTS),
            _("choose the outline's layer with --layer, or a larger --tolerance for splines"),
        )

    def _unit_remark(self, units: Units) -> str:
        """Where the units come from."""
        source = _("as said") if self.view.units else _("from the drawing")
        scale = (
            ""
            if self.view.scale == 1
            else _(", scaled by {scale}").format(scale=number(self.view.scale, 6))
        )
        return _("drawn in {drawn}, {source}{scale}").format(
            drawn=units.drawn, source=source, scale=scale
        )

    def _left_out(self) -> list[str]:
        """What was drawn, too, but is not the outline."""
        assert self.reading is not None
        parts = [f"{count} {kind}" for kind, count in sorted(self.reading.left_out.items())]
        return [_("left out: {parts}").format(parts=", ".join(parts))] if parts else []

    def drawn(self) -> list[Segment]:
        """Everything read so far, as it is drawn."""
        return self.reading.segments if self.reading else []

    def outline(self) -> list[Segment]:
        """The half that is turned, as it is drawn; empty before it is known."""
        if self.half is None or self.paper is None:
            return []
        paper = self.paper
        return [segment.mapped(paper.turn, paper.upright) for segment in self.half.pieces]


def _long(contour: Contour) -> list[str]:
    """A warning when the profile may need more room than the lathe has for a part."""
    arcs = sum(1 for segment in contour.segments if segment.center)
    size = ARC_BYTES * arcs + LINE_BYTES * (len(contour.segments) - arcs)
    if size <= ROOM_BYTES:
        return []
    return [
        _(
            "the profile has {segments} pieces, perhaps too many for the lathe's "
            "memory: a larger --tolerance makes fewer"
        ).format(segments=len(contour.segments))
    ]
