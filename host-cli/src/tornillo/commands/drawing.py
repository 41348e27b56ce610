# SPDX-License-Identifier: Apache-2.0
"""The verb draw."""

from pathlib import Path

import click

from tornillo.commands.connection import machine_option
from tornillo.commands.progress import busy
from tornillo.language import _
from tornillo.machine import Machine
from tornillo.part import Part


@click.command()
@click.argument("file", type=click.Path(dir_okay=False))
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(dir_okay=False),
    metavar="OUT.svg|OUT.png",
    help="Picture to write; its ending chooses the format.",
)
@machine_option
def draw(file: str, output: str, machine: str) -> None:
    """Draw FILE: stock, finished shape, passes and dimensions.

    \b
    Examples: tornillo draw examples/test-bar.toml -o test-bar.svg
              tornillo draw examples/test-bar.toml -o test-bar.png
    """
    from tornillo.drawing import draw_part

    if Path(output).suffix not in (".svg", ".png"):
        raise click.BadParameter(_("the picture must end in .svg or .png"), param_hint="--output")
    part = Part.load(file)
    known = Machine.load(machine)
    part.check(known)
    with busy(_("drawing")):
        draw_part(part, known, Path(output))
    click.echo(_("{output} written").format(output=output))


VERBS = (draw,)
