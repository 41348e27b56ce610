# SPDX-License-Identifier: Apache-2.0
"""Drawings for the tests of the DXF importer, and what the part files made of them hold.

The geometry here is the tests' own: nothing of it comes from `tornillo.dxf`.
"""

import math
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import ezdxf.units
from ezdxf.document import Drawing
from ezdxf.filemanagement import new
from ezdxf.layouts.layout import Modelspace

from tornillo.dxf.importer import Import
from tornillo.dxf.options import Cutting, Tool, View
from tornillo.machine import Machine

MM, INCH = ezdxf.units.MM, ezdxf.units.IN
Point = tuple[float, float]
STEEP = Tool("profiling", back_clearance=89.9)


class Piece(NamedTuple):
    """A piece of a profile: places are (z, radius)."""

    start: Point
    end: Point
    center: Point | None

    def distance(self, place: Point) -> float:
        """How far `place` is from it."""
        (z0, x0), (z1, x1) = self.start, self.end
        near_ends = min(math.dist(place, self.start), math.dist(place, self.end))
        if self.center is None:
            dz, dx = z1 - z0, x1 - x0
            share = (place[0] - z0) * dz + (place[1] - x0) * dx
            share = min(1.0, max(0.0, share / (dz * dz + dx * dx)))
            return math.dist(place, (z0 + share * dz, x0 + share * dx))
        above = place[1] >= self.center[1]
        on_side = above == (max(x0, x1) > self.center[1])
        if on_side and z1 <= place[0] <= z0:
            radius = math.dist(self.start, self.center)
            return abs(math.dist(place, self.center) - radius)
        return near_ends

    def mismatch(self) -> float:
        """How far the centre is from being equally far from both ends; 0 for a line."""
        if self.center is None:
            return 0.0
        return abs(math.dist(self.start, self.center) - math.dist(self.end, self.center))


def drawing(units: int = MM, version: str = "R2010") -> tuple[Drawing, Modelspace]:
    """An empty document and its model space."""
    document = new(version)
    document.header["$INSUNITS"] = units
    return document, document.modelspace()


def saved(document: Drawing, folder: Path, name: str = "drawing.dxf") -> Path:
    """The document as a file."""
    path = folder / name
    document.saveas(path)
    return path


def task_for(document: Drawing, folder: Path, **view: Any) -> Import:
    """The importer for a document."""
    return Import(saved(document, folder), View(**view), Machine.load())


def imported(document: Drawing, folder: Path, tool: Tool = STEEP, **view: Any) -> list[Piece]:
    """The profile that the part file of a document has."""
    task = task_for(document, folder, **view)
    return pieces(task.part_text(Cutting(tool=tool)))


def pieces(text: str) -> list[Piece]:
    """The profile in the text of a part file."""
    points = tomllib.loads(text)["operation"][-1]["points"]
    places = [(point["z"], point["diameter"] / 2) for point in points]
    centers = [
        (point["center"]["z"], point["center"]["diameter"] / 2) if "center" in point else None
        for point in points
    ]
    return [
        Piece(places[index - 1], places[index], centers[index]) for index in range(1, len(places))
    ]


def corners(found: list[Piece]) -> list[Point]:
    """The places where pieces meet, rounded to a micrometre, as (z, diameter)."""
    places = [found[0].start, *(piece.end for piece in found)]
    return [(round(z, 3) + 0.0, round(2 * radius, 3)) for z, radius in places]


def deviation(found: list[Piece], places: list[Point]) -> float:
    """The largest distance of `places`, (z, radius), from a profile."""
    return max(min(piece.distance(place) for piece in found) for place in places)


def add_stepped_pin(space: Modelspace) -> None:
    """Diameters 4, 8 and 12 over 20 mm, upper half, with faces and the axis as a line."""
    outline = [(0, 0), (0, 2), (-5, 2), (-5, 4), (-12, 4), (-12, 6), (-20, 6), (-20, 0), (0, 0)]
    for start, end in pairwise(outline):
        space.add_line(start, end)


STEPPED_PIN = [(0, 4), (-5, 4), (-5, 8), (-12, 8), (-12, 12), (-20, 12)]
