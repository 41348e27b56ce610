# SPDX-License-Identifier: Apache-2.0
"""Part texts for tests: a head with stock, cutting data and tools, and what follows it."""

from collections.abc import Callable

import pytest

from tornillo.errors import PartError
from tornillo.image import PartImage, Segment, unpack_segments
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol import ContourRecord

HEAD = """\
[part]
name = "piece"
units = "mm"

[stock]
diameter = 20.0
length = 40.0

[cut]
depth_of_cut = 1.0
feed = 100.0
retract = 0.5

"""
TOOLS = """\
[[tool]]
name = "turning"
back_clearance = 30.0

[[tool]]
name = "pointed"
hand = "neutral"
back_clearance = 60.0

[[tool]]
name = "left"
hand = "left"
back_clearance = 40.0

[[tool]]
name = "round"
nose_radius = 0.4
back_clearance = 50.0

[[tool]]
name = "parting"
width = 2.0

"""


def operation(kind: str, body: str) -> str:
    """The text of one operation."""
    return f'[[operation]]\ntype = "{kind}"\n{body}\n\n'


def profile(*points: str, more: str = "") -> str:
    """A profile through points written as "z diameter rest"."""
    rows = []
    for point in points:
        z, diameter, *rest = point.split(maxsplit=2)
        tail = f", {rest[0]}" if rest else ""
        rows.append(f"  {{ z = {z}, diameter = {diameter}{tail} }},\n")
    return operation("profile", f"points = [\n{''.join(rows)}]\n{more}")


def steps(*operations: str, head: str = HEAD + TOOLS) -> PartImage:
    """The image of these operations; raises PartError when it is refused."""
    part = Part.parse(head + "".join(operations))
    part.check(Machine.load())
    return part.steps(Machine.load())


def refusal(*operations: str, head: str = HEAD + TOOLS) -> PartError:
    """How these operations are refused."""
    with pytest.raises(PartError) as caught:
        steps(*operations, head=head)
    assert caught.value.remedy
    return caught.value


def line_of(text: str, wanted: str) -> int:
    """The line, from 1, in which `wanted` begins."""
    return text[: text.index(wanted)].count("\n") + 1


def segments(record: object) -> tuple[Segment, ...]:
    """The segments of a contour."""
    assert isinstance(record, ContourRecord)
    return tuple(unpack_segments(record.segments))


Refused = Callable[..., PartError]
