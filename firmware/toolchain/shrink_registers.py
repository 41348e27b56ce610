# SPDX-License-Identifier: Apache-2.0
"""Gives all virtual registers of the program places such that nothing is saved.

Two registers may share a place unless one is written while the other is still
needed; a register needed after a call shares with none that the called function
or the functions below it use. The interrupt's functions get places of their own.
Functions in `kept` save what they use, as SDCC wrote them, and so disturb nobody.
"""

from dataclasses import dataclass

from shrink_flow import Liveness, effect
from shrink_model import Function, Line, Program, RefusalError

PUSH = "POSTDEC1"
POP = "PREINC1"


def reachable(program: Program, root: str) -> set[str]:
    """Return a root and every function of the program below it."""
    found: set[str] = set()
    todo = [root]
    while todo:
        name = todo.pop()
        if name in found or name not in program.functions:
            continue
        found.add(name)
        todo += program.functions[name].calls()
    return found


def refuse_recursion(program: Program) -> None:
    """Raise RefusalError if a function can call itself, directly or not."""
    for name, function in program.functions.items():
        for called in set(function.calls()):
            if called in program.functions and name in reachable(program, called):
                raise RefusalError(f"{name}: recursion")


@dataclass
class Frame:
    """Where a function saves and restores: line numbers of its body."""

    saved: set[str]
    lines: list[int]
    pointer: list[int]


def _is_register(text: str) -> bool:
    return "@r0x" in text


def find_frame(function: Function) -> Frame | None:
    """Return how a function saves its registers; None if it is not as expected.

    Expected: saves in one run near the entry, before anything else is done, and
    before each return the same registers restored in the opposite order.
    """
    body = function.body
    index = 1
    pointer: list[int] = []
    while index < len(body) and _entry_move(body[index]):
        if body[index].args[0] in ("FSR2L", "FSR1L"):
            pointer.append(index)
        index += 1
    saves: list[int] = []
    while (
        index < len(body)
        and body[index].op == "MOVFF"
        and (_is_register(body[index].args[0]) and body[index].args[1] == PUSH)
    ):
        saves.append(index)
        index += 1
    if len(pointer) not in (0, 2):
        return None
    order = [body[i].args[0] for i in saves]
    lines = list(saves)
    for end, line in enumerate(body):
        if line.op not in ("RETURN", "RETFIE"):
            continue
        restored = _restores(body, end)
        if [body[i].args[1] for i in restored if _is_register(body[i].args[1])] != order[::-1]:
            return None
        pops = [i for i in restored if body[i].args[1] == "FSR2L"]
        if len(pops) != len(pointer) // 2:
            return None
        lines += [i for i in restored if _is_register(body[i].args[1])]
        pointer += pops
    return Frame(set(order), lines, pointer)


def _entry_move(line: Line) -> bool:
    """Tell whether a line saves something other than a register on entry."""
    if line.is_("MOVWF", PUSH) or line.is_("MOVFF", "FSR1L", "FSR2L"):
        return True
    return (
        line.op == "MOVFF"
        and line.args[1] == PUSH
        and line.args[0]
        in ("STATUS", "BSR", "PRODL", "PRODH", "FSR0L", "FSR0H", "PCLATH", "PCLATU", "FSR2L")
    )


def _restores(body: list[Line], end: int) -> list[int]:
    """Return the MOVFF PREINC1 lines that lead straight to a return."""
    found: list[int] = []
    index = end - 1
    while index >= 0 and (
        (body[index].op == "MOVFF" and body[index].args[0] == POP)
        or body[index].is_("MOVF", POP, "W")
    ):
        if body[index].op == "MOVFF":
            found.append(index)
        index -= 1
    return found[::-1]


def drop_lines(function: Function, lines: list[int]) -> None:
    """Remove lines from a function by number."""
    gone = set(lines)
    function.body[:] = [line for i, line in enumerate(function.body) if i not in gone]


def drop_saves(program: Program, kept: set[str]) -> None:
    """Remove the saves and restores of every function that is not in `kept`."""
    for name, function in program.functions.items():
        if name not in kept:
            frame = find_frame(function)
            if frame is None:
                raise RefusalError(f"{name}: unknown form of entry or return")
            drop_lines(function, frame.lines)


def unsaved(program: Program, kept: set[str]) -> dict[str, set[str]]:
    """Return for each function the registers that calling it may change."""
    own: dict[str, set[str]] = {}
    for name, function in program.functions.items():
        own[name] = function.registers()
        frame = find_frame(function) if name in kept else None
        if frame is not None:
            own[name] -= frame.saved
    return {
        name: set().union(*(own[f] for f in reachable(program, name))) for name in program.functions
    }


class Interference:
    """Which registers of a group of functions must not share a place."""

    def __init__(self, program: Program, live: Liveness, kept: set[str], group: set[str]) -> None:
        """Look at the functions of the group; those in `kept` save what they use."""
        self.live = live
        self.registers = sorted(set().union(*(program.functions[f].registers() for f in group)))
        self.edges = dict.fromkeys(self.registers, 0)
        self.changed = {name: live.mask(used) for name, used in unsaved(program, kept).items()}
        self.wanted = live.mask(set(self.registers))
        for name in group:
            self._entry(name)
            for index, line in enumerate(program.functions[name].body):
                self._line(name, index, line)
        self._symmetric()

    def _add(self, register: str, others: int) -> None:
        self.edges[register] |= others & self.wanted & ~self.live.mask({register})

    def _entry(self, name: str) -> None:
        incoming = self.live.entry[name] & self.wanted
        for register in self.live.things(incoming):
            self._add(register, incoming)

    def _line(self, name: str, index: int, line: Line) -> None:
        after = self.live.after[name][index] & self.wanted
        if line.op in ("CALL", "RCALL") and line.args[0] in self.changed:
            across = after & ~self.live.results[line.args[0]]
            for register in self.live.things(across):
                self._add(register, self.changed[line.args[0]])
        for register in effect(line).writes:
            if "@" in register:
                copied = line.args[0] if line.op == "MOVFF" and "@" in line.args[0] else register
                self._add(register, after & ~self.live.mask({copied}))

    def _symmetric(self) -> None:
        for register in self.registers:
            bit = self.live.mask({register})
            for other in self.live.things(self.edges[register]):
                self.edges[other] |= bit


def copies(program: Program) -> list[tuple[str, str]]:
    """Return pairs of registers of which one is copied to the other."""
    found = []
    for function in program.functions.values():
        for line, after in zip(function.body, function.body[1:], strict=False):
            if line.op == "MOVFF" and "@" in line.args[0] and "@" in line.args[1]:
                found.append((line.args[0], line.args[1]))
            if (
                line.op == "MOVF"
                and line.args[1:] == ["W"]
                and "@" in line.args[0]
                and (after.op == "MOVWF" and "@" in after.args[0])
            ):
                found.append((line.args[0], after.args[0]))
    return found


def allocate(graph: Interference, copied: list[tuple[str, str]]) -> dict[str, int]:
    """Give each register a place, numbered from 0; copied ones share where they may."""
    live = graph.live
    parent = {r: r for r in graph.registers}
    members = {r: live.mask({r}) for r in graph.registers}
    edges = dict(graph.edges)

    def find(register: str) -> str:
        while parent[register] != register:
            register = parent[register]
        return register

    for one, two in copied:
        if one not in parent or two not in parent:
            continue
        a, b = find(one), find(two)
        if a != b and not edges[a] & members[b]:
            parent[b] = a
            members[a] |= members[b]
            edges[a] |= edges[b]
    groups = sorted(
        (r for r in graph.registers if parent[r] == r), key=lambda r: (-edges[r].bit_count(), r)
    )
    filled: list[int] = []
    place: dict[str, int] = {}
    for group in groups:
        slot = next((i for i, mask in enumerate(filled) if not mask & edges[group]), len(filled))
        if slot == len(filled):
            filled.append(0)
        filled[slot] |= members[group]
        place[group] = slot
    return {r: place[find(r)] for r in graph.registers}


def assign(program: Program, places: dict[str, str]) -> None:
    """Write the names of the places into all instructions."""
    for function in program.functions.values():
        for line in function.body:
            line.args = [places.get(arg, arg) for arg in line.args]
