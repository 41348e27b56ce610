# SPDX-License-Identifier: Apache-2.0
"""A calibration in words, and for scripts."""

import math

from tornillo.calibration import Calibration, Figure
from tornillo.language import _
from tornillo.protocol import Axis
from tornillo.setting_names import BY_ID, amount, span

#: After the point, for scripts.
DIGITS = 6


def report(found: Calibration) -> list[str]:
    """Lines for a person: figures, then what is recommended."""
    lines = [
        _("axis {axis}, {count} measurements").format(
            axis=found.known.axis.name, count=found.backlash.count
        )
    ]
    if found.step_nm is not None:
        lines.append(
            _("step size   {step_nm}; set is {step_nm2}").format(
                step_nm=_figure(found.step_nm, "nm", 1), step_nm2=found.known.step_nm
            )
        )
    lines += [
        _("backlash    {backlash_um}").format(backlash_um=_figure(found.backlash_um, "um", 2)),
        _("            {backlash}; the lathe takes up {dead}").format(
            backlash=_figure(found.backlash, _("steps"), 1), dead=found.known.dead
        ),
    ]
    if found.switch_travel is not None:
        travel, now = found.switch_travel, found.known.switch_travel
        lines.append(
            _("switch      {travel} steps of travel; set is {now}").format(travel=travel, now=now)
        )
    return [*lines, *_recommendation(found)]


def _figure(figure: Figure, unit: str, decimals: int) -> str:
    """Mean and three sigma, of one value and of the mean."""
    mean = f"{figure.mean:.{decimals}f} {unit}"
    text = _("mean {mean}").format(mean=mean)
    if math.isnan(figure.sigma):
        return _("{text} (one measurement: no deviation known)").format(text=text)
    return _("{text}, 3 sigma {one}, of the mean {all}").format(
        text=text,
        one=f"{figure.three_sigma:.{decimals}f} {unit}",
        all=f"{figure.mean_within:.{decimals}f}",
    )


def _recommendation(found: Calibration) -> list[str]:
    """What to store."""
    lines = []
    for setting, value in found.values.items():
        entry = BY_ID[setting]
        name = setting.name.lower()
        lines.append(
            _("recommended {name} {entry} ({entry2})").format(
                name=name, entry=amount(entry, value), entry2=span(entry)
            )
        )
    if found.switch_travel is None:
        lines.append(
            _("the travel of the switch is not known: it takes the dead steps that homing found")
        )
    elif not found.values:
        lines.append(_("recommended nothing: the settings are right"))
    return lines


def as_json(found: Calibration) -> dict[str, object]:
    """Everything, for scripts."""
    return {
        "axis": found.known.axis.name,
        "measurements": found.backlash.count,
        "step_nm": None if found.step_nm is None else _numbers(found.step_nm),
        "backlash_um": _numbers(found.backlash_um),
        "backlash_steps": _numbers(found.backlash),
        "dead_steps": found.dead,
        "switch_travel_steps": found.switch_travel,
        "recommended": {setting.name.lower(): value for setting, value in found.values.items()},
    }


def _numbers(figure: Figure) -> dict[str, float | None]:
    """A figure; deviations of one value alone are not known."""
    known = not math.isnan(figure.sigma)
    return {
        "mean": round(figure.mean, DIGITS),
        "sigma": round(figure.sigma, DIGITS) if known else None,
        "three_sigma": round(figure.three_sigma, DIGITS) if known else None,
    }


def axis_named(name: str) -> Axis:
    """The axis called x or z."""
    return Axis[name.upper()]
