# SPDX-License-Identifier: Apache-2.0
"""The sheet around a drawing: frame, list of operations, tools, legend, title block."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from tornillo.contour import Line
from tornillo.dimensioning import show
from tornillo.language import _, later, plural
from tornillo.operations import Contour, Operation, Pause, Plunge
from tornillo.part import Part
from tornillo.plan_report import OperationSummary, PlanReport, show_time
from tornillo.scene import Pen, Point, Scene, Text
from tornillo.tool_picture import draw_angles, draw_tool
from tornillo.tools import Tool
from tornillo.view import View

#: What a tool's hand is called.
HANDS = {
    "right": later("right hand"),
    "left": later("left hand"),
    later("neutral"): later("neutral"),
}

SHEET = (297.0, 210.0)
FRAME: tuple[Point, Point] = ((8.0, 8.0), (289.0, 202.0))
TITLE_TOP = 58.0
VIEW: tuple[Point, Point] = ((12.0, TITLE_TOP + 3.0), (285.0, 200.0))
BORDER, RULE = Pen(0.5), Pen(0.2)
TOOLS_BLOCK, LEGEND_BLOCK, TITLE_BLOCK = 104.0, 168.0, 204.0
SMALL, NORMAL, LARGE = 2.7, 3.2, 6.5
ROWS, ROW = 9, 4.4
GREY = "#57606a"
TOOL_HEIGHT = 10.0
TOOLS_SHOWN = 3


class Legend(NamedTuple):
    """What a line or a fill means."""

    text: str
    pen: Pen | None = None
    fill: str = ""


def draw_sheet(scene: Scene, report: PlanReport, view: View, legend: Sequence[Legend]) -> None:
    """Draw everything that is not the part."""
    (left, low), (right, high) = FRAME
    scene.box(BORDER, (left, low), (right, high))
    scene.line(BORDER, (left, TITLE_TOP), (right, TITLE_TOP))
    for x in (TOOLS_BLOCK, LEGEND_BLOCK, TITLE_BLOCK):
        scene.line(RULE, (x, low), (x, TITLE_TOP))
    _operations(scene, report)
    _tools(scene, report.part, view)
    _legend(scene, legend)
    _title(scene, report, view)


def _heading(scene: Scene, left: float, text: str) -> None:
    """The title of a block."""
    scene.text(Text((left, TITLE_TOP - 5), text, NORMAL, bold=True))


def _shortened(text: str, room: float, size: float) -> str:
    """A text that fits into `room`."""
    most = int(room / (size * 0.58))
    return text if len(text) <= most else text[: most - 1] + "…"


def _operations(scene: Scene, report: PlanReport) -> None:
    """What is cut, in order, with passes and time."""
    left, right = FRAME[0][0] + 3, TOOLS_BLOCK - 2.5
    _heading(scene, left, _("Operations ({units})").format(units=report.part.units))
    summaries = list(report.operations())
    shown = summaries if len(summaries) <= ROWS else summaries[: ROWS - 1]
    for row, summary in enumerate(shown):
        operation = report.part.ordered[summary.number - 1]
        y = TITLE_TOP - 10.5 - row * ROW
        effort = _effort(summary)
        room = right - left - len(effort) * SMALL * 0.58
        text = f"{operation.position + 1:2d}  {operation.type}: {place_of(operation)}"
        scene.text(Text((left, y), _shortened(text, room, SMALL), SMALL))
        scene.text(Text((right, y), effort, SMALL, "end", color=GREY))
    if len(shown) < len(summaries):
        y = TITLE_TOP - 10.5 - len(shown) * ROW
        scene.text(
            Text(
                (left, y),
                _("    and {summaries} more").format(summaries=len(summaries) - len(shown)),
                SMALL,
            )
        )


def _effort(summary: OperationSummary) -> str:
    """Passes and time."""
    if not summary.tool:
        return _("RUN goes on")
    count = summary.passes
    passes = plural("{count} pass", "{count} passes", count).format(count=count)
    return f"{passes}, {show_time(summary.seconds)}"


def place_of(operation: Operation) -> str:
    """Where an operation cuts, in the numbers of the file."""
    shape = operation.shape
    if isinstance(shape, Pause):
        return shape.message
    if isinstance(shape, Plunge):
        z = _number(shape.front)
        if shape.front != shape.back:
            z = _("{z} to {back}").format(z=z, back=_number(shape.back))
        return f"z {z}, Ø{_number(shape.diameter)}"
    assert isinstance(shape, Contour)
    first, last = shape.elements[0].start, shape.elements[-1].end
    if operation.type == "face":
        return _("z {z}, to Ø{number}").format(z=_number(first.z), number=_number(2 * first.x))
    if operation.type == "cylinder" and isinstance(shape.elements[0], Line):
        return _("z {z} to {z2}, Ø{number}").format(
            z=_number(first.z), z2=_number(last.z), number=_number(2 * first.x)
        )
    ends = _("Ø{number} to Ø{number2}").format(
        number=_number(2 * first.x), number2=_number(2 * last.x)
    )
    return _("z {z} to {z2}, {ends}").format(z=_number(first.z), z2=_number(last.z), ends=ends)


def _used(part: Part) -> Iterator[Tool]:
    """The tools in the order of their use."""
    seen: list[str] = []
    for operation in part.ordered:
        if not isinstance(operation.shape, Pause) and operation.tool.name not in seen:
            seen.append(operation.tool.name)
            yield operation.tool


def _tools(scene: Scene, part: Part, view: View) -> None:
    """Each tool with its edges, at the scale of the part as far as the block has room."""
    left = TOOLS_BLOCK + 3
    tools = list(_used(part))
    _heading(scene, left, _("Tools") if len(tools) > 1 else _("Tool"))
    pitch = (LEGEND_BLOCK - TOOLS_BLOCK - 4) / TOOLS_SHOWN
    for column, tool in enumerate(tools[:TOOLS_SHOWN]):
        x = left + column * pitch
        scale = view.size(1)
        widest = max(tool.width, 3 * tool.nose_radius) * scale
        if widest > TOOL_HEIGHT:
            scale *= TOOL_HEIGHT / widest
        tip = x + 6.0, TITLE_TOP - 23.5
        draw_angles(scene, tool, tip, TOOL_HEIGHT)
        draw_tool(scene, tool, tip, scale, TOOL_HEIGHT)
        for row, line in enumerate(tool_lines(part, tool)):
            y = TITLE_TOP - 27.5 - row * 3.4
            scene.text(Text((x, y), line, 2.4, bold=row == 0))
    if len(tools) > TOOLS_SHOWN:
        names = ", ".join(tool.name for tool in tools[TOOLS_SHOWN:])
        text = _shortened(_("and {names}").format(names=names), LEGEND_BLOCK - left - 2, 2.4)
        scene.text(Text((left, FRAME[0][1] + 2.4), text, 2.4))


def tool_lines(part: Part, tool: Tool) -> list[str]:
    """Name and sizes of a tool in words."""
    sizes = []
    if tool.width:
        sizes.append(_("width {width}").format(width=show(part, tool.width)))
    else:
        sizes.append(_(HANDS[tool.hand]))
        sizes += [
            _("front {front_clearance:g}°").format(front_clearance=tool.front_clearance),
            _("back {back_clearance:g}°").format(back_clearance=tool.back_clearance),
        ]
    if tool.nose_radius:
        sizes.append(_("nose R{nose_radius}").format(nose_radius=show(part, tool.nose_radius)))
    if tool.offset_z or tool.offset_x:
        sizes.append(
            _("off z {offset_z}, Ø {number}").format(
                offset_z=_number(tool.offset_z), number=_number(2 * tool.offset_x)
            )
        )
    return [tool.name, *sizes]


def _legend(scene: Scene, legend: Sequence[Legend]) -> None:
    """What the lines mean."""
    left = LEGEND_BLOCK + 2.5
    _heading(scene, left, _("Legend"))
    for row, entry in enumerate(legend):
        y = TITLE_TOP - 10.5 - row * ROW
        if entry.pen is not None:
            scene.line(entry.pen, (left, y), (left + 7, y))
        else:
            low, high = (left, y - 1.4), (left + 7, y + 1.4)
            scene.area(entry.fill, low, (high[0], low[1]), high, (low[0], high[1]))
        scene.text(Text((left + 8.5, y), _(entry.text), 2.4))
    for row, note in enumerate((_("zero: front face, axis"), _("lengths from zero"))):
        y = TITLE_TOP - 12.5 - (len(legend) + row) * ROW
        scene.text(Text((left, y), note, 2.4, color=GREY))


def _title(scene: Scene, report: PlanReport, view: View) -> None:
    """Name, stock, cutting data, time."""
    part, units = report.part, report.part.units
    left = TITLE_BLOCK + 3
    scene.text(Text((left, TITLE_TOP - 6.5), part.name, LARGE, bold=True))
    factor = view.factor
    scale = f"{factor:.3g}:1" if factor >= 1 else f"1:{1 / factor:.3g}"
    allowance = (
        _(" + {allowance} raw").format(allowance=show(part, part.stock.allowance))
        if part.stock.allowance
        else ""
    )
    cut = part.cut
    spring = (
        _(", {spring_passes} spring").format(spring_passes=cut.spring_passes)
        if cut.spring_passes
        else ""
    )
    stock = f"Ø{show(part, part.stock.diameter)} x {show(part, part.stock.length)}{allowance}"
    share = _("{share:.0%} in the cut").format(share=report.timing.share)
    rows = (
        (_("stock"), f"{stock} {units}"),
        (
            _("depth of cut"),
            _("{depth_of_cut} {units}, retract {retract}").format(
                depth_of_cut=_number(cut.depth_of_cut), units=units, retract=_number(cut.retract)
            ),
        ),
        (
            _("finish"),
            _("{finish_allowance} {units} left{spring}").format(
                finish_allowance=_number(cut.finish_allowance), units=units, spring=spring
            ),
        ),
        (
            _("feed"),
            _("{feed} {units}/min, finish {finish_feed}").format(
                feed=_number(cut.feed), units=units, finish_feed=_number(cut.finish_feed)
            ),
        ),
        (_("spindle"), _spindle(part)),
        (
            _("time"),
            _("about {total}, {share}").format(total=show_time(report.timing.total), share=share),
        ),
        (
            _("machine"),
            _("{machine}, step {report}").format(
                machine=report.scale.machine.name, report=_step(report)
            ),
        ),
        (_("scale"), _("{scale} on A4, {units}").format(scale=scale, units=units)),
    )
    for row, (name, value) in enumerate(rows):
        y = TITLE_TOP - 14.0 - row * ROW
        scene.text(Text((left, y), name, SMALL, color=GREY))
        room = FRAME[1][0] - left - 24
        scene.text(Text((left + 22, y), _shortened(value, room, SMALL), SMALL))


def _number(value: float) -> str:
    """A number as short as it can be."""
    return f"{value:g}"


def _step(report: PlanReport) -> str:
    """The size of a step."""
    machine = report.scale.machine
    if machine.step_x_nm == machine.step_z_nm:
        return f"{machine.step_z_nm / 1000:g} µm"
    return f"X {machine.step_x_nm / 1000:g}, Z {machine.step_z_nm / 1000:g} µm"


def _spindle(part: Part) -> str:
    """The advised speeds, each once."""
    speeds: list[int] = []
    for operation in part.ordered:
        speed = operation.cut.spindle
        if speed and speed not in speeds and not isinstance(operation.shape, Pause):
            speeds.append(speed)
    return (
        _("{list} rev/min").format(list=", ".join(map(str, speeds))) if speeds else _("no advice")
    )
