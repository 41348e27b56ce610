# SPDX-License-Identifier: Apache-2.0
"""Shortens the ways through a function: jumps to jumps, to returns, over nothing."""

import itertools

from shrink_compares import branch_over_jumps
from shrink_model import Function, Line, Program, places
from shrink_registers import drop_lines
from shrink_simplify import after_skip

JUMPS = ("BRA", "GOTO")
BRANCH_REACH = 254  # bytes forward, 256 backward: what a conditional branch reaches
JUMP_REACH = 2046  # the same for BRA
ON_FLAG = {
    ("BTFSC", "0"): "BC",
    ("BTFSS", "0"): "BNC",
    ("BTFSC", "2"): "BZ",
    ("BTFSS", "2"): "BNZ",
    ("BTFSC", "4"): "BN",
    ("BTFSS", "4"): "BNN",
}


def shorten_ways(program: Program) -> None:
    """Apply all rules of this module until nothing changes."""
    for function in program.functions.values():
        before = -1
        while before != function.size():
            before = function.size()
            _thread(function)
            _jumps_to_return(function)
            _drop_unreachable(function)
            _drop_jumps_to_next(function)
            _branch_on_flags(function)
            branch_over_jumps(function, BRANCH_REACH)


def _destinations(body: list[Line]) -> dict[str, Line]:
    """Return for each label the first instruction after it."""
    found: dict[str, Line] = {}
    waiting: list[str] = []
    for line in body:
        if not line.op:
            waiting.append(line.label)
            continue
        found.update(dict.fromkeys(waiting, line))
        waiting = []
    return found


def _thread(function: Function) -> None:
    """Let each BRA to a BRA go where that one goes."""
    first = _destinations(function.body)
    if function.size() > JUMP_REACH:
        return
    for line in function.body:
        if line.op not in JUMPS or line.pinned:
            continue
        seen: set[str] = set()
        while line.args[0] in first and line.args[0] not in seen:
            seen.add(line.args[0])
            then = first[line.args[0]]
            if then.op != "BRA" or then.args[0] not in first:
                break
            line.args = list(then.args)


def _jumps_to_return(function: Function) -> None:
    """Turn each BRA to a RETURN into the RETURN itself (as long, but quicker)."""
    first = _destinations(function.body)
    for line in function.body:
        if line.op == "BRA" and line.args[0] in first and first[line.args[0]].op == "RETURN":
            line.op, line.args = "RETURN", []


def _drop_unreachable(function: Function) -> None:
    """Remove labels nobody names and what only they made reachable."""
    body = function.body
    named = " ".join(arg for line in body for arg in line.args)
    gone = []
    ended = False
    for index, line in enumerate(body):
        if not line.op:
            table = index + 1 < len(body) and body[index + 1].pinned
            if index and line.label not in named and not table:
                gone.append(index)
            else:
                ended = False
        elif ended:
            gone.append(index)
        elif line.op in (*JUMPS, "RETURN", "RETFIE") and not line.pinned:
            ended = not after_skip(body, index)
        elif line.is_("MOVWF", "PCL"):
            ended = True
    drop_lines(function, gone)


def _drop_jumps_to_next(function: Function) -> None:
    body = function.body
    gone = []
    for index, line in enumerate(body):
        if line.op in ("BRA", "BZ", "BNZ", "BC", "BNC", "BN", "BNN") and not (
            after_skip(body, index)
        ):
            following = index + 1
            while following < len(body) and not body[following].op:
                if body[following].label == line.args[0]:
                    gone.append(index)
                    break
                following += 1
    drop_lines(function, gone)


def _branch_on_flags(function: Function) -> None:
    """Turn a skip on a flag and the jump it skips into one branch, where it reaches."""
    body = function.body
    place, at = places(body)
    gone = []
    for index, (line, jump) in enumerate(itertools.pairwise(body)):
        branch = ON_FLAG.get((line.op, line.args[-1])) if line.args[:1] == ["STATUS"] else None
        if branch is None or jump.op != "BRA" or jump.args[0] not in place:
            continue
        if abs(place[jump.args[0]] - at[index]) < BRANCH_REACH and not after_skip(body, index):
            jump.op = branch
            gone.append(index)
    drop_lines(function, gone)


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


def return_values(program: Program) -> None:
    """Return a value from WREG where it is stored only to be fetched by the common end.

    MOVWF r (or CLRF r), BRA end; end: MOVF r, W, RETURN. SDCC passes no flags on.
    """
    for function in program.functions.values():
        body = function.body
        ends = {
            line.label: body[index + 1].args[0]
            for index, line in enumerate(body[:-2])
            if body[index + 1].op == "MOVF"
            and body[index + 1].args[1:] == ["W"]
            and body[index + 2].op == "RETURN"
            and not line.op
        }
        entered = []
        for index, (store, jump) in enumerate(itertools.pairwise(body)):
            if store.op not in ("MOVWF", "CLRF") or after_skip(body, index):
                continue
            end = jump.args[0] if jump.op == "BRA" else jump.label
            if "@r0x" in store.args[0] and ends.get(end) == store.args[0]:
                if jump.op == "BRA":
                    jump.op, jump.args = "RETURN", []
                else:
                    entered.append(index + 1)
                if store.op == "CLRF":
                    store.args = ["WREG"]
        for index in reversed(entered):
            body.insert(index, Line("RETURN"))


def return_literals(program: Program) -> int:
    """Use RETLW for a literal and a return; return bytes saved."""
    saved = 0
    for function in program.functions.values():
        body = function.body
        gone = []
        for index, (load, end) in enumerate(itertools.pairwise(body)):
            zero = load.is_("CLRF", "WREG")
            number = load.op == "MOVLW" and load.args[0].startswith("0x")
            if end.op == "RETURN" and (zero or number) and not after_skip(body, index):
                load.op, load.args = "RETLW", ["0x00"] if zero else load.args
                gone.append(index + 1)
        saved += 2 * len(gone)
        drop_lines(function, gone)
    return saved
