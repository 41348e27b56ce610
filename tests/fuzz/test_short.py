# SPDX-License-Identifier: Apache-2.0
"""A short run of the fuzzer, and the whole corpus; ``make fuzz`` is the long run."""

from __future__ import annotations

import pytest
from simulated.processes import on_a_new_chip
from tornillo.protocol import Command, HomedAxis

from fuzz import frames, transfers
from fuzz.frames import FrameFuzzer
from fuzz.target import Broken, Target, frame
from fuzz.transfers import TransferFuzzer
from fuzz.unplugs import Unplugs

TRANSFERS = 4000
FRAMES = 8000


@on_a_new_chip
def test_every_transfer_of_the_corpus_does_no_harm() -> None:
    fuzzer = TransferFuzzer(Target(), seed=0)
    for case in transfers.corpus():
        fuzzer.play(case)
    fuzzer.check_alive()


@on_a_new_chip
def test_every_frame_of_the_corpus_does_no_harm() -> None:
    fuzzer = FrameFuzzer(Target(), seed=0)
    for case in frames.corpus():
        fuzzer.play([case])


@pytest.mark.parametrize("seed", [1, 2])
@on_a_new_chip
def test_nonsense_in_transfers_does_no_harm(seed: int) -> None:
    fuzzer = TransferFuzzer(Target(), seed)
    fuzzer.run(TRANSFERS)
    fuzzer.check_alive()


@pytest.mark.parametrize("seed", [1, 2])
@on_a_new_chip
def test_nonsense_in_frames_does_no_harm(seed: int) -> None:
    FrameFuzzer(Target(), seed).run(FRAMES)


@on_a_new_chip
def test_the_same_seed_makes_the_same_run() -> None:
    target = Target()
    one, other = TransferFuzzer(target, 7), TransferFuzzer(target, 7)
    assert [one.case() for _ in range(200)] == [other.case() for _ in range(200)]
    first, second = FrameFuzzer(target, 7), FrameFuzzer(target, 7)
    assert [first.piece() for _ in range(200)] == [second.piece() for _ in range(200)]


@on_a_new_chip
def test_a_stray_write_would_be_seen() -> None:
    target = Target()
    chip = target.bench.chip
    target.check()
    chip.write(min(target.forbidden), 0x55)
    with pytest.raises(Broken, match="none of its business"):
        target.check()


@on_a_new_chip
def test_a_frame_that_moves_the_lathe_would_be_seen() -> None:
    target = Target()
    target.check_alive()
    target.bench.send_raw(frame(1, Command.HOME, bytes([HomedAxis.X | HomedAxis.Z])))
    target.bench.host.wait(0.2)
    with pytest.raises(Broken, match="moved"):
        target.check()


@on_a_new_chip
def test_the_cable_pulled_at_random_moments_disturbs_nothing() -> None:
    unplugs = Unplugs(seed=1)
    unplugs.upload(12)
    unplugs.status(12)
    unplugs.run(16)
    assert unplugs.moments >= 40
