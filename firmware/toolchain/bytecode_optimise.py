# SPDX-License-Identifier: Apache-2.0
"""Makes compiled byte code shorter: jumps, unreachable code, equal ends, equal pieces."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence

from bytecode_flow import drop_needless
from bytecode_model import Code, Function, Label, Whole
from bytecode_operations import ENDS, INVERSE, JUMPS, can_pair, select, size

Line = Code | Label
Lines = list[Line]
RETURNS = {"ret", "ret0", "ret1", "retk"}
PIECE_MAX = 14  # operations
LIKELY_PAIRS = 60


def choose(function: Function) -> None:
    """Turn what the compiler wrote into operations of the chip."""
    lines: Lines = []
    for line in function.code:
        lines += [line] if isinstance(line, Label) else select(line)
    function.code = lines


def optimise(function: Function, whole: Whole) -> None:
    """Shorten one function."""
    lines = function.code
    own = function.own_symbols()
    while True:
        before = list(lines)
        lines = drop_needless(lines, whole, own, function.result.size > 0)
        lines = _thread_jumps(lines)
        lines = _drop_unreachable(lines)
        lines = _drop_unused_labels(lines)
        lines = _merge_ends(lines, function.name)
        if lines == before:
            break
    function.code = lines


def _targets(lines: Lines) -> dict[str, int]:
    return {line.name: index for index, line in enumerate(lines) if isinstance(line, Label)}


def _first(lines: Lines, index: int) -> Code | None:
    """Return the operation at an index or behind the labels there."""
    while index < len(lines):
        line = lines[index]
        if isinstance(line, Code):
            return line
        index += 1
    return None


def _thread_jumps(lines: Lines) -> Lines:
    """Lead jumps to jumps to their ends; jump over a jump by the opposite condition."""
    at = _targets(lines)
    return _invert([_threaded(line, lines, at) for line in lines])


def _threaded(line: Line, lines: Lines, at: dict[str, int]) -> Line:
    """Return a jump as it is best: to the end of a row of jumps, or the return it leads to."""
    if isinstance(line, Code) and line.op in (*JUMPS, "case"):
        target = _first(lines, at[str(line.operand)])
        if target is not None and target.op == "jmp" and target.operand != line.operand:
            return Code(line.op, target.operand, line.extra)
        if line.op == "jmp" and target is not None and target.op in RETURNS:
            return target
    return line


def _invert(lines: Lines) -> Lines:
    """`jz a; jmp b; a:` becomes `jnz b; a:`; a jump to what follows goes."""
    result = list(lines)
    index = 0
    while index < len(result):
        line = result[index]
        if isinstance(line, Code) and line.op in JUMPS:
            if line.operand in _labels_at(result, index + 1):
                del result[index]
                continue
            after = result[index + 1] if index + 1 < len(result) else None
            if (
                line.op in INVERSE
                and isinstance(after, Code)
                and after.op == "jmp"
                and line.operand in _labels_at(result, index + 2)
            ):
                result[index : index + 2] = [Code(INVERSE[line.op], after.operand)]
                continue
        index += 1
    return result


def _labels_at(lines: Lines, index: int) -> set[str]:
    found = set()
    while index < len(lines):
        line = lines[index]
        if not isinstance(line, Label):
            break
        found.add(line.name)
        index += 1
    return found


def _drop_unreachable(lines: Lines) -> Lines:
    """Drop what follows an end up to the next label."""
    kept: Lines = []
    dead = False
    for line in lines:
        if isinstance(line, Label):
            dead = False
        if not dead:
            kept.append(line)
        if isinstance(line, Code) and line.op in ENDS:
            dead = True
    return kept


def _drop_unused_labels(lines: Lines) -> Lines:
    used = {line.operand for line in lines if isinstance(line, Code)}
    return [line for line in lines if isinstance(line, Code) or line.name in used]


def _merge_ends(lines: Lines, name: str) -> Lines:
    """Let of two equal pieces that end alike the first jump into the second."""
    ends = [i for i, line in enumerate(lines) if isinstance(line, Code) and line.op in ENDS]
    best: tuple[int, int, int, int] | None = None
    for number, first in enumerate(ends):
        for second in ends[number + 1 :]:
            length, saved = _common(lines, first, second)
            if saved > 0 and (best is None or saved > best[0]):
                best = (saved, first, second, length)
    if best is None:
        return lines
    _, first, second, length = best
    start = second - length + 1
    names = _targets(lines)
    number = next(n for n in range(len(lines)) if f"{name}@end{n}" not in names)
    label = Label(f"{name}@end{number}")
    cut = first - length + 1
    return [*lines[:cut], Code("jmp", label.name), *lines[first + 1 : start], label, *lines[start:]]


def _common(lines: Lines, first: int, second: int) -> tuple[int, int]:
    """Return how many operations before two ends are equal, and the bytes saved."""
    length = saved = 0
    while (
        first - length >= 0
        and second - length > first
        and isinstance(lines[first - length], Code)
        and lines[first - length] == lines[second - length]
    ):
        saved += size(lines[first - length])
        length += 1
    return length, saved - 2 if length else 0


class Pieces:
    """Finds equal pieces in all functions and makes functions of them."""

    def __init__(self, functions: list[Function]) -> None:
        """Take all functions; those found are appended to the list."""
        self.functions = functions
        self.count = 0
        self.pairs: set[Code] = set()

    def fold(self) -> None:
        """Fold the pieces that save most, again and again."""
        while True:
            self._guess_pairs()
            found = self._best()
            for piece in found:
                self._take(piece)
            if not found:
                return

    def _guess_pairs(self) -> None:
        """Note which operations may take one byte."""
        counts = Counter(
            line
            for function in self.functions
            for line in function.code
            if isinstance(line, Code) and can_pair(line)
        )
        self.pairs = {code for code, _ in counts.most_common(LIKELY_PAIRS)}

    def _size(self, code: Code) -> int:
        return 1 if code in self.pairs else size(code)

    def _best(self) -> list[tuple[Code, ...]]:
        """Return some pieces worth folding that share no operation, the best first."""
        number: dict[Code, int] = {}
        places: dict[tuple[int, ...], list[tuple[int, int]]] = defaultdict(list)
        for owner, function in enumerate(self.functions):
            for start, run in _runs(function.code):
                numbers = [number.setdefault(code, len(number)) for code in run]
                for begin in range(len(run)):
                    for end in _ends_of(run, begin):
                        places[tuple(numbers[begin : end + 1])].append((owner, start + begin))
        codes = list(number)
        worth = []
        for piece, found in places.items():
            if len(found) > 1:
                length = sum(self._size(codes[n]) for n in piece)
                saved = _apart(found, len(piece)) * (length - 2) - length - 1
                if saved > 0:
                    worth.append((saved, piece))
        worth.sort(reverse=True)
        chosen: list[tuple[Code, ...]] = []
        used: set[int] = set()
        for saved, piece in worth:
            if used.isdisjoint(piece) and 2 * saved >= worth[0][0]:
                used.update(piece)
                chosen.append(tuple(codes[n] for n in piece))
        return chosen

    def _take(self, piece: tuple[Code, ...]) -> None:
        name = f"piece_{self.count}"
        self.count += 1
        for function in self.functions:
            code, index = function.code, 0
            while index <= len(code) - len(piece):
                if tuple(code[index : index + len(piece)]) == piece:
                    code[index : index + len(piece)] = [Code("call", name)]
                    function.calls.add(name)
                index += 1
        made = Function(name, [], self.functions[0].result, [*piece, Code("ret")])
        made.calls = {str(c.operand) for c in piece if c.op in ("call", "native8", "native16")}
        self.functions.append(made)


def _ends_of(run: list[Code], begin: int) -> list[int]:
    """Return where a piece may end: it takes nothing from the stack that others pushed."""
    depth = 0
    ends = []
    for end in range(begin, min(len(run), begin + PIECE_MAX)):
        code = run[end]
        depth += growth(code)
        if depth < (code.extra or 0):
            break
        if depth == 0 and end > begin:
            ends.append(end)
    return ends


def growth(code: Code) -> int:
    """Return by how many bytes an operation lets the stack grow."""
    match code.op:
        case "push":
            return 2
        case "push8":
            return 1
        case (
            "adds" | "subs" | "ands" | "ors" | "xors" | "cmps" | "stx8" | "stx16" | "sti8" | "sti16"
        ):
            return -2
        case "drop1" | "drop2" | "drop3" | "drop4":
            return -int(code.op[4])
    return 0


def _runs(lines: Sequence[Line]) -> list[tuple[int, list[Code]]]:
    """Return the stretches without labels, jumps and returns, with their starts."""
    found: list[tuple[int, list[Code]]] = []
    run: list[Code] = []
    for index, line in enumerate([*lines, Label("")]):
        if isinstance(line, Label) or line.op in ENDS or line.op in JUMPS or line.op == "case":
            if run:
                found.append((index - len(run), run))
            run = []
        else:
            run.append(line)
    return found


def _apart(found: list[tuple[int, int]], length: int) -> int:
    """Return how many places do not overlap."""
    count = 0
    last = (-1, -length)
    for owner, index in found:
        if owner != last[0] or index >= last[1] + length:
            count += 1
            last = (owner, index)
    return count
