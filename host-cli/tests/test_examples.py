# SPDX-License-Identifier: Apache-2.0
"""The example files: their shapes can be turned, and they keep to the figures of the papers."""

import math
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from console import Tornillo
from dxf_drawings import Piece, corners, pieces

from tornillo.machine import Machine

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
STEP_MM = 0.007112
MM_PER = {"mm": 1.0, "inch": 25.4}
NAMES = sorted(path.stem for path in EXAMPLES.glob("*.toml"))


def load(name: str) -> dict[str, Any]:
    """The values of an example."""
    return tomllib.loads((EXAMPLES / f"{name}.toml").read_text(encoding="utf-8"))


def point(entry: dict[str, float]) -> tuple[float, float]:
    """A place of a part file as (z, radius)."""
    return entry["z"], entry["diameter"] / 2


def center_of(start: tuple[float, float], end: tuple[float, float], radius: float) -> Any:
    """The centre of the shorter arc from `start` towards the chuck, convex for a radius above 0."""
    chord = math.dist(start, end)
    height = math.sqrt(radius * radius - chord * chord / 4)
    side = 1 if radius > 0 else -1
    return (
        (start[0] + end[0]) / 2 + side * height * (start[1] - end[1]) / chord,
        (start[1] + end[1]) / 2 + side * height * (end[0] - start[0]) / chord,
    )


def chain(operation: dict[str, Any]) -> list[Piece]:
    """The pieces of an operation that has a shape."""
    kind = operation["type"]
    if kind == "profile":
        points = operation["points"]
    elif kind in ("cone", "arc"):
        end = operation["end"] | {key: operation[key] for key in ("radius",) if key in operation}
        points = [operation["start"], end]
    elif kind == "cylinder":
        points = [{"z": z, "diameter": operation["diameter"]} for z in operation["z"]]
    else:
        return []
    result = []
    for before, after in pairwise(points):
        start, end = point(before), point(after)
        middle = point(after["center"]) if "center" in after else None
        if "radius" in after:
            middle = center_of(start, end, after["radius"])
        result.append(Piece(start, end, middle))
    return result


@pytest.mark.parametrize("name", NAMES)
def test_an_example_can_be_turned_from_its_free_end(name: str) -> None:
    values = load(name)
    part, stock = values["part"], values["stock"]
    millimetre = MM_PER[part["units"]]
    assert part["name"] == name
    for operation in values["operation"]:
        for piece in chain(operation):
            assert piece.end[0] <= piece.start[0]
            assert 0 <= piece.end[1] <= stock["diameter"] / 2
            assert -stock["length"] + values["cut"]["retract"] <= piece.end[0]
            if piece.center is None:
                continue
            assert piece.mismatch() * millimetre < STEP_MM / 10
            sides = [place[1] - piece.center[1] for place in (piece.start, piece.end)]
            slack = STEP_MM / millimetre / 10
            assert min(sides) >= -slack or max(sides) <= slack


@pytest.mark.parametrize("name", NAMES)
def test_an_example_fits_the_lathe(name: str, machine: Machine) -> None:
    values = load(name)
    millimetre = MM_PER[values["part"]["units"]]
    stock, cut = values["stock"], values["cut"]
    reach = (stock["diameter"] / 2 + cut["retract"]) * millimetre / STEP_MM
    assert reach <= -machine.zero_x
    front = (stock.get("allowance", 0.0) + cut["retract"]) * millimetre / STEP_MM
    assert front <= -machine.zero_z
    ends = [piece.end[0] for operation in values["operation"] for piece in chain(operation)]
    assert min(ends) * millimetre / STEP_MM >= -machine.travel_z - machine.zero_z
    for feed in (cut["feed"], cut.get("finish_feed", cut["feed"])):
        assert 4 <= feed * millimetre / STEP_MM / 60 <= machine.max_rate


@pytest.mark.parametrize("name", NAMES)
def test_an_example_names_tools_that_it_has(name: str) -> None:
    values = load(name)
    tools = {tool["name"]: tool for tool in values.get("tool", [])}
    for operation in values["operation"]:
        if "tool" in operation:
            has_width = "width" in tools[operation["tool"]]
            assert has_width == (operation["type"] in ("groove", "part-off"))


@pytest.mark.parametrize(
    ("name", "diameters", "lengths"),
    [
        ("reference-inch", (0.980, 0.600), [0.200] * 5),
        ("reference-mm", (25.146, 20.066), [9.906, 5.08, 5.08, 5.08, 5.08]),
    ],
)
def test_the_reference_parts_have_the_dimensions_of_s0(
    name: str, diameters: tuple[float, float], lengths: list[float]
) -> None:
    operations = load(name)["operation"]
    found = [piece for operation in operations for piece in chain(operation)]
    places = sorted({piece.end[0] for piece in found} | {0.0}, reverse=True)
    assert [before - after for before, after in pairwise(places)] == pytest.approx(lengths)
    at_end = max(piece.end[1] for piece in found if piece.end[0] == places[-1])
    at_nose = min(piece.end[1] for piece in found if piece.end[0] == places[2])
    assert (2 * at_end, 2 * at_nose) == pytest.approx(diameters)


def test_the_reference_parts_have_a_cone_and_both_kinds_of_arc() -> None:
    for name in ("reference-inch", "reference-mm"):
        found = [piece for operation in load(name)["operation"] for piece in chain(operation)]
        sides = {piece.start[1] < piece.center[1] for piece in found if piece.center}
        assert sides == {False, True}
        cones = [piece for piece in found if not piece.center and piece.start[1] < piece.end[1]]
        assert len(cones) == 1


def test_the_marks_are_as_many_steps_apart_as_the_specimen_says() -> None:
    grooves = [entry for entry in load("three-marks")["operation"] if entry["type"] == "groove"]
    steps = [round(entry["z"][1] / STEP_MM) for entry in grooves]
    assert [after - before for before, after in pairwise(steps)] == [-1050, 950]
    assert {round(entry["z"][0] - entry["z"][1], 6) for entry in grooves} == {0.4}


def test_the_contour_of_s3_is_scaled_alike_everywhere() -> None:
    found = pieces((EXAMPLES / "g71-contour.toml").read_text(encoding="utf-8"))
    wanted = [
        (0, 2.75), (-0.125, 3), (-0.95, 3), (-1.25, 3.6), (-1.25, 4), (-2.25, 4),
        (-4.5, 4.5), (-6.25, 4.5), (-6.25, 5.35),
    ]  # fmt: skip
    places = [found[0].start, *(piece.end for piece in found)]
    scaled = [(z / 0.3, 2 * radius / 0.3) for z, radius in places]
    assert scaled == [pytest.approx(place) for place in wanted]


def test_the_pawn_is_what_its_drawing_gives(tornillo: Tornillo, tmp_path: Path) -> None:
    text = (EXAMPLES / "pawn.toml").read_text(encoding="utf-8")
    start = text.index("import-dxf") + len("import-dxf pawn.dxf -o pawn.toml")
    options = text[start : text.index("\n#\n", start)].replace("#", " ").split()
    output = tmp_path / "pawn.toml"
    result = tornillo("import-dxf", EXAMPLES / "pawn.dxf", "-o", output, *options)
    assert result.exit_code == 0, result.stderr
    assert tomllib.loads(output.read_text(encoding="utf-8")) == load("pawn")
    found = pieces(text)
    places = corners(found)
    assert places[0] == (0, 0)
    assert places[-1][0] == -27.92
    assert places[-1][0] - places[-2][0] == pytest.approx(-4.0)
    assert places[-1][0] - places[-3][0] == pytest.approx(-4.92)
    head, neck = found[0], found[1]
    assert head.center is not None
    assert neck.center is not None
    assert 2 * math.dist(head.start, head.center) == pytest.approx(8.0)
    throat = neck.center[1] - math.dist(neck.start, neck.center)
    assert 2 * throat == pytest.approx(5.0, abs=0.0005)
