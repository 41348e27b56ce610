# SPDX-License-Identifier: Apache-2.0
"""What measurements say about a screw: the size of a step, its backlash, the switch's travel.

The method is that of paper S2 (its sections on resolution and backlash): go `forward` steps in one
direction, then `back` steps, and measure both ways. Before, the tool must have moved in the
direction of the first way, so that no slack is left in it. With s the size of a step, B the true
backlash and D the dead steps that the lathe takes up at a reversal, both in steps:

    first way    forward * s
    second way   (back + D - B) * s

So s is the first way over its steps, and B = back + D - second / s. Homing counts D plus the
setting switch_travel from a limit switch closing to opening; what B leaves of them is the travel of
the switch: switch_travel = D + switch_travel now - B.
"""

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass

from tornillo.errors import TornilloError
from tornillo.language import _
from tornillo.protocol import Axis, SettingId
from tornillo.setting_names import BY_ID, unit

NM_PER_UM = 1000
SIGMAS = 3
_STEP = {Axis.X: SettingId.STEP_X_NM, Axis.Z: SettingId.STEP_Z_NM}
_TRAVEL = {Axis.X: SettingId.SWITCH_TRAVEL_X, Axis.Z: SettingId.SWITCH_TRAVEL_Z}


@dataclass(frozen=True)
class Ways:
    """Two lengths measured one after the other, in micrometres, both above 0."""

    first: float
    second: float


@dataclass(frozen=True)
class Programme:
    """Steps that the lathe was told to go: there, and back."""

    forward: int
    back: int


@dataclass(frozen=True)
class Known:
    """What the lathe goes by at present: nanometres a step, dead steps, the switch's travel.

    `dead` is what the last homing found and the lathe takes up at every reversal.
    """

    axis: Axis
    step_nm: int
    dead: int
    switch_travel: int


@dataclass(frozen=True)
class Figure:
    """Mean and standard deviation (of the sample, n - 1) of `count` values."""

    mean: float
    sigma: float
    count: int

    @classmethod
    def of(cls, values: Sequence[float]) -> "Figure":
        """The figure of some values; one value alone has no deviation to tell."""
        sigma = statistics.stdev(values) if len(values) > 1 else math.nan
        return cls(statistics.fmean(values), sigma, len(values))

    @property
    def three_sigma(self) -> float:
        """How far off a single value may be."""
        return SIGMAS * self.sigma

    @property
    def mean_within(self) -> float:
        """How far off the mean may be: three standard errors."""
        return self.three_sigma / math.sqrt(self.count)


@dataclass(frozen=True)
class Calibration:
    """What was measured of one axis.

    `step_nm`: None when the procedure does not tell. `backlash_um` and `backlash` (steps).
    `values`: settings that are recommended, only those that differ from the present ones.
    `switch_travel`: steps, None when homing has not told what it counted.
    """

    known: Known
    step_nm: Figure | None
    backlash_um: Figure
    backlash: Figure
    switch_travel: int | None
    values: dict[SettingId, int]

    @property
    def dead(self) -> int:
        """Dead steps that homing will find with the recommended values."""
        return round(self.backlash.mean)


def from_ways(ways: Sequence[Ways], programme: Programme, known: Known) -> Calibration:
    """What pairs of ways tell; each of them may come from a specimen of its own.

    Raises TornilloError when there is none, or when they contradict what homing counted.
    """
    if not ways:
        raise TornilloError(_("no measurement was given"), _("measure at least one specimen"))
    _must_be_ways(ways, programme)
    steps = Figure.of([pair.first * NM_PER_UM / programme.forward for pair in ways])
    lengths = [
        (programme.back + known.dead) * pair.first / programme.forward - pair.second
        for pair in ways
    ]
    step_um = steps.mean / NM_PER_UM
    return _recommend(known, steps, Figure.of(lengths), [one / step_um for one in lengths])


def from_steps(
    backlash: Sequence[int], known: Known, steps_nm: Sequence[float] = ()
) -> Calibration:
    """What counted steps tell, and sizes of a step when they were measured.

    Raises TornilloError when there is none, or when they contradict what homing counted.
    """
    if not backlash:
        raise TornilloError(_("no measurement was made"), _("ask for at least one round"))
    steps = Figure.of(steps_nm) if steps_nm else None
    step_um = (steps.mean if steps else known.step_nm) / NM_PER_UM
    return _recommend(
        known, steps, Figure.of([one * step_um for one in backlash]), [float(n) for n in backlash]
    )


def _must_be_ways(ways: Sequence[Ways], programme: Programme) -> None:
    """Refuse what cannot have been measured."""
    if programme.forward < 1 or programme.back < 1:
        raise TornilloError(_("a way of no steps tells nothing"), _("give at least one step"))
    for number, pair in enumerate(ways, start=1):
        good = all(math.isfinite(one) and one > 0 for one in (pair.first, pair.second))
        if not good:
            raise TornilloError(
                _("measurement {number}: {first:g} and {second:g} are no two lengths").format(
                    number=number, first=pair.first, second=pair.second
                ),
                _("give two numbers above 0: mark 1 to 2, and mark 2 to 3"),
            )


def _recommend(
    known: Known, steps: Figure | None, lengths: Figure, counts: Sequence[float]
) -> Calibration:
    """Compare what was measured with what is set."""
    backlash = Figure.of(counts)
    values: dict[SettingId, int] = {}
    if steps is not None and _differs(steps, known.step_nm):
        values[_STEP[known.axis]] = _fitting(_STEP[known.axis], round(steps.mean))
    travel = _switch_travel(known, backlash)
    if travel is not None and travel != known.switch_travel:
        values[_TRAVEL[known.axis]] = _fitting(_TRAVEL[known.axis], travel)
    return Calibration(known, steps, lengths, backlash, travel, values)


def _differs(steps: Figure, now: int) -> bool:
    """Whether a step is of another size than the lathe believes, beyond doubt."""
    doubt = 0.0 if math.isnan(steps.mean_within) else steps.mean_within
    return abs(steps.mean - now) > max(doubt, 0.5)


def _switch_travel(known: Known, backlash: Figure) -> int | None:
    """The travel of the switch, or None when homing has not counted.

    Raises TornilloError when homing counted fewer steps than the backlash has.
    """
    counted = known.dead + known.switch_travel
    if counted == 0:
        return None
    if known.dead == 0:
        raise TornilloError(
            _(
                "homing found no dead steps besides {switch_travel} steps of switch "
                "travel, so what it counted is not known"
            ).format(switch_travel=known.switch_travel),
            _("`tornillo settings set {travel} 0`, home, and calibrate again").format(
                travel=_TRAVEL[known.axis].name.lower()
            ),
        )
    travel = counted - round(backlash.mean)
    doubt = 0.0 if math.isnan(backlash.mean_within) else backlash.mean_within
    if travel < 0 and -travel > max(1.0, doubt):
        raise TornilloError(
            _(
                "{mean:.1f} steps of backlash were measured, but from its switch closing "
                "to opening homing counted {counted} steps in all"
            ).format(mean=backlash.mean, counted=counted),
            _("check the readings and their order, and that nothing is loose; home again"),
        )
    return max(travel, 0)


def _fitting(setting: SettingId, value: int) -> int:
    """`value` when the setting can take it."""
    entry = BY_ID[setting]
    if not entry.minimum <= value <= entry.maximum:
        raise TornilloError(
            _(
                "{setting} would have to be {value} {unit}, but goes from {minimum} to "
                "{maximum} {unit}"
            ).format(
                setting=setting.name.lower(),
                value=value,
                unit=unit(entry),
                minimum=entry.minimum,
                maximum=entry.maximum,
            ),
            _("check the units and the order of the readings"),
        )
    return value
