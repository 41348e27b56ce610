# SPDX-License-Identifier: Apache-2.0
"""Verbs that move the slides by hand: jog, goto, touch."""

import re
from typing import Any

import click

from tornillo.commands.connection import connected, json_option, print_json
from tornillo.commands.jog_pad import open_pad
from tornillo.commands.settings import finite, units_option
from tornillo.errors import TornilloError
from tornillo.language import _, later
from tornillo.lathe import Lathe
from tornillo.machine import Machine
from tornillo.protocol import Axis
from tornillo.status import Status
from tornillo.touching import REPEATS, REPEATS_MAX, Touch, set_zero, still, touch
from tornillo.units import NM_PER_UNIT, Scale

LENGTH = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+))\s*(\w*)")
POLL_S = 0.1
UNDER_WAY = later("moving; Ctrl-C stops")

axis_argument = click.argument("name", type=click.Choice(["x", "z"]), metavar="AXIS")
rate_option = click.option(
    "--rate",
    type=click.IntRange(min=1, max=0xFFFF),
    metavar="STEPS/S",
    help="Speed; the rapid speed when left out.",
)
negative_numbers = {"ignore_unknown_options": True}


@click.command(context_settings=negative_numbers)
@click.argument("name", type=click.Choice(["x", "z"]), metavar="[AXIS", required=False)
@click.argument("distance", metavar="DISTANCE]", required=False)
@click.option("--steps", "in_steps", is_flag=True, help="DISTANCE is a number of steps.")
@rate_option
@units_option
def jog(
    name: str | None, distance: str | None, in_steps: bool, rate: int | None, units: str
) -> None:
    """Move slide AXIS (x or z) by DISTANCE, like -0.5mm or 0.02inch; waits for the end.

    Without AXIS the arrow keys move: by steps of a size you choose, or as long as a key is held.
    Releasing it stops within a fifth of a second, and so does a lost link.

    Minus is towards the spindle's axis (x) or the chuck (z); x is the way of the slide, half of
    what a diameter changes. Works before homing too, slowly, and away from a limit switch.
    Ctrl-C stops.

    \b
    Examples: tornillo jog
              tornillo jog x -0.5mm
              tornillo jog z 40 --steps --rate 50
    """
    if name is None:
        open_pad(units)
        return
    if distance is None:
        raise click.UsageError(_("say how far, like -0.5mm"))
    axis = Axis[name.upper()]
    length, unit = _length(distance, in_steps)
    with connected() as lathe:
        machine = lathe.machine()
        before = lathe.status()
        end = before.position(axis) + _steps(length, unit, machine, axis)
        if before.homed:
            _check_travel(machine, axis, end)
        lathe.jog(axis, end - before.position(axis), rate or 0)
        click.echo(_(UNDER_WAY), err=True)
        now = still(lathe, POLL_S)
        _report_place(lathe, now)
    if now.position(axis) != end:
        raise TornilloError(_("the jog was stopped before its end"), _("see `tornillo status`"))


@click.command(context_settings=negative_numbers)
@click.option("--diameter", type=float, callback=finite, help="Where to go across.")
@click.option("--z", "at", type=float, callback=finite, help="Where to go along; 0 is the front.")
@units_option
@rate_option
def goto(diameter: float | None, at: float | None, units: str, rate: int | None) -> None:
    """Move the tool to a place of the part; waits for the end.

    One slide after the other: x first when it moves away from the spindle's axis, else z first.
    Ctrl-C stops.

    \b
    Example: tornillo goto --diameter 30 --z 2
    """
    if diameter is None and at is None:
        raise click.UsageError(_("say where: --diameter, --z, or both"))
    with connected() as lathe:
        machine = lathe.machine()
        scale = Scale(units, machine)
        place = lathe.status().x, lathe.status().z
        if diameter is not None:
            place = machine.zero_x + scale.radius_steps(diameter), place[1]
        if at is not None:
            place = place[0], machine.zero_z + scale.z_steps(at)
        for axis in Axis:
            _check_travel(machine, axis, place[axis])
        lathe.goto(*place, rate or 0)
        click.echo(_(UNDER_WAY), err=True)
        now = still(lathe, POLL_S)
        _report_place(lathe, now)
    if (now.x, now.z) != place:
        raise TornilloError(_("the way was stopped before its end"), _("see `tornillo status`"))


@click.command("touch")
@axis_argument
@click.option(
    "--diameter",
    type=click.FloatRange(min=0),
    callback=finite,
    help="x: store part zero; this is the diameter that is touched.",
)
@click.option(
    "--at", type=float, callback=finite, help="z: store part zero; this is the z that is touched."
)
@click.option(
    "--within", default="5mm", show_default=True, metavar="LENGTH", help="How far to search."
)
@click.option("--outwards", is_flag=True, help="Search away from the spindle's axis or the chuck.")
@click.option("--repeats", type=click.IntRange(1, REPEATS_MAX), default=REPEATS, show_default=True)
@click.option(
    "--two-sided",
    is_flag=True,
    help="x: once more after half a turn of the chuck; the mean counts.",
)
@units_option
@json_option
def touch_work(name: str, units: str, as_json: bool, **goal: Any) -> None:
    """Move slide AXIS (x or z) slowly until the tool touches the work.

    Backs off, repeats, takes the median, goes back to where it began. With --diameter or --at
    the part zero is stored; without, it tells the diameter or z of what it has touched. Needs
    the contact sensor (`tornillo settings set probe_fitted 1`) and a spindle that stands still.
    Ctrl-C stops.

    \b
    Examples: tornillo touch x --diameter 25.4
              tornillo touch z --at 0
              tornillo touch x --two-sided
    """
    axis = Axis[name.upper()]
    known = goal["at"] if axis is Axis.Z else goal["diameter"]
    foreign = ("diameter", "two_sided") if axis is Axis.Z else ("at",)
    if any(goal[option] is not None and goal[option] is not False for option in foreign):
        raise click.UsageError(_("--diameter and --two-sided belong to x, --at to z"))
    length, unit = _length(goal["within"])
    with connected() as lathe:
        machine = lathe.machine()
        way = abs(_steps(length, unit, machine, axis)) * (1 if goal["outwards"] else -1)
        sides = _touch_sides(lathe, axis, way, goal["repeats"], goal["two_sided"])
        position = round(sum(side.position for side in sides) / len(sides))
        if known is not None:
            scale = Scale(units, machine)
            steps = scale.radius_steps(known) if axis is Axis.X else scale.z_steps(known)
            set_zero(lathe, axis, position, steps)
        _report_touch(Scale(units, lathe.machine()), axis, position, sides, as_json)


def _touch_sides(lathe: Lathe, axis: Axis, way: int, repeats: int, two_sided: bool) -> list[Touch]:
    """Touch, and on the other side of the bar too if wanted; never beyond the soft limits."""
    start = lathe.status().position(axis)
    end = max(-_travel(lathe.machine(), axis), min(0, start + way))
    click.echo(_(UNDER_WAY), err=True)
    sides = [touch(lathe, axis, end - start, repeats, POLL_S)]
    if two_sided:
        click.prompt(
            _("turn the chuck by hand, half a turn, then press Enter"),
            default="",
            show_default=False,
            prompt_suffix="",
            err=True,
        )
        sides.append(touch(lathe, axis, end - start, repeats, POLL_S))
    return sides


def _length(text: str, in_steps: bool = False) -> tuple[float, str]:
    """A number and its unit: mm, inch, or nothing for steps."""
    found = LENGTH.fullmatch(text)
    units = ("",) if in_steps else tuple(NM_PER_UNIT)
    if found is None or found[2].lower() not in units:
        form = _("a whole number of steps") if in_steps else _("a length like -0.5mm or 0.02inch")
        raise click.UsageError(_('"{text}": write {form}').format(text=text, form=form))
    if in_steps and not float(found[1]).is_integer():
        raise click.UsageError(_('"{text}": there are no parts of a step').format(text=text))
    return float(found[1]), found[2].lower()


def _steps(length: float, unit: str, machine: Machine, axis: Axis) -> int:
    """A way of a slide in steps."""
    if not unit:
        return int(length)
    scale = Scale(unit, machine)
    return scale.x_steps(length) if axis is Axis.X else scale.z_steps(length)


def _travel(machine: Machine, axis: Axis) -> int:
    """Steps that a slide can travel."""
    return machine.travel_x if axis is Axis.X else machine.travel_z


def _check_travel(machine: Machine, axis: Axis, position: int) -> None:
    """Refuse a place outside the soft limits, in words."""
    travel = _travel(machine, axis)
    if not -travel <= position <= 0:
        raise TornilloError(
            _("{axis} cannot go to step {position}: its travel is {travel} to 0").format(
                axis=axis.name, position=position, travel=-travel
            ),
            _("go less far, or check the travel with `tornillo settings`"),
        )


def _report_place(lathe: Lathe, now: Status) -> None:
    """Say where the tool is."""
    if not now.homed:
        click.echo(_("X {x}, Z {z} steps; not homed").format(x=now.x, z=now.z))
        return
    scale = Scale("mm", lathe.machine())
    diameter = scale.show_diameter(now.x - scale.machine.zero_x)
    click.echo(
        _("tool at {diameter}, {show_z}").format(
            diameter=diameter, show_z=scale.show_z(now.z - scale.machine.zero_z)
        )
    )


def _report_touch(
    scale: Scale, axis: Axis, position: int, sides: list[Touch], as_json: bool
) -> None:
    """Say what was touched, in part coordinates."""
    spread = max(side.spread for side in sides)
    machine = scale.machine
    if axis is Axis.X:
        value = scale.diameter(position - machine.zero_x)
        text = _("touched diameter {value:.3f} {units}").format(value=value, units=scale.units)
    else:
        value = scale.length(position - machine.zero_z)
        text = _("touched z = {value:.3f} {units}").format(value=value, units=scale.units)
    eccentricity = abs(sides[0].position - sides[-1].position) / 2
    if as_json:
        print_json(
            {
                "axis": axis.name,
                "position": position,
                "positions": [list(side.positions) for side in sides],
                "spread": spread,
                "eccentricity": eccentricity,
                "value": round(value, 4),
                "units": scale.units,
            }
        )
        return
    if len(sides) > 1:
        text += _(", {eccentricity:g} steps out of centre").format(eccentricity=eccentricity)
    click.echo(
        _("{text}; the readings differ by {spread} steps at most").format(text=text, spread=spread)
    )


VERBS = (jog, goto, touch_work)
