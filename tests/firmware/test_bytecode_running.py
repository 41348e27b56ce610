# SPDX-License-Identifier: Apache-2.0
"""Random programs in byte code compute on the simulated chip what C's rules say."""

from __future__ import annotations

import re
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest
from virtual_lathe.chip import Chip

from firmware.random_c import ARRAYS, LENGTH, TABLES, U8, VARIABLES, Generator, State, fit
from firmware.test_shrink_running import ROOT, SDCC, SDCC_FLAGS

FUNCTIONS = 12
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
    cases = " ".join(f"case {number}: f{number}(); break;" for number in range(FUNCTIONS))
    lines.append(f"void begin(void) {{ turn = 0; {' '.join(first)} }}")
    lines.append(f"uint8_t go_on(void) {{ switch (turn) {{ {cases} default: return 0; }}")
    lines.append("turn++; return 1; }")
    for _, run in parts:
        run(state)
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
    own = [
        ROOT / f"firmware/{name}.asm" for name in ("startup", "arithmetic", "bytecode/interpreter")
    ]
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


@pytest.mark.parametrize("seed", range(1, 9))
def test_random_programs_compute_what_the_rules_of_c_say(seed: int, tmp_path: Path) -> None:
    source, wanted = program(seed)
    image = build(tmp_path, source)
    with ProcessPoolExecutor(1, get_context("spawn")) as worker:
        assert worker.submit(results, image).result() == wanted


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
    (tmp_path / "native.asm").write_text("_main:\n\tcall\t_begin\n")
    (tmp_path / "bytes.c").write_text(f"#include <stdint.h>\n{line}\n")
    sdcc = [str(SDCC / "bin/sdcc"), *SDCC_FLAGS]
    subprocess.run(
        [*sdcc, "-E", "bytes.c", "-o", "bytes.i"], cwd=tmp_path, check=True, capture_output=True
    )
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
