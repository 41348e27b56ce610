# SPDX-License-Identifier: Apache-2.0
"""Read the lines and arcs of a DXF file with ezdxf; what cannot be turned is counted."""

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tornillo.dxf.approximation import approximate
from tornillo.dxf.curves import Origin, Point, Segment, bulged, steady
from tornillo.errors import DrawingError, TornilloError
from tornillo.language import _

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.entities.dxfentity import DXFEntity

KINDS = ("LINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "LWPOLYLINE", "POLYLINE")
UNIT_NAMES = {1: "inch", 2: "foot", 4: "mm", 5: "cm", 6: "m", 9: "mil", 13: "um", 14: "dm"}
CENTER_NAMES = ("CENTER", "CENTRE", "DASHDOT", "AXIS", "EJE", "ACAD_ISO04", "ACAD_ISO10")
HIDDEN_NAMES = ("HIDDEN", "DASHED", "PHANTOM", "ACAD_ISO02")
CONSTRUCTION_LAYER = "DEFPOINTS"
DEEPEST_BLOCK = 16
FRAME_POINT = 16
DWG_START = b"AC10"
FLAT = 1e-6


@dataclass
class Reading:
    """What a drawing holds, in its own units.

    `unit` is a name of UNIT_NAMES or empty; `layers` counts the usable entities by layer,
    `left_out` the others by what they are.
    """

    file: str
    unit: str
    segments: list[Segment] = field(default_factory=list)
    center_lines: list[Segment] = field(default_factory=list)
    layers: Counter[str] = field(default_factory=Counter)
    left_out: Counter[str] = field(default_factory=Counter)


def open_drawing(path: Path) -> "Drawing":
    """The document in the file `path`.

    Raises DrawingError when it cannot be read, TornilloError without ezdxf.
    """
    try:
        from ezdxf.lldxf.const import DXFError
    except ImportError as error:
        raise TornilloError(
            _("reading drawings needs ezdxf"), _('install it with `pip install "tornillo[dxf]"`')
        ) from error
    try:
        with path.open("rb") as file:
            start = file.read(len(DWG_START))
    except OSError as error:
        raise DrawingError(
            _("{path}: the drawing cannot be read: {strerror}").format(
                path=path, strerror=error.strerror
            ),
            _("check its name and place"),
        ) from error
    if start == DWG_START:
        raise DrawingError(
            _("{path}: this is a DWG file").format(path=path),
            _("save it as DXF (ASCII, R12 or later) in the CAD program"),
        )
    try:
        if not start:
            raise ValueError(_("it is empty"))
        return _load(path)
    except (OSError, ValueError, DXFError) as error:
        raise DrawingError(
            _("{path}: this is not a DXF drawing, or it is damaged: {error}").format(
                path=path, error=error
            ),
            _("export it again as DXF (ASCII, R12 or later)"),
        ) from error


def _load(path: Path) -> "Drawing":
    """The document, repaired when it is damaged."""
    from ezdxf import recover
    from ezdxf.filemanagement import readfile
    from ezdxf.lldxf.const import DXFError

    try:
        return readfile(path)
    except (OSError, ValueError, DXFError):
        return recover.readfile(path)[0]


def unit_of(document: "Drawing") -> str:
    """The unit that the drawing names in $INSUNITS; empty when it names none."""
    return UNIT_NAMES.get(document.header.get("$INSUNITS", 0), "")


class Reader:
    """Collects the segments of a document, one entity after the other."""

    def __init__(self, document: "Drawing", file: str, layers: tuple[str, ...]) -> None:
        """Take only `layers`, or all of them when there are none."""
        self.document = document
        self.wanted = {layer.casefold() for layer in layers}
        self.reading = Reading(file, unit_of(document))

    def read(self, tolerance: float) -> Reading:
        """Everything in model space; splines and ellipses as arcs within `tolerance`.

        Raises DrawingError when nothing can be used.
        """
        found = self.reading
        for entity, origin in self._entities():
            kind = entity.dxftype()
            if kind not in KINDS:
                found.left_out[kind] += 1
                continue
            hidden = self._hidden(entity, origin.layer)
            if hidden:
                found.left_out[hidden] += 1
                continue
            center_line = self._line_type(entity, origin.layer, CENTER_NAMES)
            if center_line:
                found.left_out[_("centre line")] += 1
                found.center_lines += _pieces(entity, origin, tolerance, found.file)
                continue
            found.layers[origin.layer] += 1
            if not self.wanted or origin.layer.casefold() in self.wanted:
                for piece in _pieces(entity, origin, tolerance, found.file):
                    found.segments += steady(piece)
        if not found.segments:
            raise self._nothing()
        return found

    def _entities(self) -> "Iterator[tuple[DXFEntity, Origin]]":
        """Every entity of model space, those of blocks in their places."""
        for entity in self.document.modelspace():
            origin = Origin(
                entity.dxftype(), str(entity.dxf.handle), str(entity.dxf.get("layer", "0"))
            )
            yield from _expanded(entity, origin, 0)

    def _hidden(self, entity: "DXFEntity", layer: str) -> str:
        """Why an entity is not part of what one sees; empty when it is."""
        if layer.upper() == CONSTRUCTION_LAYER:
            return _("on layer {layer}").format(layer=layer)
        if entity.dxf.get(_("invisible"), 0):
            return _("invisible")
        if layer in self.document.layers:
            settings = self.document.layers.get(layer)
            if settings.is_off() or settings.is_frozen():
                return _("on layer {layer}, which is off or frozen").format(layer=layer)
        return _("hidden line") if self._line_type(entity, layer, HIDDEN_NAMES) else ""

    def _line_type(self, entity: "DXFEntity", layer: str, names: tuple[str, ...]) -> bool:
        """Whether a line type starts with one of `names`."""
        name = str(entity.dxf.get("linetype", "BYLAYER")).upper()
        if name in ("BYLAYER", "BYBLOCK") and layer in self.document.layers:
            name = str(self.document.layers.get(layer).dxf.get("linetype", "")).upper()
        return name.startswith(names)

    def _nothing(self) -> DrawingError:
        """The refusal of a drawing without anything to turn."""
        found = self.reading
        layers = ", ".join(f"{name} ({count})" for name, count in sorted(found.layers.items()))
        others = ", ".join(f"{count} {kind}" for kind, count in sorted(found.left_out.items()))
        if layers:
            wanted = ", ".join(sorted(self.wanted))
            return DrawingError(
                _("{file}: nothing is drawn on layer {wanted}").format(
                    file=found.file, wanted=wanted
                ),
                _("choose with --layer from: {layers}").format(layers=layers),
            )
        return DrawingError(
            _("{file}: there is nothing to turn in it; found: {value}").format(
                file=found.file, value=others or _("no entities")
            ),
            _("draw the outline in model space with {kinds}").format(kinds=", ".join(KINDS)),
        )


def _expanded(
    entity: "DXFEntity", origin: Origin, depth: int
) -> "Iterator[tuple[DXFEntity, Origin]]":
    """`entity`, or what is inside when it is a block reference, known by the reference."""
    if entity.dxftype() != "INSERT" or depth > DEEPEST_BLOCK:
        yield entity, origin
        return
    reference: Any = entity
    for inner in reference.virtual_entities():
        layer = str(inner.dxf.get("layer", "0"))
        kind = _("{dxftype} in block {dxf}").format(dxftype=inner.dxftype(), dxf=reference.dxf.name)
        where = Origin(kind, origin.handle, origin.layer if layer == "0" else layer)
        yield from _expanded(inner, where, depth + 1)


def _pieces(entity: "DXFEntity", origin: Origin, tolerance: float, file: str) -> list[Segment]:
    """The lines and arcs of one entity."""
    thing: Any = entity
    if not _is_flat(thing):
        raise DrawingError(
            _("{file}: {origin} does not lie in the plane of the drawing").format(
                file=file, origin=origin
            ),
            _("flatten the drawing, or draw the outline in the XY plane of the world"),
        )
    kind = entity.dxftype()
    if kind == "LINE":
        return [Segment(_flat(thing.dxf.start), _flat(thing.dxf.end), origin)]
    if kind in ("ARC", "CIRCLE"):
        return _arc(thing, origin)
    if kind == "ELLIPSE":
        return _ellipse(thing, origin, tolerance)
    if kind == "SPLINE":
        return _spline(thing, origin, tolerance, file)
    return _polyline(thing, origin)


def _is_flat(thing: Any) -> bool:
    """Whether an entity lies in a plane of constant z."""
    extrusion = thing.dxf.get("extrusion")
    if extrusion is not None and math.hypot(extrusion.x, extrusion.y) > FLAT:
        return False
    if thing.dxftype() == "LINE":
        return bool(abs(thing.dxf.start.z - thing.dxf.end.z) <= FLAT)
    if thing.dxftype() == "SPLINE":
        heights = [place[2] for place in (*thing.control_points, *thing.fit_points)]
        return not heights or max(heights) - min(heights) <= FLAT
    return True


def _flat(place: Any) -> Point:
    """A place without its height."""
    return float(place.x), float(place.y)


def _arc(thing: Any, origin: Origin) -> list[Segment]:
    """An arc, or a circle as two halves."""
    ocs = thing.ocs()
    center = _flat(ocs.to_wcs(thing.dxf.center))
    radius = float(thing.dxf.radius)
    clockwise = thing.dxf.extrusion.z < 0
    if thing.dxftype() == "ARC":
        return [
            Segment(_flat(thing.start_point), _flat(thing.end_point), origin, center, clockwise)
        ]
    right, left = (center[0] + radius, center[1]), (center[0] - radius, center[1])
    return [
        Segment(right, left, origin, center),
        Segment(left, right, origin, center),
    ]


def _ellipse(thing: Any, origin: Origin, tolerance: float) -> list[Segment]:
    """Arcs along an ellipse."""
    shape = thing.construction_tool()
    sweep = shape.param_span

    def curve(at: float) -> Point:
        parameter = shape.start_param + at * sweep
        x, y = math.cos(parameter), math.sin(parameter)
        center, major, minor = shape.center, shape.major_axis, shape.minor_axis
        return center.x + x * major.x + y * minor.x, center.y + x * major.y + y * minor.y

    quarters = [index * math.pi / 2 / sweep for index in range(1, 4)]
    return approximate(curve, quarters, tolerance, origin)


def _spline(thing: Any, origin: Origin, tolerance: float, file: str) -> list[Segment]:
    """Arcs along a spline."""
    from ezdxf.lldxf.const import DXFError

    try:
        shape = thing.construction_tool()
    except (ValueError, DXFError) as error:
        raise DrawingError(
            _("{file}: {origin} cannot be understood: {error}").format(
                file=file, origin=origin, error=error
            ),
            _("draw it again, or as arcs"),
        ) from error
    knots = [float(knot) for knot in shape.knots()]
    first, last = knots[shape.degree], knots[-1 - shape.degree]

    def curve(at: float) -> Point:
        return _flat(shape.point(first + at * (last - first)))

    counted = Counter(knots)
    corners = [
        (knot - first) / (last - first)
        for knot, count in counted.items()
        if count >= shape.degree and first < knot < last
    ]
    return approximate(curve, corners, tolerance, origin)


def _polyline(thing: Any, origin: Origin) -> list[Segment]:
    """The sides of a polyline, old or new."""
    if thing.dxftype() == "LWPOLYLINE":
        places = [((x, y, 0.0), float(bulge)) for x, y, bulge in thing.get_points("xyb")]
        closed = bool(thing.closed)
    else:
        places = [
            (tuple(vertex.dxf.location), float(vertex.dxf.get("bulge", 0.0)))
            for vertex in thing.vertices
            if not vertex.dxf.get("flags", 0) & FRAME_POINT
        ]
        closed = bool(thing.is_closed)
    ocs = thing.ocs()
    corners = [(_flat(ocs.to_wcs(place)), bulge) for place, bulge in places]
    turned = -1 if thing.dxf.extrusion.z < 0 else 1
    if closed and corners:
        corners.append((corners[0][0], 0.0))
    return [
        bulged(start, end, turned * bulge, origin)
        for (start, bulge), (end, _) in pairwise(corners)
        if start != end
    ]
