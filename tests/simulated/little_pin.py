# SPDX-License-Identifier: Apache-2.0
"""A part so small and so near to the switches that cutting it takes two simulated seconds."""

from __future__ import annotations

from typing import Any

from tornillo.image import Operation, PartImage
from tornillo.protocol import CylinderRecord, FaceRecord, ImageHeader
from virtual_lathe.part import Cylinder, Face, Nominal, WantedPart

from simulated.bench import Bench

STEP_MM = 7112e-6
RADIUS, LENGTH, FRONT = 60, 100, 6
ZERO_X, ZERO_Z = -100, -60
OPERATIONS: tuple[Operation, ...] = (FaceRecord(0, 0), CylinderRecord(0, -40, 35))
#: Options of the virtual lathe that belong to the part.
OPTIONS: dict[str, Any] = {
    "stock_diameter_mm": 2 * RADIUS * STEP_MM,
    "stock_length_mm": LENGTH * STEP_MM,
    "stock_allowance_mm": FRONT * STEP_MM,
    "part_zero_x": ZERO_X,
    "part_zero_z": ZERO_Z,
}
HEADER = ImageHeader(
    format=1,
    operation_count=2,
    flags=0,
    reserved=0,
    name=b"little-pin".ljust(16, b"\0"),
    step_x_nm=7112,
    step_z_nm=7112,
    stock_radius=RADIUS,
    stock_length=LENGTH,
    stock_front=FRONT,
    depth_of_cut=10,
    finish_allowance=2,
    feed=400 * 256,
    finish_feed=200 * 256,
    retract=5,
    reserved_end=0,
)


def image(
    name: str = "little-pin",
    operations: tuple[Operation, ...] = OPERATIONS,
    **header: Any,
) -> bytes:
    """Return the image of a part for the little stock; ``header`` changes fields of the header."""
    changed = HEADER._replace(
        name=name.encode().ljust(16, b"\0"), operation_count=len(operations)
    )._replace(**header)
    return PartImage(changed, operations).pack()


def wanted(operations: tuple[Operation, ...] = OPERATIONS, front: int = FRONT) -> WantedPart:
    """Return what the virtual lathe shall compare the workpiece with."""
    shapes = tuple(
        Face(record.z, record.x_inner, Nominal(0.0, record.z))
        if isinstance(record, FaceRecord)
        else Cylinder(
            record.z_start,
            record.z_end,
            record.x,
            Nominal(record.x, record.z_start - record.z_end),
        )
        for record in operations
    )
    return WantedPart(RADIUS, LENGTH, front, shapes)


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
