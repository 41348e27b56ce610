# SPDX-License-Identifier: Apache-2.0
"""Changes the settings of a lathe, one or a whole machine file, and says what that means."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from tornillo.errors import ChipError, LinkError, TornilloError
from tornillo.lathe import Lathe
from tornillo.protocol import Setting, SettingId
from tornillo.setting_names import BY_ID, amount, span

STEP_SIZES = frozenset({SettingId.STEP_X_NM, SettingId.STEP_Z_NM})


@dataclass(frozen=True)
class Change:
    """A setting that was stored: what it was and what it is."""

    setting: Setting
    old: int
    new: int

    def __str__(self) -> str:
        """The change in words, with unit and range."""
        name = self.setting.id.name.lower()
        return f"{name} was {self.old}, is {amount(self.setting, self.new)} ({span(self.setting)})"


def store(lathe: Lathe, setting: Setting, value: int) -> Change:
    """Change one setting in the lathe.

    Raises TornilloError with name and range when it lies outside or the lathe says no.
    """
    told = lathe.setting(setting.id)
    name = setting.id.name.lower()
    if not told.minimum <= value <= told.maximum:
        raise TornilloError(
            f"{name} cannot be {amount(setting, value)}: it goes from {span(setting, told)}",
            f"choose a value in this range; now it is {amount(setting, told.value)}",
        )
    try:
        lathe.set_setting(setting.id, value)
    except ChipError as error:
        raise TornilloError(
            f"{name} stays {amount(setting, told.value)} ({span(setting, told)}): {error}",
            error.remedy,
        ) from error
    return Change(setting, told.value, value)


def store_all(
    lathe: Lathe, values: Mapping[SettingId, int], tell: Callable[[Change], None]
) -> list[Change]:
    """Change every setting of `values` that has another value; `tell` is called after each.

    All of them are checked before the first is stored. Raises TornilloError when one lies outside
    its range, the lathe refuses, or it has kept something else; it says how many are stored.
    """
    told = {setting: lathe.setting(setting) for setting in values}
    for setting, value in values.items():
        now = told[setting]
        if not now.minimum <= value <= now.maximum:
            entry = BY_ID[setting]
            raise TornilloError(
                f"{setting.name.lower()} cannot be {amount(entry, value)}: it goes from "
                f"{span(entry, now)}; nothing was changed",
                "correct the file; it may belong to another version of the firmware",
            )
    due = [setting for setting, value in values.items() if told[setting].value != value]
    changes: list[Change] = []
    for setting in due:
        try:
            changes.append(store(lathe, BY_ID[setting], values[setting]))
        except TornilloError as error:
            raise TornilloError(
                f"{error}; {len(changes)} of {len(due)} changes are stored", error.remedy
            ) from error
        tell(changes[-1])
    for change in changes:
        kept = lathe.setting(change.setting.id).value
        if kept != change.new:
            raise LinkError(
                f"{change.setting.id.name.lower()} is {kept} in the lathe, not {change.new}",
                "load the file again; if it stays, the chip's memory is worn out",
            )
    return changes


def outdated_parts(lathe: Lathe, changes: list[Change]) -> list[str]:
    """Names of stored parts that were made for other screws, after a step size was changed."""
    if not any(change.setting.id in STEP_SIZES for change in changes):
        return []
    return [part.name for part in lathe.outdated_parts()]
