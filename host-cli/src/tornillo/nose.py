# SPDX-License-Identifier: Apache-2.0
"""The path of the imaginary tip of a tool with a round nose, so that the contour comes out exact.

The centre of the nose keeps the nose radius away from the contour. The imaginary tip of an
external right-hand tool (orientation 3) lies one radius below the centre and one towards the
chuck. Around convex corners the nose rolls; in inside corners it touches both sides at once.
"""

import math
from dataclasses import replace

from tornillo.contour import (
    SAME,
    Arc,
    Element,
    Line,
    Point,
    distance,
    intersections,
    turn,
)
from tornillo.corners import SMOOTH, joined
from tornillo.language import _

SQUARE = math.pi / 2
BISECTIONS = 16
SAMPLES = 8


class NoseError(ValueError):
    """The nose does not fit; `place` is the number of the point of the file, `at` the place."""

    def __init__(self, message: str, place: int, at: Point) -> None:
        """Keep where it is."""
        super().__init__(message)
        self.place = place
        self.at = at


def tip_path(
    contour: list[Element],
    nose: float,
    fine: float,
    before: Element | None = None,
    after: Element | None = None,
) -> list[Element]:
    """The path of the imaginary tip along `contour` for the radius `nose`.

    `before` and `after` are what the finished part has in front of the contour and behind it;
    they are touched, not cut. `fine` is a length that does not matter. Raises NoseError.
    """
    if nose <= 0:
        return contour
    whole = [*([before] if before else []), *contour, *([after] if after else [])]
    centre = _Centre(whole, nose, fine)
    for number in range(len(whole) - 1):
        centre.turn_corner(number)
    first = 1 if before else 0
    path = centre.path(first, first + len(contour))
    _no_gouge(path, whole, nose, fine)
    moved = joined([element.shifted(Point(-nose, -nose)) for element in path])
    if not moved:
        raise NoseError(_("the nose does not reach this piece"), contour[0].place, contour[0].end)
    return moved


def largest_nose(
    contour: list[Element], nose: float, fine: float, before: Element | None, after: Element | None
) -> float:
    """The largest nose radius below `nose` that fits the contour."""
    low, high = 0.0, nose
    for _step in range(BISECTIONS):
        middle = (low + high) / 2
        try:
            tip_path(contour, middle, fine, before, after)
            low = middle
        except NoseError:
            high = middle
    return low


def _moved(element: Element, nose: float) -> Element:
    """The path of the nose's centre along one piece."""
    if isinstance(element, Arc) and not element.convex and element.radius < nose + SAME:
        if element.radius < nose - SAME:
            raise NoseError(
                _("the concave arc has a radius of {radius:.6g} only").format(
                    radius=element.radius
                ),
                element.place,
                element.end,
            )
        return Arc(element.centre, element.centre, element.centre, False, element.place)
    return element.offset(nose)


class _Centre:
    """The path of the nose's centre along a contour.

    `_touching` are the parts of it on which the nose touches the work.
    """

    def __init__(self, whole: list[Element], nose: float, fine: float) -> None:
        """Along every piece for itself; raises NoseError for one that is too narrow."""
        self._whole = whole
        self._nose = nose
        self._fine = fine
        self._moved = [_moved(element, nose) for element in whole]
        self._touching = list(self._moved)
        self._rolls: dict[int, Arc] = {}

    def turn_corner(self, number: int) -> None:
        """Let the paths along a piece and the next one meet; raises NoseError."""
        one, two = self._whole[number], self._whole[number + 1]
        a, b = self._moved[number], self._moved[number + 1]
        angle = turn(one, two)
        if abs(angle) < SMOOTH or a.length < SAME or b.length < SAME:
            return
        mitre = self._nose * (1 / max(math.cos(angle / 2), SAME) - 1) < self._fine
        lines = isinstance(one, Line) and isinstance(two, Line)
        if angle > 0 or (lines and (mitre or _square(one, angle))):
            places = intersections(a, b)
            if not places:
                raise NoseError(_("the nose does not fit the inside corner"), two.place, one.end)
            place = min(places, key=lambda at: distance(at, a.end) + distance(at, b.start))
            self._moved[number] = replace(a, end=place)
            self._moved[number + 1] = replace(b, start=place)
            if angle > 0:
                self._touching[number] = replace(self._touching[number], end=place)
                self._touching[number + 1] = replace(b, start=place)
        elif distance(a.end, b.start) < self._fine:
            self._moved[number] = replace(a, end=b.start)
        else:
            self._rolls[number] = Arc(a.end, b.start, one.end, convex=True, place=two.place)

    def path(self, first: int, last: int) -> list[Element]:
        """The path along pieces `first` up to `last`; raises NoseError."""
        path: list[Element] = []
        for number in range(first, last):
            if number - 1 in self._rolls:
                path.append(self._rolls[number - 1])
            _must_run_on(self._whole[number], self._touching[number])
            path.append(self._moved[number])
        return path


def _square(one: Element, angle: float) -> bool:
    """Whether a corner leads from upright to level or back, at right angles."""
    level = min(abs(one.start.x - one.end.x), abs(one.start.z - one.end.z)) < SAME
    return level and abs(angle + SQUARE) < SMOOTH


def _must_run_on(element: Element, path: Element) -> None:
    """Refuse a piece whose path runs backwards: the nose does not reach it."""
    if path.length < SAME:
        return
    if isinstance(path, Line):
        direction = element.direction(element.start)
        gone = path.end.minus(path.start).dot(direction)
    else:
        gone = math.pi - path.sweep
    if gone < -SAME:
        raise NoseError(_("the nose does not reach this piece"), element.place, element.end)


def _no_gouge(path: list[Element], whole: list[Element], nose: float, fine: float) -> None:
    """Refuse a path on which the nose cuts into a piece that is no neighbour."""
    for element in path:
        low, high = element.end.z - nose, element.start.z + nose
        near = [other for other in whole if other.end.z < high and other.start.z > low]
        for place in _samples(element):
            for other in near:
                if away(other, place) < nose - fine:
                    raise NoseError(_("the nose would cut into this piece"), other.place, other.end)


def _samples(element: Element) -> list[Point]:
    """Some places along a piece, its ends included."""
    parts = [number / SAMPLES for number in range(SAMPLES + 1)]
    if isinstance(element, Line):
        way = element.end.minus(element.start)
        return [element.start.plus(way, part) for part in parts]
    return [element.at(part) for part in parts]


def away(element: Element, place: Point) -> float:
    """The distance of `place` from a piece of the contour."""
    if 0 < element.along(place) < element.length:
        if isinstance(element, Line):
            return abs(place.minus(element.start).dot(element.normal(element.start)))
        return abs(distance(place, element.centre) - element.radius)
    return min(distance(place, element.start), distance(place, element.end))
