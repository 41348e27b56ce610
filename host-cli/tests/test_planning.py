# SPDX-License-Identifier: Apache-2.0
"""Planning: small cases worked out by hand, to the step."""

import re
from itertools import pairwise
from pathlib import Path

import pytest
from planned import FEED, FINISH_FEED, POINT, contour, cut, cylinder, face, line, part

from tornillo.image import PartImage, Record, Segment, SegmentKind
from tornillo.machine import Machine
from tornillo.moves import Halt, Pass, Role, Stop
from tornillo.planning import PARK_STEPS, plan_part, plunge_places, spread
from tornillo.protocol import PauseRecord, PlungeRecord, ToolRecord

PARK = (8000 - PARK_STEPS, 3575 - PARK_STEPS)


def passes(*records: Record, **sizes: int) -> tuple[Pass, ...]:
    """The passes of a part."""
    return plan_part(part(*records, **sizes), Machine.load()).passes


def ways(stroke: Pass) -> list[tuple[int, int, int]]:
    """(z, x, feed) at the end of each move."""
    return [(*move.end, move.feed) for move in stroke.moves]


def test_a_cylinder_is_cut_in_even_passes_and_left_by_the_retract() -> None:
    found = passes(POINT, cut(20), cylinder(0, -50, 50))
    assert [stroke.depth for stroke in found] == [17, 17, 16]
    assert ways(found[0]) == [(5, 105, 0), (5, 83, 0), (-50, 83, FEED), (-50, 88, 0)]
    assert (
        ways(found[1]) == [(-50, 88, 0), (5, 88, 0), (5, 66, 0), (-50, 66, FEED), (-50, 71, 0)][1:]
    )
    assert ways(found[2]) == [(5, 71, 0), (5, 50, 0), (-50, 50, FEED), (-50, 55, 0)]


def test_a_cylinder_with_an_allowance_gets_one_finishing_pass_and_its_spring_passes() -> None:
    found = passes(POINT, cut(20, allowance=6, spring=2), cylinder(0, -50, 80))
    assert [stroke.role for stroke in found] == [
        Role.ROUGHING,
        Role.FINISHING,
        Role.SPRING,
        Role.SPRING,
    ]
    assert ways(found[0])[-2:] == [(-50, 86, FEED), (-50, 91, 0)]
    finish = [(5, 105, 0), (5, 80, 0), (0, 80, FINISH_FEED), (-50, 80, FINISH_FEED), (-50, 105, 0)]
    assert ways(found[1]) == [(-50, 105, 0), *finish]
    assert ways(found[2]) == finish


def test_the_tool_comes_in_both_axes_at_once_only_from_outside() -> None:
    first, second = passes(POINT, cut(60), cylinder(0, -50, 50), cylinder(0, -40, 40))
    assert ways(first)[0] == (5, 105, 0)
    assert ways(second)[:3] == [(-50, 105, 0), (5, 105, 0), (5, 40, 0)]


def test_a_face_is_cut_from_outside_level_by_level() -> None:
    found = passes(POINT, cut(10), face(0, 0, 100), front=15)
    assert [stroke.role for stroke in found] == [Role.FACING, Role.FACING]
    assert ways(found[0]) == [(7, 105, 0), (7, 0, FEED), (12, 0, FEED)]
    assert ways(found[1]) == [(12, 105, 0), (0, 105, 0), (0, 0, FEED), (5, 0, FEED)]
    assert [stroke.depth for stroke in found] == [8, 7]


def test_a_cone_is_roughed_to_its_flank_and_finished_along_it() -> None:
    found = passes(POINT, cut(20, allowance=4), contour(0, 60, line(-40, 40)))
    # 100 to 60 + 4 in two levels: 82, 64. The contour is at 78 at z = -18 and at 60 at z = 0.
    assert [stroke.role for stroke in found] == [Role.ROUGHING, Role.SMOOTHING, Role.FINISHING]
    assert ways(found[0]) == [(5, 105, 0), (5, 82, 0), (-18, 82, FEED), (-18, 87, 0)]
    assert ways(found[1]) == [
        (-18, 105, 0),
        (5, 105, 0),
        (5, 64, 0),
        (0, 64, FEED),
        (-40, 104, FEED),
        (-40, 105, 0),
    ]
    assert ways(found[2])[2:4] == [(0, 60, FINISH_FEED), (-40, 100, FINISH_FEED)]


def test_two_pockets_are_cut_one_after_the_other() -> None:
    pocket = (line(-20, -60), line(-40, 0), line(-20, 60))
    found = passes(POINT, cut(20), contour(-20, 100, *pocket, line(-10, 0), *pocket))
    strokes = [stroke.stroke for stroke in found[:-1]]
    assert strokes == [
        ((-27, 105), (-93, 80)),
        ((-34, 85), (-86, 60)),
        ((-40, 65), (-80, 40)),
        ((-117, 105), (-183, 80)),
        ((-124, 85), (-176, 60)),
        ((-130, 65), (-170, 40)),
    ]
    # From the ground of the first one the tool rises above what stands between them.
    assert ways(found[3])[:2] == [(-80, 105, 0), (-117, 105, 0)]
    assert found[-1].role is Role.FINISHING


def test_what_an_earlier_operation_has_cut_is_not_cut_again() -> None:
    found = passes(POINT, cut(60), cylinder(0, -30, 50), cylinder(0, -60, 60), cylinder(0, -20, 70))
    assert [stroke.operation for stroke in found] == [1, 2]
    assert found[1].stroke == ((-25, 60), (-60, 60))


def test_an_operation_with_nothing_left_to_cut_is_left_out_with_its_contour_passes() -> None:
    before = cylinder(0, -90, 30)
    shapes: list[Record] = [
        contour(0, 40, line(-20, 10), line(-20, 0)),
        contour(0, 60, line(-20, 0), line(0, 40), facing=True),
        contour(0, 60, line(-95, 0), line(0, 40), facing=True),
    ]
    cuts = [[stroke.operation for stroke in passes(POINT, cut(70), before, s)] for s in shapes]
    assert cuts[:2] == [[1], [1]]
    assert set(cuts[2]) == {1, 2}
    tool = ToolRecord(1, b"parting", 0, 0, 20, 0, 0, 0, 0)
    found = passes(POINT, cut(70), before, tool, PlungeRecord(0, -40, -60, 30))
    assert [stroke.operation for stroke in found] == [1]


def test_an_arc_is_met_on_the_safe_side() -> None:
    quarter = Segment(SegmentKind.CONVEX, -60, 60, -60 * 256, 0)
    found = passes(POINT, cut(30), contour(0, 40, quarter))
    # The circle about z = -60, x = 40 with radius 60; levels 70 and 40. At x = 69 it is at
    # z = -60 + 52, two steps more on the safe side: -6. At 40 there is nothing but its start.
    assert [stroke.stroke[1] for stroke in found[:1]] == [(-6, 70)]
    assert [stroke.role for stroke in found] == [Role.ROUGHING, Role.FINISHING]


def test_a_groove_is_plunged_side_by_side_with_pecks() -> None:
    tool = ToolRecord(0, b"parting", 0, 0, 20, 0, 0, 0, 0)
    found = passes(tool, cut(20, peck=30), PlungeRecord(0, -40, -60, 50))
    assert plunge_places(-40, -60, 20) == [-40, -50, -60]
    assert len(found) == 3
    assert ways(found[0]) == [
        (-40, 105, 0),
        (-40, 70, FEED),
        (-40, 75, 0),
        (-40, 50, FEED),
        (-40, 105, 0),
    ]
    assert ways(found[1])[0] == (-50, 105, 0)


def test_a_plunge_as_wide_as_the_tool_is_one() -> None:
    assert plunge_places(-40, -40, 20) == [-40]
    assert plunge_places(-40, -55, 20) == [-40, -55]
    assert plunge_places(-40, -56, 20) == [-40, -48, -56]


def test_a_pause_and_another_tool_park_the_lathe() -> None:
    second = POINT._replace(kind=1, name=b"other\0", offset_z=7, offset_x=-3)
    records = (
        POINT,
        cut(60),
        cylinder(0, -50, 50),
        PauseRecord(1, b"drill 5 mm"),
        second,
        cylinder(0, -20, 40),
    )
    plan = plan_part(part(*records), Machine.load())
    kinds = [step.halt if isinstance(step, Stop) else step.operation for step in plan.steps]
    assert kinds == [1, Halt.DRILL, Halt.TOOL, 3, Halt.END]
    drill, change, end = plan.stops
    assert [move.end for move in drill.moves] == [(-50, PARK[1]), PARK]
    assert (drill.operation, drill.text) == (2, "drill 5 mm")
    assert (change.moves, change.text) == ((), "other")
    assert plan.passes[1].moves[0].start == (PARK[0] - 7, PARK[1] + 3)
    assert end.moves[-1].end == (PARK[0] - 7, PARK[1] + 3)
    assert [len(chain) for chain in plan.chains()] == [6, 0, 6]


def test_every_move_starts_where_the_one_before_has_ended() -> None:
    plan = plan_part(
        part(POINT, cut(20, 3), face(0, 0, 100), cylinder(0, -50, 50), front=9), Machine.load()
    )
    at = PARK
    for move in plan.moves:
        assert move.start == at
        at = move.end
    assert at == PARK


@pytest.mark.parametrize(("outside", "size", "depth"), [(100, 50, 20), (7, 6, 3), (50, -10, 9)])
def test_levels_are_even_and_end_on_size(outside: int, size: int, depth: int) -> None:
    levels = [outside, *spread(outside, size, depth)]
    steps = [one - other for one, other in pairwise(levels)]
    assert levels[-1] == size
    assert max(steps) - min(steps) <= 1
    assert max(steps) <= depth
    assert spread(size, outside, depth) == []


def test_a_part_without_tool_or_cutting_data_cannot_be_planned() -> None:
    for records in ((cylinder(0, -50, 50),), (POINT, cylinder(0, -50, 50))):
        with pytest.raises(ValueError, match="the part has no"):
            plan_part(PartImage(part().header, records), Machine.load())


def test_the_parking_place_is_that_of_the_firmware() -> None:
    text = (Path(__file__).parents[2] / "firmware" / "config.h").read_text(encoding="ascii")
    assert re.findall(r"#define PARK_STEPS (\d+)", text) == [str(PARK_STEPS)]
