# SPDX-License-Identifier: Apache-2.0
"""A slide with backlash, a dial gauge on it and work in front of it, for tests of procedures."""

from tornillo.errors import TornilloError


class MeasuredSlide:
    """Turns its screw as the chip does: `dead` steps more at each reversal, not counted.

    `truth` is the slide's place in steps, `screw` that of the screw; the slack between them is 0
    (pushed in + direction) to `backlash`. The contact closes at `work` and below.
    """

    def __init__(
        self, backlash: int, dead: int, work: int = -10_000, step_um: float = 7.112
    ) -> None:
        """Stand beside the switch, slack taken up in - direction as after homing."""
        self.position = -20
        self.dead = dead
        self.backlash = backlash
        self.work = work
        self.step_um = step_um
        self.truth = -20
        self.moved: list[int] = []
        self._slack = 0  # how far the screw may turn in - direction before the slide moves
        self._direction = -1

    def go(self, position: int) -> None:
        """Move to a place."""
        self.moved.append(position)
        while self.position != position:
            self._step(1 if position > self.position else -1)

    def _step(self, direction: int) -> None:
        if direction != self._direction:
            self._direction = direction
            for _ in range(self.dead):
                self._turn(direction)
        self._turn(direction)
        self.position += direction

    def _turn(self, direction: int) -> None:
        """Turn the screw by one step."""
        slack = self._slack + direction
        if 0 <= slack <= self.backlash:
            self._slack = slack
        else:
            self.truth += direction

    def touch(self, end: int) -> int:
        """Move until contact."""
        while self.position > end and not self.contact():
            self._step(-1)
        if not self.contact():
            raise TornilloError("no contact", "nearer")
        return self.position

    def contact(self) -> bool:
        """Whether the tool touches."""
        return self.truth <= self.work

    def gauge(self, _question: str) -> float:
        """What the dial gauge shows, micrometres."""
        return 3000.0 - self.truth * self.step_um
