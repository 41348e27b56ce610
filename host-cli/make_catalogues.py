#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Collect every message, bring the catalogues up to date and compile them.

    python3 host-cli/make_catalogues.py           write them, and list what is not translated
    python3 host-cli/make_catalogues.py --check   write nothing; exit 1 when one is stale

A catalogue is `src/tornillo/locale/LANGUAGE/LC_MESSAGES/tornillo.po`: the English message and
what it is called. It is sorted and names no lines, so that work in parallel merges. The compiled
file beside it is what the program reads.
"""

import sys
from collections.abc import Iterator
from datetime import UTC, datetime
from io import BytesIO
from pathlib import Path

import click
from babel.messages.catalog import Catalog
from babel.messages.extract import extract_from_dir
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po

from tornillo.cli import main as command_line
from tornillo.help_texts import messages
from tornillo.protocol import SETTINGS, ResetCause, State
from tornillo.protocol_texts import ALARM_TEXTS, ERROR_TEXTS, REFUSAL_TEXTS, WARNING_TEXTS
from tornillo.verbs import SECTIONS, VERBS

SOURCE = Path(__file__).resolve().parent / "src" / "tornillo"
LOCALE = SOURCE / "locale"
OWN = {"_": None, "later": None, "plural": (1, 2)}
CLICK = {"_": None, "gettext": None, "ngettext": (1, 2)}
PYTHON = [("**.py", "python")]

#: The compiled file has a date; one that changes would make it differ each time.
NEVER = datetime(2026, 1, 1, tzinfo=UTC)

Message = str | tuple[str, ...]


def wanted() -> set[Message]:
    """Every message that a person can meet; a tuple has the words for one and for many."""
    found: set[Message] = set()
    for folder, keywords in ((SOURCE, OWN), (Path(click.__file__).parent, CLICK)):
        for _file, _line, message, _comments, _context in extract_from_dir(
            folder, method_map=PYTHON, keywords=keywords
        ):
            found.add(message if isinstance(message, str) else tuple(message))
    found.update(SECTIONS)
    found.update(verb.summary for verb in VERBS.values())
    found.update(_help())
    for texts in (ALARM_TEXTS, ERROR_TEXTS, REFUSAL_TEXTS, WARNING_TEXTS):
        for text in texts.values():
            found.update((text.cause, text.remedy))
    found.update(text for setting in SETTINGS for text in (setting.meaning, setting.unit))
    names = [*State, *ResetCause]
    found.update(name.name.lower().replace("_", "-") for name in names)
    return {message for message in found if not isinstance(message, str) or message.strip()}


def _help() -> Iterator[str]:
    """The help of all commands."""
    context = click.Context(command_line)
    yield from messages(command_line)
    for name in VERBS:
        command = command_line.get_command(context, name)
        assert command is not None
        yield from messages(command)


def updated(old: Catalog, language: str) -> Catalog:
    """A catalogue of exactly the wanted messages, with the translations of `old`."""
    new = Catalog(locale=language, domain="tornillo", project="Tornillo", fuzzy=False)
    new.header_comment = (
        "# SPDX-License-Identifier: Apache-2.0\n# Written by host-cli/make_catalogues.py; "
        "only the lines that begin with msgstr are written by hand."
    )
    for message in sorted(wanted(), key=str):
        known = old.get(message if isinstance(message, str) else message[0])
        new.add(message, known.string if known is not None else "")
    return new


def texts(catalogue: Catalog) -> tuple[bytes, bytes]:
    """The catalogue as people edit it, and as the program reads it."""
    written, compiled = BytesIO(), BytesIO()
    write_po(written, catalogue, width=100, omit_header=False, sort_output=False)
    lines = written.getvalue().decode("utf-8").splitlines(keepends=True)
    kept = [line for line in lines if not line.startswith(VARYING)]
    undated = read_po(BytesIO("".join(kept).encode("utf-8")), locale=catalogue.locale)
    undated.creation_date = undated.revision_date = NEVER
    write_mo(compiled, undated)
    return "".join(kept).encode("utf-8"), compiled.getvalue()


#: Lines of a header that would differ without any change of the messages.
VARYING = (
    '"POT-Creation-Date',
    '"PO-Revision-Date',
    '"Generated-By',
    '"Last-Translator',
    '"Language-Team',
    '"Project-Id-Version',
    '"Report-Msgid-Bugs-To',
)


def main(arguments: list[str]) -> int:
    """Write or check; return the exit code."""
    if arguments not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    stale = False
    for path in sorted(LOCALE.glob("*/LC_MESSAGES/tornillo.po")):
        language = path.parents[1].name
        with path.open("rb") as file:
            catalogue = updated(read_po(file, locale=language), language)
        for place, text in zip((path, path.with_suffix(".mo")), texts(catalogue), strict=True):
            if place.exists() and place.read_bytes() == text:
                continue
            stale = True
            became = "is stale: run make catalogues" if arguments else "written"
            print(f"{place.relative_to(SOURCE)} {became}")
            if not arguments:
                place.write_bytes(text)
        missing = [message.id for message in catalogue if message.id and not message.string]
        for message in missing:
            print(f"{language}: not translated: {message!r}")
    return 1 if arguments and stale else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
