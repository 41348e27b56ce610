# SPDX-License-Identifier: Apache-2.0
"""From the contour of one operation to the path of the tool's tip, and what that leaves."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

from tornillo.contour import SAME, Element, Line, Point, intersections
from tornillo.corners import joined
from tornillo.edges import remedy, too_steep
from tornillo.finished import Around
from tornillo.language import _
from tornillo.nose import NoseError, largest_nose, tip_path
from tornillo.operations import Contour, Operation
from tornillo.protocol import Refusal
from tornillo.protocol_texts import REFUSAL_TEXTS
from tornillo.toml_lines import Place
from tornillo.units import Scale

#: What a place may be off without mattering, in steps.
FINE_STEPS = 0.25


class Fault(NamedTuple):
    """Something that the tool cannot cut, with the place in the part file."""

    place: Place
    message: str
    remedy: str


@dataclass(frozen=True)
class Reach:
    """The smallest tip radius that the machine reaches, in file units."""

    least_x: float


def fault(operation: Operation, place: int, message: str, what_to_do: str) -> Fault:
    """A fault of an operation; `place` is the number of the point of a profile, else 0."""
    where: Place = ("operation", operation.position)
    if place and operation.type == "profile":
        where = (*where, "points", place)
    elif isinstance(operation.shape, Contour):
        where = (*where, operation.shape.keys[1])
    return Fault(where, f"{operation.title}: {message}", what_to_do)


def edge_faults(operation: Operation, scale: Scale) -> list[Fault]:
    """Where the edges of the tool would cut into the work."""
    assert isinstance(operation.shape, Contour)
    found: list[Fault] = []
    for steep in too_steep(operation.shape.elements, operation.tool):
        text = REFUSAL_TEXTS[Refusal.BACK_EDGE if steep.falls else Refusal.FRONT_EDGE]
        way = _("falls") if steep.falls else _("rises")
        message = _(
            "{cause} at {scale}: the contour {way} with {angle:.1f} degrees, the tool "
            '"{tool}" follows {follows:.1f}'
        ).format(
            cause=_(text.cause),
            scale=show(steep.at, scale),
            way=way,
            angle=steep.angle,
            tool=operation.tool.name,
            follows=steep.follows,
        )
        found.append(fault(operation, steep.place, message, remedy(steep, operation.tool)))
    return found


def show(at: Point, scale: Scale) -> str:
    """A place in words."""
    return _("z = {z}, diameter {show}").format(z=scale.show(at.z), show=scale.show(2 * at.x))


def tip_of(
    operation: Operation, around: Around, reach: Reach, scale: Scale
) -> tuple[list[Element], list[Fault], list[str]]:
    """The path of the tip along the contour, what is wrong with it, and what it leaves."""
    assert isinstance(operation.shape, Contour)
    contour = list(operation.shape.elements)
    nose = operation.tool.nose_radius
    if nose <= 0:
        return contour, [], []
    fine = FINE_STEPS * scale.length(1)
    try:
        path = tip_path(contour, nose, fine, around.before, around.after)
    except NoseError as error:
        best = largest_nose(contour, nose, fine, around.before, around.after)
        message = _(
            'the nose of the tool "{tool}" (radius {nose:g}) does not fit at {scale}: {error}'
        ).format(tool=operation.tool.name, nose=nose, scale=show(error.at, scale), error=error)
        digits = 10.0 ** -(3 + (scale.units == "inch"))
        fitting = math.floor(best / digits + 1e-6) * digits
        way = _(
            "use a nose radius of at most {fitting:g}, or a larger radius or piece there"
        ).format(fitting=fitting)
        return [], [fault(operation, error.place, message, way)], []
    least = min(reach.least_x, 0.0)
    notes = _left(operation, path[0].start.x, least, scale)
    path = without_low(path, max(least, around.lowest))
    start = contour[0].start
    if around.level and path and path[0].start.z < start.z - SAME:
        path = joined([Line(Point(start.z, path[0].start.x), path[0].start), *path])
    return _up_to_the_end(path, contour[-1].end, around), [], notes


def without_low(path: list[Element], least: float) -> list[Element]:
    """The path without its beginning below the radius `least`."""
    kept = list(path)
    while kept and kept[0].start.x < least - SAME:
        first = kept.pop(0)
        if first.end.x > least + SAME:
            level = Line(Point(first.start.z + 1, least), Point(first.start.z, least))
            for place in intersections(first, level):
                if -SAME <= first.along(place) <= first.length + SAME:
                    kept.insert(0, first.between(place, first.end))
                    break
    return kept or path


def _up_to_the_end(path: list[Element], end: Point, around: Around) -> list[Element]:
    """A last upright piece, behind which nothing is larger, up to the end of the contour."""
    last = path[-1]
    upright = isinstance(last, Line) and abs(last.start.z - last.end.z) < SAME
    if around.after is None and upright and last.start.x < last.end.x < end.x:
        path = [*path[:-1], replace(last, end=Point(last.end.z, end.x))]
    return path


def _left(operation: Operation, start: float, least: float, scale: Scale) -> list[str]:
    """What stays in the middle when the tip cannot go below the axis as far as it should."""
    nose = operation.tool.nose_radius
    if least <= start + FINE_STEPS * scale.length(1):
        return []
    across = least + nose
    height = nose - math.sqrt(max(0.0, nose * nose - across * across))
    return [
        _(
            "{title}: the slide ends before the round nose is past the axis: a pip of "
            "diameter {show}, at most {height} high, stays in the middle"
        ).format(title=operation.title, show=scale.show(2 * across), height=scale.show(height))
    ]
