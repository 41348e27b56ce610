# SPDX-License-Identifier: Apache-2.0
"""Verbs that change what the chip remembers about the machine: settings, zero."""

import math
from pathlib import Path

import click

from tornillo.commands.completion import complete_settings
from tornillo.commands.connection import connected, json_option, print_json, print_table
from tornillo.errors import TornilloError
from tornillo.language import _
from tornillo.lathe import Lathe
from tornillo.machine_file import file_text, load_file
from tornillo.protocol import Axis
from tornillo.setting_names import explained, named, span, unit
from tornillo.settings import Change, outdated_parts, store, store_all
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
    """List the settings of the lathe, get or set one, save or load all.

    \b
    Examples: tornillo settings
              tornillo settings get zero_z
              tornillo settings set rapid_rate_x 900
              tornillo settings save my-lathe.toml
              tornillo settings load my-lathe.toml
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
            "meaning": entry.meaning,
        }
        for entry, data in found
    ]
    if as_json:
        print_json(rows)
        return
    print_table(
        {
            _("name"): entry.id.name.lower(),
            _("value"): data.value,
            _("unit"): unit(entry),
            _("minimum"): data.minimum,
            _("maximum"): data.maximum,
            _("meaning"): _(entry.meaning),
        }
        for entry, data in found
    )


@settings.command("get")
@click.argument("name", shell_complete=complete_settings)
def get_setting(name: str) -> None:
    """Print the value of NAME alone; meaning, range and unit go to stderr.

    \b
    Example: tornillo settings get travel_z
    """
    entry = named(name)
    with connected() as lathe:
        told = lathe.setting(entry.id)
    click.echo(told.value)
    click.echo(explained(entry, told), err=True)


@settings.command("set", context_settings={"ignore_unknown_options": True})
@click.argument("name", shell_complete=complete_settings)
@click.argument("value")
def set_setting(name: str, value: str) -> None:
    """Change NAME to VALUE, a whole number, and store it in the lathe.

    \b
    Example: tornillo settings set rapid_rate_x 900
    """
    entry = named(name)
    try:
        number = int(value)
    except ValueError as error:
        raise click.BadParameter(
            _("{value} is no whole number; {id} goes from {entry}").format(
                value=value, id=entry.id.name.lower(), entry=span(entry)
            ),
            param_hint="VALUE",
        ) from error
    with connected() as lathe:
        change = store(lathe, entry, number)
        click.echo(change)
        _warn_of_parts(lathe, [change])


@settings.command("save")
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path))
@click.option("--force", is_flag=True, help="Write over FILE when it is there.")
def save_settings(file: Path, force: bool) -> None:
    """Write all settings of the lathe to the machine file FILE.

    It is TOML with units and ranges. Every verb with --machine takes it, too.

    \b
    Example: tornillo settings save my-lathe.toml
    """
    if file.exists() and not force:
        raise TornilloError(
            _("{file} is there already").format(file=file), _("name another file, or add --force")
        )
    with connected() as lathe:
        values = {entry.id: data.value for entry, data in lathe.settings()}
        source = _("read from lathe {serial_number}, firmware {firmware}").format(
            serial_number=lathe.serial_number, firmware=lathe.firmware
        )
    try:
        file.write_text(file_text(values, file.stem, source), encoding="utf-8")
    except OSError as error:
        raise TornilloError(
            _("cannot write {file}: {error}").format(file=file, error=error),
            _("choose another place"),
        ) from error
    click.echo(_("{values} settings saved in {file}").format(values=len(values), file=file))


@settings.command("load")
@click.argument("file")
def load_settings(file: str) -> None:
    """Store the settings of the machine file FILE in the lathe.

    The whole file is checked first. Settings that it does not name stay, and only those that differ
    are written. FILE is a path ending in .toml or a machine that comes with tornillo.

    \b
    Example: tornillo settings load my-lathe.toml
    """
    values = load_file(file)
    with connected() as lathe:
        changes = store_all(lathe, values, click.echo)
        click.echo(
            _("{values} settings of {file}: {changes} changed and stored").format(
                values=len(values), file=file, changes=len(changes)
            )
        )
        _warn_of_parts(lathe, changes)


def _warn_of_parts(lathe: Lathe, changes: list[Change]) -> None:
    """Name the parts that a changed step size makes useless."""
    names = outdated_parts(lathe, changes)
    if names:
        click.echo(
            _("made for another step size, refused until uploaded again: {names}").format(
                names=", ".join(names)
            ),
            err=True,
        )


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
