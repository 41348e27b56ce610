# SPDX-License-Identifier: Apache-2.0
"""What every plan must keep, on random parts cut from a simulated bar."""

import math
from collections.abc import Callable, Iterable
from functools import cache

import pytest
from planned import random_part
from turned_stock import TurnedStock, halves, height

from tornillo.image import PartImage, unpack_segments
from tornillo.machine import Machine
from tornillo.material import Stretch, contour_chain
from tornillo.moves import Halt, Move, Pass, Role, Stop
from tornillo.planning import plan_part, pockets, spread
from tornillo.protocol import CONTOUR_FACING, ContourRecord, CutRecord, PlungeRecord, ToolRecord

SEEDS = range(100)
#: The tool may be so far off a curve whose centre the chip rounds to whole steps.
ROUNDING = 1.5
BEHIND = 600


def contour_moves(record: ContourRecord) -> list[Move]:
    """A contour as moves."""
    moves: list[Move] = []
    at = record.z, record.x
    for kind, dz, dx, cz, cx in unpack_segments(record.segments):
        end = at[0] + dz, at[1] + dx
        moves.append(Move(at, end, 1, kind, cz, cx))
        at = end
    return moves


@cache
def shape(record: ContourRecord) -> dict[float, float]:
    """The smallest radius of a contour at every half z it passes."""
    found: dict[float, float] = {}
    for move in contour_moves(record):
        for z in halves(move):
            found[z] = min(found.get(z, math.inf), height(move, z))
    return found


def contours(image: PartImage) -> dict[int, ContourRecord]:
    """The contours of a part by the number of their operation."""
    return {
        number: operation
        for number, operation in enumerate(image.operations, start=1)
        if isinstance(operation, ContourRecord)
    }


def bar(image: PartImage) -> TurnedStock:
    """The raw stock of a part, with room behind it."""
    header = image.header
    return TurnedStock(header.stock_radius, header.stock_front, -BEHIND)


def cut_all(image: PartImage, after: Callable[[Pass, float], None]) -> TurnedStock:
    """Cut a part; `after` is told of each pass how deep it was. No rapid meets material."""
    stock = bar(image)
    known = contours(image)
    for step in plan_part(image, Machine.load()).steps:
        facing = step.operation in known and bool(known[step.operation].kind & CONTOUR_FACING)
        depths = [stock.make(move, facing) for move in step.moves]
        if isinstance(step, Stop) and step.halt is Halt.TOOL:
            stock.width = tools(image)[1].width
        if isinstance(step, Pass):
            after(step, max(depths))
    return stock


def tools(image: PartImage) -> list[ToolRecord]:
    """The tools of a part."""
    return [record for record in image.records if isinstance(record, ToolRecord)]


def depth_of(image: PartImage) -> int:
    """The depth of cut of a part with one CUT record."""
    return next(r.depth_of_cut for r in image.records if isinstance(r, CutRecord))


@pytest.mark.parametrize("seed", SEEDS)
def test_no_rapid_meets_material_and_no_pass_is_too_deep(seed: int) -> None:
    image = random_part(seed)
    deepest = depth_of(image)

    def judge(stroke: Pass, depth: float) -> None:
        if stroke.role in (Role.ROUGHING, Role.FACING):
            assert depth <= deepest + ROUNDING, stroke
            assert stroke.depth <= deepest

    cut_all(image, judge)


def leaves(image: PartImage, record: ContourRecord | PlungeRecord, z: float) -> float:
    """The radius that an operation leaves at a half z, at most."""
    if isinstance(record, PlungeRecord):
        front = record.z_high + tools(image)[1].width
        return record.x if record.z_low < z < front else math.inf
    if record.kind & CONTOUR_FACING and z > record.z:
        return record.x
    return shape(record).get(z, math.inf)


@pytest.mark.parametrize("seed", SEEDS)
def test_everything_outside_the_contours_is_removed_and_nothing_else(seed: int) -> None:
    image = random_part(seed)
    left = cut_all(image, lambda _stroke, _depth: None)
    header = image.header
    shapes = [r for r in image.operations if isinstance(r, ContourRecord | PlungeRecord)]
    for place in range(-400, header.stock_front):
        z = place + 0.5
        wanted = min(header.stock_radius, *(leaves(image, record, z) for record in shapes))
        assert left.radius(z) == pytest.approx(wanted, abs=ROUNDING), z


@pytest.mark.parametrize("seed", SEEDS)
def test_roughing_leaves_the_contour_and_its_allowance(seed: int) -> None:
    image = random_part(seed)
    known = contours(image)
    stock = bar(image)
    for stroke in plan_part(image, Machine.load()).passes:
        if stroke.operation not in known:
            continue
        record = known[stroke.operation]
        facing = bool(record.kind & CONTOUR_FACING)
        before = list(stock.left)
        for move in stroke.moves:
            stock.make(move, facing)
        if stroke.role in (Role.ROUGHING, Role.FACING):
            for z, x in shape(record).items():
                index = math.floor(z) + BEHIND
                if index < len(before):
                    assert stock.left[index] >= min(before[index], x) - ROUNDING, (stroke, z)


def nested(found: Iterable[tuple[int, Stretch]]) -> None:
    """Check that stretches come pocket by pocket, from the front, the highest level first."""
    above: list[Stretch] = []
    before: dict[int, int] = {}
    for number, stretch in found:
        assert number <= len(above) + 1
        del above[number - 1 :]
        for level in [level for level in before if level > number]:
            del before[level]
        if above:
            assert above[-1].start >= stretch.start > stretch.end >= above[-1].end
        if number in before:
            assert stretch.start <= before[number]
        before[number] = stretch.end
        above.append(stretch)


@pytest.mark.parametrize("seed", SEEDS)
def test_pockets_are_cut_one_by_one_each_level_from_the_one_above(seed: int) -> None:
    image = random_part(seed)
    for record in contours(image).values():
        chain = contour_chain(record)
        if chain.facing:
            continue
        top = image.header.stock_radius
        radii = [top, *spread(top, chain.lowest, depth_of(image))]
        found = list(pockets(chain, radii))
        nested(found)
        # And none is forgotten: at each level every place of the contour below it.
        for number, radius in enumerate(radii[1:], start=1):
            covered = sum(s.start - s.end for level, s in found if level == number)
            most = sum(1 for x in shape(record).values() if x <= radius + ROUNDING)
            least = sum(1 for x in shape(record).values() if x <= radius - ROUNDING)
            assert least - 4 * len(chain.subs) <= covered <= most


@pytest.mark.parametrize("seed", range(40))
def test_no_roughing_pass_is_a_sliver(seed: int) -> None:
    image = random_part(seed)
    for number in contours(image):
        depths = {
            stroke.depth
            for stroke in plan_part(image, Machine.load()).passes
            if stroke.operation == number and stroke.role in (Role.ROUGHING, Role.FACING)
        }
        assert not depths or max(depths) - min(depths) <= 1


def test_a_part_ends_parked() -> None:
    last = plan_part(random_part(1), Machine.load()).steps[-1]
    assert isinstance(last, Stop)
    assert not last.text
