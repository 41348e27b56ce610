# SPDX-License-Identifier: Apache-2.0
"""Returns the higher bytes of results in registers instead of PROD and FSR0L.

SDCC returns the bytes of a result in WREG, PRODL, PRODH and FSR0L; the function
copies them there, the caller copies them away. A register of the function in
place of PRODL, PRODH or FSR0L can be the very register in which the value was
made or is wanted, so that one copy or both vanish (shrink_registers.py).
"""

from shrink_flow import RESULT, Liveness, effect, result_name
from shrink_model import Function, Line, Program

RETURN = -1
WRITES = {"MOVWF": 0, "CLRF": 0, "SETF": 0, "MOVFF": 1}


class _Web:
    """Where the values of one core register come from and go to in one function."""

    def __init__(self, function: Function, live: Liveness, name: str) -> None:
        self.body = function.body
        self.graph = live.graph[function.name]
        self.name = name
        self.needed = [live.needed(function.name, i, name) for i in range(len(self.body))]
        self.sources: dict[int, set[int]] = {}
        self.returned: set[int] = set()
        for index, line in enumerate(self.body):
            if self._defines(line) and self.needed[index]:
                self._follow(index)

    def _defines(self, line: Line) -> bool:
        return line.op in ("CALL", "RCALL") or self.name in effect(line).writes

    def _follow(self, definition: int) -> None:
        """Note every use that the value defined at a line can reach."""
        todo = list(self.graph[definition])
        seen = set(todo)
        while todo:
            index = todo.pop()
            line = self.body[index]
            if self.name in effect(line).reads:
                self.sources.setdefault(index, set()).add(definition)
            if self._defines(line) or not self.needed[index]:
                continue
            if not self.graph[index]:
                self.returned.add(definition)
            fresh = [target for target in self.graph[index] if target not in seen]
            seen.update(fresh)
            todo += fresh

    def writes_are_plain(self) -> bool:
        """Tell whether all that reaches a return was written for nothing else."""
        used = set().union(*self.sources.values(), set())
        return not used & self.returned and all(
            self.body[i].op in WRITES and self.body[i].args[WRITES[self.body[i].op]] == self.name
            for i in self.returned
        )

    def reads_of(self, called: str) -> list[int] | None:
        """Return the lines that read the result of calls of a function; None if mixed."""
        calls = {i for i, line in enumerate(self.body) if line.args[:1] == [called]}
        if calls & self.returned:
            return None
        found = []
        for index, sources in self.sources.items():
            if sources & calls:
                line = self.body[index]
                if (
                    not sources <= calls
                    or line.args[0] != self.name
                    or (self.name in line.args[1:] or self.name in effect(line).writes)
                ):
                    return None
                found.append(index)
        return found


def results_in_registers(program: Program, live: Liveness, excluded: set[str]) -> None:
    """Convert each result byte for which function and all calls have a known form.

    `excluded` functions stay as they are: those called from outside, and those
    that interrupt and main loop share.
    """
    for name in RESULT:
        webs = {f.name: _Web(f, live, name) for f in program.functions.values()}
        renames: list[tuple[Line, str]] = []
        for function in program.functions.values():
            if function.name not in excluded and live.returns(function.name, name):
                renames += _renames(program, webs, function, name)
        for line, register in renames:
            line.args = [register if arg == name else arg for arg in line.args]


def _renames(
    program: Program, webs: dict[str, _Web], function: Function, name: str
) -> list[tuple[Line, str]]:
    """Return the lines to change for one result byte of one function; none if unsure."""
    web = webs[function.name]
    register = result_name(function.name, name)
    if not web.returned or not web.writes_are_plain():
        return []
    lines = [function.body[index] for index in web.returned]
    for caller in program.functions.values():
        if function.name in caller.calls():
            reads = webs[caller.name].reads_of(function.name)
            if reads is None:
                return []
            lines += [caller.body[index] for index in reads]
    return [(line, register) for line in lines]
