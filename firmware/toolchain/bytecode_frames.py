# SPDX-License-Identifier: Apache-2.0
"""Gives local variables addresses; those of functions that never run at once share them.

Loads and stores that are used most often take one byte of byte code, so the
variables used most get the addresses used most.
"""

from __future__ import annotations

from collections import Counter

from bytecode_model import Code, Function, Place
from bytecode_types import BytecodeError

LOCALS = "locals"  # label of all local variables


class Frames:
    """Addresses of local variables; first finds out which functions can run at once."""

    def __init__(self, functions: list[Function], native_reach: dict[str, set[str]]) -> None:
        """`native_reach`: byte-code functions that a native one leads to."""
        self.known = {function.name for function in functions}
        self.sizes = {
            f"{function.name}.{variable}": (function.name, kind.size)
            for function in functions
            for variable, kind in function.locals.items()
        }
        edges: dict[str, set[str]] = {}
        for function in functions:
            edges[function.name] = self._reached(function.calls, native_reach)
        for function in functions:
            for waiting, called in function.meanwhile:
                edges[waiting] = edges[waiting] | self._reached({called}, native_reach)
        self.below: dict[str, set[str]] = {}
        for name in edges:
            self._visit(name, edges, [])
        self.total = 0

    def _reached(self, calls: set[str], native_reach: dict[str, set[str]]) -> set[str]:
        found = set()
        for name in calls:
            found |= {name} if name in self.known else native_reach.get(name, set())
        return found

    def _visit(self, name: str, edges: dict[str, set[str]], above: list[str]) -> set[str]:
        """Return what a function leads to."""
        if name in above:
            raise BytecodeError(f"recursion: {' -> '.join([*above, name])}")
        if name not in self.below:
            found = set(edges[name])
            for called in edges[name]:
                found |= self._visit(called, edges, [*above, name])
            self.below[name] = found
        return self.below[name]

    def at_once(self, one: str, other: str) -> bool:
        """Tell whether two functions can run at once."""
        return one == other or one in self.below[other] or other in self.below[one]

    def settle(self, functions: list[Function]) -> None:
        """Give the operations addresses: equal ones of different functions become equal."""
        at = self._places(functions)
        for function in functions:
            for index, line in enumerate(function.code):
                operand = line.operand if isinstance(line, Code) else None
                if isinstance(line, Code) and isinstance(operand, Place) and operand.symbol in at:
                    place = Place(LOCALS, at[operand.symbol] + operand.offset)
                    function.code[index] = Code(line.op, place, line.extra)

    def _places(self, functions: list[Function]) -> dict[str, int]:
        """Return the offset of each `function.variable` that is used."""
        uses: Counter[str] = Counter()
        for function in functions:
            for line in function.code:
                if isinstance(line, Code) and isinstance(line.operand, Place):
                    uses[line.operand.symbol] += line.operand.symbol in self.sizes
        found: dict[str, int] = {}
        popular: Counter[tuple[int, int]] = Counter()  # uses of an offset with a size
        for symbol, count in uses.most_common():
            if count == 0:
                break
            name, size = self.sizes[symbol]
            offset = self._best(name, size, found, popular)
            found[symbol] = offset
            popular[offset, size] += count
            self.total = max(self.total, offset + size)
        return found

    def _best(
        self, name: str, size: int, found: dict[str, int], popular: Counter[tuple[int, int]]
    ) -> int:
        """Return the free offset that variables of this size have most often."""
        taken: set[int] = set()
        for symbol, offset in found.items():
            function, length = self.sizes[symbol]
            if self.at_once(name, function):
                taken.update(range(offset, offset + length))
        free = [
            offset
            for offset in range(self.total + 1)
            if taken.isdisjoint(range(offset, offset + size))
        ]
        return max(free, key=lambda offset: (popular[offset, size], -offset))
