# SPDX-License-Identifier: Apache-2.0
"""Every type of operation: what it becomes, and how what cannot be is refused."""

from dataclasses import replace

import pytest
from part_texts import HEAD, TOOLS, operation, profile, refusal, segments, steps

from tornillo.errors import PartError
from tornillo.image import SegmentKind
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol import (
    ContourRecord,
    CutRecord,
    PauseRecord,
    PlungeRecord,
    ToolRecord,
)

LINE, CONVEX, CONCAVE = SegmentKind
MM = 1e6 / 7112
FACED = HEAD.replace("length = 40.0", "length = 40.0\nallowance = 0.5") + TOOLS
CYLINDER = operation("cylinder", "z = [0.0, -10.0]\ndiameter = 15.0")


def contour_of(*operations: str, head: str = HEAD + TOOLS) -> ContourRecord:
    """The last contour of a part."""
    record = steps(*operations, head=head).records[-1]
    assert isinstance(record, ContourRecord)
    return record


def test_a_face_is_an_upright_line_roughed_in_facing_direction() -> None:
    record = contour_of(operation("face", "z = 0.0"), head=FACED)
    assert (record.kind, record.z, record.x) == (0x80, 0, 0)
    assert [(s.dz, s.dx) for s in segments(record)] == [(0, 1406)]


def test_a_face_may_stop_at_a_diameter() -> None:
    assert contour_of(operation("face", "z = 0.0\ndiameter = 4"), head=FACED).x == round(2 * MM)


def test_a_cylinder_is_a_level_line() -> None:
    record = contour_of(CYLINDER)
    assert (record.kind, record.z, record.x) == (1, 0, 1055)
    assert [(s.dz, s.dx) for s in segments(record)] == [(-1406, 0)]


def test_a_cone_is_a_slanted_line() -> None:
    record = contour_of(
        operation("cone", "start = { z = 0, diameter = 5 }\nend = { z = -10, diameter = 12 }")
    )
    assert (record.kind, record.z, record.x) == (2, 0, 352)
    assert [(s.dz, s.dx) for s in segments(record)] == [(-1406, 492)]


@pytest.mark.parametrize(
    ("how", "kind"),
    [
        ("radius = 8", CONVEX),
        ("radius = -8", CONCAVE),
        ("center = { z = -8, diameter = 0 }", CONVEX),
        ("center = { z = 0, diameter = 16 }", CONCAVE),
        ("center = { z = 0, diameter = 16 }\nradius = -8", CONCAVE),
        ("via = { z = -2.34314575, diameter = 11.3137085 }", CONVEX),
        ("via = { z = -5.65685425, diameter = 4.6862915 }", CONCAVE),
    ],
)
def test_an_arc_is_given_by_radius_centre_or_a_third_point(how: str, kind: SegmentKind) -> None:
    body = f"start = {{ z = 0, diameter = 0 }}\nend = {{ z = -8, diameter = 16 }}\n{how}"
    record = contour_of(operation("arc", body))
    [arc] = segments(record)
    assert (record.kind & 0x7F, arc.kind, arc.dz, arc.dx) == (3, kind, -1125, 1125)
    centre = (-1125, 0) if kind is CONVEX else (0, 1125)
    assert (arc.cz / 256, arc.cx / 256) == pytest.approx(centre, abs=0.3)


def test_a_profile_is_a_chain_of_lines_and_arcs() -> None:
    text = profile("0 4", "-3 4", "-5 8 radius = 2.0", "-8 8", "-9 12 radius = -2.5", "-12 12")
    record = contour_of(text)
    assert record.kind & 0x7F == 4
    assert [s.kind for s in segments(record)] == [LINE, CONVEX, LINE, CONCAVE, LINE]


def test_a_profile_may_have_rounded_and_chamfered_corners() -> None:
    text = profile("0 0", "0 10 chamfer = 1", "-5 10 corner = 1.5", "-5 16 corner = 1", "-9 16")
    found = segments(contour_of(text))
    assert [s.kind for s in found] == [LINE, LINE, LINE, CONCAVE, LINE, CONVEX, LINE]
    chamfer = found[1]
    assert (chamfer.dz, chamfer.dx) == (-141, 141)


def test_a_groove_is_a_plunge_with_the_tools_corner_on_the_chucks_side() -> None:
    body = 'z = [-5.0, -12.0]\ndiameter = 8.0\ntool = "parting"'
    record = steps(operation("groove", body)).records[-1]
    assert record == PlungeRecord(0, round(-5 * MM) - 281, round(-12 * MM), round(4 * MM))


def test_parting_off_leaves_the_back_face_at_its_place() -> None:
    record = steps(operation("part-off", 'z = -20.0\ntool = "parting"')).records[-1]
    place = round(-20 * MM) - 281
    assert record == PlungeRecord(1, place, place, 0)


def test_parting_off_with_a_round_nose_goes_beyond_the_axis_where_the_slide_does() -> None:
    head = HEAD + TOOLS.replace("width = 2.0", "width = 2.0\nnose_radius = 0.2")
    part = Part.parse(head + operation("part-off", 'z = -20.0\ntool = "parting"'))
    far = Machine("far", 7112, 7112, 3700, 16072, -3575, -8000, 1000)
    for machine, x in ((Machine.load(), 0), (far, -28)):
        part.check(machine)
        record = part.steps(machine).records[-1]
        assert isinstance(record, PlungeRecord)
        assert record.x == x


def test_a_drill_is_a_pause_that_tells_what_to_drill() -> None:
    [*_, plain, said] = steps(
        CYLINDER,
        operation("drill", "diameter = 4.2\ndepth = 15"),
        operation("drill", 'diameter = 4\ndepth = 9\nmessage = "for M5"'),
    ).records
    assert plain == PauseRecord(1, b"drill 4.2 x 15 mm")
    assert said == PauseRecord(1, b"drill 4 x 9 mm: for M5")


def test_a_pause_keeps_its_message() -> None:
    image = steps(operation("pause", 'message = "turn the bar"'))
    assert [type(record) for record in image.records] == [ToolRecord, CutRecord, PauseRecord]
    assert image.records[-1] == PauseRecord(0, b"turn the bar")


def test_tools_and_cutting_data_are_told_again_only_when_they_change() -> None:
    deeper = operation("cylinder", "z = [0.0, -10.0]\ndiameter = 14.0\nfeed = 50.0")
    groove = operation("groove", 'z = [-5.0, -8.0]\ndiameter = 8.0\ntool = "parting"')
    pause = operation("pause", 'message = "look"')
    image = steps(CYLINDER, CYLINDER, deeper, pause, CYLINDER, groove, groove)
    kinds = "".join(type(record).__name__[0:2] for record in image.records)
    assert kinds == "ToCuCoCoCuCoPaCuCoToPlPl"
    assert [r.kind for r in image.records if isinstance(r, ToolRecord)] == [0, 1]


@pytest.mark.parametrize(
    ("key", "value", "field", "wanted"),
    [
        ("feed", "50", "feed", round(50e6 / 7112 * 8 / 60)),
        ("finish_feed", "50", "finish_feed", round(50e6 / 7112 * 8 / 60)),
        ("depth_of_cut", "0.5", "depth_of_cut", 70),
        ("finish_allowance", "0.1", "finish_allowance", 14),
        ("spindle", "1200", "spindle", 1200),
        ("spring_passes", "3", "kind", 3),
        ("peck", "0.7", "peck", 98),
        ("peck", "0", "peck", 0),
    ],
)
def test_an_operation_may_have_its_own_cutting_data(
    key: str, value: str, field: str, wanted: int
) -> None:
    image = steps(operation("cylinder", f"z = [0, -9]\ndiameter = 9\n{key} = {value}"))
    cut = image.records[1]
    assert isinstance(cut, CutRecord)
    assert getattr(cut, field) == wanted


def test_the_finish_feed_follows_the_feed_until_somebody_gives_one() -> None:
    own = operation("cylinder", "z = [0, -9]\ndiameter = 9\nfeed = 50")
    for head, follows in (
        (HEAD, True),
        (HEAD.replace("feed = 100", "feed = 100.0\nfinish_feed = 9"), False),
    ):
        cut = steps(own, head=head).records[1]
        assert isinstance(cut, CutRecord)
        assert (cut.finish_feed == cut.feed) is follows


def test_order_auto_cuts_faces_cylinders_cones_arcs_then_the_others() -> None:
    head = FACED.replace('units = "mm"', 'units = "mm"\norder = "auto"')
    part = Part.parse(
        head
        + operation("pause", 'message = "one"')
        + operation("arc", "start = {z=-12,diameter=18}\nend = {z=-13,diameter=20}\nradius = 1")
        + operation("cone", "start = {z=-10,diameter=15}\nend = {z=-12,diameter=18}")
        + operation("groove", 'z = [-3, -6]\ndiameter = 8\ntool = "parting"')
        + CYLINDER
        + operation("face", "z = 0.0")
    )
    part.check(Machine.load())
    assert [op.type for op in part.ordered] == [
        "face",
        "cylinder",
        "cone",
        "arc",
        "pause",
        "groove",
    ]
    assert part.describe(1) == "operation 6 (face)"


@pytest.mark.parametrize(
    ("length", "diameter", "how", "facing"),
    [
        (-10, 15, "", False),
        (-1.1, 14.2, "", False),  # though in facing direction it takes fewer passes
        (-0.8, 18.6, "", False),  # as many passes, but the way out of each is at the feed
        (-1, 4, "", True),
        (-1, 4, 'roughing = "along"', False),
        (-10, 15, 'roughing = "facing"', True),
        (-10, 15, 'roughing = "shortest"', False),
    ],
)
def test_roughing_takes_the_shorter_way_or_the_one_it_is_told(
    length: float, diameter: float, how: str, facing: bool
) -> None:
    text = operation("cylinder", f"z = [0, {length}]\ndiameter = {diameter}\n{how}")
    assert bool(contour_of(text).kind & 0x80) is facing


def test_what_is_already_cut_decides_about_the_way_of_roughing() -> None:
    first = operation("cylinder", 'z = [0, -30]\ndiameter = 9\nroughing = "along"')
    second = operation("cylinder", "z = [0, -2]\ndiameter = 8")
    assert contour_of(second).kind & 0x80
    assert not contour_of(first, second).kind & 0x80


@pytest.mark.parametrize(("step_z", "facing"), [(3556, True), (7112, False), (14224, False)])
def test_a_step_along_another_size_than_across_is_allowed_for(step_z: int, facing: bool) -> None:
    machine = replace(Machine.load(), step_z_nm=step_z)
    text = HEAD + operation("cylinder", "z = [0, -1.1]\ndiameter = 14.2")
    image = Part.parse(text).steps(machine)
    cut, record = image.records[1:]
    assert isinstance(cut, CutRecord)
    assert isinstance(record, ContourRecord)
    assert bool(record.kind & 0x80) is facing
    assert cut.depth_of_cut == round(1e6 / (step_z if facing else 7112))


@pytest.mark.parametrize("bad", ["depth_of_cut = 0.001", "feed = 0.1", "finish_feed = 0.1"])
def test_what_the_rules_refuse_is_not_timed(bad: str, machine: Machine) -> None:
    text = HEAD + operation("cylinder", f"z = [0, -1]\ndiameter = 4\n{bad}")
    with pytest.raises(PartError, match=r"depth of cut|a feed is too slow"):
        Part.parse(text).check(machine)


def test_roughing_does_not_cut_in_facing_direction_what_is_in_front() -> None:
    bead = operation("cylinder", "z = [0, -3]\ndiameter = 15")
    neck = operation("cylinder", 'z = [-3, -4]\ndiameter = 6\ntool = "square"')
    head = HEAD + TOOLS.replace('"pointed"', '"square"').replace("= 60.0", "= 90.0")
    assert not contour_of(bead, neck, head=head).kind & 0x80
    error = refusal(bead, neck.replace("tool", 'roughing = "facing"\ntool'), head=head)
    assert "would cut what is in front" in str(error)
    assert 'roughing = "along"' in error.remedy


def test_a_falling_contour_is_not_roughed_in_facing_direction() -> None:
    text = profile("0 10", "-5 8", "-6 16", more='roughing = "facing"\n')
    assert "a contour that falls cannot be roughed" in str(refusal(text))
