# SPDX-License-Identifier: Apache-2.0
"""What measurements say: the tables of paper S2, made-up screws, and contradictions."""

import math
import random
from pathlib import Path

import pytest

from tornillo.calibration import Calibration, Figure, Known, Programme, Ways, from_steps, from_ways
from tornillo.errors import TornilloError
from tornillo.protocol import Axis, SettingId
from tornillo.readings import read_ways

S2 = Path(__file__).resolve().parents[1] / "examples" / "s2-marks.txt"
S2_PROGRAMME = Programme(forward=1050, back=1050)
#: S2 takes nothing up at a reversal; the step size set is that of its design.
S2_KNOWN = Known(Axis.Z, step_nm=1875, dead=0, switch_travel=0)
#: Table 6.1, distance of marks 1 and 2 in um, and table 6.4, backlash in um, as printed.
TABLE_6_1 = (
    *(1979.3, 1979.4, 1971.0, 1973.5, 1971.1, 1992.1, 1983.1, 1982.1, 1979.7, 1973.9),
    *(1971.1, 1975.3, 1975.4, 1980.0, 1977.3, 1971.3, 1985.0, 1987.4, 1976.3, 1985.9),
)
TABLE_6_4 = (
    *(344.41, 344.08, 344.01, 350.33, 351.02, 350.61, 345.42, 350.03, 344.47, 345.17),
    *(326.03, 346.23, 327.24, 341.35, 350.94, 342.23, 339.87, 350.67, 358.07, 353.24),
)


@pytest.fixture
def s2() -> Calibration:
    """What table 6.3 tells."""
    return from_ways(read_ways(S2, "um"), S2_PROGRAMME, S2_KNOWN)


def test_table_6_3_gives_the_distances_of_table_6_1_and_the_backlash_of_table_6_4() -> None:
    ways = read_ways(S2, "um")
    assert len(ways) == len(TABLE_6_1) == len(TABLE_6_4) == 20
    for pair, distance, backlash in zip(ways, TABLE_6_1, TABLE_6_4, strict=True):
        assert abs(pair.first - distance) <= 0.1
        assert abs(pair.first - pair.second - backlash) <= 0.011


def test_the_step_size_of_paper_s2_comes_out(s2: Calibration) -> None:
    assert s2.step_nm is not None
    assert s2.step_nm.mean * 1.05 == pytest.approx(1978.5, abs=0.1)  # um for 1050 steps
    assert round(s2.step_nm.mean / 1000, 2) == 1.88
    assert s2.values == {SettingId.STEP_Z_NM: 1884}


def test_the_spread_of_paper_s2_comes_out_within_one_percent_of_what_it_prints() -> None:
    figure = Figure.of(TABLE_6_1)
    assert figure.mean == pytest.approx(1978.5, abs=0.05)
    # Printed: sigma 6.07, 3 sigma 18.21; its own numbers have 6.03 and 18.08.
    assert figure.sigma == pytest.approx(6.07, rel=0.01)
    assert figure.three_sigma == pytest.approx(18.21, rel=0.01)
    assert figure.mean_within == pytest.approx(figure.three_sigma / math.sqrt(20))


def test_the_backlash_of_paper_s2_comes_out(s2: Calibration) -> None:
    assert s2.backlash_um.mean == pytest.approx(345.27, abs=0.01)
    assert s2.backlash_um.sigma == pytest.approx(7.78, abs=0.01)
    assert s2.backlash.mean == pytest.approx(345.27 / 1.8843, abs=0.1)
    assert s2.switch_travel is None


@pytest.mark.parametrize("backlash", [0, 1, 23, 200])
@pytest.mark.parametrize("travel", [0, 14, 60])
@pytest.mark.parametrize("setting", [0, 14])
@pytest.mark.parametrize("back", [950, 1050])
def test_backlash_and_switch_travel_are_told_apart_whatever_was_set(
    backlash: int, travel: int, setting: int, back: int
) -> None:
    counted = backlash + travel
    known = Known(Axis.X, 7112, max(0, counted - setting), setting)
    if known.dead == 0 and setting:
        with pytest.raises(TornilloError, match="what it counted is not known"):
            from_ways([Ways(1050.0, 950.0)], Programme(1050, back), known)
        return
    step = 7.25
    ways = Ways(1050 * step, (back + known.dead - backlash) * step)
    found = from_ways([ways], Programme(1050, back), known)
    assert found.backlash.mean == pytest.approx(backlash)
    assert found.backlash_um.mean == pytest.approx(backlash * step)
    assert found.values[SettingId.STEP_X_NM] == 7250
    if counted:
        assert found.switch_travel == travel
        assert found.values.get(SettingId.SWITCH_TRAVEL_X, setting) == travel
    assert found.dead == backlash


def test_a_step_size_within_doubt_stays_as_it_is() -> None:
    dice = random.Random(4)
    known = Known(Axis.Z, 7112, 45, 0)

    def specimen(step: float) -> Ways:
        return Ways(1050 * step + dice.gauss(0, 6), (950 + 45 - 31) * step + dice.gauss(0, 6))

    same = from_ways([specimen(7.112) for _ in range(20)], Programme(1050, 950), known)
    assert same.values == {SettingId.SWITCH_TRAVEL_Z: 14}
    other = from_ways([specimen(7.13) for _ in range(20)], Programme(1050, 950), known)
    assert other.values[SettingId.STEP_Z_NM] == pytest.approx(7130, abs=5)


def test_counted_steps_tell_the_switch_travel_and_sizes_of_a_step_when_there_are_any() -> None:
    known = Known(Axis.X, 7112, 37, 0)
    found = from_steps([23, 23, 24, 23], known)
    assert (found.step_nm, found.switch_travel) == (None, 14)
    assert found.values == {SettingId.SWITCH_TRAVEL_X: 14}
    assert found.backlash_um.mean == pytest.approx(23.25 * 7.112)
    with_size = from_steps([23], known, [7000.0, 7002.0])
    assert with_size.values[SettingId.STEP_X_NM] == 7001
    assert with_size.backlash_um.mean == pytest.approx(23 * 7.001)


def test_settings_that_are_right_already_are_not_recommended() -> None:
    found = from_steps([23, 23], Known(Axis.X, 7112, 23, 14))
    assert (found.switch_travel, found.values) == (14, {})


def test_one_step_more_than_homing_counted_is_doubt_and_more_a_contradiction() -> None:
    known = Known(Axis.X, 7112, 30, 0)
    assert from_steps([31], known).switch_travel == 0
    with pytest.raises(TornilloError, match="homing counted 30 steps in all"):
        from_steps([34, 34, 34], known)


@pytest.mark.parametrize("pair", [(0.0, 5.0), (5.0, -1.0), (math.nan, 5.0), (5.0, math.inf)])
def test_lengths_that_cannot_be_are_refused_by_their_number(pair: tuple[float, float]) -> None:
    with pytest.raises(TornilloError, match="measurement 2: "):
        from_ways([Ways(5.0, 5.0), Ways(*pair)], S2_PROGRAMME, S2_KNOWN)


def test_nothing_measured_tells_nothing() -> None:
    with pytest.raises(TornilloError, match="no measurement was given"):
        from_ways([], S2_PROGRAMME, S2_KNOWN)
    with pytest.raises(TornilloError, match="no measurement was made"):
        from_steps([], S2_KNOWN)
    with pytest.raises(TornilloError, match="a way of no steps"):
        from_ways([Ways(1, 1)], Programme(0, 1), S2_KNOWN)


def test_a_step_size_that_no_lathe_has_is_refused_with_its_range() -> None:
    with pytest.raises(TornilloError, match="step_z_nm would have to be 1978560 nm") as caught:
        from_ways([Ways(1978.56, 900.0)], Programme(1, 1), S2_KNOWN)
    assert "units" in caught.value.remedy
