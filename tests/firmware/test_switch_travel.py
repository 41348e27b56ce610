# SPDX-License-Identifier: Apache-2.0
"""What the travel of the limit switches does to the reference part of paper S0, and to its page."""

from __future__ import annotations

import pytest
from calibration_page import (
    PAGE,
    SPANISH_PAGE,
    diameters,
    fill,
    s2_report,
    turned_inwards,
    turned_outwards,
)
from simulated.processes import on_a_new_chip
from simulated.switch_travel import SWITCH_TRAVEL, Zero, cut_reference
from spanish import translated

STEP_MM = 7112e-6
#: How far a diameter is off when each side is by the travel of the switch.
WRONG = 2 * SWITCH_TRAVEL * STEP_MM


def assert_page_has(sizes: dict[str, float]) -> None:
    """Check that the page shows these diameters, as cut, mm."""
    page = PAGE.read_text(encoding="utf-8")
    for name, cut in sizes.items():
        row = next(line for line in page.splitlines() if line.startswith(f"| {name} |"))
        assert f"| {cut:.3f} " in row


@pytest.mark.parametrize("setting", [0, SWITCH_TRAVEL])
@on_a_new_chip
def test_the_switch_travel_left_in_makes_the_part_too_small_and_set_it_makes_it_right(
    setting: int,
) -> None:
    sizes = cut_reference(Zero.OUTWARDS, setting)
    wanted = 0.0 if setting else -WRONG
    assert turned_inwards(sizes) == pytest.approx(wanted, abs=STEP_MM)
    assert abs(turned_outwards(sizes)) < 2 * STEP_MM
    assert_page_has({size.name.removesuffix(" diameter"): size.cut for size in diameters(sizes)})


def test_the_page_has_what_the_readings_of_paper_s2_give_today() -> None:
    for path, language in ((PAGE, "en"), (SPANISH_PAGE, "es")):
        page = path.read_text(encoding="utf-8")
        assert s2_report(language) in page
        assert fill(page, {"s2": s2_report(language)}) == page


def test_the_spanish_page_has_the_figures_of_the_english_one() -> None:
    page = PAGE.read_text(encoding="utf-8")
    table = page.partition("<!-- switch travel -->\n")[2].partition("<!-- end -->")[0]
    assert table.count("mm (") == 10
    spanish = SPANISH_PAGE.read_text(encoding="utf-8")
    assert fill(spanish, {"switch travel": translated(table)}) == spanish
