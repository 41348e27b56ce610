# SPDX-License-Identifier: Apache-2.0
"""The outline of the finished part from all its operations."""

import pytest

from tornillo.contour import Arc, Element, Line
from tornillo.dimensioning import diameters, lengths, sharpened
from tornillo.outline import outline
from tornillo.part import Part

HEAD = """
[part]
name = "shape"
units = "mm"
[stock]
diameter = 20.0
length = 30.0
allowance = 1.0
[cut]
depth_of_cut = 1.0
feed = 100.0
retract = 0.5
[[tool]]
name = "turning"
back_clearance = 60
[[tool]]
name = "parting"
width = 2.0
"""


def shape(*operations: str) -> tuple[Element, ...]:
    """The outline of a part."""
    return outline(part_of(*operations))


def part_of(*operations: str) -> Part:
    """A part of these operations."""
    return Part.parse(HEAD + "".join(f"[[operation]]\n{text}\n" for text in operations))


def ends(pieces: tuple[Element, ...]) -> list[tuple[float, float, float, float]]:
    """Start and end of each piece, z and radius, rounded."""
    return [
        (round(a.z, 3), round(a.x, 3), round(b.z, 3), round(b.x, 3))
        for a, b in ((piece.start, piece.end) for piece in pieces)
    ]


FACE = 'type = "face"\nz = 0.0'


def test_cylinders_leave_steps_and_a_face_clears_the_front() -> None:
    found = shape(FACE, 'type = "cylinder"\nz = [0.0, -10.0]\ndiameter = 12.0')
    assert ends(found) == [(0, 6, -10, 6), (-10, 10, -30, 10)]


def test_without_a_face_the_raw_front_stands() -> None:
    found = shape('type = "cylinder"\nz = [0.0, -10.0]\ndiameter = 12.0')
    assert ends(found)[0] == (1, 10, 0, 10)


def test_arcs_stay_arcs_and_are_cut_where_others_pass_below() -> None:
    found = shape(
        FACE,
        'type = "arc"\nstart = { z = 0.0, diameter = 0.0 }\n'
        "end = { z = -10.0, diameter = 20.0 }\nradius = 10.0",
        'type = "cylinder"\nz = [0.0, -20.0]\ndiameter = 12.0',
    )
    arc, line, raw = found
    assert isinstance(arc, Arc)
    assert arc.radius == pytest.approx(10)
    assert (arc.end.z, arc.end.x) == pytest.approx((-2.0, 6.0))
    assert isinstance(line, Line)
    assert ends((line, raw)) == [(-2, 6, -20, 6), (-20, 10, -30, 10)]


def test_grooves_and_parting_cut_into_what_stands_there() -> None:
    found = shape(
        FACE,
        'type = "groove"\ntool = "parting"\nz = [-5.0, -9.0]\ndiameter = 10.0',
        'type = "part-off"\ntool = "parting"\nz = -20.0\ndiameter = 2.0',
    )
    assert ends(found) == [
        (0, 10, -5, 10),
        (-5, 5, -9, 5),
        (-9, 10, -20, 10),
        (-20, 1, -22, 1),
        (-22, 10, -30, 10),
    ]


def test_what_is_turned_away_is_not_there() -> None:
    found = shape('type = "cylinder"\nz = [1.0, -10.0]\ndiameter = 0.0')
    assert ends(found) == [(-10, 10, -30, 10)]


def test_a_diameter_behind_a_larger_one_is_hidden() -> None:
    pieces = shape(
        FACE,
        'type = "profile"\npoints = [{ z = 0.0, diameter = 14.0 }, { z = -5.0, diameter = 14.0 }, '
        "{ z = -8.0, diameter = 8.0 }, { z = -12.0, diameter = 8.0 }]",
    )
    found = {entry.radius: entry for entry in diameters(pieces)}
    assert sorted(found) == [4, 7, 10]
    assert [found[radius].hidden for radius in (4, 7, 10)] == [True, False, False]
    assert found[4].level == pytest.approx(4)


def test_lengths_are_told_once_and_part_zero_not_at_all() -> None:
    part = part_of(FACE, 'type = "cylinder"\nz = [0.0, -10.0]\ndiameter = 12.0')
    assert lengths(part, outline(part)) == [1.0, -10.0, -30.0]


def test_a_rounded_corner_is_dimensioned_where_its_lines_meet() -> None:
    pieces = shape(
        FACE,
        'type = "profile"\npoints = [{ z = 0.0, diameter = 10.0 }, '
        "{ z = -10.0, diameter = 10.0, corner = 0.3 }, { z = -12.0, diameter = 14.0 }, "
        "{ z = -15.0, diameter = 14.0 }]",
    )
    assert isinstance(pieces[1], Arc)
    assert ends(tuple(sharpened(pieces, 0.5)))[:2] == [(0, 5, -10, 5), (-10, 5, -12, 7)]
