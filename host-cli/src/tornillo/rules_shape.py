# SPDX-License-Identifier: Apache-2.0
"""The rules of contours and plunges, as the chip applies them and in its order."""

from collections.abc import Iterator
from math import atan, degrees, isqrt
from typing import NamedTuple

from tornillo.image import CENTRE_UNIT, Segment, SegmentKind, unpack_segments
from tornillo.language import _
from tornillo.material import (
    Chain,
    Material,
    Sub,
    chain_of,
    pieces,
    plunge_chain,
    rounded_centre,
)
from tornillo.protocol import (
    CONTOUR_FACING,
    CONTOUR_KIND,
    RADIUS_MAX,
    SLOPE_ANY,
    SLOPE_UNIT,
    ContourRecord,
    ImageHeader,
    PlungeRecord,
    Refusal,
    ToolRecord,
)
from tornillo.units import Scale

CONTOUR_KIND_MAX = 4
PLUNGE_KIND_MAX = 1
NEAR_STEPS = 2
SMALLEST_RADIUS = 504  # 2 steps, less what rounding takes, in 1/256 step


class Found(NamedTuple):
    """A broken rule of one record: what it is about, and the numbers in words."""

    refusal: Refusal
    key: str
    detail: str


class Ground(NamedTuple):
    """What a cut is judged by: the part, the machine, the tool and what still stands."""

    header: ImageHeader
    scale: Scale
    tool: ToolRecord
    material: Material

    @property
    def nearest(self) -> int:
        """The smallest z: one retract in front of the chuck."""
        return self.header.retract - self.header.stock_length

    @property
    def foremost(self) -> int:
        """The largest z: one retract in front of the raw face."""
        return self.header.stock_front + self.header.retract

    def outside(self, z: int, x: int, at: str) -> Iterator[Found]:
        """The rules of a place; `at` names it."""
        header, scale = self.header, self.scale
        if x < -self.tool.below or x > header.stock_radius:
            limit = scale.show_diameter(header.stock_radius)
            detail = _("{x}, the stock has {limit}").format(x=scale.show_diameter(x), limit=limit)
            yield Found(Refusal.OUTSIDE_STOCK, f"{at}.x", detail)
        if z < self.nearest:
            detail = _("{z}, one retract in front of the chuck is {nearest}").format(
                z=scale.show_z(z), nearest=scale.show_z(self.nearest)
            )
            yield Found(Refusal.OUTSIDE_STOCK, f"{at}.z", detail)
        machine = scale.machine
        least_x = -machine.travel_x - machine.zero_x - self.tool.offset_x
        least_z = -machine.travel_z - machine.zero_z - self.tool.offset_z
        if x < least_x:
            detail = _("{x}, the slide ends at {least_x}").format(
                x=scale.show_diameter(x), least_x=scale.show_diameter(least_x)
            )
            yield Found(Refusal.OUTSIDE_TRAVEL, f"{at}.x", detail)
        if z < least_z:
            detail = _("{z}, the slide ends at {least_z}").format(
                z=scale.show_z(z), least_z=scale.show_z(least_z)
            )
            yield Found(Refusal.OUTSIDE_TRAVEL, f"{at}.z", detail)

    def in_front(self, z: int, at: str) -> Iterator[Found]:
        """The rule of places in front of the part."""
        if z > self.foremost:
            scale = self.scale
            detail = _("{z}, one retract in front of the stock is {foremost}").format(
                z=scale.show_z(z), foremost=scale.show_z(self.foremost)
            )
            yield Found(Refusal.OUTSIDE_STOCK, f"{at}.z", detail)


def contour_rules(record: ContourRecord, ground: Ground) -> Iterator[Found]:
    """The first rule that a contour breaks; a good one is cut from the material of `ground`."""
    segments: list[Segment] = []
    for found in _contour_rules(record, ground, segments):
        yield found
        return
    facing = bool(record.kind & CONTOUR_FACING)
    ground.material.cut(chain_of(record.z, record.x, segments, facing))


def _contour_rules(
    record: ContourRecord, ground: Ground, segments: list[Segment]
) -> Iterator[Found]:
    """The rules of a contour in order; only the first one means something.

    Fills `segments` with those of the record.
    """
    kind, known = record.kind & CONTOUR_KIND, CONTOUR_KIND | CONTOUR_FACING
    if kind > CONTOUR_KIND_MAX or record.kind & ~known:
        yield Found(Refusal.FORMAT, "", _("kind {kind}").format(kind=record.kind))
    if ground.tool.width:
        yield Found(Refusal.TOOL, "tool", _("a tool with a width cuts grooves only"))
    yield from _start_rules(record, ground)
    facing = bool(record.kind & CONTOUR_FACING)
    z, x = record.z, record.x
    try:
        for segment in unpack_segments(record.segments):
            yield from _segment_rules(z, x, segment, facing, ground)
            z, x = z + segment.dz, x + segment.dx
            segments.append(segment)
    except ValueError as error:
        yield Found(Refusal.OPERATION_SIZE, "", str(error))
    if not segments:
        yield Found(Refusal.OPERATION_SIZE, "", _("no segment"))
    yield from _chain_rules(chain_of(record.z, record.x, segments, facing), ground)


def _start_rules(record: ContourRecord, ground: Ground) -> Iterator[Found]:
    """The start of a contour, all of OUTSIDE_STOCK before OUTSIDE_TRAVEL."""
    found = [*ground.in_front(record.z, "start"), *ground.outside(record.z, record.x, "start")]
    yield from _in_order(found)


def _in_order(found: list[Found]) -> list[Found]:
    """What lies outside the stock before what lies outside the travel."""
    return sorted(found, key=lambda one: one.refusal is Refusal.OUTSIDE_TRAVEL)


def _segment_rules(
    z: int, x: int, segment: Segment, facing: bool, ground: Ground
) -> Iterator[Found]:
    """The rules of one segment that starts at (z, x)."""
    scale = ground.scale
    here = f"{scale.show_z(z)}, {scale.show_diameter(x)}"
    if segment.dz > 0 or (facing and segment.dx < 0):
        way = _("z grows") if segment.dz > 0 else _("the diameter gets smaller")
        yield Found(Refusal.DIRECTION, "end.z", _("{way} behind {here}").format(way=way, here=here))
    if segment.dz == 0 and segment.dx == 0:
        yield Found(
            Refusal.EMPTY_CUT, "end.z", _("a piece without length at {here}").format(here=here)
        )
    yield from _in_order([*ground.outside(z + segment.dz, x + segment.dx, "end")])
    subs = pieces(z, x, segment)
    if segment.kind is not SegmentKind.LINE:
        if not arc_exists(segment):
            yield Found(Refusal.ARC, "end.x", _("from {here}").format(here=here))
        if len(subs) > 1 and facing:
            yield Found(
                Refusal.DIRECTION,
                "end.z",
                _("the diameter gets smaller behind {here}").format(here=here),
            )
        if len(subs) > 1:
            apex = subs[0].xe - (segment.kind is SegmentKind.CONVEX)
            yield from _in_order([*ground.outside(subs[0].ze, apex, "end")])
    yield from _edge_rules(segment, subs, ground)


def arc_exists(segment: Segment) -> bool:
    """Whether an arc leads from its start to its end in whole steps, without running back."""
    crz, crx = rounded_centre(segment)
    radius = isqrt(crz * crz + crx * crx)
    ez, ex = segment.dz - crz, segment.dx - crx
    if radius > RADIUS_MAX or abs(isqrt(ez * ez + ex * ex) - radius) > NEAR_STEPS:
        return False
    if segment.kind is SegmentKind.CONVEX:
        return crx <= 0 <= ex and _drivable(segment)
    return ex <= 0 <= crx and _drivable(segment)


def _drivable(segment: Segment) -> bool:
    """Whether the motion takes the arc: see arc_begin() in firmware/motion/arc.c.

    Numbers are scaled down until those from the centre to the start fit 16 bits.
    """
    m, p = -segment.cz, -segment.cx
    along = segment.dz * (2 * m + CENTRE_UNIT * segment.dz)
    across = segment.dx * (2 * p + CENTRE_UNIT * segment.dx)
    scale = max(0, max(abs(m), abs(p)).bit_length() - 16)
    half_squares = sum((abs(value) >> scale) ** 2 >> 1 for value in (m, p))
    radius = isqrt(half_squares) * 181 >> 7
    missed = abs(along + across) // 2 >> scale
    return missed <= radius and (scale > 0 or radius >= SMALLEST_RADIUS)


def slopes(segment: Segment) -> Iterator[tuple[bool, int, int]]:
    """(falling, climb, run) of the steepest places of a segment, climb not negative."""
    if segment.kind is SegmentKind.LINE:
        if segment.dx:
            yield segment.dx < 0, abs(segment.dx), -segment.dz
        return
    crz, crx = rounded_centre(segment)
    convex = segment.kind is SegmentKind.CONVEX
    for ez, ex in ((-crz, -crx), (segment.dz - crz, segment.dx - crx)):
        if ez:
            yield (ez < 0) is convex, abs(ez), abs(ex)


def _edge_rules(segment: Segment, subs: tuple[Sub, ...], ground: Ground) -> Iterator[Found]:
    """Where the edges of the tool would cut into the work."""
    tool, scale = ground.tool, ground.scale
    for falling, climb, run in slopes(segment):
        limit = tool.back if falling else tool.front
        if limit == SLOPE_ANY or climb * SLOPE_UNIT <= limit * run:
            continue
        angle = degrees(atan(climb / run)) if run else 90.0
        follows = degrees(atan(limit / SLOPE_UNIT))
        way = _("falls") if falling else _("rises")
        yield Found(
            Refusal.BACK_EDGE if falling else Refusal.FRONT_EDGE,
            "end.x",
            _(
                "between {zs} and {ze} the contour {way} with {angle:.1f} degrees, the "
                "tool follows {follows:.1f}"
            ).format(
                zs=scale.show_z(subs[0].zs),
                ze=scale.show_z(subs[-1].ze),
                way=way,
                angle=angle,
                follows=follows,
            ),
        )


def _chain_rules(chain: Chain, ground: Ground) -> Iterator[Found]:
    """The rules of a contour as a whole."""
    header, scale = ground.header, ground.scale
    if chain.facing:
        if chain.z_end >= header.stock_front:
            front = scale.show_z(header.stock_front)
            detail = _("{z_end}, the stock begins at {front}").format(
                z_end=scale.show_z(chain.z_end), front=front
            )
            yield Found(Refusal.EMPTY_CUT, "end.z", detail)
        return
    if chain.z_end == chain.z:
        detail = _("it starts and ends at {z}").format(z=scale.show_z(chain.z))
        yield Found(Refusal.EMPTY_CUT, "end.z", detail)
    if chain.lowest >= header.stock_radius:
        detail = _("{lowest} is that of the stock").format(lowest=scale.show_diameter(chain.lowest))
        yield Found(Refusal.EMPTY_CUT, "end.x", detail)
    if ground.tool.back != SLOPE_ANY and (ground.material.free_end(chain.x, chain.z + 1) > chain.z):
        detail = _("starts at {z}, and in front of it something larger than {x} stands").format(
            z=scale.show_z(chain.z), x=scale.show_diameter(chain.x)
        )
        yield Found(Refusal.BLOCKED, "start.z", detail)


def plunge_rules(record: PlungeRecord, ground: Ground) -> Iterator[Found]:
    """The first rule that a plunge breaks; a good one is cut from the material of `ground`."""
    for found in _plunge_rules(record, ground):
        yield found
        return
    ground.material.cut(plunge_chain(record, ground.tool.width))


def _plunge_rules(record: PlungeRecord, ground: Ground) -> Iterator[Found]:
    """All rules of a plunge, in the chip's order."""
    scale = ground.scale
    if not 0 <= record.kind <= PLUNGE_KIND_MAX:
        yield Found(Refusal.FORMAT, "", _("kind {kind}").format(kind=record.kind))
    if not ground.tool.width:
        yield Found(Refusal.TOOL, "tool", _("a tool without a width cannot cut straight in"))
    yield from _in_order(
        [
            *ground.in_front(record.z_high + ground.tool.width, "start"),
            *ground.outside(record.z_low, record.x, "end"),
        ]
    )
    if record.z_low > record.z_high:
        room = scale.show(scale.length(record.z_high - record.z_low))
        yield Found(
            Refusal.EMPTY_CUT, "end.z", _("narrower than the tool by {room}").format(room=room)
        )
    if record.x >= ground.header.stock_radius:
        yield Found(
            Refusal.EMPTY_CUT,
            "end.x",
            _("{x} is not smaller").format(x=scale.show_diameter(record.x)),
        )
