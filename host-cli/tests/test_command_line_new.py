# SPDX-License-Identifier: Apache-2.0
"""`tornillo new`: the answers of a person, the pictures in between, the file at the end."""

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from tornillo.cli import main
from tornillo.part import Part

#: Name, unit, bar, free length, raw face; cutting data; nose, fall.
BEGIN = ["my-part", "mm", "20", "40", "", *5 * [""], "", ""]
FACE = ["face", "", ""]
ROUNDED = ["-5", "8", "line", "rounded", "1"]
ARC = ["-12", "16", "arc", "40", ""]
CHAMFERED = ["-5", "12", "line", "chamfered", "0.5"]
#: A character of the chuck's jaws, which every row of a picture begins with.
JAW = "\N{BRAILLE PATTERN DOTS-1358}"
CYLINDER = ["cylinder", "0", "-20", "12"]


def answer(folder: Path, *answers: str) -> tuple[Result, Path]:
    """Type `answers`, one a line."""
    file = folder / "my part.toml"
    typed = "\n".join(answers) + "\n"
    return CliRunner().invoke(main, ["new", str(file)], input=typed), file


def test_answers_make_a_part_that_can_be_cut(tmp_path: Path) -> None:
    raw_face = [*BEGIN[:4], "0.5", *BEGIN[5:]]
    result, file = answer(tmp_path, *raw_face, "", *FACE[1:], *CYLINDER, "done")
    assert result.exit_code == 0
    assert f"{file} written; next: tornillo plan {file}" in result.stdout
    part = Part.load(file)
    assert (part.name, part.units, part.stock.allowance) == ("my-part", "mm", 0.5)
    assert [operation.type for operation in part.operations] == ["face", "cylinder"]
    assert CliRunner().invoke(main, ["check", str(file)]).exit_code == 0


@pytest.mark.parametrize(
    ("answers", "written"),
    [
        (
            ["cone", "0", "10", "-10", "14"],
            "start = { z = 0.0, diameter = 10.0 }\nend = { z = -10.0, diameter = 14.0 }",
        ),
        (
            ["arc", "0", "0", "-6", "12", "6"],
            "end = { z = -6.0, diameter = 12.0 }\nradius = 6.0",
        ),
        (
            [
                "profile",
                "0",
                "8",
                *ROUNDED,
                "y",
                *CHAMFERED,
                "y",
                "-12",
                "16",
                "arc",
                "40",
                "",
                "n",
            ],
            "points = [\n  { z = 0.0, diameter = 8.0 },\n"
            "  { z = -5.0, diameter = 8.0, corner = 1.0 },\n"
            "  { z = -5.0, diameter = 12.0, chamfer = 0.5 },\n"
            "  { z = -12.0, diameter = 16.0, radius = 40.0 },\n]",
        ),
        (["groove", "-5", "-8", "14", "2"], 'z = [-5.0, -8.0]\ndiameter = 14.0\ntool = "grooving"'),
        (["part-off", "-25", "", "2"], 'type = "part-off"\nz = -25.0\ndiameter = 0.0'),
        (["drill", "4.2", "15"], 'type = "drill"\ndiameter = 4.2\ndepth = 15.0'),
        (["pause", 'turn "it"'], 'message = "turn \\"it\\""'),
    ],
)
def test_every_operation_can_be_asked_for(tmp_path: Path, answers: list[str], written: str) -> None:
    result, file = answer(tmp_path, *BEGIN, *answers, "done")
    assert result.exit_code == 0, result.output
    assert written in file.read_text(encoding="utf-8")
    assert CliRunner().invoke(main, ["check", str(file)]).exit_code == 0


def test_the_part_is_drawn_after_each_answer_about_a_shape(tmp_path: Path) -> None:
    def pictures(*answers: str) -> int:
        shown = answer(tmp_path, *BEGIN, *answers)[0].stdout
        height = 14
        return shown.count(2 * JAW) // height

    before = pictures()
    drawn = [pictures(*CYLINDER[:count]) - before for count in range(2, len(CYLINDER) + 1)]
    assert drawn == [1, 2, 3]
    shown = answer(tmp_path, *BEGIN, "cone", "-5", "10")[0].stdout
    assert "+" in shown


def test_what_cannot_be_made_is_explained_and_asked_again(tmp_path: Path) -> None:
    wrong = ["cylinder", "0", "-50", "10"]
    result, file = answer(tmp_path, *BEGIN, *wrong, *CYLINDER, "done")
    assert result.exit_code == 0
    assert "This cannot be made: operation 1 (cylinder): the operation lies" in result.stdout
    assert "Try: keep the operation inside the stock" in result.stdout
    assert len(Part.load(file).operations) == 1


def test_a_stock_that_the_machine_cannot_hold_is_asked_for_again(tmp_path: Path) -> None:
    large = ["big", "mm", "90", "40", "0", *5 * [""], "", ""]
    result, file = answer(tmp_path, *large, *BEGIN, *CYLINDER, "done")
    assert result.exit_code == 0
    assert "the slide ends at diameter" in result.stdout
    assert Part.load(file).stock.diameter == 20


def test_an_operation_can_be_taken_back_and_nothing_is_no_part(tmp_path: Path) -> None:
    groove = ["groove", "-5", "-8", "14", "2"]
    result, file = answer(tmp_path, *BEGIN, "done", *CYLINDER, *groove, "undo", "done")
    assert "A part needs an operation." in result.stdout
    part = Part.load(file)
    assert [operation.type for operation in part.operations] == ["cylinder"]
    assert [tool.name for tool in part.tools] == ["turning"]


def test_wrong_answers_are_asked_again_on_the_spot(tmp_path: Path) -> None:
    answers = ["My Part!", "my-part", "mm", "-3", "20", "40", "", *5 * [""], "", ""]
    result, _file = answer(tmp_path, *answers, *CYLINDER, "done")
    assert result.exit_code == 0
    assert "use 1 to 16 of the characters a-z, 0-9 and -" in result.output


def test_an_existing_file_is_kept_and_leaving_early_writes_none(tmp_path: Path) -> None:
    result, file = answer(tmp_path, *BEGIN, *CYLINDER)
    assert result.exit_code == 1
    assert not file.exists()
    file.write_text("mine", encoding="utf-8")
    result, file = answer(tmp_path, *BEGIN, *CYLINDER, "done")
    assert result.exit_code == 1
    assert "exists already" in result.stderr
    assert file.read_text(encoding="utf-8") == "mine"
