# SPDX-License-Identifier: Apache-2.0
"""Every verb of the command line: its section in the help, its module, what it does in short.

This is all that `tornillo --help` and the shell's completion need, so that nothing else is
imported for them. A verb stands in `VERBS` of its module in `tornillo.commands`.
"""

from typing import NamedTuple


class Verb(NamedTuple):
    """`module` of `tornillo.commands` that has it; `summary` in at most 60 characters."""

    module: str
    summary: str


SECTIONS: dict[str, dict[str, Verb]] = {
    "Parts on the computer": {
        "new": Verb("new", "Make a part by answering questions."),
        "import-dxf": Verb("import_dxf", "Make a part file from a DXF drawing."),
        "check": Verb("parts", "Say whether a part can be made, and what is wrong with it."),
        "plan": Verb("planning", "List the passes that a part takes, and how long."),
        "draw": Verb("drawing", "Draw a part: stock, finished shape, passes, dimensions."),
    },
    "Parts in the lathe": {
        "upload": Verb("parts", "Store a part in the lathe and verify it."),
        "parts": Verb("parts", "List the stored parts."),
        "select": Verb("parts", "Choose the part that the RUN button cuts."),
        "download": Verb("parts", "Read a stored part back as a part file."),
        "delete": Verb("parts", "Delete a stored part."),
    },
    "Cutting": {
        "home": Verb("running", "Find the limit switches and measure the dead steps."),
        "jog": Verb("moving", "Move the slides by keys, or one by a distance."),
        "goto": Verb("moving", "Move the tool to a place of the part."),
        "touch": Verb("moving", "Touch the work with the tool; set part zero."),
        "zero": Verb("settings", "Tell the lathe where the tool stands."),
        "run": Verb("running", "Cut a part."),
        "hold": Verb("running", "Stop the run so that it can go on."),
        "resume": Verb("running", "Go on after a hold or a pause."),
        "override": Verb("running", "Change the feed of the run."),
        "stop": Verb("running", "End the run or the homing."),
        "reset": Verb("running", "Acknowledge an alarm."),
        "status": Verb("running", "Show what the lathe does and where the tool is."),
        "watch": Verb("watch", "Show it live, with the part; hold and go on by key."),
    },
    "Setting up": {
        "doctor": Verb("doctor", "Check port, firmware, settings, switches and buttons."),
        "calibrate": Verb("calibrate", "Measure dead steps, switch travel and step size."),
        "settings": Verb("settings", "List, read or change the settings of the lathe."),
        "flash": Verb("flash", "Give the chip another firmware over USB."),
        "serial": Verb("system", "Show or change the serial number."),
        "udev": Verb("system", "Print or install the udev rule for Linux."),
        "completion": Verb("completion", "Print what completes commands in your shell."),
    },
}
VERBS: dict[str, Verb] = {name: verb for verbs in SECTIONS.values() for name, verb in verbs.items()}
