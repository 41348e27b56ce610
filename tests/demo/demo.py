# SPDX-License-Identifier: Apache-2.0
"""`make demo`: the test bar of the thesis, from its file to a measured piece of metal.

Everything goes the way it goes on a real lathe: commands and parts through the serial port, RUN
with the button, steps through the motor pins. What is judged comes from outside of the chip: the
virtual workpiece, and the pins recorded in the trace.

Leaves build/demo/report.json, part.svg, part.png, trace.vcd and lathe.log. Exit code 1, with the
reasons, when anything is off by more than one step.
"""

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from lathe_process import LatheError, LatheProcess
from picture import draw
from rich.console import Console
from rich.table import Table
from tornillo import Lathe, Part, TornilloError
from tornillo.commands.following import follow_run
from tornillo.outline import outline
from tornillo.protocol import State
from tornillo.units import NM_PER_UNIT
from verdict import DeadSteps, faults, table
from virtual_lathe import decode_vcd

OUT = Path("build/demo")
PART = Path("host-cli/examples/test-bar.toml")
SCREWS = DeadSteps(x=23, z=31)
STOCK_MM = ("--stock-diameter", "25.4", "--stock-length", "50.8")
TORNILLO = str(Path(sys.executable).with_name("tornillo"))
START_S = 10.0
NM_PER_MM = 1e6

console = Console(highlight=False, soft_wrap=True)


class DemoError(Exception):
    """The demo cannot go on."""


def say(text: str) -> None:
    """Announce the next part of the story."""
    console.print(f"\n[bold]{text}[/bold]")


def tornillo(*arguments: str) -> None:
    """Run the command as a user would, and show it.

    Raises DemoError when it fails.
    """
    console.print(f"$ tornillo {' '.join(arguments)}", style="cyan")
    if subprocess.run([TORNILLO, *arguments], check=False).returncode != 0:
        raise DemoError(f"`tornillo {' '.join(arguments)}` failed")


def cut(lathe_process: LatheProcess) -> DeadSteps:
    """Store the part, home, press RUN and wait for the end; return the measured dead steps."""
    port = ("--port", str(lathe_process.port))
    say("2. The part goes into the lathe, through the USB serial port")
    tornillo(*port, "upload", str(PART))
    say("3. Homing finds the limit switches, X first, and measures the dead steps of the screws")
    tornillo(*port, "home")
    console.print(f"the virtual screws have X {SCREWS.x}, Z {SCREWS.z}")
    say("4. Somebody presses RUN")
    with Lathe.open(str(lathe_process.port)) as lathe:
        lathe_process.press("run")
        give_up = time.monotonic() + START_S
        while lathe.status().state is not State.RUNNING:
            if time.monotonic() > give_up:
                raise DemoError("the RUN button did not start the part")
        follow_run(lathe)
        status = lathe.status()
    return DeadSteps(status.dead_x, status.dead_z)


def decode(report: dict[str, Any]) -> int:
    """At how many steps of Z the motor pins tell another profile than the report."""
    setup = report["setup"]
    bench = decode_vcd.Bench(
        decode_vcd.Screw(setup["start_x"], SCREWS.x, setup["slack_x"]),
        decode_vcd.Screw(setup["start_z"], SCREWS.z, setup["slack_z"]),
        setup["part_zero_x"],
        setup["part_zero_z"],
        setup["stock_radius_steps"],
        setup["stock_length_steps"],
        setup["stock_allowance_steps"],
    )
    pins = decode_vcd.cut_profile(OUT / "trace.vcd", bench)
    metal = decode_vcd.expand(report["profile"], setup["step_x_nm"], setup["step_z_nm"])
    console.print(f"RB0..3 and RD0..3 of {OUT}/trace.vcd: {len(pins)} steps of Z decoded")
    return sum(a != b for a, b in zip(pins, metal, strict=False)) + abs(len(pins) - len(metal))


def wanted() -> list[tuple[float, float]]:
    """The finished part as (z, diameter) in mm, from the free end to the chuck."""
    part = Part.load(PART)
    unit = NM_PER_UNIT[part.units] / NM_PER_MM
    return [
        (place.z * unit, 2 * place.x * unit)
        for piece in outline(part)
        for place in (piece.start, piece.end)
    ]


def show(report: dict[str, Any]) -> None:
    """Print what was wanted and what was cut."""
    heads = ("", "wanted mm", "cut mm", "wanted inch", "cut inch", "error, steps")
    printed = Table(*heads, box=None, header_style="bold", pad_edge=False)
    for column in printed.columns[1:]:
        column.justify = "right"
    for row in table(report):
        printed.add_row(*row)
    console.print(printed)
    console.print("wanted: the whole step of the screw (7.112 um) nearest to the part file")
    console.print(
        f"lost steps {report['lost_steps']}, deepest gouge {report['gouge_max_steps']:g} steps, "
        f"crashes {len(report['crashes'])}; {report['virtual_seconds']:.0f} s on the lathe, "
        f"{report['wall_seconds']:.0f} s on the clock"
    )


def story() -> list[str]:
    """Tell it; return what is wrong with the result."""
    OUT.mkdir(parents=True, exist_ok=True)
    say("1. A part, checked and drawn")
    tornillo("check", str(PART))
    tornillo("draw", str(PART), "-o", str(OUT / "part.svg"))
    tornillo("draw", str(PART), "-o", str(OUT / "part.png"))
    say("   A virtual lathe is switched on: the firmware on a simulated chip, and a bar of metal")
    report_file = OUT / "report.json"
    report_file.unlink(missing_ok=True)
    options = (
        *("--vcd", str(OUT / "trace.vcd"), "--report", str(report_file), "--part", str(PART)),
        *("--backlash-x", str(SCREWS.x), "--backlash-z", str(SCREWS.z), *STOCK_MM),
    )
    with LatheProcess(OUT / "port", OUT / "lathe.log", *options) as lathe_process:
        measured = cut(lathe_process)
    report = json.loads(report_file.read_text(encoding="utf-8"))
    say("5. What became of the bar")
    show(report)
    say("6. What the motor pins alone tell")
    differ = decode(report)
    draw(OUT / "part.png", report, wanted())
    return faults(report, measured, SCREWS, differ)


def main() -> int:
    """Run the demo; return the exit code."""
    try:
        found = story()
    except (DemoError, LatheError, TornilloError) as error:
        found = [str(error)]
    for fault in found:
        console.print(f"demo: {fault}", style="red")
    if found:
        return 1
    console.print("they tell the same profile as the metal\n")
    console.print(f"[bold green]good[/bold green]: see {OUT}/part.png and {OUT}/report.json")
    return 0


if __name__ == "__main__":
    sys.exit(main())
