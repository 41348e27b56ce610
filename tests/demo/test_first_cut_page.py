# SPDX-License-Identifier: Apache-2.0
"""The commands of docs/first-cut.md, run as they are printed."""

import json
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from lathe_process import LatheProcess

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "first-cut.md"
BLOCK = re.compile(r"<!-- test: ([\w-]+)(?: ([^\n]+?))? -->\n```console\n(.*?)```", re.DOTALL)
LINK = re.compile(r"\]\(([^)#]+)(?:#[^)]*)?\)")
COMMAND_S = 120


class Command(NamedTuple):
    """One line after a `$`, and what the page prints below it."""

    line: str
    printed: list[str]


class Block(NamedTuple):
    """One marked block of the page; `kind` and `argument` are those of the mark."""

    kind: str
    argument: str
    commands: list[Command]


def blocks() -> Iterator[Block]:
    """Every marked block in the order of the page."""
    for kind, argument, text in BLOCK.findall(PAGE.read_text(encoding="utf-8")):
        commands: list[Command] = []
        for line in text.splitlines():
            if line.startswith("$ "):
                commands.append(Command(line[2:], []))
            else:
                commands[-1].printed.append(line)
        yield Block(kind, argument, commands)


class Reader:
    """Somebody who follows the page in an empty folder with the examples in it."""

    def __init__(self, folder: Path) -> None:
        """Go there."""
        self.folder = folder
        (folder / "build").mkdir()
        (folder / "host-cli").symlink_to(ROOT / "host-cli")
        path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
        self.environment = {**os.environ, "PATH": path}
        self.environment.pop("TORNILLO_PORT", None)

    def type(self, line: str) -> subprocess.CompletedProcess[str]:
        """Run one command."""
        if line.startswith("export "):
            name, value = line.removeprefix("export ").split("=", 1)
            self.environment[name] = value
            line = "true"
        return subprocess.run(
            shlex.split(line),
            cwd=self.folder,
            env=self.environment,
            capture_output=True,
            text=True,
            timeout=COMMAND_S,
            check=False,
        )

    def run(self, block: Block) -> None:
        """Run the commands of a block and compare what they print."""
        for command in block.commands:
            result = self.type(command.line)
            assert result.returncode == 0, f"{command.line}: {result.stderr}"
            for line in command.printed:
                assert line in result.stdout, command.line

    def edit_part(self, old: str, new: str) -> None:
        """Change the copy of the part file."""
        part = self.folder / "build" / "my-part.toml"
        if not part.exists():
            example = self.folder / "host-cli" / "examples" / "test-bar.toml"
            part.write_text(example.read_text(encoding="utf-8"), encoding="utf-8")
        text = part.read_text(encoding="utf-8")
        assert old in text
        part.write_text(text.replace(old, new), encoding="utf-8")

    def switch_on(self, block: Block) -> LatheProcess:
        """The virtual lathe with the options of the page's `make virtual-lathe ARGS=...`."""
        words = shlex.split(block.commands[0].line)
        options = shlex.split(words[-1].removeprefix("ARGS="))
        at = options.index("--port-link")
        port = options[at + 1]
        assert block.commands[0].printed == [f"port: {port}"]
        del options[at : at + 2]
        return LatheProcess(Path(port), Path("build/log"), *options)


@pytest.fixture
def reader(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Reader:
    """A reader in a folder of their own."""
    monkeypatch.chdir(tmp_path)
    return Reader(tmp_path)


def test_a_newcomer_who_types_the_first_cut_page_gets_a_part(reader: Reader) -> None:
    page = list(blocks())
    assert [block.kind for block in page] == ["run", "my-part", "lathe", *["run"] * 5]
    reader.run(page[0])

    reader.edit_part("diameter = 0.600", page[1].argument)
    refused = reader.type(page[1].commands[0].line)
    assert refused.returncode == 1
    assert "build/my-part.toml:31: operation 1 (cylinder)" in refused.stderr
    assert "Try: " in refused.stderr
    reader.edit_part(page[1].argument, "diameter = 0.5")
    reader.edit_part('"test-bar"', '"my-part"')

    with reader.switch_on(page[2]):
        for block in page[3:]:
            reader.run(block)
    report = json.loads((reader.folder / "build" / "report.json").read_text(encoding="utf-8"))
    assert report["lost_steps"] == 0
    assert report["crashes"] == []
    # The drawing's sizes lie between two whole steps: the nearer one was cut.
    errors = [entry["error_steps"] for entry in report["dimensions"]]
    assert len(errors) == 2
    assert all(abs(error) <= 0.5 for error in errors)


def test_every_page_that_the_documentation_links_to_exists() -> None:
    rooms = [page for page in ROOT.glob("*/**/README.md") if ".venv" not in page.parts]
    pages = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *rooms]
    links = [
        (page, target)
        for page in pages
        for target in LINK.findall(page.read_text(encoding="utf-8"))
        if ":" not in target
    ]
    assert len(links) > 30
    assert [(page, target) for page, target in links if not (page.parent / target).exists()] == []
