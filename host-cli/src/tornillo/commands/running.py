# SPDX-License-Identifier: Apache-2.0
"""Verbs that move the machine or tell about it, from home to status."""

import dataclasses

import click

from tornillo.commands.completion import complete_parts
from tornillo.commands.connection import connected, json_option, print_json
from tornillo.commands.following import describe, follow_homing, follow_run, pause_message
from tornillo.errors import ChipError, TornilloError
from tornillo.language import _, later
from tornillo.lathe import Lathe
from tornillo.protocol import Axis, ErrorCode, HomedAxis, ProgressData, State, StatusFlag
from tornillo.protocol_texts import ALARM_TEXTS
from tornillo.status import Status

NM_PER_MM = 1_000_000
#: The labels of `status`.
LABELS = (
    later("state"),
    later("alarm"),
    later("tool"),
    later("machine"),
    later("dead steps"),
    later("warning"),
    later("unfinished"),
    later("part"),
    later("progress"),
    later("waits for"),
    later("pressed"),
    later("firmware"),
    later("last start"),
)
follow_option = click.option("--follow", is_flag=True, help="Show the progress until the end.")


@click.command()
@click.option(
    "--axis",
    type=click.Choice([axis.name.lower() for axis in Axis]),
    help="This axis alone; the other one stays where it is.",
)
def home(axis: str | None) -> None:
    """Find the limit switches and measure the dead steps; waits for the end.

    Ctrl-C stops the slides. It is told when the dead steps have changed since the last homing.

    \b
    Examples: tornillo home
              tornillo home --axis z
    """
    axes = HomedAxis.X | HomedAxis.Z if axis is None else HomedAxis[axis.upper()]
    with connected() as lathe:
        lathe.home(axes)
        what = _("X first") if axis is None else _("{axis} alone").format(axis=axis.upper())
        click.echo(_("homing, {what}; Ctrl-C stops").format(what=what), err=True)
        status = follow_homing(lathe)
    click.echo(_("homed; {status}").format(status=_dead_steps(status, axes)))
    for line in status.advice:
        click.secho(_("Warning: {line}").format(line=line), fg="yellow", err=True)


def _dead_steps(status: Status, axes: HomedAxis) -> str:
    """What homing has found of some axes."""
    found = {
        HomedAxis.X: (status.dead_x, status.spread_x),
        HomedAxis.Z: (status.dead_z, status.spread_z),
    }
    some = {axis.name: found[axis] for axis in HomedAxis if axis in axes}
    dead = ", ".join(f"{name} {steps}" for name, (steps, _spread) in some.items())
    spread = ", ".join(f"{name} {steps}" for name, (_dead, steps) in some.items())
    return _("dead steps: {dead}; spread: {spread}").format(dead=dead, spread=spread)


@click.command()
@click.argument("part", required=False, shell_complete=complete_parts)
@click.option("--step", is_flag=True, help="Pause after each operation.")
@click.option("--resume", is_flag=True, help="Go on with the part that was not finished.")
@follow_option
def run(part: str | None, step: bool, resume: bool, follow: bool) -> None:
    """Cut PART (name or slot), or the selected part.

    With --follow, Ctrl-C holds the run. A pause waits for the RUN button or `tornillo resume`.

    After a power cut, a stop or an alarm: home, then --resume. It goes on from the pass that was
    completed last; what was cut before is left out. The tool must be the one of that moment.

    \b
    Examples: tornillo run test-bar --follow
              tornillo run --resume --follow
    """
    with connected() as lathe:
        slot = None if part is None else lathe.find(part).slot
        try:
            lathe.run(slot, step, resume)
        except ChipError as error:
            if error.code is ErrorCode.INVALID_PART:
                _refuse_outdated(lathe)
            raise
        begun = lathe.progress() if resume else None
        if begun is not None:
            click.echo(_("going on behind {begun}").format(begun=_completed(begun)), err=True)
        _started(lathe, follow)


def _refuse_outdated(lathe: Lathe) -> None:
    """Raise TornilloError when the selected or another part was made for other screws."""
    names = ", ".join(part.name for part in lathe.outdated_parts())
    if names:
        raise TornilloError(
            _("the step size was changed since these parts were stored: {names}").format(
                names=names
            ),
            _("upload them again, so that they fit the screws"),
        )


def _completed(begun: ProgressData) -> str:
    """How far a part came."""
    if begun.pass_number == 0:
        return _("operation {operation}").format(operation=begun.operation)
    return _("operation {operation}, pass {pass_number}").format(
        operation=begun.operation, pass_number=begun.pass_number
    )


@click.command()
def hold() -> None:
    """Stop the run so that it can go on.

    \b
    Example: tornillo hold
    """
    with connected() as lathe:
        lathe.hold()
    click.echo(_("held; go on with `tornillo resume`, give up with `tornillo stop`"))


@click.command()
@follow_option
def resume(follow: bool) -> None:
    """Go on after a hold or a pause.

    \b
    Example: tornillo resume --follow
    """
    with connected() as lathe:
        lathe.resume()
        _started(lathe, follow)


@click.command(context_settings={"ignore_unknown_options": True})
@click.argument("percent", type=int)
def override(percent: int) -> None:
    """Change the feed of the run to PERCENT (10 to 200) of the programmed one.

    Rapids keep their speed; the next run starts with 100 again.

    \b
    Example: tornillo override 80
    """
    with connected() as lathe:
        lathe.override(percent)
    click.echo(_("feed now {percent} %; back with `tornillo override 100`").format(percent=percent))


def _started(lathe: Lathe, follow: bool) -> None:
    """Follow a run that was just started, if wanted."""
    if follow:
        follow_run(lathe)
        click.echo(_("finished"))
    else:
        click.echo(_("running; see `tornillo status`, hold with `tornillo hold`"))


@click.command()
def stop() -> None:
    """End the run, the homing, or whatever else moves.

    \b
    Example: tornillo stop
    """
    with connected() as lathe:
        lathe.stop()
    click.echo(_("stopped"))


@click.command()
def reset() -> None:
    """Acknowledge an alarm.

    \b
    Example: tornillo reset
    """
    with connected() as lathe:
        lathe.reset()
        status = lathe.status()
    if status.state is State.ALARM:
        raise status.alarm_error()
    click.echo(_("no alarm") if status.homed else _("no alarm; home next: `tornillo home`"))


@click.command()
@json_option
def status(as_json: bool) -> None:
    """Show what the lathe is doing and where the tool is.

    \b
    Example: tornillo status --json
    """
    with connected() as lathe:
        now = lathe.status()
        begun = lathe.progress()
        names = {part.slot: part.name for part in lathe.parts()}
        if as_json:
            print_json(status_json(lathe, now, begun, names))
            return
        rows = {_(name): value for name, value in _as_rows(lathe, now, begun, names).items()}
    width = max(len(name) for name in rows)
    for name, value in rows.items():
        click.echo(f"{name:<{width}}  {value}")


def _position_mm(lathe: Lathe, now: Status) -> tuple[float, float]:
    """Diameter and z of the tool from part zero, in mm."""
    hello = lathe.hello
    radius = (now.x - hello.zero_x) * hello.step_x_nm / NM_PER_MM
    return 2 * radius, (now.z - hello.zero_z) * hello.step_z_nm / NM_PER_MM


def status_json(
    lathe: Lathe, now: Status, begun: ProgressData | None, names: dict[int, str]
) -> dict[str, object]:
    """Everything known, for scripts."""
    diameter, z = _position_mm(lathe, now)
    values = dataclasses.asdict(now)
    values["state"] = now.state.name
    values["alarm"] = now.alarm.name
    values["alarm_axis"] = None if now.alarm_axis is None else now.alarm_axis.name
    values["reset_cause"] = now.reset_cause.name
    values["flags"] = [flag.name for flag in now.flags]
    values["inputs"] = [flag.name for flag in now.inputs]
    values["homed_axes"] = [axis.name for axis in now.homed_axes]
    values["warnings"] = [warning.name for warning in now.warnings]
    return {
        **values,
        "homed": now.homed,
        "finished": now.finished,
        "message": pause_message(lathe, now) if now.state is State.PAUSE else None,
        "part": names.get(-1 if now.slot is None else now.slot),
        "unfinished": None if begun is None else begun._asdict(),
        "part_diameter_mm": round(diameter, 4),
        "part_z_mm": round(z, 4),
        "firmware": lathe.firmware,
        "serial_number": lathe.serial_number,
    }


def _as_rows(
    lathe: Lathe, now: Status, begun: ProgressData | None, names: dict[int, str]
) -> dict[str, str]:
    """What a person wants to know."""
    rows = {"state": _(now.state.name.lower())}
    if now.state is State.ALARM:
        rows["alarm"] = f"{now.alarm_error()}; {_(ALARM_TEXTS[now.alarm].remedy)}"
    if now.homed:
        diameter, z = _position_mm(lathe, now)
        rows["tool"] = _("diameter {diameter:.3f} mm, z {z:.3f} mm").format(diameter=diameter, z=z)
    else:
        some = (
            _(", only {homed_axes}").format(homed_axes=now.homed_axes.name)
            if now.homed_axes
            else ""
        )
        rows["tool"] = _("unknown: not homed{some}").format(some=some)
    rows["machine"] = _("X {x}, Z {z} steps").format(x=now.x, z=now.z)
    rows["dead steps"] = _("X {dead_x}, Z {dead_z}; spread X {spread_x}, Z {spread_z}").format(
        dead_x=now.dead_x, dead_z=now.dead_z, spread_x=now.spread_x, spread_z=now.spread_z
    )
    if now.warnings:
        rows["warning"] = "; ".join(now.advice)
    if now.slot is not None:
        rows["part"] = _("{slot} (slot {slot2})").format(
            slot=names.get(now.slot, "?"), slot2=now.slot
        )
    if now.under_way:
        rows["progress"] = f"{now.permille / 10:.1f} %, {describe(now)}"
    elif begun is not None:
        name = names.get(begun.slot, "?")
        rows["unfinished"] = _(
            "{name}, completed up to {begun}; home, then `tornillo run --resume`"
        ).format(name=name, begun=_completed(begun))
    if now.state is State.PAUSE:
        rows["waits for"] = _("{lathe}; go on with RUN or `tornillo resume`").format(
            lathe=pause_message(lathe, now)
        )
    pressed = [
        text
        for flag, text in (
            (StatusFlag.ESTOP, _("emergency stop")),
            (StatusFlag.SWITCH_X, _("limit switch {x}").format(x=Axis.X.name)),
            (StatusFlag.SWITCH_Z, _("limit switch {z}").format(z=Axis.Z.name)),
            (StatusFlag.BUTTON_RUN, "RUN"),
            (StatusFlag.BUTTON_HOLD, "HOLD"),
            (StatusFlag.BUTTON_STOP, "STOP"),
        )
        if flag in now.flags
    ]
    if now.contact:
        pressed.append(_("contact sensor"))
    if pressed:
        rows["pressed"] = ", ".join(pressed)
    rows["firmware"] = _("{firmware}, serial number {serial_number}").format(
        firmware=lathe.firmware, serial_number=lathe.serial_number
    )
    rows["last start"] = _(now.reset_cause.name.lower().replace("_", "-"))
    return rows


VERBS = (home, run, hold, resume, override, stop, reset, status)
