# SPDX-License-Identifier: Apache-2.0
"""Broken rules of a part image in words, with the line of the part file to correct."""

from tornillo.compile import Compiled, Origin
from tornillo.errors import PartError
from tornillo.language import _
from tornillo.operations import Contour, Operation
from tornillo.protocol import Refusal
from tornillo.protocol_texts import REFUSAL_TEXTS
from tornillo.rules import Violation
from tornillo.toml_lines import Place
from tornillo.toml_source import Source


def explain(violation: Violation, compiled: Compiled, source: Source) -> PartError:
    """The refusal for a broken rule."""
    text = REFUSAL_TEXTS[violation.refusal]
    remedy = _(text.remedy)
    what = ""
    place: Place = tuple(violation.key.split("."))
    if violation.record >= 0:
        origin = compiled.origins[violation.record]
        place = _place(violation, origin, source)
        what = "" if place[0] == "cut" else f"{origin.operation.title}: "
        if violation.refusal is Refusal.EMPTY_CUT and violation.key == "end.z":
            remedy = _empty_cut_remedy(origin.operation)
    detail = f": {violation.detail}" if violation.detail else ""
    return source.error(place, f"{what}{_(text.cause)}{detail}", remedy)


def _place(violation: Violation, origin: Origin, source: Source) -> Place:
    """Where in the file a rule about a record is broken."""
    operation = origin.operation
    if origin.kind == "tool":
        return ("tool", operation.tool.position, violation.key)
    inside: Place = ("operation", operation.position)
    if origin.kind == "cut":
        own = (*inside, violation.key)
        return own if own in source.lines else ("cut", violation.key)
    end, _, axis = violation.key.partition(".")
    if not axis:
        return (*inside, end)
    return (*inside, _key(operation, end, axis))


def _key(operation: Operation, end: str, axis: str) -> str:
    """The key that tells a place of a contour or plunge."""
    if not isinstance(operation.shape, Contour) or operation.type in ("face", "cylinder"):
        return "diameter" if axis == "x" else "z"
    return operation.shape.keys[0 if end == "start" else 1]


def _empty_cut_remedy(operation: Operation) -> str:
    """What to do about an operation that has nothing to cut along z."""
    if operation.type == "face":
        return _("give the raw material in front of the face as `allowance` in [stock]")
    if operation.type == "groove":
        return _("make the groove wider, or use a narrower tool")
    return _("order z from the free end towards the chuck; towards the chuck z gets smaller")
