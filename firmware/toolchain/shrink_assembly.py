#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Shrink the assembly that SDCC generates, looking at the whole program at once.

usage: shrink_assembly.py [--report] [--registers N] [--levels N] \
    [--entries FILE.json] [--asm FILE.asm]... -o OUT.asm FILE.asm [FILE.asm ...]

Joins the files into one. SDCC compiles each function as if anything could call
it at any time; here all functions and their callers are known, there is no
recursion, and nothing is called through a pointer, so registers and arguments
can have fixed places (shrink_registers.py, shrink_arguments.py), what nobody
needs can go (shrink_simplify.py, shrink_compares.py), a function called once can
stand in the place of the call (shrink_inline.py), of equal pieces one can stay
(shrink_fold.py: at most N levels of the return stack, interrupts included, are
used), and calls can be short (shrink_layout.py).
Stops with a message, and writes nothing, at anything it does not understand.
"""

import argparse
import re
import sys
from collections import Counter
from pathlib import Path

from shrink_arguments import check_stack, static_arguments
from shrink_banks import drop_bank_selections, selected_by
from shrink_compares import compare_on, compare_words
from shrink_entries import add_entries, read_entries, remove_entries
from shrink_flow import Liveness
from shrink_fold import Folder
from shrink_inline import inline_single_calls
from shrink_jumps import return_literals, return_values, shorten_ways, tail_calls
from shrink_layout import check_reach, order, shorten
from shrink_levels import levels_of, outside_levels
from shrink_model import Program, RefusalError, read_program, write_program
from shrink_registers import (
    Interference,
    allocate,
    assign,
    copies,
    drop_saves,
    find_frame,
    reachable,
    refuse_recursion,
)
from shrink_results import results_in_registers
from shrink_simplify import add_into_pointer, drop_repeated_loads, drop_unneeded, store_less_tests

MAIN = "_main"
INTERRUPT = "_low_interrupt"
HIGH_INTERRUPT_LEVELS = LOW_INTERRUPT_LEVELS = 1  # besides what they call
LIBRARY = ("__mul", "__div", "__mod")


class TooManyError(Exception):
    """More register bytes are needed than allowed."""


class Shrinker:
    """Takes a program through all steps; `steps` holds the bytes each saved."""

    def __init__(
        self,
        program: Program,
        assembly: str,
        entries: dict[str, list[str]],
        *,
        registers: int,
        levels: int,
        saving: set[str],
    ) -> None:
        """Find what is called from where; RefusalError where that is not sound."""
        self.program = program
        self.entries = entries
        add_entries(program, entries)
        self.assembly = assembly
        self.limit = registers
        self.levels = levels
        self.steps: Counter[str] = Counter()
        self.order: list[str] = []
        self.slots: list[str] = []
        self.interrupt_slots: list[str] = []
        self.repairs = 0
        refuse_recursion(program)
        code = re.sub(r";.*", "", assembly)
        _refuse_hand_written(code, set(program.functions) - {MAIN, INTERRUPT})
        names = set(re.findall(r"\b_\w+", code))
        called = {name for f in program.functions.values() for name in f.calls()}
        self.outside = called - set(program.functions)
        stand_ins = {name for entry in entries for name in (entry, f"{entry}_below")}
        self.roots = (names | {MAIN, INTERRUPT} | (set(program.functions) - called)) & set(
            program.functions
        ) | stand_ins
        self.takes_w = {
            name for name in self.outside if name in names or name.startswith(("__gptr", "__gput"))
        }
        self.interrupt = reachable(program, INTERRUPT)
        background = set().union(
            *(reachable(program, root) for root in self.roots - {INTERRUPT}), set()
        )
        self.shared = self.interrupt & background
        self.background = set(program.functions) - self.interrupt | self.shared
        odd = {name for name, f in program.functions.items() if find_frame(f) is None}
        self.kept = self.shared | odd | saving
        self._refuse_shared_library()

    def _refuse_shared_library(self) -> None:
        """SDCC's arithmetic keeps values in fixed places: only one side may use it."""

        def used(names: set[str]) -> set[str]:
            return {
                called
                for name in names
                for called in self.program.functions[name].calls()
                if called in self.outside and called.startswith(LIBRARY)
            }

        both = used(self.interrupt) & used(self.background)
        if both:
            raise RefusalError(f"called by interrupt and main loop: {', '.join(sorted(both))}")

    def size(self) -> int:
        """Return the bytes all functions take now."""
        return sum(function.size() for function in self.program.functions.values())

    def live(self) -> Liveness:
        """Return what is needed where, as the program stands."""
        return Liveness(self.program, self.roots - {MAIN}, self.takes_w)

    def run(self) -> None:
        """Take all steps; raise RefusalError when one is not safe."""
        check_stack(self.program)
        before = self.size()
        static_arguments(self.program, self.live(), self.roots | self.kept)
        self._count("arguments", before)
        before = self.size()
        drop_saves(self.program, self.kept)
        self._count("saves", before)
        results_in_registers(self.program, self.live(), self.roots | self.kept)
        self._simplify()
        self._place_registers()
        check_stack(self.program)
        before = self.size()
        shorten_ways(self.program)
        self._count("jumps", before)
        before = self.size()
        self.repairs = drop_bank_selections(self.program, self.assembly, self.roots)
        self._count("bank selections", before)
        before = self.size()
        inline_single_calls(self.program, self.roots | self.interrupt, {MAIN})
        shorten_ways(self.program)
        self._count("called once", before)
        before = self.size()
        compare_words(self.program, self.live())
        compare_on(self.program)
        drop_repeated_loads(self.program, self.live())
        drop_unneeded(self.program, self.live(), places=True)
        shorten_ways(self.program)
        self._count("compares", before)
        before = self.size()
        tail_calls(self.program)
        return_literals(self.program)
        self._count("returns", before)
        self._fold()
        self.steps["short calls"] += shorten(self.program, self.order)
        check_reach(self.program, self.order)

    def _fold(self) -> None:
        """Keep one of equal pieces of code, but leave what an interrupt executes as it is."""
        outside = outside_levels(self.assembly)
        interrupts = HIGH_INTERRUPT_LEVELS + LOW_INTERRUPT_LEVELS
        if INTERRUPT in self.program.functions:
            interrupts += levels_of(self.program, outside, INTERRUPT)
        bank = selected_by(self.program, self.assembly)
        fixed = self.interrupt & set(self.program.functions)
        fixed |= {name for entry in self.entries for name in (entry, f"{entry}_below")}
        folder = Folder(self.program, order(self.program), fixed, bank, outside)
        self.order = folder.run(MAIN, self.levels - interrupts)
        self.steps.update(folder.saved)
        self.order = remove_entries(self.program, self.order, self.entries)

    def _count(self, step: str, before: int) -> None:
        self.steps[step] += before - self.size()

    def _simplify(self) -> None:
        return_values(self.program)
        before = -1
        while before != self.size():
            before = self.size()
            self.steps["unneeded"] += drop_unneeded(self.program, self.live())
            self.steps["repeated"] += drop_repeated_loads(self.program, self.live())
            self.steps["tests"] += store_less_tests(self.program, self.live())
            self.steps["pointers"] += add_into_pointer(self.program, self.live())

    def text(self) -> str:
        """Return the program as one assembly file."""
        return write_program(self.program, self.order, self.slots, self.interrupt_slots)

    def _place_registers(self) -> None:
        """Give all registers places: the interrupt's in a section of its own.

        The library's routines overlay the main loop's, and save what they use.
        """
        interrupt = self.interrupt - self.shared
        live = self.live()
        names = {}
        for group, letter, slots in (
            (self.background, "r", self.slots),
            (interrupt, "i", self.interrupt_slots),
        ):
            graph = Interference(self.program, live, self.kept, group)
            places = allocate(graph, copies(self.program))
            slots += [f"{letter}0x{n:02x}" for n in range(max(places.values(), default=-1) + 1)]
            names.update({register: f"@{slots[n]}" for register, n in places.items()})
        used = len(self.slots) + len(self.interrupt_slots)
        if used > self.limit:
            raise TooManyError(f"{used} register bytes needed, {self.limit} allowed")
        assign(self.program, names)
        before = -1
        while before != self.size():
            before = self.size()
            self.steps["copies"] += drop_repeated_loads(self.program, self.live())
            self.steps["copies"] += drop_unneeded(self.program, self.live(), places=True)


def _refuse_hand_written(code: str, functions: set[str]) -> None:
    """Hand-written code may not use SDCC's registers nor call C other than main."""
    if found := re.search(r"\br0x[0-9a-f]+\b", code, re.IGNORECASE):
        raise RefusalError(f"hand-written assembly uses {found.group(0)}")
    called = re.findall(r"\b(?:r?call|goto|bra)\s+(_\w+)", code, re.IGNORECASE)
    if both := functions & set(called):
        raise RefusalError(f"hand-written assembly calls {', '.join(sorted(both))}")


def heaviest(program: Program, kept: set[str]) -> str:
    """Return the function that should rather save: many registers, much called."""
    below = {name: reachable(program, name) for name in program.functions}

    def weight(name: str) -> tuple[int, str]:
        callers = sum(name in names for names in below.values()) - 1
        return len(program.functions[name].registers()) * callers, name

    best = max(set(program.functions) - kept, key=weight, default="")
    if not best or weight(best)[0] == 0:
        raise RefusalError("too few registers allowed")
    return best


def shrink(
    files: list[Path],
    assembly: list[Path],
    entries: dict[str, list[str]],
    registers: int,
    levels: int,
) -> tuple[str, str]:
    """Return the program as one assembly text, and the report.

    As long as more register bytes are needed than allowed, one function more
    keeps its saves.
    """
    outside = "\n".join(path.read_text() for path in assembly)
    saving: set[str] = set()
    while True:
        program = read_program(files)
        before = _sizes(program)
        shrinker = Shrinker(
            program, outside, entries, registers=registers, levels=levels, saving=saving
        )
        try:
            shrinker.run()
            break
        except TooManyError:
            saving.add(heaviest(read_program(files), shrinker.kept))
    return shrinker.text(), _report(shrinker, before)


def _report(shrinker: Shrinker, before: Counter[str]) -> str:
    after = _sizes(shrinker.program)
    lines = [f"{name:16}{before[name]:7}{after[name]:7}" for name in sorted(before)]
    lines.append(f"{'all':16}{before.total():7}{after.total():7}")
    lines += [f"  {step:20}{-count:7}" for step, count in shrinker.steps.items()]
    lines.append(
        f"  register bytes: {len(shrinker.slots)} main loop, "
        f"{len(shrinker.interrupt_slots)} interrupt"
    )
    lines.append(f"  bank selections that SDCC forgot: {shrinker.repairs}")
    lines.append(f"  still saving: {' '.join(sorted(shrinker.kept)) or 'none'}")
    return "\n".join(lines)


def _sizes(program: Program) -> Counter[str]:
    sizes: Counter[str] = Counter()
    for function in program.functions.values():
        sizes[function.file] += function.size()
    return sizes


def main() -> None:
    """Read the command line, write the output file, print the report if asked."""
    parser = argparse.ArgumentParser(description="Shrink generated assembly.")
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("-o", dest="output", type=Path, required=True)
    parser.add_argument("--asm", action="append", type=Path, default=[])
    parser.add_argument("--entries", type=Path, help="report of compile_bytecode.py")
    parser.add_argument("--registers", type=int, default=48)
    parser.add_argument("--levels", type=int, default=20)
    parser.add_argument("--report", action="store_true")
    options = parser.parse_args()
    try:
        entries = read_entries(options.entries) if options.entries else {}
        text, report = shrink(
            options.files, options.asm, entries, options.registers, options.levels
        )
    except RefusalError as refusal:
        sys.exit(f"shrink_assembly: {refusal}")
    options.output.write_text(text)
    if options.report:
        print(report)


if __name__ == "__main__":
    main()
