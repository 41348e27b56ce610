# SPDX-License-Identifier: Apache-2.0
"""The verbs about parts: check, draw, upload, parts, select, delete."""

import builtins
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from console import Tornillo
from scripted_chip import ScriptedChip, ScriptedPort

from tornillo import __version__
from tornillo.cli import main
from tornillo.protocol import PART_SLOTS, Command, ErrorCode, Refusal, SettingId


def part_file(folder: Path, source: Path, old: str, new: str) -> Path:
    """A copy of a part file with something replaced."""
    text = source.read_text(encoding="utf-8")
    assert old in text
    path = folder / "part.toml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    return path


def test_check_accepts_the_examples(tornillo: Tornillo, test_bar: Path, stepped_pin: Path) -> None:
    result = tornillo("check", test_bar)
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout == "test-bar: 1 operation, 91 bytes, fits otmt-co\n"
    assert "4 operations, 130 bytes" in tornillo("check", stepped_pin).stdout


def test_check_tells_every_problem_and_exits_with_1(
    tornillo: Tornillo, tmp_path: Path, stepped_pin: Path
) -> None:
    path = part_file(tmp_path, stepped_pin, "diameter = 16.0", "diameter = 12.0")
    result = tornillo("check", path)
    assert result.exit_code == 1
    assert result.stdout == ""
    assert result.stderr.count("Error: ") == result.stderr.count("Try: ") == 1
    assert "operation 2 (cylinder): the operation lies outside the stock" in result.stderr
    path = part_file(tmp_path, stepped_pin, "retract = 0.5", "retract = 0.001")
    path = part_file(tmp_path, path, "depth_of_cut = 0.75", "depth_of_cut = 0.001")
    result = tornillo("check", path)
    assert result.exit_code == 1
    assert result.stderr.count("Error: ") == 3


def test_check_uses_the_machine_it_is_told(tornillo: Tornillo, test_bar: Path) -> None:
    result = tornillo("check", test_bar, "--machine", "nonsense")
    assert result.exit_code == 1
    assert "use one of otmt-co" in result.stderr


def test_a_missing_file_is_the_inputs_fault(tornillo: Tornillo) -> None:
    result = tornillo("check", "nowhere.toml")
    assert result.exit_code == 1
    assert "nowhere.toml: the file cannot be read" in result.stderr


def test_upload_stores_verifies_and_says_where(
    tornillo: Tornillo, chip: ScriptedChip, test_bar: Path
) -> None:
    result = tornillo("upload", test_bar)
    assert result.exit_code == 0
    assert result.stdout == "test-bar is stored in slot 0, 91 bytes, verified\n"
    assert len(chip.slots[0]) == 91


def test_upload_uses_the_step_sizes_of_the_chip(
    tornillo: Tornillo, chip: ScriptedChip, test_bar: Path
) -> None:
    chip.values[SettingId.STEP_X_NM] = 3556
    chip.values[SettingId.TRAVEL_X] = 7150
    chip.values[SettingId.ZERO_X] = -7150
    assert tornillo("upload", test_bar).exit_code == 0
    assert chip.slots[0][20:24] == (3556).to_bytes(2, "little") + (7112).to_bytes(2, "little")
    assert chip.slots[0][24:26] == (3571).to_bytes(2, "little")


def test_upload_refuses_a_part_beyond_the_travel_before_sending_it(
    tornillo: Tornillo, chip: ScriptedChip, test_bar: Path
) -> None:
    chip.values[SettingId.TRAVEL_Z] = 9000
    result = tornillo("upload", test_bar)
    assert result.exit_code == 1
    assert "operation 1 (cylinder): the slides cannot go that far" in result.stderr
    assert Command.UPLOAD_BEGIN not in chip.executed


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ((1, "[[operation]]"), ": operation 1 (cylinder): the chip refuses the part: material in"),
        ((0, "[part]"), ": the chip refuses the part: material in front"),
        ((9, ""), "operation 9: material in front"),
    ],
)
def test_upload_tells_the_line_of_what_the_chip_refuses(
    tornillo: Tornillo, chip: ScriptedChip, test_bar: Path, place: tuple[int, str], message: str
) -> None:
    operation, line = place
    answer = bytes([ErrorCode.INVALID_PART, Refusal.BLOCKED, operation])
    chip.refusals[Command.UPLOAD_COMMIT] = answer
    result = tornillo("upload", test_bar)
    assert result.exit_code == 1
    lines = test_bar.read_text(encoding="utf-8").splitlines()
    named = f"test-bar.toml:{lines.index(line) + 1}" if line else ""
    assert named + message in result.stderr
    assert "Try: cut the part in front first" in result.stderr


def test_upload_to_a_full_store_says_how_to_make_room(
    tornillo: Tornillo, chip: ScriptedChip, test_bar: Path
) -> None:
    for _ in range(PART_SLOTS):
        assert tornillo("upload", test_bar).exit_code == 0
    result = tornillo("upload", test_bar)
    assert result.exit_code == 1
    assert "no room for one more part" in result.stderr
    assert "tornillo delete" in result.stderr
    assert len(chip.slots) == PART_SLOTS


def test_parts_are_listed_for_people_and_for_scripts(tornillo: Tornillo, test_bar: Path) -> None:
    assert (
        tornillo("parts").stdout
        == f"no parts stored, all {PART_SLOTS} units of the store are free\n"
    )
    assert json.loads(tornillo("parts", "--json").stdout) == []
    tornillo("upload", test_bar)
    tornillo("select", "test-bar")
    listed = tornillo("parts").stdout
    assert "test-bar" in listed
    assert "selected" in listed
    assert (
        f"{PART_SLOTS - 1} of {PART_SLOTS} units of the store are free; a part takes 1 to 10\n"
        in listed
    )
    [part] = json.loads(tornillo("parts", "--json").stdout)
    assert (part["slot"], part["name"], part["selected"]) == (0, "test-bar", True)


def test_select_and_delete_take_names_and_slots(
    tornillo: Tornillo, chip: ScriptedChip, test_bar: Path
) -> None:
    tornillo("upload", test_bar)
    result = tornillo("select", "0")
    assert result.stdout == "test-bar is selected: the RUN button cuts it\n"
    assert chip.selected == 0
    assert tornillo("delete", "test-bar").stdout == "test-bar is deleted, 1 unit is free again\n"
    assert chip.slots == {}
    result = tornillo("delete", "test-bar")
    assert result.exit_code == 1
    assert "no part called 'test-bar' is stored in the lathe" in result.stderr
    assert "Try: stored are: none" in result.stderr


def test_download_gives_a_file_with_the_same_image(
    tornillo: Tornillo, chip: ScriptedChip, tmp_path: Path, stepped_pin: Path
) -> None:
    tornillo("upload", stepped_pin)
    path = tmp_path / "back.toml"
    result = tornillo("download", "stepped-pin", "-o", path)
    assert (result.exit_code, result.stdout) == (0, f"stepped-pin is written to {path}\n")
    assert tornillo("upload", path).exit_code == 0
    assert chip.slots[1] == chip.slots[0]
    assert tornillo("download", "0").stdout == path.read_text(encoding="utf-8")


def test_download_to_a_place_that_is_not_there_is_refused(
    tornillo: Tornillo, tmp_path: Path, test_bar: Path
) -> None:
    tornillo("upload", test_bar)
    result = tornillo("download", "test-bar", "-o", tmp_path / "none" / "back.toml")
    assert result.exit_code == 1
    assert "the file cannot be written: No such file" in result.stderr


def test_check_notes_what_will_be_left(
    tornillo: Tornillo, tmp_path: Path, stepped_pin: Path
) -> None:
    tool = '[[tool]]\nname = "round"\nnose_radius = 0.4\n\n[[operation]]\ntype = "face"'
    path = part_file(tmp_path, stepped_pin, '[[operation]]\ntype = "face"', tool)
    result = tornillo("check", path)
    assert result.exit_code == 0
    assert "Note: operation 1 (face): the slide ends before the round nose" in result.stdout


@pytest.mark.parametrize("suffix", [".svg", ".png"])
def test_draw_writes_a_picture(
    tornillo: Tornillo, tmp_path: Path, test_bar: Path, suffix: str
) -> None:
    path = tmp_path / f"bar{suffix}"
    result = tornillo("draw", test_bar, "-o", path)
    assert (result.exit_code, result.stdout) == (0, f"{path} written\n")
    start = b"\x89PNG" if suffix == ".png" else b"<svg"
    assert path.read_bytes().startswith(start)


def test_draw_refuses_other_formats_as_wrong_usage(tornillo: Tornillo, test_bar: Path) -> None:
    result = tornillo("draw", test_bar, "-o", "bar.gif")
    assert result.exit_code == 2
    assert "must end in .svg or .png" in result.stderr


def test_draw_refuses_a_part_that_cannot_be_made(
    tornillo: Tornillo, tmp_path: Path, test_bar: Path
) -> None:
    path = part_file(tmp_path, test_bar, "diameter = 0.600", "diameter = 1.2")
    result = tornillo("draw", path, "-o", tmp_path / "bar.svg")
    assert result.exit_code == 1
    assert "outside the stock" in result.stderr
    assert not (tmp_path / "bar.svg").exists()


def test_draw_without_matplotlib_says_how_to_get_it(
    tornillo: Tornillo, tmp_path: Path, test_bar: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real_import = builtins.__import__

    def without(name: str, *rest: Any) -> object:
        if name.startswith("matplotlib"):
            raise ImportError(name)
        return real_import(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    result = tornillo("draw", test_bar, "-o", tmp_path / "bar.png")
    assert result.exit_code == 1
    assert 'pip install "tornillo[draw]"' in result.stderr


@pytest.mark.parametrize(
    "arguments", [("nonsense",), ("check",), ("--nonsense",), ("draw", "x.toml"), ("zero", "y")]
)
def test_wrong_usage_exits_with_2(tornillo: Tornillo, arguments: tuple[str, ...]) -> None:
    assert tornillo(*arguments).exit_code == 2


def test_help_and_version_are_there(tornillo: Tornillo) -> None:
    assert tornillo("--version").stdout == f"tornillo, version {__version__}\n"
    text = tornillo("--help").stdout
    for verb in ("check", "draw", "upload", "home", "run", "status", "settings", "zero"):
        assert verb in text


def test_every_verb_shows_an_example_in_its_help(tornillo: Tornillo) -> None:
    for verb in main.commands:
        assert "Example" in tornillo(verb, "--help").stdout, verb


def test_starting_the_command_imports_neither_heavy_libraries_nor_planning() -> None:
    heavy = ("serial", "rich", "matplotlib", "numpy", "tornillo.planning", "tornillo.timing")
    code = f"import sys, tornillo.cli; print([n for n in {heavy} if n in sys.modules])"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    assert result.stdout.decode().strip() == "[]"


def test_the_port_comes_from_the_option_or_the_environment(
    port: ScriptedPort, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []

    def remember(name: str, *_arguments: object) -> ScriptedPort:
        opened.append(name)
        return port

    monkeypatch.setattr("tornillo.lathe.open_port", remember)
    CliRunner().invoke(main, ["--port", "/dev/one", "status"])
    CliRunner().invoke(main, ["status"], env={"TORNILLO_PORT": "/dev/two"})
    assert opened == ["/dev/one", "/dev/two"]


def test_no_lathe_is_told_with_a_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("serial.tools.list_ports.comports", list)
    result = CliRunner().invoke(main, ["status"])
    assert result.exit_code == 1
    assert "Error: no lathe found" in result.stderr
    assert "Try: plug in the USB cable" in result.stderr
