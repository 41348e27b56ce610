# SPDX-License-Identifier: Apache-2.0
"""The examples of docs/protocol.md are what the implementation sends and receives."""

import re
from pathlib import Path

import pytest
from scripted_chip import ScriptedChip
from scripted_loader import ScriptedSocket

from tornillo.frames import Frame, crc16, decode, encode
from tornillo.loader import Loader, LoaderRefusedError
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol import FRAME_RESPONSE_BIT, Command

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "protocol.md").read_text(encoding="utf-8")
FIELD = re.compile(r"^(seq|code|payload|body|wire) *((?:[0-9a-f]{2}\s*)*)", re.MULTILINE)


def frame_examples() -> list[dict[str, bytes]]:
    """Every frame block of the page, field by field."""
    blocks = re.findall(r"```frame\n(.*?)```", PAGE, re.DOTALL)
    return [
        {name: bytes.fromhex(digits) for name, digits in FIELD.findall(block)} for block in blocks
    ]


def image_example() -> bytes:
    """The part image of the page."""
    found = re.search(r"```image\n(.*?)```", PAGE, re.DOTALL)
    assert found is not None
    return bytes.fromhex(found[1])


EXAMPLES = frame_examples()


def test_the_page_shows_requests_and_responses() -> None:
    assert len(EXAMPLES) >= 12


@pytest.mark.parametrize("example", EXAMPLES)
def test_every_frame_of_the_page_is_what_the_implementation_makes_of_it(
    example: dict[str, bytes],
) -> None:
    frame = Frame(example["seq"][0], example["code"][0], example["payload"])
    assert encode(frame) == example["wire"]
    assert decode(example["wire"][:-1]) == frame
    body = example["seq"] + example["code"] + example["payload"]
    assert example["body"] == body + crc16(body).to_bytes(2, "little")


@pytest.mark.parametrize(
    ("request_example", "response_example"), list(zip(EXAMPLES[::2], EXAMPLES[1::2], strict=True))
)
def test_every_response_of_the_page_belongs_to_its_request(
    request_example: dict[str, bytes], response_example: dict[str, bytes]
) -> None:
    assert response_example["seq"] == request_example["seq"]
    assert response_example["code"][0] == request_example["code"][0] | FRAME_RESPONSE_BIT


def test_the_chip_model_gives_the_answers_of_the_page() -> None:
    chip = ScriptedChip()
    for command in (Command.HELLO, Command.STATUS):
        asked, answered = next(
            pair
            for pair in zip(EXAMPLES[::2], EXAMPLES[1::2], strict=True)
            if pair[0]["code"][0] == command
        )
        assert chip.execute(command, asked["payload"]) == answered["payload"]


def test_the_image_of_the_page_is_that_of_the_test_bar(test_bar: Path, machine: Machine) -> None:
    image = Part.load(test_bar).image(machine)
    assert image_example() == image
    assert f"{len(image)} bytes, CRC 0x{crc16(image):04X}" in PAGE


def test_the_upload_of_the_page_announces_and_sends_that_image() -> None:
    image = image_example()
    payloads = {example["code"][0]: example["payload"] for example in reversed(EXAMPLES)}
    announced = len(image).to_bytes(2, "little") + crc16(image).to_bytes(2, "little")
    assert payloads[Command.UPLOAD_BEGIN] == announced
    assert payloads[Command.UPLOAD_DATA] == bytes(2) + image[:32]
    stored = payloads[Command.UPLOAD_COMMIT | FRAME_RESPONSE_BIT]
    assert stored == bytes(2) + crc16(image).to_bytes(2, "little")


def test_the_packets_of_the_page_are_those_of_host_and_boot_loader(socket: ScriptedSocket) -> None:
    blocks = re.findall(r"```packets\n(.*?)```", PAGE, re.DOTALL)
    packets = [bytes.fromhex(line) for block in blocks for line in block.splitlines()]
    answered: list[bytes] = []
    answer = socket.loader.answer

    def remember(packet: bytes) -> bytes:
        answered.extend((packet, answer(packet)))
        return answered[-1]

    vars(socket.loader)["answer"] = remember
    socket.in_loader = True
    loader = Loader(socket.open(socket.port))
    loader.identify()
    loader.write(0x0840, bytes(range(32)))
    loader.read(0x0840)
    with pytest.raises(LoaderRefusedError):
        loader.go()
    assert packets == answered
