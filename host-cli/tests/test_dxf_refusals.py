# SPDX-License-Identifier: Apache-2.0
"""DXF import: what is refused names the file, the place and the remedy."""

import builtins
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import pytest
from dxf_drawings import add_stepped_pin, drawing, saved, task_for
from ezdxf.layouts.layout import Modelspace

from tornillo.dxf.importer import Import
from tornillo.dxf.options import Cutting, Tool, View
from tornillo.errors import DrawingError, TornilloError
from tornillo.machine import Machine


class Refused(NamedTuple):
    """A drawing, what is said about it, and the refusal's parts."""

    draw: Callable[[Modelspace], object]
    texts: tuple[str, ...]
    remedy: str
    marks: tuple[tuple[float, float], ...] = ()
    view: Mapping[str, Any] = MappingProxyType({})
    tool: Tool = Tool()


def lines(*places: tuple[float, float], layer: str = "0") -> Callable[[Modelspace], object]:
    """Draw a line through places."""
    return lambda space: space.add_lwpolyline(places, dxfattribs={"layer": layer})


def both(*draw: Callable[[Modelspace], object]) -> Callable[[Modelspace], object]:
    """Draw several things."""
    return lambda space: [one(space) for one in draw]


REFUSED = {
    "a gap just above the snap": Refused(
        both(lines((0, 2), (-5, 2)), lines((-5.02, 2), (-9, 4))),
        (
            "the outline breaks into 2 parts: 0.02 mm are missing between x -5, y 2 (LWPOLYLINE ",
            "on layer 0) and x -5.02, y 2 (LWPOLYLINE ",
        ),
        "join the ends in the drawing, or bridge them with --snap 0.021",
        ((-5, 2), (-5.02, 2)),
    ),
    "a large gap": Refused(
        both(lines((0, 2), (-5, 2), layer="A"), lines((-8, 2), (-9, 4), layer="B")),
        ("3 mm are missing between", "on layer A", "on layer B"),
        "draw what is missing, or choose the outline's layer with --layer",
        ((-5, 2), (-8, 2)),
    ),
    "two gaps": Refused(
        both(lines((0, 2), (-5, 2)), lines((-5.1, 2), (-9, 2)), lines((-9.2, 2), (-12, 2))),
        ("breaks into 3 parts: 0.1 mm are missing", "; 0.2 mm are missing"),
        "--snap 0.105",
        ((-5, 2), (-5.1, 2), (-9, 2), (-9.2, 2)),
    ),
    "a gap beside an upright spindle": Refused(
        both(lines((2, 0), (2, -5)), lines((2, -5.02), (4, -9))),
        ("between x 2, y -5 (", "and x 2, y -5.02 ("),
        "--snap 0.021",
        ((2, -5), (2, -5.02)),
        {"spindle": "y"},
    ),
    "a branch": Refused(
        both(lines((0, 2), (-5, 2), (-5, 4)), lines((-5, 2), (-9, 2))),
        ("the outline branches at x -5, y 2: 3 pieces meet there: LWPOLYLINE",),
        "leave only the outline: take its layer with --layer, or delete inner lines",
        ((-5, 2),),
    ),
    "a crowded branch": Refused(
        both(*(lines((0, 2), (-5, y)) for y in (1, 2, 3, 4, 5))),
        ("5 pieces meet there", "2 more"),
        "--layer",
        ((0, 2),),
    ),
    "a separate figure": Refused(
        both(lines((0, 0), (0, 5), (-9, 5)), lambda space: space.add_circle((-4, 3), 1)),
        ("2 separate figures are drawn; one of them is CIRCLE", "on layer 0 at x -3, y 3"),
        "choose the outline's layer with --layer, or delete the other figures",
        ((-4, 4),),
    ),
    "an overhang": Refused(
        lines((0, 2), (-5, 2), (-3, 4), (-9, 4)),
        (
            "the outline runs back towards the free end, where no tool from this side reaches: "
            "LWPOLYLINE",
            "at x -5, y 2 (z -5, diameter 4 mm)",
        ),
        "--free-end",
        ((-5, 2),),
    ),
    "a fall that is too steep": Refused(
        lines((0, 4), (-5, 4), (-7, 2), (-12, 2)),
        (
            "the outline falls at 45.0 degrees, the tool right-hand follows 30: LWPOLYLINE",
            "at x -5, y 4 (z -5, diameter 8 mm)",
        ),
        "take a tool that can, for example --back-clearance 45, or change the drawing",
        ((-5, 4),),
        {"free_end": "right"},
    ),
    "the far side of a ball": Refused(
        lambda space: space.add_circle((-5, 0), 5),
        ("the outline falls at 90.0 degrees", "at x -10, y 0 (z -10, diameter 0 mm)"),
        "stop in front of it with --length",
        ((-10, 0),),
    ),
    "a rise that is too steep": Refused(
        lines((0, 2), (-5, 2), (-5, 4), (-9, 4)),
        ("the outline rises at 90.0 degrees, the tool blunt follows 85",),
        "take a tool with another hand or --front-clearance",
        ((-5, 2),),
        {},
        Tool("blunt", front_clearance=-5.0),
    ),
    "a rise that a left-hand tool cannot follow": Refused(
        lines((0, 2), (-5, 2), (-9, 6)),
        ("the outline rises at 45.0 degrees, the tool left follows 30",),
        "--back-clearance 45",
        ((-5, 2),),
        {},
        Tool("left", "left"),
    ),
    "halves that differ": Refused(
        lines((0, 2), (-5, 2), (-5, -2), (-3.5, -3), (-2, -2), (0, -2), (0, 2)),
        ("the halves above and below the axis (y 0) differ by 1 mm", "has no mirror image"),
        "--half",
        ((-3.5, -3),),
    ),
    "an axis that cannot be found": Refused(
        lines((0, 1), (-9, 1), (-9, -8), (0, -5)),
        ("the axis cannot be found: the drawing reaches from y -8 to y 1",),
        "say where the axis is with --axis",
    ),
    "a half that is not there": Refused(
        lines((0, 2), (-9, 2)),
        ("nothing is drawn in the lower half, axis at y 0",),
        "leave --half lower out, or say with --axis where the axis is",
        (),
        {"half": "lower"},
    ),
    "only the axis": Refused(
        lines((0, 0), (-9, 0)),
        ("everything drawn lies on the axis, y 0",),
        "say with --axis where the axis is",
    ),
    "only a face": Refused(
        lines((0, 0), (0, 5)),
        ("only flat faces are drawn",),
        "check --spindle",
    ),
    "a part shorter than wanted": Refused(
        lines((0, 2), (-9, 2)),
        ("the outline ends at z -9 mm, before the wanted length of 12",),
        "leave --length out",
        (),
        {"length": 12.0},
    ),
    "a layer without anything": Refused(
        both(lines((0, 2), (-9, 2), layer="OUTLINE"), lines((0, 3), (-9, 3), layer="HATCHING")),
        ("nothing is drawn on layer contour",),
        "choose with --layer from: HATCHING (1), OUTLINE (1)",
        (),
        {"layers": ("CONTOUR",)},
    ),
    "nothing but text": Refused(
        lambda space: space.add_text("nothing"),
        ("there is nothing to turn in it; found: 1 TEXT",),
        "draw the outline in model space with LINE, ARC, CIRCLE",
    ),
    "an empty drawing": Refused(
        lambda _space: None, ("there is nothing to turn in it; found: no entities",), "model space"
    ),
    "a part as large as a house": Refused(
        lines((0, 2), (-5, 2)),
        (
            "the part is 5000 mm long and 4000 mm thick; otmt-co reaches 57.41 mm along and "
            "25.43 mm from the axis, retract included",
        ),
        "check the units (now m) with --units, or make the part smaller with --scale 0.0115",
        (),
        {"units": "m"},
    ),
    "a line that leaves the plane": Refused(
        lambda space: space.add_line((0, 2, 0), (-9, 2, 3)),
        ("LINE ", "on layer 0 does not lie in the plane of the drawing"),
        "flatten the drawing",
    ),
    "a tilted arc": Refused(
        lambda space: space.add_circle((0, 2), 1, {"extrusion": (1, 0, 1)}),
        ("CIRCLE ", "does not lie in the plane"),
        "flatten the drawing",
    ),
    "a spline without points": Refused(
        lambda space: space.add_spline(),
        ("SPLINE ", "on layer 0 cannot be understood"),
        "draw it again, or as arcs",
    ),
    "too much": Refused(
        lambda space: [space.add_line((0, i), (-9, i)) for i in range(1, 402)],
        ("401 lines and arcs are too many for an outline, at most 400",),
        "choose the outline's layer with --layer",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_refusal_names_file_place_and_remedy(tmp_path: Path, name: str) -> None:
    case = REFUSED[name]
    document, space = drawing()
    case.draw(space)
    with pytest.raises(DrawingError) as caught:
        task_for(document, tmp_path, **case.view).part_text(Cutting(tool=case.tool))
    message = str(caught.value)
    assert message.startswith(f"{tmp_path / 'drawing.dxf'}: ")
    for text in case.texts:
        assert text in message
    assert case.remedy in caught.value.remedy
    places = [pytest.approx(place, abs=1e-6) for place, _ in caught.value.marks]
    assert len(places) == len(case.marks)
    assert all(any(wanted == place for place in places) for wanted in case.marks)


def refusal_of(path: Path) -> DrawingError:
    """What is said about a file."""
    with pytest.raises(DrawingError) as caught:
        Import(path, View(), Machine.load()).part_text(Cutting())
    return caught.value


def test_a_drawing_without_units_is_not_guessed(tmp_path: Path) -> None:
    document, space = drawing(0)
    add_stepped_pin(space)
    error = refusal_of(saved(document, tmp_path))
    assert "drawing.dxf: the drawing does not say its units ($INSUNITS)" in str(error)
    assert error.remedy == "say them with --units mm or --units inch"


def test_a_file_that_is_not_there_is_told(tmp_path: Path) -> None:
    error = refusal_of(tmp_path / "nothing.dxf")
    assert "nothing.dxf: the drawing cannot be read: No such file or directory" in str(error)


@pytest.mark.parametrize("content", [b"", b"not a drawing\n", b"\x89PNG\r\n\x1a\n\0\0"])
def test_a_file_that_is_no_drawing_is_told(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "other.dxf"
    path.write_bytes(content)
    error = refusal_of(path)
    assert "other.dxf: this is not a DXF drawing, or it is damaged" in str(error)
    assert error.remedy == "export it again as DXF (ASCII, R12 or later)"


def test_a_dwg_file_is_told_from_a_dxf_file(tmp_path: Path) -> None:
    path = tmp_path / "part.dxf"
    path.write_bytes(b"AC1032" + bytes(100))
    error = refusal_of(path)
    assert "part.dxf: this is a DWG file" in str(error)
    assert "save it as DXF" in error.remedy


def test_a_damaged_drawing_is_repaired_when_it_can_be(tmp_path: Path) -> None:
    document, space = drawing()
    add_stepped_pin(space)
    path = saved(document, tmp_path)
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("ENDTAB\n  0\nTABLE", "ENDTAB\n  0\nTABEL", 1), encoding="utf-8")
    assert "profile" in Import(path, View(), Machine.load()).part_text(Cutting())


def test_without_ezdxf_it_is_told_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real_import = builtins.__import__

    def without(name: str, *rest: Any) -> object:
        if name.startswith("ezdxf"):
            raise ImportError(name)
        return real_import(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(TornilloError) as caught:
        Import(tmp_path / "x.dxf", View(), Machine.load()).part_text(Cutting())
    assert 'pip install "tornillo[dxf]"' in caught.value.remedy
