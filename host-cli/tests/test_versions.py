# SPDX-License-Identifier: Apache-2.0
"""Old and new firmware, and ports with something else at their end."""

from collections.abc import Callable
from pathlib import Path

import pytest
from console import Tornillo
from scripted_chip import ScriptedChip, ScriptedPort

from tornillo import Lathe, __version__
from tornillo.errors import ChipError, NoAnswerError, VersionError
from tornillo.holders import Holder
from tornillo.protocol import PROTOCOL_VERSION, Command, ErrorCode

Open = Callable[[], Lathe]


@pytest.fixture
def opened(port: ScriptedPort, monkeypatch: pytest.MonkeyPatch) -> Open:
    """Open the lathe at the scripted port, which is called COM3."""
    monkeypatch.setattr("tornillo.lathe.open_port", lambda *_arguments: port)
    monkeypatch.setattr("tornillo.versions.holders", lambda _port: [])
    return lambda: Lathe.open("COM3")


@pytest.mark.parametrize(
    ("protocol", "word", "remedy"),
    [
        (PROTOCOL_VERSION - 1, "older", f"update the firmware to that of tornillo {__version__}"),
        (PROTOCOL_VERSION + 1, "newer", "update tornillo: install host-cli from the release"),
        (255, "newer", "that the firmware 7.8.9 came with"),
    ],
)
def test_another_protocol_is_refused_naming_both_versions_and_the_remedy(
    opened: Open, chip: ScriptedChip, protocol: int, word: str, remedy: str
) -> None:
    chip.protocol = protocol
    chip.firmware = (7, 8, 9)
    with pytest.raises(VersionError) as caught:
        opened()
    assert str(caught.value) == (
        f"the firmware 7.8.9 speaks protocol {protocol}, {word} than protocol "
        f"{PROTOCOL_VERSION} of tornillo {__version__}"
    )
    assert remedy in caught.value.remedy


def test_the_versions_are_told_from_the_first_four_bytes_whatever_follows(
    opened: Open, chip: ScriptedChip
) -> None:
    chip.refusals[Command.HELLO] = bytes([0, PROTOCOL_VERSION + 3, 2, 0, 1]) + b"?" * 50
    with pytest.raises(
        VersionError, match=rf"the firmware 2\.0\.1 speaks protocol {PROTOCOL_VERSION + 3}, newer"
    ):
        opened()


@pytest.mark.parametrize("answer", [b"\0", b"\0\x01", b"\0\x01\x00\x02"])
def test_a_hello_without_versions_is_an_old_firmware(
    opened: Open, chip: ScriptedChip, answer: bytes
) -> None:
    chip.refusals[Command.HELLO] = answer
    with pytest.raises(VersionError, match="does not tell its version; tornillo") as caught:
        opened()
    assert "update the firmware" in caught.value.remedy


@pytest.mark.parametrize("code", [ErrorCode.UNKNOWN_COMMAND, ErrorCode.BAD_LENGTH])
def test_a_firmware_that_refuses_hello_is_an_old_one(
    opened: Open, chip: ScriptedChip, code: ErrorCode
) -> None:
    chip.refusals[Command.HELLO] = bytes([code])
    with pytest.raises(VersionError, match=f"answers HELLO with {code.name}: its version is unkn"):
        opened()


def test_silence_names_the_port_both_remedies_and_our_version(
    opened: Open, port: ScriptedPort
) -> None:
    port.lose_answers = 100
    with pytest.raises(NoAnswerError) as caught:
        opened()
    assert str(caught.value) == (
        f"nothing answers at COM3; tornillo {__version__} speaks protocol {PROTOCOL_VERSION}"
    )
    assert "plug the cable out and in again" in caught.value.remedy
    assert "its firmware is too old" in caught.value.remedy
    assert port.closed


def test_another_device_that_talks_is_told_from_a_silent_one(
    opened: Open, port: ScriptedPort
) -> None:
    port.lose_answers = 100
    port.inject(b"ok Grbl 1.1\r\n")
    with pytest.raises(NoAnswerError, match="what answers at COM3 sends 13 bytes and no frame"):
        opened()


def test_a_program_that_listens_too_is_named_when_nothing_answers(
    opened: Open, port: ScriptedPort, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tornillo.versions.holders", lambda _port: [Holder("screen", 42)])
    port.lose_answers = 100
    with pytest.raises(NoAnswerError) as caught:
        opened()
    assert "screen (process 42) has the port open too" in caught.value.remedy


def test_a_command_that_the_firmware_lacks_is_refused_naming_both_versions(
    opened: Open, chip: ScriptedChip
) -> None:
    chip.unknown = {Command.SERIAL_SET}
    with opened() as lathe, pytest.raises(ChipError) as caught:
        lathe.set_serial_number("LATHE-07")
    assert f"(firmware 0.1.0, tornillo {__version__})" in str(caught.value)
    assert caught.value.code is ErrorCode.UNKNOWN_COMMAND
    assert "update the firmware" in caught.value.remedy


def test_the_command_line_shows_message_and_remedy(
    tornillo: Tornillo, chip: ScriptedChip, test_bar: Path
) -> None:
    chip.protocol = PROTOCOL_VERSION + 1
    result = tornillo("upload", test_bar)
    assert result.exit_code == 1
    assert f"Error: the firmware 0.1.0 speaks protocol {PROTOCOL_VERSION + 1}, newer" in (
        result.stderr
    )
    assert "Try: update tornillo" in result.stderr
