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


def drop_unneeded(program: Program, live: Liveness, places: bool = False) -> int:
    """Remove instructions that only write what is not needed; return bytes saved.

    With `places`, the registers have got their places: functions share them, so
    only what writes nothing but WREG and flags may go.
    """
    saved = 0
    for name, function in program.functions.items():
        gone = []
        for index, line in enumerate(function.body):
            what = effect(line)
            if what.pure or line.op == "MOVLW" or line.is_("CLRF", "WREG"):
                needed = any(live.needed(name, index, thing) for thing in what.writes)
                needed |= places and not what.writes <= FLAGS | {"W"}
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


def store_less_tests(program: Program, live: Liveness) -> int:
    """Use IORLW 0 where a value is stored only to test it; return bytes saved.

    MOVWF r, MOVF r, W with r not needed afterwards: both set Z and N alike.
    """
    saved = 0
    for name, function in program.functions.items():
        body = function.body
        gone = []
        for index in range(len(body) - 1):
            store, load = body[index], body[index + 1]
            if store.op != "MOVWF" or "@" not in store.args[0] or after_skip(body, index):
                continue
            if load.is_("MOVF", store.args[0], "W") and not (
                live.needed(name, index + 1, store.args[0])
            ):
                load.op, load.args = "IORLW", ["0x00"]
                gone.append(index)
        saved += 2 * len(gone)
        drop_lines(function, gone)
    return saved


def add_into_pointer(program: Program, live: Liveness) -> int:
    """Add an address straight into FSR0 where the sum is needed for nothing else.

    ADDWF a, F; MOVLW h; ADDWFC b, F; MOVFF a, FSR0L; MOVFF b, FSR0H becomes
    ADDWF a, W; MOVWF FSR0L; MOVLW h; ADDWFC b, W; MOVWF FSR0H. Returns bytes saved.
    """
    saved = 0
    for name, function in program.functions.items():
        body = function.body
        for index in range(len(body) - 4):
            if not _is_pointer_sum(body[index : index + 5]) or after_skip(body, index):
                continue
            low, high = body[index].args[0], body[index + 2].args[0]
            if any(live.needed(name, index + 4, thing) for thing in (low, high, "W")):
                continue
            body[index : index + 5] = [
                Line("ADDWF", [low, "W"]),
                Line("MOVWF", ["FSR0L"]),
                body[index + 1],
                Line("ADDWFC", [high, "W"]),
                Line("MOVWF", ["FSR0H"]),
            ]
            saved += 4
    return saved


def _is_pointer_sum(five: list[Line]) -> bool:
    low, literal, high, to_low, to_high = five
    return (
        (low.op, low.args[1:], high.op, high.args[1:]) == ("ADDWF", ["F"], "ADDWFC", ["F"])
        and literal.op == "MOVLW"
        and "@" in low.args[0]
        and "@" in high.args[0]
        and low.args[0] != high.args[0]
        and to_low.is_("MOVFF", low.args[0], "FSR0L")
        and to_high.is_("MOVFF", high.args[0], "FSR0H")
    )
