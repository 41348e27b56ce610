# SPDX-License-Identifier: Apache-2.0
"""Where the values of C lie: variables, members, elements, fixed addresses."""

from __future__ import annotations

from bytecode_model import Code, Function, Label, Place, Unit
from bytecode_types import BytecodeError, Type, refuse
from pycparser import c_ast


class Places:
    """Emits operations of one function, and finds variables."""

    def __init__(self, unit: Unit, native: set[str], function: Function) -> None:
        """`native`: functions that are not byte code."""
        self.unit = unit
        self.types = unit.types
        self.native = native
        self.function = function
        self.labels = 0

    # --- small helpers ---------------------------------------------------------

    def emit(
        self, op: str, operand: Place | int | str | None = None, extra: int | None = None
    ) -> None:
        """Append an operation."""
        self.function.code.append(Code(op, operand, extra))

    def new_label(self) -> str:
        """Return a label not used yet."""
        self.labels += 1
        return f"{self.function.name}@{self.labels}"

    def put(self, label: str) -> None:
        """Put a label here."""
        self.function.code.append(Label(label))

    def ends(self) -> bool:
        """Tell whether control cannot come to the end of what is there."""
        code = self.function.code
        return bool(code) and isinstance(code[-1], Code) and code[-1].op in ("ret", "retk", "jmp")

    def variable(self, node: c_ast.Node, name: str) -> tuple[Place, Type]:
        """Return where a variable is."""
        if name in self.function.locals:
            return Place(f"{self.function.name}.{name}"), self.function.locals[name]
        if name in self.unit.variables:
            return self.unit.variables[name]
        raise refuse(node, f"{name} is not a variable of RAM")

    def load_constant(self, value: int) -> None:
        """A = value."""
        self.emit("ldk", value & 0xFFFF)

    def load(self, place: Place, kind: Type) -> None:
        """A = variable."""
        self.emit(f"ld{self.bits(place, kind)}", place)

    def store(self, place: Place, kind: Type) -> None:
        """Variable = A."""
        self.emit(f"st{self.bits(place, kind)}", place)

    def bits(self, place: Place, kind: Type) -> int:
        """Return 8 or 16; BytecodeError for a variable that A cannot hold."""
        if kind.size not in (1, 2):
            raise BytecodeError(f"{place} has more than 16 bits")
        if kind.size == 1 and kind.signed:
            raise BytecodeError(f"{place} has 8 bits with a sign")
        return 8 * kind.size

    # --- addresses -------------------------------------------------------------

    def place(self, node: c_ast.Node) -> tuple[Place, Type] | None:
        """Return where an expression's value lies, None unless that is fixed."""
        match node:
            case c_ast.ID():
                if node.name in self.function.locals or node.name in self.unit.variables:
                    return self.variable(node, node.name)
            case c_ast.StructRef(type="."):
                inner = self.place(node.name)
                return None if inner is None else self.member(node, *inner)
            case c_ast.Cast():
                inner = self.place(node.expr)
                kind = self.types.of(node.to_type)
                if inner is not None and inner[1].size == kind.size == 2:
                    return inner[0], kind
            case c_ast.ArrayRef() | c_ast.UnaryOp(op="*"):
                return self.pointed_at(node)
        return None

    def pointed_at(self, node: c_ast.ArrayRef | c_ast.UnaryOp) -> tuple[Place, Type] | None:
        """Return the place of array[constant] or *address."""
        indexed = isinstance(node, c_ast.ArrayRef)
        base = self.address(node.name if indexed else node.expr)
        index = self.types.maybe_constant(node.subscript) if indexed else 0
        if base is None or index is None:
            return None
        return base[0].plus(index * base[1].element.size), base[1].element

    def member(self, node: c_ast.StructRef, place: Place, kind: Type) -> tuple[Place, Type]:
        """Return the member of a structure."""
        for name, member, offset in kind.members:
            if name == node.field.name:
                return place.plus(offset), member
        raise refuse(node, f"no member {node.field.name}")

    def address(self, node: c_ast.Node) -> tuple[Place, Type] | None:
        """Return the fixed address that an expression is: an array, &x, array + k, a cast of it."""
        match node:
            case c_ast.ID() if node.name in self.unit.variables:
                place, kind = self.unit.variables[node.name]
                return (place, kind) if kind.count else None
            case c_ast.UnaryOp(op="&"):
                inner = self.place(node.expr)
                return None if inner is None else (inner[0], Type(2, target=inner[1]))
            case c_ast.Cast():
                kind = self.types.of(node.to_type)
                inner = self.address(node.expr)
                return (inner[0], kind) if inner is not None and kind.target else None
            case c_ast.BinaryOp(op="+"):
                base = self.address(node.left)
                index = self.types.maybe_constant(node.right)
                if base is not None and index is not None:
                    return base[0].plus(index * base[1].element.size), base[1]
            case c_ast.StructRef():
                inner = self.place(node)
                return inner if inner is not None and inner[1].count else None
        return None
