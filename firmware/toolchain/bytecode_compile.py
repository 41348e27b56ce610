# SPDX-License-Identifier: Apache-2.0
"""Compiles functions of C to byte code (firmware/bytecode/interpreter.asm tells what each does).

The machine has one accumulator of 16 bits, A. Values of 8 bits are in it with
a high byte of 0. An operation takes its right side from RAM, from the code or
from the stack. Every variable has a fixed address: nothing is called
recursively, so local variables of functions that never run at once share theirs
(bytecode_link.py). The caller writes arguments straight into the called
function's variables, the last one comes in A; the result goes back in A.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from bytecode_expressions import Expressions
from bytecode_model import Code, Function, Unit
from bytecode_types import fit, refuse
from pycparser import c_ast

Statements = list[c_ast.Node]


class Compiler(Expressions):
    """Compiles one function."""

    def __init__(self, unit: Unit, native: set[str], node: c_ast.FuncDef) -> None:
        """`native`: functions that are not byte code."""
        name = node.decl.name
        signature = unit.functions[name]
        parameters = [parameter for parameter, _ in signature.parameters]
        function = Function(unit.renamed.get(name, name), parameters, signature.result)
        function.locals.update(signature.parameters)
        function.module = unit.name
        super().__init__(unit, native, function)
        self.breaks: list[str] = []
        self.continues: list[str] = []
        if parameters:
            self.store(*self.variable(node, parameters[-1]))
        self.statement(node.body)
        if not self.ends():
            self.emit("ret")

    # --- statements ------------------------------------------------------------

    def statement(self, node: c_ast.Node | None) -> None:
        """Compile one statement."""
        if node is None:
            return
        for kind, compile_it in self.STATEMENTS.items():
            if isinstance(node, kind):
                compile_it(self, node)
                return
        self.value(node)

    def nothing(self, node: c_ast.Node) -> None:
        """Compile a lone semicolon."""

    def block(self, node: c_ast.Compound) -> None:
        """Compile statements in braces."""
        for item in node.block_items or []:
            self.statement(item)

    def declarations(self, node: c_ast.DeclList) -> None:
        """Compile the declarations of a for."""
        for item in node.decls:
            self.statement(item)

    def counting(self, node: c_ast.UnaryOp) -> None:
        """Compile ++ and --, before or behind: nobody wants the value."""
        if node.op.strip("p") in ("++", "--"):
            self.add_to(node, node.expr, 1 if "+" in node.op else -1)
        else:
            self.value(node)

    def leave(self, node: c_ast.Break | c_ast.Continue) -> None:
        """Compile break and continue."""
        self.emit("jmp", (self.breaks if isinstance(node, c_ast.Break) else self.continues)[-1])

    def dropped(self, node: c_ast.Cast) -> None:
        """Compile (void)expression."""
        self.value(node.expr)

    def declaration(self, node: c_ast.Decl) -> None:
        """Give a local variable its place; names may come again in other blocks."""
        kind = self.types.of(node.type)
        known = self.function.locals.get(node.name)
        if known is not None and known != kind:
            raise refuse(node, f"{node.name} has another type elsewhere in the function")
        self.function.locals[node.name] = kind
        if node.init is not None:
            self.value(node.init)
            self.store(*self.variable(node, node.name))

    def if_(self, node: c_ast.If) -> None:
        """Compile if and else."""
        other = self.new_label()
        self.jump_unless(node.cond, other)
        self.statement(node.iftrue)
        if node.iffalse is None:
            self.put(other)
            return
        end = self.new_label()
        if not self.ends():
            self.emit("jmp", end)
        self.put(other)
        self.statement(node.iffalse)
        self.put(end)

    def loop(self, node: c_ast.While | c_ast.DoWhile | c_ast.For) -> None:
        """Compile while, do while, for."""
        top, again, end = self.new_label(), self.new_label(), self.new_label()
        self.breaks.append(end)
        self.continues.append(again)
        if isinstance(node, c_ast.For):
            self.statement(node.init)
        self.put(top)
        if isinstance(node, c_ast.DoWhile):
            self.statement(node.stmt)
            self.put(again)
            self.jump_if(node.cond, top)
        else:
            if not isinstance(node, c_ast.For):
                self.put(again)
            if node.cond is not None:
                self.jump_unless(node.cond, end)
            self.statement(node.stmt)
            if isinstance(node, c_ast.For):
                self.put(again)
                self.statement(node.next)
            self.emit("jmp", top)
        self.put(end)
        self.breaks.pop()
        self.continues.pop()

    def switch(self, node: c_ast.Switch) -> None:
        """Compile switch as a row of comparisons."""
        end = self.new_label()
        default = end
        self.breaks.append(end)
        self.value(node.cond)
        bodies = []
        for item in node.stmt.block_items:
            label = self.new_label()
            match item:
                case c_ast.Case():
                    self.function.code.append(Code("case", label, self.types.constant(item.expr)))
                case c_ast.Default():
                    default = label
                case _:
                    raise refuse(item, "a statement between cases")
            bodies.append((label, item.stmts))
        bodies = self._nested_cases(bodies)
        self.emit("jmp", default)
        for label, statements in bodies:
            self.put(label)
            for statement in statements or []:
                self.statement(statement)
        self.put(end)
        self.breaks.pop()

    def _nested_cases(self, bodies: list[tuple[str, Statements]]) -> list[tuple[str, Statements]]:
        """Take apart `case A: case B:`, which the parser puts one inside the other."""
        found: list[tuple[str, Statements]] = []
        for first, statements in bodies:
            label, rest = first, statements or []
            while rest and isinstance(rest[0], (c_ast.Case, c_ast.Default)):
                inner = rest[0]
                if isinstance(inner, c_ast.Default):
                    raise refuse(inner, "default inside a case")
                other = self.new_label()
                self.function.code.append(Code("case", other, self.types.constant(inner.expr)))
                found.append((label, []))
                label, rest = other, [*(inner.stmts or []), *rest[1:]]
            found.append((label, rest))
        return found

    def return_(self, node: c_ast.Return) -> None:
        """Compile return."""
        if node.expr is not None:
            number = self.constant(node.expr)
            if number is not None:
                self.emit("retk", fit(number, self.function.result) & 0xFFFF)
                return
            kind = self.value(node.expr)
            if self.function.result.size == 1 and kind.size != 1:
                self.emit("low")
        self.emit("ret")

    STATEMENTS: ClassVar[dict[Any, Callable[..., None]]] = {
        c_ast.EmptyStatement: nothing,
        c_ast.Compound: block,
        c_ast.Decl: declaration,
        c_ast.DeclList: declarations,
        c_ast.If: if_,
        (c_ast.While, c_ast.DoWhile, c_ast.For): loop,
        c_ast.Switch: switch,
        (c_ast.Break, c_ast.Continue): leave,
        c_ast.Return: return_,
        c_ast.UnaryOp: counting,
        c_ast.Cast: dropped,
    }
