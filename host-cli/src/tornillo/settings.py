# SPDX-License-Identifier: Apache-2.0
"""Changes the settings of a lathe, one or a whole machine file, and says what that means."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from tornillo.errors import ChipError, LinkError, TornilloError
from tornillo.language import _
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
        return _("{name} was {old}, is {setting} ({setting2})").format(
            name=name,
            old=self.old,
            setting=amount(self.setting, self.new),
            setting2=span(self.setting),
        )


def store(lathe: Lathe, setting: Setting, value: int) -> Change:
    """Change one setting in the lathe.

    Raises TornilloError with name and range when it lies outside or the lathe says no.
    """
    told = lathe.setting(setting.id)
    name = setting.id.name.lower()
    if not told.minimum <= value <= told.maximum:
        raise TornilloError(
            _("{name} cannot be {setting}: it goes from {setting2}").format(
                name=name, setting=amount(setting, value), setting2=span(setting, told)
            ),
            _("choose a value in this range; now it is {setting}").format(
                setting=amount(setting, told.value)
            ),
        )
    try:
        lathe.set_setting(setting.id, value)
    except ChipError as error:
        raise TornilloError(
            _("{name} stays {setting} ({setting2}): {error}").format(
                name=name,
                setting=amount(setting, told.value),
                setting2=span(setting, told),
                error=error,
            ),
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
                _("{setting} cannot be {entry}: it goes from {entry2}; nothing was changed").format(
                    setting=setting.name.lower(),
                    entry=amount(entry, value),
                    entry2=span(entry, now),
                ),
                _("correct the file; it may belong to another version of the firmware"),
            )
    due = [setting for setting, value in values.items() if told[setting].value != value]
    changes: list[Change] = []
    for setting in due:
        try:
            changes.append(store(lathe, BY_ID[setting], values[setting]))
        except TornilloError as error:
            raise TornilloError(
                _("{error}; {changes} of {due} changes are stored").format(
                    error=error, changes=len(changes), due=len(due)
                ),
                error.remedy,
            ) from error
        tell(changes[-1])
    for change in changes:
        kept = lathe.setting(change.setting.id).value
        if kept != change.new:
            raise LinkError(
                _("{id} is {kept} in the lathe, not {new}").format(
                    id=change.setting.id.name.lower(), kept=kept, new=change.new
                ),
                _("load the file again; if it stays, the chip's memory is worn out"),
            )
    return changes


def outdated_parts(lathe: Lathe, changes: list[Change]) -> list[str]:
    """Names of stored parts that were made for other screws, after a step size was changed."""
    if not any(change.setting.id in STEP_SIZES for change in changes):
        return []
    return [part.name for part in lathe.outdated_parts()]
