# SPDX-License-Identifier: Apache-2.0
"""Verbs about the connection: the serial number of the lathe, the udev rule of Linux."""

import secrets
from pathlib import Path

import click

from tornillo import udev as udev_rule
from tornillo.commands.connection import connected, json_option, print_json
from tornillo.language import _
from tornillo.protocol import SERIAL_LENGTH

#: Letters and digits that are not taken for one another.
CHARACTERS = "23456789ABCDEFGHJKLMNPQRSTUVWXYZ"
PREFIX = "TN"


@click.command()
@click.argument("new", required=False)
@click.option("--random", "at_random", is_flag=True, help="Choose a new number at random.")
@json_option
def serial(new: str | None, at_random: bool, as_json: bool) -> None:
    """Show the serial number of the lathe, or change it to NEW (8 characters).

    With numbers of their own several lathes can be told apart: `tornillo --port NUMBER ...`.

    \b
    Examples: tornillo serial
              tornillo serial LATHE-07
              tornillo serial --random
    """
    if new is not None and at_random:
        raise click.UsageError(_("give either a number or --random"))
    if at_random:
        new = random_number()
    with connected() as lathe:
        old = lathe.serial_number
        if new is not None:
            lathe.set_serial_number(new)
    if as_json:
        print_json({"serial_number": new or old, "before": old})
        return
    if new is None:
        click.echo(old)
        return
    click.echo(_("serial number was {old}, is {new}").format(old=old, new=new))
    click.echo(_("the computer sees it when the cable is plugged in again"), err=True)


def random_number() -> str:
    """A serial number that hardly any other lathe has: one of a thousand million."""
    chosen = (secrets.choice(CHARACTERS) for _ in range(SERIAL_LENGTH - len(PREFIX)))
    return PREFIX + "".join(chosen)


@click.command()
@click.option("--install", is_flag=True, help="Write it to /etc/udev/rules.d; needs sudo.")
@click.option(
    "--root",
    type=click.Path(path_type=Path, file_okay=False),
    default=udev_rule.ROOT,
    help="With --install: the system to write to, for images of other machines.",
)
def udev(install: bool, root: Path) -> None:
    """Print the udev rule for Linux, or install it.

    It lets users open the lathe's port and keeps ModemManager away from it.

    \b
    Examples: tornillo udev
              sudo "$(command -v tornillo)" udev --install
    """
    if not install:
        click.echo(udev_rule.rule(), nl=False)
        return
    path = udev_rule.install(root)
    click.echo(_("{path} written; unplug the lathe and plug it in again").format(path=path))


VERBS = (serial, udev)
