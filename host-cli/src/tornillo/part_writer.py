# SPDX-License-Identifier: Apache-2.0
"""A stored part as a part file again.

What comes back is the path of the tool's tip, in which the nose of the tool is already allowed
for; `path = "tip"` in the file says so, and its image is the same again, byte for byte.
"""

import math
from collections.abc import Callable

from tornillo.image import CENTRE_UNIT, PartImage, Segment, SegmentKind, unpack_segments
from tornillo.machine import Machine
from tornillo.protocol import (
    CONTOUR_FACING,
    CONTOUR_KIND,
    SLOPE_ANY,
    SLOPE_UNIT,
    ContourRecord,
    CutRecord,
    PauseRecord,
    PlungeRecord,
    ToolRecord,
)
from tornillo.tool_records import NM_PER_UM, nose_micrometres
from tornillo.tools import SQUARE, slope
from tornillo.units import NM_PER_UNIT, Scale

DIGITS = 12
ASIDE = (-1e-9, 0.0, 1e-9)
KINDS = ("face", "cylinder", "cone", "arc", "profile")
HEAD = """\
# Read back from the lathe by `tornillo download`.
#
# The numbers are the path of the tool's tip in whole steps, as the lathe cuts it: the nose
# radius of the tools is already allowed for, and `path = "tip"` keeps it from being allowed for
# again. Uploaded as it is, the part is the same again, byte for byte.
"""


def shortest(value: float, back: Callable[[float], int], wanted: int) -> str:
    """`value` with as few decimals as `back` needs to turn it into `wanted`, not just so."""
    for digits in range(1, DIGITS):
        text = f"{value:.{digits}f}"
        if all(back(float(text) + aside) == wanted for aside in ASIDE):
            return text if float(text) else text.removeprefix("-")
    return repr(value)


def part_text(image: PartImage, machine: Machine) -> str:
    """The text of a part file whose image on `machine` is `image`."""
    return _Writer(image, machine).text()


class _Writer:
    """Turns steps into the units that the part was drawn in."""

    def __init__(self, image: PartImage, machine: Machine) -> None:
        """For `image`, made for `machine`."""
        self.image = image
        self.scale = Scale("inch" if image.inch else "mm", machine)
        self.unit = NM_PER_UNIT[self.scale.units]
        self.machine = machine

    def z(self, steps: int) -> str:
        """A length along."""
        return shortest(self.scale.length(steps), self.scale.z_steps, steps)

    def x(self, steps: int) -> str:
        """A length across."""
        return shortest(self.scale.diameter(steps) / 2, self.scale.x_steps, steps)

    def diameter(self, steps: int) -> str:
        """The diameter of a radius."""
        return shortest(self.scale.diameter(steps), self.scale.radius_steps, steps)

    def at(self, z: int, x: int, more: str = "") -> str:
        """A place."""
        return f"{{ z = {self.z(z)}, diameter = {self.diameter(x)}{more} }}"

    def text(self) -> str:
        """The whole file."""
        header = self.image.header
        cuts = self._cuts()
        blocks = [
            HEAD,
            f'[part]\nname = "{self.image.name}"\nunits = "{self.scale.units}"\npath = "tip"\n',
            f"[stock]\ndiameter = {self.diameter(header.stock_radius)}\n"
            f"length = {self.z(header.stock_length)}\n"
            f"allowance = {self.z(header.stock_front)}\n",
            "[cut]\n"
            + "".join(f"{key} = {value}\n" for key, value in cuts[0].items())
            + f"retract = {self.x(header.retract)}\n",
        ]
        tools: dict[int, ToolRecord] = {}
        for record in self.image.records:
            if isinstance(record, ToolRecord) and record.kind not in tools:
                tools[record.kind] = record
        blocks += [self._tool(tool) for tool in tools.values()]
        return "\n".join([*blocks, *self._operations(cuts)])

    def _operations(self, cuts: list[dict[str, str]]) -> list[str]:
        """All operations, with what their cutting data have of their own."""
        blocks: list[str] = []
        name, width = "", 0
        for record in self.image.records:
            if isinstance(record, ToolRecord):
                name, width = _text(record.name), record.width
            elif isinstance(record, PauseRecord):
                blocks.append(self._pause(record))
            elif not isinstance(record, CutRecord):
                shape = (
                    self._contour(record)
                    if isinstance(record, ContourRecord)
                    else self._plunge(record, width)
                )
                own = cuts[len(blocks) + 1]
                more = [f"{key} = {own[key]}\n" for key in own if own[key] != cuts[0][key]]
                blocks.append(f'[[operation]]\n{shape}tool = "{name}"\n' + "".join(more))
        return blocks

    def _cuts(self) -> list[dict[str, str]]:
        """The cutting data of [cut], then those of every operation."""
        found: list[dict[str, str]] = []
        cut: CutRecord | None = None
        for record in self.image.records:
            if isinstance(record, CutRecord):
                cut = record
            elif not isinstance(record, ToolRecord) and cut is not None:
                facing = isinstance(record, ContourRecord) and record.kind & CONTOUR_FACING
                found.append(self._cut(cut, bool(facing)))
        return [found[0], *found]

    def _cut(self, cut: CutRecord, facing: bool) -> dict[str, str]:
        """Cutting data as keys."""
        depth = self.z if facing else self.x
        return {
            "depth_of_cut": depth(cut.depth_of_cut),
            "finish_allowance": self.x(cut.finish_allowance),
            "feed": self._feed(cut.feed),
            "finish_feed": self._feed(cut.finish_feed),
            "spindle": str(cut.spindle),
            "spring_passes": str(cut.kind),
            "peck": self.x(cut.peck),
        }

    def _feed(self, feed: int) -> str:
        """A feed per minute."""
        return shortest(self.scale.per_minute(feed), self.scale.feed, feed)

    def _tool(self, tool: ToolRecord) -> str:
        """A tool, by what the chip knows of it."""
        ratio = self.machine.step_z_nm / self.machine.step_x_nm
        unit = self.scale.units
        lines = [f'[[tool]]\nname = "{_text(tool.name)}"']
        nose = shortest(
            tool.nose * NM_PER_UM / self.unit, lambda n: nose_micrometres(n, unit), tool.nose
        )
        lines.append(f"nose_radius = {nose}")
        lines.append(f"back_clearance = {_angle(tool.back, ratio)}")
        if tool.front != SLOPE_ANY:
            lines.append(f"front_clearance = {_lean(tool.front, ratio)}")
        if tool.width:
            lines.append(f"width = {self.z(tool.width)}")
        if tool.offset_x or tool.offset_z:
            lines.append(f"offset = {self.at(tool.offset_z, tool.offset_x)}")
        return "\n".join(lines) + "\n"

    def _contour(self, record: ContourRecord) -> str:
        """A contour in the shortest form that has all of it."""
        segments = tuple(unpack_segments(record.segments))
        facing = bool(record.kind & CONTOUR_FACING)
        kind = KINDS[record.kind & CONTOUR_KIND]
        one = segments[0] if len(segments) == 1 else None
        text = f'type = "{kind}"\n'
        outside = self.image.header.stock_radius
        whole = one is not None and (one.dz, record.x + one.dx) == (0, outside)
        if whole and kind == "face":
            return f"{text}z = {self.z(record.z)}\ndiameter = {self.diameter(record.x)}\n"
        roughing = "" if kind == "face" else f'roughing = "{"facing" if facing else "along"}"\n'
        if one is not None and kind == "cylinder" and one.dx == 0:
            ends = f"{self.z(record.z)}, {self.z(record.z + one.dz)}"
            return f"{text}z = [{ends}]\ndiameter = {self.diameter(record.x)}\n{roughing}"
        if one is not None and kind in ("cone", "arc"):
            end = self.at(record.z + one.dz, record.x + one.dx)
            more = "".join(
                f"{key} = {value}\n" for key, value in self._arc(record.z, record.x, one)
            )
            return f"{text}start = {self.at(record.z, record.x)}\nend = {end}\n{more}{roughing}"
        return f"{text}points = [\n{self._points(record.z, record.x, segments)}]\n{roughing}"

    def _points(self, z: int, x: int, segments: tuple[Segment, ...]) -> str:
        """A chain as points."""
        rows = [f"  {self.at(z, x)},\n"]
        for segment in segments:
            more = "".join(f", {key} = {value}" for key, value in self._arc(z, x, segment))
            z, x = z + segment.dz, x + segment.dx
            rows.append(f"  {self.at(z, x, more)},\n")
        return "".join(rows)

    def _arc(self, z: int, x: int, segment: Segment) -> list[tuple[str, str]]:
        """What a point says about the arc that ends in it; nothing for a line."""
        if segment.kind is SegmentKind.LINE:
            return []
        step_z, step_x = self.machine.step_z_nm / self.unit, self.machine.step_x_nm / self.unit
        at_z = z + segment.cz / CENTRE_UNIT
        at_x = x + segment.cx / CENTRE_UNIT
        centre_z = shortest(
            at_z * step_z, lambda n: math.floor((n / step_z - z) * CENTRE_UNIT + 0.5), segment.cz
        )
        centre_x = shortest(
            2 * at_x * step_x,
            lambda n: math.floor((n / 2 / step_x - x) * CENTRE_UNIT + 0.5),
            segment.cx,
        )
        radius = math.hypot(segment.cz * step_z, segment.cx * step_x) / CENTRE_UNIT
        side = "" if segment.kind is SegmentKind.CONVEX else "-"
        return [
            ("center", f"{{ z = {centre_z}, diameter = {centre_x} }}"),
            ("radius", f"{side}{radius:.4f}"),
        ]

    def _plunge(self, record: PlungeRecord, width: int) -> str:
        """A groove, or the parting behind a part."""
        front = self.z(record.z_high + width)
        bottom = f"diameter = {self.diameter(record.x)}\n"
        if record.kind == 1:
            return f'type = "part-off"\nz = {front}\n{bottom}'
        return f'type = "groove"\nz = [{front}, {self.z(record.z_low)}]\n{bottom}'

    def _pause(self, record: PauseRecord) -> str:
        """A pause."""
        kind = "drill" if record.kind == 1 else "pause"
        message = record.message.decode("ascii", "replace")
        quoted = message.replace("\\", "\\\\").replace('"', '\\"')
        return f'[[operation]]\ntype = "{kind}"\nmessage = "{quoted}"\n'


def _text(name: bytes) -> str:
    """A zero-padded name."""
    return name.rstrip(b"\0").decode("ascii", "replace")


def _angle(steepness: int, ratio: float) -> str:
    """The angle from the axis whose slope this is."""
    if steepness == SLOPE_ANY:
        return f"{SQUARE}"
    angle = math.degrees(math.atan(steepness / SLOPE_UNIT / ratio))
    return shortest(angle, lambda degrees: slope(degrees, ratio), steepness)


def _lean(steepness: int, ratio: float) -> str:
    """The clearance of a leading edge that follows this slope and no more."""
    lean = math.degrees(math.atan(steepness / SLOPE_UNIT / ratio)) - SQUARE
    return shortest(lean, lambda degrees: slope(SQUARE + degrees, ratio), steepness)
