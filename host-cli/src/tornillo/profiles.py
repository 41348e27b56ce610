# SPDX-License-Identifier: Apache-2.0
"""Arcs and chains of points in a part file, with rounded and chamfered corners."""

import math
from typing import NoReturn

from tornillo.contour import (
    SAME,
    Arc,
    Element,
    Line,
    Point,
    arc_by_centre,
    arc_by_radius,
    arc_by_third,
    distance,
    monotone,
    smallest_radius,
)
from tornillo.corners import with_corners
from tornillo.language import _
from tornillo.toml_source import Table

#: How far, in file units, the ends may be from a circle about the given centre.
OFF_CIRCLE = 2e-3
ARC_KEYS = ("radius", "center", "via")


def read_arc(
    table: Table, start: Point, end: Point, place: int = 0, exact: bool = False
) -> Element:
    """The arc from `start` to `end` that `table` describes, or a line when it does not.

    `exact`: it came from an image, where rounding may lead it a little astray. Raises PartError.
    """
    given = [key for key in ARC_KEYS if table.has(key)]
    if not given:
        return Line(start, end, place)
    if exact and given == ["radius", "center"]:
        return Arc(start, end, table.point("center"), table.number("radius") > 0, place)
    if "via" in given and len(given) > 1:
        table.refuse(
            "via",
            _("{title}: {given} are too much for one arc").format(
                title=table.title, given=_(" and ").join(given)
            ),
            _("give one of radius, center and via"),
        )
    arc = _arc_of(table, given, start, end)
    if not monotone(arc):
        _refuse_back(table, given[0], start, end, arc)
    return Arc(arc.start, arc.end, arc.centre, arc.convex, place)


def _arc_of(table: Table, given: list[str], start: Point, end: Point) -> Arc:
    """The arc by what the file gives."""
    if "via" in given:
        try:
            arc = arc_by_third(start, end, table.point("via"))
        except ValueError as error:
            table.refuse(
                "via",
                _("{title}: there is no such arc: {error}").format(title=table.title, error=error),
                _("move via aside"),
            )
        return arc
    if "center" in given:
        return _arc_about(table, start, end, "radius" in given)
    radius = table.number("radius")
    if radius == 0 or distance(start, end) < SAME:
        table.refuse(
            "radius",
            _("{title}: there is no such arc: its radius or its length is 0").format(
                title=table.title
            ),
            _("give a radius above 0 for a convex arc, below 0 for a concave one"),
        )
    try:
        return arc_by_radius(start, end, radius)
    except ValueError as error:
        table.refuse(
            "radius",
            _("{title}: there is no such arc: {error}").format(title=table.title, error=error),
            _larger(start, end),
        )


def _arc_about(table: Table, start: Point, end: Point, signed: bool) -> Arc:
    """The arc about a given centre; a radius beside it tells which side it bulges to."""
    centre = table.point("center")
    inner, outer = sorted((distance(start, centre), distance(end, centre)))
    if inner < SAME or outer - inner > OFF_CIRCLE:
        table.refuse(
            "center",
            _(
                "{title}: there is no such arc: the center is {start:.6g} from the start "
                "and {end:.6g} from the end"
            ).format(title=table.title, start=distance(start, centre), end=distance(end, centre)),
            _("give a center as far from the start as from the end"),
        )
    if not signed:
        return arc_by_centre(start, end, centre)
    radius = table.number("radius")
    if abs(abs(radius) - inner) > OFF_CIRCLE:
        table.refuse(
            "radius",
            _(
                "{title}: the center is {inner:.6g} from the ends, the radius says {radius:g}"
            ).format(title=table.title, inner=inner, radius=radius),
            _("give one of radius and center alone"),
        )
    return Arc(start, end, centre, radius > 0)


def _refuse_back(table: Table, key: str, start: Point, end: Point, arc: Arc) -> NoReturn:
    """An arc that would lead away from the chuck somewhere."""
    farthest = (
        f"z = {arc.centre.z + arc.radius:.6g}"
        if arc.side * (arc.start.x - arc.centre.x) < 0
        else f"z = {arc.centre.z - arc.radius:.6g}"
    )
    table.refuse(
        key,
        _("{title}: the arc would run back in z, by way of {farthest}").format(
            title=table.title, farthest=farthest
        ),
        _larger(start, end) if key == "radius" else _("end it where it stands upright"),
    )


def _larger(start: Point, end: Point) -> str:
    """What radius would do."""
    least = smallest_radius(start, end)
    if math.isinf(least):
        return _("give the start a larger z than the end")
    return _("use a radius of at least {least:.6g}, or end the arc elsewhere").format(least=least)


def read_points(table: Table, exact: bool = False) -> tuple[Element, ...]:
    """The chain through `points`; raises PartError."""
    items = table.items("points", least=2)
    elements: list[Element] = []
    corners: dict[int, tuple[str, float]] = {}
    last = Point(0.0, 0.0)
    for number, item in enumerate(items):
        place = Point(item.number("z"), item.number("diameter") / 2)
        if number:
            _check_step(item, last, place)
            elements.append(read_arc(item, last, place, number, exact))
        _read_corner(item, number, 0 < number < len(items) - 1, corners)
        item.finish()
        last = place
    done, wrong = with_corners(elements, corners)
    for number, reason in wrong.items():
        items[number + 1].refuse(
            "", f"{items[number + 1].title}: {reason}", _("make it smaller or leave it out")
        )
    return tuple(done)


def _check_step(item: Table, start: Point, end: Point) -> None:
    """Refuse a point that is where the one before is, or in front of it."""
    if distance(start, end) < SAME:
        item.refuse(
            "",
            _("{title}: it is where the one before is").format(title=item.title),
            _("leave one of them out"),
        )
    if end.z > start.z + SAME:
        item.refuse(
            "z",
            _("{title}: the contour runs the wrong way, from z = {z:g} to {z2:g}").format(
                title=item.title, z=start.z, z2=end.z
            ),
            _("order the points from the free end towards the chuck"),
        )


def _read_corner(
    item: Table, number: int, inside: bool, corners: dict[int, tuple[str, float]]
) -> None:
    """A corner that is rounded or chamfered."""
    given = [key for key in ("corner", "chamfer") if item.has(key)]
    for key in given:
        if not inside or len(given) > 1:
            item.refuse(
                key,
                _("{title}: {key} is not possible here").format(title=item.title, key=key),
                _("give corner or chamfer, at a point between two others"),
            )
        corners[number - 1] = (key, item.positive(key))
