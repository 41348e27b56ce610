# SPDX-License-Identifier: Apache-2.0
"""Touch the work with the tool: search, back off, again; what the readings tell.

    touched = touch(lathe, Axis.X, -500)
    set_zero(lathe, Axis.X, touched.position, radius_steps)

The chip finds one contact to the step; repeats, median and what to make of it are done here. The
tool ends where it began. All positions are machine steps.
"""

import statistics
from dataclasses import dataclass

from tornillo.errors import ChipError, TornilloError
from tornillo.language import _
from tornillo.lathe import WATCH_EVERY_S, Lathe
from tornillo.protocol import Axis, ErrorCode, SettingId, State, StatusInput
from tornillo.status import Status

REPEATS = 3
REPEATS_MAX = 9


class TouchError(TornilloError):
    """The tool did not find the work, or not twice at the same place."""


@dataclass(frozen=True)
class Touch:
    """Where the tool was when the contact closed, each time."""

    axis: Axis
    positions: tuple[int, ...]

    @property
    def position(self) -> int:
        """The median, of an even number the larger of the two in the middle."""
        return int(statistics.median_high(self.positions))

    @property
    def spread(self) -> int:
        """Largest less smallest."""
        return max(self.positions) - min(self.positions)


def still(lathe: Lathe, every: float = WATCH_EVERY_S) -> Status:
    """Wait until jog, goto or touch has ended; return the status then.

    Asking for it is also the sign of life that a jog and a touch need. `every`: seconds between
    two questions. Raises AlarmError for an alarm. Ctrl-C brakes a jog or goto, and ends a touch.
    """
    try:
        with lathe.watch(lambda status: not status.moving, every) as watch:
            status = watch.wait()
    except KeyboardInterrupt:
        _brake(lathe, every)
        raise TornilloError(
            _("stopped by Ctrl-C; the position is still known"), _("see `tornillo status`")
        ) from None
    if status.state is State.ALARM:
        raise status.alarm_error()
    return status


def _brake(lathe: Lathe, every: float) -> None:
    """End whatever moves, and wait until it stands."""
    try:
        lathe.hold()
    except ChipError as error:
        if error.code is not ErrorCode.NOT_RUNNING:
            raise
        lathe.stop()
    lathe.watch(lambda status: not status.moving, every).wait()


def touch(
    lathe: Lathe,
    axis: Axis,
    steps: int,
    repeats: int = REPEATS,
    every: float = WATCH_EVERY_S,
) -> Touch:
    """Move `axis` slowly by at most `steps` (with sign) until the tool touches, `repeats` times.

    Raises TouchError when there is no contact within `steps`, when it stays closed as the tool
    backs off, or when the readings differ by more than the setting spread_max; ChipError for what
    the chip refuses (not homed, no sensor, contact closed already, outside the travel).
    """
    if not 1 <= repeats <= REPEATS_MAX:
        raise TornilloError(
            _("{repeats} repeats are not possible").format(repeats=repeats),
            _("choose 1 to {repeats_max}").format(repeats_max=REPEATS_MAX),
        )
    start = lathe.status().position(axis)
    end = start + steps
    back_off = lathe.setting(SettingId.TOUCH_BACK_OFF).value
    positions: list[int] = []
    while len(positions) < repeats:
        lathe.touch(axis, end)
        positions.append(_found(lathe, still(lathe, every), axis, (start, end), every))
        back = start
        if len(positions) < repeats and abs(start - positions[-1]) > back_off:
            back = positions[-1] + (back_off if steps < 0 else -back_off)
        _go(lathe, axis, back)
        if still(lathe, every).contact:
            raise TouchError(
                _("the contact stayed closed when the tool backed off"),
                _(
                    "look for chips between tool and work; if its slide was still in the dead "
                    "steps, raise the setting touch_back_off"
                ),
            )
    touched = Touch(axis, tuple(positions))
    most = lathe.setting(SettingId.SPREAD_MAX).value
    if touched.spread > most:
        raise TouchError(
            _("the readings differ by {spread} steps: {list}").format(
                spread=touched.spread, list=", ".join(map(str, positions))
            ),
            _(
                "clean tool and work, stop the spindle, and touch again; the setting "
                "spread_max allows {most}"
            ).format(most=most),
        )
    return touched


def _found(lathe: Lathe, status: Status, axis: Axis, way: tuple[int, int], every: float) -> int:
    """Where the search ended in contact; without one the tool goes back first."""
    start, end = way
    here = status.position(axis)
    if StatusInput.TOUCHED in status.inputs:
        return here
    if here != end:
        raise TouchError(_("the search was stopped"), _("start it again when you are ready"))
    _go(lathe, axis, start)
    still(lathe, every)
    raise TouchError(
        _("no contact within {abs} steps").format(abs=abs(end - start)),
        _("bring the tool nearer, or search farther; check that the sensor's wire is on the tool"),
    )


def _go(lathe: Lathe, axis: Axis, position: int) -> None:
    """Move one axis to a position, at rapid."""
    if axis is Axis.X:
        lathe.goto(x=position)
    else:
        lathe.goto(z=position)


def set_zero(lathe: Lathe, axis: Axis, position: int, steps: int) -> None:
    """Say that machine `position` of `axis` is part coordinate `steps` (X: a radius)."""
    lathe.zero(axis, steps + lathe.status().position(axis) - position)
