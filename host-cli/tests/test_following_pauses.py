# SPDX-License-Identifier: Apache-2.0
"""What a run that pauses asks the operator for, told while it is followed."""

import pytest
from console import Tornillo
from scripted_chip import IDLE, ScriptedChip

from tornillo import Lathe
from tornillo.commands.following import STEP_MESSAGE, asked_for, pause_message
from tornillo.errors import LinkError
from tornillo.image import PartImage
from tornillo.protocol import IMAGE_HEADER, ImageHeader, PauseRecord, State, ToolRecord
from tornillo.status import Status

HEADER = ImageHeader(2, 3, 0, 0, b"pauses", 7112, 7112, 1000, 4000, 10, 100)
PAUSED = IDLE._replace(state=State.PAUSE, slot=0, operation=2, operations=3)


def tool(name: bytes) -> ToolRecord:
    """A tool called `name`."""
    return ToolRecord(0, name, 0, 0, 0, 65535, 65535, 0, 0)


IMAGE = PartImage(
    HEADER,
    (tool(b"left"), PauseRecord(0, b""), PauseRecord(1, b"drill 3 mm"), PauseRecord(0, b"turn")),
)


@pytest.mark.parametrize(
    ("operation", "text"), [(1, STEP_MESSAGE), (2, "drill 3 mm"), (3, "turn"), (4, STEP_MESSAGE)]
)
def test_a_pause_says_itself_what_it_asks_for(operation: int, text: str) -> None:
    assert asked_for(IMAGE, operation) == text


def test_a_pause_of_no_part_is_a_step(lathe: Lathe) -> None:
    assert pause_message(lathe, Status.from_data(PAUSED._replace(slot=255))) == STEP_MESSAGE


def test_following_tells_once_what_the_operator_is_asked_for(
    tornillo: Tornillo, chip: ScriptedChip
) -> None:
    chip.slots[0] = IMAGE.pack()
    chip.coming = [PAUSED, PAUSED, IDLE._replace(permille=1000)]
    chip.status = PAUSED
    result = tornillo("resume", "--follow")
    assert result.exit_code == 0
    assert "operation 2 of 3, paused: drill 3 mm; go on with RUN or" in result.stderr
    assert result.stderr.count("drill 3 mm") == 1


def test_a_stored_part_that_this_host_does_not_know_is_told(
    lathe: Lathe, chip: ScriptedChip
) -> None:
    image = bytearray(IMAGE.pack())
    image[IMAGE_HEADER.size] = 99
    chip.slots[0] = bytes(image)
    with pytest.raises(LinkError, match="the part in slot 0 cannot be understood"):
        lathe.image(0)
