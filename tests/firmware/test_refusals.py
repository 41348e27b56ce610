# SPDX-License-Identifier: Apache-2.0
"""Images sent past the command line: the chip refuses them itself, with reason and operation."""

from __future__ import annotations

import pytest
from refusal_cases import CASES, DATA
from simulated.agreement import chips_answer, damaged_parts, judge, nasty_parts, parts
from simulated.bench import Bench
from simulated.processes import on_a_new_chip
from tornillo.protocol import ErrorCode, Refusal, SettingId

#: More of them by hand: python -m simulated.agreement --parts 10000 --damaged 10000
SEEDS = range(100)
#: A length that is announced before the first piece is sent.
ANNOUNCED = (0, 31, 2497, 65535)


@pytest.mark.parametrize("refusal", list(Refusal), ids=lambda refusal: refusal.name)
@on_a_new_chip
def test_the_chip_refuses_by_itself_with_reason_and_operation(refusal: Refusal) -> None:
    bench = Bench()
    cases = CASES[refusal]
    assert len(cases) >= 10
    wanted = [(refusal, operation) for _, operation in cases]
    assert [chips_answer(bench, image) for image, _ in cases] == wanted
    assert bench.host.parts() == []


@on_a_new_chip
def test_host_and_chip_are_of_one_mind_about_random_and_damaged_parts() -> None:
    bench = Bench()
    machine = bench.host.machine()
    images = [
        *parts(SEEDS, machine),
        *damaged_parts(SEEDS, machine),
        *nasty_parts(SEEDS, machine),
    ]
    assert [judged for judged in judge(bench, images, machine) if not judged.agreed] == []


@on_a_new_chip
def test_a_part_is_judged_again_before_every_run() -> None:
    bench = Bench()
    bench.home()
    slot = bench.host.upload(DATA)
    bench.set(travel_z=8100)
    assert bench.refusal(lambda: bench.host.run(slot)) is ErrorCode.INVALID_PART
    assert not bench.moving
    bench.host.set_setting(SettingId.TRAVEL_Z, 16072)
    assert bench.refusal(lambda: bench.host.run(slot)) is ErrorCode.OK


@pytest.mark.parametrize("length", ANNOUNCED)
@on_a_new_chip
def test_an_upload_of_an_impossible_length_is_refused_at_once(length: int) -> None:
    bench = Bench()
    image = bytes(length)
    assert chips_answer(bench, image) == (Refusal.LENGTH, 0)
