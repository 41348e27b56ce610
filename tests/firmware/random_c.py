# SPDX-License-Identifier: Apache-2.0
"""Random functions in C, and what they must compute, worked out by C's rules in Python."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass

U8, I16, U16 = "uint8_t", "int16_t", "uint16_t"
VARIABLES = [(f"a{n}", U8) for n in range(3)]
VARIABLES += [(f"b{n}", I16) for n in range(3)] + [(f"c{n}", U16) for n in range(3)]
ARRAYS = {"bytes": U8, "words": I16}
TABLES = {
    "small": (U8, (3, 1, 4, 159, 26, 5, 35, 255)),
    "large": (U16, (0, 1, 32768, 65535, 9, 8, 7, 6)),
}
LENGTH = 8  # of arrays and tables


@dataclass
class State:
    """The variables, and the arrays, by name."""

    numbers: dict[str, int]
    arrays: dict[str, list[int]]


def fit(value: int, kind: str) -> int:
    """Return what is left of a number in a type."""
    if kind == U8:
        return value & 0xFF
    value &= 0xFFFF
    return value - 0x10000 if kind == I16 and value & 0x8000 else value


@dataclass(frozen=True)
class Expression:
    """C text, its type, and how to work it out."""

    text: str
    kind: str
    value: Callable[[State], int]
    constant: bool = False


def promoted(expression: Expression) -> str:
    """Return the type in which arithmetic takes place: int has 16 bits."""
    return I16 if expression.kind == U8 else expression.kind


class Generator:
    """Makes expressions and statements from one seed."""

    def __init__(self, seed: int) -> None:
        """The same seed makes the same functions."""
        self.random = random.Random(seed)

    def leaf(self) -> Expression:
        """Return a variable, an element or a constant."""
        chance = self.random.random()
        if chance < 0.55:
            name, kind = self.random.choice(VARIABLES)
            return Expression(name, kind, lambda state: state.numbers[name])
        if chance < 0.7:
            name = self.random.choice(sorted(ARRAYS))
            index = self.random.randrange(LENGTH)
            return Expression(f"{name}[{index}]", ARRAYS[name], lambda s: s.arrays[name][index])
        number = self.random.choice(
            [0, 1, 2, 7, 100, 255, 256, 1000, 32767, self.random.randrange(32768)]
        )
        return Expression(str(number), I16, lambda _: number, constant=True)

    def expression(self, depth: int) -> Expression:
        """Return an expression with so many levels of operators at most."""
        if depth == 0 or self.random.random() < 0.1:
            return self.leaf()
        makers = (self.arithmetic, self.compared, self.shifted, self.one_sided, self.other)
        return self.random.choice(makers)(depth - 1)

    def varying(self, depth: int) -> Expression:
        """Return an expression that is not a constant: their sums have types of their own."""
        while (found := self.expression(depth)).constant:
            pass
        return found

    def arithmetic(self, depth: int) -> Expression:
        """Return left operator right."""
        left, right = self.varying(depth), self.expression(depth)
        kind = U16 if U16 in (promoted(left), promoted(right)) else I16
        op = self.random.choice(["+", "-", "&", "|", "^", "*", "/", "%"])
        if op in "/%":
            text = f"((uint16_t){left.text} {op} (uint16_t)({right.text} | 1))"
            divide = int.__floordiv__ if op == "/" else int.__mod__
            return Expression(
                text, U16, lambda s: divide(fit(left.value(s), U16), fit(right.value(s) | 1, U16))
            )
        work = {
            "+": int.__add__,
            "-": int.__sub__,
            "&": int.__and__,
            "|": int.__or__,
            "^": int.__xor__,
            "*": int.__mul__,
        }[op]
        return Expression(
            f"({left.text} {op} {right.text})",
            kind,
            lambda s: fit(work(fit(left.value(s), kind), fit(right.value(s), kind)), kind),
        )

    def compared(self, depth: int) -> Expression:
        """Return a comparison, && or ||."""
        left, right = self.varying(depth), self.expression(depth)
        op = self.random.choice(["<", ">", "<=", ">=", "==", "!=", "&&", "||"])
        text = f"({left.text} {op} {right.text})"
        if op in ("&&", "||"):
            both = all if op == "&&" else any
            return Expression(text, I16, lambda s: int(both((left.value(s), right.value(s)))))
        kind = U16 if U16 in (promoted(left), promoted(right)) else I16
        work = {
            "<": int.__lt__,
            ">": int.__gt__,
            "<=": int.__le__,
            ">=": int.__ge__,
            "==": int.__eq__,
            "!=": int.__ne__,
        }[op]
        return Expression(
            text, I16, lambda s: int(work(fit(left.value(s), kind), fit(right.value(s), kind)))
        )

    def shifted(self, depth: int) -> Expression:
        """Return a shift by a constant."""
        inner, count = self.varying(depth), self.random.randrange(1, 15)
        kind = promoted(inner)
        if self.random.random() < 0.5:
            return Expression(
                f"({inner.text} << {count})", kind, lambda s: fit(inner.value(s) << count, kind)
            )
        return Expression(f"({inner.text} >> {count})", kind, lambda s: inner.value(s) >> count)

    def one_sided(self, depth: int) -> Expression:
        """Return a sign, a complement, a negation or a cast."""
        inner = self.varying(depth)
        op = self.random.choice(["-", "~", "!", U8, I16, U16])
        if op == "!":
            return Expression(f"(!{inner.text})", I16, lambda s: int(not inner.value(s)))
        if op in "-~":
            kind = promoted(inner)
            work = int.__neg__ if op == "-" else int.__invert__
            return Expression(
                f"({op}{inner.text})", kind, lambda s: fit(work(inner.value(s)), kind)
            )
        return Expression(f"(({op}){inner.text})", op, lambda s: fit(inner.value(s), op))

    def other(self, depth: int) -> Expression:
        """Return a choice, an element at a computed place, or a call."""
        inner, left, right = (self.varying(depth) for _ in range(3))
        kind = self.random.choice(["choice", "array", "table", "byte", "native"])
        if kind == "choice":
            both = U16 if U16 in (promoted(left), promoted(right)) else I16
            return Expression(
                f"({inner.text} ? {left.text} : {right.text})",
                both,
                lambda s: fit((left if inner.value(s) else right).value(s), both),
            )
        if kind == "array":
            name = self.random.choice(sorted(ARRAYS))
            return Expression(
                f"{name}[{inner.text} & 7]",
                ARRAYS[name],
                lambda s: s.arrays[name][inner.value(s) & 7],
            )
        if kind == "table":
            name = self.random.choice(sorted(TABLES))
            return Expression(
                f"{name}[{inner.text} & 7]",
                TABLES[name][0],
                lambda s: TABLES[name][1][inner.value(s) & 7],
            )
        return Expression(
            f"{kind}_mix((uint8_t){left.text}, (uint16_t){right.text})",
            U16,
            lambda s: fit(fit(left.value(s), U8) * 3 + (fit(right.value(s), U16) >> 1), U16),
        )

    def statement(self, depth: int) -> tuple[str, Callable[[State], None]]:
        """Return a statement and what it does."""
        kind = self.random.choice(["set", "set", "element", "if", "loop", "switch", "add"])
        if depth == 0 or kind in ("set", "add"):
            return self.assignment("+=" if kind == "add" else "=")
        return {"element": self.element, "if": self.if_, "loop": self.loop, "switch": self.switch}[
            kind
        ](depth - 1)

    def assignment(self, op: str) -> tuple[str, Callable[[State], None]]:
        """Return variable = or += expression."""
        name, kind = self.random.choice(VARIABLES)
        inner = self.expression(3)

        def run(state: State) -> None:
            value = inner.value(state)
            state.numbers[name] = fit(value + (state.numbers[name] if op == "+=" else 0), kind)

        return f"{name} {op} {inner.text};", run

    def element(self, _: int) -> tuple[str, Callable[[State], None]]:
        """Return array[expression] = expression."""
        name = self.random.choice(sorted(ARRAYS))
        index, inner = self.expression(1), self.expression(2)

        def run(state: State) -> None:
            value = fit(inner.value(state), ARRAYS[name])
            state.arrays[name][index.value(state) & 7] = value

        return f"{name}[{index.text} & 7] = {inner.text};", run

    def if_(self, depth: int) -> tuple[str, Callable[[State], None]]:
        """Return if and else."""
        condition = self.expression(2)
        (yes, do_yes), (no, do_no) = self.statement(depth), self.statement(depth)

        def run(state: State) -> None:
            (do_yes if condition.value(state) else do_no)(state)

        return f"if ({condition.text}) {{ {yes} }} else {{ {no} }}", run

    def loop(self, depth: int) -> tuple[str, Callable[[State], None]]:
        """Return a loop of some rounds, left early on a condition."""
        rounds, condition = self.random.randrange(1, 5), self.expression(1)
        body, do_body = self.statement(depth)
        counter = f"i{depth}"

        def run(state: State) -> None:
            for _ in range(rounds):
                do_body(state)
                if condition.value(state):
                    break

        text = f"for ({counter} = 0; {counter} < {rounds}; {counter}++)"
        return f"{text} {{ {body} if ({condition.text}) {{ break; }} }}", run

    def switch(self, depth: int) -> tuple[str, Callable[[State], None]]:
        """Return a switch, one case of which runs on into the next."""
        condition = self.expression(2)
        (one, do_one), (two, do_two), (rest, do_rest) = (self.statement(depth) for _ in range(3))

        def run(state: State) -> None:
            number = condition.value(state) & 3
            if number == 0:
                do_one(state)
            if number in (0, 2):
                do_two(state)
            if number in (1, 3):
                do_rest(state)

        text = f"case 0: {one} case 2: {two} break; default: {rest} break;"
        return f"switch ({condition.text} & 3) {{ {text} }}", run

    def function(self, name: str) -> tuple[str, Callable[[State], None]]:
        """Return a function of some statements."""
        parts = [self.statement(2) for _ in range(4)]

        def run(state: State) -> None:
            for _, do in parts:
                do(state)

        body = "\n    ".join(text for text, _ in parts)
        return (
            f"static void {name}(void)\n{{\n    uint8_t i0;\n    uint8_t i1;\n    {body}\n}}\n",
            run,
        )
