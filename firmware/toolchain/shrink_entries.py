# SPDX-License-Identifier: Apache-2.0
"""Stands in for byte code while the native program is shrunk.

What byte code calls is called from outside the compiled assembly. So that the
registers and the levels of the return stack are counted right, each entry into
byte code is, for a while, a function that calls all native functions it can
lead to, one level deeper as the interpreter does.
"""

import json
from pathlib import Path

from shrink_model import Function, Line, Program

INTERPRETER = "byte_enter"
FILE = "byte code"


def read_entries(path: Path) -> dict[str, list[str]]:
    """Return entry -> labels of the native functions it leads to, from compile_bytecode.py."""
    report = json.loads(path.read_text())
    functions = report["functions"]
    found = {}
    for entry in report["entries"]:
        seen, natives, todo = {entry}, set(), [entry]
        while todo:
            for _, called in functions[todo.pop()]["calls"]:
                if called not in functions:
                    natives.add(f"_{called}")
                elif called not in seen:
                    seen.add(called)
                    todo.append(called)
        found[f"_{entry}"] = sorted(natives)
    return found


def add_entries(program: Program, entries: dict[str, list[str]]) -> None:
    """Put the stand-ins in."""
    for name, natives in entries.items():
        below = f"{name}_below"
        _add(program, name, [below])
        _add(program, below, natives)


def _add(program: Program, name: str, calls: list[str]) -> None:
    body = [Line("", label=name)]
    body += [Line("CALL", [called]) for called in calls]
    # Whatever a caller keeps in core registers is lost.
    body += [Line("CALL", [INTERPRETER]), Line("RETURN")]
    program.functions[name] = Function(name, FILE, body)


def remove_entries(program: Program, order: list[str], entries: dict[str, list[str]]) -> list[str]:
    """Take the stand-ins out again; returns the order without them."""
    for name in entries:
        del program.functions[name], program.functions[f"{name}_below"]
    return [name for name in order if name in program.functions]
