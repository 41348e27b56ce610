# SPDX-License-Identifier: Apache-2.0
"""Expressions, conditions and calls of C in byte code."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from bytecode_model import Code, Function, Label, Place, Signature, Unit, common
from bytecode_types import I16, U8, U16, VOID, BytecodeError, Type, fit, refuse
from pycparser import c_ast

SWAPPED = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "==", "!=": "!="}
INVERTED = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "=="}
SIGNED_JUMP = {"<": "jlt", ">=": "jge", ">": "jgt", "<=": "jle", "==": "jeq", "!=": "jne"}
UNSIGNED_JUMP = SIGNED_JUMP | {"<": "jltu", ">=": "jgeu", ">": "jgtu", "<=": "jleu"}
SIMPLE_OPERATIONS = {"+": "add", "-": "sub", "&": "and", "|": "or", "^": "xor"}
COMMUTATIVE = {"+", "&", "|", "^", "*"}
FROM_RAM = {"add8", "add16", "sub8", "sub16", "and8", "and16", "or8", "or16", "xor8"}
LIBRARY = {"*": "_mulint", "/": "_divuint", "%": "_moduint"}


class Expressions:
    """Compiles expressions into the operations of one function."""

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
        if kind.size not in (1, 2):
            raise BytecodeError(f"{place} has {kind.size} bytes; 1 and 2 can be had")
        self.emit("ld8" if kind.size == 1 else "ld16", place)

    def store(self, place: Place, kind: Type) -> None:
        """Variable = A."""
        if kind.size not in (1, 2):
            raise BytecodeError(f"{place} has {kind.size} bytes; 1 and 2 can be had")
        self.emit("st8" if kind.size == 1 else "st16", place)

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

    # --- expressions -----------------------------------------------------------

    def constant(self, node: c_ast.Node) -> int | None:
        """Return the value of a constant expression, None if it is none."""
        return self.types.maybe_constant(node)

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
        if kind.size > 2:
            raise refuse(node, "more than 16 bits")
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

    def stacked(self, op: str, left: c_ast.Node, right: c_ast.Node) -> None:
        """A = left op right with the right side on the stack."""
        self.value(right)
        self.emit("push")
        self.value(left)
        self.emit(op)

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

    def simple(self, node: c_ast.Node) -> bool:
        """Tell whether an expression can be the right side of an operation as it is."""
        if self.constant(node) is not None:
            return True
        place = self.place(node)
        return place is not None and place[1].size in (1, 2)

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
