#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Write what the documentation takes from the program: commands, keys of part files, pins.

    python3 docs/generate_reference.py           write the pages
    python3 docs/generate_reference.py --check   exit 1 when one is stale

A table stands between `<!-- generated: NAME -->` and `<!-- end -->`.
"""

import re
import sys
from collections.abc import Callable
from pathlib import Path

DOCS = Path(__file__).resolve().parent
BOARD = DOCS.parent / "firmware" / "board.h"
PIN = re.compile(r"^BOARD_PIN\((\w+), (\w), (\d)\) *(?:/\* (.*?) \*/)?", re.MULTILINE)
MARKER = r"(<!-- generated: {name} -->\n).*?(<!-- end -->)"


def pins(say: Callable[[str], str] = str) -> str:
    """The pins of the chip as firmware/board.h has them."""
    heads = ("pin", "name in the firmware", "reads or means")
    rows = ["| " + " | ".join(say(head) for head in heads) + " |", "|---|---|---|"]
    for name, port, bit, meaning in PIN.findall(BOARD.read_text(encoding="utf-8")):
        rows.append(f"| R{port}{bit} | `{name}` | {say(meaning) if meaning else ''} |")
    return "\n".join(rows) + "\n"


def warnings() -> str:
    """All warnings in Spanish."""
    from tornillo.language import use
    from tornillo.protocol_texts import WARNING_TEXTS

    say = use("es").gettext
    rows = ["| bit | nombre | causa | qué hacer |", "|---|---|---|---|"]
    for flag, text in WARNING_TEXTS.items():
        cause, remedy = say(text.cause), say(text.remedy)
        rows.append(f"| 0x{flag.value:02X} | `{flag.name}` | {cause} | {remedy} |")
    use("en")
    return "\n".join(rows) + "\n"


def refusals() -> str:
    """Why the chip refuses parts, in Spanish."""
    from tornillo.language import use
    from tornillo.protocol_texts import REFUSAL_TEXTS

    say = use("es").gettext
    rows = ["| código | nombre | causa | qué hacer |", "|---|---|---|---|"]
    for refusal, text in REFUSAL_TEXTS.items():
        cause, remedy = say(text.cause), say(text.remedy)
        rows.append(f"| {refusal.value} | `{refusal.name}` | {cause} | {remedy} |")
    use("en")
    return "\n".join(rows) + "\n"


def alarms() -> str:
    """All alarms in Spanish."""
    from tornillo.language import use
    from tornillo.protocol_texts import ALARM_TEXTS

    say = use("es").gettext
    rows = ["| código | nombre | causa | qué hacer |", "|---|---|---|---|"]
    for alarm, text in ALARM_TEXTS.items():
        rows.append(f"| {alarm.value} | `{alarm.name}` | {say(text.cause)} | {say(text.remedy)} |")
    use("en")
    return "\n".join(rows) + "\n"


def settings() -> str:
    """All settings in Spanish."""
    from tornillo.language import use
    from tornillo.protocol import SETTINGS
    from tornillo.setting_names import unit

    say = use("es").gettext
    rows = ["| nombre | de fábrica | intervalo | unidad | significado |", "|---|---|---|---|---|"]
    for entry in SETTINGS:
        limits = f"{entry.minimum} a {entry.maximum}"
        name = entry.id.name.lower()
        rows.append(
            f"| `{name}` | {entry.default} | {limits} | {unit(entry)} | {say(entry.meaning)} |"
        )
    use("en")
    return "\n".join(rows) + "\n"


def pages() -> dict[str, str]:
    """Every page with its generated text, by its file name."""
    from cli_pages import page
    from part_keys import table_text
    from spanish import say

    found = {"cli.md": page("en"), "es/comandos.md": page("es")}
    for name, mark, text in (
        ("wiring.md", "pins", pins()),
        ("part-file.md", "keys", table_text()),
        ("es/alarmas.md", "alarms", alarms()),
        ("es/alarmas.md", "warnings", warnings()),
        ("es/cableado.md", "pins", pins(say)),
        ("es/archivo-de-pieza.md", "keys", table_text(say)),
        ("es/archivo-de-pieza.md", "refusals", refusals()),
        ("es/ajustes.md", "settings", settings()),
    ):
        old = found.get(name) or (DOCS / name).read_text(encoding="utf-8")
        place = re.search(MARKER.format(name=mark), old, re.DOTALL)
        if place is None:
            raise SystemExit(f"docs/{name}: no place for {mark}")
        found[name] = old[: place.end(1)] + text + old[place.start(2) :]
    return found


def main(arguments: list[str]) -> int:
    """Write or check; return the exit code."""
    if arguments not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    sys.path.insert(0, str(DOCS))
    stale = False
    for name, text in pages().items():
        path = DOCS / name
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        stale = True
        if arguments:
            print(f"docs/{name} is stale: run make docs")
        else:
            path.write_text(text, encoding="utf-8")
            print(f"docs/{name} written")
    return 1 if arguments and stale else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
