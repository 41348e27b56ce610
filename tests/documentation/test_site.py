# SPDX-License-Identifier: Apache-2.0
"""The documentation builds, its links lead somewhere, what is generated is fresh."""

import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from click.testing import CliRunner
from part_keys import Noting, asked, sections
from site_hooks import on_page_markdown
from tornillo.cli import main as tornillo
from tornillo.cutting import read_cut
from tornillo.language import use

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
STORED = "{part} is stored in slot {slot}, {image} bytes, verified"
HOMED = "homed; {status}"
FOUND = "dead steps: {dead}; spread: {spread}"
PAGES = sorted(DOCS.rglob("*.md"))


def build(folder: Path) -> subprocess.CompletedProcess[str]:
    """Build the site into `folder`; a warning is an error."""
    return subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_site_builds_without_a_warning_and_has_every_page(tmp_path: Path) -> None:
    done = build(tmp_path)
    assert done.returncode == 0, done.stderr
    for page in PAGES:
        path = page.relative_to(DOCS)
        name = "index" if path.stem == "README" else path.stem
        assert (tmp_path / path.with_name(f"{name}.html")).is_file(), path
    assert not list(tmp_path.rglob("*.py"))


def test_the_menu_of_the_site_has_every_page() -> None:
    menu = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    missing = [
        str(page.relative_to(DOCS)) for page in PAGES if str(page.relative_to(DOCS)) not in menu
    ]
    assert missing == []


@pytest.mark.parametrize("script", ["generate_reference.py", "generate_tables.py"])
def test_what_is_generated_is_fresh(script: str) -> None:
    done = subprocess.run(
        [sys.executable, str(DOCS / script), "--check"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout


def test_the_spanish_guide_has_the_commands_of_the_english_one() -> None:
    def commands(page: str) -> list[str]:
        text = (DOCS / page).read_text(encoding="utf-8")
        return re.findall(r"^\$ (.*)$", text, re.MULTILINE)

    typed = commands("first-cut.md")
    assert len(typed) > 10
    assert commands("es/primer-corte.md") == typed


def test_what_the_spanish_guide_says_is_printed_is_printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    text = (DOCS / "es" / "primer-corte.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```console\n(.*?)```", text, re.DOTALL)
    done = ""
    for line in re.findall(r"^\$ tornillo (.*)$", blocks[0], re.MULTILINE):
        words = line.replace("build/", f"{tmp_path}/").split()
        result = CliRunner(env={"TORNILLO_LANG": "es"}).invoke(tornillo, words)
        done += result.output.replace(f"{tmp_path}/", "build/")
    printed = [line for line in blocks[0].splitlines() if not line.startswith("$ ")]
    assert len(printed) == 3
    assert [line for line in printed if line not in done] == []
    say = use("es").gettext
    later = "".join(blocks[1:])
    for message in (
        "held; go on with `tornillo resume`, give up with `tornillo stop`",
        "running; see `tornillo status`, hold with `tornillo hold`",
        "stopped",
        "finished",
    ):
        assert f"\n{say(message)}\n" in later
    assert say(STORED).format(part="my-part", slot=0, image=91) in later
    found = say(FOUND).format(dead="X 23, Z 31", spread="X 0, Z 0")
    assert f"\n{say(HOMED).format(status=found)}\n" in later
    use("en")


def test_every_picture_is_made_by_a_tool() -> None:
    makers = [*DOCS.glob("*.py"), *(ROOT / "hw").rglob("*.py"), *(ROOT / "hw").rglob("*.sh")]
    scripts = "".join(path.read_text(encoding="utf-8") for path in makers)
    pictures = [*(DOCS / "images").iterdir()]
    assert len(pictures) >= 7
    assert [picture.name for picture in pictures if f'"{picture.stem}' not in scripts] == []
    with_a_font = [
        picture.name
        for picture in pictures
        if picture.suffix == ".svg" and "@font-face" in picture.read_text(encoding="utf-8")
    ]
    assert with_a_font == []


def test_links_to_sources_become_names_on_the_site() -> None:
    page = SimpleNamespace(file=SimpleNamespace(src_uri="index.md"))

    def shown(text: str) -> str:
        return on_page_markdown(text, page=page)

    assert shown("[tour](firmware-tour.md)") == "[tour](firmware-tour.md)"
    assert shown("[ex](../host-cli/examples)") == "ex (`host-cli/examples`)"
    assert shown("[firmware/board.h](../firmware/board.h)") == "firmware/board.h"
    assert shown("[gone](../nowhere.md)") == "[gone](../nowhere.md)"
    assert shown("![picture](images/x.png)") == "![picture](images/x.png)"


def test_the_reference_of_part_files_is_asked_from_the_readers() -> None:
    found = {head: {key.name for key in keys} for head, keys in sections().items()}
    assert found["`[stock]`"] == {"diameter", "length", "allowance"}
    assert found["a point of a profile"] >= {"z", "diameter", "radius", "corner", "chamfer"}
    needed = {key.name for key in asked(read_cut) if key.default is None}
    assert needed == {"depth_of_cut", "feed", "retract"}
    assert re.search("^lookup$", Noting().text("x", default="lookup"))
