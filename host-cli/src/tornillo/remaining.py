# SPDX-License-Identifier: Apache-2.0
"""How long a run still takes: the plan of its part, and how far the status says it is."""

from tornillo.drives import Drives
from tornillo.image import PartImage
from tornillo.machine import Machine
from tornillo.moves import Pass
from tornillo.planning import plan_part
from tornillo.protocol import PERMILLE_DONE, State
from tornillo.status import Status
from tornillo.timing import time_plan

USUAL_PERCENT = 100


class Remaining:
    """The time left of one run, from statuses in the order in which they came.

    Within a pass the chip's clock counts, as long as it cuts. Pauses are not foreseen.
    """

    def __init__(self, image: PartImage, machine: Machine, drives: Drives) -> None:
        """Plan the part in `image` as the chip does."""
        plan = plan_part(image, machine)
        timing = time_plan(plan, drives)
        self._rows = list(zip(plan.steps, timing.steps, timing.feeding, strict=True))
        self._at: tuple[int, int] = (0, 0)
        self._spent = 0.0
        self._clock: int | None = None

    def feed(self, status: Status) -> int | None:
        """The feed of the pass that is being made, 1/8 step/s; None for none."""
        for step, _seconds, _feeding in self._rows:
            if isinstance(step, Pass) and self._here(step, status) and step.cuts:
                return step.cuts[-1].feed
        return None

    def seconds(self, status: Status, percent: int = USUAL_PERCENT) -> float:
        """Seconds left at a feed override of `percent`, as of `status`."""
        self._count(status)
        if status.permille == PERMILLE_DONE:
            return 0.0
        left, passed = 0.0, status.operation == 0
        for step, seconds, feeding in self._rows:
            needed = seconds - feeding + feeding * USUAL_PERCENT / percent
            if passed:
                left += needed
            elif isinstance(step, Pass) and self._here(step, status):
                passed = True
                left += max(0.0, needed - self._spent)
            elif step.operation > status.operation:
                passed = True
                left += needed
        return left

    @staticmethod
    def _here(step: Pass, status: Status) -> bool:
        """Whether this pass is the one that is being made."""
        return (step.operation, step.number) == (status.operation, status.pass_number)

    def _count(self, status: Status) -> None:
        """Count how long the pass has been cut."""
        at = (status.operation, status.pass_number)
        if at != self._at:
            self._at, self._spent = at, 0.0
        elif self._clock is not None and status.state is State.RUNNING:
            self._spent += (status.uptime_ms - self._clock) / 1000
        self._clock = status.uptime_ms
