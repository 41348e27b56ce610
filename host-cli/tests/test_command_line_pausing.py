# SPDX-License-Identifier: Apache-2.0
"""Parts that pause: what they ask for, and how they go on."""

import json
from pathlib import Path

import pytest
from console import Tornillo
from scripted_chip import IDLE, ScriptedChip

from tornillo.protocol import State

CUTTING = IDLE._replace(
    state=State.RUNNING, slot=0, operation=1, operations=3, pass_number=1, passes=4, permille=100
)
FINISHED = IDLE._replace(slot=0, permille=1000)
PAUSING = """\
[part]
name = "pausing"
units = "mm"
[stock]
diameter = 20
length = 30
[cut]
depth_of_cut = 1
feed = 100
retract = 0.5
[[tool]]
name = "turning"
[[tool]]
name = "parting"
width = 2
[[operation]]
type = "cylinder"
z = [0, -10]
diameter = 15
[[operation]]
type = "pause"
message = "measure it"
[[operation]]
type = "groove"
z = [-5, -8]
diameter = 10
tool = "parting"
"""


@pytest.fixture
def pausing(tornillo: Tornillo, chip: ScriptedChip, tmp_path: Path) -> ScriptedChip:
    """A chip with a part of four operations, one of them a pause, and two tools."""
    path = tmp_path / "pausing.toml"
    path.write_text(PAUSING, encoding="utf-8")
    assert tornillo("upload", path).exit_code == 0
    chip.selected = 0
    return chip


@pytest.mark.parametrize(
    ("operation", "message"),
    [(2, "measure it"), (3, "put in the tool parting"), (1, "step by step"), (9, "step by step")],
)
def test_a_pause_tells_what_it_asks_for(
    tornillo: Tornillo, pausing: ScriptedChip, operation: int, message: str
) -> None:
    paused = CUTTING._replace(state=State.PAUSE, operation=operation, operations=3, passes=0)
    pausing.coming = [paused, paused, FINISHED]
    result = tornillo("run", "--follow")
    assert result.exit_code == 0
    wanted = f" 10.0 %  operation {operation} of 3, paused: {message}"
    assert result.stderr.startswith(wanted)
    assert "go on with RUN or `tornillo resume`" in result.stderr
    pausing.status = paused
    [line] = [row for row in tornillo("status").stdout.splitlines() if "waits for" in row]
    assert message in line
    values = json.loads(tornillo("status", "--json").stdout)
    assert (values["state"], values["message"][: len(message)]) == ("PAUSE", message)


def test_resume_goes_on_after_a_pause(tornillo: Tornillo, pausing: ScriptedChip) -> None:
    pausing.status = CUTTING._replace(state=State.PAUSE, slot=0xFF)
    assert "step by step" in tornillo("status").stdout
    assert "running" in tornillo("resume").stdout
    assert pausing.status.state == State.RUNNING
