# SPDX-License-Identifier: Apache-2.0
"""Puts compiled functions together: places of variables, table of pairs, assembly text."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from bytecode_model import Code, Function, Label, Place
from bytecode_operations import (
    CODE_MAX,
    FIRST_CALL,
    FIRST_PAIR,
    INVERSE,
    JUMPS,
    MEMORY,
    NUMBER,
    PAIRS_MAX,
    WIDE,
    can_pair,
    size,
)
from bytecode_optimise import growth
from bytecode_types import BytecodeError

NATIVES_MAX = 128
LOCALS = "locals"  # label of all local variables
SHORT_REACH = range(-128, 128)


@dataclass
class Module:
    """What one source file adds besides functions: variables and tables."""

    name: str
    variables: list[tuple[str, int, bool]] = field(default_factory=list)  # label, bytes, exported
    tables: dict[str, list[int]] = field(default_factory=dict)


class Frames:
    """Gives local variables addresses; functions that never run at once share them."""

    def __init__(self, functions: list[Function], native_reach: dict[str, set[str]]) -> None:
        """`native_reach`: byte-code functions that a native one leads to."""
        self.functions = {function.name: function for function in functions}
        self.edges: dict[str, set[str]] = {}
        for function in functions:
            self.edges[function.name] = self._reached(function.calls, native_reach)
        for function in functions:
            for waiting, called in function.meanwhile:
                self.edges[waiting] = self.edges[waiting] | self._reached({called}, native_reach)
        self.base: dict[str, int] = {}
        self.open: list[str] = []
        order: list[str] = []
        for name in self.functions:
            self._visit(name, order, set())
        self.base = dict.fromkeys(self.functions, 0)
        for name in reversed(order):
            end = self.base[name] + self._own(name)
            for called in self.edges[name]:
                self.base[called] = max(self.base[called], end)
        self.total = max(self.base[name] + self._own(name) for name in self.functions)

    def _reached(self, calls: set[str], native_reach: dict[str, set[str]]) -> set[str]:
        found = set()
        for name in calls:
            found |= {name} if name in self.functions else native_reach.get(name, set())
        return found

    def _visit(self, name: str, order: list[str], seen: set[str]) -> None:
        if name in self.open:
            raise BytecodeError(f"recursion: {' -> '.join([*self.open, name])}")
        if name in self.base:
            return
        self.open.append(name)
        for called in sorted(self.edges[name]):
            self._visit(called, order, seen)
        self.open.pop()
        self.base[name] = 0
        order.append(name)

    def _own(self, name: str) -> int:
        return sum(kind.size for kind in self.functions[name].locals.values())

    def places(self) -> dict[str, int]:
        """Return the offset of each `function.variable`."""
        found = {}
        for name, function in self.functions.items():
            at = self.base[name]
            for variable, kind in function.locals.items():
                found[f"{name}.{variable}"] = at
                at += kind.size
        return found

    def settle(self) -> None:
        """Give the operations addresses: equal ones of different functions become equal."""
        at = self.places()
        for function in self.functions.values():
            for index, line in enumerate(function.code):
                operand = line.operand if isinstance(line, Code) else None
                if isinstance(line, Code) and isinstance(operand, Place) and operand.symbol in at:
                    place = Place(LOCALS, at[operand.symbol] + operand.offset)
                    function.code[index] = Code(line.op, place, line.extra)


Item = int | tuple[str, str]


class Layout:
    """The bytes of all functions."""

    def __init__(self, functions: list[Function], natives: list[str]) -> None:
        """Choose pairs, then long and short jumps, then offsets."""
        if len(natives) > NATIVES_MAX:
            raise BytecodeError(f"{len(natives)} native functions are called, {NATIVES_MAX} fit")
        self.natives = {name: number for number, name in enumerate(natives)}
        self.functions = functions
        counts = Counter(
            line for f in functions for line in f.code if isinstance(line, Code) and can_pair(line)
        )
        pairs = [code for code, count in counts.most_common(PAIRS_MAX) if count > 2]
        self.pairs = {code: number for number, code in enumerate(pairs)}
        self.long: set[int] = set()
        self.offsets: dict[str, int] = {}
        while self._place():
            pass
        if self.length > CODE_MAX:
            raise BytecodeError(f"{self.length} bytes of byte code, {CODE_MAX} can be called")

    def sizes(self) -> dict[str, int]:
        """Return the bytes of each source file's functions; equal pieces are nobody's."""
        found: Counter[str] = Counter()
        for function in self.functions:
            lines = [line for line in function.code if isinstance(line, Code)]
            found[function.module] += sum(map(self.size, lines))
        return dict(found)

    def size(self, line: Code | Label) -> int:
        """Return the bytes of an operation as it is laid out."""
        if isinstance(line, Code):
            if line in self.pairs:
                return 1
            if id(line) in self.long:
                return 3 if line.op == "jmp" else 8 if line.op == "case" else 5
        return size(line)

    def _place(self) -> bool:
        """Set the offsets; tell whether a jump became a long one."""
        at = 0
        starts: list[tuple[Code, int]] = []
        for function in self.functions:
            self.offsets[function.name] = at
            for index, line in enumerate(function.code):
                if isinstance(line, Label):
                    self.offsets[line.name] = at
                    continue
                here = line
                if line.op in JUMPS or line.op == "case":
                    if id(line) not in self.long:  # one object for each place
                        here = function.code[index] = Code(line.op, line.operand, line.extra)
                    starts.append((here, at + self.size(here)))
                at += self.size(here)
        self.length = at
        grown = False
        for line, end in starts:
            distance = self.offsets[str(line.operand)] - end
            if id(line) not in self.long and distance not in SHORT_REACH:
                self.long.add(id(line))
                grown = True
        return grown

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
        if line in self.pairs:
            return [FIRST_PAIR + self.pairs[line]]
        if line.op in JUMPS or line.op == "case":
            return self._jump(line, at)
        if size(line) == 2:
            return self._two(line)
        return [NUMBER[line.op], *self._operand(line)] if size(line) > 1 else [NUMBER[line.op]]

    def _operand(self, line: Code) -> list[Item]:
        """Return two bytes of operand: a number or an address."""
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
        return [NUMBER[line.op], operand]


def stack_use(functions: list[Function]) -> dict[str, dict[str, object]]:
    """Return for each function the bytes it pushes at most, and what it calls at which depth."""
    found: dict[str, dict[str, object]] = {}
    for function in functions:
        at: dict[str, int] = {}
        depth = deepest = 0
        calls: set[tuple[int, str]] = set()
        for line in function.code:
            if isinstance(line, Label):
                depth = max(depth, at.get(line.name, 0))
                continue
            if line.op in JUMPS or line.op == "case":
                name = str(line.operand)
                at[name] = max(at.get(name, 0), depth)
            if line.op in ("call", "native8", "native16"):
                calls.add((depth, str(line.operand)))
            if line.op in ("jmp", "ret", "ret0", "ret1", "retk"):
                depth = 0
            depth += growth(line)
            deepest = max(deepest, depth)
        found[function.name] = {"bytes": deepest, "calls": sorted(calls)}
    return found


def write(modules: list[Module], layout: Layout, frames: Frames, entries: list[str]) -> str:
    """Return the assembly: stubs, code, tables, variables."""
    defined = {label for module in modules for label, _, _ in module.variables}
    defined |= {label for module in modules for label in module.tables}
    items = [layout.pair_items(), layout.items()]
    names = {item[1] for part in items for item in part if isinstance(item, tuple)}
    symbols = {name.partition("+")[0] for name in names} - {LOCALS}
    natives = [f"_{name}" for name in layout.natives]
    outside = sorted((symbols | set(natives)) - defined)
    lines = ["\tlist\tp=18f4550", "\tradix\tdec", "\tinclude\t<p18f4550.inc>"]
    lines += [f"\textern\t{name}" for name in ["byte_enter", *outside]]
    lines += [f"\tglobal\t{name}" for name in ("byte_code", "byte_pairs", "byte_natives")]
    lines += [f"\tglobal\t_{name}" for name in entries]
    for module in modules:
        lines += [f"\tglobal\t{label}" for label, _, exported in module.variables if exported]
    lines += _variables(modules, frames.total)
    lines.append("byte_stubs\tcode")
    for name in entries:
        place = f"byte_code+{layout.offsets[name]}"
        lines += [f"_{name}:", f"\tmovlw\tLOW({place})", "\tmovwf\tPRODL, ACCESS"]
        lines += [f"\tmovlw\tHIGH({place})", "\tgoto\tbyte_enter"]
    lines.append("byte_tables\tcode")
    for module in modules:
        for label, values in module.tables.items():
            lines.append(f"{label}:")
            lines += _bytes(list(values))
    lines.append("byte_natives:")
    for name in natives:
        lines.append(f"\tdb\tLOW({name}), HIGH({name})")
    lines.append("byte_pairs:")
    lines += _bytes(items[0])
    lines.append("byte_code_area\tcode")
    lines.append("byte_code:")
    lines += _bytes(items[1])
    lines += ["\tend", ""]
    return "\n".join(lines)


def _variables(modules: list[Module], frame: int) -> list[str]:
    lines = ["byte_locals\tudata", f"{LOCALS}\tres\t{max(frame, 1)}"]
    for module in modules:
        for number, (label, count, _) in enumerate(module.variables):
            # A section each, so that the linker can fill what other sections leave.
            lines += [f"{module.name}_{number}_data\tudata", f"{label}\tres\t{count}"]
    return lines


def _bytes(items: list[Item]) -> list[str]:
    """Return db lines of an even number of bytes; gpasm fills up odd ones."""
    texts = []
    for item in items:
        if isinstance(item, tuple):
            symbol, plus, offset = item[1].partition("+")
            texts.append(f"{item[0]}({symbol}+{eval_sum(offset) if plus else 0})")
        else:
            texts.append(f"0x{item:02x}")
    return [f"\tdb\t{', '.join(texts[i : i + 8])}" for i in range(0, len(texts), 8)]


def eval_sum(text: str) -> int:
    """Return the sum of numbers written with plus signs between them."""
    return sum(int(part) for part in text.split("+"))
