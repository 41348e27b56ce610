# SPDX-License-Identifier: Apache-2.0
"""The guide in Spanish has what the English one has, and its tables come from the same place."""

import re
from pathlib import Path

import menu_model
import menu_pages
import pytest
import spanish
from generate_reference import pins
from part_keys import sections, table_text
from tornillo.language import use
from tornillo.protocol import SETTINGS
from tornillo.setting_names import unit

DOCS = Path(__file__).resolve().parents[2] / "docs"
#: The pages for those who use the lathe, and what they are called in Spanish.
PAGES = {
    "first-cut": "primer-corte",
    "terminal": "terminal",
    "panel": "panel",
    "cli": "comandos",
    "part-file": "archivo-de-pieza",
    "dxf": "dxf",
    "alarms": "alarmas",
    "safety": "seguridad",
    "wiring": "cableado",
    "settings": "ajustes",
    "calibration": "calibracion",
    "flashing": "actualizar",
}
#: Pages that are translated sentence by sentence; the others are shorter in Spanish.
WHOLE = [
    *("panel", "part-file", "dxf", "wiring", "settings", "calibration"),
    *("alarms", "safety", "flashing"),
]
TABLE = re.compile(r"<!-- (?:generated|table|panel): \w+ -->.*?<!-- end -->", re.DOTALL)
#: What stands in code and has words for people in it all the same.
OWN = {
    "--axis PLACE": "--axis LUGAR",
    "--port NAME": "--port NOMBRE",
    "last start": "último arranque",
    "tornillo draw part.toml -o part.svg": "tornillo draw pieza.toml -o pieza.svg",
    "tornillo flash FILE.hex --check": "tornillo flash ARCHIVO.hex --check",
    "--front PLACE": "--front LUGAR",
    "tornillo check FILE": "tornillo check ARCHIVO",
    "tornillo download PART -o FILE": "tornillo download PIEZA -o ARCHIVO",
    "tornillo draw FILE -o part.svg": "tornillo draw ARCHIVO -o pieza.svg",
    "tornillo settings set panel 1": "tornillo settings set panel 2",
    'tool = "name"': 'tool = "nombre"',
    "[front, back]": "[frente, fondo]",
    "[start, end]": "[principio, final]",
}


def text(page: str) -> str:
    """A page without its generated tables."""
    return TABLE.sub("", (DOCS / f"{page}.md").read_text(encoding="utf-8"))


def blocks(page: str) -> list[str]:
    """What is shown as typed, but for what people say in it."""
    found = re.findall(r"^```\w*\n(.*?)^```$", text(page), re.MULTILINE | re.DOTALL)
    return [re.sub(r" +# .*", "", block) for block in found]


def names(page: str) -> set[str]:
    """Keys, settings, options and commands that a page speaks of."""
    running = re.sub(r"^```.*?^```$", "", text(page), flags=re.MULTILINE | re.DOTALL)
    return set(re.findall(r"`([^`\n]+)`", running))


def shape(page: str) -> list[str]:
    """Headings, rows of tables and pictures of a page, as one sign each."""
    lines = re.sub(r"^```.*?^```$", "", text(page), flags=re.MULTILINE | re.DOTALL).splitlines()
    heads = [re.match(r"#+ |\||!\[", line) for line in lines]
    return [head[0] for head in heads if head]


def test_every_page_for_users_is_there_in_spanish_and_can_be_found() -> None:
    index = (DOCS / "es" / "index.md").read_text(encoding="utf-8")
    assert {page.stem for page in (DOCS / "es").iterdir()} == {*PAGES.values(), "index"}
    for english, name in PAGES.items():
        assert (DOCS / f"{english}.md").is_file()
        assert f"({name}.md)" in index


@pytest.mark.parametrize("page", WHOLE)
def test_a_page_has_the_sections_rows_and_names_of_the_english_one(page: str) -> None:
    other = f"es/{PAGES[page]}"
    assert shape(other) == shape(page)
    wanted = {OWN.get(name, name) for name in names(page)}
    assert wanted - names(other) == set()


@pytest.mark.parametrize("page", ["panel", "part-file", "dxf", "wiring"])
def test_what_is_typed_is_the_same_in_spanish(page: str) -> None:
    own = [
        block.replace("settings set panel 2", "settings set panel 1")
        for block in blocks(f"es/{PAGES[page]}")
    ]
    assert own == blocks(page)


def test_a_word_without_spanish_stops_the_generator() -> None:
    with pytest.raises(SystemExit, match=r"no Spanish for 'front \{\} back'"):
        spanish.said_with_figures("front 2 back")
    with pytest.raises(SystemExit, match="no Spanish for 'a new kind'"):
        spanish.say("a new kind")


def test_no_spanish_word_is_kept_for_nothing() -> None:
    used: set[str] = set()

    def note(words: str) -> str:
        used.add(words)
        return spanish.say(words)

    pins(note)
    table_text(note)
    page = (DOCS / "calibration.md").read_text(encoding="utf-8")
    table = page.partition("<!-- switch travel -->\n")[2].partition("<!-- end -->")[0]
    cells = [cell.strip() for line in table.splitlines() for cell in line.strip("|").split("|")]
    used |= {spanish.FIGURE.sub("{}", cell) for cell in cells}
    assert set(spanish.WORDS) - used == set()


def test_figures_stay_as_they_are() -> None:
    shown = spanish.translated(
        "| drawn | 0, inwards |\n|---|---|\n| -0.202 mm (-0.0080 inch) | 7 |\n"
    )
    assert shown == ("| dibujado | 0, adentro |\n|---|---|\n| -0.202 mm (-0.0080 pulgadas) | 7 |\n")


def test_the_keys_of_part_files_are_the_same_in_both_languages() -> None:
    assert [[key.name for key in keys] for keys in sections(spanish.say).values()] == [
        [key.name for key in keys] for keys in sections().values()
    ]


def test_the_menus_have_the_same_texts_on_both_pages() -> None:
    panel = menu_model.load()
    for tables in (menu_pages.menus, menu_pages.alarms):
        english, own = (tables(panel, words).splitlines() for words in menu_pages.WORDS)
        assert len(english) == len(own) > 10
    rows = [row for row in own if row.startswith("| 1")]
    assert [row for row in english if row.startswith("| 1")] == rows != []


def test_settings_have_their_units_in_spanish() -> None:
    use("es")
    units = {unit(entry) for entry in SETTINGS}
    use("en")
    assert units == {"", "nm", "pasos", "pasos/s", "pasos/s2", "ms", "us", "rpm"}
