# SPDX-License-Identifier: Apache-2.0
"""Worst-case stack use of a PIC18 program, from its machine code.

Follows every path of every function, library routines included, and counts

- bytes on SDCC's software stack: writes through POSTDEC1 push, reads through
  PREINC1 or POSTINC1 pop, ADDWF/SUBWF FSR1L after MOVLW free or take room;
- levels of the hardware return stack: one for each call.

The program has no recursion and no function pointers; both are refused. Computed
jumps (SDCC's switch tables: a write to PCL) go to any of the GOTO or BRA that follow.
Byte code is not machine code: compile_bytecode.py reports what its functions push and
call, and what the interpreter takes itself is written down here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

POSTDEC1, PREINC1, POSTINC1, FSR1L, PCL = 0xFE5, 0xFE4, 0xFE6, 0xFE1, 0xFF9
HIGH_VECTOR, LOW_VECTOR, RESET_VECTOR = 0x08, 0x18, 0x00

# Instructions that may skip the next one: first byte of the opcode.
SKIPS = frozenset(
    byte
    for first, last in ((0x60, 0x67), (0x2C, 0x2F), (0x3C, 0x3F), (0x48, 0x4F), (0xA0, 0xBF))
    for byte in range(first, last + 1)
)
RETURNS = frozenset([0x0010, 0x0011, 0x0012, 0x0013])


class UnboundedStackError(ValueError):
    """The depth cannot be computed: recursion, or code that was never written."""


@dataclass(frozen=True)
class Use:
    """Stack use of a function: software bytes and hardware levels."""

    bytes: int
    levels: int


@dataclass
class Step:
    """What one instruction does: bytes of the instruction, stack effect, ways on."""

    size: int = 2
    push: int = 0
    call: int | None = None
    targets: list[int] = field(default_factory=list)
    falls_through: bool = True


ENTER_BYTES = 3  # the interpreter saves where it was, and a mark
OPERATION_LEVELS = 3  # of its own calls in an operation
RETURN_BYTES, NATIVE_LEVELS = 2, 2  # a call of byte code, of a native function


class ByteCode:
    """What compile_bytecode.py reports, with the addresses of labels."""

    def __init__(self, report: dict[str, Any], addresses: dict[str, int]) -> None:
        """`addresses`: of entries and native functions, by label."""
        self.functions = report["functions"]
        self.addresses = addresses
        self.entries = {addresses[f"_{name}"]: name for name in report["entries"]}

    def use(self, name: str, native: Callable[[int], Use]) -> Use:
        """Return the stack use of a byte-code function, callees included."""
        deepest, levels = self.functions[name]["bytes"], OPERATION_LEVELS
        for depth, called in self.functions[name]["calls"]:
            if called in self.functions:
                use = self.use(called, native)
                deepest = max(deepest, depth + RETURN_BYTES + use.bytes)
                levels = max(levels, use.levels)
            else:
                use = native(self.addresses[f"_{called}"])
                deepest = max(deepest, depth + use.bytes)
                levels = max(levels, NATIVE_LEVELS + use.levels)
        return Use(deepest, levels)


class Program:
    """Flash content with analysed functions."""

    def __init__(self, flash: bytes, byte_code: ByteCode | None = None) -> None:
        """Take the program memory, little endian, 0xFF where nothing was written."""
        self._flash = flash
        self._byte_code = byte_code
        self._known: dict[int, Use] = {}
        self._open: set[int] = set()

    def _word(self, address: int) -> int:
        return self._flash[address] | self._flash[address + 1] << 8

    def _decode(self, address: int) -> Step:
        """Return what the instruction at a byte address does."""
        word = self._word(address)
        if word == 0xFFFF:
            raise UnboundedStackError(f"execution reaches empty flash at 0x{address:04X}")
        step = Step(size=self._size(address))
        if step.size == 4:
            self._decode_long(address, word, step)
        elif word & 0xF000 == 0xD000 or 0xE0 <= word >> 8 <= 0xE7:
            self._decode_relative(address, word, step)
        elif word in RETURNS or word >> 8 == 0x0C or word == 0x00FF:
            step.falls_through = False
        else:
            self._decode_file(address, word, step)
        if word >> 8 in SKIPS:
            step.targets.append(address + step.size + self._size(address + step.size))
        return step

    def _decode_long(self, address: int, word: int, step: Step) -> None:
        """Complete a step for MOVFF, CALL, GOTO and LFSR."""
        if word & 0xF000 == 0xC000:
            destination = self._word(address + 2) & 0xFFF
            step.push = (destination == POSTDEC1) - (word & 0xFFF == PREINC1)
        elif word >> 8 in (0xEC, 0xED):
            step.call = self._long_target(address)
        elif word >> 8 == 0xEF:
            step.targets, step.falls_through = [self._long_target(address)], False

    def _decode_relative(self, address: int, word: int, step: Step) -> None:
        """Complete a step for RCALL, BRA and the conditional branches."""
        bits = 8 if word & 0xF000 == 0xE000 else 11
        offset = word & (1 << bits) - 1
        offset -= (offset & 1 << bits - 1) << 1
        target = address + 2 + 2 * offset
        if bits == 11 and word & 0x0800:
            step.call = target
        else:
            step.targets, step.falls_through = [target], bits == 8

    def _decode_file(self, address: int, word: int, step: Step) -> None:
        """Complete a step for an instruction on a register in the access bank."""
        register = 0xF00 | (word & 0xFF)
        if word & 0x0100 or register < 0xF60:
            return
        operation = word >> 9 << 1
        if register == POSTDEC1 and operation in (0x6E, 0x6A, 0x68):
            step.push = 1
        elif register in (PREINC1, POSTINC1):
            step.push = -1
        elif register == FSR1L and word >> 8 in (0x26, 0x5E):
            literal = self._word(address - 2)
            if literal >> 8 != 0x0E:
                raise UnboundedStackError(f"stack moved by an unknown amount at 0x{address:04X}")
            amount = literal & 0xFF
            step.push = -amount if word >> 8 == 0x26 else amount
        elif register == PCL and word >> 8 in (0x26, 0x6E):
            step.falls_through = False
            step.targets = self._table(address + 2)

    def _table(self, address: int) -> list[int]:
        """Return the entries of a jump table: consecutive GOTO and BRA."""
        entries = []
        while True:
            word = self._word(address)
            if word >> 8 == 0xEF:
                entries.append(address)
                address += 4
            elif word & 0xF800 == 0xD000:
                entries.append(address)
                address += 2
            else:
                return entries

    def _size(self, address: int) -> int:
        word = self._word(address)
        return 4 if word & 0xF000 == 0xC000 or 0xEC <= word >> 8 <= 0xEF else 2

    def _long_target(self, address: int) -> int:
        return 2 * ((self._word(address) & 0xFF) | (self._word(address + 2) & 0xFFF) << 8)

    def use(self, entry: int) -> Use:
        """Return the worst stack use of the function at a byte address, callees included."""
        if entry in self._known:
            return self._known[entry]
        if entry in self._open:
            raise UnboundedStackError(f"recursion through 0x{entry:04X}")
        self._open.add(entry)
        if self._byte_code and entry in self._byte_code.entries:
            use = self._byte_code.use(self._byte_code.entries[entry], self.use)
            self._open.discard(entry)
            self._known[entry] = Use(ENTER_BYTES + use.bytes, use.levels)
            return self._known[entry]
        deepest, levels = 0, 0
        seen: dict[int, int] = {}
        waiting = [(entry, 0)]
        while waiting:
            address, depth = waiting.pop()
            if seen.get(address, -1) >= depth:
                continue
            if depth > 0x100:
                raise UnboundedStackError(f"a loop at 0x{address:04X} keeps pushing")
            seen[address] = depth
            step = self._decode(address)
            if step.call is not None:
                callee = self.use(step.call)
                deepest = max(deepest, depth + callee.bytes)
                levels = max(levels, 1 + callee.levels)
            depth += step.push
            deepest = max(deepest, depth)
            waiting += [(target, depth) for target in step.targets]
            if step.falls_through:
                waiting.append((address + step.size, depth))
        self._open.discard(entry)
        self._known[entry] = Use(deepest, levels)
        return self._known[entry]


def worst_case(flash: bytes, byte_code: ByteCode | None = None) -> Use:
    """Return the stack use of main with both interrupts on top of its deepest point."""
    program = Program(flash, byte_code)
    main, low, high = (program.use(v) for v in (RESET_VECTOR, LOW_VECTOR, HIGH_VECTOR))
    return Use(main.bytes + low.bytes + high.bytes, main.levels + low.levels + high.levels + 2)
