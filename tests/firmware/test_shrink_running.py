# SPDX-License-Identifier: Apache-2.0
"""A program shrunk by the whole-program pass computes the same as it did before."""

import os
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from virtual_lathe.chip import Chip

ROOT = Path(__file__).parents[2]
TOOL = ROOT / "firmware/toolchain/shrink_assembly.py"
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
SDCC = CACHE / "tornillo/sdcc-4.2.0"
SDCC_FLAGS = [
    *["-mpic16", "-p18f4550", "--no-warn-non-free", "--nostdlib", "--nostdinc", "--obanksel=9"],
    *["--optimize-cmp", "--optimize-df", "--denable-peeps", "--fomit-frame-pointer"],
    f"-I{SDCC}/include/pic16",
    f"-I{SDCC}/include",
    f"-I{ROOT}/build/firmware",
]

PROGRAM = """
#include <stdint.h>
#include "sfr.h"
#pragma stack 0x700 256
#pragma config WDT=OFF, XINST=OFF, LVP=OFF, FOSC=HSPLL_HS
volatile uint8_t reset_rcon;
volatile uint8_t reset_stkptr;
volatile uint8_t done, fault;
volatile uint16_t ticks;
volatile uint32_t trace;
uint8_t bytes[16];
uint16_t seen;
static const uint8_t table[8] = {3, 1, 4, 1, 5, 9, 2, 6};

static uint8_t shared(uint8_t a, uint8_t b)
{
    uint8_t c = a ^ b;
    uint8_t i;
    for (i = 0; i < 3; ++i) {
        c += a;
        if (c & 0x80) {
            c ^= b;
        }
    }
    return c;
}

static uint16_t turn_up(uint16_t a, uint8_t b)
{
    uint8_t i;
    for (i = 0; i < (b & 3); ++i) {
        a = (a << 1) ^ (a >> 15) ^ b;
    }
    return a;
}

static uint16_t turn_down(uint16_t a, uint8_t b)
{
    uint8_t i = b & 3;
    while (i) {
        --i;
        a = (a << 1) ^ (a >> 15) ^ b;
    }
    return a;
}

void low_interrupt(void) __interrupt(2)
{
    if (INTCON & 0x04) {
        INTCON &= 0xFB;
        TMR0L = 0xA3;
        ++ticks;
        seen += 77;
        if (turn_up(seen, (uint8_t)ticks) != turn_down(seen, (uint8_t)ticks)) {
            fault = 1;
        }
        if (shared(7, 9) != 35) {
            fault = 2;
        }
    }
}

static void note(uint32_t value)
{
    trace = (trace << 5) + (trace >> 27) + value + 1;
}

static int16_t signed_step(int8_t a, int16_t b)
{
    int16_t sum = a;
    switch (b & 3) {
    case 0:
        sum -= b;
        break;
    case 1:
        sum = (sum << 2) + a;
    case 2:
        sum ^= 0x55AA;
        break;
    case 3:
        sum = b > a ? sum + 1 : sum - 1;
        break;
    }
    return sum;
}

static uint32_t weigh(uint32_t a, uint8_t b, uint16_t c, int8_t d)
{
    uint32_t result = a * (b + 1u);
    uint8_t i;
    for (i = 0; i < 4; ++i) {
        result += (uint16_t)signed_step(d, c + i) ^ table[(b + i) & 7];
        if (result & 1) {
            result -= shared(b, bytes[i]);
        }
        note(result);
    }
    return result / (b + 1u) + c;
}

static void fill(__data uint8_t *to, uint8_t count, uint8_t value)
{
    while (count) {
        --count;
        *to++ = value;
        value = shared(value, count);
    }
}

void main(void)
{
    uint8_t i;
    uint32_t sum = 0;
    ADCON1 = 15;
    T0CON = 0xC4;
    INTCON2 = 0;
    RCON |= 0x80;
    INTCON = 0xE0;
    for (i = 0; i < 12; ++i) {
        fill(&bytes[i & 7], 5, i + 3);
        sum ^= weigh(sum + i, i * 7, (uint16_t)sum, (int8_t)(i - 6));
        note(sum + (uint16_t)signed_step((int8_t)bytes[i], (int16_t)i * 300));
    }
    INTCON = 0;
    note(sum);
    done = 1;
    for (;;) {
    }
}
"""


def built(folder: Path) -> tuple[Path, Path]:
    """Compile PROGRAM; return the image as SDCC makes it, and the shrunk one."""

    def run(*command: str | Path) -> None:
        subprocess.run(command, cwd=folder, check=True, capture_output=True)

    (folder / "plain.c").write_text(PROGRAM)
    run(SDCC / "bin/sdcc", *SDCC_FLAGS, "-S", "plain.c", "-o", "plain.asm")
    run(SDCC / "bin/sdcc", *SDCC_FLAGS, "-c", ROOT / "build/firmware/sfr.c", "-o", "sfr.o")
    startup = Path(__file__).with_name("bare_start.asm")
    run(sys.executable, TOOL, "--asm", startup, "-o", "shrunk.asm", "plain.asm")
    run("gpasm", "-p18f4550", "-c", startup, "-o", "startup.o")
    for name in ("plain", "shrunk"):
        run("gpasm", "-p18f4550", "-w2", "-c", f"{name}.asm", "-o", f"{name}.o")
        run(
            "gplink",
            "-c",
            "-m",
            "-s",
            ROOT / "firmware/tornillo.lkr",
            "-o",
            f"{name}.hex",
            f"{name}.o",
            "startup.o",
            "sfr.o",
            SDCC / "lib/libsdcc.lib",
        )
    return folder / "plain.hex", folder / "shrunk.hex"


def results(image: Path) -> dict[str, int]:
    """Run an image on the simulated chip until it says it is done; return its variables."""
    chip = Chip(image)
    for _ in range(50):
        chip.run(0.001)
        if chip.variable("done", 1):
            break
    return {
        name: chip.variable(name, size)
        for name, size in (("done", 1), ("fault", 1), ("ticks", 2), ("trace", 4), ("bytes", 16))
    }


def test_the_shrunk_program_computes_the_same_as_the_plain_one(tmp_path: Path) -> None:
    plain, shrunk_image = built(tmp_path)
    workers = [ProcessPoolExecutor(1, get_context("spawn")) for _ in range(2)]
    try:
        one, two = (
            worker.submit(results, image).result()
            for worker, image in zip(workers, (plain, shrunk_image), strict=True)
        )
    finally:
        for worker in workers:
            worker.shutdown()
    assert one["done"] == two["done"] == 1
    assert one["fault"] == two["fault"] == 0
    assert one["ticks"] > 10
    assert 5 < two["ticks"] < one["ticks"], "the shrunk program must be the quicker one"
    assert two["trace"] == one["trace"] != 0
    assert two["bytes"] == one["bytes"] != 0
