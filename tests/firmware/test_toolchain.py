# SPDX-License-Identifier: Apache-2.0
"""The build's own tools, on programs small enough to be counted by hand."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from generate_sfr import read_registers
from repair_assembly import repair
from report_size import BOOT_BLOCK_BYTES, LOADER, read_hex, room
from stack_depth import Program, UnboundedStackError, Use, worst_case

ROOT = Path(__file__).parents[2]
TOOLS = ROOT / "firmware" / "toolchain"
HEADER = Path("/usr/share/gputils/header/p18f4550.inc")


def run(tool: str, *arguments: Path | str) -> subprocess.CompletedProcess[str]:
    """Run a tool as the build does."""
    command = [sys.executable, str(TOOLS / tool), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)


# -- repair_assembly ------------------------------------------------------------------------------


@pytest.mark.parametrize("operation", ["BTFSC", "BTFSS", "BTG", "BSF", "BCF", "btfsc"])
def test_a_bit_test_inside_a_variable_gets_the_bank_flag(operation: str) -> None:
    assert repair(f"\t{operation}\t(_rate + 1), 7") == f"\t{operation}\t(_rate + 1), 7, B\n"


@pytest.mark.parametrize(
    "line",
    [
        "\tBTFSC\t(_rate + 1), 7, B",
        "\tBTFSS\t_rate, 7, B",
        "\tBTFSC\tr0x01, 0",
        "\tMOVFF\t(_rate + 1), r0x00",
        "; BTFSC (_rate + 1), 7",
    ],
)
def test_everything_else_stays_as_it_is(line: str) -> None:
    assert repair(line) == line + "\n"


def test_an_initialised_variable_is_refused_and_its_file_removed(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.asm"
    wrong.write_text("\tradix dec\n_speed_0 idata\n_speed db 5\n")
    done = run("repair_assembly.py", wrong)
    assert done.returncode != 0
    assert "wrong.asm:2: initialised variable" in done.stderr
    assert not wrong.exists()


def test_an_interrupt_vector_lies_behind_the_boot_loader() -> None:
    vector = "S_main_ivec_0x2_low_interrupt\tcode\t0X000018"
    assert repair(vector) == vector[:-3] + "818\n"


def test_files_are_repaired_in_place(tmp_path: Path) -> None:
    file = tmp_path / "code.asm"
    file.write_text("\tBSF\t(_flags + 3), 2\n\tRETURN\n")
    assert run("repair_assembly.py", file).returncode == 0
    assert file.read_text() == "\tBSF\t(_flags + 3), 2, B\n\tRETURN\n"


# -- stack_depth ----------------------------------------------------------------------------------

PUSH, POP = 0x6EE5, 0x50E4  # movwf POSTDEC1; movf PREINC1, W
RETURN, RETFIE, NOP = 0x0012, 0x0010, 0x0000


def rcall(offset: int) -> int:
    """RCALL over so many words, counted from the next one."""
    return 0xD800 | offset & 0x7FF


def bra(offset: int) -> int:
    """BRA over so many words, counted from the next one."""
    return 0xD000 | offset & 0x7FF


def program(*words: int, at: int = 0x20) -> Program:
    """Return a program with a function at an address and nothing else."""
    flash = bytearray(b"\xff" * 0x200)
    for number, word in enumerate(words):
        flash[at + 2 * number : at + 2 * number + 2] = word.to_bytes(2, "little")
    return Program(bytes(flash))


@pytest.mark.parametrize(
    ("words", "use"),
    [
        pytest.param([RETURN], Use(0, 0), id="nothing"),
        pytest.param([PUSH, PUSH, POP, POP, RETURN], Use(2, 0), id="push and pop"),
        pytest.param([rcall(1), RETURN, PUSH, POP, RETURN], Use(1, 1), id="a call"),
        pytest.param(
            [PUSH, rcall(2), POP, RETURN, rcall(1), RETURN, PUSH, PUSH, POP, POP, RETURN],
            Use(3, 2),
            id="a call in a call with something pushed",
        ),
        pytest.param([0xE001, PUSH, RETURN], Use(1, 0), id="the deeper side of a branch"),
        pytest.param([0xB001, PUSH, RETURN], Use(1, 0), id="a skip that may not skip"),
        pytest.param([0x0E05, 0x5EE1, 0x0E05, 0x26E1, RETURN], Use(5, 0), id="room taken at once"),
        pytest.param([0xC001, 0xFFE5, 0xCFE4, 0xF001, RETURN], Use(1, 0), id="movff to the stack"),
        pytest.param([0xEC14, 0xF000, RETURN, NOP, PUSH, RETURN], Use(1, 1), id="a long call"),
        pytest.param([PUSH, POP, bra(-3)], Use(1, 0), id="a loop that keeps its balance"),
        pytest.param(
            [0x6EF9, bra(2), bra(2), RETURN, RETURN, PUSH, RETURN], Use(1, 0), id="a jump table"
        ),
    ],
)
def test_the_stack_use_of_small_programs_is_what_one_counts(words: list[int], use: Use) -> None:
    assert program(*words).use(0x20) == use


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        pytest.param([rcall(-1), RETURN], "recursion", id="recursion"),
        pytest.param([PUSH, bra(-2)], "keeps pushing", id="a loop that pushes"),
        pytest.param([NOP], "empty flash", id="no end"),
        pytest.param([NOP, 0x5EE1, RETURN], "unknown amount", id="unknown room"),
    ],
)
def test_a_stack_without_bound_is_refused(words: list[int], reason: str) -> None:
    with pytest.raises(UnboundedStackError, match=reason):
        program(*words).use(0x20)


def test_the_worst_case_adds_both_interrupts_to_the_main_program() -> None:
    flash = bytearray(b"\xff" * 0x200)
    for address, words in (
        (0x00, [bra(0x1F)]),
        (0x08, [PUSH, POP, RETFIE]),
        (0x18, [rcall(1), RETFIE, PUSH, PUSH, PUSH, POP, POP, POP, RETURN]),
        (0x40, [PUSH, rcall(2), POP, bra(-4), PUSH, RETURN]),
    ):
        for number, word in enumerate(words):
            flash[address + 2 * number : address + 2 * number + 2] = word.to_bytes(2, "little")
    used = worst_case(bytes(flash))
    assert used.levels == 1 + 1 + 0 + 2
    assert used.bytes == 2 + 3 + 1


# -- report_size ----------------------------------------------------------------------------------


def test_a_hex_file_is_read_into_the_program_memory_only(tmp_path: Path) -> None:
    file = tmp_path / "small.hex"
    file.write_text(
        ":020000040000FA\n:0400100001020304E2\n:020000040030CA\n:0100000024DB\n:00000001FF\n"
    )
    flash = read_hex(file)
    assert flash[0x10:0x14] == bytes([1, 2, 3, 4])
    assert flash[:0x10] == b"\xff" * 0x10
    assert len(flash) == 0x8000


@pytest.mark.parametrize(
    ("section", "source", "owner"),
    [
        ("udata_homing_0", "", "lathe"),
        ("code_flash", "firmware/store/flash.asm", "store"),
        ("code_startup", "firmware/startup.asm", "start and main loop"),
        ("code_program", "build/firmware/obj/compiled.asm", "tables and registers"),
        ("S_divulong___divulong", "objects/divulong.asm", "library"),
    ],
)
def test_every_section_belongs_to_a_room(section: str, source: str, owner: str) -> None:
    assert room(section, source) == owner


@pytest.fixture
def build(tmp_path: Path) -> Path:
    """A copy of what the linker has left behind."""
    for name in ("tornillo.hex", "tornillo.map", "shrink.txt", "byte_code.json"):
        shutil.copy(ROOT / "build" / "firmware" / name, tmp_path)
    return tmp_path


def test_the_report_adds_up_to_the_bytes_in_the_hex_file(build: Path) -> None:
    assert run("report_size.py", build).returncode == 0
    report = json.loads((build / "size.json").read_text())
    assert report["flash_bytes"] == sum(report["flash_by_room"].values())
    assert report["ram_static_bytes"] == sum(report["ram_by_room"].values())
    flash = read_hex(build / "tornillo.hex")
    assert report["flash_by_room"][LOADER] == BOOT_BLOCK_BYTES
    written = sum(byte != 0xFF for byte in flash[BOOT_BLOCK_BYTES:]) + BOOT_BLOCK_BYTES
    assert 0 <= report["flash_bytes"] - written < report["flash_bytes"] // 64, (
        "bytes 0xFF that are written cannot be told"
    )


def test_a_budget_that_is_exceeded_fails_the_build(build: Path) -> None:
    text = (build / "tornillo.map").read_text()
    grown = re.sub(r"(code_program +code +0x\w+ +program +)0x00", r"\g<1>0x01", text)
    assert grown != text
    (build / "tornillo.map").write_text(grown)
    done = run("report_size.py", build)
    assert done.returncode != 0
    assert "over budget: flash_bytes" in done.stderr
    assert not (build / "size.json").exists()


# -- generate_sfr ---------------------------------------------------------------------------------


def test_the_registers_are_those_of_the_data_sheet() -> None:
    registers = dict(read_registers(HEADER))
    known = {"PORTB": 0xF81, "LATD": 0xF8C, "CCPR2H": 0xFBC, "UCON": 0xF6D, "EECON1": 0xFA6}
    assert {name: registers[name] for name in known} == known
    assert all(0xF60 <= address <= 0xFFF for address in registers.values())


def test_both_files_declare_and_define_every_register_once(tmp_path: Path) -> None:
    assert run("generate_sfr.py", HEADER, tmp_path).returncode == 0
    declared = (tmp_path / "sfr.h").read_text()
    defined = (tmp_path / "sfr.c").read_text()
    assert "extern __sfr __at(0xF81) PORTB;" in declared
    assert defined.count("__at(0xF81) PORTB;") == 1
    assert declared.count("extern") == defined.count("__sfr")


def test_an_include_file_of_another_layout_is_refused(tmp_path: Path) -> None:
    strange = tmp_path / "strange.inc"
    strange.write_text("; Register Files\nPORTB EQU H'0F81'\n;-----\n")
    done = run("generate_sfr.py", strange, tmp_path)
    assert done.returncode != 0
    assert "only 1 registers found" in done.stderr
