# SPDX-License-Identifier: Apache-2.0
"""What the firmware needs of the chip, as published by the build and as measured in a run."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import on_a_new_chip
from tornillo.protocol import PART_SLOTS, PART_UNIT, State

SIZE_FILE = Path(__file__).parents[2] / "build" / "firmware" / "size.json"
STORE_BEGIN, FLASH_SIZE = 0x7600, 0x8000
STACK_FIRST, STACK_LAST = 0x700, 0x77F
FSR1L, FSR1H = 0xFE1, 0xFE2


@pytest.fixture
def size() -> dict[str, int]:
    """What the build has published."""
    found: dict[str, int] = json.loads(SIZE_FILE.read_text(encoding="utf-8"))
    return found


def test_the_budgets_hold(size: dict[str, int]) -> None:
    assert size["ram_static_bytes"] + size["sw_stack_worst_bytes"] <= 2048 * 94 // 100
    assert size["hw_stack_worst_levels"] <= 20


def test_the_program_ends_before_the_part_store(size: dict[str, int]) -> None:
    assert size["flash_bytes"] <= STORE_BEGIN
    assert STORE_BEGIN + PART_SLOTS * PART_UNIT == FLASH_SIZE


def software_stack_used(bench: Bench) -> int:
    """Bytes of the painted stack that have been touched."""
    return STACK_LAST + 1 - STACK_FIRST - bench.chip.painted_low_water(STACK_FIRST, STACK_LAST)


@on_a_new_chip
def test_neither_stack_gets_deeper_than_the_build_has_computed(size: dict[str, int]) -> None:
    bench = Bench(**little_pin.OPTIONS, backlash_x=7, backlash_z=12)
    bench.run(0.1)  # behind the boot loader
    pointer = bench.chip.peek(FSR1L, 2)
    assert STACK_FIRST < pointer <= STACK_LAST
    bench.chip.paint(STACK_FIRST, pointer - 1)
    bench.set(zero_x=little_pin.ZERO_X, zero_z=little_pin.ZERO_Z)
    bench.host.upload(little_pin.image())
    bench.host.upload(little_pin.image())
    bench.home()
    bench.host.run()
    while bench.is_in(State.RUNNING):
        bench.host.status()
        bench.host.part(7)
    bench.unplug()
    bench.connect()
    used = software_stack_used(bench)
    assert 0 < used <= size["sw_stack_worst_bytes"]
    assert 5 < bench.chip.stack_depth_max <= size["hw_stack_worst_levels"]
    little_pin_is_there(bench)


def little_pin_is_there(bench: Bench) -> None:
    """Check that the run was a whole one."""
    bench.lathe.wanted = little_pin.wanted()
    little_pin.assert_cut_exactly(bench)
