# SPDX-License-Identifier: Apache-2.0
"""Jumps that do not reach their target go to a jump on the way that leads there."""

from __future__ import annotations

from collections.abc import Callable, Collection

from bytecode_model import Code, Function, Label, Line
from bytecode_operations import ENDS

REACH = 100  # bytes; a short jump has 127


def relay(function: Function, far: Collection[int], size: Callable[[Line], int]) -> bool:
    """Give one far jump (`far`: their ids) a nearer target; tell whether one was found.

    A case, which has no long form that is short, gets a jump behind the next end.
    """
    for index, line in enumerate(function.code):
        if isinstance(line, Code) and id(line) in far and "@" in str(line.operand):
            at = _same(function.code, index, line, size)
            if at is None and line.op == "case":
                at = _end(function.code, index, size)
                if at is not None:
                    function.code.insert(at, Code("jmp", line.operand))
            if at is not None:
                label = f"{function.name}@relay{len(function.code)}"
                function.code[index] = Code(line.op, label, line.extra)
                function.code.insert(at, Label(label))
                return True
    return False


def _same(code: list[Line], index: int, line: Code, size: Callable[[Line], int]) -> int | None:
    """Return the index of a jump to the same target that is in reach."""
    for at, other in enumerate(code):
        if at != index and isinstance(other, Code) and other.op == "jmp":
            first, last = sorted((at, index))
            between = sum(size(item) for item in code[first : last + 1])
            if other.operand == line.operand and between < REACH:
                return at
    return None


def _end(code: list[Line], index: int, size: Callable[[Line], int]) -> int | None:
    """Return the index behind the next end."""
    way = 0
    for at in range(index, len(code)):
        line = code[at]
        way += size(line)
        if way > REACH:
            break
        if isinstance(line, Code) and line.op in ENDS:
            return at + 1
    return None
