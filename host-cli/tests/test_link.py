# SPDX-License-Identifier: Apache-2.0
"""Requests and responses on a bad line."""

import threading
from itertools import pairwise
from types import SimpleNamespace
from unittest import mock

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scripted_chip import ScriptedChip, ScriptedPort

from tornillo.errors import ChipError, LinkError, NoAnswerError
from tornillo.frames import Frame, encode
from tornillo.lathe import Lathe
from tornillo.link import READ_SLICE_S, REQUEST_S, Link
from tornillo.protocol import (
    FRAME_TIMEOUT_MS,
    FRAME_TRIES,
    RESPONSES,
    Command,
    ErrorCode,
    Refusal,
    SettingId,
)


def test_a_lost_answer_is_asked_for_again_and_not_executed_twice(
    lathe: Lathe, port: ScriptedPort, chip: ScriptedChip
) -> None:
    port.lose_answers = 3
    lathe.set_setting(SettingId.RAPID_RATE_X, 900)
    assert chip.executed.count(Command.SETTING_SET) == 1
    sent = [frame for frame in port.requests if frame.code == Command.SETTING_SET]
    assert len(sent) == 4
    assert len({frame.seq for frame in sent}) == 1


def test_a_damaged_answer_is_asked_for_again(lathe: Lathe, port: ScriptedPort) -> None:
    port.damage_answers = 1
    assert lathe.status().dead_x == 23
    assert lathe._link.repeats == 1


def test_every_request_has_a_new_sequence_number(lathe: Lathe, port: ScriptedPort) -> None:
    for _ in range(300):
        lathe.status()
    numbers = [frame.seq for frame in port.requests]
    assert all((after - before) % 256 == 1 for before, after in pairwise(numbers))


def test_after_five_tries_the_link_gives_up_with_a_remedy(lathe: Lathe, port: ScriptedPort) -> None:
    port.lose_answers = 100
    with pytest.raises(NoAnswerError, match="no answer to STATUS after 5 tries") as caught:
        lathe.status()
    assert "cable" in caught.value.remedy
    assert caught.value.heard == 0
    assert port.now == pytest.approx(FRAME_TRIES * FRAME_TIMEOUT_MS / 1000, abs=0.1)
    assert port.lose_answers == 100 - FRAME_TRIES


@pytest.mark.parametrize("write_seconds", [0.0, 0.05, 0.2, 0.25])
@pytest.mark.parametrize("blocked", [0, 1, 3, 1000])
def test_no_request_takes_longer_than_its_documented_time(
    lathe: Lathe, port: ScriptedPort, write_seconds: float, blocked: int
) -> None:
    assert REQUEST_S == 1.5
    port.lose_answers = 100
    port.write_seconds = write_seconds
    port.blocked_writes = blocked
    with pytest.raises(NoAnswerError):
        lathe.status()
    assert 1.2 <= port.now <= REQUEST_S + READ_SLICE_S


def test_a_request_that_got_half_out_is_sent_again_and_executed_once(
    lathe: Lathe, port: ScriptedPort, chip: ScriptedChip
) -> None:
    port.blocked_writes = 2
    lathe.set_setting(SettingId.RAPID_RATE_X, 900)
    assert chip.executed.count(Command.SETTING_SET) == 1
    assert lathe._link.repeats == 2


@given(st.lists(st.binary(min_size=1, max_size=90), max_size=6), st.integers(0, 4))
def test_whatever_comes_between_the_answers_the_next_ones_are_right(
    garbage: list[bytes], damaged: int
) -> None:
    chip = ScriptedChip()
    port = ScriptedPort(chip)
    with mock.patch("tornillo.link.time", SimpleNamespace(monotonic=lambda: port.now)):
        lathe = Lathe(port)
        for number, noise in enumerate([*garbage, b""]):
            port.inject(noise)
            port.damage_answers = damaged
            lathe.set_setting(SettingId.RAPID_RATE_X, 900 + number)
            assert lathe.setting(SettingId.RAPID_RATE_X).value == 900 + number
        assert chip.executed.count(Command.SETTING_SET) == len(garbage) + 1


@given(st.binary(max_size=200), st.integers(0, 40))
def test_whatever_was_on_the_line_before_the_chip_carries_out_the_next_request(
    garbage: bytes, cut: int
) -> None:
    port = ScriptedPort(ScriptedChip())
    port.write(garbage.replace(b"\0", b"\1") + encode(Frame(9, Command.STOP, b""))[:cut][:-1])
    with mock.patch("tornillo.link.time", SimpleNamespace(monotonic=lambda: port.now)):
        assert Lathe(port)._link.repeats == 0


def test_a_closed_link_says_so(lathe: Lathe, port: ScriptedPort) -> None:
    lathe.close()
    lathe.close()
    assert port.closed
    with pytest.raises(LinkError, match="the port has been closed"):
        lathe.status()


@pytest.mark.parametrize(
    "noise",
    [
        b"AT+GCAP\r\n\0",
        b"\0\0\0",
        bytes(range(1, 200)) + b"\0",
        encode(Frame(77, 0x82, b"late")),
        encode(Frame(1, 0x81, b"other command")),
    ],
)
def test_garbage_and_late_answers_before_an_answer_are_skipped(
    lathe: Lathe, port: ScriptedPort, noise: bytes
) -> None:
    port.noise = noise
    assert lathe.status().dead_z == 31


def test_garbage_that_runs_into_an_answer_costs_one_repeat(
    lathe: Lathe, port: ScriptedPort
) -> None:
    port.inject(b"half a frame")
    assert lathe.status().dead_z == 31
    assert lathe._link.repeats == 1


def test_endless_garbage_is_given_up(lathe: Lathe, port: ScriptedPort) -> None:
    port.inject(b"x" * 100_000)
    port.lose_answers = 100
    with pytest.raises(LinkError, match="no answer to STATUS"):
        lathe.status()


def test_a_pulled_cable_is_told_as_such(lathe: Lathe, port: ScriptedPort) -> None:
    port.unplugged = True
    with pytest.raises(LinkError, match="connection was lost: device disconnected") as caught:
        lathe.status()
    assert "goes on without the computer" in caught.value.remedy


def test_each_request_starts_with_a_delimiter_to_end_garbage(
    port: ScriptedPort, monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[bytes] = []
    monkeypatch.setattr(port, "write", written.append)
    with pytest.raises(LinkError):
        Link(port).request(Command.HELLO)
    assert all(data[:1] == b"\0" == data[-1:] for data in written)


@pytest.mark.parametrize("code", [code for code in ErrorCode if code is not ErrorCode.OK])
def test_every_error_code_becomes_a_refusal_with_a_remedy(
    lathe: Lathe, chip: ScriptedChip, code: ErrorCode
) -> None:
    chip.refusals[Command.HOME] = bytes([code])
    with pytest.raises(ChipError, match="HOME was refused: ") as caught:
        lathe.home()
    assert caught.value.code is code
    assert caught.value.remedy


@pytest.mark.parametrize("reason", list(Refusal))
def test_every_reason_of_an_invalid_part_is_explained(
    lathe: Lathe, chip: ScriptedChip, reason: Refusal
) -> None:
    chip.refusals[Command.RUN] = bytes([ErrorCode.INVALID_PART, reason, 2])
    with pytest.raises(ChipError, match="operation 2") as caught:
        lathe.run(0)
    assert (caught.value.reason, caught.value.operation) == (reason, 2)


@pytest.mark.parametrize("payload", [b"\x63", b"\x07\x63\x01"])
def test_unknown_codes_are_told_with_their_bytes(
    lathe: Lathe, chip: ScriptedChip, payload: bytes
) -> None:
    chip.refusals[Command.HOME] = payload
    with pytest.raises(LinkError, match=payload.hex(" ")):
        lathe.home()


def test_an_empty_answer_is_refused(lathe: Lathe, chip: ScriptedChip) -> None:
    chip.refusals[Command.HOME] = b""
    with pytest.raises(LinkError, match="answer to HOME is empty"):
        lathe.home()


def test_an_answer_of_the_wrong_length_is_refused(lathe: Lathe, chip: ScriptedChip) -> None:
    chip.refusals[Command.STATUS] = b"\0abc"
    with pytest.raises(LinkError, match=f"has 3 bytes, not {RESPONSES[Command.STATUS].size}"):
        lathe.status()


def test_threads_never_have_two_requests_in_flight(lathe: Lathe, port: ScriptedPort) -> None:
    results: list[int] = []

    def ask() -> None:
        results.extend(lathe.status().dead_x for _ in range(50))

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [23] * 200
    assert lathe._link.repeats == 0
    assert len(port.requests) == 201
