# SPDX-License-Identifier: Apache-2.0
"""Wait for a run or a homing to end, showing its progress."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import click

from tornillo.commands.progress import busy, on_terminal
from tornillo.errors import TornilloError
from tornillo.image import OPERATIONS, PartImage
from tornillo.language import _, later
from tornillo.lathe import Lathe
from tornillo.protocol import PERMILLE_DONE, PauseRecord, State, ToolRecord
from tornillo.status import Status

POLL_S = 0.1
STEP_MESSAGE = later("step by step: look at it")
#: Shows how many permille of the run are done and what is being cut.
Display = Callable[[int, str], None]


def follow_homing(lathe: Lathe) -> Status:
    """Wait until homing has ended; return the status then.

    Raises AlarmError when it failed.
    """
    with (
        busy(_("homing")),
        lathe.watch(lambda status: status.state is not State.HOMING, POLL_S) as watch,
    ):
        status = watch.wait()
    if status.state is State.ALARM:
        raise status.alarm_error()
    return status


def follow_run(lathe: Lathe) -> None:
    """Show the progress of the run until the part is finished.

    Raises AlarmError for an alarm, TornilloError when the run was stopped.
    """
    with _display() as show:
        status = _until_standing(lathe, show)
    if status.state is State.ALARM:
        raise status.alarm_error()
    if not status.finished:
        raise TornilloError(
            _("the run was stopped before its end"),
            _("start it again from its beginning with `tornillo run`"),
        )


def _until_standing(lathe: Lathe, show: Display) -> Status:
    """Watch until the run has ended; what a pause asks for is read from the part once."""
    asked: dict[int, str] = {}

    def show_status(status: Status) -> bool:
        if not status.under_way:
            return True
        text = describe(status)
        if status.state is State.PAUSE:
            if status.operation not in asked:
                asked[status.operation] = pause_message(lathe, status)
            text += _(": {asked}; go on with RUN or `tornillo resume`").format(
                asked=asked[status.operation]
            )
        show(status.permille, text)
        return False

    with lathe.watch(show_status, POLL_S) as watch:
        status = watch.wait()
    if status.finished:
        show(PERMILLE_DONE, _("finished"))
    return status


def describe(status: Status) -> str:
    """What is being cut, and whether it stands still."""
    waiting = {State.HOLD: _(", held"), State.PAUSE: _(", paused")}
    return place(status) + waiting.get(status.state, "")


def place(status: Status) -> str:
    """What is being cut."""
    text = _("on the way to the part")
    if status.operation:
        text = _("operation {operation} of {operations}").format(
            operation=status.operation, operations=status.operations
        )
    if status.passes:
        text += _(", pass {pass_number} of {passes}").format(
            pass_number=status.pass_number, passes=status.passes
        )
    return text


def pause_message(lathe: Lathe, status: Status) -> str:
    """What the operator is asked for before operation `status.operation` goes on."""
    if status.slot is None:
        return _(STEP_MESSAGE)
    return asked_for(lathe.image(status.slot), status.operation)


def asked_for(image: PartImage, operation: int) -> str:
    """What a part asks for before its operation of this number, from 1.

    A pause or a drill says it itself; another tool is named; otherwise the run goes step by
    step.
    """
    count = 0
    tool: ToolRecord | None = None
    for record in image.records:
        if isinstance(record, ToolRecord):
            tool = record
        elif isinstance(record, OPERATIONS):
            count += 1
            if count == operation and isinstance(record, PauseRecord):
                return record.message.decode("ascii", "replace") or _(STEP_MESSAGE)
            if count == operation and tool is not None and operation > 1:
                return _("put in the tool {tool}").format(
                    tool=tool.name.rstrip(bytes(1)).decode("ascii", "replace")
                )
            tool = None
    return _(STEP_MESSAGE)


@contextmanager
def _display() -> Iterator[Display]:
    """A progress bar on a terminal, otherwise a line for each new operation and pass."""
    if on_terminal():
        with _bar() as display:
            yield display
    else:
        yield _line_printer()


@contextmanager
def _bar() -> Iterator[Display]:
    """A progress bar."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (
        BarColumn(),
        TextColumn("{task.percentage:5.1f} %"),
        TextColumn("{task.description}"),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=Console(stderr=True)) as progress:
        task = progress.add_task(_("starting"), total=PERMILLE_DONE)

        def show(permille: int, text: str) -> None:
            progress.update(task, completed=permille, description=text)

        yield show


def _line_printer() -> Display:
    """Print a line whenever the text changes."""
    last = ""

    def show(permille: int, text: str) -> None:
        nonlocal last
        if text != last:
            click.echo(f"{permille / 10:5.1f} %  {text}", err=True)
        last = text

    return show
