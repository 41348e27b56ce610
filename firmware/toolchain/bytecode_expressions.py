# SPDX-License-Identifier: Apache-2.0
"""Expressions, conditions and calls of C in byte code."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from bytecode_conditions import Conditions
from bytecode_model import Place, Signature, Unit, common
from bytecode_operators import COMMUTATIVE, FROM_RAM, LIBRARY, SIMPLE_OPERATIONS, SWAPPED
from bytecode_types import I16, U8, U16, VOID, Type, refuse
from pycparser import c_ast


class Expressions(Conditions):
    """Compiles expressions into the operations of one function."""

    # --- expressions -----------------------------------------------------------

    def value(self, node: c_ast.Node) -> Type:
        """A = expression; returns its type."""
        number = self.constant(node)
        if number is not None:
            self.load_constant(number)
            return self.constant_type(node, number)
        return self.known_place(node) or self.worked_out(node)

    def known_place(self, node: c_ast.Node) -> Type | None:
        """A = fixed address, or the variable there; None where it is neither."""
        fixed = self.address(node)
        if fixed is not None:
            self.emit("ldk", fixed[0])
            return Type(2, target=fixed[1].element)
        place = self.place(node)
        if place is not None:
            self.load(*place)
            return place[1]
        return None

    def worked_out(self, node: c_ast.Node) -> Type:
        """A = what has to be worked out."""
        for kind, compile_it in self.VALUES.items():
            if isinstance(node, kind):
                found: Type = compile_it(self, node)
                return found
        raise refuse(node, f"an expression that byte code cannot do: {type(node).__name__}")

    def constant_type(self, node: c_ast.Node, number: int) -> Type:
        """Return the type of a constant."""
        if isinstance(node, c_ast.Cast):
            return self.types.of(node.to_type)
        if isinstance(node, c_ast.Constant) and "u" in node.value.lower():
            return U16
        return I16 if -0x8000 <= number <= 0x7FFF else U16

    def type_of(self, node: c_ast.Node) -> Type:
        """Return the type of an expression without compiling it."""
        number = self.constant(node)
        if number is not None:
            return self.constant_type(node, number)
        kept, self.function.code = self.function.code, []
        calls, self.function.calls = self.function.calls, set()
        labels = self.labels
        try:
            return self.value(node)
        finally:
            self.function.code, self.function.calls, self.labels = kept, calls, labels

    def indexed(self, node: c_ast.ArrayRef) -> Type:
        """A = array[index]."""
        if isinstance(node.name, c_ast.ID) and node.name.name in self.unit.tables:
            place, kind = self.unit.tables[node.name.name]
            self.value(node.subscript)
            self.emit("ldt8" if kind.element.size == 1 else "ldt16", place)
            return kind.element
        base = self.address(node.name)
        if base is not None:
            place, kind = base[0], base[1].element
            self.value(node.subscript)
            self.emit("ldx8" if kind.size == 1 else "ldx16", place)
            return kind
        kind = self.pointer_sum(node)
        self.emit("ldi8" if kind.size == 1 else "ldi16")
        return kind

    def pointer_sum(self, node: c_ast.ArrayRef) -> Type:
        """A = pointer + index * size."""
        sum_of = c_ast.BinaryOp("+", node.name, node.subscript, node.coord)
        return self.binary(sum_of).element

    def cast(self, node: c_ast.Cast) -> Type:
        """A = the value in another type."""
        kind = self.types.of(node.to_type)
        inner = self.value(node.expr)
        if kind.size > 2 or (kind.size == 1 and kind.signed):
            raise refuse(node, "more than 16 bits, or 8 bits with a sign")
        if kind.size == 1 and inner.size != 1:
            self.emit("low")
        return kind

    def choice(self, node: c_ast.TernaryOp) -> Type:
        """A = condition ? this : that."""
        other, end = self.new_label(), self.new_label()
        self.jump_unless(node.cond, other)
        kind = self.value(node.iftrue)
        self.emit("jmp", end)
        self.put(other)
        second = self.value(node.iffalse)
        self.put(end)
        return common(kind, second) if kind.size and second.size else VOID

    def unary(self, node: c_ast.UnaryOp) -> Type:
        """A = operator expression."""
        match node.op:
            case "!":
                return self.truth(node)
            case "-" | "~":
                kind = self.value(node.expr)
                self.emit("neg" if node.op == "-" else "com")
                return common(kind, I16)
            case "*":
                kind = self.value(node.expr).element
                self.emit("ldi8" if kind.size == 1 else "ldi16")
                return kind
            case "++" | "--":
                return self.add_to(node, node.expr, 1 if node.op == "++" else -1)
        raise refuse(node, f"operator {node.op} in an expression")

    def add_to(self, node: c_ast.Node, what: c_ast.Node, amount: int) -> Type:
        """Variable += amount, with the new value in A."""
        place = self.place(what)
        if place is None:
            raise refuse(node, "only variables at a fixed place can be counted")
        self.load(*place)
        self.emit("addk", amount & 0xFFFF)
        self.store(*place)
        return place[1]

    def truth(self, node: c_ast.Node) -> Type:
        """A = 1 where the expression is true, else 0."""
        true, end = self.new_label(), self.new_label()
        self.jump_if(node, true)
        self.load_constant(0)
        self.emit("jmp", end)
        self.put(true)
        self.load_constant(1)
        self.put(end)
        return U8

    def binary(self, node: c_ast.BinaryOp) -> Type:
        """A = left operator right."""
        op = node.op
        if op in ("&&", "||", *SWAPPED):
            return self.truth(node)
        if op in ("<<", ">>"):
            return self.shift(node)
        left, right = node.left, node.right
        left_type, right_type = self.type_of(left), self.type_of(right)
        if (
            op in COMMUTATIVE
            and self.constant(right) is None
            and not left_type.target
            and self.simple(left)
        ):
            left, right = right, left
            left_type, right_type = right_type, left_type
        kind = common(left_type, right_type)
        if left_type.target and op in "+-":
            kind = Type(2, target=left_type.element)
            if left_type.element.size != 1:
                right = c_ast.BinaryOp(
                    "*", right, c_ast.Constant("int", str(left_type.element.size)), node.coord
                )
        self.operate(op, left, right, kind)
        return kind

    def operate(self, op: str, left: c_ast.Node, right: c_ast.Node, kind: Type) -> None:
        """A = left op right by the shortest way."""
        number = self.constant(right)
        if op in "|^" and number is not None and number & 0xFFFF > 0xFF:
            self.stacked(f"{SIMPLE_OPERATIONS[op]}s", left, right)
            return
        if op in LIBRARY:
            if number is not None and number & (number - 1) == 0 and number > 0:
                self.power_of_two(op, left, number)
                return
            if kind.signed and op != "*":
                raise refuse(left, f"{op} of signed numbers")
            self.value(right)
            self.emit("push")
            self.value(left)
            self.emit("push")
            self.emit("native16", LIBRARY[op], 4)
            self.emit("drop", 4)
            self.function.calls.add(LIBRARY[op])
            return
        name = SIMPLE_OPERATIONS[op]
        if number is not None:
            self.value(left)
            if op == "-":
                name, number = "add", -number
            self.emit(f"{name}k", number & 0xFFFF)
            return
        place = self.place(right)
        if place is not None and f"{name}{8 * place[1].size}" in FROM_RAM:
            self.value(left)
            self.emit(f"{name}{8 * place[1].size}", place[0])
            return
        self.stacked(f"{name}s", left, right)

    def power_of_two(self, op: str, left: c_ast.Node, number: int) -> None:
        """A = left * / % a power of two; numbers that are divided are not negative."""
        self.value(left)
        if op == "%":
            self.emit("andk", number - 1)
            return
        shift = number.bit_length() - 1
        if shift:
            self.emit("shl" if op == "*" else "shr", shift)

    def shift(self, node: c_ast.BinaryOp) -> Type:
        """A = left << >> right."""
        count = self.constant(node.right)
        if count is None:
            raise refuse(node, "shift by a number that is not constant")
        kind = self.value(node.left)
        if node.op == "<<":
            self.emit("shl", count)
            return common(kind, I16)
        if kind.signed:
            self.emit("sar", count)
        else:
            self.emit("shr", count)
        return kind

    # --- calls -----------------------------------------------------------------

    def call(self, node: c_ast.FuncCall) -> Type:
        """A = function(arguments)."""
        name = node.name.name
        if name == "vm_asm":
            self.emit("clrwdt")
            return VOID
        signature = self.unit.functions.get(name)
        if signature is None:
            raise refuse(node, f"{name}() is not declared")
        arguments = node.args.exprs if node.args else []
        if len(arguments) != len(signature.parameters):
            raise refuse(node, f"{name}() takes {len(signature.parameters)} arguments")
        target = self.unit.renamed.get(name, name)
        if target in self.native:
            self.call_native(node, target, signature, arguments)
        else:
            self.call_bytecode(node, target, signature, arguments)
        self.function.calls.add(target)
        return signature.result

    def call_native(
        self, node: c_ast.Node, name: str, signature: Signature, arguments: list[c_ast.Node]
    ) -> None:
        """Push the arguments, the last first, and call."""
        pushed = 0
        for argument, (_, kind) in reversed(
            list(zip(arguments, signature.parameters, strict=True))
        ):
            self.value(argument)
            if kind.size not in (1, 2):
                raise refuse(node, "an argument of more than 16 bits")
            self.emit("push8" if kind.size == 1 else "push")
            pushed += kind.size
        if signature.result.size > 2:
            raise refuse(node, f"{name}() returns more than 16 bits")
        wide = "16" if signature.result.size == 2 else "8"
        self.emit(f"native{wide}" if signature.result.size else "native", name, pushed)
        if pushed:
            self.emit("drop", pushed)

    def call_bytecode(
        self, node: c_ast.Node, name: str, signature: Signature, arguments: list[c_ast.Node]
    ) -> None:
        """Write the arguments where the function has them, the last to A, and call."""
        count = len(arguments)
        if any(name in calls_in(later, self.unit) for later in arguments[1:]):
            self.call_within_itself(name, signature, arguments)
            return
        for index, (argument, (parameter, kind)) in enumerate(
            zip(arguments, signature.parameters, strict=True)
        ):
            actual = self.value(argument)
            if index == count - 1:
                if kind.size == 1 and actual.size != 1:
                    pass  # the called function stores 8 bits
                continue
            for later in arguments[index + 1 :]:
                self.function.meanwhile |= {(name, called) for called in calls_in(later, self.unit)}
            self.store(Place(f"{name}.{parameter}"), kind)
        self.emit("call", name)

    def call_within_itself(
        self, name: str, signature: Signature, arguments: list[c_ast.Node]
    ) -> None:
        """Call f(x, f(y)): the arguments wait on the stack until all are there."""
        for argument in arguments:
            self.value(argument)
            self.emit("push")
        for parameter, kind in reversed(signature.parameters):
            self.load_constant(0)
            self.emit("adds")
            self.store(Place(f"{name}.{parameter}"), kind)
        self.load(Place(f"{name}.{signature.parameters[-1][0]}"), signature.parameters[-1][1])
        self.emit("call", name)

    # --- assignments -----------------------------------------------------------

    def assignment(self, node: c_ast.Assignment) -> Type:
        """Left = right, or left op= right."""
        if node.op != "=":
            return self.compound(node)
        place = self.place(node.lvalue)
        if place is not None:
            if place[1].size > 2:
                raise refuse(node, "more than 16 bits")
            self.value(node.rvalue)
            self.store(*place)
            return place[1]
        if not isinstance(node.lvalue, c_ast.ArrayRef):
            raise refuse(node, "assignment to something at no fixed place")
        base = self.address(node.lvalue.name)
        self.value(node.rvalue)
        self.emit("push")
        if base is not None:
            kind = base[1].element
            self.value(node.lvalue.subscript)
            self.emit("stx8" if kind.size == 1 else "stx16", base[0])
        else:
            kind = self.pointer_sum(node.lvalue)
            self.emit("sti8" if kind.size == 1 else "sti16")
        return kind

    def compound(self, node: c_ast.Assignment) -> Type:
        """Left op= right, which is left = left op right."""
        op = node.op[:-1]
        place = self.place(node.lvalue)
        if place is None:
            raise refuse(node, f"{node.op} on something at no fixed place")
        self.binary(c_ast.BinaryOp(op, node.lvalue, node.rvalue, node.coord))
        self.store(*place)
        return place[1]

    VALUES: ClassVar[dict[type[c_ast.Node], Callable[..., Type]]] = {
        c_ast.ArrayRef: indexed,
        c_ast.Cast: cast,
        c_ast.FuncCall: call,
        c_ast.Assignment: assignment,
        c_ast.TernaryOp: choice,
        c_ast.UnaryOp: unary,
        c_ast.BinaryOp: binary,
    }


def calls_in(node: c_ast.Node, unit: Unit) -> set[str]:
    """Return the functions that an expression calls."""
    found = {called for _, child in node.children() for called in calls_in(child, unit)}
    if isinstance(node, c_ast.FuncCall):
        found.add(unit.renamed.get(node.name.name, node.name.name))
    return found
