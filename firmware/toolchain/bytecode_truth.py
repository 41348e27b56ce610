# SPDX-License-Identifier: Apache-2.0
"""Comparisons whose result is 0 or 1: a function for each kind, as calls keep the flags."""

from __future__ import annotations

from collections import Counter

from bytecode_model import Code, Function, Label, Line
from bytecode_operations import INVERSE
from bytecode_types import U8

NUMBERS = {(Code("ld0"), Code("ld1")): False, (Code("ld1"), Code("ld0")): True}
LINES = 6


def share_truths(functions: list[Function]) -> None:
    """Call `jcc x; ld0; jmp y; x: ld1; y:` where the program has it twice at least."""
    found: Counter[str] = Counter()
    for function in functions:
        found.update(filter(None, (_truth(function.code, at) for at in range(len(function.code)))))
    shared = {jump for jump, count in found.items() if count > 1}
    for function in functions:
        at = 0
        while at < len(function.code):
            jump = _truth(function.code, at)
            if jump in shared:
                function.code[at : at + LINES - 1] = [Code("call", f"truth_{jump}")]
                function.calls.add(f"truth_{jump}")
            at += 1
    for jump in sorted(shared):
        name = f"truth_{jump}"
        true = Label(f"{name}@true")
        lines: list[Line] = [Code(jump, true.name), Code("ret0"), true, Code("ret1")]
        functions.append(Function(name, [], U8, lines))


def _truth(code: list[Line], at: int) -> str:
    """Return the jump that leads to 1, empty unless the result is a number."""
    if at + LINES > len(code):
        return ""
    jump, first, over, label, second, end = code[at : at + LINES]
    match jump, first, over, label, second, end:
        case (Code(), Code(), Code(op="jmp"), Label(), Code(), Label()) if jump.op in INVERSE:
            pass
        case _:
            return ""
    inverse = NUMBERS.get((first, second))
    users = [line for line in code if isinstance(line, Code) and line.operand == label.name]
    if inverse is None or users != [jump] or over.operand != end.name:
        return ""
    return INVERSE[jump.op] if inverse else jump.op
