# SPDX-License-Identifier: Apache-2.0
"""Numbers and sizes of the byte code's operations (firmware/bytecode/interpreter.asm)."""

from __future__ import annotations

from bytecode_model import Code, Label, Place
from bytecode_types import BytecodeError

# In the order of the interpreter's table.
PLAIN = [
    *("ret", "ret0", "ret1", "ld0", "ld1", "inc", "dec", "push", "push8"),
    *("subs", "cmps", "neg", "low", "ldi8", "clrwdt", "drop1", "drop2", "drop4"),
    *("shl", "shr", "ldk", "ldkn", "addk", "addkn", "cmpk", "retk", "andk", "ork"),
    *("ldkw", "addkw", "cmpkw", "case"),
    *("jmp", "jz", "jnz", "jeq", "jne", "jlt", "jge", "jgt", "jle"),
    *("jltu", "jgeu", "jgtu", "jleu", "ljmp", "native8", "native16"),
    *("ldt8", "add8", "cmp8", "ldx8", "ldx16", "stx8", "rare"),
]
FIRST_MEMORY = len(PLAIN)
MEMORY_ORDER = ["ld8", "ld16", "st8", "st16", "add16", "sub16", "cmp16"]
# These have `rare` before their own number.
RARE = [
    *("adds", "ands", "ors", "xors", "com", "ldi16", "sti8", "sti16", "drop3"),
    *("sar", "xork", "andkw", "ldt16", "stx16", "sub8", "and8", "or8", "xor8", "and16", "or16"),
]
NUMBER = {name: number for number, name in enumerate(PLAIN)}
RARE_NUMBER = {name: number for number, name in enumerate(RARE)}
MEMORY = {name: FIRST_MEMORY + 8 * number for number, name in enumerate(MEMORY_ORDER)}
FIRST_CALL = FIRST_MEMORY + 8 * len(MEMORY)
PAIRS_MAX = 128

INVERSE = {
    "jz": "jnz",
    "jeq": "jne",
    "jlt": "jge",
    "jgt": "jle",
    "jltu": "jgeu",
    "jgtu": "jleu",
}
INVERSE |= {other: one for one, other in INVERSE.items()}
JUMPS = {"jmp", *INVERSE}
ENDS = {"ret", "ret0", "ret1", "retk", "jmp", "ljmp"}
NO_OPERAND = {*PLAIN[: PLAIN.index("shl")], *RARE[: RARE.index("sar")]}
SMALL = {"shl", "shr", "sar", "ldk", "ldkn", "addk", "addkn", "cmpk", "retk", "andk", "ork", "xork"}
WIDE = {"ldkw", "addkw", "cmpkw", "andkw"}
THREE_BYTES = {
    *("ldt8", "ldt16", "add8", "sub8", "and8", "or8", "xor8", "cmp8", "and16", "or16"),
    *("ldx8", "ldx16", "stx8", "stx16"),
}


def select(code: Code) -> list[Code]:
    """Return the operations of the chip for one of the compiler: the shortest constants."""
    op, operand = code.op, code.operand
    if op == "drop":
        assert isinstance(operand, int)
        return [Code("drop4")] * (operand // 4) + ([Code(f"drop{operand % 4}")] * bool(operand % 4))
    if op == "native":
        return [Code("native16", operand)]
    if op in ("ldk", "addk", "cmpk", "retk", "andk", "ork", "xork"):
        return _constant(op, operand)
    return [code]


SHORT = {("ldk", 0): "ld0", ("ldk", 1): "ld1", ("retk", 0): "ret0", ("retk", 1): "ret1"}
SHORT |= {("addk", 1): "inc", ("addk", 0xFFFF): "dec", ("andk", 0xFF): "low"}


def _constant(op: str, operand: Place | int | str | None) -> list[Code]:
    if isinstance(operand, Place):
        if op != "ldk":
            raise BytecodeError(f"{op} with an address")
        return [Code("ldkw", operand)]
    assert isinstance(operand, int)
    if op == "addk" and operand == 0:
        return []
    if (op, operand) in SHORT:
        found = Code(SHORT[op, operand])
    elif operand < 0x100:
        found = Code(op, operand)
    elif operand >= 0xFF00 and op in ("ldk", "addk"):
        found = Code(f"{op}n", operand & 0xFF)
    elif op == "retk":
        return [*_constant("ldk", operand), Code("ret")]
    elif op in ("ork", "xork"):
        raise BytecodeError(f"{op} with more than 8 bits")
    else:
        found = Code(f"{op}w", operand)
    return [found]


def size(code: Code | Label) -> int:
    """Return the bytes of an operation; jumps in their short form."""
    if isinstance(code, Label) or code.op == "into":
        return 0
    found = 2
    if code.op in NO_OPERAND:
        found = 1
    elif code.op in THREE_BYTES or code.op in WIDE or code.op in ("case", "ljmp"):
        found = 3
    return found + (code.op in RARE_NUMBER)


def can_pair(code: Code) -> bool:
    """Tell whether an operation may come from the table of pairs."""
    if code.op in RARE_NUMBER:
        return False
    return code.op in SMALL or code.op in MEMORY or code.op in ("call", "native8", "native16")
