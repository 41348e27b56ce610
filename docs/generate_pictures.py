#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Write the pictures of the documentation, all of them made by the tools they show.

    python3 docs/generate_pictures.py

The live view is that of the pawn being cut on the virtual lathe, 40 simulated seconds into the
run; simulated time makes the picture the same every time.
"""

import re
import subprocess
import sys
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

from click.testing import CliRunner
from rich.console import Console
from rich.text import Text
from tornillo import Lathe, Machine, Part
from tornillo.cli import main as tornillo
from tornillo.commands.jog_pad import frame as jog_frame
from tornillo.commands.watch import View
from tornillo.drawing import draw_part
from tornillo.jogging import JogPad
from tornillo.protocol import SettingId, State
from tornillo.units import Scale
from virtual_lathe.lathe import Options, VirtualLathe

DOCS = Path(__file__).resolve().parent
IMAGES = DOCS / "images"
EXAMPLES = DOCS.parent / "host-cli" / "examples"
WIDE, POLL_S, CUTTING_S = 104, 0.1, 40.0
#: What is typed into `tornillo new`, and how many of its last lines are shown.
ANSWERS = [
    *("knob", "mm", "20", "40", "", "", "", "", "", "", "", ""),
    *("cylinder", "0", "-20", "12"),
    *("profile", "-20", "12", "-25", "16", "line", "rounded", "2", "y"),
    *("-30", "16", "line", "sharp", "n"),
    *("groove", "-10", "-13", "8", "2"),
    "done",
]
LAST = 38
#: The program brings its own font from the net; the pages have one of their own.
FONT = re.compile(r"@font-face \{.*?\}\s*", re.DOTALL)


def recorder() -> Console:
    """A terminal that remembers what it shows."""
    return Console(
        record=True, width=WIDE, force_terminal=True, color_system="truecolor", file=StringIO()
    )


def save(console: Console, name: str, title: str) -> None:
    """Write a remembered screen as a picture."""
    text = console.export_svg(title=title, unique_id=name)
    (IMAGES / f"{name}.svg").write_text(FONT.sub("", text), encoding="utf-8")


def drawings() -> None:
    """The workshop drawings."""
    machine = Machine.load()
    draw_part(Part.load(EXAMPLES / "test-bar.toml"), machine, IMAGES / "test-bar.png")
    for name in ("pockets", "disc"):
        draw_part(Part.load(DOCS / "parts" / f"{name}.toml"), machine, IMAGES / f"{name}.png")


def imported() -> None:
    """What the import of a drawing shows."""
    out = DOCS.parent / "build" / "pawn.toml"
    out.parent.mkdir(exist_ok=True)
    arguments = ["import-dxf", str(EXAMPLES / "pawn.dxf"), "-o", str(out), "--force"]
    arguments += ["--back-clearance", "52", "--picture", str(IMAGES / "pawn-import.png")]
    result = CliRunner().invoke(tornillo, arguments)
    if result.exit_code:
        raise SystemExit(result.output)


def help_screen() -> None:
    """`tornillo --help`."""
    console = recorder()
    shown = CliRunner().invoke(tornillo, ["--help"], prog_name="tornillo", terminal_width=WIDE)
    console.print(Text("$ tornillo --help", "bold"))
    console.print(Text(shown.stdout.rstrip()))
    save(console, "help", "tornillo")


def new_screen() -> None:
    """The end of a conversation with `tornillo new`."""
    console = recorder()
    with TemporaryDirectory() as folder:
        typed = "\n".join(ANSWERS) + "\n"
        shown = CliRunner(echo_stdin=True).invoke(
            tornillo, ["new", f"{folder}/knob.toml"], input=typed
        )
    if shown.exit_code:
        raise SystemExit(shown.output)
    lines = shown.stdout.rstrip().splitlines()
    console.print(Text("\n".join(lines[-LAST:-1])))
    save(console, "new", "tornillo new")


def live_screens() -> None:
    """`tornillo jog` of a lathe that waits, `tornillo watch` and the panel of one that cuts."""
    path = EXAMPLES / "pawn.toml"
    lathe = VirtualLathe(Options(part=path, backlash_x=23, backlash_z=31, panel=True))
    lathe.plug()
    with Lathe(lathe.port) as chip:
        chip.set_setting(SettingId.PANEL, 1)
        slot = chip.upload(Part.load(path).image(chip.machine()))
        chip.home()
        while chip.status().state is State.HOMING:
            lathe.run(POLL_S)
        pad = JogPad(chip, Scale("mm", chip.machine()), rapid=1000, most=1000)
        console = recorder()
        console.print(jog_frame(pad, chip.status()))
        save(console, "jog", "tornillo jog")
        view = View(chip, "mm")
        view.readout.follow(chip.status())
        chip.run(slot)
        lathe.run(CUTTING_S)
        view.readout.follow(chip.status())
        lathe.run(POLL_S)
        status = chip.status()
        view.readout.follow(status)
        console = recorder()
        console.print(view.frame(status, WIDE))
        save(console, "watch", "tornillo watch")
        lathe.panel.picture(IMAGES / "panel.svg")


def main() -> int:
    """Write all of them."""
    drawings()
    imported()
    help_screen()
    new_screen()
    live_screens()
    shown = subprocess.run(
        ["git", "-C", str(DOCS), "status", "--short", "images"],
        capture_output=True,
        text=True,
        check=False,
    )
    print(shown.stdout or "pictures are as they were")
    return 0


if __name__ == "__main__":
    sys.exit(main())
