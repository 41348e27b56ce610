# SPDX-License-Identifier: Apache-2.0
"""The screen of the interactive `tornillo jog`."""

from contextlib import suppress
from typing import TYPE_CHECKING

import click

from tornillo.commands.connection import connected
from tornillo.commands.planning import drives_of
from tornillo.commands.progress import on_terminals
from tornillo.errors import ChipError
from tornillo.jogging import SIZES, JogPad, fastest
from tornillo.keys import Keys, keyboard
from tornillo.language import _
from tornillo.protocol import Axis
from tornillo.status import Status
from tornillo.units import Scale

if TYPE_CHECKING:
    from rich.console import RenderableType

#: Seconds without a key from one look at the lathe to the next; the chip waits for three.
LOOK_S = 0.03


def open_pad(units: str) -> None:
    """Move the connected lathe by keys; positions in `units`."""
    if not on_terminals():
        raise click.UsageError(_("moving by keys needs a terminal; scripts give axis and distance"))
    with connected() as lathe:
        drives = drives_of(lathe)
        most = fastest(drives.start, drives.acceleration)
        rapid = min(drives.rapid_x, drives.rapid_z)
        with keyboard() as keys:
            show_pad(JogPad(lathe, Scale(units, lathe.machine()), rapid, most), keys)


def show_pad(pad: JogPad, keys: Keys) -> None:
    """Move by keys until q is pressed; the slides stand at the end."""
    from rich.console import Console
    from rich.live import Live

    console = Console()
    try:
        with Live(console=console, auto_refresh=False, screen=console.is_terminal) as live:
            pressed: str | None = ""
            while pressed != "q":
                status = pad.mover.status()
                live.update(frame(pad, status), refresh=True)
                pressed = keys.read(min(LOOK_S, pad.patience_s))
                use_key(pad, pressed, status)
    finally:
        with suppress(ChipError):  # nothing moves
            pad.mover.hold()


def use_key(pad: JogPad, key: str | None, status: Status) -> None:
    """Pass a key on; a refusal of the chip is shown."""
    try:
        if key and key != "q":
            pad.press(key, status)
        else:
            pad.idle()
    except ChipError as error:
        pad.message = _("{error}; try: {remedy}").format(error=error, remedy=error.remedy)


def frame(pad: JogPad, status: Status) -> "RenderableType":
    """Where both axes are, how they will move, and the keys."""
    from rich.console import Group
    from rich.table import Table
    from rich.text import Text

    table = Table.grid(padding=(0, 2))
    for label, value in rows(pad, status):
        table.add_row(Text(label, "dim"), Text(value, "bold"))
    return Group(
        table,
        Text(_("arrows move: left to the chuck, up away from the axis   space stops"), "dim"),
        Text(_("s step size   c continuous   + - speed   r rapid   q leave"), "dim"),
        Text(_("NUMBER Enter: ms a step   NUMBER m: {units}/min").format(
            units=pad.scale.units), "dim"),
        Text(pad.message or pad.entry, "bold yellow"),
    )  # fmt: skip


def rows(pad: JogPad, status: Status) -> list[tuple[str, str]]:
    """The lines of the screen."""
    scale = pad.scale
    machine = scale.machine
    x, z = status.x - machine.zero_x, status.z - machine.zero_z
    steps = _("{place}, {steps} steps")
    units = scale.units
    diameter, along = scale.show(scale.diameter(x)), scale.show(scale.length(z))
    if not status.homed:
        diameter = along = _("not homed")
    size = SIZES[units][pad.size]
    way = _("one step") if size == 0 else f"{size:g} {units}"
    if pad.continuous:
        way = _("as long as the key is held")
    speed = _("{ms} ms a step, {speed:.3g} {units}/min").format(
        ms=pad.ms_per_step, speed=pad.per_minute, units=units
    )
    if pad.rapid:
        speed = _("rapid, {speed:.3g} {units}/min").format(speed=pad.per_minute, units=units)
    return [
        (_("{axis} (diameter)").format(axis=Axis.X.name), steps.format(
            place=diameter, steps=status.x)),
        (Axis.Z.name, steps.format(place=along, steps=status.z)),
        (_("moves by"), way),
        (_("speed"), speed),
    ]  # fmt: skip
