# SPDX-License-Identifier: Apache-2.0
"""The whole-program pass: one copy of equal pieces, calls made once, shorter compares."""

from pathlib import Path

import pytest

from firmware.test_shrink_assembly import INTERRUPT, function, shrunk

PIECE = "MOVFF _x, _LATB; INCF _LATB, F; RLNCF _LATB, F; COMF _LATC, F; SWAPF _LATC, F"
WAYS = "BTFSC _PORTB, 0; BRA _00001_DS_; {0}; BRA _00002_DS_; _00001_DS_:; {1}; _00002_DS_:; {2}"


def jumps_and_calls(lines: list[str]) -> list[str]:
    return [line for line in lines if line.split()[0] in ("RCALL", "CALL", "BRA", "GOTO")]


def text(out: dict[str, list[str]]) -> str:
    return "; ".join(line for name, lines in out.items() if name != "head" for line in lines)


def test_equal_ends_of_two_ways_become_one(tmp_path: Path) -> None:
    body = WAYS.format(f"CLRF _LATA; {PIECE}", f"SETF _LATA; {PIECE}", "CLRF _LATD")
    out = shrunk(tmp_path, function("_main", body))
    assert text(out).count("RLNCF") == 1
    assert not any("CALL" in line for line in out["_main"])


def test_equal_ends_of_two_functions_become_one(tmp_path: Path) -> None:
    one = function("_one", f"CLRF _LATA; {PIECE}")
    two = function("_two", f"SETF _LATA; {PIECE}")
    calls = "CALL _one; CALL _two; CALL _one; CALL _two; CLRF _LATD"
    out = shrunk(tmp_path, function("_main", calls), one, two, options="--levels 0")
    assert text(out).count("RLNCF") == 1


THRICE = "; CLRF _LATA; ".join([PIECE] * 3) + "; CLRF _LATD"


def test_equal_pieces_become_a_function(tmp_path: Path) -> None:
    out = shrunk(tmp_path, function("_main", THRICE))
    assert text(out).count("RLNCF") == 1
    assert sum(line.startswith("RCALL _fold") for line in jumps_and_calls(out["_main"])) == 3


def test_equal_pieces_stay_where_no_level_of_the_return_stack_is_left(tmp_path: Path) -> None:
    main = function("_main", THRICE)
    assert text(shrunk(tmp_path, main, options="--levels 3")).count("RLNCF") == 1
    assert text(shrunk(tmp_path, main, options="--levels 2")).count("RLNCF") == 3


def test_levels_of_hand_written_functions_count(tmp_path: Path) -> None:
    hand = " global _hand\n_hand:\n rcall deep\n return\ndeep:\n return\n end\n"
    pieces = "; CLRF _LATA; ".join([f"CALL _hand; {PIECE}"] * 3) + "; CLRF _LATD"
    main = function("_main", pieces)
    enough = shrunk(tmp_path, main, asm=hand, options="--levels 5")
    short = shrunk(tmp_path, main, asm=hand, options="--levels 4")
    assert "CALL _hand; MOVFF _x, _LATB" in text(enough)
    assert "CALL _hand; MOVFF _x, _LATB" not in text(short)


def test_the_code_of_the_interrupt_stays_as_it_is(tmp_path: Path) -> None:
    interrupt = INTERRUPT.replace("\tCALL\t_leaf\n", f"\t{THRICE}\n".replace("; ", "\n\t"))
    out = shrunk(tmp_path, function("_main", "CLRF _LATA"), interrupt)
    assert text(out).count("RLNCF") == 3


@pytest.mark.parametrize(
    "line", ["MOVWF _EECON2", "BTFSC _PORTB, 0; MOVFF _x, _y", "MOVWF POSTDEC1; MOVF POSTINC1, F"]
)
def test_what_must_not_be_torn_apart_is_not_called(tmp_path: Path, line: str) -> None:
    pieces = "; CLRF _LATA; ".join([f"{line}; INCF _LATB, F"] * 3) + "; CLRF _LATD"
    out = shrunk(tmp_path, function("_main", pieces))
    wanted = line.split("; ", maxsplit=1)[0]
    following = [out["_main"][i + 1] for i, x in enumerate(out["_main"]) if x == wanted]
    assert all(not after.startswith("RCALL") for after in following)


def test_a_function_called_once_stands_in_the_place_of_the_call(tmp_path: Path) -> None:
    once = function("_once", "BTFSC _PORTB, 0; BRA _00001_DS_; CLRF _LATB; _00001_DS_:; CLRF _LATC")
    twice = function("_twice", "CALL _once; CLRF _LATD")
    out = shrunk(tmp_path, function("_main", "CALL _twice; CALL _twice"), twice, once)
    assert "_once" not in out
    assert out["_twice"][-3:] == ["CLRF _LATC", "CLRF _LATD", "RETURN"]


def test_a_function_called_once_stays_where_the_call_may_be_skipped(tmp_path: Path) -> None:
    once = function("_once", "CLRF _LATB; CLRF _LATC")
    twice = function("_twice", "BTFSC _PORTB, 0; CALL _once; CLRF _LATD")
    out = shrunk(tmp_path, function("_main", "CALL _twice; CALL _twice"), twice, once)
    assert "_once" in out


def test_words_are_compared_with_borrow(tmp_path: Path) -> None:
    body = (
        "CALL _hand; MOVWF r0x00; CALL _hand; MOVWF r0x01; MOVLW 0x03; SUBWF r0x01, W; "
        "BNZ _00001_DS_; MOVLW 0xe8; SUBWF r0x00, W; _00001_DS_:; B{} _00002_DS_; CLRF _LATB; "
        "_00002_DS_:; CLRF _LATC"
    )
    out = "; ".join(shrunk(tmp_path, function("_main", body.format("C")))["_main"])
    low, high = "MOVLW 0xe8; SUBWF r0x0", "; MOVLW 0x03; SUBWFB r0x0"
    assert low in out
    assert high in out
    assert "SUBWFB" not in text(shrunk(tmp_path, function("_main", body.format("Z"))))


def test_a_register_compared_with_many_constants_is_loaded_once(tmp_path: Path) -> None:
    body = (
        "CALL _hand; MOVWF r0x00; CALL _hand; MOVF r0x00, W; XORLW 0x05; BZ _00001_DS_; "
        "MOVF r0x00, W; XORLW 0x06; BZ _00001_DS_; MOVF r0x00, W; XORLW 0x0a; BZ _00001_DS_; "
        "CLRF _LATB; _00001_DS_:; CLRF _LATC"
    )
    out = [line for line in shrunk(tmp_path, function("_main", body))["_main"] if "MOVF" in line]
    assert out == ["MOVF r0x00, W"]
    assert "XORLW 0x05; BZ _00001_DS_0; XORLW 0x03; BZ _00001_DS_0; XORLW 0x0c" in text(
        shrunk(tmp_path, function("_main", body))
    )


def test_a_branch_over_a_jump_becomes_a_branch(tmp_path: Path) -> None:
    body = (
        "INCF _LATB, F; BNZ _00001_DS_; BRA _00002_DS_; _00001_DS_:; CLRF _LATB; "
        "_00002_DS_:; CLRF _LATC"
    )
    assert "BZ _00002_DS_0" in shrunk(tmp_path, function("_main", body))["_main"]


def test_a_value_that_falls_into_the_common_end_is_returned_at_once(tmp_path: Path) -> None:
    choose = (
        "BTFSS _PORTB, 0; BRA _00001_DS_; MOVLW 0x05; MOVWF r0x00; BRA _00002_DS_; "
        "_00001_DS_:; MOVLW 0x07; MOVWF r0x00; _00002_DS_:; MOVF r0x00, W"
    )
    calls = "CALL _choose; BANKSEL _x; MOVWF _x, B; CALL _choose; BANKSEL _x; MOVWF _x, B"
    out = shrunk(tmp_path, function("_main", calls), function("_choose", choose, "r0x00"))
    assert {"RETLW 0x05", "RETLW 0x07"} <= set(out["_choose"])
    assert not any("r0x00" in line for line in out["_choose"])
