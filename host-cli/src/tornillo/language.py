# SPDX-License-Identifier: Apache-2.0
"""The language that the program speaks: English, or what a catalogue in `locale/` has.

`_("...")` says a message in it; values go in afterwards, `_("slot {slot}").format(slot=3)`.
`later("...")` only marks one. The first of TORNILLO_LANG, LANGUAGE, LC_ALL,
LC_MESSAGES and LANG that is set chooses; Windows is asked when none is.
"""

import gettext
import os
import sys
from pathlib import Path
from typing import Any

DOMAIN = "tornillo"
LOCALE = Path(__file__).parent / "locale"
VARIABLES = ("TORNILLO_LANG", "LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG")


class _Spoken:
    """The catalogue in use; None before the first message."""

    catalogue: gettext.NullTranslations | None = None


def _(message: str) -> str:
    """`message` in the user's language."""
    return (_Spoken.catalogue or use(chosen())).gettext(message)


def plural(one: str, many: str, count: int) -> str:
    """`one` or `many`, as the user's language has it for `count`."""
    return (_Spoken.catalogue or use(chosen())).ngettext(one, many, count)


def later(message: str) -> str:
    """`message` itself, marked for the catalogue; `_` is asked when it is said."""
    return message


def chosen() -> str:
    """The code of the language that the system asks for, like "es"; "en" when it does not tell."""
    for variable in VARIABLES:
        if os.environ.get(variable):
            return os.environ[variable].split(":")[0][:2].lower()
    return _windows_language() if sys.platform == "win32" else "en"


def _windows_language() -> str:
    """The code of the language that Windows shows its windows in."""
    import locale

    return locale.windows_locale.get(_windows_number(), "en")[:2]


def _windows_number() -> int:
    """The number of that language."""
    import ctypes

    libraries: Any = ctypes
    return int(libraries.windll.kernel32.GetUserDefaultUILanguage())


def use(language: str) -> gettext.NullTranslations:
    """Speak `language` from now on, English when there is no catalogue for it."""
    catalogue = gettext.translation(DOMAIN, LOCALE, [language], fallback=True)
    _Spoken.catalogue = catalogue
    # The words of the library that reads the command line are in the same catalogue.
    os.environ["LANGUAGE"] = language
    gettext.bindtextdomain(DOMAIN, LOCALE)
    gettext.textdomain(DOMAIN)
    return catalogue
