# SPDX-License-Identifier: Apache-2.0
"""C types as the byte code knows them, and constant expressions.

The chip's int has 16 bits; char is not used. A pointer has 16 bits and points
to RAM. Structures have no padding, as SDCC lays them out.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass, field

from pycparser import c_ast


class BytecodeError(Exception):
    """Something in the C source that the byte code cannot express."""


def refuse(node: c_ast.Node, text: str) -> BytecodeError:
    """Return the error for a place in the source."""
    return BytecodeError(f"{node.coord}: {text}")


@dataclass(frozen=True)
class Type:
    """A type; `count` is 0 but for arrays, `target` is what a pointer points to."""

    size: int
    signed: bool = False
    count: int = 0
    target: Type | None = None
    members: tuple[tuple[str, Type, int], ...] = field(default=(), repr=False)

    @property
    def element(self) -> Type:
        """What indexing or following it leads to."""
        if self.target is None:
            raise BytecodeError("neither a pointer nor an array")
        return self.target


VOID = Type(0)
U8 = Type(1)
I16 = Type(2, signed=True)
U16 = Type(2)
SIMPLE = {
    "void": VOID,
    "unsigned char": U8,
    "char": U8,
    "int": I16,
    "short": I16,
    "signed int": I16,
    "unsigned int": U16,
    "unsigned": U16,
    "short int": I16,
    "unsigned short": U16,
    "unsigned short int": U16,
    "signed short int": I16,
    "signed char": Type(1, signed=True),
    "long": Type(4, signed=True),
    "long int": Type(4, signed=True),
    "unsigned long": Type(4),
    "unsigned long int": Type(4),
    "long long": Type(8, signed=True),
    "long long int": Type(8, signed=True),
    "unsigned long long": Type(8),
    "unsigned long long int": Type(8),
    "signed long": Type(4, signed=True),
}


class Types:
    """Types and constants declared in one translation unit."""

    def __init__(self) -> None:
        """Start with the types of the language."""
        self.names: dict[str, Type] = {}
        self.structs: dict[str, Type] = {}
        self.constants: dict[str, int] = {}

    def of(self, node: c_ast.Node) -> Type:
        """Return the type that a declaration's type node describes."""
        if isinstance(node, (c_ast.TypeDecl, c_ast.Typename, c_ast.FuncDecl)):
            return self.of(node.type)
        match node:
            case c_ast.IdentifierType():
                found = self._named(node)
            case c_ast.PtrDecl():
                found = Type(2, target=self.of(node.type))
            case c_ast.ArrayDecl():
                element = self.of(node.type)
                count = self.constant(node.dim) if node.dim else 0
                found = Type(element.size * count, count=count or 1, target=element)
            case c_ast.Struct():
                found = self._struct(node)
            case c_ast.Enum():
                self.declare_enum(node)
                found = U8
            case _:
                raise refuse(node, f"a type that is not known: {type(node).__name__}")
        return found

    def _named(self, node: c_ast.IdentifierType) -> Type:
        name = " ".join(word for word in node.names if word not in ("const", "volatile"))
        if name in self.names:
            return self.names[name]
        if name in SIMPLE:
            return SIMPLE[name]
        raise refuse(node, f"type {name}")

    def _struct(self, node: c_ast.Struct) -> Type:
        if node.decls is not None:
            members = []
            offset = 0
            for member in node.decls:
                kind = self.of(member.type)
                members.append((member.name, kind, offset))
                offset += kind.size
            self.structs[node.name] = Type(offset, members=tuple(members))
        return self.structs[node.name]

    def declare_enum(self, node: c_ast.Enum) -> None:
        """Note the constants of an enumeration."""
        value = 0
        for item in node.values.enumerators if node.values else []:
            if item.value is not None:
                value = self.constant(item.value)
            self.constants[item.name] = value
            value += 1

    def constant(self, node: c_ast.Node) -> int:
        """Return the value of a constant expression; BytecodeError if it is none."""
        value = self.maybe_constant(node)
        if value is None:
            raise refuse(node, "not a constant")
        return value

    def maybe_constant(self, node: c_ast.Node) -> int | None:
        """Return the value of a constant expression, None if it is none."""
        value: int | None
        match node:
            case c_ast.Constant(type="char"):
                value = ord(node.value[1])
            case c_ast.Constant():
                value = int(node.value.rstrip("uUlL"), 0)
            case c_ast.ID():
                value = self.constants.get(node.name)
            case c_ast.UnaryOp(op="sizeof"):
                value = self.of(node.expr).size
            case c_ast.UnaryOp() | c_ast.Cast():
                value = self._of_one(node)
            case c_ast.BinaryOp():
                left = self.maybe_constant(node.left)
                right = self.maybe_constant(node.right)
                value = None
                if left is not None and right is not None:
                    value = int(OPERATORS[node.op](left, right))
            case c_ast.TernaryOp():
                chosen = self.maybe_constant(node.cond)
                way = node.iftrue if chosen else node.iffalse
                value = None if chosen is None else self.maybe_constant(way)
            case _:
                value = None
        return value

    def _of_one(self, node: c_ast.UnaryOp | c_ast.Cast) -> int | None:
        value = self.maybe_constant(node.expr)
        if value is None:
            return None
        if isinstance(node, c_ast.Cast):
            return fit(value, self.of(node.to_type))
        signs = {"-": -value, "~": ~value, "!": int(not value), "+": value}
        return signs.get(node.op)


def fit(value: int, kind: Type) -> int:
    """Return what is left of a value in a type."""
    if kind.size == 0 or kind.target is not None:
        return value
    bits = 8 * kind.size
    value &= (1 << bits) - 1
    return value - (1 << bits) if kind.signed and value >> bits - 1 else value


OPERATORS: dict[str, Callable[[int, int], int]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.floordiv,
    "%": operator.mod,
    "<<": operator.lshift,
    ">>": operator.rshift,
    "&": operator.and_,
    "|": operator.or_,
    "^": operator.xor,
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
    "&&": lambda left, right: bool(left and right),
    "||": lambda left, right: bool(left or right),
}
