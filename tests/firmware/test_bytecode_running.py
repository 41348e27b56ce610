# SPDX-License-Identifier: Apache-2.0
"""Random programs in byte code compute on the simulated chip what C's rules say."""

from __future__ import annotations

import re
import subprocess
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest
from bytecode_operations import MEMORY_ORDER, PLAIN, RARE
from compile_bytecode import Native, Source, compile_all
from virtual_lathe.chip import Chip

from firmware.random_c import ARRAYS, I16, LENGTH, TABLES, U8, VARIABLES, Generator, State, fit
from firmware.test_shrink_running import ROOT, SDCC, SDCC_FLAGS

FUNCTIONS = 12
SEEDS = range(1, 9)
ASSEMBLER: tuple[str | Path, ...] = (
    *("gpasm", "-p18f4550", "-w2"),
    *("-I", ROOT / "firmware/bytecode"),
)
TOOLCHAIN = ROOT / "firmware/toolchain"

NATIVE = """
#include <stdint.h>
#include "sfr.h"
#pragma stack 0x700 192
#pragma config WDT=OFF, XINST=OFF, LVP=OFF, FOSC=HSPLL_HS
volatile uint8_t reset_rcon;
volatile uint8_t reset_stkptr;
volatile uint8_t done;
extern void begin(void);
extern uint8_t go_on(void);
uint16_t native_mix(uint8_t a, uint16_t b)
{
    return a * 3u + (b >> 1);
}
uint8_t native_low(uint8_t a)
{
    return a ^ 0x5A;
}
uint16_t native_half(uint16_t b)
{
    return b >> 1;
}
void low_interrupt(void) __interrupt(2)
{
    INTCON &= 0xFB;
}
void main(void)
{
    begin();
    while (go_on()) {
    }
    done = 1;
    for (;;) {
    }
}
"""

# What random functions have not: pointers, small natives, numbers returned.
POINTERS = """
uint8_t native_low(uint8_t a);
uint16_t native_half(uint16_t b);
static void swap_bytes(uint8_t *at, uint8_t other)
{ uint8_t kept = *at; at[0] = at[other]; at[other] = kept; }
static void swap_words(int16_t *at, uint8_t other)
{ int16_t kept = *at; at[0] = at[other]; at[other] = kept; }
static int16_t sign(int16_t value)
{ if (value < 0) { return -5; } if (value > 9) { return 7; } return 3; }
static void by_pointers(void)
{
    __asm__("clrwdt");
    swap_bytes(bytes, 3);
    swap_bytes(bytes + 1, 5);
    swap_words(words, 4);
    swap_words(words + 2, 1);
    a0 = native_low(a1);
    c0 = native_half(c1);
    b1 = sign(b0);
    b2 = sign(words[0]);
    b0--;
}
"""


def by_pointers(state: State) -> None:
    """Do what the function in C does."""
    numbers, small, large = state.numbers, state.arrays["bytes"], state.arrays["words"]
    for values, one, other in ((small, 0, 3), (small, 1, 6), (large, 0, 4), (large, 2, 3)):
        values[one], values[other] = values[other], values[one]
    numbers["a0"] = numbers["a1"] ^ 0x5A
    numbers["c0"] = numbers["c1"] >> 1
    numbers["b1"], numbers["b2"] = (
        -5 if value < 0 else 7 if value > 9 else 3 for value in (numbers["b0"], large[0])
    )
    numbers["b0"] = fit(numbers["b0"] - 1, I16)


def start(seed: int) -> State:
    """Return the first values of all variables."""
    numbers = {
        name: fit(seed * 7919 + number * 12345, kind)
        for number, (name, kind) in enumerate(VARIABLES)
    }
    arrays = {
        name: [fit(seed * 31 + number * 4711, kind) for number in range(LENGTH)]
        for name, kind in ARRAYS.items()
    }
    return State(numbers, arrays)


def program(seed: int) -> tuple[str, State]:
    """Return the source of the byte code, and the variables as they must end."""
    generator = Generator(seed)
    state = start(seed)
    lines = ["#include <stdint.h>", "uint16_t native_mix(uint8_t a, uint16_t b);"]
    lines += [f"{kind} {name};" for name, kind in VARIABLES]
    lines += [f"{kind} {name}[{LENGTH}];" for name, kind in ARRAYS.items()]
    for name, (kind, values) in TABLES.items():
        lines.append(f"static const {kind} {name}[] = {{{', '.join(map(str, values))}}};")
    lines.append("static uint8_t turn;")
    lines.append("static uint16_t byte_mix(uint8_t a, uint16_t b)\n{ return a * 3u + (b >> 1); }")
    first = [f"{name} = {value};" for name, value in state.numbers.items()]
    for name, elements in state.arrays.items():
        first += [f"{name}[{index}] = {value};" for index, value in enumerate(elements)]
    parts = [generator.function(f"f{number}") for number in range(FUNCTIONS)]
    lines += [text for text, _ in parts]
    lines.append(POINTERS)
    cases = " ".join(f"case {number}: f{number}(); break;" for number in range(FUNCTIONS))
    cases += f" case {FUNCTIONS}: by_pointers(); break;"
    lines.append(f"void begin(void) {{ turn = 0; {' '.join(first)} }}")
    lines.append(f"uint8_t go_on(void) {{ switch (turn) {{ {cases} default: return 0; }}")
    lines.append("turn++; return 1; }")
    for _, run in parts:
        run(state)
    by_pointers(state)
    return "\n".join(lines), state


def build(folder: Path, source: str) -> Path:
    """Compile and link the program; return its image."""

    def run(*command: str | Path) -> None:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr

    (folder / "native.c").write_text(NATIVE)
    (folder / "bytes.c").write_text(source)
    run(SDCC / "bin/sdcc", *SDCC_FLAGS, "-S", "native.c", "-o", "native.asm")
    run(SDCC / "bin/sdcc", *SDCC_FLAGS, "-E", "bytes.c", "-o", "bytes.i")
    own = [Path(__file__).with_name("bare_start.asm")]
    own += [ROOT / f"firmware/{name}.asm" for name in ("arithmetic", "bytecode/interpreter")]
    compiler: list[str | Path] = [sys.executable, TOOLCHAIN / "compile_bytecode.py"]
    run(
        *compiler,
        "--native",
        "native.asm",
        *own,
        "-o",
        "bytes.asm",
        "--stack",
        "bytes.json",
        "bytes.i",
    )
    assembly: list[str | Path] = [
        item for path in (*own, folder / "bytes.asm") for item in ("--asm", path)
    ]
    shrinker: list[str | Path] = [sys.executable, TOOLCHAIN / "shrink_assembly.py", *assembly]
    run(*shrinker, "--entries", "bytes.json", "-o", "shrunk.asm", "native.asm")
    objects = []
    for path in (*own, folder / "bytes.asm", folder / "shrunk.asm"):
        objects.append(folder / f"{path.stem}.o")
        run(
            "gpasm",
            "-p18f4550",
            "-w2",
            "-I",
            ROOT / "firmware/bytecode",
            "-c",
            path,
            "-o",
            objects[-1],
        )
    run(SDCC / "bin/sdcc", *SDCC_FLAGS, "-c", ROOT / "build/firmware/sfr.c", "-o", "sfr.o")
    linker: list[str | Path] = ["gplink", "-q", "-c", "-m", "-s", ROOT / "firmware/tornillo.lkr"]
    run(*linker, "-o", "all.hex", *objects, "sfr.o", SDCC / "lib/libsdcc.lib")
    return folder / "all.hex"


def preprocess(folder: Path, source: str) -> None:
    """Leave the source in a folder as the compiler of byte code takes it, and who calls it."""
    (folder / "native.asm").write_text("_main:\n\tcall\t_begin\n\tcall\t_go_on\n")
    (folder / "bytes.c").write_text(source)
    command = [str(SDCC / "bin/sdcc"), *SDCC_FLAGS, "-E", "bytes.c", "-o", "bytes.i"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)


def operations(folder: Path, source: str) -> Counter[str]:
    """Return the operations that a program is compiled to."""
    preprocess(folder, source)
    _, report = compile_all([Source(folder / "bytes.i")], Native([folder / "native.asm"]))
    return Counter(report["operations"])


def results(image: Path) -> State:
    """Run an image until it says it is done; return its variables."""
    chip = Chip(image)
    assert chip.run_until(lambda: chip.variable("done") == 1, 2.0)
    found = State({}, {})
    for name, kind in VARIABLES:
        found.numbers[name] = fit(chip.variable(name, 1 if kind == U8 else 2), kind)
    for name, kind in ARRAYS.items():
        size = 1 if kind == U8 else 2
        packed = chip.variable(name, size * LENGTH).to_bytes(size * LENGTH, "little")
        found.arrays[name] = [
            fit(int.from_bytes(packed[at : at + size], "little"), kind)
            for at in range(0, size * LENGTH, size)
        ]
    return found


@pytest.mark.parametrize("seed", SEEDS)
def test_random_programs_compute_what_the_rules_of_c_say(seed: int, tmp_path: Path) -> None:
    source, wanted = program(seed)
    image = build(tmp_path, source)
    with ProcessPoolExecutor(1, get_context("spawn")) as worker:
        assert worker.submit(results, image).result() == wanted


def test_those_programs_use_every_operation_alone_and_as_a_pair(tmp_path: Path) -> None:
    found = sum((operations(tmp_path, program(seed)[0]) for seed in SEEDS), Counter[str]())
    assert not {*PLAIN, *RARE, *MEMORY_ORDER} - set(found)
    assert found["into"] > 0
    assert not {f"{op} pair" for op in ("jz", "jmp", "call", "ldk", "ld8", "st16")} - set(found)


def called_last() -> str:
    """Return a program whose functions call each other last."""
    return """
    uint8_t a;
    static void third(void) { a = a + 3; }
    static void second(void) { a = a + 2; third(); }
    void begin(void) { a = 1; second(); }
    uint8_t go_on(void) { third(); return 0; }
    """


def test_what_is_called_once_or_last_needs_no_call(tmp_path: Path) -> None:
    found = operations(tmp_path, "#include <stdint.h>\n" + called_last())
    assert found["call"] == 1  # of third() by go_on(), which goes on behind it
    assert found["into"] == 1  # begin(), with second() in it, to third()


def test_what_a_holds_is_not_loaded_and_what_nobody_reads_not_stored(tmp_path: Path) -> None:
    source = """#include <stdint.h>
    uint8_t a; uint8_t b; uint16_t c;
    void begin(void)
    {
        uint8_t kept = a;
        if (kept == 0) { b = 0; c = 0; } else { b = kept; }
    }
    uint8_t go_on(void) { a = 1; return 1; }
    """
    found = operations(tmp_path, source)
    loads = [op for op in found if op.startswith("ld") and not op.endswith("pair")]
    assert {op: found[op] for op in loads} == {"ld8": 1, "ld1": 1}


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("int32_t wide; void begin(void) { wide = 1; }", "more than 16 bits"),
        ("int8_t small; void begin(void) { small = -1; }", "8 bits with a sign"),
        ("uint8_t a; void begin(void) { a = (int8_t)a > 0; }", "8 bits with a sign"),
        ("int16_t a; void begin(void) { a = a / 3; }", "/ of signed numbers"),
        ("uint8_t a, b; void begin(void) { a = a << b; }", "not constant"),
        ("uint8_t a = 3; void begin(void) { a = 1; }", "an initialised variable"),
        ("uint8_t g(uint8_t n); void begin(void) { goto end; end: return; }", "cannot do: Goto"),
        ("static uint8_t f(uint8_t n) { return f(n); } void begin(void) { f(1); }", "recursion"),
        ("void begin(uint8_t a) { a = 1; }", "takes arguments"),
    ],
)
def test_what_byte_code_cannot_do_is_refused_with_its_place(
    line: str, reason: str, tmp_path: Path
) -> None:
    preprocess(tmp_path, f"#include <stdint.h>\n{line}\n")
    compiler = [sys.executable, str(TOOLCHAIN / "compile_bytecode.py"), "--native", "native.asm"]
    done = subprocess.run(
        [*compiler, "-o", "bytes.asm", "--stack", "bytes.json", "bytes.i"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert re.search(reason, done.stderr), done.stderr
