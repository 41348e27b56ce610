# SPDX-License-Identifier: Apache-2.0
"""Settings by name, and their ranges in words with units."""

import difflib

from tornillo.errors import TornilloError
from tornillo.language import _
from tornillo.protocol import SETTINGS, Setting, SettingGetData, SettingId

BY_ID: dict[SettingId, Setting] = {entry.id: entry for entry in SETTINGS}
BY_NAME: dict[str, Setting] = {entry.id.name.lower(): entry for entry in SETTINGS}


def named(name: str) -> Setting:
    """The setting called `name`; raises TornilloError with the nearest name."""
    known = name.lower()
    if known not in BY_NAME:
        raise TornilloError(_('there is no setting "{name}"').format(name=name), nearest(known))
    return BY_NAME[known]


def nearest(name: str) -> str:
    """A question for the setting that was meant by `name`."""
    close = difflib.get_close_matches(name, BY_NAME, n=1)
    return (
        _('did you mean "{close}"?').format(close=close[0])
        if close
        else _("see `tornillo settings`")
    )


def unit(setting: Setting) -> str:
    """The unit of a setting in the user's language; empty when it has none."""
    return _(setting.unit) if setting.unit else ""


def amount(setting: Setting, value: int) -> str:
    """`value` with its unit."""
    return f"{value} {unit(setting)}".rstrip()


def span(setting: Setting, told: SettingGetData | None = None) -> str:
    """The range of a setting with its unit, as the chip tells it or else as the protocol does."""
    low, high = (told.minimum, told.maximum) if told else (setting.minimum, setting.maximum)
    return _("{low} to {setting}").format(low=low, setting=amount(setting, high))


def explained(setting: Setting, told: SettingGetData | None = None) -> str:
    """Name, meaning and range of a setting."""
    return f"{setting.id.name.lower()}: {_(setting.meaning)}, {span(setting, told)}"
