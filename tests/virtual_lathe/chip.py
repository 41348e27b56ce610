# SPDX-License-Identifier: Apache-2.0
"""The simulated PIC18F4550: run it, look into it, count what it costs.

One chip per process, because gpsim keeps its state in globals: use :func:`in_new_process` of
``virtual_lathe.worker`` for a second one, for instance after a power cycle.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path

from .configuration import write_protection
from .native_library import (
    InterruptCostC,
    NonvolatileCountsC,
    PinChangeC,
    RamWriteC,
    library,
)
from .symbols import Symbols

CYCLES_PER_SECOND = 12_000_000
FLASH_BYTES = 0x8000
EEPROM_BYTES = 0x100


class Stop(IntEnum):
    """Why :meth:`Chip.run_to` came back; see ``enum vl_stop``."""

    CYCLE = 0
    ADDRESS = 1
    EVENT = 2
    LOST = 3
    HALT = 4


class Reset(IntEnum):
    """Kinds of reset; the first four can be injected."""

    POWER_ON = 0
    BROWN_OUT = 1
    WATCHDOG = 2
    MCLR = 3
    STACK_FULL = 4
    STACK_EMPTY = 5
    SOFTWARE = 6
    OTHER = 7


class Drive(IntEnum):
    """What a pin is connected to outside the chip."""

    LOW = 0
    HIGH = 1
    OPEN = 2


class ChipFault(RuntimeError):
    """The simulated program left the program memory or gpsim halted by itself."""


@dataclass(frozen=True)
class InterruptCost:
    """Cycles spent in the interrupts of one priority, nested ones left out."""

    entries: int
    total: int
    best: int
    worst: int
    worst_at: int

    @property
    def mean(self) -> float:
        """Mean cycles per entry, 0.0 when there was none."""
        return self.total / self.entries if self.entries else 0.0


@dataclass(frozen=True)
class RamWrite:
    """One write of the firmware to a watched address."""

    cycle: int
    address: int
    value: int
    pc: int


@dataclass(frozen=True)
class NonVolatile:
    """Contents that survive a power cycle: 32,768 bytes of flash, 256 of EEPROM."""

    flash: bytes
    eeprom: bytes


def pin_number(name: str) -> int:
    """Return the number of a pin named as in the data sheet, ``RA0`` .. ``RE2``.

    Raises:
        ValueError: the name is not a port pin.
    """
    if len(name) != 3 or name[0] != "R" or name[1] not in "ABCDE" or name[2] not in "01234567":
        raise ValueError(f"{name!r} is not a pin; pins are named RA0 to RE2")
    return (ord(name[1]) - ord("A")) * 8 + int(name[2])


class Chip:
    """The chip of this process with firmware in it, just powered on.

    Args:
        firmware: a ``.hex`` or ``.cod`` file; a ``.map`` beside it gives the symbols.

    Raises:
        RuntimeError: this process already has a chip, or the file cannot be loaded.
    """

    def __init__(self, firmware: Path | str) -> None:
        """Load the firmware into the chip of this process."""
        self.firmware = Path(firmware)
        self._native = library()
        if not self.firmware.exists():
            raise RuntimeError(f"{self.firmware} does not exist")
        if self._native.vl_load(str(self.firmware).encode()) != 0:
            raise RuntimeError(f"cannot load {self.firmware} (one chip per process, PIC18F4550)")
        if self.firmware.suffix == ".hex":
            self._native.vl_write_protection(write_protection(self.firmware))
        self.symbols = Symbols.read(self.firmware.with_suffix(".map"))

    # -- time -----------------------------------------------------------------------------------

    @property
    def cycle(self) -> int:
        """Instruction cycles since the first power-on, 12 per microsecond."""
        return int(self._native.vl_cycle())

    @property
    def seconds(self) -> float:
        """Simulated seconds since the first power-on."""
        return self.cycle / CYCLES_PER_SECOND

    def run_to(self, cycle: int) -> Stop:
        """Run until the given cycle (it may be overshot by one instruction).

        Raises:
            ChipFault: the program ran away.
        """
        reason = Stop(self._native.vl_run(cycle))
        if reason in (Stop.LOST, Stop.HALT):
            raise ChipFault(f"{reason.name} at cycle {self.cycle}, address {self.pc:#06x}")
        return reason

    def run(self, seconds: float) -> Stop:
        """Run for a simulated time in seconds."""
        return self.run_to(self.cycle + round(seconds * CYCLES_PER_SECOND))

    def run_until(self, predicate: Callable[[], bool], timeout: float, every: float = 1e-3) -> bool:
        """Run until ``predicate()`` holds, looked at every ``every`` simulated seconds.

        Returns:
            True when it held, False when ``timeout`` simulated seconds had passed before.
        """
        end = self.cycle + round(timeout * CYCLES_PER_SECOND)
        while not predicate():
            if self.cycle >= end:
                return False
            self.run_to(min(end, self.cycle + max(1, round(every * CYCLES_PER_SECOND))))
        return True

    def run_to_address(self, address: int, timeout: float = 1.0) -> bool:
        """Run until the instruction at a byte address is next; False after ``timeout`` s."""
        self._native.vl_set_break(address, 1)
        try:
            return self.run(timeout) == Stop.ADDRESS
        finally:
            self._native.vl_set_break(address, 0)

    def set_break(self, address: int, on: bool = True) -> None:
        """Stop :meth:`run_to` before the instruction at a byte address, or no longer."""
        self._native.vl_set_break(address, int(on))

    @property
    def pc(self) -> int:
        """Byte address of the next instruction."""
        return int(self._native.vl_program_counter())

    # -- memory ---------------------------------------------------------------------------------

    def peek(self, address: int, count: int = 1) -> int:
        """Return a little-endian unsigned number of ``count`` bytes, without side effects."""
        return sum(int(self._native.vl_peek(address + i)) << (8 * i) for i in range(count))

    def poke(self, address: int, value: int, count: int = 1) -> None:
        """Store a little-endian number of ``count`` bytes, without side effects."""
        for i in range(count):
            self._native.vl_poke(address + i, value >> (8 * i) & 0xFF)

    def read(self, address: int) -> int:
        """Read a register as an instruction would, side effects included."""
        return int(self._native.vl_read(address))

    def write(self, address: int, value: int) -> None:
        """Write a register as an instruction would, side effects included."""
        self._native.vl_write(address, value)

    def variable(self, name: str, count: int = 1, signed: bool = False) -> int:
        """Return the value of a firmware variable of ``count`` bytes by its C name."""
        value = self.peek(self.symbols.ram(name), count)
        if signed and value >= 1 << (8 * count - 1):
            value -= 1 << (8 * count)
        return value

    def set_variable(self, name: str, value: int, count: int = 1) -> None:
        """Overwrite a firmware variable of ``count`` bytes by its C name."""
        self.poke(self.symbols.ram(name), value, count)

    # -- resets and non-volatile memory ---------------------------------------------------------

    def reset(self, kind: Reset) -> None:
        """Inject a power-on, brown-out, watchdog or MCLR reset; RAM keeps its contents."""
        if self._native.vl_reset_chip(int(kind)) != 0:
            raise ValueError(f"{kind.name} cannot be injected")

    def fill_ram(self, seed: int) -> None:
        """Fill RAM with repeatable noise, as after a long time without power."""
        self._native.vl_fill_ram(seed)

    @property
    def resets(self) -> list[tuple[int, Reset]]:
        """Resets seen so far as (cycle, kind)."""
        room = self._native.vl_resets(None, None, 0)
        cycles = (ctypes.c_uint64 * max(room, 1))()
        kinds = (ctypes.c_int * max(room, 1))()
        self._native.vl_resets(cycles, kinds, room)
        return [(int(cycles[i]), Reset(kinds[i])) for i in range(room)]

    def save(self) -> NonVolatile:
        """Return what survives a power cycle."""
        flash = (ctypes.c_uint8 * FLASH_BYTES)()
        eeprom = (ctypes.c_uint8 * EEPROM_BYTES)()
        self._native.vl_flash_read(0, flash, FLASH_BYTES)
        self._native.vl_eeprom_read(eeprom)
        return NonVolatile(bytes(flash), bytes(eeprom))

    def restore(self, memory: NonVolatile) -> None:
        """Load flash and EEPROM as saved before; call it before running."""
        self._native.vl_flash_write(
            0, (ctypes.c_uint8 * FLASH_BYTES).from_buffer_copy(memory.flash), FLASH_BYTES
        )
        self._native.vl_eeprom_write(
            (ctypes.c_uint8 * EEPROM_BYTES).from_buffer_copy(memory.eeprom)
        )

    @property
    def nonvolatile_counts(self) -> dict[str, int]:
        """Writes so far, by kind.

        ``eeprom_writes`` (bytes), ``flash_erases`` (blocks of 64 bytes), ``flash_writes`` (blocks
        of 32) and ``broken_unlocks`` (write commands the chip ignored).
        """
        counts = NonvolatileCountsC()
        self._native.vl_nonvolatile_counts(ctypes.byref(counts))
        return {name: int(getattr(counts, name)) for name, *_ in counts._fields_}

    # -- pins -----------------------------------------------------------------------------------

    def drive(self, pin: str, how: Drive) -> None:
        """Connect a pin to ground, to +5 V, or to nothing."""
        if self._native.vl_pin_drive(pin_number(pin), int(how)) != 0:
            raise ValueError(f"{pin} does not exist")

    def drive_volts(self, pin: str, volts: float, ohms: float) -> None:
        """Connect a pin to a voltage through a resistance."""
        if self._native.vl_pin_drive_volts(pin_number(pin), volts, ohms) != 0:
            raise ValueError(f"{pin} does not exist")

    def level(self, pin: str) -> int:
        """Return the level of a pin, 0 or 1."""
        return int(self._native.vl_pin_level(pin_number(pin)))

    def port(self, letter: str) -> int:
        """Return the levels of the eight pins of a port, ``"A"`` to ``"E"``."""
        return int(self._native.vl_pin_levels()) >> (ord(letter) - ord("A")) * 8 & 0xFF

    def log_pins(self, *names: str) -> None:
        """Begin to log changes of the named pins, forgetting what was logged before."""
        self._native.vl_pin_log(sum(1 << pin_number(name) for name in names))

    def pin_changes(self) -> list[tuple[int, int]]:
        """Return and forget the logged changes as (cycle, levels of all pins)."""
        room = 65536
        entries = (PinChangeC * room)()
        changes: list[tuple[int, int]] = []
        while True:
            count = self._native.vl_pin_changes(entries, room)
            changes += [(int(entries[i].cycle), int(entries[i].levels)) for i in range(count)]
            if count < room:
                return changes

    # -- instruments ----------------------------------------------------------------------------

    def interrupt_cost(self, high: bool) -> InterruptCost:
        """Return what the high- or the low-priority interrupt has cost so far."""
        cost = InterruptCostC()
        self._native.vl_interrupts(int(high), ctypes.byref(cost))
        return InterruptCost(*(int(getattr(cost, name)) for name, *_ in cost._fields_))

    @property
    def stack_depth_max(self) -> int:
        """Deepest use of the 31-level return stack so far."""
        return int(self._native.vl_stack_depth_max())

    def executed(self) -> set[int]:
        """Byte addresses of the instructions executed so far."""
        flags = (ctypes.c_uint8 * (FLASH_BYTES // 2))()
        self._native.vl_executed(flags)
        return {2 * word for word, flag in enumerate(flags) if flag}

    def clear_statistics(self) -> None:
        """Forget interrupt costs, stack depth and coverage."""
        self._native.vl_clear_statistics()

    def paint(self, first: int, last: int, pattern: int = 0xA5) -> None:
        """Fill RAM first..last with a pattern, to find out later what was used."""
        for address in range(first, last + 1):
            self._native.vl_poke(address, pattern)

    def painted_low_water(self, first: int, last: int, pattern: int = 0xA5) -> int:
        """Return how many painted bytes of a downward-growing stack were never touched."""
        for address in range(first, last + 1):
            if self.peek(address) != pattern:
                return address - first
        return last + 1 - first

    def watch_writes(self, first: int, last: int) -> None:
        """Log every write of the firmware to RAM first..last (at most 65,536 of them)."""
        if self._native.vl_watch_writes(first, last) != 0:
            raise ValueError(f"{first:#x}..{last:#x} is not in data memory")

    def ram_writes(self) -> list[RamWrite]:
        """Return the logged writes to watched addresses."""
        room = 65536
        entries = (RamWriteC * room)()
        count = min(room, self._native.vl_ram_writes(entries, room))
        return [
            RamWrite(int(e.cycle), int(e.address), int(e.value), int(e.pc)) for e in entries[:count]
        ]

    def written(self) -> set[int]:
        """Addresses of watched RAM that have been written since they are watched, all of them."""
        flags = (ctypes.c_uint8 * 0x1000)()
        self._native.vl_written(flags)
        return {address for address, flag in enumerate(flags) if flag}

    def open_vcd(self, path: Path | str) -> None:
        """Begin a value change dump of all pins, timescale 1 ns.

        Raises:
            OSError: the file cannot be written.
        """
        if self._native.vl_vcd_open(str(path).encode()) != 0:
            raise OSError(f"cannot write {path}")

    def close_vcd(self) -> None:
        """Finish the value change dump; without one nothing happens."""
        self._native.vl_vcd_close()
