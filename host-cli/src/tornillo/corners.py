# SPDX-License-Identifier: Apache-2.0
"""Rounded and chamfered corners of a contour."""

import math
from dataclasses import replace

from tornillo.contour import SAME, Arc, Element, Line, Point, distance, intersections, turn
from tornillo.language import _

SMOOTH = 1e-6  # radians


def rounded(before: Element, after: Element, radius: float) -> list[Element]:
    """Both pieces, shortened, with an arc of `radius` between them that touches both.

    Raises ValueError when there is no corner, or no room for the arc.
    """
    angle = turn(before, after)
    if abs(angle) < SMOOTH:
        raise ValueError(_("there is no corner to round here"))
    by = math.copysign(radius, angle)
    corner = before.end
    fits: list[tuple[float, Point, Point, Point]] = []
    for centre in _centres(before, after, by):
        first, second = _foot(before, centre, by), _foot(after, centre, by)
        on_first = SAME < before.along(first) <= before.length + SAME
        on_second = -SAME <= after.along(second) < after.length - SAME
        if on_first and on_second:
            fits.append((distance(centre, corner), centre, first, second))
    if not fits:
        raise ValueError(
            _("an arc of radius {radius:g} does not fit between its neighbours").format(
                radius=radius
            )
        )
    _distance, centre, first, second = min(fits)
    arc = Arc(first, second, centre, convex=angle < 0, place=before.place)
    return [before.between(before.start, first), arc, after.between(second, after.end)]


def chamfered(before: Element, after: Element, length: float) -> list[Element]:
    """Both pieces, shortened by `length`, with a line between them.

    Raises ValueError when there is no corner, or a piece is too short.
    """
    if abs(turn(before, after)) < SMOOTH:
        raise ValueError(_("there is no corner to chamfer here"))
    first = _at_distance(before, before.end, length)
    second = _at_distance(after, after.start, length)
    if first is None or second is None:
        raise ValueError(
            _("a chamfer of {length:g} is longer than its neighbours").format(length=length)
        )
    line = Line(first, second, before.place)
    return [before.between(before.start, first), line, after.between(second, after.end)]


def _centres(before: Element, after: Element, by: float) -> list[Point]:
    """Places at the distance `by` from both, towards the tool."""
    moved = []
    for element in (before, after):
        if isinstance(element, Arc) and element.radius + element.side * by < SAME:
            return []
        moved.append(element.offset(by))
    return intersections(*moved)


def _foot(element: Element, centre: Point, by: float) -> Point:
    """Where a circle about `centre` touches `element`."""
    if isinstance(element, Line):
        return centre.plus(element.normal(element.start), -by)
    return element.centre.plus(centre.minus(element.centre).unit, element.radius)


def _at_distance(element: Element, corner: Point, length: float) -> Point | None:
    """The place on `element` at `length` from its end in `corner`."""
    aside = Point(corner.z + length, corner.x)
    circle = Arc(aside, aside, corner, convex=True)
    for place in intersections(element, circle):
        if SAME < element.along(place) < element.length - SAME:
            return place
    return None


def with_corners(
    elements: list[Element], corners: dict[int, tuple[str, float]]
) -> tuple[list[Element], dict[int, str]]:
    """The contour with its corners worked, and what went wrong by number of the corner.

    `corners[i]` is ("corner", radius) or ("chamfer", length) at the end of element i.
    """
    done = [elements[0]]
    wrong: dict[int, str] = {}
    for number, after in enumerate(elements[1:]):
        pieces: list[Element] = [done[-1], after]
        if number in corners:
            kind, size = corners[number]
            work = rounded if kind == "corner" else chamfered
            try:
                pieces = work(done[-1], after, size)
            except ValueError as error:
                wrong[number] = str(error)
        done[-1:] = pieces
    return done, wrong


def joined(elements: list[Element]) -> list[Element]:
    """The contour with straight continuations as one line, and without empty pieces."""
    done: list[Element] = []
    for element in elements:
        if element.length < SAME:
            continue
        last = done[-1] if done else None
        if (
            isinstance(last, Line)
            and isinstance(element, Line)
            and (abs(turn(last, element)) < SAME)
        ):
            done[-1] = replace(last, end=element.end)
        else:
            done.append(element)
    return done
