# SPDX-License-Identifier: Apache-2.0
"""What the parts of the byte-code compiler tell each other: operations, functions, names."""

from __future__ import annotations

from dataclasses import dataclass, field

from bytecode_types import I16, U16, Type, Types


@dataclass(frozen=True)
class Place:
    """An address in RAM or code: a symbol of C and bytes behind it."""

    symbol: str
    offset: int = 0

    def __str__(self) -> str:
        """As the assembler writes it."""
        return f"{self.symbol}+{self.offset}" if self.offset else self.symbol

    def plus(self, offset: int) -> Place:
        """Return the place so many bytes further on."""
        return Place(self.symbol, self.offset + offset)


@dataclass(frozen=True)
class Code:
    """One operation; the operand is a Place, a number, a label or a function.

    `extra`: the number that a case compares with, the bytes of arguments of a
    native function.
    """

    op: str
    operand: Place | int | str | None = None
    extra: int | None = None


@dataclass(frozen=True)
class Label:
    """A place that jumps go to."""

    name: str


Line = Code | Label


@dataclass
class Function:
    """A compiled function; `locals` has its variables, arguments first."""

    name: str
    parameters: list[str]
    result: Type
    code: list[Line] = field(default_factory=list)
    locals: dict[str, Type] = field(default_factory=dict)
    calls: set[str] = field(default_factory=set)
    module: str = ""  # the source file
    meanwhile: set[tuple[str, str]] = field(default_factory=set)  # arguments wait for a call
    absorbed: set[str] = field(default_factory=set)  # symbols of functions that were put in

    def own_symbols(self) -> set[str]:
        """Return the symbols of the local variables."""
        return self.absorbed | {f"{self.name}.{variable}" for variable in self.locals}

    def natives(self) -> list[Code]:
        """Return the calls of native functions, once the operations are the chip's."""
        codes = [line for line in self.code if isinstance(line, Code)]
        return [code for code in codes if code.op in ("native8", "native16")]


@dataclass
class Whole:
    """What the optimiser must know of the rest of the program, by name."""

    volatile: set[str]  # variables
    takes_a: set[str]  # functions with an argument in A
    narrow: set[str]  # functions that return 8 bits


@dataclass
class Signature:
    """What callers know of a function."""

    result: Type
    parameters: list[tuple[str, Type]]


@dataclass
class Unit:
    """What the functions of one source file can see."""

    name: str
    types: Types
    variables: dict[str, tuple[Place, Type]] = field(default_factory=dict)
    tables: dict[str, tuple[Place, Type]] = field(default_factory=dict)
    functions: dict[str, Signature] = field(default_factory=dict)
    renamed: dict[str, str] = field(default_factory=dict)


def common(left: Type, right: Type) -> Type:
    """Return the type in which two numbers are added or compared."""
    return U16 if any(kind.size == 2 and not kind.signed for kind in (left, right)) else I16
