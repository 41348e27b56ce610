# SPDX-License-Identifier: Apache-2.0
"""The dialogue with the boot loader: packets, repetition, refusals, time."""

from pathlib import Path
from typing import Any

import pytest
from hex_files import firmware_file, program
from scripted_loader import ScriptedSocket

from tornillo import updating
from tornillo.errors import LoaderError
from tornillo.firmware_file import BLOCK, FIRST, Firmware
from tornillo.frames import crc16
from tornillo.link import REQUEST_S
from tornillo.loader import (
    PIECE,
    Identity,
    Loader,
    LoaderCommand,
    LoaderRefusedError,
    LoaderResult,
    answers,
)
from tornillo.updating import UPDATE_S, check_fits, write_whole

BEHIND_THE_HEADER = FIRST + BLOCK


@pytest.fixture
def loader(socket: ScriptedSocket) -> Loader:
    """The dialogue with a chip that waits in its boot loader."""
    socket.in_loader = True
    return Loader(socket.open(socket.port))


@pytest.fixture
def firmware(tmp_path: Path) -> Firmware:
    """A firmware to write."""
    return Firmware.load(str(firmware_file(tmp_path)))


def test_requests_are_packets_as_the_protocol_page_has_them(
    loader: Loader, socket: ScriptedSocket
) -> None:
    assert loader.identify() == Identity(1, 1, 0x0800, 0x8000, whole=True)
    assert loader.read(0x0840) == bytes(socket.loader.flash[0x0840:0x0860])
    loader.write(0x0840, bytes(range(PIECE)))
    assert socket.loader.flash[0x0840:0x0860] == bytes(range(PIECE))
    sent = [b"I\x00\x00", b"R\x40\x08", b"W\x40\x08" + bytes(range(PIECE))]
    assert socket.loader.asked == [body + crc16(body).to_bytes(2, "little") for body in sent]
    assert (loader.repeats, socket.now) == (0, 0.0)


def test_the_clock_may_be_another_one(socket: ScriptedSocket) -> None:
    ticks = iter(range(1000))
    socket.unplugged = socket.usb = False
    socket.lose_answers = 1000
    socket.in_loader = True
    with pytest.raises(LoaderError, match="does not answer"):
        Loader(socket.open(socket.port), timeout_s=10, clock=lambda: next(ticks)).identify(tries=3)
    assert len(socket.loader.asked) == 3
    assert next(ticks) >= 30


def test_lost_answers_are_asked_for_again(loader: Loader, socket: ScriptedSocket) -> None:
    socket.lose_answers = 4
    assert loader.identify().whole
    assert (loader.repeats, len(socket.loader.asked)) == (4, 5)
    assert socket.now <= REQUEST_S


def test_damaged_requests_are_sent_again(loader: Loader, socket: ScriptedSocket) -> None:
    socket.damage_requests = 3
    assert loader.read(0x0840) == bytes(socket.loader.flash[0x0840:0x0860])
    assert loader.repeats == 3


def test_a_blocked_write_is_a_try(loader: Loader, socket: ScriptedSocket) -> None:
    socket.blocked_writes = 2
    assert loader.identify().whole
    assert loader.repeats == 2


def test_what_stood_on_the_line_before_does_no_harm(loader: Loader, socket: ScriptedSocket) -> None:
    socket.outgoing += b"OK\r\nIII"
    assert loader.identify().board == 1
    assert loader.repeats == 0


def test_an_answer_that_comes_late_is_not_taken_for_the_next_one(
    loader: Loader, socket: ScriptedSocket, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = (bytes(socket.loader.flash[at : at + PIECE]) for at in (0x0840, 0x0860))
    late = socket.loader.answer
    kept: list[bytes] = []

    def delay(packet: bytes) -> bytes:
        kept.append(late(packet))
        return b"" if len(kept) == 1 else kept[0] + kept[1] if len(kept) == 2 else kept[-1]

    monkeypatch.setattr(socket.loader, "answer", delay)
    assert loader.read(0x0840) == first
    assert loader.read(0x0860) == second


def test_silence_is_told_with_the_request_and_takes_as_long_as_any(
    loader: Loader, socket: ScriptedSocket
) -> None:
    socket.lose_answers = 1000
    with pytest.raises(LoaderError) as caught:
        loader.read(0x0840)
    assert str(caught.value) == "the boot loader does not answer READ after 5 tries"
    assert "plug the cable out and in again" in caught.value.remedy
    assert socket.now <= REQUEST_S + 0.25


def test_a_pulled_cable_is_told(loader: Loader, socket: ScriptedSocket) -> None:
    socket.unplugged = True
    with pytest.raises(LoaderError, match="the connection was lost: device disconn") as caught:
        loader.identify()
    assert "type the same command again" in caught.value.remedy


@pytest.mark.parametrize(
    ("result", "message", "remedy"),
    [
        (1, "requests arrive damaged", "use another USB cable or port"),
        (2, "result 2, which has no meaning for this tornillo", "belongs to this boot loader"),
        (3, "result 3, which has no meaning for this tornillo", "belongs to this boot loader"),
        (4, "the chip's memory does not keep what was written", "the supply is weak"),
        (5, "the program in the chip is not whole", "write it again with the same command"),
        (77, "result 77, which has no meaning for this tornillo", "belongs to this boot loader"),
    ],
)
def test_every_refusal_of_the_loader_is_explained(
    loader: Loader, socket: ScriptedSocket, result: int, message: str, remedy: str
) -> None:
    socket.loader.results[LoaderCommand.GO] = result
    with pytest.raises(LoaderRefusedError) as caught:
        loader.go()
    assert str(caught.value) == f"the boot loader refused GO: {message}"
    assert remedy in caught.value.remedy


def test_only_a_loader_answers_as_one(socket: ScriptedSocket) -> None:
    assert not answers(socket.open(socket.port))
    assert socket.now <= 0.75
    socket.in_loader = True
    assert answers(socket.open(socket.port))


def test_the_program_is_written_upwards_with_its_header_last(
    loader: Loader, socket: ScriptedSocket, firmware: Firmware
) -> None:
    told: list[tuple[int, int]] = []
    write_whole(loader, firmware, lambda done, total: told.append((done, total)))
    end = FIRST + len(firmware.image)
    assert socket.loader.written == [*range(BEHIND_THE_HEADER, end, PIECE), FIRST, FIRST + PIECE]
    assert socket.loader.flash[FIRST:end] == firmware.image
    assert socket.loader.whole
    read = [packet[1:3] for packet in socket.loader.asked if packet[:1] == b"R"]
    assert read == [at.to_bytes(2, "little") for at in range(FIRST, end, PIECE)]
    total = 2 * len(firmware.image)
    assert told[0] == (BLOCK, total)
    assert told[-1] == (total, total)
    assert [done for done, _total in told] == sorted(done for done, _total in told)


def test_a_block_that_was_not_kept_is_written_again_from_its_beginning(
    loader: Loader, socket: ScriptedSocket, firmware: Firmware
) -> None:
    socket.loader.not_kept = 2
    write_whole(loader, firmware)
    assert socket.loader.written[:4] == [*3 * [BEHIND_THE_HEADER], BEHIND_THE_HEADER + PIECE]
    assert socket.loader.whole


def test_memory_that_never_keeps_is_told(
    loader: Loader, socket: ScriptedSocket, firmware: Firmware
) -> None:
    socket.loader.not_kept = 1000
    with pytest.raises(LoaderRefusedError, match="refused WRITE: the chip's memory does not keep"):
        write_whole(loader, firmware)
    assert socket.loader.written == 3 * [BEHIND_THE_HEADER]


def test_other_refusals_of_a_write_are_not_tried_again(
    loader: Loader, socket: ScriptedSocket, firmware: Firmware
) -> None:
    socket.loader.results[LoaderCommand.WRITE] = LoaderResult.BAD_ADDRESS
    with pytest.raises(LoaderRefusedError, match="refused WRITE: result 3"):
        write_whole(loader, firmware)
    assert len(socket.loader.asked) == 1


def test_a_program_that_does_not_compare_is_written_once_more(
    loader: Loader, socket: ScriptedSocket, firmware: Firmware
) -> None:
    socket.loader.weak[0x08A0] = 1
    write_whole(loader, firmware)
    assert len(socket.loader.written) == 2 * len(firmware.image) // PIECE
    assert socket.loader.whole


def test_memory_that_reads_otherwise_is_told_with_its_address(
    loader: Loader, socket: ScriptedSocket, firmware: Firmware
) -> None:
    socket.loader.weak[0x08A0] = 1000
    with pytest.raises(LoaderError) as caught:
        write_whole(loader, firmware)
    assert str(caught.value) == "the chip holds something else at 0x08A5 than was written"
    assert "the chip is worn out" in caught.value.remedy


def test_an_update_over_a_bad_cable_ends_in_bounded_time(
    loader: Loader, socket: ScriptedSocket, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    large = Firmware.load(str(firmware_file(tmp_path, program(size=0x2000))))
    answer = socket.loader.answer
    numbers = iter(range(1_000_000))

    def one_of_five(packet: bytes) -> bytes:
        return answer(packet) if next(numbers) % 5 == 4 else b""

    monkeypatch.setattr(socket.loader, "answer", one_of_five)
    with pytest.raises(LoaderError) as caught:
        write_whole(loader, large)
    assert str(caught.value).startswith(f"the update is not over after {UPDATE_S:g} s: ")
    assert str(caught.value).endswith(f"{loader.repeats} requests were lost")
    assert "use another USB cable or port" in caught.value.remedy
    assert UPDATE_S <= socket.now <= UPDATE_S + 2 * (REQUEST_S + 0.25)


@pytest.mark.parametrize(
    ("change", "message", "remedy"),
    [
        (
            {"version": 2},
            "the boot loader speaks version 2, this tornillo version 1",
            "use the tornillo version that belongs to this boot loader",
        ),
        (
            {"board": 3},
            "new.hex was made for board 1, and this is board 3",
            "take the firmware made for your board; nothing has been changed",
        ),
        (
            {"first": 0x1000},
            "new.hex fills 0x0800 to 0x0A62, and this chip has 0x1000 to 0x8000 for a program",
            "take the firmware of a release made for this boot loader",
        ),
        (
            {"end": 0x0A60},
            "new.hex fills 0x0800 to 0x0A62, and this chip has 0x0800 to 0x0A60 for a program",
            "take the firmware of a release made for this boot loader",
        ),
    ],
)
def test_a_chip_that_the_firmware_was_not_made_for_is_refused(
    loader: Loader, firmware: Firmware, change: dict[str, Any], message: str, remedy: str
) -> None:
    identity = loader.identify()
    check_fits(identity, firmware)
    with pytest.raises(LoaderError) as caught:
        check_fits(identity._replace(**change), firmware)
    assert message in str(caught.value)
    assert remedy in caught.value.remedy


def test_the_old_version_is_told_when_there_is_a_whole_one(
    loader: Loader, socket: ScriptedSocket
) -> None:
    assert updating.old_version(loader, loader.identify()) == "0.1.0"
    socket.loader.flash[FIRST + 100] ^= 1
    assert updating.old_version(loader, loader.identify()) is None
    socket.loader.put(program(identity=b"Whatever"))
    assert updating.old_version(loader, loader.identify()) is None
