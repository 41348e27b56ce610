# SPDX-License-Identifier: Apache-2.0
"""Files that keep the settings of a lathe.

A machine file is TOML: [machine] says whose values they are, [settings] has one line for each
setting, in the lathe's own names and units:

    [settings]
    step_x_nm = 7112    # nm, 100 to 32000: one step of X
"""

import difflib
import json
from collections.abc import Mapping
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import NoReturn

from tornillo.errors import MachineError, PartError
from tornillo.language import _
from tornillo.protocol import SETTINGS, Setting, SettingId
from tornillo.setting_names import BY_NAME, amount, nearest, span
from tornillo.toml_source import Source


def file_text(values: Mapping[SettingId, int], name: str, source: str) -> str:
    """A machine file with `values`; `source` says where they come from."""
    lines = [
        "# Settings of a lathe; `tornillo settings load FILE` stores them, and",
        "# `tornillo check PART.toml --machine FILE` checks parts against them.",
        "",
        "[machine]",
        f"name = {json.dumps(name)}",
        f"source = {json.dumps(source)}",
        "",
        "[settings]",
    ]
    for entry in SETTINGS:
        if entry.id in values:
            line = f"{entry.id.name.lower()} = {values[entry.id]}"
            unit = f"{entry.unit}, " if entry.unit else ""
            bounds = f"{entry.minimum} to {entry.maximum}"
            lines.append(f"{line:<24}# {unit}{bounds}: {entry.meaning}")
    return "\n".join(lines) + "\n"


def read_file(text: str, name: str) -> dict[SettingId, int]:
    """The values in the text of a machine file called `name`.

    Raises MachineError, with the line and the range, for an unknown key, a value that is not a
    whole number or lies outside its range, and for a file without settings.
    """
    try:
        return _read(Source(name, text))
    except PartError as error:
        raise MachineError(str(error), error.remedy) from error


def load_file(name: str) -> dict[SettingId, int]:
    """The values in a machine file: one that comes with tornillo, or a path ending in .toml.

    Raises MachineError as `read_file`, or when there is none.
    """
    known = _shipped()
    path: Traversable = Path(name) if name.endswith(".toml") else known / f"{name}.toml"
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        names = ", ".join(sorted(entry.name.removesuffix(".toml") for entry in known.iterdir()))
        raise MachineError(
            _("machine {name}: {error}").format(name=name, error=error),
            _("use one of {names}, or the path of a machine file").format(names=names),
        ) from error
    return read_file(text, name)


def _shipped() -> Traversable:
    """The folder of machine files: in the package, or beside it in a source checkout."""
    packaged = files("tornillo") / "machines"
    return packaged if packaged.is_dir() else Path(__file__).resolve().parents[2] / "machines"


def _read(source: Source) -> dict[SettingId, int]:
    """The settings of a machine file."""
    for key in source.values:
        if key not in ("machine", "settings"):
            close = difflib.get_close_matches(key, ["machine", "settings"], n=1)
            remedy = (
                _('did you mean "{close}"?').format(close=close[0])
                if close
                else _("use [machine] and [settings]")
            )
            source.refuse((key,), _('unknown table "{key}"').format(key=key), remedy)
    table = source.values.get("settings")
    if not isinstance(table, dict) or not table:
        source.refuse(
            (),
            _("the table [settings] is missing"),
            _("write one with `tornillo settings save FILE`"),
        )
    return {_entry(source, key).id: _value(source, key, table[key]) for key in table}


def _entry(source: Source, key: str) -> Setting:
    """The setting of a key."""
    if key not in BY_NAME:
        source.refuse(("settings", key), _('unknown setting "{key}"').format(key=key), nearest(key))
    return BY_NAME[key]


def _value(source: Source, key: str, value: object) -> int:
    """The value of a key, inside its range."""
    entry = BY_NAME[key]
    if isinstance(value, bool) or not isinstance(value, int):
        _refuse(
            source,
            key,
            _("{key} must be a whole number, not {value!r}").format(key=key, value=value),
        )
    if not entry.minimum <= value <= entry.maximum:
        _refuse(
            source, key, _("{key} cannot be {entry}").format(key=key, entry=amount(entry, value))
        )
    return value


def _refuse(source: Source, key: str, message: str) -> NoReturn:
    """Refuse the value of a key with its range."""
    source.refuse(
        ("settings", key), message, _("it goes from {by_name}").format(by_name=span(BY_NAME[key]))
    )
