# SPDX-License-Identifier: Apache-2.0
"""What a run of the virtual lathe has come to, as the contract wants it, for JSON."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from .chip import CYCLES_PER_SECOND
from .dimensions import Ruler
from .machine import AxisName, FaultKind

if TYPE_CHECKING:
    from .lathe import VirtualLathe


def _setup(lathe: VirtualLathe, step_nm: int) -> dict[str, int]:
    """What a reader of the trace must know besides the trace."""
    x, z = lathe.machine.options(AxisName.X), lathe.machine.options(AxisName.Z)
    return {
        "dead_steps_x": x.backlash,
        "dead_steps_z": z.backlash,
        "slack_x": x.slack,
        "slack_z": z.slack,
        "start_x": x.start,
        "start_z": z.start,
        "part_zero_x": lathe.workpiece.zero_x,
        "part_zero_z": lathe.workpiece.zero_z,
        "stock_radius_steps": lathe.workpiece.stock.radius,
        "stock_length_steps": lathe.workpiece.stock.length,
        "stock_allowance_steps": lathe.workpiece.stock.allowance,
        "step_x_nm": step_nm,
        "step_z_nm": step_nm,
    }


def write_report(lathe: VirtualLathe, step_nm: int) -> dict[str, Any]:
    """Return the report as the contract wants it, for JSON."""
    work = lathe.workpiece
    lost = {name: lathe.lost_steps(name) for name in AxisName}
    stops = [f for f in lathe.faults if f.kind == FaultKind.END_STOP]
    crashes = [crash.as_dict() for crash in work.crashes]
    if stops:
        first = stops[0]
        crashes.append(
            {
                "kind": f"end stop {first.axis.name}",
                "seconds": first.cycle / CYCLES_PER_SECOND,
                "steps": len(stops),
            }
        )
    cost = lathe.interrupt_cost()
    wanted = lathe.wanted
    ruler = Ruler(work.surface(wanted), wanted, step_nm, step_nm) if wanted else None
    return {
        "virtual_seconds": lathe.seconds,
        "wall_seconds": time.monotonic() - lathe.wall_start,
        "cycles": lathe.chip.cycle,
        "lost_steps": sum(lost.values()),
        "lost_steps_x": lost[AxisName.X],
        "lost_steps_z": lost[AxisName.Z],
        "crashes": crashes,
        "gouge_max_steps": work.gouge_max_steps(wanted) if wanted else None,
        "left_max_steps": work.left_max_steps(wanted) if wanted else None,
        "profile": work.profile(step_nm, step_nm, wanted),
        "dimensions": ruler.dimensions() if ruler else [],
        "angles": ruler.angles() if ruler else [],
        "circles": ruler.circles() if ruler else [],
        "tool": work.tool.name,
        "nose_radius_mm": round(work.tool.nose * step_nm / 1e6, 6),
        "steps_cutting": work.steps_cutting,
        "setup": _setup(lathe, step_nm),
        "slide_x": lathe.machine.axis(AxisName.X).slide,
        "slide_z": lathe.machine.axis(AxisName.Z).slide,
        "usb_errors": lathe.host.mistakes,
        "usb_counts": lathe.host.counts,
        "interrupt_worst_cycles": cost.worst,
        "interrupt_entries": cost.entries,
        "stack_depth_max": lathe.chip.stack_depth_max,
        "resets": [[cycle, kind.name] for cycle, kind in lathe.chip.resets],
        "nonvolatile": lathe.chip.nonvolatile_counts,
        "panel": list(lathe.panel.lines()) if lathe.options.panel else None,
        "checks": {check.name: list(check.broken) for check in lathe.checks()},
    }
