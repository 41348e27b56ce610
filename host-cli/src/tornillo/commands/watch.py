# SPDX-License-Identifier: Apache-2.0
"""The verb watch: a live view of the lathe with its part beside it, and a few keys."""

import sys
import time
from typing import TYPE_CHECKING

import click

from tornillo.commands.connection import connected, json_option
from tornillo.commands.following import pause_message
from tornillo.commands.planning import drives_of
from tornillo.commands.progress import on_terminals
from tornillo.commands.running import status_json
from tornillo.contour import Point
from tornillo.errors import ChipError, TornilloError
from tornillo.image import PartImage
from tornillo.keys import Keys, keyboard
from tornillo.language import _
from tornillo.lathe import Lathe
from tornillo.part import Part
from tornillo.part_writer import part_text
from tornillo.protocol import OVERRIDE_MAX, OVERRIDE_MIN, State
from tornillo.readout import Readout
from tornillo.remaining import Remaining
from tornillo.status import Status
from tornillo.terminal_picture import Picture, shows_braille
from tornillo.units import NM_PER_UNIT

if TYPE_CHECKING:
    from rich.console import RenderableType

#: Seconds from one look at the lathe to the next.
EVERY_S = 0.2
STEP_PERCENT = 10
#: Columns for the lines of text, beside the picture.
TEXT_COLUMNS = 44
HEIGHT = 16


def _help() -> str:
    """The line with the keys."""
    return _("h hold   r resume   + - feed   0 programmed feed   q leave   Ctrl-C hold and leave")


@click.command()
@click.option(
    "--units",
    type=click.Choice(list(NM_PER_UNIT)),
    default="mm",
    show_default=True,
    help="Units of the positions.",
)
@click.option(
    "--every",
    type=click.FloatRange(0.05, 60),
    default=EVERY_S,
    show_default=True,
    metavar="SECONDS",
    help="From one look to the next.",
)
@json_option
def watch(units: str, every: float, as_json: bool) -> None:
    """Show what the lathe does until you press q: position, pass, feed, time left, the part.

    Keys: h holds the run, r goes on, + and - change the feed by 10 %, 0 sets it back, q leaves
    and the run goes on. Ctrl-C holds and leaves.

    With --json one status a line is printed, for scripts.

    \b
    Examples: tornillo watch
              tornillo watch --units inch
              tornillo watch --json --every 1
    """
    if not as_json and not on_terminals():
        raise click.UsageError(_("watch needs a terminal; scripts use --json"))
    with connected() as lathe:
        if as_json:
            _print_lines(lathe, every)
        else:
            with keyboard() as keys:
                View(lathe, units).run(keys, every)


def _print_lines(lathe: Lathe, every: float) -> None:
    """One JSON object a line, until the reader goes away or Ctrl-C."""
    import json

    names = {part.slot: part.name for part in lathe.parts()}
    while True:
        click.echo(json.dumps(status_json(lathe, lathe.status(), lathe.progress(), names)))
        time.sleep(every)


class View:
    """The live view of one lathe."""

    def __init__(self, lathe: Lathe, units: str) -> None:
        """Ask what does not change: the machine and the stored parts."""
        self.lathe = lathe
        self.readout = Readout(lathe.machine(), units)
        self._names = {part.slot: part.name for part in lathe.parts()}
        self._drives = drives_of(lathe)
        self._slot: int | None = None
        self._image: PartImage | None = None
        self._picture: Picture | None = None
        self._asked: tuple[int, str] = (0, "")
        self.message = ""

    def run(self, keys: Keys, every: float) -> None:
        """Show frame after frame until q is pressed."""
        from rich.console import Console
        from rich.live import Live

        console = Console()
        with Live(console=console, auto_refresh=False, screen=console.is_terminal) as live:
            pressed: str | None = ""
            while pressed != "q":
                status = self.lathe.status()
                self.readout.follow(status)
                live.update(self.frame(status, console.width), refresh=True)
                pressed = keys.read(every)
                if pressed:
                    self.press(pressed, status)

    def press(self, key: str, status: Status) -> None:
        """Do what a key asks for; a refusal is shown below."""
        try:
            self.message = self._do(key, status)
        except ChipError as error:
            self.message = _("{error}; try: {remedy}").format(error=error, remedy=error.remedy)

    def _do(self, key: str, status: Status) -> str:
        """Send what a key stands for; returns what to tell."""
        known = self.readout.percent or 100
        if key == "h":
            self.lathe.hold()
            return _("held; r goes on")
        if key == "r":
            self.lathe.resume()
            return _("going on")
        steps = {"+": STEP_PERCENT, "=": STEP_PERCENT, "-": -STEP_PERCENT}
        if key in steps or key == "0":
            wanted = known + steps[key] if key in steps else 100
            percent = min(max(wanted, OVERRIDE_MIN), OVERRIDE_MAX)
            self.lathe.override(percent)
            self.readout.percent = percent
            return _("feed now {percent} %").format(percent=percent)
        return self.message

    def frame(self, status: Status, columns: int) -> "RenderableType":
        """The screen: text, the part beside it, keys below."""
        from rich.console import Group
        from rich.table import Table
        from rich.text import Text

        self._know_part(status)
        lines = Table.grid(padding=(0, 2))
        for label, value in self._rows(status):
            style = "bold red" if status.state is State.ALARM and label == _("alarm") else ""
            lines.add_row(Text(label, "dim"), Text(value, style or "bold"))
        sides = Table.grid(padding=(0, 2))
        sides.add_column(width=TEXT_COLUMNS)
        sides.add_row(lines, self._drawn(status, columns - TEXT_COLUMNS - 2))
        return Group(sides, Text(_help(), "dim"), Text(self.message, "bold yellow"))

    def _rows(self, status: Status) -> list[tuple[str, str]]:
        """The lines of text, with what a pause asks for."""
        name = "" if status.slot is None else self._names.get(status.slot, "?")
        rows = self.readout.rows(status, name)
        if status.state is State.PAUSE:
            if self._asked[0] != status.operation:
                self._asked = status.operation, pause_message(self.lathe, status)
            rows.append((_("waits for"), self._asked[1]))
        return rows

    def _know_part(self, status: Status) -> None:
        """Read the running or selected part once, and plan it."""
        if status.slot == self._slot:
            return
        self._slot, self._image, self._picture = status.slot, None, None
        self.readout.remaining = None
        if status.slot is None:
            return
        try:
            self._image = self.lathe.image(status.slot)
            self.readout.remaining = Remaining(
                self._image, self.readout.scale.machine, self._drives
            )
        except TornilloError as error:
            self.message = str(error)

    def _drawn(self, status: Status, columns: int) -> "RenderableType":
        """The part with the tool at its place."""
        from rich.text import Text

        if self._image is None or columns < 20:
            return Text("")
        if self._picture is None or self._picture.columns != columns:
            part = Part.parse(part_text(self._image, self.readout.scale.machine))
            self._picture = Picture(part, columns, HEIGHT)
        picture = self._picture
        picture.clear()
        if status.homed:
            diameter, z = self.readout.place(status)
            factor = NM_PER_UNIT[self.readout.scale.units] / NM_PER_UNIT[picture.part.units]
            picture.show(Point(z * factor, diameter / 2 * factor), "tool")
        return picture.text(shows_braille(sys.stdout.encoding))


VERBS = (watch,)
