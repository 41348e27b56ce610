# SPDX-License-Identifier: Apache-2.0
"""Puts functions of byte code that are called once where they are called."""

from __future__ import annotations

from collections import Counter

from bytecode_model import Code, Function, Label
from bytecode_operations import size

#: Bytes that a function may grow to: jumps reach 128 bytes, longer ones take five.
GROWN_MAX = 240


def inline(functions: list[Function], entries: set[str]) -> list[Function]:
    """Return the functions that are left; `entries` are called from elsewhere too."""
    left = {function.name: function for function in functions}
    while True:
        calls = Counter(
            str(line.operand)
            for function in left.values()
            for line in function.code
            if isinstance(line, Code) and line.op == "call"
        )
        found = _candidate(left, {n for n, count in calls.items() if count == 1} - entries)
        if found is None:
            return list(left.values())
        caller, index = found
        line = caller.code[index]
        assert isinstance(line, Code)
        called = left.pop(str(line.operand))
        caller.code[index : index + 1] = _body(called, _at_end(caller, index))
        caller.absorbed |= called.own_symbols()
        caller.calls |= called.calls


def _candidate(left: dict[str, Function], once: set[str]) -> tuple[Function, int] | None:
    for function in left.values():
        for index, line in enumerate(function.code):
            if isinstance(line, Code) and line.op == "call" and line.operand in once:
                called = left[str(line.operand)]
                grown = _bytes(function) + _bytes(called)
                returns = sum(_is_return(called, at) for at in range(len(called.code)))
                if grown <= GROWN_MAX and (returns <= 3 or _at_end(function, index)):
                    return function, index
    return None


def _bytes(function: Function) -> int:
    return sum(map(size, function.code))


def _at_end(function: Function, index: int) -> bool:
    following = function.code[index + 1] if index + 1 < len(function.code) else None
    return following == Code("ret")


def _is_return(function: Function, index: int) -> bool:
    line = function.code[index] if index < len(function.code) else None
    return isinstance(line, Code) and line.op in ("ret", "ret0", "ret1", "retk")


LOADS = {"ret0": Code("ld0"), "ret1": Code("ld1")}


def _body(called: Function, at_end: bool) -> list[Code | Label]:
    """Return what stands for a call; `at_end`: a return follows it."""
    end = f"{called.name}@return"
    lines: list[Code | Label] = []
    for line in called.code:
        if isinstance(line, Label) or line.op not in ("ret", "ret0", "ret1", "retk"):
            lines.append(line)
            continue
        if at_end:
            lines.append(line)
            continue
        if line.op == "retk":
            lines.append(Code("ldk", line.operand))
        elif line.op != "ret":
            lines.append(LOADS[line.op])
        lines.append(Code("jmp", end))
    return [*lines, Label(end)]
