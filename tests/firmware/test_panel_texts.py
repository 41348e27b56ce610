# SPDX-License-Identifier: Apache-2.0
"""The menus as data: one place to add an entry, and texts that cannot be shown are refused."""

from __future__ import annotations

from pathlib import Path

import generate_menus
import menu_model
import menu_pages
import pytest
import text_code

MENUS = menu_model.MENUS.read_text(encoding="utf-8")
SUBMENU = "[[settings]]\n"
ENTRY = """[[settings]]
text = ["Home rate", "Vel. referencia"]
setting = "home_rate"
"""


def changed(folder: Path, old: str, new: str) -> Path:
    """menus.toml with something replaced."""
    assert old in MENUS
    path = folder / "menus.toml"
    path.write_text(MENUS.replace(old, new, 1), encoding="utf-8")
    return path


def decoded(code: text_code.TextCode, number: int) -> str:
    """A text as the chip finds and reads it."""
    stream = "".join(f"{byte:08b}" for byte in code.data[code.groups[number // text_code.GROUP] :])
    letters = {bits: letter for letter, bits in code.codes.items()}
    texts, found, bits = [], "", ""
    for bit in stream:
        bits += bit
        if bits in letters:
            found += letters[bits]
            bits = ""
            if found.endswith(text_code.END):
                texts.append(found)
                found = ""
                if len(texts) > number % text_code.GROUP:
                    break
    text = texts[-1].removesuffix(text_code.END)
    return text[:1].upper() + text[1:]


def test_what_is_written_belongs_to_the_menus_as_they_are() -> None:
    assert generate_menus.main(["--check"]) == 0


def test_every_text_comes_out_of_its_code_as_it_went_in() -> None:
    panel = menu_model.load()
    texts = [text for texts in panel.all_texts().values() for text in texts]
    all_of_them = [text[language] for language in (0, 1) for text in texts]
    code = text_code.TextCode(all_of_them)
    assert [decoded(code, number) for number in range(len(all_of_them))] == all_of_them
    # The chip counts codes in eight bits.
    assert sum(code.counts) == len(code.letters) < 128


def test_an_entry_is_added_in_one_place(tmp_path: Path) -> None:
    before = menu_model.load()
    after = menu_model.load(changed(tmp_path, SUBMENU, ENTRY + SUBMENU))
    first = after.first("settings")
    assert after.entries()[first].text == ("Home rate", "Vel. referencia")
    assert len(after.entries()) == len(before.entries()) + 1
    assert "X(KIND_SETTING, SETTING_HOME_RATE)" in generate_menus.header(after)
    page = "<!-- panel: menus -->\n<!-- end -->"
    assert "changes the setting `home_rate`" in menu_pages.fill(after, page, menu_pages.WORDS[0])
    spanish = menu_pages.fill(after, page, menu_pages.WORDS[1])
    assert "| Home rate | Vel. referencia | cambia el ajuste `home_rate` |" in spanish


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"Home", "Referencia"', '"Home", "Buscar referencia"', "more than 16"),
        ('"Home", "Referencia"', '"Home", "Referênci"', "has no 'ê'"),
        ('"Home", "Referencia"', '"home", "Referencia"', "capital"),
        ('"Home", "Referencia"', '"Home"', "not one text"),
        ('does = "home"', 'does = "homing"', "no such kind"),
        (', "cambia el idioma"', "", "kind language: not one text"),
        ('menu = "jog"', 'menu = "jogs"', "no submenu"),
        ('setting = "idle_ms"', 'setting = "idle"', "no such setting"),
    ],
)
def test_what_the_panel_cannot_show_or_do_is_refused(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        menu_model.load(changed(tmp_path, old, new))
