# SPDX-License-Identifier: Apache-2.0
"""A virtual lathe and a command line, each a process of its own, joined by a pseudo-terminal."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from types import TracebackType
from typing import Any

#: Wall seconds after which a process is taken for stuck; nothing here comes near it.
STUCK_S = 240
ZERO_X, ZERO_Z = -330, -80
PIN = """
[part]
name = "pin"
units = "mm"
[stock]
diameter = 4.0
length = 6.0
allowance = 0.2
[cut]
depth_of_cut = 0.3
finish_allowance = 0.05
feed = 300.0
finish_feed = 200.0
retract = 0.1
[[operation]]
type = "face"
z = 0.0
[[operation]]
type = "cylinder"
z = [0.0, {end}]
diameter = {diameter}
"""


def pin_file(path: Path, end: float = -1.5, diameter: float = 3.0) -> Path:
    """Write the part file of a small faced pin."""
    path.write_text(PIN.format(end=end, diameter=diameter), encoding="utf-8")
    return path


class Workshop:
    """A lathe that is switched on; leaving the ``with`` block switches it off.

    ``report`` holds the report of the virtual lathe afterwards.
    """

    def __init__(self, folder: Path, *options: str) -> None:
        """Switch the lathe on; ``options`` go to the virtual lathe."""
        self.port = folder / "port"
        self.report: dict[str, Any] = {}
        self._report = folder / "report.json"
        command = [
            *[sys.executable, "-m", "virtual_lathe"],
            *["--port-link", str(self.port), "--report", str(self._report)],
            *["--start-x", "-30", "--start-z", "-30"],
            *["--part-zero-x", str(ZERO_X), "--part-zero-z", str(ZERO_Z)],
            *["--stock-diameter", "4", "--stock-length", "6", "--stock-allowance", "0.2"],
            *options,
        ]
        self._lathe = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        assert self._lathe.stdout is not None
        #: The first line of the virtual lathe: where its port is.
        self.announced = self._lathe.stdout.readline().strip()
        assert self.announced.startswith(("port: ", "usbip: "))

    def __enter__(self) -> Workshop:
        """Return the workshop."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Switch off and read the report, unless that was done before."""
        if not self.report:
            self.switch_off()

    def switch_off(self) -> None:
        """Switch off and read the report."""
        if self._lathe.poll() is None:
            self._lathe.terminate()
        self.wait()

    def wait(self) -> None:
        """Wait until the lathe has ended by itself and read the report."""
        _, _ = self._lathe.communicate(timeout=STUCK_S)
        assert self._lathe.returncode == 0
        self.report = json.loads(self._report.read_text(encoding="utf-8"))

    def type(self, line: str) -> None:
        """Type a line at the virtual lathe: press a button, move the cable."""
        assert self._lathe.stdin is not None
        self._lathe.stdin.write(line + "\n")
        self._lathe.stdin.flush()

    def tornillo(self, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
        """Run the command line and return what came of it."""
        command = [Path(sys.executable).parent / "tornillo", "--port", self.port, *arguments]
        return subprocess.run(
            command,
            capture_output=True,
            text=True,
            timeout=STUCK_S,
            check=False,
            env=os.environ
            | {"COLUMNS": "200", "NO_COLOR": "1", "TERM": "dumb", "TORNILLO_LANG": "en"},
        )

    def must(self, *arguments: str | Path) -> str:
        """Run the command line, which must succeed, and return its standard output."""
        done = self.tornillo(*arguments)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    def json(self, *arguments: str | Path) -> Any:
        """Return what a command prints with ``--json``."""
        return json.loads(self.must(*arguments, "--json"))

    def set_up(self) -> None:
        """Tell the lathe where the part's zero is."""
        for name, value in (("zero_x", ZERO_X), ("zero_z", ZERO_Z), ("homing_repeats", 1)):
            self.must("settings", "set", name, str(value))

    def assert_part_is_right(self) -> None:
        """Check the report: every dimension to a step, nothing lost, crashed or gouged."""
        report = self.report
        assert len(report["dimensions"]) == 3
        assert all(abs(entry["error_steps"]) < 1 for entry in report["dimensions"])
        assert report["lost_steps"] == 0
        assert report["crashes"] == []
        assert report["gouge_max_steps"] == 0
        assert {name: broken for name, broken in report["checks"].items() if broken} == {}
