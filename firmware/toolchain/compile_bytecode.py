#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compile modules of C to byte code.

usage: compile_bytecode.py --native FILE.asm... -o OUT.asm --stack OUT.json FILE.i [FILE.i ...]

The .i files are preprocessed C. `--native` files are the assembly of all other
modules: they tell which functions need an entry (they call them), and where a
native function leads back into byte code. Stops with a message at anything
that byte code cannot express; firmware/bytecode/README.md lists that.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

from bytecode_compile import Compiler
from bytecode_frames import Frames
from bytecode_inline import inline
from bytecode_layout import Layout
from bytecode_link import Module, stack_use, write
from bytecode_model import Function, Place, Signature, Unit, Whole
from bytecode_optimise import Pieces, choose, optimise
from bytecode_truth import share_truths
from bytecode_types import U8, BytecodeError, Types
from pycparser import c_ast, c_parser

INTERRUPT = "_low_interrupt"
NAME = r"_[a-zA-Z]\w*"  # of a function; the compiler's jumps go to _ and digits


class Source:
    """One preprocessed file."""

    def __init__(self, path: Path) -> None:
        """Parse it."""
        self.name = path.stem
        text = path.read_text()
        text = re.sub(r"^#pragma.*$", "", text, flags=re.M)
        text = re.sub(r"__at\s*\(?\s*0x[0-9a-fA-F]+\s*\)?", "", text)
        text = text.replace("__asm__", "vm_asm")
        self.tree = c_parser.CParser().parse(text, path.name)
        self.definitions = [n for n in self.tree.ext if isinstance(n, c_ast.FuncDef)]
        self.unit = Unit(self.name, Types())
        self.module = Module(self.name.replace("/", "_"))
        self.volatile: set[str] = set()

    def declare(self, doubled: set[str]) -> None:
        """Note types, variables and functions; `doubled` names get the file's behind theirs."""
        for node in self.tree.ext:
            if isinstance(node, c_ast.Typedef):
                self.unit.types.names[node.name] = self.unit.types.of(node.type)
            elif isinstance(node, c_ast.FuncDef):
                self._function(node.decl, doubled)
            elif isinstance(node, c_ast.Decl):
                self._declaration(node, doubled)

    def _function(self, node: c_ast.Decl, doubled: set[str]) -> None:
        types = self.unit.types
        parameters = []
        for number, parameter in enumerate(node.type.args.params if node.type.args else []):
            kind = types.of(parameter.type)
            if kind.size:
                parameters.append((parameter.name or f"argument{number}", kind))
        self.unit.functions[node.name] = Signature(types.of(node.type), parameters)
        if "static" in node.storage and node.name in doubled:
            self.unit.renamed[node.name] = f"{node.name}__{self.name}"

    def _declaration(self, node: c_ast.Decl, doubled: set[str]) -> None:
        if isinstance(node.type, c_ast.FuncDecl):
            self._function(node, doubled)
            return
        kind = self.unit.types.of(node.type)
        if node.name is None:
            return
        own = "static" in node.storage
        label = f"_{node.name}__{self.name}" if own and node.name in doubled else f"_{node.name}"
        if "volatile" in node.quals or "volatile" in getattr(node.type, "quals", []):
            self.volatile.add(label)
        if "const" in _all_quals(node):
            self.unit.tables[node.name] = (Place(label), kind)
            if node.init is not None:
                self.module.tables[label] = self._table(node, kind)
            return
        if node.init is not None:
            raise BytecodeError(f"{node.coord}: an initialised variable")
        self.unit.variables[node.name] = (Place(label), kind)
        known = {name for name, _, _ in self.module.variables}
        if "extern" not in node.storage and label not in known:
            self.module.variables.append((label, kind.size, not own))

    def _table(self, node: c_ast.Decl, kind: object) -> list[int]:
        values = [self.unit.types.constant(item) for item in node.init.exprs]
        width = self.unit.types.of(node.type).element.size
        return [
            byte
            for value in values
            for byte in (value % (1 << 8 * width)).to_bytes(width, "little")
        ]


def _all_quals(node: c_ast.Decl) -> set[str]:
    found = set(node.quals)
    inner = node.type
    while inner is not None and not isinstance(inner, (c_ast.Struct, c_ast.IdentifierType)):
        found |= set(getattr(inner, "quals", None) or [])
        inner = getattr(inner, "type", None)
    return found


class Native:
    """Who calls whom in the assembly of the native modules."""

    def __init__(self, paths: list[Path]) -> None:
        """Read it."""
        self.calls: dict[str, set[str]] = defaultdict(set)
        for path in paths:
            text = re.sub(r";.*", "", path.read_text())
            shown = set(re.findall(r"^\s+global\s+(\w+)", text, re.M | re.I))
            private = set(re.findall(rf"^({NAME}):", text, re.M)) - shown
            owner = ""
            for line in text.splitlines():
                if label := re.match(rf"({NAME}):", line):
                    owner = self._within(path, label[1], private)
                found = re.match(rf"(?:\w+:)?\s+(?:call|rcall|goto|bra)\s+({NAME})", line, re.I)
                if found and owner:
                    self.calls[owner].add(self._within(path, found[1], private))

    @staticmethod
    def _within(path: Path, name: str, private: set[str]) -> str:
        return f"{name}@{path}" if name in private else name

    def reach(self, name: str) -> set[str]:
        """Return all that a function leads to, native or not."""
        seen: set[str] = set()
        todo = [name]
        while todo:
            for called in self.calls.get(todo.pop(), set()) - seen:
                seen.add(called)
                todo.append(called)
        return seen


def compile_all(sources: list[Source], native: Native) -> tuple[str, dict[str, Any]]:
    """Return the assembly and the use of the stack."""
    names = Counter(n.decl.name for s in sources for n in s.definitions)
    names += Counter(
        n.name
        for s in sources
        for n in s.tree.ext
        if isinstance(n, c_ast.Decl) and n.name and "static" in n.storage
        if not isinstance(n.type, c_ast.FuncDecl)
    )
    doubled = {name for name, count in names.items() if count > 1}
    for source in sources:
        source.declare(doubled)
    own = {s.unit.renamed.get(n.decl.name, n.decl.name) for s in sources for n in s.definitions}
    functions: list[Function] = []
    for source in sources:
        outside = {source.unit.renamed.get(n, n) for n in source.unit.functions} - own
        outside |= {"_mulint", "_divuint", "_moduint"}
        for node in source.definitions:
            functions.append(Compiler(source.unit, outside, node).function)
    whole = Whole(
        {label for source in sources for label in source.volatile},
        {function.name for function in functions if function.parameters},
        {function.name for function in functions if function.result == U8},
    )
    for function in functions:
        choose(function)
        optimise(function, whole)
    called = {name for reached in native.calls.values() for name in reached}
    entries = sorted(name for name in own if f"_{name}" in called)
    interrupted = {name[1:] for name in native.reach(INTERRUPT)} & own
    if interrupted:
        raise BytecodeError(f"an interrupt calls byte code: {', '.join(sorted(interrupted))}")
    for function in functions:
        if function.name in entries and function.parameters:
            raise BytecodeError(f"native code calls {function.name}(), which takes arguments")
    functions = _needed(functions, entries, own)
    reach = {
        name: {reached[1:] for reached in native.reach(f"_{name}")} & own
        for function in functions
        for name in function.calls - own
    }
    frames = Frames(functions, reach)
    functions = inline(functions, set(entries) | set().union(*reach.values()))
    for function in functions:
        optimise(function, whole)
    frames.settle(functions)
    share_truths(functions)
    Pieces(functions).fold()
    natives = sorted({str(line.operand) for f in functions for line in f.natives()})
    layout = Layout(functions, natives)
    modules = [source.module for source in sources]
    text = write(modules, layout, frames, entries)
    report = {
        "entries": entries,
        "flash": layout.sizes(),
        "functions": stack_use(functions),
        "operations": layout.operations(),
    }
    print(
        f"{layout.length} bytes of byte code, {2 * len(layout.pairs)} of pairs, "
        f"{2 * len(natives)} of natives, {frames.total} of local variables"
    )
    return text, report


def _needed(functions: list[Function], entries: list[str], own: set[str]) -> list[Function]:
    """Return the functions that something calls."""
    known = {function.name: function for function in functions}
    todo, seen = list(entries), set(entries)
    while todo:
        for called in (known[todo.pop()].calls & own) - seen:
            seen.add(called)
            todo.append(called)
    return [function for function in functions if function.name in seen]


def main() -> None:
    """Compile the files of the command line."""
    parser = argparse.ArgumentParser(description="Compile modules of C to byte code.")
    parser.add_argument("--native", type=Path, nargs="*", default=[])
    parser.add_argument("-o", dest="output", type=Path, required=True)
    parser.add_argument("--stack", type=Path, required=True)
    parser.add_argument("files", type=Path, nargs="+")
    arguments = parser.parse_args()
    try:
        sources = [Source(path) for path in arguments.files]
        text, report = compile_all(sources, Native(arguments.native))
    except (BytecodeError, c_parser.ParseError) as error:
        sys.exit(f"compile_bytecode.py: {error}")
    arguments.output.write_text(text)
    arguments.stack.write_text(json.dumps(report, indent=1) + "\n")


if __name__ == "__main__":
    main()
