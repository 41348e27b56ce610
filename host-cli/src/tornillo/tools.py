# SPDX-License-Identifier: Apache-2.0
"""Tools of a part file: what they can follow without cutting into the work."""

import math
import re
from dataclasses import dataclass

from tornillo.language import _
from tornillo.protocol import SLOPE_ANY, SLOPE_UNIT, TOOL_NAME_LENGTH
from tornillo.toml_source import Source, Table

NAME = re.compile(rf"[a-z0-9-]{{1,{TOOL_NAME_LENGTH}}}")
HANDS = ("right", "left", "neutral")
EXTERNAL = 3  # the orientation of a tip for turning outside, towards the chuck
TOOLS_MAX = 16
SQUARE = 90.0
FRONT_CLEARANCE, BACK_CLEARANCE = 3.0, 30.0
ANGLE_SLACK = 1e-6


@dataclass(frozen=True)
class Tool:
    """One tool. Angles in degrees, lengths in file units.

    `front_clearance`: how far the leading edge leans back from a square shoulder.
    `back_clearance`: angle between trailing edge and axis. `position`: its number in the file,
    -1 for the tool of a file that has none. `offset_z`, `offset_x`: where its tip is, relative
    to the first tool, x as a radius.
    """

    name: str = "right-hand"
    hand: str = "right"
    front_clearance: float = FRONT_CLEARANCE
    back_clearance: float = BACK_CLEARANCE
    nose_radius: float = 0.0
    width: float = 0.0
    offset_z: float = 0.0
    offset_x: float = 0.0
    position: int = -1

    @property
    def steepest_rise(self) -> float:
        """The steepest rise towards the chuck that it can follow, degrees."""
        return self.back_clearance if self.hand == "left" else self._leading

    @property
    def steepest_fall(self) -> float:
        """The steepest fall towards the chuck that it can follow, degrees."""
        return self._leading if self.hand == "left" else self.back_clearance

    @property
    def _leading(self) -> float:
        """The angle of the leading edge from the axis."""
        return SQUARE + min(self.front_clearance, 0.0)


def slope(angle: float, ratio: float = 1.0) -> int:
    """An angle from the axis in 1/256 X step per Z step; SLOPE_ANY when it is square.

    `ratio`: the size of a Z step by that of an X step.
    """
    if angle > SQUARE - ANGLE_SLACK:
        return SLOPE_ANY
    return min(round(math.tan(math.radians(angle)) * SLOPE_UNIT * ratio), SLOPE_ANY - 1)


def read_tools(source: Source, entries: list[object]) -> tuple[Tool, ...]:
    """The tools of a file; raises PartError for one that cannot be."""
    found: dict[str, Tool] = {}
    for position, entry in enumerate(entries):
        table = Table(
            source, ("tool", position), entry, _("tool {position}").format(position=position + 1)
        )
        tool = _read_tool(table, position)
        if tool.name in found:
            table.refuse(
                "name",
                _('{title}: there already is a tool "{tool}"').format(
                    title=table.title, tool=tool.name
                ),
                _("give every tool a name of its own"),
            )
        found[tool.name] = tool
    if len(found) > TOOLS_MAX:
        source.refuse(
            ("tool", TOOLS_MAX),
            _("{found} tools are too many").format(found=len(found)),
            _("use at most {tools_max} in one part").format(tools_max=TOOLS_MAX),
        )
    return tuple(found.values()) or (Tool(),)


def _read_tool(table: Table, position: int) -> Tool:
    """One tool."""
    name = table.text("name")
    if not NAME.fullmatch(name):
        table.refuse(
            "name",
            _('{title}: the name "{name}" cannot be used').format(title=table.title, name=name),
            _("use 1 to {tool_name_length} of the characters a-z, 0-9 and -").format(
                tool_name_length=TOOL_NAME_LENGTH
            ),
        )
    table.title = _('tool "{name}"').format(name=name)
    hand = table.text("hand", HANDS, default="right")
    front = FRONT_CLEARANCE
    back = table.within("back_clearance", 0.0, SQUARE, BACK_CLEARANCE)
    if table.has("front_clearance"):
        front = table.within("front_clearance", -SQUARE, SQUARE, FRONT_CLEARANCE)
    elif hand == "neutral":
        front = back - SQUARE
    orientation = table.whole("orientation", 0, 9, EXTERNAL)
    if orientation != EXTERNAL:
        table.refuse(
            "orientation",
            _("{title}: a tip of orientation {orientation} cannot be compensated").format(
                title=table.title, orientation=orientation
            ),
            _(
                "use {external}, the tip at small z and small diameter, for turning "
                "towards the chuck"
            ).format(external=EXTERNAL),
        )
    offset_z, offset_x = _read_offset(table)
    tool = Tool(
        name=name,
        hand=hand,
        front_clearance=front,
        back_clearance=back,
        nose_radius=table.positive("nose_radius", 0.0),
        width=table.positive("width", 0.0),
        offset_z=offset_z,
        offset_x=offset_x,
        position=position,
    )
    table.finish()
    return tool


def _read_offset(table: Table) -> tuple[float, float]:
    """Where the tip is relative to the first tool: z, and x as a radius."""
    if not table.has("offset"):
        return 0.0, 0.0
    place = table.point("offset")
    return place.z, place.x


def named(tools: tuple[Tool, ...], name: str, table: Table) -> Tool:
    """The tool called `name`; raises PartError naming the nearest one."""
    names = tuple(tool.name for tool in tools)
    table.choice("tool", name, names)
    return tools[names.index(name)]
