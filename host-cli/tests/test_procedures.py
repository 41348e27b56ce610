# SPDX-License-Identifier: Apache-2.0
"""The guided measurements on a slide whose truth is known."""

import pytest
from measured_slide import MeasuredSlide

from tornillo.calibration import Known, Programme, from_steps, from_ways
from tornillo.errors import TornilloError
from tornillo.procedures import APPROACH, block_steps, by_contact, by_gauge
from tornillo.protocol import Axis


@pytest.mark.parametrize("backlash", [0, 1, 23, 200])
@pytest.mark.parametrize("travel", [0, 14, 60])
@pytest.mark.parametrize("setting", [0, 7])
def test_the_gauge_tells_backlash_and_switch_travel_apart(
    backlash: int, travel: int, setting: int
) -> None:
    dead = max(0, backlash + travel - setting)
    slide = MeasuredSlide(backlash, dead, step_um=7.2)
    ways = by_gauge(slide, 1000, 3, slide.gauge, print)
    # What homing counts is known but where more is set than there is: then the setting is put to 0.
    known = Known(Axis.X, 7112, dead, setting if dead else 0)
    found = from_ways(ways, Programme(1000, 1000), known)
    assert found.backlash.mean == pytest.approx(backlash)
    assert found.switch_travel == (travel if dead else None)
    assert found.step_nm is not None
    assert found.step_nm.mean == pytest.approx(7200)
    assert slide.position == -20
    assert min(slide.moved) == -20 - APPROACH - 1000


def test_readings_that_do_not_come_back_are_taken_again() -> None:
    slide = MeasuredSlide(23, 37)
    asked: list[float] = []
    told: list[str] = []

    def ask(question: str) -> float:
        """Type the second reading twice."""
        asked.append(asked[1] if len(asked) == 2 else slide.gauge(question))
        return asked[-1]

    assert len(by_gauge(slide, 1000, 1, ask, told.append)) == 1
    assert len(asked) == 6
    assert len(told) == 1
    assert "do not go there and back" in told[0]


@pytest.mark.parametrize("backlash", [0, 1, 23, 200])
@pytest.mark.parametrize("dead", [0, 5])
def test_the_contact_finds_the_backlash_when_less_is_taken_up(backlash: int, dead: int) -> None:
    slide = MeasuredSlide(backlash, dead, work=-150)
    if dead and backlash <= dead:
        with pytest.raises(TornilloError, match="opened at once"):
            by_contact(slide, 400, 3)
        return
    assert by_contact(slide, 400, 3) == [backlash] * 3
    assert slide.position == -20
    known = Known(Axis.X, 7112, backlash + 14, 0)
    assert from_steps([backlash] * 3, known).switch_travel == 14


class StuckSlide(MeasuredSlide):
    """One on which a chip connects tool and work."""

    def contact(self) -> bool:
        """Always closed."""
        return True


def test_a_contact_that_does_not_open_ends_the_procedure() -> None:
    slide = StuckSlide(23, 0, work=-150)
    with pytest.raises(TornilloError, match="stayed closed"):
        by_contact(slide, 400, 1)


def test_a_block_between_tool_and_work_tells_the_size_of_a_step() -> None:
    slide = MeasuredSlide(23, 37, work=-900, step_um=10.0)

    def ready(text: str) -> None:
        slide.work = -900 + (500 if "put" in text else 0)

    assert block_steps(slide, 1500, 2, 5000.0, ready) == [10_000.0, 10_000.0]


def test_a_block_that_was_forgotten_is_noticed() -> None:
    slide = MeasuredSlide(23, 37, work=-900)
    with pytest.raises(TornilloError, match="with the block the tool touched at"):
        block_steps(slide, 1500, 1, 5000.0, lambda _text: None)
