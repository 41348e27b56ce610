# SPDX-License-Identifier: Apache-2.0
"""The report of executed firmware, on a listing small enough to be counted by hand."""

from __future__ import annotations

from pathlib import Path

from executed.record import Record
from executed.report import functions, instructions, summary, text

LISTING = """\
                                           _home:
000020   c01f     movff   0x01f, 0x006     \tMOVFF\t_position_z, r0x06
000022   f006
000024   e103     bnz     0x00002c         \tBNZ\t_00290_DS_11
                                           _00290_DS_11:
000026   0012     return  0x0              \tRETURN
                                           _park:
000028   0012     return  0x0              \tRETURN
00002a   0001     halt                     \tDB\t0x01, 0x00, 0x00, 0x02
00002c   0200     mulwf   0x00, 0x0
                                           fast:
00002e   0010     retfie  0x0              \tretfie
"""
MAP = """\
                   _home   0x000020    program     extern build/firmware/obj/compiled.asm
           _00290_DS_11   0x000026    program     static build/firmware/obj/compiled.asm
                   _park   0x000028    program     static build/firmware/obj/compiled.asm
                   _fast   0x00002e    program     extern firmware/motion/fast.asm
                   inner   0x00002e    program     static firmware/motion/fast.asm
"""


def build_folder(folder: Path) -> Path:
    """Write what a build leaves behind."""
    (folder / "obj" / "lathe").mkdir(parents=True)
    (folder / "obj" / "lathe" / "homing.asm").write_text("_home:\n_park:\n_00290_DS_:\n")
    (folder / "tornillo.lst").write_text(LISTING)
    (folder / "tornillo.map").write_text(MAP)
    return folder


def test_second_words_and_tables_are_no_instructions() -> None:
    assert instructions(LISTING) == [0x20, 0x24, 0x26, 0x28, 0x2E]


def test_every_function_is_counted_and_what_it_missed_is_named(tmp_path: Path) -> None:
    judged = functions(build_folder(tmp_path), frozenset({0x20, 0x24, 0x2E}))
    counted = {f.name: (f.room, f.executed, f.total, f.missed) for f in judged}
    assert counted == {
        "home": ("lathe/homing.c", 2, 3, [0x26]),
        "park": ("lathe/homing.c", 0, 1, [0x28]),
        "fast": ("motion/fast.asm", 1, 1, []),
    }


def test_the_report_ends_with_the_sum(tmp_path: Path) -> None:
    record = Record(frozenset({0x20, 0x24, 0x2E}), 7)
    judged = functions(build_folder(tmp_path), record.executed)
    assert summary(judged, record) == (
        "firmware: 3 of 5 instructions executed (60.0 %), 2 of 3 functions, "
        "hardware stack 7 levels deep"
    )
    lines = text(judged, record).splitlines()
    assert lines[-1] == summary(judged, record)
    assert "lathe/homing.c: home: 1 of 3: 00026" in lines
