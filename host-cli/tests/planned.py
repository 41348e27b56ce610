# SPDX-License-Identifier: Apache-2.0
"""Parts in steps for the tests of planning: headers, tools, contours, random ones too."""

import math
import random

from tornillo.image import PartImage, Record, Segment, SegmentKind, pack_segments
from tornillo.protocol import (
    CONTOUR_FACING,
    FEED_UNIT,
    IMAGE_FORMAT,
    SLOPE_ANY,
    ContourRecord,
    CutRecord,
    ImageHeader,
    PauseRecord,
    PlungeRecord,
    ToolRecord,
)

FEED, FINISH_FEED = 100 * FEED_UNIT, 50 * FEED_UNIT
RETRACT = 5
#: A tool that can go anywhere.
POINT = ToolRecord(0, b"point", 0, 0, 0, SLOPE_ANY, SLOPE_ANY, 0, 0)


def cut(depth: int, allowance: int = 0, spring: int = 0, peck: int = 0) -> CutRecord:
    """Cutting data."""
    return CutRecord(spring, depth, allowance, FEED, FINISH_FEED, 0, peck)


def part(
    *records: Record, radius: int = 100, length: int = 500, front: int = 0, retract: int = RETRACT
) -> PartImage:
    """A part with these records."""
    count = sum(
        isinstance(record, ContourRecord | PlungeRecord | PauseRecord) for record in records
    )
    header = ImageHeader(
        IMAGE_FORMAT, count, 0, 0, b"part", 7112, 7112, radius, length, front, retract
    )
    return PartImage(header, records)


def contour(z: int, x: int, *segments: Segment, facing: bool = False) -> ContourRecord:
    """A contour from (z, x)."""
    return ContourRecord(4 | CONTOUR_FACING * facing, z, x, pack_segments(segments))


def line(dz: int, dx: int) -> Segment:
    """A line."""
    return Segment(SegmentKind.LINE, dz, dx)


def arc(dz: int, dx: int, radius: float, convex: bool) -> Segment | None:
    """The arc of a radius; None when it would run back somewhere."""
    chord = math.hypot(dz, dx)
    if dz >= 0 or radius < max(2.0, chord / 2):
        return None
    height = math.sqrt(radius * radius - chord * chord / 4)
    side = 1 if convex else -1
    # (-dx, dz) / chord is to the left of the way towards the chuck, which is the axis' side.
    cz = dz / 2 - side * height * dx / chord
    cx = dx / 2 + side * height * dz / chord
    ends = (-cx, dx - cx)
    if any(side * end < 0 for end in ends):
        return None
    kind = SegmentKind.CONVEX if convex else SegmentKind.CONCAVE
    return Segment(kind, dz, dx, round(cz * 256), round(cx * 256))


def face(z: int, inner: int, radius: int) -> ContourRecord:
    """A face as the host writes it."""
    return ContourRecord(CONTOUR_FACING, z, inner, pack_segments((line(0, radius - inner),)))


def cylinder(z: int, end: int, x: int) -> ContourRecord:
    """A cylinder as the host writes it."""
    return ContourRecord(1, z, x, pack_segments((line(end - z, 0),)))


def random_segments(
    dice: random.Random, x: int, low: int, high: int, falling: bool
) -> list[Segment]:
    """Lines, shoulders and arcs between two radii."""
    found: list[Segment] = []
    for _ in range(dice.randint(1, 7)):
        floor = low if falling else x
        target = dice.choice((x, dice.randint(floor, high), dice.randint(floor, high)))
        dz, dx = -dice.randint(1, 60), target - x
        if dx and dice.random() < 0.2:
            dz = 0
        segment: Segment | None = line(dz, dx)
        if dz and dice.random() < 0.5:
            radius = math.hypot(dz, dx) / 2 * dice.uniform(1.0, 3.0)
            segment = arc(dz, dx, radius, dice.random() < 0.5) or segment
        if segment is not None and inside(segment, x, low, high) and (falling or rises(segment)):
            found.append(segment)
            x += segment.dx
    # A contour that ends in a fall leaves the tool in a notch of no width.
    return [*found, line(-dice.randint(1, 20), 0)]


def inside(segment: Segment, x: int, low: int, high: int) -> bool:
    """Whether an arc's apex stays between two radii, and its circle where the chip can count."""
    if segment.kind is SegmentKind.LINE:
        return True
    radius = math.hypot(segment.cz, segment.cx) / 256
    at = x + segment.cx / 256
    passes_apex = segment.dz < segment.cz / 256 < 0
    apex = at + radius if segment.kind is SegmentKind.CONVEX else at - radius
    return not passes_apex or low <= apex <= high


def rises(segment: Segment) -> bool:
    """Whether a segment never comes nearer to the axis on its way."""
    if segment.kind is SegmentKind.LINE:
        return segment.dx >= 0
    if segment.kind is SegmentKind.CONVEX:
        return segment.dx >= 0 and segment.cz / 256 <= segment.dz
    return segment.dx >= 0 and segment.cz >= 0


def random_part(seed: int) -> PartImage:
    """One to three operations of any shape with a tool that can go anywhere."""
    dice = random.Random(seed)
    radius, front = dice.randint(60, 160), dice.choice((0, 0, 8, 20))
    depth = dice.randint(5, 30)
    records: list[Record] = [POINT, cut(depth, dice.choice((0, 0, dice.randint(1, depth))))]
    for _ in range(dice.randint(1, 3)):
        facing = dice.random() < 0.25
        x = dice.randint(0, radius)
        z = dice.choice((0, 0, front, -dice.randint(0, 100)))
        if dice.random() < 0.2:
            records.append(face(-dice.randint(0, 10), dice.randint(0, radius - 1), radius))
            continue
        segments = random_segments(dice, x, 0, radius, falling=not facing)
        records.append(contour(z, x, *segments, facing=facing))
    if dice.random() < 0.3:
        width, x = dice.randint(3, 20), dice.randint(0, radius - 1)
        z = -dice.randint(width, 100)
        groove = PlungeRecord(0, z, z - dice.randint(0, 40), x)
        records += [POINT._replace(kind=1, width=width), cut(depth, peck=dice.choice((0, 7)))]
        records.append(groove)
    return part(*records, radius=radius, front=front, retract=dice.randint(1, 12))
