# SPDX-License-Identifier: Apache-2.0
"""Write a profile as a part file with comments that explain it."""

import re
from dataclasses import dataclass
from pathlib import Path

from tornillo.dxf.contour import Contour
from tornillo.dxf.curves import Point, Segment
from tornillo.dxf.options import DEFAULTS, Cutting, Tool, rounded_up
from tornillo.dxf.paper import number
from tornillo.protocol import NAME_LENGTH

NOT_NAME = re.compile(r"[^a-z0-9-]+")


@dataclass(frozen=True)
class Stock:
    """The raw bar and the cutting data, nothing left open; units of the part file."""

    diameter: float
    length: float
    retract: float


def stock_for(contour: Contour, cutting: Cutting, units: str) -> Stock:
    """What a person said about the stock, the rest to suit the profile."""
    usual = DEFAULTS[units]
    retract = usual.retract if cutting.retract is None else cutting.retract
    diameter, length = cutting.stock_diameter, cutting.stock_length
    if diameter is None:
        diameter = rounded_up(contour.largest_diameter, usual.stock_grid)
    if length is None:
        spare = max(usual.spare_length, 2 * retract)
        length = rounded_up(contour.length + spare, usual.stock_grid)
    return Stock(diameter, length, retract)


def part_name(cutting: Cutting, path: Path) -> str:
    """The name that was said, or that of the file as far as a lathe can show it."""
    made = NOT_NAME.sub("-", path.stem.lower()).strip("-")[:NAME_LENGTH].strip("-")
    return cutting.name or made or "part"


def part_text(
    contour: Contour, cutting: Cutting, units: str, source: Path, remarks: list[str]
) -> str:
    """The part file."""
    usual = DEFAULTS[units]
    stock = stock_for(contour, cutting, units)
    value = _Numbers(usual.decimals)
    lines = [
        f"# {part_name(cutting, source)}: made by `tornillo import-dxf` from {source.name}.",
        "#",
        *(f"# - {remark}" for remark in remarks),
        "",
        "[part]",
        f'name = "{part_name(cutting, source)}"',
        f'units = "{units}"',
        "",
        "[stock]",
        f"diameter = {value(stock.diameter)}",
        f"length = {value(stock.length)}",
    ]
    if cutting.allowance:
        lines.append(f"allowance = {value(cutting.allowance)}")
    lines += ["", "[cut]", *_cut(cutting, stock, units)]
    tool = cutting.tool
    if tool != Tool():
        lines += ["", "[[tool]]", *_tool(tool, contour.steepest_fall, value)]
    if cutting.allowance:
        lines += [
            "",
            "[[operation]]",
            'type = "face"             # takes the allowance off',
            f"z = {value(contour.segments[0].start[0])}",
        ]
        if contour.face:
            lines.append(f"diameter = {value(contour.face)}")
    lines += ["", "[[operation]]", 'type = "profile"          # free end to chuck']
    if tool != Tool():
        lines.append(f'tool = "{tool.name}"')
    return "\n".join([*lines, "points = [", *_points(contour.segments, value), "]", ""])


class _Numbers:
    """Writes numbers as TOML floats, rounded."""

    def __init__(self, decimals: int) -> None:
        """`decimals` behind the point."""
        self.decimals = decimals

    def __call__(self, value: float) -> str:
        """A float, with at least one decimal."""
        text = number(value, self.decimals)
        return text if "." in text else f"{text}.0"

    def place(self, place: Point) -> str:
        """Both coordinates of a place."""
        return f"z = {self(place[0])}, diameter = {self(2 * place[1])}"


def _cut(cutting: Cutting, stock: Stock, units: str) -> list[str]:
    """The cutting data, one line for each."""
    usual = DEFAULTS[units]
    value = _Numbers(usual.decimals)
    rows = (
        ("depth_of_cut", cutting.depth_of_cut, usual.depth_of_cut, "radial, per pass"),
        ("finish_allowance", cutting.finish_allowance, usual.finish_allowance, "radial"),
        ("feed", cutting.feed, usual.feed, f"{units} per minute along the path"),
        ("finish_feed", cutting.finish_feed, usual.finish_feed, "the last pass"),
        ("retract", stock.retract, stock.retract, "distance in rapid moves"),
    )
    lines = []
    for key, said, default, comment in rows:
        text = f"{key} = {value(default if said is None else said)}"
        lines.append(f"{text:<25} # {comment}")
    if cutting.spindle_speed is not None:
        text = f"spindle = {number(cutting.spindle_speed)}"
        lines.append(f"{text:<25} # turns per minute, advice to whoever sets it")
    return lines


def _tool(tool: Tool, steepest_fall: float, value: _Numbers) -> list[str]:
    """The tool's table."""
    lines = [
        f'name = "{tool.name}"',
        f'hand = "{tool.hand}"',
        f"front_clearance = {value(tool.front_clearance)}",
        f"back_clearance = {value(tool.back_clearance)}",
    ]
    lines[-1] += f"     # degrees; the profile falls at up to {number(steepest_fall, 1)}"
    if tool.nose_radius:
        lines.append(f"nose_radius = {value(tool.nose_radius)}")
    return lines


def _points(segments: tuple[Segment, ...], value: _Numbers) -> list[str]:
    """The corners, with the centre of the arc that ends there and where it comes from."""
    lines = [f"  {{ {value.place(segments[0].start)} }},"]
    for segment in segments:
        center = f", center = {{ {value.place(segment.center)} }}" if segment.center else ""
        origin = f"{segment.origin.kind} {segment.origin.handle}"
        lines.append(f"  {{ {value.place(segment.end)}{center} }},  # {origin}")
    return lines
