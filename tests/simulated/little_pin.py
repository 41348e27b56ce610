# SPDX-License-Identifier: Apache-2.0
"""A part so small and so near to the switches that cutting it takes two simulated seconds."""

from __future__ import annotations

from typing import Any

from tornillo.image import PartImage, Record, Segment, SegmentKind, pack_segments
from tornillo.protocol import (
    CONTOUR_FACING,
    SLOPE_ANY,
    ContourRecord,
    CutRecord,
    ImageHeader,
    PauseRecord,
    ToolRecord,
)
from virtual_lathe.part import Cylinder, Face, Nominal, WantedPart

from simulated.bench import Bench

STEP_MM = 7112e-6
RADIUS, LENGTH, FRONT = 60, 100, 6
ZERO_X, ZERO_Z = -100, -60
FACE_KIND, CYLINDER_KIND, PROFILE_KIND = CONTOUR_FACING, 1, 4
#: Options of the virtual lathe that belong to the part.
OPTIONS: dict[str, Any] = {
    "stock_diameter_mm": 2 * RADIUS * STEP_MM,
    "stock_length_mm": LENGTH * STEP_MM,
    "stock_allowance_mm": FRONT * STEP_MM,
    "part_zero_x": ZERO_X,
    "part_zero_z": ZERO_Z,
}
HEADER = ImageHeader(
    format=2,
    operation_count=2,
    flags=0,
    reserved=0,
    name=b"little-pin".ljust(16, b"\0"),
    step_x_nm=7112,
    step_z_nm=7112,
    stock_radius=RADIUS,
    stock_length=LENGTH,
    stock_front=FRONT,
    retract=5,
)
#: Right-hand: follows square shoulders, and falls of 30 degrees.
TOOL = ToolRecord(
    kind=0,
    name=b"right-hand".ljust(12, b"\0"),
    nose=0,
    below=0,
    width=0,
    back=148,
    front=SLOPE_ANY,
    offset_x=0,
    offset_z=0,
)
CUT = CutRecord(
    kind=0,
    depth_of_cut=10,
    finish_allowance=2,
    feed=400 * 8,
    finish_feed=200 * 8,
    spindle=0,
    peck=0,
)


def line(dz: int, dx: int) -> Segment:
    """Return a straight segment."""
    return Segment(SegmentKind.LINE, dz, dx)


def contour(z: int, x: int, *segments: Segment, kind: int = PROFILE_KIND) -> ContourRecord:
    """Return the record of a contour that starts at a place."""
    return ContourRecord(kind, z, x, pack_segments(segments))


def face(z: int, x_inner: int, radius: int = RADIUS) -> ContourRecord:
    """Return the record of a face, from a radius out to that of the stock."""
    return contour(z, x_inner, line(0, radius - x_inner), kind=FACE_KIND)


def cylinder(z_start: int, z_end: int, x: int) -> ContourRecord:
    """Return the record of a cylinder."""
    return contour(z_start, x, line(z_end - z_start, 0), kind=CYLINDER_KIND)


def pause(message: str = "") -> PauseRecord:
    """Return the record of a pause."""
    return PauseRecord(0, message.encode())


FACE, CYLINDER = OPERATIONS = (face(0, 0), cylinder(0, -40, 35))


def image(
    name: str = "little-pin",
    operations: tuple[Record, ...] = OPERATIONS,
    **changes: Any,
) -> bytes:
    """Return the image of a part for the little stock.

    ``changes`` are fields of the header, of the tool or of its cutting data; those of the tool
    begin with ``tool_``, as in ``tool_width``.
    """
    count = sum(not isinstance(record, ToolRecord | CutRecord) for record in operations)
    header = HEADER._replace(name=name.encode().ljust(16, b"\0"), operation_count=count)
    header = header._replace(**{k: v for k, v in changes.items() if k in header._fields})
    cut = CUT._replace(**{k: v for k, v in changes.items() if k in CUT._fields and k != "kind"})
    tool = TOOL._replace(
        **{k.removeprefix("tool_"): v for k, v in changes.items() if k.startswith("tool_")}
    )
    known = {*header._fields, *cut._fields, *(f"tool_{field}" for field in tool._fields)}
    assert set(changes) <= known
    return PartImage(header, (tool, cut, *operations)).pack()


def wanted(operations: tuple[ContourRecord, ...] = OPERATIONS, front: int = FRONT) -> WantedPart:
    """Return what the virtual lathe shall compare the workpiece with: faces and cylinders."""
    shapes = tuple(
        Face(record.z, record.x, Nominal(record.x, record.z))
        if record.kind & CONTOUR_FACING
        else Cylinder(record.z, end_of(record), record.x, _drawn(record))
        for record in operations
    )
    return WantedPart(RADIUS, LENGTH, front, shapes)


def _drawn(record: ContourRecord) -> Nominal:
    return Nominal(record.x, record.z - end_of(record))


def end_of(record: ContourRecord) -> int:
    """Return the z at which a contour of one line ends."""
    return record.z + int.from_bytes(record.segments[3:5], "little", signed=True)


def lathe_with_pin(**options: Any) -> Bench:
    """Return a lathe that is connected, set up for the little stock, and has the part stored."""
    bench = Bench(**(OPTIONS | options))
    bench.lathe.wanted = wanted()
    bench.set(zero_x=ZERO_X, zero_z=ZERO_Z)
    bench.host.upload(image())
    return bench


def homed_lathe_with_pin(**options: Any) -> Bench:
    """Return the same, homed."""
    bench = lathe_with_pin(**options)
    bench.home()
    return bench


def assert_cut_exactly(bench: Bench) -> None:
    """Check that the part is there, every dimension to the step, and nothing was lost."""
    report = bench.lathe.report()
    errors = {entry["name"]: entry["error_steps"] for entry in report["dimensions"]}
    assert set(errors) == {"face 1 z", "cylinder 1 diameter", "cylinder 1 length"}
    assert set(errors.values()) == {0}
    assert report["gouge_max_steps"] == 0
    assert report["lost_steps"] == 0
    assert report["crashes"] == []
