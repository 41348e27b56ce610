# SPDX-License-Identifier: Apache-2.0
"""The command `tornillo`: a thin layer over the library.

Exit codes: 0 fine, 1 the input or the machine said no (message on stderr), 2 wrong usage.
"""

import sys

import click

from tornillo import __version__
from tornillo.commands import (
    drawing,
    import_dxf,
    moving,
    parts,
    planning,
    running,
    settings,
    system,
)
from tornillo.errors import TornilloError


class TeachingGroup(click.Group):
    """A group that shows a TornilloError with its remedy and exits with 1."""

    def invoke(self, context: click.Context) -> object:
        """Run the chosen verb."""
        try:
            return super().invoke(context)
        except TornilloError as error:
            click.secho(f"Error: {error}", fg="red", err=True)
            click.echo(f"Try: {error.remedy}", err=True)
            sys.exit(1)


@click.group(cls=TeachingGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="tornillo")
@click.option(
    "--port",
    envvar="TORNILLO_PORT",
    metavar="NAME",
    help="Port of the lathe, like /dev/ttyACM0 or COM3, or its serial number; found by its USB id "
    "when left out.",
)
@click.pass_context
def main(context: click.Context, port: str | None) -> None:
    """Check, draw and upload parts for the Tornillo lathe, and run them.

    Start with: tornillo check PART.toml
    """
    context.obj = port


for module in (parts, planning, drawing, import_dxf, running, moving, settings, system):
    for verb in module.VERBS:
        main.add_command(verb)
