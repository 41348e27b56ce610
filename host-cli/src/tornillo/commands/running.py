# SPDX-License-Identifier: Apache-2.0
"""Verbs that move the machine or tell about it, from home to status."""

import dataclasses

import click

from tornillo.commands.completion import complete_parts
from tornillo.commands.connection import connected, json_option, print_json
from tornillo.commands.following import describe, follow_homing, follow_run, pause_message
from tornillo.language import _, later
from tornillo.lathe import Lathe
from tornillo.protocol import Axis, State, StatusFlag
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
    later("part"),
    later("progress"),
    later("waits for"),
    later("pressed"),
    later("firmware"),
    later("last start"),
)
follow_option = click.option("--follow", is_flag=True, help="Show the progress until the end.")


@click.command()
def home() -> None:
    """Find the limit switches and measure the dead steps; waits for the end.

    Ctrl-C stops the slides.

    \b
    Example: tornillo home
    """
    with connected() as lathe:
        lathe.home()
        click.echo(_("homing, X first; Ctrl-C stops"), err=True)
        status = follow_homing(lathe)
    click.echo(
        _("homed; dead steps: X {dead_x}, Z {dead_z}").format(
            dead_x=status.dead_x, dead_z=status.dead_z
        )
    )


@click.command()
@click.argument("part", required=False, shell_complete=complete_parts)
@click.option("--step", is_flag=True, help="Pause after each operation.")
@follow_option
def run(part: str | None, step: bool, follow: bool) -> None:
    """Cut PART (name or slot), or the selected part.

    With --follow, Ctrl-C holds the run. A pause waits for the RUN button or `tornillo resume`.

    \b
    Example: tornillo run test-bar --follow
    """
    with connected() as lathe:
        slot = None if part is None else lathe.find(part).slot
        lathe.run(slot, step)
        _started(lathe, follow)


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
        click.echo("finished")
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
    click.echo("stopped")


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
        names = {part.slot: part.name for part in lathe.parts()}
        if as_json:
            print_json(status_json(lathe, now, names))
            return
        rows = {_(name): value for name, value in _as_rows(lathe, now, names).items()}
    width = max(len(name) for name in rows)
    for name, value in rows.items():
        click.echo(f"{name:<{width}}  {value}")


def _position_mm(lathe: Lathe, now: Status) -> tuple[float, float]:
    """Diameter and z of the tool from part zero, in mm."""
    hello = lathe.hello
    radius = (now.x - hello.zero_x) * hello.step_x_nm / NM_PER_MM
    return 2 * radius, (now.z - hello.zero_z) * hello.step_z_nm / NM_PER_MM


def status_json(lathe: Lathe, now: Status, names: dict[int, str]) -> dict[str, object]:
    """Everything known, for scripts."""
    diameter, z = _position_mm(lathe, now)
    values = dataclasses.asdict(now)
    values["state"] = now.state.name
    values["alarm"] = now.alarm.name
    values["alarm_axis"] = None if now.alarm_axis is None else now.alarm_axis.name
    values["reset_cause"] = now.reset_cause.name
    values["flags"] = [flag.name for flag in now.flags]
    values["inputs"] = [flag.name for flag in now.inputs]
    return {
        **values,
        "homed": now.homed,
        "finished": now.finished,
        "message": pause_message(lathe, now) if now.state is State.PAUSE else None,
        "part": names.get(-1 if now.slot is None else now.slot),
        "part_diameter_mm": round(diameter, 4),
        "part_z_mm": round(z, 4),
        "firmware": lathe.firmware,
        "serial_number": lathe.serial_number,
    }


def _as_rows(lathe: Lathe, now: Status, names: dict[int, str]) -> dict[str, str]:
    """What a person wants to know."""
    rows = {"state": _(now.state.name.lower())}
    if now.state is State.ALARM:
        rows["alarm"] = f"{now.alarm_error()}; {_(ALARM_TEXTS[now.alarm].remedy)}"
    if now.homed:
        diameter, z = _position_mm(lathe, now)
        rows["tool"] = _("diameter {diameter:.3f} mm, z {z:.3f} mm").format(diameter=diameter, z=z)
    else:
        rows["tool"] = _("unknown: not homed")
    rows["machine"] = _("X {x}, Z {z} steps").format(x=now.x, z=now.z)
    rows["dead steps"] = f"X {now.dead_x}, Z {now.dead_z}"
    if now.slot is not None:
        rows["part"] = _("{slot} (slot {slot2})").format(
            slot=names.get(now.slot, "?"), slot2=now.slot
        )
    if now.under_way:
        rows["progress"] = f"{now.permille / 10:.1f} %, {describe(now)}"
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
