# SPDX-License-Identifier: Apache-2.0
"""Which way a contour is roughed in less time."""

from collections.abc import Iterable

from tornillo.drives import Drives
from tornillo.image import PartImage, Record
from tornillo.material import contour_chain, plunge_chain
from tornillo.moves import Plan
from tornillo.planning import Planner
from tornillo.protocol import (
    CONTOUR_FACING,
    ContourRecord,
    CutRecord,
    ImageHeader,
    PlungeRecord,
)
from tornillo.timing import time_plan


def facing_is_shorter(
    header: ImageHeader,
    records: Iterable[Record],
    contour: ContourRecord,
    facing_cut: CutRecord | None = None,
) -> bool:
    """Whether `contour`, after `records`, takes less time when roughed in facing direction.

    `records` begin with a tool and its cutting data; `facing_cut` are those of the facing
    direction, when its steps are of another size. A contour that falls somewhere can only be
    roughed along Z, one without any length in z only in facing direction. The times are those of
    the chip's default drives, so that the same part always gives the same image. Raises
    ValueError when tool or cutting data are missing.
    """
    chain = contour_chain(contour)
    if chain.z == chain.z_end:
        return True
    if any(sub.xe < sub.xs for sub in chain.subs):
        return False
    before = PartImage(header, tuple(records))
    facing = contour._replace(kind=contour.kind | CONTOUR_FACING)
    along = contour._replace(kind=contour.kind & ~CONTOUR_FACING)
    cuts = () if facing_cut is None else (facing_cut,)
    return _seconds(before, (*cuts, facing)) < _seconds(before, (along,))


def _seconds(before: PartImage, records: Iterable[Record]) -> float:
    """The time of `records` from outside the stock."""
    header = before.header
    clear = header.stock_front + header.retract, header.stock_radius + header.retract
    planner = Planner(before, clear)
    for record in before.records:
        # How earlier operations were cut does not matter, only what they have left.
        if isinstance(record, ContourRecord):
            planner.material.cut(contour_chain(record))
        elif isinstance(record, PlungeRecord):
            planner.material.cut(plunge_chain(record, planner.tool.width))
        else:
            for _ in planner.record(record):
                pass
    planner.path.take()
    planner.path.stand(*clear)
    passes = tuple(step for record in records for step in planner.record(record))
    return time_plan(Plan(before, passes), Drives.default()).total
