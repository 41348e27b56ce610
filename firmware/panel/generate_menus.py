#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Write every file that is derived from menus.toml.

    python3 firmware/panel/generate_menus.py           write the files
    python3 firmware/panel/generate_menus.py --check   exit 1 when one is stale

Written are `menus.h` and `texts.inc` for the firmware and the tables between the markers of
`docs/panel.md` and `docs/es/panel.md`. Only the standard library is needed.
"""

from __future__ import annotations

import sys
from pathlib import Path

from menu_model import HERE, LANGUAGES, Panel, load
from menu_pages import WORDS, fill
from text_code import END, TextCode

ROOT = HERE.parents[1]
#: The pages of the panel, in the order of the languages.
PAGES = (ROOT / "docs" / "panel.md", ROOT / "docs" / "es" / "panel.md")
NOTICE = "Generated from menus.toml by generate_menus.py: do not edit."
LAST = 0x80
#: Of the first letter of ours, both its code and its place in the display's memory.
FIRST_LETTER = 1


def define(name: str, value: int | str) -> str:
    """One definition of C."""
    return f"#define {name:<24} {value}"


def header(panel: Panel) -> str:
    """The whole of menus.h."""
    lines = [
        "/* SPDX-License-Identifier: Apache-2.0",
        " *",
        " * Numbers of the panel's menus and texts.",
        f" * {NOTICE}",
        " */",
        "#ifndef MENUS_H",
        "#define MENUS_H",
        "",
        "/* What an entry does, and the bit of a menu's last one. */",
    ]
    kinds = list(panel.kinds)
    lines += [define(f"KIND_{name.upper()}", number) for number, name in enumerate(kinds)]
    lines += [define("MENU_LAST", f"0x{LAST:02X}"), "", "/* First text of each group. */"]
    number = 0
    for group, texts in panel.all_texts().items():
        lines.append(define(f"TEXT_{group}", number))
        number += len(texts)
    rows = []
    for entry in panel.entries():
        kind = f"KIND_{entry.kind.upper()}" + (" | MENU_LAST" if entry.last else "")
        with_ = entry.argument
        if entry.kind == "menu":
            with_ = panel.first(str(with_))
        elif entry.kind == "setting":
            with_ = f"SETTING_{str(with_).upper()}"
        rows.append(f"    X({kind}, {with_})")
    lines += ["", "/* MENU_ENTRIES(X): X(kind, with) for each entry, its text is its number. */"]
    lines += macro("MENU_ENTRIES(X)", rows)
    ways = [
        f"    X({way}{' | WAY_AXIS' if number in panel.with_axis() else ''})"
        for number, way in enumerate(panel.way_numbers())
    ]
    lines += ["", "/* ALARM_WAYS(X): X(way) for each alarm by number, from TEXT_WAY; with a bit"]
    lines += [" * where it concerns an axis. */", define("WAY_AXIS", f"0x{LAST:02X}")]
    lines += macro("ALARM_WAYS(X)", ways)
    return "\n".join([*lines, "", "#endif", ""])


def macro(name: str, rows: list[str]) -> list[str]:
    """A definition of several lines."""
    lines = [f"#define {name}", *rows]
    return [f"{line:<77}\\" for line in lines[:-1]] + lines[-1:]


def bytes_of(values: list[int]) -> list[str]:
    """Rows of db, 12 bytes each; the assembler wants an even number, so a 0 may come last."""
    values = values + [0] * (len(values) % 2)
    return [
        "        db      " + ", ".join(str(value) for value in values[at : at + 12])
        for at in range(0, len(values), 12)
    ]


def assembly(panel: Panel) -> str:
    """The whole of texts.inc."""
    groups = [text for texts in panel.all_texts().values() for text in texts]
    texts = [text[number] for number in range(len(LANGUAGES)) for text in groups]
    code = TextCode(texts)
    signs = {letter: FIRST_LETTER + number for number, letter in enumerate(panel.letters)}
    signs[END] = 0
    rows = [int(row, 2) for letter in panel.letters.values() for row in letter]
    lines = [
        "; Texts and letters of the panel.",
        "; SPDX-License-Identifier: Apache-2.0",
        ";",
        f"; {NOTICE}",
        "",
        f"TEXT_COUNT      equ     {len(groups)}",
        "",
        "text_groups:                            ; where every eighth text begins",
    ]
    lines += [
        f"        db      LOW(text_bits + {at}), HIGH(text_bits + {at})" for at in code.groups
    ]
    lines += ["text_counts:                            ; letters with 1, 2, ... bits"]
    lines += bytes_of(code.counts)
    lines += ["text_letters:                           ; in the order of their codes"]
    lines += bytes_of([signs.get(letter, ord(letter)) for letter in code.letters])
    lines += ["text_patterns:                          ; eight rows of dots each"]
    lines += bytes_of(rows)
    lines += ["text_bits:"]
    lines += bytes_of(list(code.data))
    return "\n".join([*lines, ""])


def derived() -> dict[Path, str]:
    """Path and wanted contents of every derived file."""
    panel = load()
    found = {HERE / "menus.h": header(panel), HERE / "texts.inc": assembly(panel)}
    for page, words in zip(PAGES, WORDS, strict=True):
        if page.exists():
            found[page] = fill(panel, page.read_text(encoding="utf-8"), words)
    return found


def main(arguments: list[str]) -> int:
    """Write or check; return the exit code."""
    if arguments not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    stale = [
        (path, text)
        for path, text in derived().items()
        if not path.exists() or path.read_text(encoding="utf-8") != text
    ]
    for path, text in stale:
        name = path.relative_to(ROOT)
        if arguments:
            print(f"{name} is stale: run python3 firmware/panel/generate_menus.py")
        else:
            path.write_text(text, encoding="utf-8")
            print(f"{name} written")
    return 1 if arguments and stale else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
