# SPDX-License-Identifier: Apache-2.0
"""A small good part image, and how to spoil it, for the tests of the rules."""

from dataclasses import replace
from typing import Any

from tornillo.image import PartImage, Record, Segment, SegmentKind, pack_segments
from tornillo.machine import Machine
from tornillo.protocol import (
    SLOPE_ANY,
    ContourRecord,
    CutRecord,
    ImageHeader,
    PauseRecord,
    PlungeRecord,
    ToolRecord,
)

MACHINE = Machine("test", 7112, 7112, 3575, 16072, -3575, -8000, 1000, 100, 3800)
SHORT_X = replace(MACHINE, travel_x=3000)
SHORT_Z = replace(MACHINE, travel_z=8100)
HEADER = ImageHeader(
    format=2,
    operation_count=2,
    flags=0,
    reserved=0,
    name=b"pin".ljust(16, b"\0"),
    step_x_nm=7112,
    step_z_nm=7112,
    stock_radius=1000,
    stock_length=5000,
    stock_front=100,
    retract=40,
)
TOOL = ToolRecord(0, b"turning".ljust(12, b"\0"), 400, 57, 0, 256, SLOPE_ANY, 0, 0)
PARTING = ToolRecord(1, b"parting".ljust(12, b"\0"), 0, 0, 200, 148, SLOPE_ANY, 0, 0)
CUT = CutRecord(0, 100, 10, 3125, 1562, 0, 0)
LINE, CONVEX, CONCAVE = SegmentKind


def line(dz: int, dx: int) -> Segment:
    """A line."""
    return Segment(LINE, dz, dx)


def arc(kind: SegmentKind, dz: int, dx: int, cz: float, cx: float) -> Segment:
    """An arc with its centre (cz, cx) steps from its start."""
    return Segment(kind, dz, dx, round(cz * 256), round(cx * 256))


def contour(z: int, x: int, *segments: Segment, kind: int = 4) -> ContourRecord:
    """A contour from (z, x)."""
    return ContourRecord(kind, z, x, pack_segments(segments))


FACE = contour(0, 0, line(0, 1000), kind=0x80)
BAR = contour(0, 600, line(-2000, 0), kind=1)
GROOVE = PlungeRecord(0, -700, -800, 300)
PAUSE = PauseRecord(0, b"look")
GOOD = PartImage(HEADER, (TOOL, CUT, FACE, BAR))


def image(*records: Record, **changes: Any) -> bytes:
    """An image of `records`, counted right, with a changed header."""
    counted = sum(not isinstance(record, ToolRecord | CutRecord) for record in records)
    header = HEADER._replace(**{"operation_count": counted, **changes})
    return PartImage(header, records).pack()


def cut(*contours: Record, tool: ToolRecord = TOOL, data: CutRecord = CUT) -> bytes:
    """An image in which `tool` cuts `contours`."""
    return image(tool, data, *contours)


def header(**changes: Any) -> bytes:
    """GOOD with another header."""
    return PartImage(HEADER._replace(**changes), GOOD.records).pack()


def patched(at: int, value: int) -> bytes:
    """GOOD with one byte changed."""
    data = bytearray(GOOD.pack())
    data[at] = value
    return bytes(data)
