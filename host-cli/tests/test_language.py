# SPDX-License-Identifier: Apache-2.0
"""Every message can be said in every language there is a catalogue for."""

import ast
import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from babel.messages.catalog import Catalog
from babel.messages.pofile import read_po
from click.testing import CliRunner
from console import Tornillo
from scripted_chip import IDLE, ScriptedChip

from tornillo import language
from tornillo.cli import main
from tornillo.protocol import Alarm, Command, ErrorCode, State

HOST = Path(__file__).resolve().parents[1]
SOURCE = HOST / "src" / "tornillo"
CATALOGUES = sorted((SOURCE / "locale").glob("*/LC_MESSAGES/tornillo.po"))
FIELD = re.compile(r"\{[^{}]*\}|%\(\w+\)s")
#: Functions whose text the catalogue has; `_length` makes an option of its help.
SAID = ("_", "later", "plural", "_length")
#: Functions that show a text, be it a single word.
SHOWN = ("echo", "print", "TornilloError")
#: What is no text for people: names of files and styles, patterns, what other programs say, the
#: text of part files and pictures, what only the library's caller sees.
NO_MESSAGES = {
    "frames.py": ".*",
    "interview.py": r"the new part|\[\[operation",
    "keys.py": ".*",
    "part_writer.py": ".*",
    "protocol.py": ".*",
    "protocol_texts.py": ".*",
    "scene.py": ".*",
    "sheet.py": r"Ø",
    "terminal_picture.py": ".*",
    "verbs.py": ".*",
    "__init__.py": ".*",
    "cli.py": r"tornillo\.commands\.",
    "commands/import_dxf.py": r"problem\.svg",
    "commands/jog_pad.py": "bold yellow",
    "commands/following.py": r"task\.",
    "commands/new.py": r"\^the new part",
    "commands/running.py": "dead steps|last start|waits for",
    "commands/watch.py": "bold ",
    "dxf/entities.py": r"Iterator\[",
    "dxf/part_text.py": ".*",
    "machine_file.py": r"\.toml|^# |^(name|source) = |^\{\} to \{\}$",
    "opening.py": "exclusively lock",
    "operations.py": "^drill ",
    "ports.py": "/dev/",
    "readout.py": "/min",
    "toml_source.py": r"at line|list\[str\]",
    "udev.py": "^sudo ",
    "units.py": "/min",
}


def sentences(path: Path) -> Iterator[tuple[int, str]]:
    """Line and text of every string that reads like a text for people and is not said by `_`."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    parent = {child: node for node in ast.walk(tree) for child in ast.iter_child_nodes(node)}
    for node in ast.walk(tree):
        text = _text(node, parent)
        if text is None:
            continue
        above = parent[node]
        shown = isinstance(above, ast.Call) and node in above.args and _name(above) in SHOWN
        if not re.search(r"[A-Za-z]{3,}" if shown else r"[A-Za-z]{2,}.* | +[A-Za-z]{3,}", text):
            continue
        if isinstance(above, ast.Call) and getattr(above.func, "id", "") in SAID:
            continue
        if isinstance(above, ast.keyword) and above.arg in ("help", "metavar"):
            continue
        if not isinstance(above, ast.Expr):  # those are docstrings
            yield getattr(node, "lineno", 0), text


def _name(call: ast.Call) -> str:
    """The name of the function that is called, without its module."""
    return getattr(call.func, "attr", "") or getattr(call.func, "id", "")


def _text(node: ast.AST, parent: dict[ast.AST, ast.AST]) -> str | None:
    """The text of a string; of a formatted one with empty fields."""
    if isinstance(node, ast.JoinedStr):
        parts = (
            str(part.value) if isinstance(part, ast.Constant) else "{}" for part in node.values
        )
        return "".join(parts)
    inside = isinstance(parent.get(node), ast.JoinedStr | ast.FormattedValue)
    if isinstance(node, ast.Constant) and isinstance(node.value, str) and not inside:
        return node.value
    return None


def test_no_message_is_written_without_the_catalogue() -> None:
    found = []
    for path in sorted(SOURCE.rglob("*.py")):
        name = path.relative_to(SOURCE).as_posix()
        allowed = re.compile(NO_MESSAGES.get(name, "(?!)"), re.DOTALL)
        found += [
            f"{name}:{line}: {text}" for line, text in sentences(path) if not allowed.search(text)
        ]
    assert found == []


def test_a_forgotten_message_would_be_found(tmp_path: Path) -> None:
    path = tmp_path / "forgotten.py"
    path.write_text(
        '"""A module."""\nraise TornilloError("the lathe is upset", _("be kind"))\n'
        'print(f"slot {3} is empty")\nclick.echo("stopped", err=True)\n',
        encoding="utf-8",
    )
    assert [text for _line, text in sentences(path)] == [
        "the lathe is upset",
        "slot {} is empty",
        "stopped",
    ]


@pytest.fixture(params=CATALOGUES, ids=lambda path: path.parents[1].name)
def catalogue(request: pytest.FixtureRequest) -> Catalog:
    """One catalogue."""
    path: Path = request.param
    with path.open("rb") as file:
        return read_po(file, locale=path.parents[1].name)


def test_there_is_a_spanish_catalogue_and_it_is_fresh() -> None:
    assert "es" in [path.parents[1].name for path in CATALOGUES]
    done = subprocess.run(
        [sys.executable, str(HOST / "make_catalogues.py"), "--check"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "")


def test_every_message_is_translated_with_all_its_fields(catalogue: Catalog) -> None:
    missing, wrong = [], []
    for message in catalogue:
        if not message.id:
            continue
        ids = message.id if isinstance(message.id, tuple | list) else (message.id,)
        texts = message.string if isinstance(message.string, tuple | list) else (message.string,)
        if not all(texts):
            missing.append(ids[0])
        elif sorted(FIELD.findall(ids[-1])) != sorted(FIELD.findall(texts[-1] or "")):
            wrong.append(ids[-1])
    assert (missing, wrong) == ([], [])


def test_the_words_of_the_trade_are_those_of_the_papers(catalogue: Catalog) -> None:
    said = "\n".join(str(message.string) for message in catalogue).lower()
    for word in (
        "torno",
        "husillo",
        "refrenta",
        "pasos muertos",
        "cero pieza",
        "avance",
        "mandril",
    ):
        assert word in said, word


def spanish(*arguments: str) -> str:
    """What a command shows to somebody who speaks Spanish."""
    result = CliRunner(env={"TORNILLO_LANG": "es"}).invoke(main, list(arguments))
    return result.output


def test_help_is_shown_in_spanish_from_its_first_to_its_last_word() -> None:
    # In a process of its own: the library of the command line says its own words only once.
    program = "from tornillo.cli import main; main(['-h'])"
    environment = {**os.environ, "TORNILLO_LANG": "es"}
    shown = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        encoding="utf-8",
        check=True,
        env=environment,
    ).stdout
    assert "Uso: " in shown
    assert "Piezas en el torno:" in shown
    assert "Busca los interruptores de límite y mide los pasos muertos." in shown
    assert "Muestra este mensaje y termina." in shown
    shown = spanish("run", "--help")
    assert "Ejemplos: tornillo run test-bar --follow" in shown
    assert "Muestra el progreso hasta el final." in shown
    shown = spanish("settings", "get", "--help")
    assert "Imprime solo el valor de NAME;" in shown
    english = CliRunner(env={"TORNILLO_LANG": "en"}).invoke(main, ["run", "--help"]).output
    assert "Examples: tornillo run test-bar --follow" in english


def test_refusals_are_explained_in_spanish(
    tornillo: Tornillo, chip: ScriptedChip, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("TORNILLO_LANG", "es")
    chip.refusals[Command.HOME] = bytes([ErrorCode.ESTOP])
    result = tornillo("home")
    assert "HOME fue rechazado: el paro de emergencia está pulsado" in result.stderr
    assert "Intente: suelte el paro de emergencia, después `tornillo reset`" in result.stderr
    chip.status = IDLE._replace(state=State.ALARM, alarm=Alarm.LIMIT, alarm_detail=1)
    assert "alarma LIMIT de Z: un interruptor de límite se cerró" in tornillo("status").stdout
    wrong = tmp_path / "p.toml"
    wrong.write_text('[part]\nname = "p"\nunits = "mm"\n[stok]\n', encoding="utf-8")
    result = tornillo("check", wrong)
    assert 'clave desconocida "stok"' in result.stderr
    assert '¿quiso decir "stock"?' in result.stderr
    assert 'no hay ningún verbo "hom"; ¿quiso decir "home"?' in tornillo("hom").stderr


def test_settings_are_explained_in_spanish_with_their_units(
    tornillo: Tornillo, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TORNILLO_LANG", "es")
    explained = "zero_z: Z de máquina de la cara frontal de la pieza, -32000 a 0 pasos\n"
    assert tornillo("settings", "get", "zero_z").stderr == explained
    refused = tornillo("settings", "set", "home_rate", "10").stderr
    assert "home_rate no puede ser 10 pasos/s: va de 20 a 4000 pasos/s" in refused
    listed = tornillo("settings").stdout
    head = ["nombre", "valor", "unidad", "mínimo", "máximo", "significado"]
    assert listed.splitlines()[0].split() == head
    assert "pasos/s2" in listed
    assert "step" not in re.sub(r"\bstep_[xz]_nm", "", listed)


def test_a_stop_is_told_in_spanish(tornillo: Tornillo, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TORNILLO_LANG", "es")
    assert tornillo("stop").stdout == "detenido\n"


def test_scripts_read_the_same_in_every_language(
    tornillo: Tornillo, monkeypatch: pytest.MonkeyPatch, test_bar: Path
) -> None:
    told = []
    for code in ("en", "es"):
        monkeypatch.setenv("TORNILLO_LANG", code)
        status = json.loads(tornillo("status", "--json").stdout)
        check = json.loads(tornillo("check", test_bar, "--json").stdout)
        told.append((status, check, json.loads(tornillo("settings", "--json").stdout)))
    assert told[0] == told[1]


@pytest.mark.parametrize(
    ("variables", "code"),
    [
        ({"TORNILLO_LANG": "es", "LANG": "de_DE.UTF-8"}, "es"),
        ({"LANGUAGE": "es:en", "LANG": "de_DE.UTF-8"}, "es"),
        ({"LC_ALL": "es_MX.UTF-8", "LANG": "C"}, "es"),
        ({"LANG": "es_ES.UTF-8"}, "es"),
        ({"LANG": "de_DE.UTF-8"}, "de"),
        ({}, "en"),
    ],
)
def test_the_system_chooses_the_language(
    monkeypatch: pytest.MonkeyPatch, variables: dict[str, str], code: str
) -> None:
    for name in language.VARIABLES:
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert language.chosen() == code
    said = language.use(code).gettext("dead steps")
    assert said == ("pasos muertos" if code == "es" else "dead steps")


def test_windows_is_asked_when_nothing_else_tells(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in language.VARIABLES:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("tornillo.language.sys.platform", "win32")
    monkeypatch.setattr(language, "_windows_number", lambda: 0x080A)
    assert language.chosen() == "es"
    monkeypatch.setattr(language, "_windows_number", lambda: 0xFFFF)
    assert language.chosen() == "en"


def test_numbers_choose_between_one_and_many() -> None:
    language.use("es")
    assert language.plural("{count} pass", "{count} passes", 1) == "{count} pasada"
    assert language.plural("{count} pass", "{count} passes", 2) == "{count} pasadas"
    language.use("en")
    assert language.plural("{count} pass", "{count} passes", 1) == "{count} pass"
