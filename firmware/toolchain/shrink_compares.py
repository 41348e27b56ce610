# SPDX-License-Identifier: Apache-2.0
"""Compares in fewer instructions: with one constant after another, and of 16 bits."""

from collections import Counter

from shrink_flow import BRANCH, Liveness
from shrink_model import Function, Line, Program, places
from shrink_registers import drop_lines
from shrink_simplify import after_skip

ALL_BUT_CARRY = ("W", "Z", "N", "OV", "DC")
INVERSE = {"BZ": "BNZ", "BC": "BNC", "BN": "BNN", "BOV": "BNOV"}
INVERSE |= {after: before for before, after in INVERSE.items()}


def _is_literal(line: Line, op: str) -> bool:
    return line.op == op and line.args[0].startswith("0x")


def _is_load(line: Line) -> bool:
    """Tell whether a line loads WREG from a register."""
    return line.op == "MOVF" and "@" in line.args[0] and line.args[1] == "W"


def compare_on(program: Program) -> None:
    """Compare a register with the next constant without loading it again.

    MOVF r, W; XORLW a; BZ x; MOVF r, W; XORLW b: after the first XORLW, WREG is
    r ^ a, so XORLW a ^ b alone makes r ^ b.
    """
    for function in program.functions.values():
        body = function.body
        gone = []
        register, mask = "", 0  # WREG is this register ^ mask
        for index, line in enumerate(body):
            skipped = after_skip(body, index)
            following = body[index + 1] if index + 1 < len(body) else Line("")
            if skipped or not line.op:
                register = ""
            elif _is_load(line):
                again = line.args[0] == register and _is_literal(following, "XORLW")
                if again and int(following.args[0], 0) != 0:
                    gone.append(index)
                    wanted = int(following.args[0], 0)
                    following.args = [f"0x{wanted ^ mask:02x}"]
                else:
                    register, mask = line.args[0], 0
            elif register and _is_literal(line, "XORLW"):
                mask ^= int(line.args[0], 0)
            elif line.op not in BRANCH:
                register = ""
        drop_lines(function, gone)


def compare_words(program: Program, live: Liveness) -> None:
    """Compare two bytes with borrow instead of the low ones if the high ones are equal.

    load b1; SUBWF a1, W; BNZ x; load b0; SUBWF a0, W; x: becomes
    load b0; SUBWF a0, W; load b1; SUBWFB a1, W. Only the carry is the same.
    """
    for name, function in program.functions.items():
        body = function.body
        used = Counter(arg for line in body for arg in line.args)
        gone: list[int] = []
        for index in range(len(body) - 4):
            length = _high_part(body, index)
            if not length or used[body[index + length + 3].label] != 1:
                continue
            end = index + length + 2
            if any(live.needed(name, end, thing) for thing in ALL_BUT_CARRY):
                continue
            high, low = body[index : index + length], body[end - 1 : end + 1]
            for line in high:
                if line.op == "ADDLW":
                    line.op = "XORLW"
            high[-1].op = "SUBWFB"
            branch = body[index + length]
            body[index : end + 1] = [*low, *high, branch]
            gone.append(end)
        drop_lines(function, gone)


def _high_part(body: list[Line], index: int) -> int:
    """Return how many lines from an index compare the high bytes of two words; 0 if none."""
    if not (_is_load(body[index]) or _is_literal(body[index], "MOVLW")):
        return 0
    flipped = body[index + 1].is_("ADDLW", "0x80")
    length = 3 if flipped else 2
    rest = body[index + length - 1 : index + length + 4]
    if len(rest) < 5 or after_skip(body, index):
        return 0
    high, branch, load, low, label = rest
    return length * (
        high.op == low.op == "SUBWF"
        and high.args[1:] == low.args[1:] == ["W"]
        and ("@" in high.args[0] or high.args[0] == "PRODL")
        and "@" in low.args[0]
        and branch.op == "BNZ"
        and (_is_load(load) or _is_literal(load, "MOVLW"))
        and not label.op
        and branch.args == [label.label]
    )


def branch_over_jumps(function: Function, reach: int) -> None:
    """Turn a branch over a jump into one branch, where it reaches: BNZ x; BRA y; x:."""
    body = function.body
    place, at = places(body)
    gone = []
    for index in range(len(body) - 2):
        line, jump, label = body[index : index + 3]
        if (
            line.op in INVERSE
            and jump.op == "BRA"
            and not jump.pinned
            and (not label.op and line.args == [label.label])
            and jump.args[0] in place
            and abs(place[jump.args[0]] - at[index]) < reach
            and not after_skip(body, index)
        ):
            line.op, line.args = INVERSE[line.op], list(jump.args)
            gone.append(index + 1)
    drop_lines(function, gone)
