# SPDX-License-Identifier: Apache-2.0
"""A part as a workshop drawing on A4: stock, finished shape, passes, dimensions, chuck."""

from pathlib import Path

from tornillo.dimensions import across, along
from tornillo.machine import Machine
from tornillo.part import Cylinder, Face, Part
from tornillo.scene import Pen, Point, Scene
from tornillo.shape import finished, passes
from tornillo.sheet import SHEET, VIEW, draw_sheet
from tornillo.units import NM_PER_UNIT, Scale

OUTLINE = Pen(0.5)
STOCK_EDGE = Pen(0.25, "#8a5a2b", (2.0, 1.2))
CENTRE = Pen(0.18, "#57606a", (6.0, 1.2, 1.2, 1.2))
ROUGHING = Pen(0.2, "#d9822b")
FINISHING = Pen(0.3, "#c2255c")
CHUCK_EDGE = Pen(0.35, "#57606a")
HATCH = Pen(0.13, "#8c959f")
STOCK_FILL, PART_FILL, CHUCK_FILL, TOOL_FILL = "#fbeedd", "#c9d7e6", "#eaeef2", "#6e7781"
SCALES = (20.0, 10.0, 5.0, 4.0, 3.0, 2.5, 2.0, 1.5, 1.0, 0.5, 0.25, 0.2, 0.1, 0.05)
CHUCK_LENGTH, JAW_HEIGHT, HATCH_PITCH = 20.0, 11.0, 2.2
FIRST_ROW, ROW = 9.0, 7.5


class View:
    """Where steps and lengths of the part land on the sheet."""

    def __init__(self, part: Part, machine: Machine, columns: int, rows: int) -> None:
        """Choose the largest usual scale; leave room for dimension `columns` and `rows`."""
        self.image = part.steps(machine)
        self.scale = Scale(part.units, machine)
        header = self.image.header
        self.x_mm = machine.step_x_nm / NM_PER_UNIT["mm"]
        self.z_mm = machine.step_z_nm / NM_PER_UNIT["mm"]
        (left, low), (right, high) = VIEW
        room_x = right - left - CHUCK_LENGTH - FIRST_ROW - ROW * columns
        room_y = high - low - JAW_HEIGHT - max(JAW_HEIGHT, FIRST_ROW + ROW * rows)
        length = (header.stock_length + header.stock_front) * self.z_mm
        diameter = 2 * header.stock_radius * self.x_mm
        fits = min(room_x / length, room_y / diameter)
        self.factor = next((value for value in SCALES if value <= fits), fits)
        used = CHUCK_LENGTH + length * self.factor + FIRST_ROW + ROW * columns
        start = left + (right - left - used) / 2 + CHUCK_LENGTH
        self.origin_x = start + header.stock_length * self.z_mm * self.factor
        below = max(JAW_HEIGHT, FIRST_ROW + ROW * rows)
        spare = high - low - JAW_HEIGHT - below - diameter * self.factor
        self.centre = low + below + spare / 2 + diameter * self.factor / 2

    def at(self, z: int, x: int) -> Point:
        """The place of a point in steps; `x` below 0 is the lower half."""
        return (
            self.origin_x + z * self.z_mm * self.factor,
            self.centre + x * self.x_mm * self.factor,
        )


def draw_part(part: Part, machine: Machine, path: Path) -> None:
    """Write the drawing of `part` to `path`, .svg or .png.

    Raises TornilloError when .png is wanted and matplotlib is not installed.
    """
    scene = part_scene(part, machine)
    if path.suffix == ".png":
        from tornillo.scene_png import save_png

        save_png(scene, path)
    else:
        path.write_text(scene.svg(), encoding="utf-8")


def part_scene(part: Part, machine: Machine) -> Scene:
    """The drawing of `part` as it is cut on `machine`."""
    diameters = sorted({op.diameter for op in part.operations if op.diameter > 0})
    lengths = _lengths(part)
    view = View(part, machine, len(diameters) + 1, len(lengths))
    scene = Scene(*SHEET)
    _draw_chuck(scene, view)
    _draw_material(scene, view)
    _draw_passes(scene, view)
    _draw_zero(scene, view)
    _draw_tool(scene, view)
    _draw_dimensions(scene, view, part, diameters, lengths)
    draw_sheet(scene, part, machine, view.factor, (ROUGHING, FINISHING, STOCK_EDGE, PART_FILL))
    return scene


def _lengths(part: Part) -> list[float]:
    """Every z that is dimensioned from part zero, nearest first."""
    found = {op.z_end for op in part.operations if isinstance(op, Cylinder)}
    found |= {op.z for op in part.operations if isinstance(op, Face)}
    found |= {op.z_start for op in part.operations if isinstance(op, Cylinder)}
    found |= {part.stock.allowance, -part.stock.length}
    return sorted(found - {0.0}, key=abs)


def _rectangle(low: Point, high: Point) -> tuple[Point, ...]:
    """The corners of a rectangle."""
    (x0, y0), (x1, y1) = low, high
    return (x0, y0), (x1, y0), (x1, y1), (x0, y1)


def _draw_chuck(scene: Scene, view: View) -> None:
    """Two jaws that hold the stock, and the body behind them."""
    header = view.image.header
    face, top = view.at(-header.stock_length, header.stock_radius)
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


def _hatch(scene: Scene, low: Point, high: Point) -> None:
    """Fill a rectangle with lines at 45 degrees."""
    (x0, y0), (x1, y1) = low, high
    offset = HATCH_PITCH
    while offset < (x1 - x0) + (y1 - y0):
        start = (x0 + max(0.0, offset - (y1 - y0)), min(y1, y0 + offset))
        end = (min(x1, x0 + offset), y0 + max(0.0, offset - (x1 - x0)))
        scene.line(HATCH, start, end)
        offset += HATCH_PITCH


def _draw_material(scene: Scene, view: View) -> None:
    """The stock pale, the finished part on it with its outline."""
    header = view.image.header
    low = view.at(-header.stock_length, -header.stock_radius)
    high = view.at(header.stock_front, header.stock_radius)
    scene.area(STOCK_FILL, *_rectangle(low, high))
    sections = finished(view.image)
    upper = [(z, section.radius) for section in sections for z in (section.z_front, section.z_back)]
    corners = [(z, -x) for z, x in reversed(upper)]
    scene.area(PART_FILL, *(view.at(*corner) for corner in (*upper, *corners)))
    outline = [*corners, *upper]
    scene.line(OUTLINE, *(view.at(*corner) for corner in outline))
    for section in sections:
        edge = view.at(section.z_back, section.radius), view.at(section.z_back, -section.radius)
        scene.line(Pen(0.35), *edge)
    scene.box(STOCK_EDGE, low, high)


def _draw_passes(scene: Scene, view: View) -> None:
    """Every pass as a line in the upper half."""
    for stroke in passes(view.image):
        pen = FINISHING if stroke.finishing else ROUGHING
        scene.line(pen, view.at(*stroke.start), view.at(*stroke.end))


def _draw_zero(scene: Scene, view: View) -> None:
    """The centre line and the mark of part zero."""
    header = view.image.header
    right, _ = view.at(header.stock_front, 0)
    left, _ = view.at(-header.stock_length, 0)
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


def _draw_tool(scene: Scene, view: View) -> None:
    """A right-hand tool, clear of the stock by the retract."""
    header = view.image.header
    tip_x, tip_y = view.at(
        header.stock_front + header.retract, header.stock_radius + header.retract
    )
    scene.area(
        TOOL_FILL,
        (tip_x, tip_y),
        (tip_x + 0.8, tip_y + 7.5),
        (tip_x + 6.0, tip_y + 7.5),
        (tip_x + 6.0, tip_y + 3.4),
    )


def _draw_dimensions(
    scene: Scene, view: View, part: Part, diameters: list[float], lengths: list[float]
) -> None:
    """Diameters to the right, lengths from part zero below."""
    header = view.image.header
    right, _ = view.at(header.stock_front, 0)
    for column, diameter in enumerate([*diameters, part.stock.diameter]):
        steps = view.scale.radius_steps(diameter)
        edge, high = view.at(_front_of(view, steps), steps)
        place = right + FIRST_ROW + ROW * column
        span = 2 * view.centre - high, high
        across(scene, span, edge, place, f"Ø{show(part, diameter)}")
    zero, bottom = view.at(0, -header.stock_radius)
    for row, z in enumerate(lengths):
        other, _ = view.at(view.scale.z_steps(z), 0)
        span = min(zero, other), max(zero, other)
        place = bottom - FIRST_ROW - ROW * row
        along(scene, span, bottom - 1, place, show(part, abs(z)))


def _front_of(view: View, radius: int) -> int:
    """The z where the finished part first has `radius` or more."""
    sections = finished(view.image)
    return next((piece.z_front for piece in sections if piece.radius >= radius), 0)


def show(part: Part, value: float) -> str:
    """A number as a machinist writes it in the units of the file."""
    if part.units == "inch":
        return f"{value:.3f}"
    return f"{value:.3f}".rstrip("0").rstrip(".")
