# SPDX-License-Identifier: Apache-2.0
"""Find the spindle axis in a drawing and take the half of the section that will be turned.

Places are in units of the drawing, turned so that x runs along the spindle.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from tornillo.dxf.curves import Point, Segment
from tornillo.dxf.paper import Paper
from tornillo.errors import DrawingError
from tornillo.language import _, later

UPPER, LOWER, BOTH, MIXED = "upper", "lower", "both", "mixed"
HALVES = {UPPER: later("upper half"), LOWER: later("lower half")}


@dataclass(frozen=True)
class Half:
    """One half of the section: its pieces, the axis's y, and on which side of it it lies."""

    axis: float
    side: str
    pieces: list[Segment]
    remark: str


def take_half(
    segments: list[Segment],
    center_lines: Sequence[Segment],
    paper: Paper,
    axis: float | None,
    half: str,
) -> Half:
    """The half to turn; `axis` and `half` are what a person said.

    Raises DrawingError when no axis fits or the halves differ.
    """
    place, why = _find_axis(segments, center_lines, paper, axis, half)
    upper, lower = _split(segments, place, paper.snap)
    if not upper and not lower:
        raise DrawingError(
            _("{file}: everything drawn lies on the axis, {place}").format(
                file=paper.file, place=paper.show_level(place)
            ),
            _("say with --axis where the axis is"),
        )
    if half == "auto" and upper and lower:
        _check_symmetry(upper, lower, place, paper)
        return Half(place, UPPER, upper, _("full section, upper half taken; {why}").format(why=why))
    side = half if half != "auto" else (UPPER if upper else LOWER)
    pieces = upper if side == UPPER else lower
    if not pieces:
        raise DrawingError(
            _("{file}: nothing is drawn in the {side} half, axis at {place}").format(
                file=paper.file, side=side, place=paper.show_level(place)
            ),
            _("leave --half {half} out, or say with --axis where the axis is").format(half=half),
        )
    return Half(place, side, pieces, f"{_(HALVES[side])}; {why}")


def _find_axis(
    segments: list[Segment],
    center_lines: Sequence[Segment],
    paper: Paper,
    axis: float | None,
    half: str,
) -> tuple[float, str]:
    """The y of the axis and how it was found."""
    if axis is not None:
        return axis, _("axis at {axis} as said").format(axis=paper.show_level(axis))
    lengthwise = [line for line in center_lines if _is_level(line, paper.snap)]
    if lengthwise:
        longest = max(lengthwise, key=lambda line: line.length)
        place = longest.start[1]
        return place, _("axis on the centre line at {place}").format(place=paper.show_level(place))
    low, high = _extent(segments)
    zero, middle = 0.0, (low + high) / 2
    found = _("axis at {zero}").format(zero=paper.show_level(zero))
    if half != "auto" and low < -paper.snap and high > paper.snap:
        return zero, found
    touches = min(abs(low), abs(high)) <= paper.snap
    if touches or _symmetric(segments, zero, paper):
        return zero, found
    if _symmetric(segments, middle, paper):
        return middle, _("axis in the middle of the section, at {middle}").format(
            middle=paper.show_level(middle)
        )
    if low > 0 or high < 0:
        return zero, found
    upper, lower = _split(segments, zero, paper.snap)
    if abs(middle) <= (high - low) / 4:
        _check_symmetry(upper, lower, zero, paper)
    raise DrawingError(
        _(
            "{file}: the axis cannot be found: the drawing reaches from {low} to "
            "{high} and is not symmetric"
        ).format(file=paper.file, low=paper.show_level(low), high=paper.show_level(high)),
        _("draw a centre line, say where the axis is with --axis, or move it to {zero}").format(
            zero=paper.show_level(zero)
        ),
    )


def _is_level(line: Segment, snap: float) -> bool:
    """Whether a centre line runs along the spindle."""
    level = abs(line.start[1] - line.end[1]) <= snap
    return line.center is None and level and abs(line.start[0] - line.end[0]) > snap


def _extent(segments: Sequence[Segment]) -> tuple[float, float]:
    """The lowest and the highest y."""
    heights = [place[1] for segment in segments for place in segment.samples()]
    for segment in segments:
        if segment.center:
            turn = segment.cut(segment.along(segment.center[0]))
            heights += [piece.end[1] for piece in turn]
    return min(heights), max(heights)


def _split(
    segments: Sequence[Segment], axis: float, snap: float
) -> tuple[list[Segment], list[Segment]]:
    """The pieces above and below the axis; ends near it are put on it, its own lines dropped."""
    upper: list[Segment] = []
    lower: list[Segment] = []
    for segment in segments:
        for piece in segment.cut(segment.across(axis)):
            start, end = (_on_axis(place, axis, snap) for place in (piece.start, piece.end))
            middle = piece.point(0.5)[1] - axis
            if abs(middle) <= snap and start[1] == end[1] == axis:
                continue
            (upper if middle > 0 else lower).append(piece.moved(start, end))
    return _whole(upper, snap), _whole(lower, snap)


def _whole(pieces: list[Segment], snap: float) -> list[Segment]:
    """Without the stubs that reach over the axis by less than the snap."""
    return [piece for piece in pieces if piece.length > snap or piece.start[1] != piece.end[1]]


def _on_axis(place: Point, axis: float, snap: float) -> Point:
    """`place`, on the axis when it is near."""
    return (place[0], axis) if abs(place[1] - axis) <= snap else place


def _symmetric(segments: list[Segment], axis: float, paper: Paper) -> bool:
    """Whether both halves are there and are mirror images."""
    upper, lower = _split(segments, axis, paper.snap)
    return bool(upper and lower) and _worst(upper, lower, axis)[0] <= paper.symmetry


def _check_symmetry(upper: list[Segment], lower: list[Segment], axis: float, paper: Paper) -> None:
    """Refuse a full section whose halves differ, at the place where they differ most."""
    distance, place, segment = _worst(upper, lower, axis)
    if distance <= paper.symmetry:
        return
    side, other = ("upper", "lower") if place[1] > axis else ("lower", "upper")
    raise DrawingError(
        _(
            "{file}: the halves above and below the axis ({axis}) differ by "
            "{distance}: {origin}, at {place}, has no mirror image"
        ).format(
            file=paper.file,
            axis=paper.show_level(axis),
            distance=paper.length(distance),
            origin=segment.origin,
            place=paper.show(place),
        ),
        _(
            "correct the {side} half, take one with --half {other} or --half {side}, "
            "or say with --axis where the axis is"
        ).format(side=side, other=other),
        (
            paper.mark(
                place, _("no mirror image, {distance} off").format(distance=paper.length(distance))
            ),
        ),
    )


def _worst(upper: list[Segment], lower: list[Segment], axis: float) -> tuple[float, Point, Segment]:
    """The place of one half that is farthest from the mirror image of the other."""
    worst = (-1.0, (0.0, axis), upper[0])
    for half, other in ((upper, lower), (lower, upper)):
        image = [piece.mapped(lambda at: (at[0], 2 * axis - at[1]), True) for piece in other]
        for segment in half:
            for place in segment.samples():
                distance = min(piece.distance(place) for piece in image)
                if distance > worst[0]:
                    worst = (distance, place, segment)
    return worst
