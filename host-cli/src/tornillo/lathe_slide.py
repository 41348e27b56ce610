# SPDX-License-Identifier: Apache-2.0
"""One slide of a connected lathe, as the procedures of tornillo.procedures want it."""

from tornillo.errors import TornilloError
from tornillo.language import _
from tornillo.lathe import WATCH_EVERY_S, Lathe
from tornillo.protocol import Axis, StatusInput
from tornillo.touching import TouchError, still

#: By the chip's clock; its input filter takes 4 ms.
FILTERED_MS = 10


class LatheSlide:
    """A slide of a homed lathe; `every` is the time between two looks while it moves, s."""

    def __init__(self, lathe: Lathe, axis: Axis, every: float = WATCH_EVERY_S) -> None:
        """Move `axis` of `lathe`."""
        self._lathe = lathe
        self._axis = axis
        self._every = every

    @property
    def position(self) -> int:
        """Where the tool is, machine steps."""
        return self._lathe.status().position(self._axis)

    @property
    def dead(self) -> int:
        """Dead steps that the last homing has found."""
        status = self._lathe.status()
        return status.dead_x if self._axis is Axis.X else status.dead_z

    def go(self, position: int) -> None:
        """Move there and wait; raises TornilloError when something stopped it."""
        if self._axis is Axis.X:
            self._lathe.goto(x=position)
        else:
            self._lathe.goto(z=position)
        if still(self._lathe, self._every).position(self._axis) != position:
            raise TornilloError(_("the slide was stopped"), _("start again when you are ready"))

    def touch(self, end: int) -> int:
        """Move slowly until the contact closes, and stay; the position."""
        self._lathe.touch(self._axis, end)
        status = still(self._lathe, self._every)
        if StatusInput.TOUCHED not in status.inputs:
            raise TouchError(
                _("no contact was found"), _("bring the tool nearer, or search farther: --within")
            )
        return status.position(self._axis)

    def contact(self) -> bool:
        """Whether the contact is closed, when its filter has had time by the chip's clock."""
        begun = self._lathe.status().uptime_ms
        while (status := self._lathe.status()).uptime_ms - begun < FILTERED_MS:
            pass
        return status.contact
