# SPDX-License-Identifier: Apache-2.0
"""A chain of the drawing as a profile: z and radius from the free end to the chuck.

Lengths are in the units of the part file, z = 0 at the free end, smaller towards the chuck.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from tornillo.dxf.curves import Point, Segment
from tornillo.dxf.options import Tool, View
from tornillo.dxf.paper import Paper, number
from tornillo.dxf.section import LOWER, Half
from tornillo.errors import DrawingError
from tornillo.language import _

RIGHT, LEFT = "right", "left"
SLACK_DEGREES = 0.05
SHARE = 1e-6
EXACT = 1e-9
SQUARE = 0.01
CHORD_SHARE = 0.5
QUARTER = 90.0


@dataclass(frozen=True)
class Contour:
    """The profile; `face` is where the flat front ends towards the axis, None without one.

    `steepest_fall` is in degrees down from the Z axis.
    """

    segments: tuple[Segment, ...]
    face: float | None
    steepest_fall: float
    remarks: tuple[str, ...]

    @property
    def length(self) -> float:
        """From z = 0 to the end at the chuck."""
        return -self.segments[-1].end[0]

    @property
    def largest_diameter(self) -> float:
        """Over the whole profile."""
        radii = [segment.end[1] for segment in self.segments] + [self.segments[0].start[1]]
        for segment in self.segments:
            if segment.center:
                turn = segment.cut(segment.along(segment.center[0]))
                radii += [piece.end[1] for piece in turn]
        return 2 * max(radii)


def profile(chain: list[Segment], half: Half, view: View, paper: Paper, tool: Tool) -> Contour:
    """The profile that `chain` draws.

    Raises DrawingError when a tool from this side cannot turn it.
    """
    remarks = []
    if chain[0].start == chain[-1].end:
        chain = _outside(chain, half, paper)
        remarks.append(_("the outer side of the closed figure is turned, not its bore"))
    free_end = view.free_end if view.free_end != "auto" else _free_end(chain, half, paper)
    if view.mirror:
        free_end = LEFT if free_end == RIGHT else RIGHT
    ends = (chain[0].start[0], chain[-1].end[0])
    every = [place[0] for segment in chain for place in (segment.start, segment.end)]
    front = max(every) if free_end == RIGHT else min(every)
    if view.front is not None:
        front = view.front
    sign = 1 if free_end == RIGHT else -1

    side = -1 if half.side == LOWER else 1

    def to_part(place: Point) -> Point:
        along, across = sign * (place[0] - front), side * (place[1] - half.axis)
        return along * paper.factor, across * paper.factor

    def to_drawing(place: Point) -> Point:
        along, across = place[0] / paper.factor, place[1] / paper.factor
        return front + sign * along, half.axis + side * across

    if sign * ends[0] < sign * ends[1]:
        chain = [segment.reversed() for segment in reversed(chain)]
    remarks.append(
        _("the free end is the {free_end} one, z = 0 at {front}").format(
            free_end=free_end, front=paper.show_along(front)
        )
    )
    pieces = [segment.mapped(to_part, sign * side < 0) for segment in chain]
    place = Place(paper, to_drawing)
    return _finished(pieces, view, tool, place, remarks)


@dataclass(frozen=True)
class Place:
    """Names places of the part as places of the drawing."""

    paper: Paper
    to_drawing: Callable[[Point], Point]

    @property
    def tolerance(self) -> float:
        """Of the part."""
        return self.paper.tolerance * self.paper.factor

    def refusal(
        self, segment: Segment, at: Point, what: str, mark: str, remedy: str
    ) -> DrawingError:
        """The refusal of `segment` at a place of the part."""
        drawn = self.to_drawing(at)
        return DrawingError(
            _("{file}: {what}: {origin}, at {drawn} (z {at}, diameter {number} {units})").format(
                file=self.paper.file,
                what=what,
                origin=segment.origin,
                drawn=self.paper.show(drawn),
                at=number(at[0]),
                number=number(2 * at[1]),
                units=self.paper.units,
            ),
            remedy,
            (self.paper.mark(drawn, mark),),
        )


def _finished(
    pieces: list[Segment], view: View, tool: Tool, place: Place, remarks: list[str]
) -> Contour:
    """Strip the faces, check that the tool can do it, and tidy up."""
    if view.length is not None:
        pieces = _shortened(pieces, view.length, place)
        remarks.append(
            _("only the first {length} {units} are turned").format(
                length=number(view.length), units=place.paper.units
            )
        )
    pieces = _monotone(pieces, place)
    pieces, face = _without_front(pieces, place.tolerance)
    pieces, back = _without_back(pieces, place.tolerance)
    if back:
        remarks.append(_("the flat back face is left to parting off"))
    if not pieces:
        file = place.paper.file
        raise DrawingError(
            _("{file}: only flat faces are drawn, nothing to turn along the spindle").format(
                file=file
            ),
            _("check --spindle: the spindle runs along the drawing's x, or y when said so"),
        )
    fall = _check_slopes(pieces, tool, place)
    tidy = [
        piece
        for segment in _merged(pieces)
        for half in _clear(segment)
        for piece in _representable(half, place)
    ]
    return Contour(tuple(tidy), face, fall, tuple(remarks))


def _outside(chain: list[Segment], half: Half, paper: Paper) -> list[Segment]:
    """The side of a closed figure that faces away from the axis, between its two ends."""
    corners = [segment.start for segment in chain]

    def corner(end: float) -> int:
        at_end = [
            (abs(place[1] - half.axis), index)
            for index, place in enumerate(corners)
            if abs(place[0] - end) <= paper.snap
        ]
        return max(at_end)[1]

    first = corner(max(place[0] for place in corners))
    last = corner(min(place[0] for place in corners))
    turned = chain[first:] + chain[:first]
    count = (last - first) % len(chain)
    one, other = turned[:count], turned[count:]

    def height(side: list[Segment]) -> float:
        length = sum(piece.length for piece in side)
        heights = (piece.length * abs(piece.point(0.5)[1] - half.axis) for piece in side)
        return sum(heights) / length

    return one if height(one) > height(other) else other


def _free_end(chain: list[Segment], half: Half, paper: Paper) -> str:
    """The end with the smaller diameter behind its face; the right one when they are equal."""
    ends = []
    for first, other in ((chain[0].start, chain[0]), (chain[-1].end, chain[-1])):
        far = other.end if first == other.start else other.start
        upright = other.center is None and abs(far[0] - first[0]) <= paper.snap
        rim = max(first, far, key=lambda place: abs(place[1] - half.axis)) if upright else first
        ends.append((first[0], abs(rim[1] - half.axis)))
    (x0, r0), (x1, r1) = sorted(ends)
    return LEFT if r0 < r1 - paper.snap and x0 < x1 else RIGHT


def _shortened(pieces: list[Segment], length: float, place: Place) -> list[Segment]:
    """The part of the chain in front of z = -length."""
    kept: list[Segment] = []
    for segment in pieces:
        for piece in segment.cut(segment.along(-length)):
            if piece.point(0.5)[0] < -length:
                return kept or [piece]
            kept.append(piece)
    raise DrawingError(
        _(
            "{file}: the outline ends at z {end} {units}, before the wanted length of {length}"
        ).format(
            file=place.paper.file,
            end=number(pieces[-1].end[0]),
            units=place.paper.units,
            length=number(length),
        ),
        _("leave --length out, or give a smaller one"),
    )


def _monotone(pieces: list[Segment], place: Place) -> list[Segment]:
    """The chain with z that never grows; refused where it runs back by more than the tolerance."""
    level = pieces[0].start[0]
    result = []
    for segment in pieces:
        if segment.end[0] > level + place.tolerance:
            raise place.refusal(
                segment,
                segment.start,
                _(
                    "the outline runs back towards the free end, where no tool from this side "
                    "reaches"
                ),
                "overhang",
                _(
                    "turn the part round with --free-end, stop in front of it with --length, "
                    "or cut it in two set-ups"
                ),
            )
        start = min(level, segment.start[0]), segment.start[1]
        level = min(level, segment.end[0])
        result.append(segment.moved(start, (level, segment.end[1])))
    return result


def _without_front(pieces: list[Segment], tolerance: float) -> tuple[list[Segment], float | None]:
    """The chain behind its flat front, and the inner diameter of that front."""
    count = 0
    while count < len(pieces) and _is_face(pieces[count], tolerance) and _rises(pieces[count]):
        count += 1
    return pieces[count:], 2 * pieces[0].start[1] if count else None


def _without_back(pieces: list[Segment], tolerance: float) -> tuple[list[Segment], bool]:
    """The chain without the flat back face at its end."""
    count = len(pieces)
    while count and _is_face(pieces[count - 1], tolerance) and not _rises(pieces[count - 1]):
        count -= 1
    return pieces[:count], count < len(pieces)


def _is_face(segment: Segment, tolerance: float) -> bool:
    """Whether a segment is square to the axis."""
    run, rise = (abs(segment.start[axis] - segment.end[axis]) for axis in (0, 1))
    return segment.center is None and run <= min(tolerance, rise * SQUARE)


def _rises(segment: Segment) -> bool:
    """Whether it ends farther from the axis than it starts."""
    return segment.end[1] > segment.start[1]


def slopes(segment: Segment) -> tuple[float, float]:
    """Degrees up (above 0) or down at start and end of a segment, towards the chuck."""
    if segment.center is None:
        run, rise = segment.start[0] - segment.end[0], segment.end[1] - segment.start[1]
        slope = math.degrees(math.atan2(rise, run))
        return slope, slope
    found = []
    for place in (segment.start, segment.end):
        run, rise = place[1] - segment.center[1], place[0] - segment.center[0]
        turned = -1 if segment.clockwise else 1
        found.append(math.degrees(math.atan2(turned * rise, max(0.0, turned * run))))
    return found[0], found[1]


def _check_slopes(pieces: list[Segment], tool: Tool, place: Place) -> float:
    """The steepest fall; refused when the tool can follow it or a rise not."""
    steepest = 0.0
    for segment in pieces:
        for at, slope in zip((segment.start, segment.end), slopes(segment), strict=True):
            steepest = max(steepest, -slope)
            limit = tool.steepest_fall if slope < 0 else tool.steepest_rise
            if abs(slope) <= limit + SLACK_DEGREES:
                continue
            way = _("falls") if slope < 0 else _("rises")
            raise place.refusal(
                segment,
                at,
                _(
                    "the outline {way} at {slope:.1f} degrees, the tool {tool} follows {limit:.4g}"
                ).format(way=way, slope=abs(slope), tool=tool.name, limit=limit),
                _("{way} at {slope:.1f} degrees").format(way=way, slope=abs(slope)),
                _slope_remedy(slope, tool),
            )
    return steepest


def _slope_remedy(slope: float, tool: Tool) -> str:
    """What to do about a slope that is too steep."""
    needed = math.ceil(abs(slope))
    if (slope < 0) == (tool.hand != "left") and needed < QUARTER:
        return _(
            "take a tool that can, for example --back-clearance {needed}, or change the drawing"
        ).format(needed=needed)
    if slope < 0:
        return _(
            "cut grooves as an operation of their own, stop in front of it with "
            "--length, or turn the part round with --free-end"
        )
    return _("take a tool with another hand or --front-clearance, or change the drawing")


def _merged(pieces: list[Segment]) -> list[Segment]:
    """Neighbours that lie on one line or circle made one, and nothing of no length."""
    result: list[Segment] = []
    for segment in pieces:
        if segment.length <= EXACT:
            continue
        if result and _continues(result[-1], segment):
            result[-1] = replace(result[-1], end=segment.end)
        else:
            result.append(segment)
    return result


def _continues(before: Segment, after: Segment) -> bool:
    """Whether `after` goes on along the line or circle of `before`."""
    if before.center and after.center:
        near = SHARE * max(before.radius, after.radius)
        same = math.dist(before.center, after.center) <= near
        return same and abs(before.radius - after.radius) <= near
    if before.center or after.center:
        return False
    whole = replace(before, end=after.end)
    return whole.distance(before.end) <= SHARE * whole.length


def _clear(segment: Segment) -> list[Segment]:
    """A half circle as two quarters.

    With both ends at the height of the centre one could not tell on which side it runs.
    """
    if segment.center is None:
        return [segment]
    heights = [abs(place[1] - segment.center[1]) for place in (segment.start, segment.end)]
    if max(heights) > SHARE * segment.radius:
        return [segment]
    return segment.cut(segment.along(segment.center[0]))


def _representable(segment: Segment, place: Place) -> list[Segment]:
    """An arc as it is, or as chords when its centre is farther away than a part can tell."""
    if segment.radius <= place.paper.largest_radius:
        return [segment]
    height = segment.radius * (1 - math.cos(segment.sweep / 2))
    count = max(1, math.ceil(math.sqrt(height / (CHORD_SHARE * place.tolerance))))
    chords = segment.cut(index / count for index in range(1, count))
    return [replace(chord, center=None) for chord in chords]
