# SPDX-License-Identifier: Apache-2.0
"""The verb calibrate: measure backlash, switch travel and step size, and store what fits."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import click

from tornillo.calibration import Calibration, Known, Programme, Ways, from_steps, from_ways
from tornillo.calibration_report import as_json, axis_named, report
from tornillo.commands.connection import connected, json_option, print_json
from tornillo.commands.following import follow_homing
from tornillo.errors import TornilloError
from tornillo.language import _
from tornillo.lathe import Lathe
from tornillo.lathe_slide import LatheSlide
from tornillo.machine_file import load_file
from tornillo.procedures import APPROACH, block_steps, by_contact, by_gauge
from tornillo.protocol import Axis, SettingId
from tornillo.readings import UM_PER_UNIT, length_um, read_ways
from tornillo.settings import outdated_parts, store_all
from tornillo.touching import still

#: The steps between the marks of examples/three-marks.toml.
FORWARD, BACK = 1050, 950
POLL_S = 0.1

axis_argument = click.argument("axis", type=click.Choice(["x", "z"]))
units_option = click.option(
    "--units",
    type=click.Choice(list(UM_PER_UNIT)),
    default="mm",
    show_default=True,
    help="Units of what is typed or read.",
)
store_option = click.option(
    "--store", is_flag=True, help="Store the recommended settings in the lathe."
)


@click.group()
def calibrate() -> None:
    """Separate backlash from switch travel, and fit the size of a step.

    \b
    Examples: tornillo calibrate marks z
              tornillo calibrate gauge x
              tornillo calibrate contact x
    """


@calibrate.command()
@axis_argument
@click.option(
    "--readings",
    type=click.Path(dir_okay=False, path_type=Path),
    help="File with two lengths a line; asked for when left out.",
)
@click.option("--forward", type=click.IntRange(1), default=FORWARD, show_default=True)
@click.option("--back", type=click.IntRange(1), default=BACK, show_default=True)
@click.option(
    "--machine",
    metavar="NAME",
    help="Take dead steps and settings from this machine file instead of the lathe.",
)
@units_option
@store_option
@json_option
def marks(
    *,
    axis: str,
    readings: Path | None,
    forward: int,
    back: int,
    machine: str | None,
    units: str,
    store: bool,
    as_json: bool,
) -> None:
    """Evaluate specimens with three marks that you have measured.

    Cut examples/three-marks.toml once or more often, and measure from mark 1 to 2 (--forward
    steps) and from 2 to 3 (--back steps).

    \b
    Example: tornillo calibrate marks z --readings measured.txt --store
    """
    if machine is not None and store:
        raise click.UsageError(_("--store needs the lathe; leave --machine out"))
    ways = _asked(units) if readings is None else read_ways(readings, units)
    programme = Programme(forward, back)
    if machine is not None:
        show(from_ways(ways, programme, known_from(machine, axis_named(axis))), as_json)
        return
    with connected() as lathe:
        found = from_ways(ways, programme, known_by(lathe, axis_named(axis)))
        show(found, as_json)
        finish(lathe, found, store)


@calibrate.command()
@axis_argument
@click.option("--rounds", type=click.IntRange(1), default=5, show_default=True)
@click.option("--steps", type=click.IntRange(100), default=1000, show_default=True)
@units_option
@store_option
@json_option
def gauge(*, axis: str, rounds: int, steps: int, units: str, store: bool, as_json: bool) -> None:
    """Measure with a dial gauge that stands against the slide; you type what it shows.

    The tool goes --steps away from the limit switch and back, --rounds times, with 300 steps of
    approach. Home first, and see that this way is free.

    \b
    Example: tornillo calibrate gauge x --store
    """
    with connected() as lathe:
        known = known_by(lathe, axis_named(axis))
        slide = LatheSlide(lathe, known.axis, POLL_S)
        _need_room(lathe, slide, known.axis, steps + APPROACH)
        ways = by_gauge(slide, steps, rounds, _typed(units), _tell)
        found = from_ways(ways, Programme(steps, steps), known)
        show(found, as_json)
        finish(lathe, found, store)


@calibrate.command()
@axis_argument
@click.option("--rounds", type=click.IntRange(1), default=5, show_default=True)
@click.option("--within", type=click.IntRange(1), default=700, show_default=True, metavar="STEPS")
@click.option(
    "--block",
    metavar="LENGTH",
    help="Thickness of a gauge block, to fit the size of a step too.",
)
@units_option
@store_option
@json_option
def contact(
    *,
    axis: str,
    rounds: int,
    within: int,
    block: str | None,
    units: str,
    store: bool,
    as_json: bool,
) -> None:
    """Measure with the contact sensor: touch the work, back off until the contact opens.

    Stand the tool in front of the work, nearer than --within, spindle off, and see that the way
    to the limit switches and back is free: the lathe homes twice, first so that it takes up no
    dead steps, at the end with the setting that then counts.

    \b
    Example: tornillo calibrate contact x --store
    """
    thickness = None if block is None else _thickness(block, units)
    with connected() as lathe:
        known = known_by(lathe, axis_named(axis))
        slide = LatheSlide(lathe, known.axis, POLL_S)
        with uncompensated(lathe, known):
            counted = by_contact(slide, within, rounds)
            sizes = (
                block_steps(slide, within, rounds, thickness, _ready)
                if thickness is not None
                else []
            )
        found = from_steps(counted, known, sizes)
        show(found, as_json)
        finish(lathe, found, store)


@contextmanager
def uncompensated(lathe: Lathe, known: Known) -> Iterator[None]:
    """Home so that the lathe takes up as few dead steps as can be, and go back to this place.

    Afterwards the old setting is stored again, and the lathe homes with it.
    """
    setting = _settings_of(known.axis)[1]
    here = lathe.status()
    highest = lathe.setting(setting).maximum
    most = min(known.dead + known.switch_travel, highest)
    try:
        lathe.set_setting(setting, most)
        _home(lathe)
        lathe.goto(here.x, here.z)
        still(lathe, POLL_S)
        yield
    finally:
        lathe.set_setting(setting, known.switch_travel)
    _home(lathe)


def _home(lathe: Lathe) -> None:
    """Home and wait."""
    _tell(_("homing, X first; Ctrl-C stops"))
    lathe.home()
    follow_homing(lathe)


def _need_room(lathe: Lathe, slide: LatheSlide, axis: Axis, steps: int) -> None:
    """Refuse a way that the slide does not have."""
    machine = lathe.machine()
    travel = machine.travel_x if axis is Axis.X else machine.travel_z
    room = travel + slide.position
    if room < steps:
        raise TornilloError(
            _("the slide has {room} steps of way left, {steps} are needed").format(
                room=room, steps=steps
            ),
            _("move it towards its limit switch (`tornillo jog`), or choose fewer --steps"),
        )


def _typed(units: str) -> Callable[[str], float]:
    """A question for a reading of the gauge, which may also be 0 or negative."""

    def question(text: str) -> float:
        reading = ask(text, units)
        assert reading is not None
        return reading

    return question


def _thickness(block: str, units: str) -> float:
    """The gauge block in micrometres; wrong usage when it has no thickness."""
    try:
        thickness = length_um(block, units)
    except ValueError as error:
        raise click.BadParameter(
            _("{block!r} is no length").format(block=block), param_hint="--block"
        ) from error
    if thickness <= 0:
        raise click.BadParameter(
            _("{block} is no thickness").format(block=block), param_hint="--block"
        )
    return thickness


def _tell(line: str) -> None:
    click.echo(line, err=True)


def _ready(line: str) -> None:
    """Wait until the person has done it."""
    click.prompt(
        _("{line}, then press Enter").format(line=line), default="", show_default=False, err=True
    )


def _asked(units: str) -> list[Ways]:
    """Ask for specimens until nothing is typed."""
    found: list[Ways] = []
    while True:
        number = len(found) + 1
        first = ask(
            _("specimen {number}: mark 1 to 2").format(number=number), units, may_end=bool(found)
        )
        if first is None:
            return found
        second = ask(_("specimen {number}: mark 2 to 3").format(number=number), units)
        assert second is not None
        found.append(Ways(first, second))


def ask(question: str, units: str, may_end: bool = False) -> float | None:
    """Ask for a length until one is typed; micrometres. None: nothing was typed, if that may be."""
    ending = _(", nothing to end") if may_end else ""
    while True:
        typed = click.prompt(
            f"{question} [{units}{ending}]", default="", show_default=False, err=True
        )
        if not typed and may_end:
            return None
        try:
            return length_um(typed, units)
        except ValueError:
            click.echo(
                _("{typed!r} is no number; type a length in {units}").format(
                    typed=typed, units=units
                ),
                err=True,
            )


def known_by(lathe: Lathe, axis: Axis) -> Known:
    """What the lathe goes by; raises TornilloError when it has not been homed."""
    status = lathe.status()
    if not status.homed:
        raise TornilloError(
            _("the lathe is not homed, so its dead steps are not known"), _("`tornillo home` first")
        )
    ids = _settings_of(axis)
    return Known(
        axis,
        lathe.setting(ids[0]).value,
        status.dead_x if axis is Axis.X else status.dead_z,
        lathe.setting(ids[1]).value,
    )


def known_from(machine: str, axis: Axis) -> Known:
    """What a machine file says."""
    values = load_file(machine)
    step, travel, dead = _settings_of(axis)
    missing = [one.name.lower() for one in (step, travel, dead) if one not in values]
    if missing:
        raise TornilloError(
            _("machine {machine}: [settings] {missing} is missing").format(
                machine=machine, missing=missing[0]
            ),
            _("write a whole file with `tornillo settings save FILE`"),
        )
    # -1: never measured, so none are taken up.
    return Known(axis, values[step], max(0, values[dead]), values[travel])


def _settings_of(axis: Axis) -> tuple[SettingId, SettingId, SettingId]:
    """Step size, switch travel and dead steps."""
    if axis is Axis.X:
        return SettingId.STEP_X_NM, SettingId.SWITCH_TRAVEL_X, SettingId.DEAD_X
    return SettingId.STEP_Z_NM, SettingId.SWITCH_TRAVEL_Z, SettingId.DEAD_Z


def show(found: Calibration, for_scripts: bool) -> None:
    """Print what was found."""
    if for_scripts:
        print_json(as_json(found))
    else:
        click.echo("\n".join(report(found)))


def finish(lathe: Lathe, found: Calibration, store: bool) -> None:
    """Store what is recommended, or say how."""
    if not found.values:
        return
    if not store:
        for setting, value in found.values.items():
            click.echo(
                _("store it: tornillo settings set {setting} {value}").format(
                    setting=setting.name.lower(), value=value
                ),
                err=True,
            )
        return
    changes = store_all(lathe, found.values, lambda change: click.echo(change, err=True))
    for name in outdated_parts(lathe, changes):
        click.echo(
            _("made for another step size, upload it again: {name}").format(name=name), err=True
        )
    click.echo(_("stored; home again, so that it counts: `tornillo home`"), err=True)


VERBS = (calibrate,)
