# SPDX-License-Identifier: Apache-2.0
"""Puts compiled functions together: the stack they use, assembly text."""

from __future__ import annotations

from dataclasses import dataclass, field

from bytecode_frames import LOCALS, Frames
from bytecode_layout import Item, Layout
from bytecode_model import Function, Label
from bytecode_operations import JUMPS
from bytecode_optimise import growth

BYTE_SYMBOLS = ("byte_code", "byte_pairs", "byte_natives", "byte_first_pair")


@dataclass
class Module:
    """What one source file adds besides functions: variables and tables."""

    name: str
    variables: list[tuple[str, int, bool]] = field(default_factory=list)  # label, bytes, exported
    tables: dict[str, list[int]] = field(default_factory=dict)


def stack_use(functions: list[Function]) -> dict[str, dict[str, object]]:
    """Return for each function the bytes it pushes at most, and what it calls at which depth."""
    found: dict[str, dict[str, object]] = {}
    names = {function.name for function in functions}
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
            if line.op in ("call", "native8", "native16") or line.operand in names:
                calls.add((depth, str(line.operand)))
            if line.op in ("jmp", "into", "ret", "ret0", "ret1", "retk"):
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
    lines += [f"\tglobal\t{name}" for name in BYTE_SYMBOLS]
    lines += [f"\tglobal\t_{name}" for name in entries]
    for module in modules:
        lines += [f"\tglobal\t{label}" for label, _, exported in module.variables if exported]
    lines += _variables(modules, frames.total)
    # A number that the linker puts into the interpreter, as the address of nothing.
    lines += [f"byte_numbers\tudata\t{layout.first_pair}", "byte_first_pair\tres\t0"]
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
