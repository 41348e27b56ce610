# SPDX-License-Identifier: Apache-2.0
"""Conditions of C in byte code: jumps where they are true, or false."""

from __future__ import annotations

from bytecode_model import common
from bytecode_operators import INVERTED, SIGNED_JUMP, SWAPPED, UNSIGNED_JUMP
from bytecode_places import Places
from bytecode_types import Type, fit
from pycparser import c_ast


class Conditions(Places):
    """Compiles conditions; what works out values comes on top (bytecode_expressions.py)."""

    def value(self, node: c_ast.Node) -> Type:
        """A = expression; returns its type."""
        raise NotImplementedError

    def type_of(self, node: c_ast.Node) -> Type:
        """Return the type of an expression without compiling it."""
        raise NotImplementedError

    def constant(self, node: c_ast.Node) -> int | None:
        """Return the value of a constant expression, None if it is none."""
        return self.types.maybe_constant(node)

    def simple(self, node: c_ast.Node) -> bool:
        """Tell whether an expression can be the right side of an operation as it is."""
        if self.constant(node) is not None:
            return True
        place = self.place(node)
        return place is not None and place[1].size in (1, 2)

    def stacked(self, op: str, left: c_ast.Node, right: c_ast.Node) -> None:
        """A = left op right with the right side on the stack."""
        self.value(right)
        self.emit("push")
        self.value(left)
        self.emit(op)

    # --- conditions ------------------------------------------------------------

    def jump_if(self, node: c_ast.Node, label: str) -> None:
        """Jump where the expression is true."""
        self.condition(node, label, True)

    def jump_unless(self, node: c_ast.Node, label: str) -> None:
        """Jump where the expression is false."""
        self.condition(node, label, False)

    def condition(self, node: c_ast.Node, label: str, wanted: bool) -> None:
        """Jump where the truth of the expression is as wanted."""
        number = self.constant(node)
        if number is not None:
            if bool(number) == wanted:
                self.emit("jmp", label)
            return
        match node:
            case c_ast.UnaryOp(op="!"):
                self.condition(node.expr, label, not wanted)
            case c_ast.BinaryOp(op="&&" | "||"):
                self.both(node, label, wanted)
            case c_ast.BinaryOp(op=op) if op in SWAPPED:
                self.comparison(node, label, wanted)
            case _:
                self.value(node)
                self.emit("jnz" if wanted else "jz", label)

    def both(self, node: c_ast.BinaryOp, label: str, wanted: bool) -> None:
        """Jump by && or ||."""
        if (node.op == "||") == wanted:
            self.condition(node.left, label, wanted)
            self.condition(node.right, label, wanted)
            return
        end = self.new_label()
        self.condition(node.left, end, not wanted)
        self.condition(node.right, label, wanted)
        self.put(end)

    def comparison(self, node: c_ast.BinaryOp, label: str, wanted: bool) -> None:
        """Jump by a comparison."""
        op, left, right = node.op, node.left, node.right
        kind = common(self.type_of(left), self.type_of(right))
        if self.constant(left) is not None or (self.simple(left) and not self.simple(right)):
            op, left, right = SWAPPED[op], right, left
        if not wanted:
            op = INVERTED[op]
        number = self.constant(right)
        if number is not None:
            number = fit(number, kind)
            if op == ">":
                op, number = ">=", number + 1
            elif op == "<=":
                op, number = "<", number + 1
            if (number == 0 and op in ("==", "!=")) or (number == 1 and not kind.signed):
                if op in ("==", "!=") and number == 0:
                    self.value(left)
                    self.emit("jz" if op == "==" else "jnz", label)
                    return
                if op in ("<", ">="):
                    self.value(left)
                    self.emit("jz" if op == "<" else "jnz", label)
                    return
            self.value(left)
            self.emit("cmpk", number & 0xFFFF)
        else:
            place = self.place(right)
            if place is not None and place[1].size in (1, 2):
                self.value(left)
                self.emit(f"cmp{8 * place[1].size}", place[0])
            else:
                self.stacked("cmps", left, right)
        self.emit((SIGNED_JUMP if kind.signed else UNSIGNED_JUMP)[op], label)
