# SPDX-License-Identifier: Apache-2.0
"""How an axis is measured: with a dial gauge, or with the contact sensor.

Both need a slide that goes where it is told; positions are machine steps, negative away from the
limit switch. The person is asked through a function, so that everything here works without one.
"""

from collections.abc import Callable
from typing import Protocol

from tornillo.calibration import Ways
from tornillo.errors import TornilloError
from tornillo.language import _

#: More than any backlash: so far the tool comes to a place from the side that counts.
APPROACH = 300
#: Between two touches, and the most that backing off may take to open the contact.
BACK_OFF = 50
OPENS_WITHIN = 1100

#: Shows a question and returns a length in micrometres.
Ask = Callable[[str], float]
#: Shows a line; where the person has something to do, returns when it is done.
Tell = Callable[[str], None]


class Slide(Protocol):
    """One axis of a homed lathe."""

    @property
    def position(self) -> int:
        """Where the tool is."""

    @property
    def dead(self) -> int:
        """Dead steps that the lathe takes up at a reversal."""

    def go(self, position: int) -> None:
        """Move the tool there and wait until it stands."""

    def touch(self, end: int) -> int:
        """Move slowly until the contact closes and stay there; the position.

        Raises TornilloError when it does not close on the way to `end`.
        """

    def contact(self) -> bool:
        """Whether the contact is closed, filtered, now that the tool stands."""


def by_gauge(slide: Slide, forward: int, rounds: int, ask: Ask, tell: Tell) -> list[Ways]:
    """Go `forward` steps away from the switch and back, reading a dial gauge at each end.

    The tool needs APPROACH + `forward` steps of free way. Readings that cannot be are told, and
    the round is made again.
    """
    start = slide.position - APPROACH
    found: list[Ways] = []
    while len(found) < rounds:
        number = _("round {found} of {rounds}").format(found=len(found) + 1, rounds=rounds)
        slide.go(start + APPROACH)
        slide.go(start)
        first = ask(_("{number}: reading at the start").format(number=number))
        slide.go(start - forward)
        far = ask(
            _("{number}: reading {forward} steps further").format(number=number, forward=forward)
        )
        slide.go(start)
        last = ask(_("{number}: reading back at the start").format(number=number))
        there, back = far - first, last - far
        if there * back < 0:
            found.append(Ways(abs(there), abs(back)))
        else:
            tell(_("these readings do not go there and back; the round is made again"))
    slide.go(start + APPROACH)
    return found


def by_contact(slide: Slide, search: int, rounds: int) -> list[int]:
    """Touch the work and back off step by step until the contact opens: backlash, in steps.

    `search` is the longest way to the work, away from the switch. The lathe must take up fewer
    dead steps than there are, none at best: what it takes up unseen cannot be counted.
    """
    start = slide.position
    found = []
    for _round in range(rounds):
        touched = slide.touch(start - search)
        opened = 0
        while slide.contact():
            opened += 1
            if opened > OPENS_WITHIN:
                raise TornilloError(
                    _("the contact stayed closed over {opens_within} steps back").format(
                        opens_within=OPENS_WITHIN
                    ),
                    _("look for chips between tool and work, and at the sensor's wires"),
                )
            slide.go(touched + opened)
        if opened < 2 and slide.dead > 0:
            raise TornilloError(
                _(
                    "the contact opened at once: the lathe takes up as many dead steps as "
                    "there are, or more, so that they cannot be counted"
                ),
                _("raise the setting switch_travel of this axis, home, and measure again"),
            )
        found.append(slide.dead + opened - 1)
        slide.go(min(start, touched + opened + BACK_OFF))
    slide.go(start)
    return found


def block_steps(
    slide: Slide, search: int, rounds: int, block_um: float, ready: Tell
) -> list[float]:
    """Touch the work, then a gauge block of `block_um` on it: nanometres a step, one a round."""
    start = slide.position
    found = []
    for number in range(1, rounds + 1):
        ready(
            _("round {number} of {rounds}: take the block away").format(
                number=number, rounds=rounds
            )
        )
        bare = slide.touch(start - search)
        slide.go(start)
        ready(
            _("round {number} of {rounds}: put the block on the work").format(
                number=number, rounds=rounds
            )
        )
        covered = slide.touch(start - search)
        slide.go(start)
        if covered <= bare:
            raise TornilloError(
                _("with the block the tool touched at {covered}, without it at {bare}").format(
                    covered=covered, bare=bare
                ),
                _("the block belongs between tool and work; start again"),
            )
        found.append(block_um * 1000 / (covered - bare))
    return found
