# SPDX-License-Identifier: Apache-2.0
"""What all verbs have in common: their help, their examples, a fast start, completion."""

import shlex
import subprocess
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import click
import pytest
from click.shell_completion import BashComplete
from click.testing import CliRunner
from console import Tornillo
from scripted_chip import ScriptedChip, ScriptedPort

import tornillo.commands
from tornillo.cli import main
from tornillo.help_texts import translate
from tornillo.verbs import VERBS

#: What `tornillo --help` has no use for, and what it would cost: from 20 ms to a second each.
HEAVY = ("matplotlib", "numpy", "ezdxf", "rich", "serial", "tornillo.lathe", "tornillo.part")


def commands() -> Iterator[tuple[str, click.Command]]:
    """Every command and subcommand with the words that call it."""
    context = click.Context(main)
    for name in main.list_commands(context):
        command = main.get_command(context, name)
        assert command is not None, name
        yield name, command
        if isinstance(command, click.Group):
            for inner, subcommand in command.commands.items():
                yield f"{name} {inner}", subcommand


COMMANDS = dict(commands())


def examples(command: click.Command) -> list[str]:
    """The lines of the help that show how a command is typed."""
    lines = (command.help or "").splitlines()
    return [
        line.split(":", 1)[-1].strip() if "Example" in line else line.strip()
        for line in lines
        if line.strip().removeprefix("Examples:").removeprefix("Example:").strip().startswith(START)
    ]


START = ("tornillo ", "sudo ")


def test_the_help_lists_exactly_the_verbs_there_are() -> None:
    folder = Path(tornillo.commands.__path__[0])
    modules = [import_module(f"tornillo.commands.{path.stem}") for path in folder.glob("*.py")]
    there = {
        verb.name: module.__name__.rpartition(".")[2]
        for module in modules
        for verb in getattr(module, "VERBS", ())
    }
    assert {name: verb.module for name, verb in VERBS.items()} == there


def test_a_verb_is_explained_in_one_line_of_the_help() -> None:
    assert all(10 < len(verb.summary) <= 60 for verb in VERBS.values())
    shown = CliRunner().invoke(main, ["--help"], terminal_width=80).stdout
    assert all(f"{name} " in shown and verb.summary in shown for name, verb in VERBS.items())


@pytest.mark.parametrize("words", COMMANDS)
def test_the_help_of_every_command_has_examples_that_can_be_typed(words: str) -> None:
    found = examples(translate(COMMANDS[words]))
    assert found
    for line in found:
        typed = shlex.split(line.removeprefix("sudo "), comments=True)[1:]
        arguments = [word for word in typed if word not in (">", ">>")]
        arguments = arguments[: len(typed) if arguments == typed else -1]
        assert " ".join(arguments).startswith(words), line
        parse(arguments)


def parse(arguments: list[str]) -> None:
    """Read a command as the command line does, without running it; wrong usage raises."""
    context = click.Context(main)
    command: click.Command = main
    while isinstance(command, click.Group) and arguments:
        found = command.get_command(context, arguments[0])
        if found is None:
            break
        command, arguments = found, arguments[1:]
    command.make_context("tornillo", list(arguments))


def test_the_start_imports_nothing_that_the_help_does_not_need() -> None:
    program = (
        "import sys; from tornillo.cli import main; main(['--help'], standalone_mode=False); "
        "print(*sys.modules, file=sys.stderr)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    loaded = done.stderr.split()
    assert "Setting up:" in done.stdout
    assert [name for name in HEAVY if name in loaded] == []


def test_an_unknown_verb_is_wrong_usage_and_the_nearest_is_named(tornillo: Tornillo) -> None:
    result = tornillo("upploud", "part.toml")
    assert result.exit_code == 2
    assert 'there is no verb "upploud"; did you mean "upload"?' in result.stderr
    result = tornillo("xyzzy")
    assert result.exit_code == 2
    assert 'there is no verb "xyzzy"; see `tornillo --help`' in result.stderr


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_prints_what_the_shell_reads(tornillo: Tornillo, shell: str) -> None:
    result = tornillo("completion", shell)
    assert result.exit_code == 0
    assert f"_TORNILLO_COMPLETE={shell}_complete" in result.stdout


def completed(*words: str) -> list[str]:
    """What the shell offers for the last of `words`."""
    shell = BashComplete(main, {}, "tornillo", "_TORNILLO_COMPLETE")
    return [item.value for item in shell.get_completions(list(words[:-1]), words[-1])]


def test_verbs_options_and_names_are_completed(
    tornillo: Tornillo, chip: ScriptedChip, port: ScriptedPort, test_bar: Path
) -> None:
    assert completed("re") == ["resume", "reset"]
    assert completed("run", "--f") == ["--follow"]
    assert completed("flash", "--c") == ["--check"]
    assert completed("settings", "get", "rapid") == ["rapid_rate_x", "rapid_rate_z"]
    assert tornillo("upload", test_bar).exit_code == 0
    assert completed("run", "te") == ["test-bar"]
    assert completed("delete", "x") == []
    port.unplugged = True
    assert completed("run", "te") == []


def test_colours_are_for_terminals_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    def shown(color: bool) -> str:
        return CliRunner().invoke(main, ["check", "none.toml"], color=color).stderr

    assert "\x1b[31m" in shown(color=True)
    assert "\x1b" not in shown(color=False)
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b" not in shown(color=True)


def test_a_file_that_cannot_be_written_is_told_with_its_name(
    tornillo: Tornillo, test_bar: Path, tmp_path: Path
) -> None:
    result = tornillo("draw", test_bar, "-o", tmp_path / "nowhere" / "bar.svg")
    assert result.exit_code == 1
    assert "nowhere/bar.svg: No such file or directory" in result.stderr
    assert "Try: check name, place and rights" in result.stderr


def test_what_nobody_foresaw_is_not_hidden(
    tornillo: Tornillo, monkeypatch: pytest.MonkeyPatch, test_bar: Path
) -> None:
    def broken(_path: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("tornillo.part.Part.load", broken)
    assert isinstance(tornillo("check", test_bar).exception, ZeroDivisionError)
