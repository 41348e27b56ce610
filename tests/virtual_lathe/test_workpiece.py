# SPDX-License-Identifier: Apache-2.0
"""Cutting and measuring, without a chip."""

from __future__ import annotations

import math

import pytest

from virtual_lathe.decode_vcd import expand
from virtual_lathe.driver import Driver
from virtual_lathe.machine import Move
from virtual_lathe.part import Cylinder, Face, WantedPart
from virtual_lathe.tool import Tool
from virtual_lathe.workpiece import Stock, Workpiece

SLOW, FAST = 24_000, 12_000


class Hand:
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


def _work(allowance: int = 0) -> tuple[Workpiece, Hand]:
    work = Workpiece(Stock(100, 400, allowance))
    return work, Hand(work, 120, 30)


def _turn(tool: Hand, radius: int, end: int) -> None:
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


def test_the_holder_in_the_material_is_a_crash() -> None:
    work = Workpiece(Stock(100, 400), tool=Tool(edge_length=30))
    tool = Driver(work, 120, 30)
    tool.along((75, 30), (75, -50), (60, 30))
    assert work.crashes == []
    tool.along((60, 30), (60, -70))
    assert [crash.kind for crash in work.crashes] == ["holder into material"]


def test_an_edge_that_leans_to_the_chuck_may_touch_it_before_the_tip_does() -> None:
    for hand, kinds in (("left", ["chuck"]), ("right", [])):
        work = Workpiece(Stock(100, 400, chuck_radius=120), tool=Tool(hand=hand))
        Driver(work, 150, -350).to(105, -380)
        assert [crash.kind for crash in work.crashes] == kinds


def test_the_nose_may_pass_the_axis_by_its_radius() -> None:
    for nose, kinds in ((20.0, []), (14.0, ["beyond the axis"])):
        work = Workpiece(Stock(100, 400), tool=Tool(nose=nose))
        Driver(work, 120, -1).to(-20, -1)
        assert [crash.kind for crash in work.crashes] == kinds


@pytest.mark.parametrize(("pace", "kinds"), [(SLOW, []), (FAST, ["rapid into material"])])
def test_a_staircase_has_the_rate_of_its_slope(pace: int, kinds: list[str]) -> None:
    """Two steps of Z to one of X at the same time, written one shortly after the other."""
    work = Workpiece(Stock(100, 400), tool=Tool())
    moves, cycle, x = [], 1_000_000, 60
    for z in range(20, -60, -1):
        cycle += pace * 9 // 8
        if z % 2:
            x += 1
            moves.append(Move(cycle - 12, 2 * (x + work.zero_x), 2 * (z + 1 + work.zero_z)))
        moves.append(Move(cycle, 2 * (x + work.zero_x), 2 * (z + work.zero_z)))
    work.cut(moves)
    assert [crash.kind for crash in work.crashes] == kinds
    assert work.steps_cutting > 40


def test_what_both_slides_do_at_once_is_one_straight_step() -> None:
    work = Workpiece(Stock(100, 400), tool=Tool(back_clearance=50))
    tool = Driver(work, 120, -100)
    tool.to(60, -100)
    x, z = 2 * (58 + work.zero_x), 2 * (-102 + work.zero_z)
    work.cut([Move(tool.cycle + SLOW, x, z + 4), Move(tool.cycle + SLOW + 10, x, z)])
    assert [work.radius_at(place) for place in (-102, -101, -100)] == [58, 59, pytest.approx(60)]


def test_the_profile_holds_every_step() -> None:
    work, tool = _work(allowance=3)
    _turn(tool, 70, -33)
    radii = expand(work.profile(7112, 7112), 7112, 7112)
    assert radii == [work.radius_at(z) for z in range(-400, 4)]
