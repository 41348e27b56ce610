# SPDX-License-Identifier: Apache-2.0
"""Puts variables into few banks and drops the bank selections that become needless.

SDCC gives each variable a section of its own, so it must select the bank for
each. Here they share sections that lie in one bank each, the most used ones in
the first; a BANKSEL goes where the bank is already the right one on every path
through the program, and comes where SDCC has forgotten it. Variables
of the access bank need none at all.
"""

import re
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

from shrink_flow import successors
from shrink_model import Function, Line, Program, RefusalError
from shrink_registers import drop_lines
from shrink_simplify import after_skip

BANK_BYTES = 256
PLAIN_SECTION = re.compile(r"^\S+\s+udata$", re.IGNORECASE)
VARIABLE = re.compile(r"^(_\w+)\s+res\s+(\d+)$", re.IGNORECASE)
SECTION = re.compile(r"^(\w+)\s+(udata\w*|code)\b\s*(\S*)", re.IGNORECASE)
SYMBOL = re.compile(r"_\w+")
UNKNOWN = "?"
UNREACHED = ""


def symbol(operand: str) -> str:
    """Return the variable that an operand such as (_x + 1) belongs to."""
    found = SYMBOL.search(operand)
    return found.group(0) if found else operand


def _plain_variables(program: Program) -> tuple[list[str], dict[str, int]]:
    """Split the data into lines to keep and variables that may go anywhere."""
    kept: list[str] = []
    free: dict[str, int] = {}
    plain = False
    for line in program.data:
        variable = VARIABLE.match(line)
        if variable is None:
            plain = bool(PLAIN_SECTION.match(line))
            if not plain:
                kept.append(line)
        elif plain:
            free[variable.group(1)] = int(variable.group(2))
        else:
            kept.append(line)
    return kept, free


def group_variables(program: Program) -> dict[str, str]:
    """Move free variables into sections of at most one bank; return variable -> section."""
    kept, free = _plain_variables(program)
    used = Counter(
        symbol(line.args[0])
        for function in program.functions.values()
        for line in function.body
        if line.op == "BANKSEL"
    )
    sections: list[dict[str, int]] = []
    for name in sorted(free, key=lambda n: (-used[n] / free[n], n)):
        room = (s for s in sections if sum(s.values()) + free[name] <= BANK_BYTES)
        section = next(room, None)
        if section is None:
            section = {}
            sections.append(section)
        section[name] = free[name]
    program.data = kept
    where: dict[str, str] = {}
    for number, section in enumerate(sections):
        program.data.append(f"variables_{number}\tudata")
        program.data += [f"{name}\tres\t{size}" for name, size in section.items()]
        where.update(dict.fromkeys(section, f"variables_{number}"))
    return where


def assembly_sections(text: str) -> tuple[dict[str, str], set[str]]:
    """Return variable -> section of hand-written assembly, and those in the access bank.

    A section that is not the access bank's lies in one bank, because the
    linker script has no region that spans two.
    """
    where: dict[str, str] = {}
    access: set[str] = set()
    section = kind = ""
    for raw in text.splitlines():
        line = raw.split(";")[0].rstrip()
        opened = SECTION.match(line)
        if opened:
            section, kind = opened.group(1), opened.group(2).lower()
            continue
        variable = re.match(r"^(_\w+):?\s+res\b", line, re.IGNORECASE)
        if variable and kind == "udata_acs":
            access.add(variable.group(1))
        elif variable and kind == "udata":
            where[variable.group(1)] = section
    return where, access


def selected_by(program: Program, assembly: str) -> Callable[[str], str]:
    """Return what tells the section that selecting a variable's bank selects."""
    where, _ = assembly_sections("\n".join([*program.data, assembly]))
    return lambda operand: where.get(symbol(operand), symbol(operand))


def use_access_bank(program: Program, access: set[str]) -> None:
    """Reach variables of the access bank without selecting a bank."""
    for function in program.functions.values():
        gone = []
        for index, line in enumerate(function.body):
            if not line.args or symbol(line.args[0]) not in access:
                continue
            if line.op == "BANKSEL" and not after_skip(function.body, index):
                gone.append(index)
            elif line.op != "BANKSEL" and line.args[-1] == "B" and len(line.args) > 1:
                line.args[-1] = "A"
        drop_lines(function, gone)


@dataclass
class _States:
    """The selected bank before each line, on entry and on return of a function."""

    graph: list[list[int]]
    before: list[str] = field(default_factory=list)
    entry: str = UNREACHED
    exit: str = UNREACHED


def _met(one: str, two: str) -> str:
    """Return what is known where two paths meet."""
    if UNREACHED in (one, two):
        return one or two
    return one if one == two else UNKNOWN


class Banks:
    """Which bank is selected where, over the whole program."""

    def __init__(self, program: Program, where: dict[str, str], roots: set[str]) -> None:
        """Solve; `roots` are entered with any bank selected."""
        self.program = program
        self.where = where
        self.states = {n: _States(successors(f)) for n, f in program.functions.items()}
        for name, state in self.states.items():
            state.before = [UNREACHED] * len(program.functions[name].body)
            state.entry = UNKNOWN if name in roots else UNREACHED
        changed = True
        while changed:
            changed = any(self._function(name) for name in program.functions)

    def bank(self, operand: str) -> str:
        """Return the section of an operand; a variable of unknown section is its own."""
        name = symbol(operand)
        return self.where.get(name, name)

    def _function(self, name: str) -> bool:
        """Propagate through one function; tell if anything changed."""
        state, body = self.states[name], self.program.functions[name].body
        changed = self._enter(state, 0, state.entry)
        todo = list(range(len(body)))
        while todo:
            index = todo.pop()
            if state.before[index] == UNREACHED:
                continue
            after = self._after(name, index)
            if not state.graph[index] and body[index].op in ("RETURN", "RETFIE"):
                met = _met(state.exit, after)
                changed |= met != state.exit
                state.exit = met
            for target in state.graph[index]:
                if self._enter(state, target, after):
                    changed = True
                    todo.append(target)
        return changed

    def _enter(self, state: _States, index: int, bank: str) -> bool:
        met = _met(state.before[index], bank)
        if met == state.before[index]:
            return False
        state.before[index] = met
        return True

    def _after(self, name: str, index: int) -> str:
        """Return the bank selected after a line, telling a called function its entry."""
        line = self.program.functions[name].body[index]
        before = self.states[name].before[index]
        if line.op == "BANKSEL":
            return self.bank(line.args[0])
        if line.op == "MOVLB" or "BSR" in line.args[1:]:
            return UNKNOWN
        if line.op not in ("CALL", "RCALL"):
            return before
        callee = self.states.get(line.args[0])
        if callee is None:
            return UNKNOWN
        callee.entry = _met(callee.entry, before)
        return callee.exit

    def wrong(self, function: Function) -> list[int]:
        """Return the lines that use a variable with another bank selected."""
        before = self.states[function.name].before
        return [
            index
            for index, line in enumerate(function.body)
            if line.args[-1:] == ["B"] and before[index] not in (UNREACHED, self.bank(line.args[0]))
        ]

    def check(self) -> None:
        """Raise RefusalError where a variable is used with another bank selected."""
        for name, function in self.program.functions.items():
            for index in self.wrong(function):
                raise RefusalError(f"{name}: wrong bank: {function.body[index].text().strip()}")

    def needless(self, function: Function) -> list[int]:
        """Return the BANKSEL lines that select what is selected already."""
        before = self.states[function.name].before
        return [
            index
            for index, line in enumerate(function.body)
            if line.op == "BANKSEL"
            and before[index] == self.bank(line.args[0])
            and not after_skip(function.body, index)
        ]


def repair_bank_selections(program: Program, roots: set[str]) -> int:
    """Select the bank where SDCC wrongly left it out; return how often.

    SDCC 4.2 does so after a MOVFF from the same variable: MOVFF needs no bank,
    but is taken for a use of it.
    """
    repaired = 0
    found = True
    while found:
        found = False
        banks = Banks(program, {}, roots)
        for function in program.functions.values():
            body = function.body
            for index in reversed(banks.wrong(function)):
                if not after_skip(body, index):
                    body.insert(index, Line("BANKSEL", body[index].args[:1]))
                    repaired += 1
                    found = True
    return repaired


def drop_bank_selections(program: Program, assembly: str, roots: set[str]) -> int:
    """Group the variables, drop all needless bank selections; return the repairs."""
    where, access = assembly_sections(assembly)
    use_access_bank(program, access)
    repaired = repair_bank_selections(program, roots)
    where |= group_variables(program)
    banks = Banks(program, where, roots)
    for function in program.functions.values():
        drop_lines(function, banks.needless(function))
    Banks(program, where, roots).check()
    return repaired
