# SPDX-License-Identifier: Apache-2.0
"""The whole-program pass over SDCC's assembly: each rule and each refusal."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).parents[2] / "firmware/toolchain/shrink_assembly.py"

HEAD = """
STATUS	equ	0xfd8
WREG	equ	0xfe8
PRODL	equ	0xff3
FSR0L	equ	0xfe9
FSR0H	equ	0xfea
INDF0	equ	0xfef
FSR1L	equ	0xfe1
FSR2L	equ	0xfd9
POSTINC1	equ	0xfe6
POSTDEC1	equ	0xfe5
PREINC1	equ	0xfe4
PLUSW2	equ	0xfdb
PCL	equ	0xff9
	global	_main
.registers	udata_ovr	0x0000
r0x00	res	1
r0x01	res	1
r0x02	res	1
udata_t_0	udata
_x	res	1
udata_t_1	udata
_y	res	1
"""


def function(name: str, body: str, saves: str = "") -> str:
    registers = saves.split()
    lines = [f"S_t_{name}\tcode", f"{name}:"]
    lines += [f"\tMOVFF\t{r}, POSTDEC1" for r in registers]
    lines += [
        line if line.endswith(":") else f"\t{line}" for line in map(str.strip, body.split(";"))
    ]
    lines += [f"\tMOVFF\tPREINC1, {r}" for r in reversed(registers)]
    return "\n".join([*lines, "\tRETURN", ""])


def run_tool(
    folder: Path, *functions: str, asm: str = "", head: str = HEAD, options: str = ""
) -> subprocess.CompletedProcess[str]:
    """Run the pass on one file made of the functions, with `asm` as hand-written assembly."""
    (folder / "t.asm").write_text(head + "".join(functions) + "\tend\n")
    (folder / "hand.asm").write_text(asm)
    return subprocess.run(
        [sys.executable, TOOL, *options.split(), "--asm", "hand.asm", "-o", "out.asm", "t.asm"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )


def shrunk(folder: Path, *functions: str, asm: str = "", options: str = "") -> dict[str, list[str]]:
    """Return what the pass makes: for each function its lines, `head` for all before them."""
    result = run_tool(folder, *functions, asm=asm, options=options)
    assert result.returncode == 0, result.stderr
    found: dict[str, list[str]] = {"head": []}
    name = "head"
    for line in (folder / "out.asm").read_text().splitlines()[:-1]:
        if re.match(r"_[a-z]\w*:", line):
            name = line[:-1]
            found[name] = []
        else:
            found[name].append(" ".join(line.split()))
    return found


def refusal(folder: Path, *functions: str, asm: str = "", head: str = HEAD) -> str:
    result = run_tool(folder, *functions, asm=asm, head=head)
    assert result.returncode == 1
    assert not (folder / "out.asm").exists()
    return result.stderr


LEAF = function("_leaf", "MOVFF _x, r0x00; INCF r0x00, F; MOVFF r0x00, _x", "r0x00")


def register_of(lines: list[str]) -> set[str]:
    return set(re.findall(r"\b[ri]0x\w\w\b", " ".join(lines)))


def test_a_value_needed_after_a_call_gets_a_register_the_callee_leaves_alone(
    tmp_path: Path,
) -> None:
    caller = function(
        "_main", "MOVFF _x, r0x00; CALL _leaf; MOVFF r0x00, _y; CALL _leaf; MOVFF r0x00, _x"
    )
    out = shrunk(tmp_path, caller, LEAF)
    assert not any("POSTDEC1" in line or "PREINC1" in line for line in out["_leaf"])
    assert len(register_of(out["_main"])) == 1
    assert not register_of(out["_main"]) & register_of(out["_leaf"])


def test_a_value_not_needed_after_a_call_shares_the_callees_register(tmp_path: Path) -> None:
    caller = function("_main", "MOVFF _x, r0x00; MOVFF r0x00, _y; CALL _leaf")
    out = shrunk(tmp_path, caller, LEAF)
    assert register_of(out["_main"]) == register_of(out["_leaf"]) == {"r0x00"}


def test_a_value_needed_on_the_next_round_of_a_loop_counts_as_needed(tmp_path: Path) -> None:
    caller = function(
        "_main", "MOVFF _x, r0x00; _00001_DS_:; CALL _leaf; DECFSZ r0x00, F; BRA _00001_DS_"
    )
    out = shrunk(tmp_path, caller, LEAF)
    assert not register_of(out["_main"]) & register_of(out["_leaf"])


ADD = (
    "S_t_add\tcode\n_add:\n\tMOVFF\tFSR2L, POSTDEC1\n\tMOVFF\tFSR1L, FSR2L\n"
    "\tMOVFF\tr0x00, POSTDEC1\n\tMOVLW\t0x02\n\tMOVFF\tPLUSW2, r0x00\n"
    "\tMOVLW\t0x03\n\tMOVFF\tPLUSW2, _y\n\tMOVF\tr0x00, W\n\tADDWF\t_y, W, B\n"
    "\tMOVFF\tPREINC1, r0x00\n\tMOVFF\tPREINC1, FSR2L\n\tRETURN\n"
).replace("\tADDWF", "\tBANKSEL\t_y\n\tADDWF")
CALL_ADD = (
    "MOVLW 0x11; MOVWF POSTDEC1; MOVLW 0x22; MOVWF POSTDEC1; CALL _add; "
    "BANKSEL _x; MOVWF _x, B; MOVF POSTINC1, F; MOVF POSTINC1, F; MOVLW 0x00"
)


def test_arguments_go_to_registers_instead_of_the_stack(tmp_path: Path) -> None:
    main = function("_main", CALL_ADD + "; " + CALL_ADD)
    out = shrunk(tmp_path, main, ADD, options="--levels 0")
    stack = "POSTDEC1|POSTINC1|PREINC1|FSR2L|PLUSW2"
    assert not re.search(stack, " ".join(out["_main"] + out["_add"]))
    first, second = re.findall(r"MOVWF (r0x\w+)", " ".join(out["_main"]))[:2]
    assert f"MOVF {second}, W" in out["_add"]
    assert f"MOVFF {first}, _y" in out["_add"]


def test_arguments_stay_on_the_stack_when_one_call_has_another_form(tmp_path: Path) -> None:
    odd = CALL_ADD.replace("CALL _add", "_00009_DS_:; CALL _add")
    out = shrunk(tmp_path, function("_main", CALL_ADD + "; " + odd), ADD)
    assert out["_main"].count("MOVWF POSTDEC1") == 4
    assert "MOVFF PLUSW2, r0x00" in out["_add"]


def test_arguments_of_hand_written_functions_stay_on_the_stack(tmp_path: Path) -> None:
    out = shrunk(tmp_path, function("_main", CALL_ADD), asm=" global _add\n_add:\n")
    assert out["_main"].count("MOVWF POSTDEC1") == 2


WORD = function("_word", "MOVFF _x, r0x00; MOVFF r0x00, PRODL; CLRF WREG", "r0x00")
CALL_WORD = "CALL _word; BANKSEL _x; MOVWF _x, B; MOVFF PRODL, _y"


def test_the_high_byte_of_a_result_comes_in_a_register(tmp_path: Path) -> None:
    out = shrunk(tmp_path, function("_main", CALL_WORD), WORD)
    assert out["_word"][:2] == ["MOVFF _x, r0x00", "RETLW 0x00"]
    assert "MOVFF r0x00, _y" in out["_main"]


def test_a_result_passed_on_as_it_came_stays_where_it_was(tmp_path: Path) -> None:
    passes_on = function("_pass", "CALL _word; CLRF _LATB")
    calls = CALL_WORD.replace("_word", "_pass")
    out = shrunk(tmp_path, function("_main", calls), passes_on, WORD)
    assert "MOVFF r0x00, PRODL" in out["_pass"]
    assert "MOVFF PRODL, _y" in out["_main"]


def test_a_result_with_two_sources_stays_where_it_was(tmp_path: Path) -> None:
    either = (
        "BTFSC _PORTB, 0; BRA _00001_DS_; CALL _word; BRA _00002_DS_; _00001_DS_:; "
        "CALL _hand; _00002_DS_:; MOVFF PRODL, _y"
    )
    out = shrunk(tmp_path, function("_main", either), WORD)
    assert "MOVFF PRODL, _y" in out["_main"]
    assert "MOVFF r0x00, PRODL" in out["_word"]


INTERRUPT = (
    "S_i\tcode\n_low_interrupt:\n\tMOVFF\tSTATUS, POSTDEC1\n\tMOVFF\tr0x00, POSTDEC1\n"
    "\tMOVFF\t_x, r0x00\n\tCALL\t_leaf\n\tMOVFF\tr0x00, _y\n"
    "\tMOVFF\tPREINC1, r0x00\n\tMOVFF\tPREINC1, STATUS\n\tRETFIE\n"
)


def test_the_interrupt_gets_registers_of_its_own(tmp_path: Path) -> None:
    out = shrunk(tmp_path, function("_main", "MOVFF _x, r0x00; MOVFF r0x00, _y"), INTERRUPT, LEAF)
    assert register_of(out["_main"]) == {"r0x00"}
    assert register_of(out["_low_interrupt"] + out["_leaf"]) == {"i0x00", "i0x01"}
    assert "registers_interrupt udata_acs" in out["head"]


def test_a_function_of_interrupt_and_main_loop_keeps_its_saves(tmp_path: Path) -> None:
    out = shrunk(tmp_path, function("_main", "CALL _leaf"), INTERRUPT, LEAF)
    assert out["_leaf"][0] == "MOVFF r0x00, POSTDEC1"
    assert out["_leaf"][-2] == "MOVFF PREINC1, r0x00"


def test_with_too_few_registers_a_function_keeps_its_saves(tmp_path: Path) -> None:
    caller = function("_main", "MOVFF _x, r0x00; CALL _leaf; MOVFF r0x00, _y")
    out = shrunk(tmp_path, caller, LEAF, options="--registers 1")
    assert register_of(out["_main"]) == {"r0x00"}
    assert out["_leaf"][0] == "MOVFF r0x00, POSTDEC1"


def test_an_instruction_whose_result_nobody_needs_goes(tmp_path: Path) -> None:
    out = shrunk(
        tmp_path,
        function("_main", "MOVLW 0x05; MOVWF r0x00; MOVLW 0x06; MOVWF POSTDEC1; MOVF POSTINC1, F"),
    )
    assert out["_main"][:2] == ["MOVLW 0x06", "MOVWF POSTDEC1"]


def test_what_a_skip_may_skip_stays(tmp_path: Path) -> None:
    body = (
        "MOVFF _x, r0x01; BTFSC r0x01, 2; MOVLW 0x05; MOVLW 0x06; MOVWF POSTDEC1; MOVF POSTINC1, F"
    )
    assert "MOVLW 0x05" in shrunk(tmp_path, function("_main", body))["_main"]


def test_a_load_of_what_wreg_holds_goes_unless_its_flags_are_needed(tmp_path: Path) -> None:
    keeps = (
        "MOVFF _x, r0x00; INCF r0x00, W; MOVWF r0x01; MOVF r0x01, W; BNZ _00001_DS_; "
        "MOVFF r0x01, _y; _00001_DS_:; MOVFF r0x01, _x"
    )
    assert "MOVF r0x00, W" in shrunk(tmp_path, function("_main", keeps))["_main"]
    drops = keeps.replace("BNZ", "BNC").replace("INCF r0x00, W", "ADDWF r0x00, W")
    assert "MOVF r0x00, W" not in shrunk(tmp_path, function("_main", drops))["_main"]


def test_a_bank_is_selected_once_for_variables_that_share_it(tmp_path: Path) -> None:
    body = (
        "BANKSEL _x; CLRF _x, B; BANKSEL _y; CLRF _y, B; BANKSEL _z; CLRF _z, B; BANKSEL _x; "
        "INCF _x, F, B"
    )
    out = shrunk(tmp_path, function("_main", body), asm="hand udata 0x400\n_z res 1\n")
    assert [line for line in out["_main"] if "BANKSEL" in line] == [
        "BANKSEL _x",
        "BANKSEL _z",
        "BANKSEL _x",
    ]


def test_a_bank_known_on_one_path_only_is_selected_again(tmp_path: Path) -> None:
    body = (
        "BANKSEL _x; CLRF _x, B; BZ _00001_DS_; BANKSEL _z; CLRF _z, B; _00001_DS_:; "
        "BANKSEL _y; CLRF _y, B"
    )
    out = shrunk(tmp_path, function("_main", body), asm="hand udata 0x400\n_z res 1\n")
    assert "BANKSEL _y" in out["_main"]


def test_a_call_of_unknown_code_leaves_no_bank_known(tmp_path: Path) -> None:
    body = "BANKSEL _x; CLRF _x, B; CALL _hand; BANKSEL _y; CLRF _y, B"
    assert "BANKSEL _y" in shrunk(tmp_path, function("_main", body))["_main"]


def test_a_bank_selection_that_sdcc_forgot_comes_back(tmp_path: Path) -> None:
    body = "BANKSEL _x; CLRF _x, B; MOVFF _z, r0x00; INCF _z, F, B; MOVFF r0x00, _y; INCF _x, F, B"
    out = shrunk(tmp_path, function("_main", body), asm="hand udata 0x400\n_z res 1\n")
    kept = "; ".join(line for line in out["_main"] if "MOVFF" not in line)
    assert "BANKSEL _z; INCF _z, F, B; BANKSEL _x; INCF _x, F, B" in kept


def test_variables_of_the_access_bank_need_no_bank(tmp_path: Path) -> None:
    out = shrunk(
        tmp_path, function("_main", "BANKSEL _z; CLRF _z, B"), asm="hand udata_acs\n_z res 1\n"
    )
    assert out["_main"][0] == "CLRF _z, A"


def test_near_calls_are_short_and_far_ones_long(tmp_path: Path) -> None:
    long, longer = ("; ".join(f"CLRF _{name}{n}" for n in range(1100)) for name in "ab")
    calls = "CALL _leaf; CALL _far; CALL _farther; CALL _hand; CLRF _LATB"
    out = shrunk(
        tmp_path,
        function("_main", calls),
        LEAF,
        function("_far", long),
        function("_farther", longer),
    )
    assert {"RCALL _leaf", "CALL _hand"} <= set(out["_main"])
    assert sum(line.startswith("CALL _far") for line in out["_main"]) == 1


def test_a_call_before_a_return_becomes_a_jump(tmp_path: Path) -> None:
    out = shrunk(tmp_path, function("_main", "CLRF _LATB; CALL _leaf"), LEAF)
    assert out["_main"] == ["CLRF _LATB", "BRA _leaf"]


def test_the_entries_of_a_jump_table_keep_their_size(tmp_path: Path) -> None:
    body = (
        "MOVLW 0x04; MOVWF PCL; _00001_DS_:; GOTO _00002_DS_; GOTO _00003_DS_; _00002_DS_:; "
        "CLRF _LATB; _00003_DS_:; CLRF _LATC"
    )
    out = shrunk(tmp_path, function("_main", body))
    assert sum(line.startswith("GOTO") for line in out["_main"]) == 2


def test_a_stored_value_that_is_only_tested_is_not_stored(tmp_path: Path) -> None:
    body = "CALL _hand; MOVWF r0x00; MOVF r0x00, W; BZ _00001_DS_; CLRF _LATB; _00001_DS_:"
    out = shrunk(tmp_path, function("_main", body + "; CLRF _LATC"))
    assert out["_main"][:2] == ["CALL _hand", "IORLW 0x00"]


def test_an_address_is_added_straight_into_the_pointer(tmp_path: Path) -> None:
    body = (
        "MOVFF _x, r0x00; CLRF r0x01; MOVLW LOW(_y); ADDWF r0x00, F; MOVLW HIGH(_y); "
        "ADDWFC r0x01, F; MOVFF r0x00, FSR0L; MOVFF r0x01, FSR0H; CLRF INDF0"
    )
    out = "; ".join(shrunk(tmp_path, function("_main", body))["_main"])
    assert "ADDWF r0x00, W; MOVWF FSR0L; MOVLW HIGH(_y); ADDWFC r0x01, W; MOVWF FSR0H" in out
    needed = function("_main", body + "; MOVFF r0x01, _x")
    assert "MOVFF r0x01, FSR0H" in shrunk(tmp_path, needed)["_main"]


def test_a_value_for_the_common_end_is_returned_at_once(tmp_path: Path) -> None:
    choose = (
        "BTFSS _PORTB, 0; BRA _00001_DS_; MOVLW 0x05; MOVWF r0x00; BRA _00002_DS_; "
        "_00001_DS_:; CALL _hand; MOVWF r0x00; _00002_DS_:; MOVF r0x00, W"
    )
    calls = "CALL _choose; BANKSEL _x; MOVWF _x, B"
    out = shrunk(tmp_path, function("_main", calls), function("_choose", choose, "r0x00"))
    assert "RETLW 0x05" in out["_choose"]


def test_a_skip_on_a_flag_over_a_jump_becomes_a_branch(tmp_path: Path) -> None:
    body = "INCF _LATB, F; BTFSC STATUS, 2; BRA _00001_DS_; CLRF _LATB; _00001_DS_:; CLRF _LATC"
    assert "BZ _00001_DS_0" in shrunk(tmp_path, function("_main", body))["_main"]


def test_jumps_lead_to_where_they_end_and_what_is_never_reached_goes(tmp_path: Path) -> None:
    body = (
        "BTFSS _PORTB, 0; BRA _00001_DS_; CLRF _LATB; BRA _00003_DS_; CLRF _LATD; "
        "_00001_DS_:; BRA _00002_DS_; _00003_DS_:; CLRF _LATA; _00002_DS_:; CLRF _LATC"
    )
    out = shrunk(tmp_path, function("_main", body))
    assert "BRA _00002_DS_0" in out["_main"]
    assert not {"BRA _00001_DS_0", "CLRF _LATD"} & set(out["_main"])


def test_private_names_of_two_files_stay_apart(tmp_path: Path) -> None:
    for name in ("one", "two"):
        body = function(
            "_main" if name == "one" else "_other", "CALL _same; CALL _same"
        ) + function("_same", "CLRF _LATB" if name == "one" else "CLRF _LATC")
        public = HEAD if name == "one" else HEAD.replace("_main", "_other")
        (tmp_path / f"{name}.asm").write_text(re.sub(r"udata_t[^$]*", "", public) + body)
    subprocess.run(
        [sys.executable, TOOL, "-o", "out.asm", "one.asm", "two.asm"], cwd=tmp_path, check=True
    )
    text = (tmp_path / "out.asm").read_text()
    for name, latch in (("one", "LATB"), ("two", "LATC")):
        assert f"_same__{name}:\n\tCLRF\t_{latch}" in text


def test_the_report_names_bytes_before_and_after(tmp_path: Path) -> None:
    main = function("_main", "CLRF _LATB; CALL _leaf")
    result = run_tool(tmp_path, main, LEAF, options="--report")
    assert re.search(r"^t +28 +16$", result.stdout, re.MULTILINE)


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("CALL _main", "recursion"),
        ("FROB r0x00", "unknown instruction"),
        ("MOVLW LOW(r0x00)", "address of a register"),
        ("MOVWF POSTDEC1", "stack is off by 1"),
        ("BZ _00001_DS_; MOVWF POSTDEC1; _00001_DS_:; CLRF _x", "stack differs"),
        ("BTFSC _PORTB, 0; CLRF _x, B", "wrong bank"),
        ("MOVWF PCL; CLRF _x", "computed jump"),
        ("GOTO _elsewhere", "jump out of the function"),
        ("CLRF _POSTDEC1", "core register"),
        ("CALL __gptrput1", "generic pointer"),
    ],
)
def test_what_is_not_understood_is_refused(tmp_path: Path, body: str, message: str) -> None:
    assert message in refusal(tmp_path, function("_main", body))


def test_arithmetic_of_the_library_may_not_be_used_on_both_sides(tmp_path: Path) -> None:
    interrupt = INTERRUPT.replace("_leaf", "__mulint")
    message = refusal(tmp_path, function("_main", "CALL __mulint"), interrupt)
    assert "called by interrupt and main loop: __mulint" in message


def test_initialised_data_are_refused(tmp_path: Path) -> None:
    head = HEAD + "idata_t_0\tidata\n_z\tDB\t0x01\n"
    assert "initialised data" in refusal(tmp_path, LEAF.replace("_leaf", "_main"), head=head)


def test_hand_written_code_may_not_use_registers_or_call_c(tmp_path: Path) -> None:
    main = function("_main", "CALL _leaf")
    assert "uses r0x01" in refusal(tmp_path, main, LEAF, asm=" clrf r0x01\n")
    assert "calls _leaf" in refusal(tmp_path, main, LEAF, asm=" goto _main\n call _leaf\n")
