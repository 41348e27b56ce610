# SPDX-License-Identifier: Apache-2.0
"""A part as a workshop drawing on A4: stock, finished shape, passes, tools, dimensions, chuck.

The upper half shows how it is cut, the lower half what it becomes.
"""

from pathlib import Path

from tornillo.contour import Arc, Element, Line, Point, distance, turn
from tornillo.dimensioning import Dimensions
from tornillo.drives import Drives
from tornillo.image import CENTRE_UNIT, SegmentKind
from tornillo.language import later
from tornillo.machine import Machine
from tornillo.moves import Move, Pass, Role
from tornillo.outline import outline
from tornillo.part import Part
from tornillo.plan_report import PlanReport
from tornillo.scene import Pen, Scene
from tornillo.scene import Point as Spot
from tornillo.sheet import SHEET, VIEW, Legend, draw_sheet
from tornillo.tool_picture import draw_tool
from tornillo.view import CHUCK_LENGTH, JAW_HEIGHT, View

OUTLINE = Pen(0.5)
SHOULDER = Pen(0.35)
STOCK_EDGE = Pen(0.25, "#8a5a2b", (2.0, 1.2))
CENTRE = Pen(0.18, "#57606a", (6.0, 1.2, 1.2, 1.2))
ROUGHING = Pen(0.2, "#d9822b")
SMOOTHING = Pen(0.25, "#2b8a78")
FINISHING = Pen(0.3, "#c2255c")
RAPID = Pen(0.1, "#4f83b5", (0.9, 0.7))
CHUCK_EDGE = Pen(0.35, "#57606a")
HATCH = Pen(0.13, "#8c959f")
STOCK_FILL, PART_FILL, CHUCK_FILL = "#fbeedd", "#c9d7e6", "#eaeef2"
HATCH_PITCH = 2.2
TOOL_HEIGHT = 9.0
#: How far around the stock rapids are shown, mm on the sheet.
AROUND = 5.0
#: File units and radians: what is no shoulder, and no edge.
TOUCHING, EDGE = 1e-4, 0.05
PENS = {
    Role.ROUGHING: ROUGHING,
    Role.FACING: ROUGHING,
    Role.PLUNGING: ROUGHING,
    Role.SMOOTHING: SMOOTHING,
    Role.FINISHING: FINISHING,
    Role.SPRING: FINISHING,
}
LEGEND = (
    Legend(later("roughing pass"), ROUGHING),
    Legend(later("along the contour"), SMOOTHING),
    Legend(later("finishing pass"), FINISHING),
    Legend(later("rapid"), RAPID),
    Legend(later("raw stock"), STOCK_EDGE),
    Legend(later("finished part"), fill=PART_FILL),
)


def draw_part(part: Part, machine: Machine, path: Path) -> None:
    """Write the drawing of `part` to `path`, .svg or .png.

    Raises TornilloError when .png is wanted and matplotlib is not installed, PartError for a
    shape that the tool cannot cut.
    """
    scene = part_scene(part, machine)
    if path.suffix == ".png":
        from tornillo.scene_png import save_png

        save_png(scene, path)
    else:
        path.write_text(scene.svg(), encoding="utf-8")


def part_scene(part: Part, machine: Machine) -> Scene:
    """The drawing of `part` as it is cut on `machine`."""
    report = PlanReport(part, machine, Drives.usual(machine))
    pieces = outline(part)
    dimensions = Dimensions(part, pieces)
    view = View(part, VIEW, dimensions.room_right, dimensions.room_below)
    scene = Scene(*SHEET)
    _draw_chuck(scene, view, part)
    _draw_material(scene, view, part, pieces)
    _draw_moves(scene, view, report)
    _draw_zero(scene, view, part)
    _draw_tool(scene, view, part)
    dimensions.draw(scene, view)
    draw_sheet(scene, report, view, LEGEND)
    return scene


def _rectangle(low: Spot, high: Spot) -> tuple[Spot, ...]:
    """The corners of a rectangle."""
    (x0, y0), (x1, y1) = low, high
    return (x0, y0), (x1, y0), (x1, y1), (x0, y1)


def _draw_chuck(scene: Scene, view: View, part: Part) -> None:
    """Two jaws that hold the stock, and the body behind them."""
    face, top = view.at(-part.stock.length, part.stock.diameter / 2)
    bottom = 2 * view.centre - top
    body = face - CHUCK_LENGTH * 0.45
    back = face - CHUCK_LENGTH
    body_half = top + JAW_HEIGHT * 0.8 - view.centre
    low, high = (back, view.centre - body_half), (body, view.centre + body_half)
    scene.area(CHUCK_FILL, *_rectangle(low, high))
    _hatch(scene, low, high)
    scene.box(CHUCK_EDGE, low, high)
    scene.area(STOCK_FILL, *_rectangle((body, bottom), (face, top)))
    for jaw_low, jaw_high in ((top, top + JAW_HEIGHT * 0.6), (bottom - JAW_HEIGHT * 0.6, bottom)):
        corners = (body, jaw_low), (face, jaw_high)
        scene.area(CHUCK_FILL, *_rectangle(*corners))
        _hatch(scene, *corners)
        scene.box(CHUCK_EDGE, *corners)


def _hatch(scene: Scene, low: Spot, high: Spot) -> None:
    """Fill a rectangle with lines at 45 degrees."""
    (x0, y0), (x1, y1) = low, high
    offset = HATCH_PITCH
    while offset < (x1 - x0) + (y1 - y0):
        start = (x0 + max(0.0, offset - (y1 - y0)), min(y1, y0 + offset))
        end = (min(x1, x0 + offset), y0 + max(0.0, offset - (x1 - x0)))
        scene.line(HATCH, start, end)
        offset += HATCH_PITCH


def _draw_material(scene: Scene, view: View, part: Part, pieces: tuple[Element, ...]) -> None:
    """The stock pale, the finished part on it with its outline and its edges."""
    stock = part.stock
    low = view.at(-stock.length, -stock.diameter / 2)
    high = view.at(stock.allowance, stock.diameter / 2)
    scene.area(STOCK_FILL, *_rectangle(low, high))
    for body in bodies(pieces):
        upper = view.trace(body)
        around = [*((z, -x) for z, x in reversed(upper)), *upper]
        scene.area(PART_FILL, *(view.at(*corner) for corner in around))
        scene.line(OUTLINE, *(view.at(*corner) for corner in (*around, around[0])))
    for number, piece in enumerate(pieces):
        after = pieces[number + 1] if number + 1 < len(pieces) else None
        if after is None or not smooth(piece, after):
            edge = view.at(piece.end.z, piece.end.x), view.at(piece.end.z, -piece.end.x)
            scene.line(SHOULDER, *edge)
    scene.box(STOCK_EDGE, low, high)


def bodies(pieces: tuple[Element, ...]) -> list[list[Element]]:
    """The outline in front of a parting and behind it."""
    found: list[list[Element]] = [[]]
    for piece in pieces:
        if max(piece.start.x, piece.end.x) < TOUCHING:
            found.append([])
        else:
            found[-1].append(piece)
    return [body for body in found if body]


def smooth(piece: Element, after: Element) -> bool:
    """Whether one piece goes over into the next without an edge."""
    return distance(piece.end, after.start) < TOUCHING and abs(turn(piece, after)) < EDGE


def _draw_moves(scene: Scene, view: View, report: PlanReport) -> None:
    """Every move of every pass in the upper half, rapids first, the last cut on top."""
    passes = report.plan.passes
    for stroke in passes:
        for move in stroke.moves:
            if move.rapid:
                _draw_rapid(scene, view, report, move)
    for stroke in passes:
        _draw_cuts(scene, view, report, stroke)


def _place(report: PlanReport, z: float, x: float) -> Point:
    """A place in steps as one in file units."""
    return Point(z * report.scale.length(1), x * report.scale.diameter(1) / 2)


def _draw_rapid(scene: Scene, view: View, report: PlanReport, move: Move) -> None:
    """A rapid, as far as it is near the stock."""
    stock = report.part.stock
    left, _ = view.at(-stock.length, 0)
    right, top = view.at(stock.allowance, stock.diameter / 2)
    start, end = (view.at(*_place(report, *place)) for place in (move.start, move.end))
    seen = clipped(start, end, ((left, view.centre), (right + AROUND, top + AROUND)))
    if seen is not None:
        scene.line(RAPID, *seen)


def clipped(start: Spot, end: Spot, area: tuple[Spot, Spot]) -> tuple[Spot, Spot] | None:
    """The part of a straight line that lies in a rectangle."""
    first, last = 0.0, 1.0
    for axis in (0, 1):
        way = end[axis] - start[axis]
        low, high = area[0][axis] - start[axis], area[1][axis] - start[axis]
        if abs(way) < 1e-9:
            if low > 0 or high < 0:
                return None
            continue
        enter, leave = sorted((low / way, high / way))
        first, last = max(first, enter), min(last, leave)
    if first >= last:
        return None
    way_x, way_y = end[0] - start[0], end[1] - start[1]
    return (
        (start[0] + first * way_x, start[1] + first * way_y),
        (start[0] + last * way_x, start[1] + last * way_y),
    )


def _draw_cuts(scene: Scene, view: View, report: PlanReport, stroke: Pass) -> None:
    """The cuts of a pass, those that follow each other as one line."""
    line: list[Spot] = []
    for move in stroke.moves:
        if move.rapid:
            if line:
                scene.line(PENS[stroke.role], *line)
            line = []
            continue
        points = [view.at(*place) for place in view.trace([_element(report, move)])]
        line += points[1:] if line else points
    if line:
        scene.line(PENS[stroke.role], *line)


def _element(report: PlanReport, move: Move) -> Element:
    """A cut in file units; steps of X and Z may differ in size, so only lines stay exact."""
    start, end = _place(report, *move.start), _place(report, *move.end)
    if move.kind is SegmentKind.LINE:
        return Line(start, end)
    centre = move.start[0] + move.cz / CENTRE_UNIT, move.start[1] + move.cx / CENTRE_UNIT
    return Arc(start, end, _place(report, *centre), move.kind is SegmentKind.CONVEX)


def _draw_zero(scene: Scene, view: View, part: Part) -> None:
    """The centre line and the mark of part zero."""
    right, _ = view.at(part.stock.allowance, 0)
    left, _ = view.at(-part.stock.length, 0)
    scene.line(CENTRE, (left - CHUCK_LENGTH - 4, view.centre), (right + 6, view.centre))
    x, y = view.at(0, 0)
    size = 2.0
    ring = [(1.0, 0.0), (0.924, 0.383), (0.707, 0.707), (0.383, 0.924), (0.0, 1.0)]
    for sign in (1, -1):
        quarter = [(x + sign * size * a, y + sign * size * b) for a, b in ring]
        scene.area(OUTLINE.color, (x, y), *quarter)
        other = [(x - sign * size * a, y + sign * size * b) for a, b in ring]
        scene.area("#ffffff", (x, y), *other)
        scene.line(Pen(0.25), *quarter)
        scene.line(Pen(0.25), *other)


def _draw_tool(scene: Scene, view: View, part: Part) -> None:
    """The first tool, clear of the stock by the retract, as large as the part is drawn."""
    stock, retract = part.stock, part.cut.retract
    tip = view.at(stock.allowance + retract, stock.diameter / 2 + retract)
    tip = tip[0], min(tip[1], view.area[1][1] - TOOL_HEIGHT - 0.5)
    first = next((op.tool for op in part.ordered if op.type not in ("pause", "drill")), None)
    draw_tool(scene, first or part.tools[0], tip, view.size(1), TOOL_HEIGHT)
