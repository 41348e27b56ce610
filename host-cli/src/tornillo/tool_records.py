# SPDX-License-Identifier: Apache-2.0
"""Tools as the chip knows them."""

import math
from collections.abc import Iterable

from tornillo.image import Segment
from tornillo.protocol import (
    POSITION_MAX,
    SLOPE_ANY,
    SLOPE_UNIT,
    TOOL_NAME_LENGTH,
    ToolRecord,
)
from tornillo.rules_shape import slopes
from tornillo.tools import Tool, slope
from tornillo.units import NM_PER_UNIT, Scale

NM_PER_UM = 1000
NOSE_MAX = 0xFFFF
TINY = 1e-6


def tool_record(number: int, tool: Tool, segments: Iterable[Segment], scale: Scale) -> ToolRecord:
    """The record of a tool that cuts `segments`, none for a file of tip paths.

    Its slopes are those of its edges, or a little more where rounding to whole steps has made
    a segment steeper that the edges can follow.
    """
    machine = scale.machine
    needs = {True: 0, False: 0}
    for segment in segments:
        for falling, climb, run in slopes(segment):
            need = -(-climb * SLOPE_UNIT // run) if run else SLOPE_ANY - 1
            needs[falling] = max(needs[falling], min(need, SLOPE_ANY - 1))
    ratio = machine.step_z_nm / machine.step_x_nm
    nose = nose_micrometres(tool.nose_radius, scale.units)
    return ToolRecord(
        kind=number,
        name=tool.name.encode("ascii").ljust(TOOL_NAME_LENGTH, b"\0"),
        nose=min(nose, NOSE_MAX),
        below=min(-(-nose * NM_PER_UM // machine.step_x_nm), POSITION_MAX),
        width=min(scale.z_steps(tool.width), POSITION_MAX),
        back=max(slope(tool.steepest_fall, ratio), needs[True]),
        front=max(slope(tool.steepest_rise, ratio), needs[False]),
        offset_x=_bounded(scale.x_steps(tool.offset_x)),
        offset_z=_bounded(scale.z_steps(tool.offset_z)),
    )


def nose_micrometres(nose: float, units: str) -> int:
    """A nose radius in whole micrometres, rounded up."""
    return math.ceil(nose * NM_PER_UNIT[units] / NM_PER_UM - TINY)


def _bounded(steps: int) -> int:
    """An offset that fits its field; one that is larger is refused anyway."""
    return max(-POSITION_MAX, min(POSITION_MAX, steps))
