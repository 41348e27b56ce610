# SPDX-License-Identifier: Apache-2.0
"""Verbs that change what the chip remembers about the machine: settings, zero."""

import difflib
import math

import click

from tornillo.commands.completion import complete_settings
from tornillo.commands.connection import connected, json_option, print_json, print_table
from tornillo.errors import TornilloError
from tornillo.language import _
from tornillo.protocol import SETTINGS, Axis, Setting
from tornillo.units import NM_PER_UNIT, Scale

units_option = click.option(
    "--units",
    type=click.Choice(list(NM_PER_UNIT)),
    default="mm",
    show_default=True,
    help="Units of the position.",
)


@click.group(invoke_without_command=True)
@json_option
@click.pass_context
def settings(context: click.Context, as_json: bool) -> None:
    """List the settings of the lathe, or get or set one.

    \b
    Examples: tornillo settings
              tornillo settings get zero_z
              tornillo settings set rapid_rate_x 900
    """
    if context.invoked_subcommand is not None:
        return
    with connected() as lathe:
        found = lathe.settings()
    rows = [
        {
            "name": entry.id.name.lower(),
            "value": data.value,
            "unit": entry.unit,
            "minimum": data.minimum,
            "maximum": data.maximum,
            "meaning": _(entry.meaning),
        }
        for entry, data in found
    ]
    if as_json:
        print_json(rows)
    else:
        print_table(rows)


@settings.command("get")
@click.argument("name", shell_complete=complete_settings)
def get_setting(name: str) -> None:
    """Print the value of NAME alone.

    \b
    Example: tornillo settings get travel_z
    """
    entry = _named(name)
    with connected() as lathe:
        click.echo(lathe.setting(entry.id).value)


@settings.command("set", context_settings={"ignore_unknown_options": True})
@click.argument("name", shell_complete=complete_settings)
@click.argument("value", type=int)
def set_setting(name: str, value: int) -> None:
    """Change NAME to VALUE and store it in the lathe.

    \b
    Example: tornillo settings set rapid_rate_x 900
    """
    entry = _named(name)
    with connected() as lathe:
        now = lathe.setting(entry.id)
        if not now.minimum <= value <= now.maximum:
            raise TornilloError(
                _("{name} cannot be {value}: it goes from {minimum} to {maximum} {unit}")
                .format(
                    name=name,
                    value=value,
                    minimum=now.minimum,
                    maximum=now.maximum,
                    unit=entry.unit,
                )
                .rstrip(),
                _("choose a value in this range; now it is {now}").format(now=now.value),
            )
        lathe.set_setting(entry.id, value)
    click.echo(
        _("{name} was {now}, is {value} {unit}")
        .format(name=name, now=now.value, value=value, unit=entry.unit)
        .rstrip()
    )


def _named(name: str) -> Setting:
    """The setting called `name`; raises TornilloError with the nearest name."""
    known = {entry.id.name.lower(): entry for entry in SETTINGS}
    if name.lower() not in known:
        close = difflib.get_close_matches(name.lower(), known, n=1)
        remedy = (
            _('did you mean "{close}"?').format(close=close[0])
            if close
            else _("see `tornillo settings`")
        )
        raise TornilloError(_('there is no setting "{name}"').format(name=name), remedy)
    return known[name.lower()]


@click.group()
def zero() -> None:
    """Tell the lathe where the tool stands, in part coordinates.

    Turn a diameter or the face, leave that slide where it is, measure, and type what you have
    measured. The part zero is stored in the lathe. With a contact sensor: `tornillo touch`.

    \b
    Examples: tornillo zero x --diameter 25.4
              tornillo zero z --at 0 --units inch
    """


def finite(_context: click.Context, _option: click.Parameter, value: float | None) -> float | None:
    """Refuse nan and inf."""
    if value is not None and not math.isfinite(value):
        raise click.BadParameter(_("must be an ordinary number"))
    return value


@zero.command("x")
@click.option(
    "--diameter",
    type=click.FloatRange(min=0),
    required=True,
    callback=finite,
    help="Diameter that the tool touches.",
)
@units_option
def zero_x(diameter: float, units: str) -> None:
    """The tool touches this diameter.

    \b
    Example: tornillo zero x --diameter 25.4
    """
    with connected() as lathe:
        scale = Scale(units, lathe.machine())
        lathe.zero(Axis.X, scale.radius_steps(diameter))
    click.echo(_("X: the tool stands at diameter {diameter}").format(diameter=scale.show(diameter)))


@zero.command("z")
@click.option("--at", type=float, required=True, callback=finite, help="z where the tool stands.")
@units_option
def zero_z(at: float, units: str) -> None:
    """The tool stands at this z; 0 is the finished front face.

    \b
    Example: tornillo zero z --at 0 --units inch
    """
    with connected() as lathe:
        scale = Scale(units, lathe.machine())
        lathe.zero(Axis.Z, scale.z_steps(at))
    click.echo(_("Z: the tool stands at z = {at}").format(at=scale.show(at)))


VERBS = (settings, zero)
