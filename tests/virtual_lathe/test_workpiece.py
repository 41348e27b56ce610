# SPDX-License-Identifier: Apache-2.0
"""Cutting and measuring, without a chip."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from virtual_lathe.decode_vcd import expand
from virtual_lathe.machine import Move
from virtual_lathe.part import Cylinder, Face, WantedPart, read_part
from virtual_lathe.workpiece import Stock, Workpiece

SLOW, FAST = 24_000, 12_000


class Tool:
    """Leads the tool in part coordinates: radius and z in steps."""

    def __init__(self, work: Workpiece, x: int, z: int) -> None:
        """Put the tool at radius ``x`` and ``z``."""
        self.work, self.x, self.z, self.cycle = work, x, z, 1_000_000

    def to(self, x: int, z: int, pace: int = SLOW) -> None:
        """Move to a place, ``pace`` cycles per step."""
        while (self.x, self.z) != (x, z):
            self.x += (x > self.x) - (x < self.x)
            self.z += (z > self.z) - (z < self.z)
            self.cycle += pace
            place = Move(
                self.cycle, 2 * (self.x + self.work.zero_x), 2 * (self.z + self.work.zero_z)
            )
            self.work.cut([place])


def _work(allowance: int = 0) -> tuple[Workpiece, Tool]:
    work = Workpiece(Stock(100, 400, allowance))
    return work, Tool(work, 120, 30)


def _turn(tool: Tool, radius: int, end: int) -> None:
    tool.to(radius, 30, FAST)
    tool.to(radius, end)
    tool.to(radius + 10, end)
    tool.to(radius + 10, 30, FAST)


def test_a_cylinder_is_cut_to_the_step_and_measured() -> None:
    work, tool = _work()
    for radius in (80, 60):
        _turn(tool, radius, -200)
    wanted = WantedPart(100, 400, 0, (Cylinder(0, -200, 60),))
    assert [work.radius_at(z) for z in (0, -100, -200, -201, -400)] == [60, 60, 60, 100, 100]
    assert work.gouge_max_steps(wanted) == 0
    assert work.crashes == []
    assert work.dimensions(wanted, 10_000, 10_000) == [
        {"name": "cylinder 1 diameter", "wanted_mm": 1.2, "cut_mm": 1.2, "error_steps": 0.0},
        {"name": "cylinder 1 length", "wanted_mm": 2.0, "cut_mm": 2.0, "error_steps": 0},
    ]


def test_what_is_cut_too_deep_too_far_or_not_at_all_is_found() -> None:
    work, tool = _work()
    _turn(tool, 58, -203)
    wanted = WantedPart(100, 400, 0, (Cylinder(0, -200, 60),))
    diameter, length = work.dimensions(wanted, 7112, 7112)
    assert (diameter["error_steps"], length["error_steps"]) == (-2, 3)
    # 3 steps behind the shoulder and 2 below the surface, measured to the edge between them.
    assert work.gouge_max_steps(wanted) == pytest.approx(math.hypot(3, 2))
    untouched, _ = _work()
    diameter, length = untouched.dimensions(wanted, 7112, 7112)
    assert (diameter["error_steps"], length["error_steps"]) == (40, -200)


def test_facing_to_the_centre_drops_what_is_in_front() -> None:
    work, tool = _work(allowance=25)
    for z in (10, 0):
        tool.to(120, z, FAST)
        tool.to(0, z)
        tool.to(0, 30)
        tool.to(120, 30)
    wanted = WantedPart(100, 400, 25, (Face(0, 0),))
    assert work.radius_at(5) == work.radius_at(25) == 0
    assert work.dimensions(wanted, 7112, 7112)[0]["error_steps"] == 0
    assert work.gouge_max_steps(wanted) == 0


def test_crashes_are_named() -> None:
    work, tool = _work()
    tool.to(90, 30)
    tool.to(90, -50, FAST)
    tool.to(120, -50)
    tool.to(120, -401)
    tool.to(120, 50)
    tool.to(-20, 50)
    tool.to(-20, -20)
    assert [crash.kind for crash in work.crashes] == [
        "rapid into material",
        "chuck",
        "beyond the axis",
    ]


def test_the_profile_holds_every_step() -> None:
    work, tool = _work(allowance=3)
    _turn(tool, 70, -33)
    radii = expand(work.profile(7112, 7112), 7112, 7112)
    assert radii == [work.radius_at(z) for z in range(-400, 4)]


def test_a_part_file_becomes_steps_of_the_nearest_size(tmp_path: Path) -> None:
    file = tmp_path / "bar.toml"
    file.write_text(
        '[part]\nname = "bar"\nunits = "inch"\n[stock]\ndiameter = 1.0\nlength = 2.0\n'
        "allowance = 0.01\n[cut]\n"
        '[[operation]]\ntype = "face"\nz = 0.0\n'
        '[[operation]]\ntype = "cylinder"\nz = [0.0, -1.0]\ndiameter = 0.6\n',
        encoding="utf-8",
    )
    part = read_part(file)
    face, cylinder = part.operations
    assert (part.stock_radius, part.length, part.front) == (1786, 7143, 36)
    assert isinstance(face, Face)
    assert (face.z, face.inner) == (0, 0)
    assert isinstance(cylinder, Cylinder)
    assert (cylinder.start, cylinder.end, cylinder.radius) == (0, -3571, 1071)
    assert cylinder.drawn.radius == pytest.approx(7.62 / 0.007112)
    assert cylinder.drawn.length == pytest.approx(25.4 / 0.007112)
    surface = part.surface()
    assert [surface[z] for z in (36, 0, -1, -3571, -3572)] == [0, 0, 1071, 1071, 1786]
    file.write_text(
        file.read_text(encoding="utf-8").replace('"face"', '"thread"'), encoding="utf-8"
    )
    with pytest.raises(ValueError, match="thread"):
        read_part(file)
