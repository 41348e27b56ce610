# SPDX-License-Identifier: Apache-2.0
"""What stands where: contours in whole steps, and what they leave of the stock.

These are the integer functions that the chip computes with, to the step: the rule BLOCKED and
all planning rest on them. z in steps, larger towards the free end; x is a radius in steps. `v`
is a radius too: the height at which somebody asks.
"""

from collections.abc import Iterable
from math import isqrt
from typing import NamedTuple

from tornillo.image import CENTRE_UNIT, Segment, SegmentKind, unpack_segments
from tornillo.protocol import CONTOUR_FACING, ContourRecord, PlungeRecord

#: In front of everything: where a contour that clears all in front of it begins.
FAR = 32767
#: Behind everything: how far the tool comes above the stock.
NOWHERE = -32768


class Sub(NamedTuple):
    """A piece of a contour that only rises or only falls: a line, or an arc split at its apex.

    (zs, xs) start, (ze, xe) end, zs >= ze. Arcs: (zc, xc) the centre rounded to whole steps,
    `square` the square of the radius about it.
    """

    kind: SegmentKind
    zs: int
    xs: int
    ze: int
    xe: int
    zc: int = 0
    xc: int = 0
    square: int = 0


class Stretch(NamedTuple):
    """A length of z at which a contour is not above some height; `start` > `end`.

    `contains` tells that it reaches to where the question was asked, or farther.
    """

    start: int
    end: int
    contains: bool


class Chain(NamedTuple):
    """A contour from the free end towards the chuck; `facing` ones clear all in front too."""

    facing: bool
    z: int
    x: int
    subs: tuple[Sub, ...]

    @property
    def z_end(self) -> int:
        """Where it ends."""
        return self.subs[-1].ze if self.subs else self.z

    @property
    def x_end(self) -> int:
        """The radius it ends with."""
        return self.subs[-1].xe if self.subs else self.x

    @property
    def lowest(self) -> int:
        """The smallest radius on it."""
        return min(self.x, *(sub.xe for sub in self.subs), self.x_end)

    @property
    def highest(self) -> int:
        """The largest radius on it."""
        return max(self.x, *(sub.xe for sub in self.subs), self.x_end)

    @property
    def simple(self) -> bool:
        """Whether it is one horizontal or vertical line, which passes alone can cut."""
        return len(self.subs) == 1 and (
            self.subs[0].kind is SegmentKind.LINE and (self.z == self.z_end or self.x == self.x_end)
        )


def rounded_centre(segment: Segment) -> tuple[int, int]:
    """(crz, crx): the centre of an arc from its start, in whole steps."""
    half = CENTRE_UNIT // 2
    return (segment.cz + half) // CENTRE_UNIT, (segment.cx + half) // CENTRE_UNIT


def pieces(z: int, x: int, segment: Segment) -> tuple[Sub, ...]:
    """`segment`, which starts at (z, x), as one or two pieces."""
    kind, ze, xe = segment.kind, z + segment.dz, x + segment.dx
    if kind is SegmentKind.LINE:
        return (Sub(kind, z, x, ze, xe),)
    crz, crx = rounded_centre(segment)
    zc, xc, square = z + crz, x + crx, crz * crz + crx * crx
    if not z > zc > ze:
        return (Sub(kind, z, x, ze, xe, zc, xc, square),)
    radius = isqrt(square)
    # Rounded, a top may come out a step too low.
    apex = xc + radius + 1 if kind is SegmentKind.CONVEX else xc - radius
    return (
        Sub(kind, z, x, zc, apex, zc, xc, square),
        Sub(kind, zc, apex, ze, xe, zc, xc, square),
    )


def chain_of(z: int, x: int, segments: Iterable[Segment], facing: bool = False) -> Chain:
    """The contour that starts at (z, x) and runs along `segments`."""
    subs: list[Sub] = []
    at_z, at_x = z, x
    for segment in segments:
        subs += pieces(at_z, at_x, segment)
        at_z, at_x = at_z + segment.dz, at_x + segment.dx
    return Chain(facing, z, x, tuple(subs))


def contour_chain(record: ContourRecord) -> Chain:
    """The contour in a record; raises ValueError when its segments cannot be read."""
    facing = bool(record.kind & CONTOUR_FACING)
    return chain_of(record.z, record.x, unpack_segments(record.segments), facing)


def plunge_chain(record: PlungeRecord, width: int) -> Chain:
    """What a tool of `width` steps leaves behind: one flat bottom."""
    front = record.z_high + width
    flat = Sub(SegmentKind.LINE, front, record.x, record.z_low, record.x)
    return Chain(False, front, record.x, (flat,))


def cross(sub: Sub, v: int) -> int:
    """The z at which `sub`, of which exactly one end is not above `v`, passes `v`.

    Never on the side where the contour is above `v`.
    """
    falling = sub.xs > sub.xe
    if sub.kind is SegmentKind.LINE:
        run, climb = sub.zs - sub.ze, abs(sub.xe - sub.xs)
        return sub.zs - (run * abs(v - sub.xs) + (climb - 1 if falling else 0)) // climb
    w = v - 1 - sub.xc
    h = isqrt(max(0, sub.square - w * w))
    z = sub.zc + h if sub.zs + sub.ze > 2 * sub.zc else sub.zc - h
    z += -2 if falling else 2
    return max(sub.ze, min(sub.zs, z))


def interval(chain: Chain, v: int, z_from: int) -> Stretch | None:
    """The first stretch of `chain` not above `v` that reaches behind `z_from`; None: no such.

    What lies in front of `z_from` is cut off.
    """
    low = chain.x <= v
    start = FAR if chain.facing else chain.z
    for sub in chain.subs:
        was, low = low, sub.xe <= v
        if was == low:
            continue
        z = cross(sub, v)
        if low:
            start = z
        elif min(start, z_from) > z:
            return Stretch(min(start, z_from), z, start >= z_from)
    if low and min(start, z_from) > chain.z_end:
        return Stretch(min(start, z_from), chain.z_end, start >= z_from)
    return None


class Material:
    """The stock and what has been cut from it so far."""

    def __init__(self, stock_radius: int, stock_front: int) -> None:
        """Raw stock with its front face at `stock_front`."""
        self.stock_radius = stock_radius
        self.stock_front = stock_front
        self.chains: list[Chain] = []

    def cut(self, chain: Chain) -> None:
        """Take away what stands above `chain`."""
        self.chains.append(chain)

    def free_end(self, v: int, z: int) -> int:
        """The first z not above `z` behind which something larger than `v` stands.

        NOWHERE when nothing larger is left at all.
        """
        if v >= self.stock_radius:
            return NOWHERE
        z = min(z, self.stock_front)
        changed = True
        while changed:
            changed = False
            for chain in self.chains:
                found = interval(chain, v, z)
                if found is not None and found.contains:
                    z, changed = found.end, True
        return z

    def highest(self, z_high: int, z_low: int, below: int = 0) -> int:
        """The largest radius that stands between `z_high` and `z_low`, at least -`below`."""
        low, high = -below, self.stock_radius
        while low < high:
            middle = (low + high) >> 1
            if self.free_end(middle, z_high) <= z_low:
                high = middle
            else:
                low = middle + 1
        return low
