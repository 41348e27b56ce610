# SPDX-License-Identifier: Apache-2.0
"""How many levels of the hardware return stack are in use at every line.

Works on lines, not on functions, because after shrink_fold.py functions share
their ends: a jump may lead into another function.
"""

import re

from shrink_flow import BRANCH, JUMPS
from shrink_model import SKIPS, Line, Program, RefusalError

ENDS = {"RETURN", "RETFIE", "RETLW", "RESET"}
CALLS = {"CALL", "RCALL"}
MOST_LEVELS = 31


class _HandWritten:
    """The ways between the labels of hand-written files, joined but each with its END."""

    def __init__(self, assembly: str) -> None:
        self.ways: dict[str, list[tuple[str, int]]] = {}
        self.file = 0
        self.last = ""  # the label above
        self.open = ""  # the same, while execution goes on to the next line
        self.skip = False
        for raw in assembly.splitlines():
            self._line(raw.split(";")[0])

    def _line(self, line: str) -> None:
        label = re.match(r"(\w+):", line)
        words = re.findall(r"\w+", line)
        if label:
            self._label(label.group(1))
        elif line[:1].isspace() and words:
            self._instruction(words[0].upper(), words[1:])

    def _label(self, label: str) -> None:
        name = label if label.startswith("_") else f"{label}/{self.file}"
        if self.open:
            self.ways[self.open].append((name, 0))
        self.ways[name] = []
        self.open = self.last = name

    def _instruction(self, op: str, operands: list[str]) -> None:
        if op == "END":
            self.file += 1
            self.open = self.last = ""
        if not self.last:
            return
        call = int(op in CALLS)
        for word in operands:
            self.ways[self.last].append((word if word[0] == "_" else f"{word}/{self.file}", call))
        ends = op in ENDS | JUMPS and not self.skip
        self.open = "" if ends else self.last
        self.skip = op in SKIPS


def outside_levels(assembly: str) -> dict[str, int]:
    """Return label -> levels that hand-written code uses from there on.

    RefusalError if that has no end.
    """
    ways = _HandWritten(assembly).ways
    found = dict.fromkeys(ways, 0)
    for _ in range(MOST_LEVELS * len(ways)):
        before = dict(found)
        for name, targets in ways.items():
            for target, call in targets:
                if target in found:
                    found[name] = max(found[name], call + found[target])
        if found == before:
            return found
        if max(found.values()) > MOST_LEVELS:
            break
    if found:
        raise RefusalError("hand-written code calls itself")
    return found


class Levels:
    """Levels used above and below the lines of a program, for one list of lines."""

    def __init__(self, lines: list[Line], outside: dict[str, int]) -> None:
        """Take all lines of all functions in the order they are placed."""
        self.lines = lines
        self.outside = outside
        self.place = {line.label: i for i, line in enumerate(lines) if not line.op}
        self.known: dict[str, int] = {}
        self.reached: dict[str, list[int]] = {}
        self.finished: list[str] = []

    def below(self, target: str) -> int:
        """Return the levels that the code at a label and all it calls use."""
        if target not in self.place:
            return self.outside.get(target, 1)
        if target not in self.known:
            deepest = 0
            self.reached[target] = self._reach(self.place[target])
            for index in self.reached[target]:
                line = self.lines[index]
                if line.op in CALLS:
                    deepest = max(deepest, 1 + self.below(line.args[0]))
                elif line.op in JUMPS and line.args[0] not in self.place:
                    deepest = max(deepest, self.below(line.args[0]))
            self.known[target] = deepest
            self.finished.append(target)
        return self.known[target]

    def above(self, root: str) -> list[int]:
        """Return for each line the most levels in use there below a root (-1: never there)."""
        self.below(root)
        entry = dict.fromkeys(self.finished, -1)
        entry[root] = 0
        found = [-1] * len(self.lines)
        for target in reversed(self.finished):
            here = entry[target]
            if here < 0:
                continue
            for index in self.reached[target]:
                found[index] = max(found[index], here)
                line = self.lines[index]
                if line.op in CALLS and line.args[0] in entry:
                    entry[line.args[0]] = max(entry[line.args[0]], here + 1)
        return found

    def _reach(self, start: int) -> list[int]:
        seen = {start}
        todo = [start]
        while todo:
            for target in self._next(todo.pop()):
                if target not in seen and target < len(self.lines):
                    seen.add(target)
                    todo.append(target)
        return sorted(seen)

    def _next(self, index: int) -> list[int]:
        line = self.lines[index]
        if line.op in ENDS:
            return []
        if line.op in JUMPS:
            return [self.place[line.args[0]]] if line.args[0] in self.place else []
        if line.is_("MOVWF", "PCL"):
            end = index + 2
            while end < len(self.lines) and self.lines[end].pinned:
                end += 1
            return list(range(index + 2, end))
        if line.op in BRANCH:
            return [index + 1, self.place[line.args[0]]]
        if line.op in SKIPS:
            skipped = index + 1
            while not self.lines[skipped].op:
                skipped += 1
            return [index + 1, skipped + 1]
        return [index + 1]


def levels_of(program: Program, outside: dict[str, int], root: str) -> int:
    """Return the levels that a root and all below it use."""
    lines = [line for function in program.functions.values() for line in function.body]
    return Levels(lines, outside).below(root)
