# SPDX-License-Identifier: Apache-2.0
"""The verb plan: what it prints for a person and for a script."""

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from console import Tornillo

from tornillo.cli import main
from tornillo.drives import Drives
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.plan_report import PlanReport, show_time
from tornillo.plan_text import PlanText

MANY_TOOLS = """
[part]
name = "shaft"
units = "mm"
[stock]
diameter = 20.0
length = 40.0
[cut]
depth_of_cut = 2.0
finish_allowance = 0.2
feed = 120.0
finish_feed = 60.0
retract = 0.5
spring_passes = 1
peck = 1.0
[[tool]]
name = "turning"
[[tool]]
name = "parting"
width = 2.0
[[operation]]
type = "arc"
start = { z = 0.0, diameter = 8.0 }
end = { z = -4.0, diameter = 16.0 }
radius = 4.0
[[operation]]
type = "pause"
message = "measure"
[[operation]]
type = "groove"
tool = "parting"
z = [-20.0, -24.0]
diameter = 14.0
"""


@pytest.fixture
def shaft(tmp_path: Path) -> Path:
    """A part with an arc, a pause and two tools."""
    path = tmp_path / "shaft.toml"
    path.write_text(MANY_TOOLS, encoding="utf-8")
    return path


def run(*arguments: object) -> str:
    """What `tornillo plan` prints."""
    result = CliRunner().invoke(main, ["plan", *map(str, arguments)])
    assert result.exit_code == 0, result.output
    return result.output


def values(*arguments: object) -> dict[str, Any]:
    """The same as JSON."""
    found = json.loads(run(*arguments, "--json"))
    assert isinstance(found, dict)
    return found


def test_the_test_bar_takes_four_passes_of_a_twentieth_of_an_inch(test_bar: Path) -> None:
    lines = run(test_bar).splitlines()
    passes = [line for line in lines if "roughing" in line]
    assert len(passes) == 4
    assert passes[0].split()[:5] == ["1", "1", "roughing", "0.0101", "0.8999"]
    assert passes[0].split()[5:8] == ["-0.9999", "0.8999", "0.0501"]
    assert lines[0] == "test-bar, lengths in inch"
    assert any(line.startswith("operation 1 (cylinder)") for line in lines)


def test_columns_stand_under_their_headings(shaft: Path) -> None:
    lines = run(shaft).splitlines()
    end = lines[2].index("from z") + len("from z")
    passes = [line for line in lines if "roughing" in line or "plunge" in line]
    assert len(passes) > 4
    assert all(line[end - 1].isdigit() and line[end] == " " for line in passes)


def test_what_stops_the_lathe_stands_between_the_passes(shaft: Path) -> None:
    text = run(shaft)
    assert "pause, RUN goes on: measure" in text
    assert "change the tool too: parting" in text
    assert "without 1 tool change and 1 pause" in text
    assert "along the contour, leaves 0.199" in text
    assert "spring pass" in text


def test_json_has_the_numbers_that_the_text_has(shaft: Path) -> None:
    found = values(shaft)
    assert (found["tool_changes"], found["pauses"], found["units"]) == (1, 1, "mm")
    assert found["passes"] == sum(entry["passes"] for entry in found["operations"])
    assert found["seconds"] == pytest.approx(
        sum(entry["seconds"] for entry in found["list"]), abs=0.5
    )
    assert found["seconds_at_least"] <= found["seconds_in_cut"] * 1.01 < found["seconds"]
    assert found["share_in_cut"] == pytest.approx(
        found["seconds_in_cut"] / found["seconds"], abs=1e-3
    )
    assert "moves" not in found


def test_a_plunge_begins_outside_and_ends_at_its_bottom(shaft: Path) -> None:
    plunges = [entry for entry in values(shaft)["list"] if entry.get("role") == "plunging"]
    assert [round(entry["from"]["z"], 1) for entry in plunges] == [-22.0, -23.0, -24.0]
    assert all(entry["from"]["diameter"] > 20 for entry in plunges)
    assert all(entry["to"]["diameter"] == pytest.approx(14, abs=0.02) for entry in plunges)


def test_all_moves_can_be_listed(shaft: Path) -> None:
    moves = values(shaft, "--moves")["moves"]
    for one, other in pairwise(moves):
        assert one["to"] == other["from"]
    arcs = [move for move in moves if move["kind"] == "convex"]
    assert arcs[-1]["center"]["z"] == pytest.approx(-4.0, abs=0.02)
    assert arcs[-1]["feed"] == pytest.approx(60, rel=0.01)
    text = run(shaft, "--moves").splitlines()
    assert sum(line.split()[2:3] == ["convex"] for line in text) == len(arcs)


def test_the_connected_lathe_can_tell_how_it_is_driven(tornillo: Tornillo, test_bar: Path) -> None:
    result = tornillo("plan", test_bar, "--lathe", "--json")
    assert result.exit_code == 0, result.output
    assert json.loads(result.output)["passes"] == 4


def test_a_part_that_does_not_fit_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(MANY_TOOLS.replace("-24.0]", "-60.0]"), encoding="utf-8")
    result = CliRunner().invoke(main, ["plan", str(path)])
    assert result.exit_code == 1


def test_every_step_of_the_plan_has_a_line(shaft: Path) -> None:
    known = Machine.load()
    report = PlanReport(Part.load(shaft), known, Drives.usual(known))
    lines = list(PlanText(report).lines(with_moves=False))
    assert lines.index("", 2) - 3 == len(report.plan.steps)


@pytest.mark.parametrize(
    ("seconds", "text"), [(9.04, "9.0 s"), (75, "1 min 15 s"), (3_700, "1 h 01 min")]
)
def test_times_are_said_as_people_say_them(seconds: float, text: str) -> None:
    assert show_time(seconds) == text
