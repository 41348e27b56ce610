# SPDX-License-Identifier: Apache-2.0
"""Passes arguments in fixed places instead of on the software stack.

SDCC pushes each argument byte, the last first; the function points FSR2 at the
stack, fetches each byte with MOVLW offset, MOVFF PLUSW2; the caller drops them.
Where all of that has the known form, at every call, each byte is written to a
register of the called function instead.
"""

from shrink_flow import BRANCH, JUMPS, Liveness, effect, successors
from shrink_model import SKIPS, Function, Line, Program, RefusalError
from shrink_registers import drop_lines, find_frame

PUSH_OPS = {"MOVWF", "CLRF", "SETF"}
CONTROL = {"CALL", "RCALL", "RETURN", "RETFIE", "RETLW"} | JUMPS | set(BRANCH) | SKIPS
FIRST_OFFSET = 2


def is_push(line: Line) -> bool:
    """Tell whether a line pushes one byte."""
    return (line.op in PUSH_OPS and line.args[:1] == ["POSTDEC1"]) or (
        line.op == "MOVFF" and line.args[1] == "POSTDEC1"
    )


def argument_name(function: str, number: int) -> str:
    """Return the register for byte `number` (0 is pushed last) of the arguments."""
    return f"{function}@arg{number}"


class _Call:
    """The pushes before and the drops after one call."""

    def __init__(self, function: Function, index: int) -> None:
        self.function = function
        self.drops: list[int] = []
        self.count = 0
        self._find_drops(index + 1)
        self.pushes = self._find_pushes(index - 1)

    def _find_drops(self, index: int) -> None:
        body = self.function.body
        while index < len(body) and body[index].op and body[index].op not in CONTROL:
            line = body[index]
            if is_push(line) or (line.op == "MOVFF" and line.args[0] == "PREINC1"):
                return
            if line.is_("MOVF", "POSTINC1", "F"):
                self.drops.append(index)
                self.count += 1
            elif line.is_("ADDWF", "FSR1L", "F"):
                if body[index - 1].op != "MOVLW":
                    self.count = -1
                    return
                self.drops.append(index)
                self.count += int(body[index - 1].args[0], 0)
            index += 1

    def _find_pushes(self, index: int) -> list[int]:
        """Return the pushes, nearest first; fewer than `count` when unsure."""
        body = self.function.body
        found: list[int] = []
        while len(found) < self.count and index > 0:
            line = body[index]
            if not line.op or line.op in CONTROL or {"PREINC1", "POSTINC1"} & set(line.args):
                return found
            if body[index - 1].op in SKIPS:
                return found
            if is_push(line):
                found.append(index)
            index -= 1
        return found

    def known(self, live: Liveness) -> bool:
        """Tell whether the call has the known form and its drops may vanish."""
        if self.count < 0 or len(self.pushes) != self.count:
            return False
        name = self.function.name
        for index in self.drops:
            lost = effect(self.function.body[index]).writes
            if any(live.needed(name, index, thing) for thing in lost):
                return False
            if self.function.body[index - 1].op in SKIPS:
                return False
        return True


def _fetches(function: Function, live: Liveness, count: int) -> dict[int, int] | None:
    """Return line -> argument byte for the fetches, None if FSR2 is used otherwise."""
    body = function.body
    found: dict[int, int] = {}
    for index, line in enumerate(body):
        if "PLUSW2" in line.args:
            before = body[index - 1]
            if line.op != "MOVFF" or line.args[0] != "PLUSW2" or before.op != "MOVLW":
                return None
            number = int(before.args[0], 0) - FIRST_OFFSET
            if not 0 <= number < count or body[index - 2].op in SKIPS:
                return None
            found[index] = number
        elif any(
            arg in ("FSR2L", "FSR2H", "INDF2", "POSTINC2", "POSTDEC2", "PREINC2")
            for arg in line.args
        ) and line.args not in (["FSR2L", "POSTDEC1"], ["FSR1L", "FSR2L"], ["PREINC1", "FSR2L"]):
            return None
    return found


def static_arguments(program: Program, live: Liveness, excluded: set[str]) -> list[str]:
    """Convert every function that can be; return their names.

    `excluded` functions keep the stack: those that code outside the program
    calls, and those that interrupt and main loop share.
    """
    calls: dict[str, list[_Call]] = {name: [] for name in program.functions}
    sites: dict[str, list[tuple[Function, int]]] = {name: [] for name in program.functions}
    for function in program.functions.values():
        for index, line in enumerate(function.body):
            if line.op in ("CALL", "RCALL") and line.args[0] in calls:
                calls[line.args[0]].append(_Call(function, index))
                sites[line.args[0]].append((function, index))
    drops: dict[str, list[int]] = {name: [] for name in program.functions}
    done = []
    for name, function in program.functions.items():
        counts = {call.count for call in calls[name]}
        if name in excluded or len(counts) != 1 or counts == {0}:
            continue
        frame = find_frame(function)
        fetches = _fetches(function, live, counts.pop())
        if frame is None or fetches is None or not all(c.known(live) for c in calls[name]):
            continue
        _convert_function(function, frame.pointer, fetches, drops[name])
        for call in calls[name]:
            _convert_call(call, name, drops[call.function.name])
        done.append(name)
    for name, lines in drops.items():
        drop_lines(program.functions[name], lines)
    return done


def _convert_function(
    function: Function, pointer: list[int], fetches: dict[int, int], drops: list[int]
) -> None:
    drops += pointer  # each MOVLW of an offset stays until nothing needs it
    for index, number in fetches.items():
        function.body[index].args[0] = argument_name(function.name, number)


def _convert_call(call: _Call, name: str, drops: list[int]) -> None:
    drops += call.drops
    for number, index in enumerate(call.pushes):
        line = call.function.body[index]
        line.args[1 if line.op == "MOVFF" else 0] = argument_name(name, number)


def check_stack(program: Program) -> None:
    """Raise RefusalError unless every function leaves the software stack as it was."""
    for function in program.functions.values():
        depth: dict[int, int] = {0: 0}
        todo = [0]
        graph = successors(function)
        while todo:
            index = todo.pop()
            line = function.body[index]
            if line.op == "CALL" and line.args[0].startswith("__gptrput"):
                raise RefusalError(f"{function.name}: write through a generic pointer; use __data")
            here = depth[index] + _growth(function, index)
            if line.op in ("RETURN", "RETFIE") and here != 0:
                raise RefusalError(f"{function.name}: stack is off by {here} at a return")
            for target in graph[index]:
                if target not in depth:
                    depth[target] = here
                    todo.append(target)
                elif depth[target] != here:
                    raise RefusalError(f"{function.name}: stack differs at {target}")


def _growth(function: Function, index: int) -> int:
    line = function.body[index]
    if is_push(line):
        return 1
    if line.args[:1] in (["PREINC1"], ["POSTINC1"]):
        return -1
    if line.is_("ADDWF", "FSR1L", "F"):
        return -int(function.body[index - 1].args[0], 0)
    return 0
