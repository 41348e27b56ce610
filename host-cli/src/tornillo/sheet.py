# SPDX-License-Identifier: Apache-2.0
"""The sheet around a drawing: frame, title block, legend, list of operations."""

from tornillo.machine import Machine
from tornillo.part import Cut, Cylinder, Part
from tornillo.scene import Pen, Point, Scene, Text
from tornillo.shape import Pass, passes

SHEET = (297.0, 210.0)
FRAME: tuple[Point, Point] = ((8.0, 8.0), (289.0, 202.0))
TITLE_TOP = 52.0
VIEW: tuple[Point, Point] = ((12.0, TITLE_TOP + 3.0), (285.0, 199.0))
BORDER, RULE = Pen(0.5), Pen(0.2)
LEFT_BLOCK, RIGHT_BLOCK = 108.0, 190.0
SMALL, NORMAL, LARGE = 2.9, 3.2, 6.5
ROWS, ROW = 7, 4.6
GREY = "#57606a"


def draw_sheet(
    scene: Scene, part: Part, machine: Machine, factor: float, styles: tuple[Pen, Pen, Pen, str]
) -> None:
    """Draw everything that is not the part; `factor` is the scale of the drawing."""
    (left, low), (right, high) = FRAME
    scene.box(BORDER, (left, low), (right, high))
    scene.line(BORDER, (left, TITLE_TOP), (right, TITLE_TOP))
    for x in (LEFT_BLOCK, RIGHT_BLOCK):
        scene.line(RULE, (x, low), (x, TITLE_TOP))
    _operations(scene, part, machine)
    _legend(scene, styles)
    _title(scene, part, machine, factor)


def _operations(scene: Scene, part: Part, machine: Machine) -> None:
    """What is cut, in order, with the number of passes."""
    strokes = passes(part.steps(machine))
    left = FRAME[0][0] + 3
    _heading(scene, left, f"Operations ({part.units})")
    shown = part.operations if len(part.operations) <= ROWS else part.operations[: ROWS - 1]
    lines = []
    for position, operation in enumerate(shown, start=1):
        number = f"{position:2d}  {operation.type}"
        if isinstance(operation, Cylinder):
            place = f"z {operation.z_start:g} to {operation.z_end:g}, Ø{operation.diameter:g}"
        else:
            place = f"z {operation.z:g}, to Ø{operation.diameter:g}"
        lines.append(f"{number}: {place}; {_count(strokes, position)}")
    if len(shown) < len(part.operations):
        lines.append(f"    and {len(part.operations) - len(shown)} more")
    for row, line in enumerate(lines):
        scene.text(Text((left, TITLE_TOP - 11 - row * ROW), line, SMALL))


def _count(strokes: list[Pass], position: int) -> str:
    """How many passes an operation takes."""
    mine = [stroke for stroke in strokes if stroke.operation == position]
    roughing = sum(not stroke.finishing for stroke in mine)
    text = f"{roughing} {'pass' if roughing == 1 else 'passes'}"
    return f"{text} + finish" if len(mine) > roughing else text


def _legend(scene: Scene, styles: tuple[Pen, Pen, Pen, str]) -> None:
    """What the lines mean."""
    roughing, finishing, stock, fill = styles
    left = LEFT_BLOCK + 3
    _heading(scene, left, "Legend")
    top = TITLE_TOP - 11
    for row, (pen, text) in enumerate(
        (
            (roughing, "roughing pass"),
            (finishing, "finishing pass"),
            (stock, "raw stock"),
        )
    ):
        y = top - row * ROW
        scene.line(pen, (left, y), (left + 10, y))
        scene.text(Text((left + 13, y), text, SMALL))
    y = top - 3 * ROW
    scene.area(fill, (left, y - 1.5), (left + 10, y - 1.5), (left + 10, y + 1.5), (left, y + 1.5))
    scene.text(Text((left + 13, y), "finished part", SMALL))
    notes = (
        "Part zero: front face, on the axis. Lengths from part zero.",
        "Right-hand tool, feeding towards the chuck.",
    )
    for row, note in enumerate(notes):
        scene.text(Text((left, y - (row + 1.3) * ROW), note, 2.4, color=GREY))


def _title(scene: Scene, part: Part, machine: Machine, factor: float) -> None:
    """Name, stock and cutting data."""
    left = RIGHT_BLOCK + 3
    scene.text(Text((left, TITLE_TOP - 6.5), part.name, LARGE, bold=True))
    cut: Cut = part.cut
    units = part.units
    allowance = f" + {part.stock.allowance:g} raw" if part.stock.allowance else ""
    scale = f"{factor:.3g}:1" if factor >= 1 else f"1:{1 / factor:.3g}"
    rows = (
        ("stock", f"Ø{part.stock.diameter:g} x {part.stock.length:g}{allowance} {units}"),
        ("depth of cut", f"{cut.depth_of_cut:g} {units}, finish {cut.finish_allowance:g}"),
        ("feed", f"{cut.feed:g} {units}/min, finish {cut.finish_feed:g}"),
        ("retract", f"{cut.retract:g} {units}"),
        ("machine", f"{machine.name}, step {machine.step_z_nm / 1000:g} µm"),
        ("scale", f"{scale} on A4"),
    )
    for row, (name, value) in enumerate(rows):
        y = TITLE_TOP - 14.5 - row * ROW
        scene.text(Text((left, y), name, SMALL, color=GREY))
        scene.text(Text((left + 24, y), value, SMALL))


def _heading(scene: Scene, left: float, text: str) -> None:
    """The title of a block."""
    scene.text(Text((left, TITLE_TOP - 5), text, NORMAL, bold=True))
