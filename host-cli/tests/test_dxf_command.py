# SPDX-License-Identifier: Apache-2.0
"""The verb import-dxf: files, options, pictures and exit codes."""

import subprocess
import sys
import tomllib
from pathlib import Path
from xml.etree import ElementTree

import pytest
from console import Tornillo
from dxf_drawings import INCH, add_stepped_pin, drawing, saved

SVG_TEXT = "{http://www.w3.org/2000/svg}text"


@pytest.fixture
def pin(tmp_path: Path) -> Path:
    """A drawing that can be turned."""
    document, space = drawing()
    add_stepped_pin(space)
    return saved(document, tmp_path, "Stepped Pin.dxf")


@pytest.fixture
def broken(tmp_path: Path) -> Path:
    """A drawing with a gap."""
    document, space = drawing()
    space.add_line((0, 2), (-5, 2))
    space.add_line((-5.05, 2), (-9, 4))
    return saved(document, tmp_path, "broken.dxf")


def picture_texts(path: Path) -> str:
    """Every text in an SVG picture."""
    root = ElementTree.parse(path).getroot()
    return "\n".join(element.text or "" for element in root.iter(SVG_TEXT))


def test_a_drawing_becomes_a_part_file(tornillo: Tornillo, pin: Path, tmp_path: Path) -> None:
    output = tmp_path / "pin.toml"
    result = tornillo("import-dxf", pin, "-o", output)
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.splitlines() == [
        f"{output} written: 5 lines and 0 arcs, 20 mm long, largest diameter 12 mm",
        "  drawn in mm, from the drawing",
        "  upper half; axis at y 0",
        "  the free end is the right one, z = 0 at x 0",
        "  the flat back face is left to parting off",
        f"next: tornillo check {output}",
    ]
    values = tomllib.loads(output.read_text(encoding="utf-8"))
    assert values["part"] == {"name": "stepped-pin", "units": "mm"}
    assert values["stock"] == {"diameter": 12.0, "length": 25.0}
    assert values["cut"] == {
        "depth_of_cut": 0.5,
        "finish_allowance": 0.1,
        "feed": 120.0,
        "finish_feed": 60.0,
        "retract": 0.5,
    }
    assert [operation["type"] for operation in values["operation"]] == ["profile"]
    assert "tool" not in values


def test_stock_cutting_data_and_tool_come_from_options(
    tornillo: Tornillo, pin: Path, tmp_path: Path
) -> None:
    output = tmp_path / "pin.toml"
    options = (
        "--name pin-7 --stock-diameter 14 --stock-length 40 --allowance 0.8 --depth-of-cut 0.3 "
        "--finish-allowance 0 --feed 200 --finish-feed 50 --retract 1 --rpm 1500 "
        "--back-clearance 50 --nose-radius 0.2 --hand neutral"
    )
    result = tornillo("import-dxf", pin, "-o", output, *options.split())
    assert result.exit_code == 0, result.stderr
    values = tomllib.loads(output.read_text(encoding="utf-8"))
    assert values["part"]["name"] == "pin-7"
    assert values["stock"] == {"diameter": 14.0, "length": 40.0, "allowance": 0.8}
    assert values["cut"] == {
        "depth_of_cut": 0.3,
        "finish_allowance": 0.0,
        "feed": 200.0,
        "finish_feed": 50.0,
        "retract": 1.0,
        "spindle": 1500,
    }
    assert values["tool"] == [
        {
            "name": "profiling",
            "hand": "neutral",
            "front_clearance": 3.0,
            "back_clearance": 50.0,
            "nose_radius": 0.2,
        }
    ]
    assert values["operation"][0] == {"type": "face", "z": 0.0}
    assert values["operation"][1]["tool"] == "profiling"


def test_a_drawing_in_inches_becomes_a_part_in_inches(tornillo: Tornillo, tmp_path: Path) -> None:
    document, space = drawing(INCH)
    space.add_lwpolyline([(0, 0.15), (-0.5, 0.15), (-0.8, 0.33)])
    output = tmp_path / "part.toml"
    tornillo("import-dxf", saved(document, tmp_path, "---.dxf"), "-o", output)
    values = tomllib.loads(output.read_text(encoding="utf-8"))
    assert values["part"] == {"name": "part", "units": "inch"}
    assert values["stock"] == {"diameter": 0.75, "length": 1.0}
    assert values["cut"]["depth_of_cut"] == 0.02


def test_existing_files_are_overwritten_only_when_forced(
    tornillo: Tornillo, pin: Path, tmp_path: Path
) -> None:
    for option, name in (("-o", "pin.toml"), ("--picture", "pin.svg")):
        path = tmp_path / name
        path.write_text("mine", encoding="utf-8")
        output = ("-o", tmp_path / "other.toml") if option == "--picture" else ()
        result = tornillo("import-dxf", pin, option, path, *output)
        assert result.exit_code == 1
        assert result.stderr == (
            f"Error: {path} exists already\nTry: choose another name, or add --force\n"
        )
        assert path.read_text(encoding="utf-8") == "mine"
        assert tornillo("import-dxf", pin, option, path, *output, "--force").exit_code == 0
        assert path.read_text(encoding="utf-8") != "mine"


def test_a_problem_is_shown_in_a_picture_beside_the_output(
    tornillo: Tornillo, broken: Path, tmp_path: Path
) -> None:
    output = tmp_path / "broken.toml"
    result = tornillo("import-dxf", broken, "-o", output)
    picture = tmp_path / "broken.problem.svg"
    assert result.exit_code == 1
    assert result.stdout == ""
    assert f"{picture} shows it\nError: {broken}: the outline breaks into 2 parts" in result.stderr
    assert "Try: join the ends in the drawing, or bridge them with --snap 0.0525" in result.stderr
    assert not output.exists()
    texts = picture_texts(picture)
    assert "broken.dxf cannot be imported" in texts
    assert "gap of 0.05 mm" in texts
    assert "--snap 0.0525" in texts
    assert tornillo("import-dxf", broken, "-o", output, "--snap", "0.0525").exit_code == 0


def test_a_picture_of_a_problem_that_has_no_place_is_not_made(
    tornillo: Tornillo, pin: Path, tmp_path: Path
) -> None:
    output = tmp_path / "pin.toml"
    result = tornillo("import-dxf", pin, "-o", output, "--layer", "nothing")
    assert result.exit_code == 1
    assert "Try: choose with --layer from: 0 (8)" in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == [pin.name]


@pytest.mark.parametrize("suffix", [".svg", ".png"])
def test_a_picture_can_be_had_of_what_was_read(
    tornillo: Tornillo, pin: Path, tmp_path: Path, suffix: str
) -> None:
    picture = tmp_path / f"pin{suffix}"
    result = tornillo("import-dxf", pin, "-o", tmp_path / "pin.toml", "--picture", picture)
    assert result.stdout.endswith(f"{picture} shows it\n")
    start = b"\x89PNG" if suffix == ".png" else b"<svg"
    assert picture.read_bytes().startswith(start)


def test_other_pictures_and_sizes_below_zero_are_wrong_usage(
    tornillo: Tornillo, pin: Path, tmp_path: Path
) -> None:
    output = tmp_path / "pin.toml"
    result = tornillo("import-dxf", pin, "-o", output, "--picture", "pin.gif")
    assert result.exit_code == 2
    assert "must end in .svg or .png" in result.stderr
    assert tornillo("import-dxf", pin, "-o", output, "--snap", "-1").exit_code == 2
    result = tornillo("import-dxf", pin, "-o", output, "--tool", 'a"b')
    assert result.exit_code == 2
    assert "use 1 to 12 of the characters a-z, 0-9 and -" in result.stderr
    assert tornillo("import-dxf", pin).exit_code == 2


def test_a_place_that_cannot_be_written_is_told(
    tornillo: Tornillo, pin: Path, tmp_path: Path
) -> None:
    output = tmp_path / "nowhere" / "pin.toml"
    result = tornillo("import-dxf", pin, "-o", output)
    assert result.exit_code == 1
    assert f"Error: {output} cannot be written: No such file or directory" in result.stderr


def test_the_library_for_drawings_is_imported_only_when_one_is_read() -> None:
    code = (
        "import sys, tornillo.cli, tornillo.commands.import_dxf; "
        "print([n for n in sys.modules if n.startswith(('ezdxf', 'tornillo.dxf'))])"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    assert result.stdout.decode().strip() == "[]"
