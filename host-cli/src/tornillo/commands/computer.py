# SPDX-License-Identifier: Apache-2.0
"""Verbs that change the computer and not the lathe."""

from pathlib import Path

import click

from tornillo.udev import RULE, RULES_FOLDER, install_rule


@click.command()
@click.option("--show", is_flag=True, help="Print the rule and change nothing.")
@click.option(
    "--folder",
    type=click.Path(path_type=Path),
    default=RULES_FOLDER,
    show_default=True,
    help="Where to put the rule.",
)
def udev(show: bool, folder: Path) -> None:
    """Let every user of this Linux computer open the port, and keep ModemManager off it.

    Installs a udev rule, which needs root once.

    \b
    Examples: sudo tornillo udev
              tornillo udev --show
    """
    if show:
        click.echo(RULE, nl=False)
        return
    click.echo(f"{install_rule(folder)} written; unplug the lathe and plug it in again")


VERBS = (udev,)
