# SPDX-License-Identifier: Apache-2.0
"""The whole program as one list of lines, to be folded (shrink_fold.py).

Gives each line a key: lines with equal keys do the same in the same place. A
line without a key (a label, a table, code that must keep its timing) never moves.
"""

from collections.abc import Callable

from shrink_model import SKIPS, Function, Line, Program

NEAR = 1900  # bytes; a short call reaches 2046, and distances still change a little
TIMED = "_EECON2"  # its unlock sequence must run without anything between
ENDS = ("RETURN", "RETLW", "GOTO", "BRA")
SAME = {"RCALL": "CALL", "BRA": "GOTO"}


class Text:
    """A snapshot of the lines of all functions in order, and the changes to make to them."""

    def __init__(
        self, program: Program, order: list[str], fixed: set[str], bank: Callable[[str], str]
    ) -> None:
        """Take the functions in order; those in `fixed` are left as they are."""
        self.program = program
        self.order = order
        self.lines: list[Line] = []
        self.owner: list[str] = []
        for name in order:
            body = program.functions[name].body
            self.lines += body
            self.owner += [name] * len(body)
        self.frozen = fixed | {
            name for name in order if any(TIMED in x.args for x in program.functions[name].body)
        }
        self.skipped = self._skipped()
        self.place = {line.label: i for i, line in enumerate(self.lines) if not line.op}
        self.address = self._addresses()
        self.same = self._same_labels()
        self.key = [self._key(index, bank) for index in range(len(self.lines))]
        self.touched: set[int] = set()
        self.instead: dict[int, list[Line]] = {}
        self.labels: dict[int, list[Line]] = {}
        self.added: dict[str, list[Function]] = {}

    def _skipped(self) -> list[bool]:
        found = []
        skip = False
        for line in self.lines:
            found.append(skip)
            if line.op:
                skip = line.op in SKIPS
        return found

    def _addresses(self) -> list[int]:
        """Return where each line will stand, with short calls where they reach."""
        size = [line.size() for line in self.lines]
        for _ in range(3):
            at = [0]
            for length in size:
                at.append(at[-1] + length)
            for index, line in enumerate(self.lines):
                target = self.place.get(line.args[0], -1) if line.args else -1
                if line.op in ("CALL", "GOTO") and not line.pinned and target >= 0:
                    size[index] = 2 if abs(at[target] - at[index]) < NEAR else 4
        return at

    def _same_labels(self) -> dict[str, str]:
        """Return label -> the first of the labels that stand in the same place."""
        found: dict[str, str] = {}
        first = ""
        for line in self.lines:
            first = "" if line.op else (first or line.label)
            if not line.op:
                found[line.label] = first
        return found

    def _key(self, index: int, bank: Callable[[str], str]) -> str | None:
        line = self.lines[index]
        if not line.op or line.pinned or self.owner[index] in self.frozen or "PCL" in line.args:
            return None
        if line.op in ("RETFIE", "RESET", "SLEEP") or "FSR1L" in line.args:
            return None
        if index + 1 < len(self.lines) and "FSR1L" in self.lines[index + 1].args:
            return None  # how much the stack moves must stand right before the move
        if line.op == "BANKSEL":
            return f"BANKSEL {bank(line.args[0])}"
        args = [self.same.get(arg, arg) for arg in line.args]
        return " ".join([SAME.get(line.op, line.op), *args])

    def is_end(self, index: int) -> bool:
        """Tell whether execution never goes on to the next line."""
        return (
            self.key[index] is not None and self.lines[index].op in ENDS and not self.skipped[index]
        )

    def bytes(self, first: int, last: int) -> int:
        """Return the bytes of the lines from first up to, not with, last."""
        return self.address[last] - self.address[first]

    def jump_size(self, index: int, target: int) -> int:
        """Return the bytes of a call or jump between two lines."""
        return 2 if abs(self.address[index] - self.address[target]) < NEAR else 4

    def free(self, first: int, last: int) -> bool:
        """Tell whether no change has been made to some lines yet."""
        return self.touched.isdisjoint(range(first, last))

    def mark(self, index: int, label: str) -> None:
        """Put a label before a line."""
        self.labels.setdefault(index, []).append(Line("", label=label))

    def replace(self, first: int, last: int, line: Line) -> None:
        """Put one line in the place of several."""
        self.touched.update(range(first, last))
        self.instead[first] = [line]
        for index in range(first + 1, last):
            self.instead[index] = []

    def add(self, function: Function, index: int) -> None:
        """Place a new function after the one that a line belongs to."""
        self.added.setdefault(self.owner[index], []).append(function)

    def apply(self) -> list[str]:
        """Make all changes; return the new order."""
        bodies: dict[str, list[Line]] = {name: [] for name in self.order}
        for index, line in enumerate(self.lines):
            body = bodies[self.owner[index]]
            body += self.labels.get(index, [])
            body += self.instead.get(index, [line])
        result = []
        for name in self.order:
            self.program.functions[name].body[:] = bodies[name]
            result.append(name)
            for function in self.added.get(name, []):
                self.program.functions[function.name] = function
                result.append(function.name)
        return result
