# SPDX-License-Identifier: Apache-2.0
"""The bytes of byte code: what gets a number of its own, how long jumps are, where all lies.

An operation of two bytes that comes often is one byte: its number in a table of
pairs. For a jump that is its distance, which depends on how long everything in
between is; so pairs are chosen and places are worked out in turns.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from bytecode_model import Code, Function, Label
from bytecode_operations import (
    FIRST_CALL,
    INVERSE,
    JUMPS,
    MEMORY,
    NO_OPERAND,
    NUMBER,
    PAIRS_MAX,
    RARE_NUMBER,
    SMALL,
    WIDE,
    can_pair,
    size,
)
from bytecode_relay import relay
from bytecode_tails import chain, jump
from bytecode_types import BytecodeError

NATIVES_MAX = 128
CALL_PAGES_MAX = 0x60
SHORT_REACH = range(-128, 128)
ROUNDS = 8  # of choosing pairs
SETTLING = 20  # rounds in which a jump may change its mind

Item = int | tuple[str, str]


class Layout:
    """The bytes of all functions."""

    def __init__(self, functions: list[Function], natives: list[str]) -> None:
        """Choose pairs, lengths of jumps, offsets."""
        if len(natives) > NATIVES_MAX:
            raise BytecodeError(f"{len(natives)} native functions are called, {NATIVES_MAX} fit")
        self.natives = {name: number for number, name in enumerate(natives)}
        self.call_pages = 0x20  # of 256 bytes; what numbers calls leave are pairs
        self.functions = chain(functions)
        self.pairs: dict[Code, int] = {}
        self.long: set[int] = set()  # jumps, by id: each is an object of its own
        self.paired: dict[int, Code] = {}  # jumps that are a pair, by id
        self.offsets: dict[str, int] = {}
        self._choose()
        jump(self.functions, self.pairs.__contains__)
        for function in functions:
            function.code = [
                replace(line) if isinstance(line, Code) and _jumps(line) else line
                for line in function.code
            ]
        self._place()
        while any(relay(function, self.long, self.size) for function in self.functions):
            self.long = set()
            self._place()
        for pages in range(CALL_PAGES_MAX):
            self.call_pages = pages
            if pages << 8 >= self.length:
                self._settle()
                if pages << 8 >= self.length:
                    return
        raise BytecodeError(f"{self.length} bytes of byte code, {pages << 8} can be called")

    @property
    def first_pair(self) -> int:
        """Return the first of the numbers behind those of calls."""
        return FIRST_CALL + self.call_pages

    def _choose(self) -> None:
        """Choose the pairs by how often each comes, with the distances as they are."""
        counts = Counter(
            line
            for function in self.functions
            for line in function.code
            if isinstance(line, Code) and can_pair(line)
        )
        if self.offsets:
            counts += Counter(
                Code(line.op, distance)
                for line, distance in self._distances()
                if line.op != "case" and id(line) not in self.long and distance in SHORT_REACH
            )
        room = min(0x100 - self.first_pair, PAIRS_MAX)
        pairs = [code for code, count in counts.most_common(room) if count > 2]
        self.pairs = {code: number for number, code in enumerate(pairs)}

    def _settle(self) -> None:
        """Choose pairs again and again, and keep the shortest result."""
        best: tuple[int, dict[Code, int], set[int], dict[int, Code]] | None = None
        for _ in range(ROUNDS):
            self._choose()
            self._place_paired()
            if best is None or self.length < best[0]:
                best = (self.length, self.pairs, set(self.long), dict(self.paired))
        assert best is not None
        _, self.pairs, self.long, self.paired = best
        self._offsets()

    def _place_paired(self) -> None:
        """Find which jumps can be pairs."""
        self.paired = {}
        self._place()
        pinned: set[int] = set()
        for turn in range(SETTLING * 10):
            wanted = {
                id(line): Code(line.op, distance)
                for line, distance in self._distances()
                if Code(line.op, distance) in self.pairs and line.op != "case"
                if id(line) not in self.long
            }
            if turn >= SETTLING:
                pinned |= {key for key, code in self.paired.items() if wanted.get(key) != code}
                wanted = {
                    key: code
                    for key, code in self.paired.items()
                    if wanted.get(key) == code and key not in pinned
                }
            if wanted == self.paired:
                return
            self.paired = wanted
            self._place()
        raise BytecodeError("the lengths of jumps do not settle")

    def _place(self) -> None:
        """Set the offsets, with long jumps where short ones do not reach."""
        while True:
            self._offsets()
            far = {
                id(line)
                for line, distance in self._distances()
                if id(line) not in self.long and distance not in SHORT_REACH
            }
            if not far:
                return
            self.long |= far

    def _offsets(self) -> None:
        at = 0
        for function in self.functions:
            self.offsets[function.name] = at
            for line in function.code:
                if isinstance(line, Label):
                    self.offsets[line.name] = at
                else:
                    at += self.size(line)
        self.length = at

    def _distances(self) -> list[tuple[Code, int]]:
        """Return the jumps and how far they reach."""
        found = []
        at = 0
        for function in self.functions:
            for line in function.code:
                at += self.size(line)
                if isinstance(line, Code) and _jumps(line):
                    found.append((line, self.offsets[str(line.operand)] - at))
        return found

    def sizes(self) -> dict[str, int]:
        """Return the bytes of each source file's functions; equal pieces are nobody's."""
        found: Counter[str] = Counter()
        for function in self.functions:
            lines = [line for line in function.code if isinstance(line, Code)]
            found[function.module] += sum(map(self.size, lines))
        return dict(found)

    def operations(self) -> dict[str, int]:
        """Return how often each operation of the chip comes, and how often as a pair."""
        found: Counter[str] = Counter()
        for function in self.functions:
            for line in function.code:
                if isinstance(line, Code):
                    paired = self.paired.get(id(line), line) in self.pairs
                    found.update([line.op, f"{line.op} pair"] if paired else [line.op])
                    found["ljmp"] += id(line) in self.long
                    found["rare"] += line.op in RARE_NUMBER
        return dict(found)

    def size(self, line: Code | Label) -> int:
        """Return the bytes of an operation as it is laid out."""
        if isinstance(line, Code):
            if line in self.pairs or id(line) in self.paired:
                return 1
            if id(line) in self.long:
                return 3 if line.op == "jmp" else 8 if line.op == "case" else 5
        return size(line)

    def items(self) -> list[Item]:
        """Return the bytes; those that the linker knows as text (part, expression)."""
        found: list[Item] = []
        for function in self.functions:
            for line in function.code:
                if isinstance(line, Code):
                    found += self._encode(line, len(found))
        if len(found) != self.length:
            raise BytecodeError("an operation has not the size it was laid out with")
        return found

    def pair_items(self) -> list[Item]:
        """Return the bytes of the table of pairs."""
        found: list[Item] = []
        for code in self.pairs:
            found += self._two(code)
        return found

    def _encode(self, line: Code, at: int) -> list[Item]:
        line = self.paired.get(id(line), line)
        if line in self.pairs:
            return [self.first_pair + self.pairs[line]]
        if _jumps(line):
            return self._jump(line, at)
        if line.op == "into":
            return []
        return self._plain(line)

    def _plain(self, line: Code) -> list[Item]:
        if line.op in RARE_NUMBER:
            return [NUMBER["rare"], RARE_NUMBER[line.op], *self._operand(line)]
        if size(line) == 2:
            return self._two(line)
        return [NUMBER[line.op], *self._operand(line)]

    def _operand(self, line: Code) -> list[Item]:
        """Return the operand, two bytes of which are a number or an address."""
        if line.op in NO_OPERAND:
            return []
        if line.op in SMALL:
            assert isinstance(line.operand, int)
            return [line.operand & 0xFF]
        if isinstance(line.operand, int):
            return [line.operand & 0xFF, line.operand >> 8]
        low_high: list[Item] = [("LOW", str(line.operand)), ("HIGH", str(line.operand))]
        return low_high if line.op in WIDE or line.op.startswith("ldt") else low_high[::-1]

    def _jump(self, line: Code, at: int) -> list[Item]:
        target = self.offsets[str(line.operand)]
        distance = (target - at - self.size(line)) & 0xFF
        far = [NUMBER["ljmp"], target & 0xFF, target >> 8]
        if line.op == "case":
            assert line.extra is not None
            if id(line) in self.long:  # when equal on to the long jump, else over it
                return [NUMBER["case"], line.extra, 2, NUMBER["jmp"], 3, *far]
            return [NUMBER["case"], line.extra, distance]
        if id(line) not in self.long:
            return [NUMBER[line.op], distance]
        return [*far] if line.op == "jmp" else [NUMBER[INVERSE[line.op]], 3, *far]

    def _two(self, line: Code) -> list[Item]:
        operand = line.operand
        if line.op == "call":
            at = self.offsets[str(operand)]
            return [FIRST_CALL + (at >> 8), at & 0xFF]
        if line.op in MEMORY:
            place = f"{operand}+{MEMORY[line.op] << 8}"
            return [("HIGH", place), ("LOW", place)]
        if line.op in ("native8", "native16"):
            return [NUMBER[line.op], self.natives[str(operand)]]
        assert isinstance(operand, int), line
        return [NUMBER[line.op], operand & 0xFF]


def _jumps(line: Code | Label) -> bool:
    return isinstance(line, Code) and (line.op in JUMPS or line.op == "case")
