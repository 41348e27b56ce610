# SPDX-License-Identifier: Apache-2.0
"""Our multiplication and division give what C says, for every kind of operand."""

import random
import subprocess
import sys
from pathlib import Path

from simulated.processes import on_a_new_chip
from virtual_lathe.chip import Chip

from firmware.test_shrink_running import ROOT, SDCC, SDCC_FLAGS, TOOL

ARITHMETIC = ROOT / "firmware/arithmetic.asm"
STARTUP = Path(__file__).with_name("bare_start.asm")
PROGRAM = """
#include <stdint.h>
#pragma stack 0x700 256
#pragma config WDT=OFF, XINST=OFF, LVP=OFF, FOSC=HSPLL_HS
volatile uint8_t reset_rcon, reset_stkptr, go;
extern uint16_t factor_1, factor_2, divisor;
uint32_t product(void);
uint16_t proportion(void);
volatile uint16_t a, b, short_product, quotient, rest, share;
volatile uint32_t c, d, long_product, long_quotient, whole_product;
void low_interrupt(void) __interrupt(2) {}
void main(void)
{
    for (;;) {
        if (go) {
            short_product = a * b;
            quotient = a / b;
            rest = a % b;
            long_product = c * d;
            long_quotient = c / d;
            factor_1 = a;
            factor_2 = b;
            whole_product = product();
            factor_1 = a;
            factor_2 = b;
            divisor = a > b ? a : b;
            share = proportion();
            go = 0;
        }
    }
}
"""
EDGES_16 = (1, 2, 3, 255, 256, 257, 32767, 32768, 65535)
EDGES_32 = (1, 2, 255, 65535, 65536, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 3_072_000_000)


def built(folder: Path) -> Path:
    """Compile PROGRAM with our arithmetic and without the compiler's library."""

    def run(*command: str | Path) -> None:
        subprocess.run(command, cwd=folder, check=True, capture_output=True)

    (folder / "sums.c").write_text(PROGRAM)
    run(SDCC / "bin/sdcc", *SDCC_FLAGS, "-S", "sums.c", "-o", "sums.asm")
    run(sys.executable, TOOL, "--asm", STARTUP, "--asm", ARITHMETIC, "-o", "small.asm", "sums.asm")
    objects = []
    for source in (folder / "small.asm", STARTUP, ARITHMETIC):
        objects.append(f"{source.stem}.o")
        run("gpasm", "-p18f4550", "-w2", "-c", source, "-o", objects[-1])
    run("gplink", "-c", "-m", "-s", ROOT / "firmware/tornillo.lkr", "-o", "sums.hex", *objects)
    return folder / "sums.hex"


def operands() -> list[tuple[int, int, int, int]]:
    """Pair all edges with each other, and some hundred seeded random numbers of all sizes."""
    chance = random.Random(20)
    pairs = [(a, b) for a in (0, *EDGES_16) for b in EDGES_16]
    longs = [(c, d) for c in (0, *EDGES_32) for d in EDGES_32]
    for _ in range(200):
        pairs.append((chance.getrandbits(16), chance.getrandbits(chance.randint(1, 16)) | 1))
        longs.append((chance.getrandbits(32), chance.getrandbits(chance.randint(1, 32)) | 1))
    return [(a, b, c, d) for (a, b), (c, d) in zip(pairs, longs, strict=True)]


@on_a_new_chip
def test_products_quotients_and_rests_are_those_of_whole_numbers(tmp_path: Path) -> None:
    chip = Chip(built(tmp_path))
    chip.run(0.001)
    for a, b, c, d in operands():
        for name, value, size in (("a", a, 2), ("b", b, 2), ("c", c, 4), ("d", d, 4)):
            chip.set_variable(name, value, size)
        chip.set_variable("go", 1)
        assert chip.run_until(lambda: chip.variable("go") == 0, timeout=0.01)
        assert chip.variable("short_product", 2) == a * b & 0xFFFF, (a, b)
        assert chip.variable("whole_product", 4) == a * b, (a, b)
        assert chip.variable("share", 2) == a * b // max(a, b), (a, b)
        assert chip.variable("quotient", 2) == a // b, (a, b)
        assert chip.variable("rest", 2) == a % b, (a, b)
        assert chip.variable("long_product", 4) == c * d & 0xFFFFFFFF, (c, d)
        assert chip.variable("long_quotient", 4) == c // d, (c, d)
