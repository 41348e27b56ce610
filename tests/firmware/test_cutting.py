# SPDX-License-Identifier: Apache-2.0
"""Parts cut on the virtual lathe: every dimension, and how the tool got there."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import on_a_new_chip
from simulated.watching import SAME_STEP, Stroke, Watch
from tornillo import Part
from tornillo.protocol import Axis, State
from virtual_lathe.chip import CYCLES_PER_SECOND
from virtual_lathe.part import read_part

HEAD = """
[part]
name = "pin"
units = "mm"
[stock]
diameter = 4.0
length = 6.0
allowance = 0.2
[cut]
depth_of_cut = 0.17
finish_allowance = {allowance}
feed = 300.0
finish_feed = 150.0
retract = 0.1
"""
FACE = """
[[operation]]
type = "face"
z = 0.0
"""
THICK, MIDDLE, THIN = (
    f"""
[[operation]]
type = "cylinder"
z = [{{start}}, {end}]
diameter = {diameter}
"""
    for end, diameter in ((-3.0, 3.4), (-2.0, 2.6), (-1.0, 1.8))
)
THICK_FIRST = FACE + "".join(text.format(start=0.0) for text in (THICK, MIDDLE, THIN))
THIN_FIRST = FACE + THIN.format(start=0.0) + MIDDLE.format(start=-1.0) + THICK.format(start=-2.0)
NO_FACE = THICK.format(start=0.2) + THIN.format(start=0.2)
DEEPER_OVER_STEPS = (
    THICK.format(start=0.2)
    + MIDDLE.format(start=0.2).replace("2.6", "3.0")
    + THIN.format(start=0.2).replace("-1.0", "-3.6")
)
TWICE = THICK_FIRST + THICK.format(start=0.0) + FACE
HOLLOW_FACE = """
[[operation]]
type = "face"
z = -0.5
diameter = 1.0
"""


def cut(path: Path, text: str, seed: int, backlash_x: int, backlash_z: int) -> Bench:
    """Write, upload and cut a part; every step of its surface must then be right."""
    path.write_text(text, encoding="utf-8")
    bench = Bench(
        part=path,
        stock_diameter_mm=4.0,
        stock_length_mm=6.0,
        stock_allowance_mm=0.2,
        part_zero_x=-330,
        part_zero_z=-80,
        backlash_x=backlash_x,
        backlash_z=backlash_z,
        seed=seed,
    )
    bench.set(zero_x=-330, zero_z=-80, homing_repeats=1)
    bench.home()
    bench.host.upload(Part.load(path).image(bench.host.machine()))
    bench.host.run()
    bench.wait(lambda: bench.state is not State.RUNNING, 60.0, every=0.05)
    assert bench.status().finished
    assert_right(bench, path)
    return bench


def assert_right(bench: Bench, path: Path) -> None:
    """Compare every dimension, and the surface step by step."""
    report = bench.lathe.report()
    assert report["dimensions"]
    assert all(abs(entry["error_steps"]) < 1 for entry in report["dimensions"])
    assert (report["lost_steps"], report["crashes"], report["gouge_max_steps"]) == (0, [], 0)
    surface = read_part(path).surface()
    work = bench.lathe.workpiece
    assert {z: work.radius_at(z) for z in surface} == surface
    assert (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide) == bench.position == (-20, -20)


@pytest.mark.parametrize(
    ("backlash_x", "backlash_z", "seed"),
    [(0, 0, 1), (150, 0, 2), (0, 150, 3), (23, 31, 4), (1, 2, 5)],
)
@on_a_new_chip
def test_a_faced_pin_of_three_diameters_is_right_whatever_the_backlash(
    tmp_path: Path, backlash_x: int, backlash_z: int, seed: int
) -> None:
    text = HEAD.format(allowance=0.03) + THICK_FIRST
    cut(tmp_path / "pin.toml", text, seed, backlash_x, backlash_z)


@pytest.mark.parametrize(
    ("operations", "allowance"),
    [
        pytest.param(THICK_FIRST, 0.0, id="thick first"),
        pytest.param(THIN_FIRST, 0.03, id="thin first"),
        pytest.param(NO_FACE, 0.03, id="not faced"),
        pytest.param(DEEPER_OVER_STEPS, 0.03, id="one pass over earlier steps"),
        pytest.param(TWICE, 0.0, id="again what is already cut"),
        pytest.param(HOLLOW_FACE, 0.0, id="face that leaves a middle"),
    ],
)
@on_a_new_chip
def test_parts_are_right_in_every_order_of_operations(
    tmp_path: Path, operations: str, allowance: float
) -> None:
    cut(tmp_path / "pin.toml", HEAD.format(allowance=allowance) + operations, 6, 12, 9)


# -- how the tool moves ----------------------------------------------------------------------------


def run_little_pin(bench: Bench) -> Watch:
    """Cut the part stored on a homed bench and watch it."""
    watch = Watch(bench)
    bench.host.run()
    bench.wait_for(State.IDLE)
    return watch


ACCELERATION, START_RATE, RAPID_RATE = 8000, 400, 1000
#: How much slower than the ideal ramp a rapid may stay: it brakes in whole milliseconds.
RAMP_LOSS = 0.05


def expected_strokes() -> list[Stroke]:
    """The little pin behind the approach as firmware/lathe/passes.h describes it, written out."""
    clear = 60 + 5
    # The approach goes to the place of the face's only pass: 6 steps.
    face = [
        Stroke("X", -65, 400),
        Stroke("Z", 5, 400),  # through what the back edge of the tool has left
        Stroke("X", 65, RAPID_RATE),
    ]
    # 25 steps, 2 of them left for finishing: 23 in three passes of 8, 8 and 7.
    levels, passes = [clear, 52, 44, 37, 35], []
    for before, level in pairwise(levels):
        # To the last one the tool goes over everything that the operation has found.
        over = clear if before in (clear, 37) else before + 5
        up = {37: clear - 37, 35: 100 - 20 - 35}.get(level, 5)
        back = 60 - 20 + 40 if level == 35 else 45
        feed = 200 if level == 35 else 400
        passes += [
            Stroke("X", level - over, RAPID_RATE),
            Stroke("Z", -45, feed),
            Stroke("X", up, RAPID_RATE),
            Stroke("Z", back, RAPID_RATE),
        ]
    return [*face, *passes]


def assert_strokes_are_those_expected(watch: Watch, backlash: int = 0) -> None:
    """Compare every stroke: a cut at its very feed, a rapid as fast as its length allows.

    A rapid of n steps begins and ends with the start rate, or with the feed of the cut before or
    behind it if that is slower; so it can reach sqrt((begin^2 + end^2) / 2 + acceleration * n),
    if not the way up alone, sqrt(begin^2 + 2 * acceleration * n), is longer. The dead steps in
    front of it are steps in which it gains speed too.
    """
    found, expected = watch.strokes(), expected_strokes()
    assert [(s.axis, s.steps) for s in found] == [(s.axis, s.steps) for s in expected]
    stand = Stroke("", 0, START_RATE)
    for stroke, wanted, last, then in zip(
        found, expected, [stand, *expected], [*expected[1:], stand], strict=False
    ):
        if wanted.rate < RAPID_RATE:
            assert stroke == wanted
            continue
        begin, end = min(START_RATE, last.rate), min(START_RATE, then.rate)
        ways = [ACCELERATION * (abs(stroke.steps) + slack) for slack in (0, backlash)]
        least, most = (math.sqrt((begin**2 + end**2) / 2 + way) for way in ways)
        climbing, braking = (math.sqrt(rate**2 + 2 * ways[0]) for rate in (begin, end))
        least = min(RAPID_RATE, max(begin, min(least, climbing)))
        most = max(begin, min(RAPID_RATE, most, braking))
        change = ACCELERATION / 1000
        assert least * (1 - RAMP_LOSS) - change <= stroke.rate <= most + change, stroke


@on_a_new_chip
def test_the_first_approach_moves_both_slides_in_a_straight_line_with_ramps() -> None:
    bench = little_pin.homed_lathe_with_pin()
    watch = run_little_pin(bench)
    approach = watch.approach()
    end_x, end_z = 60 + 5, 0
    assert (approach[-1].x, approach[-1].z) == (end_x, end_z)
    start_x, start_z = 100 - 20, 60 - 20
    across, along = start_x - end_x, start_z - end_z
    whole = [m for m, then in pairwise(approach) if then.cycle - m.cycle >= SAME_STEP]
    for movement in whole:
        done = (start_z - movement.z) / along
        assert abs(start_x - done * across - movement.x) <= 0.5
    length = math.hypot(across, along)
    # Over so many steps of Z the slides come along whole steps of X.
    speeds = []
    for first, then in zip(whole, whole[8:], strict=False):
        way = math.hypot(then.x - first.x, then.z - first.z)
        speeds.append(way * CYCLES_PER_SECOND / (then.cycle - first.cycle))
    # The corner behind it is taken at no more than the start rate.
    peak = math.sqrt(START_RATE**2 + ACCELERATION * length)
    assert 0.9 * peak <= max(speeds) <= 1.02 * peak
    assert all(not movement.cut for movement in approach)


@pytest.mark.parametrize("backlash", [0, 12])
@on_a_new_chip
def test_each_pass_is_infeed_cut_retract_and_rapid_return(backlash: int) -> None:
    bench = little_pin.homed_lathe_with_pin(backlash_x=backlash, backlash_z=backlash)
    watch = run_little_pin(bench)
    assert_strokes_are_those_expected(watch, backlash)
    little_pin.assert_cut_exactly(bench)


@on_a_new_chip
def test_metal_is_only_cut_at_feed_and_never_deeper_than_the_depth_of_cut() -> None:
    bench = little_pin.homed_lathe_with_pin(backlash_x=12, backlash_z=7)
    watch = run_little_pin(bench)
    cutting = [movement for movement in watch.movements if movement.cut]
    assert {movement.axis for movement in cutting if movement.z > 0} <= {"X"}
    levels = sorted({movement.x for movement in cutting if movement.axis == "Z"}, reverse=True)
    assert levels == [52, 44, 37, 35]
    for first, then in pairwise(watch.movements):
        if first.cut and then.cut and first.axis == then.axis:
            feed = 200 if then.x == 35 and then.axis == "Z" else 400
            # A table read that the interrupt finds under way takes a cycle more.
            assert abs(then.cycle - first.cycle - CYCLES_PER_SECOND // feed) <= 1
    report = bench.lathe.report()
    assert report["crashes"] == []


@on_a_new_chip
def test_dead_steps_are_taken_up_in_front_of_the_work_and_never_while_cutting() -> None:
    bench = little_pin.homed_lathe_with_pin(backlash_x=12, backlash_z=7)
    watch = run_little_pin(bench)
    slack = watch.slack_steps()
    assert {entry.axis for entry in slack} == {"X", "Z"}
    towards_work = [entry for entry in slack if entry.direction < 0]
    assert len(towards_work) >= 4 * 12 + 4 * 7
    for entry in towards_work:
        place = watch.place_at(entry.cycle)
        assert place is None or place.clear, entry
    for first, then in pairwise(watch.movements):
        if first.cut and then.cut and first.axis == then.axis:
            assert not [entry for entry in slack if first.cycle < entry.cycle < then.cycle]


@on_a_new_chip
def test_an_operation_inside_what_is_already_cut_costs_no_pass() -> None:
    once = little_pin.homed_lathe_with_pin()
    operations = (*little_pin.OPERATIONS, little_pin.cylinder(-10, -30, 40), little_pin.face(3, 0))
    once.host.upload(little_pin.image("with-more", operations))
    watch = run_little_pin(once)
    assert_strokes_are_those_expected(watch)


@on_a_new_chip
def test_a_stock_as_thick_as_the_travel_allows_is_not_cut_on_the_way_to_park() -> None:
    radius = -little_pin.ZERO_X - 5
    thick = {"stock_diameter_mm": 2 * radius * little_pin.STEP_MM}
    bench = Bench(**(little_pin.OPTIONS | thick))
    bench.set(zero_x=little_pin.ZERO_X, zero_z=little_pin.ZERO_Z)
    bench.home()
    operations = (little_pin.face(0, 0, radius), little_pin.cylinder(0, -40, radius - 5))
    bench.host.upload(little_pin.image("thick", operations, stock_radius=radius))
    bench.host.run()
    bench.wait_for(State.IDLE)
    work = bench.lathe.workpiece
    assert {work.radius_at(z + 0.5) for z in range(-40, 0)} == {radius - 5}
    assert {work.radius_at(z + 0.5) for z in range(-90, -40)} == {radius}
    assert work.crashes == []
    assert bench.position == (0, -20)


@on_a_new_chip
def test_progress_grows_steadily_and_names_operation_and_pass() -> None:
    bench = little_pin.homed_lathe_with_pin()
    bench.host.run()
    seen = []
    while bench.is_in(State.RUNNING):
        bench.run(0.02)
        seen.append(bench.status())
    done = [status.permille for status in seen]
    assert done == sorted(done)
    assert done[-1] == 1000
    assert {s.operations for s in seen[:-1]} == {2}
    shown = [(s.operation, s.pass_number, s.passes) for s in seen[:-1] if s.operation]
    # While it is cut the next operation is being worked out already: 0 passes are not known.
    assert {(1, 1, 0)} <= set(shown) <= {(1, 1, 1), (1, 1, 0), *((2, n, 4) for n in range(1, 5))}
    assert {number for operation, number, _ in shown if operation == 2} == {1, 2, 3, 4}
    assert [s[:2] for s in shown] == sorted(s[:2] for s in shown)
