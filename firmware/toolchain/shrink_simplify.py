# SPDX-License-Identifier: Apache-2.0
"""Removes instructions whose results nothing needs, and repeated loads."""

from shrink_flow import FLAGS, Liveness, effect
from shrink_model import SKIPS, Function, Line, Program
from shrink_registers import drop_lines


def after_skip(body: list[Line], index: int) -> bool:
    """Tell whether a line is the one that a skip instruction skips."""
    index -= 1
    while index > 0 and not body[index].op:
        index -= 1
    return body[index].op in SKIPS


def drop_unneeded(program: Program, live: Liveness) -> int:
    """Remove instructions that only write what is not needed; return bytes saved."""
    saved = 0
    for name, function in program.functions.items():
        gone = []
        for index, line in enumerate(function.body):
            what = effect(line)
            if what.pure or line.op == "MOVLW" or line.is_("CLRF", "WREG"):
                needed = any(live.needed(name, index, thing) for thing in what.writes)
                if not needed and not after_skip(function.body, index):
                    gone.append(index)
        saved += sum(function.body[i].size() for i in gone)
        drop_lines(function, gone)
    return saved


def drop_repeated_loads(program: Program, live: Liveness) -> int:
    """Remove moves to where the value already is; return bytes saved.

    Follows which registers WREG equals between labels and calls.
    """
    saved = 0
    for name, function in program.functions.items():
        gone = _repeated(name, function, live)
        saved += sum(function.body[i].size() for i in gone)
        drop_lines(function, gone)
    return saved


def _repeated(name: str, function: Function, live: Liveness) -> list[int]:
    equal: set[str] = set()
    gone = []
    body = function.body
    for index, line in enumerate(body):
        skipped = after_skip(body, index)
        if line.op == "MOVFF" and line.args[0] == line.args[1] and not skipped:
            gone.append(index)
            continue
        if not skipped and _is_register(line) and line.args[0] in equal:
            flags = any(live.needed(name, index, f) for f in effect(line).writes & FLAGS)
            if line.op == "MOVWF" or (line.args[1] == "W" and not flags):
                gone.append(index)
                continue
        equal = _equal_after(line, equal, skipped)
    return gone


def _is_register(line: Line) -> bool:
    return line.op in ("MOVF", "MOVWF") and ("@" in line.args[0])


def _equal_after(line: Line, equal: set[str], skipped: bool) -> set[str]:
    """Return the registers that surely hold what WREG holds after a line."""
    if not line.op or line.op in ("CALL", "RCALL"):
        return set()
    writes = effect(line).writes
    if line.op == "MOVF" and line.args[1] == "F":
        return equal
    if line.op == "MOVWF" and "@" in line.args[0] and not skipped:
        return equal | {line.args[0]}
    if line.op == "MOVF" and line.args[1] == "W" and "@" in line.args[0] and not skipped:
        return {line.args[0]} | (equal if line.args[0] in equal else set())
    if "W" in writes:
        return set()
    return equal - writes


def tail_calls(program: Program) -> int:
    """Turn each CALL right before RETURN into a jump; return bytes saved."""
    saved = 0
    for function in program.functions.values():
        body = function.body
        gone = []
        for index in range(len(body) - 1):
            if (
                body[index].op == "CALL"
                and body[index + 1].op == "RETURN"
                and not (after_skip(body, index))
            ):
                body[index].op = "GOTO"
                gone.append(index + 1)
                saved += 2
        drop_lines(function, gone)
    return saved


def jumps_to_return(program: Program) -> None:
    """Turn each BRA to a RETURN into the RETURN itself (as long, but quicker)."""
    for function in program.functions.values():
        body = function.body
        for line in body:
            if line.op == "BRA" and line.args[0] in _return_labels(body):
                line.op, line.args = "RETURN", []


def _return_labels(body: list[Line]) -> set[str]:
    found: set[str] = set()
    waiting: set[str] = set()
    for line in body:
        if not line.op:
            waiting.add(line.label)
        else:
            if line.op == "RETURN":
                found |= waiting
            waiting = set()
    return found
