# SPDX-License-Identifier: Apache-2.0
"""Calls behind which nothing comes: the called function is placed there, or jumped to.

`into` is no operation of the chip: what it names follows.
"""

from __future__ import annotations

from collections.abc import Callable

from bytecode_model import Code, Function, Line

RETURN = Code("ret")


def chain(functions: list[Function]) -> list[Function]:
    """Return the functions in an order in which many lead into the next one without a call."""
    known = {function.name: function for function in functions}
    after: dict[str, str] = {}
    taken: set[str] = set()
    for function in functions:
        called = _last_call(function.code)
        if called in known and called not in taken and _end(after, called) != function.name:
            after[function.name] = called
            taken.add(called)
            function.code[-2:] = [Code("into", called)]
    ordered = []
    for function in functions:
        name: str | None = function.name if function.name not in taken else None
        while name is not None:
            ordered.append(known[name])
            name = after.get(name)
    return ordered


def _last_call(code: list[Line]) -> str:
    call = code[-2] if len(code) > 1 else None
    found = isinstance(call, Code) and call.op == "call" and code[-1] == RETURN
    return str(call.operand) if found and isinstance(call, Code) else ""


def _end(after: dict[str, str], name: str) -> str:
    while name in after:
        name = after[name]
    return name


def jump(functions: list[Function], stays: Callable[[Code], bool]) -> None:
    """Make jumps of the calls at the end, but for those that stay: in one byte."""
    for function in functions:
        index = 0
        while index + 1 < len(function.code):
            line, following = function.code[index : index + 2]
            if (
                isinstance(line, Code)
                and line.op == "call"
                and following == RETURN
                and not stays(line)
            ):
                function.code[index : index + 2] = [Code("jmp", line.operand)]
            index += 1
