# SPDX-License-Identifier: Apache-2.0
"""The verb import-dxf."""

import re
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tornillo.commands.connection import machine_option
from tornillo.commands.progress import busy
from tornillo.errors import DrawingError, TornilloError
from tornillo.language import _
from tornillo.machine import Machine
from tornillo.protocol import NAME_LENGTH

if TYPE_CHECKING:
    from tornillo.dxf.importer import Import
    from tornillo.dxf.options import Cutting, View

ABOVE_ZERO = click.FloatRange(min=0, min_open=True)
NOT_BELOW_ZERO = click.FloatRange(min=0)
DEGREES = click.FloatRange(min=0, max=90)
PICTURES = (".svg", ".png")
TOOL_NAME, TOOL_NAME_LENGTH = "profiling", 12


def _options(*options: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Several options as one decorator, in their order."""

    def add(function: Any) -> Any:
        for option in reversed(options):
            function = option(function)
        return function

    return add


def _length(name: str, text: str) -> Callable[[Any], Any]:
    """An option with a length above 0."""
    return click.option(name, type=ABOVE_ZERO, metavar="LENGTH", help=text)


def _name_of(most: int) -> Callable[[Any, Any, str | None], str | None]:
    """A check that a name has 1 to `most` of the characters a lathe can show."""

    def checked(_context: Any, _option: Any, name: str | None) -> str | None:
        if name is not None and not re.fullmatch(f"[a-z0-9-]{{1,{most}}}", name):
            raise click.BadParameter(
                _("use 1 to {most} of the characters a-z, 0-9 and -").format(most=most)
            )
        return name

    return checked


view_options = _options(
    click.option(
        "--layer",
        "layers",
        multiple=True,
        metavar="NAME",
        help="Take only this layer; may be repeated. All visible layers when left out.",
    ),
    click.option(
        "--units",
        type=click.Choice(["mm", "inch", "um", "cm", "dm", "m", "mil", "foot"]),
        help="Unit of the drawing; $INSUNITS of the drawing when left out.",
    ),
    click.option("--scale", type=ABOVE_ZERO, default=1.0, help="Make the part larger or smaller."),
    click.option(
        "--spindle",
        type=click.Choice(["x", "y"]),
        default="x",
        show_default=True,
        help="Direction of the spindle in the drawing. With y, upper means right, right the top.",
    ),
    click.option(
        "--axis", type=float, metavar="PLACE", help="Spindle axis, in drawing units; found else."
    ),
    click.option(
        "--half",
        type=click.Choice(["auto", "upper", "lower"]),
        default="auto",
        help="Half to turn, when both are drawn and differ.",
    ),
    click.option(
        "--free-end",
        type=click.Choice(["auto", "right", "left"]),
        default="auto",
        help="End away from the chuck; the one with the smaller diameter when left out.",
    ),
    click.option("--mirror", is_flag=True, help="The other end than the one found is free."),
    click.option(
        "--front", type=float, metavar="PLACE", help="z = 0, in drawing units; the free end else."
    ),
    _length("--length", "Turn only this much behind z = 0."),
    _length("--tolerance", "Largest deviation of splines and ellipses; half a step when left out."),
    _length("--snap", "Join ends up to this far apart.  [default: 0.01 mm or 0.0004 inch]"),
)

cutting_options = _options(
    click.option(
        "--name",
        callback=_name_of(NAME_LENGTH),
        metavar="NAME",
        help="Name of the part; that of the file else.",
    ),
    _length("--stock-diameter", "Raw bar; the part's largest diameter, rounded up, else."),
    _length("--stock-length", "Free in front of the chuck; 5 mm more than the part else."),
    click.option(
        "--allowance",
        type=NOT_BELOW_ZERO,
        default=0.0,
        metavar="LENGTH",
        help="Raw material in front of z = 0; it is faced off.",
    ),
    _length("--depth-of-cut", "Radial, per pass.  [default: 0.5 mm]"),
    click.option(
        "--finish-allowance",
        type=NOT_BELOW_ZERO,
        metavar="LENGTH",
        help="Radial, for the last pass.  [default: 0.1 mm]",
    ),
    _length("--feed", "Per minute, roughing.  [default: 120 mm]"),
    _length("--finish-feed", "Per minute, last pass.  [default: 60 mm]"),
    _length("--retract", "From the work in rapid moves.  [default: 0.5 mm]"),
    click.option("--rpm", "spindle_speed", type=ABOVE_ZERO, metavar="RPM", help="Noted as advice."),
    click.option(
        "--tool",
        "tool_name",
        callback=_name_of(TOOL_NAME_LENGTH),
        metavar="NAME",
        help="Name of the tool.",
    ),
    click.option(
        "--hand",
        type=click.Choice(["right", "left", "neutral"]),
        default="right",
        help="Of the tool.",
    ),
    click.option(
        "--front-clearance",
        type=click.FloatRange(-90, 90),
        default=3.0,
        show_default=True,
        metavar="DEGREES",
        help="How far the leading edge leans back.",
    ),
    click.option(
        "--back-clearance",
        type=DEGREES,
        default=30.0,
        show_default=True,
        metavar="DEGREES",
        help="Steepest fall towards the chuck that the tool can follow.",
    ),
    click.option(
        "--nose-radius", type=NOT_BELOW_ZERO, default=0.0, metavar="LENGTH", help="Of the tool."
    ),
)


@click.command("import-dxf")
@click.argument("file", type=click.Path(dir_okay=False))
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(dir_okay=False),
    metavar="PART.toml",
    help="Part file to write.",
)
@click.option("--force", is_flag=True, help="Overwrite files that exist.")
@click.option(
    "--picture",
    type=click.Path(dir_okay=False),
    metavar="OUT.svg|OUT.png",
    help="Show what was read; a problem is drawn beside the output even without this.",
)
@view_options
@cutting_options
@machine_option
def import_dxf(
    file: str, output: str, force: bool, picture: str | None, machine: str, **said: Any
) -> None:
    """Make a part file from the outline in the DXF drawing FILE.

    Draw one half of the section, or both; lengths are in the units of the part file.

    \b
    Example: tornillo import-dxf pawn.dxf -o pawn.toml --back-clearance 52
    """
    from tornillo.dxf.importer import Import

    if picture and Path(picture).suffix not in PICTURES:
        raise click.BadParameter(_("the picture must end in .svg or .png"), param_hint="--picture")
    for path in (output, picture):
        if path and Path(path).exists() and not force:
            raise TornilloError(
                _("{path} exists already").format(path=path),
                _("choose another name, or add --force"),
            )
    task = Import(Path(file), _view(said), Machine.load(machine))
    try:
        with busy(_("reading the drawing")):
            text = task.part_text(_cutting(said))
    except DrawingError as error:
        _show_problem(task, error, Path(picture or f"{output.removesuffix('.toml')}.problem.svg"))
        raise
    try:
        Path(output).write_text(text, encoding="utf-8")
    except OSError as error:
        raise TornilloError(
            _("{output} cannot be written: {strerror}").format(
                output=output, strerror=error.strerror
            ),
            _("choose another place"),
        ) from error
    _tell(task, output)
    if picture:
        _save(
            task,
            _("{file}, as {output}").format(file=file, output=output),
            task.remarks,
            (),
            Path(picture),
        )


def _view(said: dict[str, Any]) -> "View":
    """What was said about the drawing."""
    from tornillo.dxf.options import View

    return View(**{entry.name: said[entry.name] for entry in fields(View)})


def _cutting(said: dict[str, Any]) -> "Cutting":
    """What was said about stock, cutting data and tool; an unusual tool gets a name."""
    from tornillo.dxf.options import Cutting, Tool

    usual = Tool()
    shape = {entry.name: said[entry.name] for entry in fields(Tool) if entry.name != "name"}
    tool = Tool(name=said["tool_name"] or usual.name, **shape)
    if tool != usual and not said["tool_name"]:
        tool = replace(tool, name=TOOL_NAME)
    known = {entry.name: said[entry.name] for entry in fields(Cutting) if entry.name != "tool"}
    return Cutting(tool=tool, **known)


def _tell(task: "Import", output: str) -> None:
    """What was written, and what was decided on the way."""
    contour = task.contour
    assert contour is not None
    assert task.paper is not None
    units = task.paper.units
    arcs = sum(1 for segment in contour.segments if segment.center)
    click.echo(
        _(
            "{output} written: {segments} lines and {arcs} arcs, {length:.4g} {units} "
            "long, largest diameter {largest_diameter:.4g} {units}"
        ).format(
            output=output,
            segments=len(contour.segments) - arcs,
            arcs=arcs,
            length=contour.length,
            units=units,
            largest_diameter=contour.largest_diameter,
        )
    )
    for remark in task.remarks:
        click.echo(f"  {remark}")
    click.echo(_("next: tornillo check {output}").format(output=output))


def _show_problem(task: "Import", error: DrawingError, path: Path) -> None:
    """Draw the place of a problem, when it has one."""
    if error.marks:
        title = _("{path} cannot be imported").format(path=task.path.name)
        _save(
            task,
            title,
            (str(error), _("Try: {remedy}").format(remedy=error.remedy)),
            error.marks,
            path,
        )


def _save(task: "Import", title: str, lines: Any, marks: Any, path: Path) -> None:
    """Write the picture and say so."""
    from tornillo.dxf.picture import save_picture

    save_picture(task, title, lines, marks, path)
    click.echo(_("{path} shows it").format(path=path), err=bool(marks))


VERBS = (import_dxf,)
