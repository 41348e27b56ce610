# SPDX-License-Identifier: Apache-2.0
"""The chip against small programs: what gpsim must do, and what the shim adds to it."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

from virtual_lathe.chip import Chip, Drive, NonVolatile, Reset
from virtual_lathe.worker import in_new_process

Program = Callable[[str], str]
MS = 12_000
PORTE, TRISD, TRISB, INTCON2, RCON_COPY, STKPTR_COPY = 0xF84, 0xF95, 0xF93, 0xFF1, 0x20, 0x21


def _toggles(chip: Chip, pin: int) -> list[int]:
    changes = [(0, 0), *chip.pin_changes()]
    return [now for (_, before), (now, after) in pairwise(changes) if (before ^ after) >> pin & 1]


def _step_timer(firmware: str) -> tuple[set[int], int, int, int, int]:
    chip = Chip(firmware)
    chip.log_pins("RD0", "RC0", "RC2")
    chip.run(1.0)
    steps = _toggles(chip, 24)
    high, low = chip.interrupt_cost(high=True), chip.interrupt_cost(high=False)
    intervals = {b - a for a, b in pairwise(steps)}
    return intervals, chip.level("RC2"), high.worst, low.worst, chip.stack_depth_max


def test_the_step_timer_is_exact_although_low_priority_interrupts_run(program: Program) -> None:
    intervals, broken, high, low, depth = in_new_process(_step_timer, program("two_priorities"))
    # 12,000 intervals, among them compare value 0x0000.
    assert intervals == {1000}
    assert broken == 0
    assert high == 15
    assert 190 < low < 210
    assert depth == 2


def _memories(firmware: str) -> tuple[bytes, int, int, int, bytes]:
    chip = Chip(firmware)
    assert chip.run_until(lambda: chip.level("RD0") == 1, timeout=0.1)
    read_back = bytes(chip.peek(0x100 + i) for i in range(64))
    memory = chip.save()
    return (
        read_back,
        chip.peek(0x24),
        memory.eeprom[0x21],
        chip.cycle // MS,
        memory.flash[0x6040:0x6080],
    )


def test_eeprom_and_flash_are_written_and_read_back(program: Program) -> None:
    read_back, ee_read, ee_stored, ms, flash = in_new_process(_memories, program("memories"))
    assert read_back == flash == bytes(range(0x80, 0xA0)) + b"\xff" * 32
    assert ee_read == ee_stored == 0x5A
    # 4 ms for the EEPROM byte, 2 ms each for erasing and writing flash
    assert 8 <= ms <= 9


def _protected(firmware: str) -> list[tuple[bool, bytes]]:
    chip = Chip(firmware)
    before = chip.save().flash
    assert chip.run_until(lambda: chip.level("RD0") == 1, 0.1)
    assert chip.nonvolatile_counts["flash_erases"] == 4
    assert chip.nonvolatile_counts["flash_writes"] == 4
    after = chip.save().flash
    blocks = (0x0040, 0x0800, 0x2000, 0x6000)
    return [(before[at : at + 64] == after[at : at + 64], after[at : at + 4]) for at in blocks]


def test_protected_blocks_keep_what_they_hold(program: Program) -> None:
    boot, *blocks = in_new_process(_protected, program("protected"))
    assert boot[0]
    assert blocks == [(False, bytes(4)), (True, bytes([1, 2, 3, 4])), (False, bytes(4))]


def _reset_bits(firmware: str) -> dict[str, tuple[int, int]]:
    chip = Chip(firmware)
    seen: dict[str, tuple[int, int]] = {}

    def note(name: str) -> None:
        seen[name] = (chip.peek(RCON_COPY), chip.peek(STKPTR_COPY))

    chip.run(0.02)
    note("power on")
    for kind in (Reset.MCLR, Reset.BROWN_OUT):
        chip.reset(kind)
        chip.run(0.02)
        note(kind.name)
    chip.poke(0x23, 1)
    chip.run(0.1)
    note("watchdog")
    chip.poke(0x23, 2)
    chip.run(0.01)
    note("stack")
    assert [kind for _, kind in chip.resets] == [
        Reset.POWER_ON,
        Reset.MCLR,
        Reset.BROWN_OUT,
        Reset.WATCHDOG,
        Reset.STACK_FULL,
    ]
    return seen


def test_every_reset_leaves_its_bits_as_the_data_sheet_says(program: Program) -> None:
    assert in_new_process(_reset_bits, program("memories")) == {
        "power on": (0x5C, 0),
        "MCLR": (0x5F, 0),
        "BROWN_OUT": (0x5E, 0),
        "watchdog": (0x57, 0),
        "stack": (0x5F, 0x80),
    }


def _pull_ups(firmware: str) -> list[int]:
    chip = Chip(firmware)
    chip.run(0.001)
    levels = [chip.level("RB4"), chip.level("RD7")]
    chip.write(INTCON2, chip.peek(INTCON2) & 0x7F)
    chip.write(PORTE, 0x80)
    levels += [chip.level("RB4"), chip.level("RD7")]
    chip.drive("RB4", Drive.LOW)
    chip.drive("RD7", Drive.LOW)
    levels += [chip.level("RB4"), chip.level("RD7")]
    return levels


def test_open_inputs_are_high_only_with_the_pull_ups_on(program: Program) -> None:
    assert in_new_process(_pull_ups, program("spin")) == [0, 0, 1, 1, 0, 0]


def _second_power_on(firmware: str) -> tuple[int, int]:
    first = in_new_process(_written_memory, firmware)
    chip = Chip(firmware)
    chip.restore(first)
    chip.run(0.001)
    memory = chip.save()
    return memory.eeprom[0x21], memory.flash[0x6045]


def _written_memory(firmware: str) -> NonVolatile:
    chip = Chip(firmware)
    chip.run(0.02)
    return chip.save()


def test_memory_survives_a_power_cycle_and_a_cut_leaves_half_a_block(program: Program) -> None:
    assert in_new_process(_second_power_on, program("memories")) == (0x5A, 0x85)
    assert in_new_process(_cut_in_flash_write, program("memories")) == (16, 1)


def _cut_in_flash_write(firmware: str) -> tuple[int, int]:
    chip = Chip(firmware)
    assert chip.run_until(lambda: chip.nonvolatile_counts["flash_erases"] == 1, 0.1, 1e-6)
    # About 25 us later the write begins; 1 ms into it power fails.
    chip.run(1.03e-3)
    chip.reset(Reset.POWER_ON)
    block = chip.save().flash[0x6040:0x6060]
    return sum(byte != 0xFF for byte in block), chip.nonvolatile_counts["flash_erases"]


def _watch(firmware: str) -> tuple[int, int, set[int], str]:
    chip = Chip(firmware)
    chip.watch_writes(0x20, 0x24)
    chip.run(0.02)
    starts = [write for write in chip.ram_writes() if write.address == 0x22]
    trace = Path(firmware).with_suffix(".vcd")
    chip.open_vcd(trace)
    chip.run(0.001)
    chip.close_vcd()
    return len(starts), starts[0].value, chip.executed(), trace.read_text(encoding="ascii")


def test_instruments_see_writes_coverage_and_pins(program: Program) -> None:
    count, value, executed, trace = in_new_process(_watch, program("memories"))
    assert (count, value) == (1, 1)
    assert 0 in executed
    assert "$timescale 1 ns $end" in trace
    assert all(f" {pin} $end" in trace for pin in ("RA0", "RB3", "RC7", "RD0", "RE2"))


def _begins(firmware: str) -> list[int]:
    chip = Chip(firmware)
    begins = []
    while chip.pc < 12:
        begins.append(chip.cycle)
        chip.run_to(chip.cycle + 1)
    return begins


def test_reading_and_writing_a_table_takes_two_cycles(program: Program) -> None:
    assert in_new_process(_begins, program("table_reads")) == [0, 2, 4, 6, 8, 10]
