# SPDX-License-Identifier: Apache-2.0
"""Puts functions that are called once in the place of the call.

That saves the CALL, the RETURN and a level of the return stack.
"""

import itertools
from collections import Counter

from shrink_flow import BRANCH
from shrink_model import Function, Line, Program, places
from shrink_simplify import after_skip

BRANCH_REACH = 254  # bytes; a conditional branch backward reaches 256
LITERALS = ("MOVLW", "CLRF")


def inline_single_calls(program: Program, excluded: set[str], keeping: set[str]) -> list[str]:
    """Inline what is called once; return the names of the functions that vanish.

    `excluded` functions stay: those entered from elsewhere. Functions called by
    those in `keeping` stay too.
    """
    done = []
    calls = Counter(name for f in program.functions.values() for name in f.calls())
    callers = {name: f for f in program.functions.values() for name in f.calls()}
    for name in list(program.functions):
        if calls[name] != 1 or name in excluded or callers[name].name in keeping:
            continue
        caller = callers[name]
        body = _joined(caller, program.functions[name])
        if body is None:
            continue
        caller.body[:] = body
        for called in program.functions[name].calls():
            callers[called] = caller
        del program.functions[name]
        program.globals = [other for other in program.globals if other != name]
        program.externs.discard(name)
        done.append(name)
    return done


def _joined(caller: Function, called: Function) -> list[Line] | None:
    """Return the caller's lines with those of the called function; None if no use."""
    index = next(i for i, line in enumerate(caller.body) if line.args[:1] == [called.name])
    if after_skip(caller.body, index):
        return None
    last = index + 1 < len(caller.body) and caller.body[index + 1].op == "RETURN"
    inner = called.body[1:]
    if not inner or inner[-1].op not in ("RETURN", "GOTO", "BRA"):
        return None
    if last:
        return _if_in_reach(caller, [*caller.body[:index], *inner, *caller.body[index + 2 :]])
    returns = sum(
        load.op in LITERALS and end.op == "RETURN" for load, end in itertools.pairwise(inner)
    )
    if returns > 1 or any(line.op in ("RETLW", "RETFIE") for line in inner):
        return None
    after = f"_end{called.name}"
    inner = [Line("BRA", [after]) if line.op == "RETURN" else line for line in inner]
    ended = Line("", label=after)
    return _if_in_reach(caller, [*caller.body[:index], *inner, ended, *caller.body[index + 1 :]])


def _if_in_reach(caller: Function, body: list[Line]) -> list[Line] | None:
    """Return the lines if all conditional branches reach as they did; None if not."""
    place, at = places(body)
    if at[-1] + body[-1].size() > 2000:
        return None
    for line, here in zip(body, at, strict=True):
        if line.op in BRANCH and abs(place[line.args[0]] - here) > BRANCH_REACH:
            return None
    return body
