# SPDX-License-Identifier: Apache-2.0
"""Keeps one of several equal pieces of code.

Equal ends of ways that lead to the same place become one end, to which the
others jump. Equal pieces elsewhere become a function of their own, or call the
end of a function that is such a piece; that takes a level of the return stack
and is done only where one is left. The instructions executed, and their order,
stay the same but for the jumps, calls and returns added.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass

from shrink_flow import BRANCH, JUMPS
from shrink_levels import Levels
from shrink_model import SKIPS, Function, Line, Program
from shrink_text import Text

LONGEST = 60
STACK = {"POSTDEC1", "PREINC1", "POSTINC1", "FSR1L", "FSR1H", "PLUSW1", "INDF1", "_STKPTR"}
Groups = list[list[int]]


@dataclass
class _Piece:
    """One place of a piece that is found several times."""

    first: int
    last: int  # the line after those to replace
    tail: bool  # the function returns after it: a jump does


@dataclass
class _Plan:
    """What a fold saves (bytes), what it keeps and what it replaces."""

    gain: int
    home: _Piece | None
    away: list[_Piece]
    inner_calls: bool = False


class Folder:
    """Folds a program; `saved` counts the bytes by kind of fold."""

    def __init__(
        self,
        program: Program,
        order: list[str],
        fixed: set[str],
        bank: Callable[[str], str],
        outside: dict[str, int],
    ) -> None:
        """Take the program and the order of its functions; `fixed` ones stay as they are.

        `outside` tells the levels of the return stack that hand-written functions use.
        """
        self.program = program
        self.order = order
        self.fixed = fixed
        self.bank = bank
        self.outside = outside
        self.number = itertools.count()
        self.saved = {"equal ends": 0, "equal pieces": 0}

    def run(self, root: str, limit: int) -> list[str]:
        """Fold until nothing is gained; return the new order.

        From `root` downward, at most `limit` levels of the return stack are used.
        """
        gained = True
        while gained:
            gained = False
            while self._round("equal ends", _Ends):
                gained = True
            while self._round("equal pieces", lambda text: self._pieces(text, root, limit)):
                gained = True
        return self.order

    def _pieces(self, text: Text, root: str, limit: int) -> "_Pieces":
        return _Pieces(text, Levels(text.lines, self.outside), root, limit)

    def _round(self, kind: str, make: Callable[[Text], "_Ends | _Pieces"]) -> int:
        """Take all folds of one kind that do not touch each other; return bytes saved."""
        text = Text(self.program, self.order, self.fixed, self.bank)
        finder = make(text)
        waiting = finder.groups()
        plans = sorted(
            ((finder.plan(*group).gain, number) for number, group in enumerate(waiting)),
            key=lambda item: (-item[0], item[1]),
        )
        saved = 0
        for gain, number in plans:
            if gain <= 0:
                break
            plan = finder.plan(*waiting[number])
            if plan.gain > 0 and plan.gain >= gain // 2:
                finder.take(plan, f"_fold_{next(self.number)}")
                saved += plan.gain
        self.order = text.apply()
        self.saved[kind] += saved
        return saved


def _refine(keys: dict[tuple[int, str], list[int]]) -> Groups:
    return [group for group in keys.values() if len(group) > 1]


class _Ends:
    """Finds ways that end with the same instructions and lead to the same place."""

    def __init__(self, text: Text) -> None:
        self.text = text

    def groups(self) -> list[tuple[list[int], int]]:
        """Return ends (line after the last to compare) and how many lines are equal."""
        text = self.text
        start: dict[tuple[int, str], list[int]] = {}
        for index, line in enumerate(text.lines):
            if text.is_end(index):
                start.setdefault((0, text.key[index] or ""), []).append(index)
            elif not line.op and index and text.owner[index - 1] == text.owner[index]:
                before = text.key[index - 1]
                if before is not None and not text.is_end(index - 1):
                    key = (0, f"GOTO {text.same[line.label]}")
                    start.setdefault(key, []).append(index)
        found: list[tuple[list[int], int]] = []
        groups = _refine(start)
        count = 0
        while groups and count < LONGEST:
            count += 1
            keys: dict[tuple[int, str], list[int]] = {}
            for number, group in enumerate(groups):
                for end in group:
                    index = self._back(end, count)
                    if index >= 0:
                        keys.setdefault((number, text.key[index] or ""), []).append(end)
            groups = _refine(keys)
            found += [(group, count) for group in groups]
        return found

    def _back(self, end: int, count: int) -> int:
        """Return the line that is `count` instructions before an end; -1 if none is."""
        text = self.text
        index = end
        while count:
            index -= 1
            if index < 0 or text.owner[index] != text.owner[end]:
                return -1
            if text.lines[index].op:
                if text.key[index] is None or text.is_end(index):
                    return -1
                count -= 1
        return index

    def plan(self, ends: list[int], count: int) -> _Plan:
        """Return the best way to fold a group."""
        text = self.text
        pieces = []
        for end in ends:
            first = self._back(end, count)
            last = end + 1 if text.lines[end].op else end
            if first >= 0 and text.free(first, last):
                pieces.append(_Piece(first, last, not text.lines[end].op))
        best = _Plan(0, None, [])
        for home in pieces:
            away = []
            gain = 0
            for piece in pieces:
                overlap = piece.first < home.last and home.first < piece.last
                less = text.bytes(piece.first, piece.last) - text.jump_size(piece.first, home.first)
                if not overlap and less > 0 and self._removable(piece):
                    away.append(piece)
                    gain += less
            if gain > best.gain:
                best = _Plan(gain, home, away)
        return best

    def _removable(self, piece: _Piece) -> bool:
        lines = self.text.lines[piece.first : piece.last]
        return not self.text.skipped[piece.first] and all(line.op for line in lines)

    def take(self, plan: _Plan, label: str) -> None:
        """Keep the home, replace all others by jumps."""
        if plan.home is None:
            return
        self.text.mark(plan.home.first, label)
        self.text.touched.update(range(plan.home.first, plan.home.last))
        for piece in plan.away:
            if self.text.free(piece.first, piece.last):
                self.text.replace(piece.first, piece.last, Line("GOTO", [label]))


class _Pieces:
    """Finds equal pieces of straight code that can be called."""

    def __init__(self, text: Text, levels: Levels, root: str, limit: int) -> None:
        self.text = text
        self.levels = levels
        self.above = levels.above(root)
        self.limit = limit
        self.used = 0

    def groups(self) -> list[tuple[list[int], int]]:
        """Return first lines of equal pieces, and how many lines are equal."""
        text = self.text
        start: dict[tuple[int, str], list[int]] = {}
        for index in range(len(text.lines)):
            if self._usable(index):
                start.setdefault((0, text.key[index] or ""), []).append(index)
        found: list[tuple[list[int], int]] = []
        groups = _refine(start)
        count = 1
        while groups and count < LONGEST:
            keys: dict[tuple[int, str], list[int]] = {}
            for number, group in enumerate(groups):
                for first in group:
                    index = first + count
                    if not self.text.is_end(index - 1) and self._usable(index):
                        keys.setdefault((number, self._key(index)), []).append(first)
            groups = _refine(keys)
            count += 1
            found += [(group, count) for group in groups]
        return found

    def _key(self, index: int) -> str:
        """Return the key of a line; a last jump to a function is the same as a call of it."""
        key = self.text.key[index] or ""
        return key.replace("GOTO ", "CALL ", 1) if self.text.is_end(index) else key

    def _usable(self, index: int) -> bool:
        """Tell whether a line may be part of a piece."""
        text = self.text
        if index >= len(text.lines) or text.key[index] is None or self.above[index] < 0:
            return False
        line = text.lines[index]
        if line.op in JUMPS:
            return text.is_end(index) and line.args[0] in text.program.functions
        return (
            line.op not in BRANCH
            and line.op not in ("RETURN", "RETLW")
            and STACK.isdisjoint(line.args)
        )

    def plan(self, starts: list[int], count: int) -> _Plan:
        """Return the best way to fold a group."""
        text = self.text
        lines = text.lines
        pieces: list[_Piece] = []
        end = -1
        for first in starts:
            last = first + count
            if first < end or text.skipped[first] or lines[last - 1].op in SKIPS:
                continue
            tail = text.is_end(last - 1)
            if not tail and last < len(lines) and lines[last].op == "RETURN":
                tail = text.is_end(last)
                last += tail
            if text.free(first, last) and (tail or self._room(first, first + count)):
                pieces.append(_Piece(first, last, tail))
                end = first + count
        if len(pieces) < 2:
            return _Plan(0, None, [])
        inner = any(
            lines[i].op in ("CALL", "RCALL") for i in range(starts[0], starts[0] + count - 1)
        )
        best = self._with_new(pieces, count, inner)
        for home in pieces:
            if home.tail:
                away = [
                    piece for piece in pieces if piece is not home and self._less(piece, home) > 0
                ]
                gain = sum(self._less(piece, home) for piece in away)
                if gain >= best.gain:
                    best = _Plan(gain, home, away, inner)
        return best

    def _with_new(self, pieces: list[_Piece], count: int, inner: bool) -> _Plan:
        """Return the plan to put the piece into a function of its own."""
        middle = pieces[len(pieces) // 2]
        away = [piece for piece in pieces if self._less(piece, middle) > 0]
        last = self.text.lines[middle.first + count - 1]
        cost = self.text.bytes(middle.first, middle.first + count)
        cost += 0 if last.op in ("CALL", "RCALL", "GOTO", "BRA") else 2
        gain = sum(self._less(piece, middle) for piece in away) - cost
        return _Plan(gain, None, [middle, *(p for p in away if p is not middle)], inner)

    def _less(self, piece: _Piece, home: _Piece) -> int:
        text = self.text
        return text.bytes(piece.first, piece.last) - text.jump_size(piece.first, home.first)

    def _room(self, first: int, last: int) -> bool:
        """Tell whether a level is left in all lines of a piece."""
        for index in range(first, last):
            line = self.text.lines[index]
            level = self.above[index] + 1 + self.used
            if line.op in ("CALL", "RCALL") and index < last - 1:
                level += 1 + self.levels.below(line.args[0])
            if level > self.limit:
                return False
        return True

    def take(self, plan: _Plan, label: str) -> None:
        """Keep one piece, or make a function of it; replace the others."""
        text = self.text
        self.used += plan.inner_calls
        if plan.home is not None:
            text.mark(plan.home.first, label)
            text.touched.update(range(plan.home.first, plan.home.last))
        else:
            text.add(self._function(plan.away[0], label), plan.away[0].first)
        for piece in plan.away:
            text.replace(piece.first, piece.last, Line("GOTO" if piece.tail else "CALL", [label]))

    def _function(self, piece: _Piece, label: str) -> Function:
        text = self.text
        body = [Line(x.op, list(x.args)) for x in text.lines[piece.first : piece.last]]
        if body[-1].op in ("CALL", "RCALL"):
            body[-1].op = "GOTO"
        elif not text.is_end(piece.last - 1):
            body.append(Line("RETURN"))
        file = text.program.functions[text.owner[piece.first]].file
        return Function(label, file, [Line("", label=label), *body])
