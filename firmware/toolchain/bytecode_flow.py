# SPDX-License-Identifier: Apache-2.0
"""What is known of A at each operation of a function, and what of it is wanted later.

Known are the loads that would not change A: of variables that hold the same
value, of a constant. Such loads go, and so do stores to local variables that
nobody reads and operations whose result in A nobody wants.
"""

from __future__ import annotations

from collections.abc import Collection

from bytecode_model import Code, Label, Place, Whole
from bytecode_operations import ENDS, INVERSE, JUMPS, select

Line = Code | Label
Lines = list[Line]
NARROW = Code("narrow")  # among the loads: the high byte of A is 0
Facts = frozenset[Code]

KEEPING = {
    *("cmpk", "cmpkw", "cmps", "cmp8", "cmp16", "push", "push8", "clrwdt", "jmp", "case"),
    *("drop1", "drop2", "drop3", "drop4", *INVERSE),
}
MAKE_NARROW = {"ld8", "native8", "low", "ldi8", "ldx8", "ldt8", "andk", "and8"}
LOADS = {"ld8", "ld16", "ld0", "ld1", "ldk", "ldkn", "ldkw"}
#: Change nothing but A.
ONLY_A = {
    *LOADS,
    *("inc", "dec", "neg", "com", "low", "shl", "shr", "sar", "addk", "addkn", "addkw"),
    *("andk", "andkw", "ork", "xork", "add8", "add16", "sub8", "sub16", "and8", "and16"),
    *("or8", "or16", "xor8", "ldi8", "ldi16", "ldx8", "ldx16", "ldt8", "ldt16"),
}
WITHOUT_A = {
    *LOADS,
    *("native8", "native16", "clrwdt", "drop1", "drop2", "drop3", "drop4", "jmp"),
    *("ret0", "ret1", "retk"),
}


def constant(value: int) -> Code:
    """Return the shortest load of a constant."""
    return select(Code("ldk", value))[0]


def drop_needless(lines: Lines, whole: Whole, own: Collection[str], result: bool) -> Lines:
    """Drop needless loads, stores and arithmetic.

    `own`: symbols of the local variables, `result`: whether the function returns
    something.
    """
    lines = _drop_known(lines, whole)
    return _drop_unwanted(lines, whole, own, result)


# --- forwards: what A holds ----------------------------------------------------


def _drop_known(lines: Lines, whole: Whole) -> Lines:
    """Drop loads of what is in A already, stores of what is there, `low` of a number of 8 bits."""
    kept: Lines = []
    for line, facts in zip(lines, _Forwards(lines, whole).arriving(), strict=True):
        if isinstance(line, Code) and facts is not None:
            if line.op == "retk" and Code("ldk", line.operand) in facts:
                kept.append(Code("ret"))
                continue
            stored = line.op in ("st8", "st16")
            if (
                (line.op in LOADS and line in facts)
                or (line.op == "low" and NARROW in facts)
                or (stored and Code(f"ld{line.op[2:]}", line.operand) in facts)
            ):
                continue
        kept.append(line)
    return kept


class _Forwards:
    """Follows all ways through a function until no way tells anything new."""

    def __init__(self, lines: Lines, whole: Whole) -> None:
        self.lines = lines
        self.whole = whole
        self.at_label: dict[str, Facts] = {}
        self.changed = True

    def arriving(self) -> list[Facts | None]:
        """Return what is known before each line; None where nothing leads."""
        arrive: list[Facts | None] = []
        while self.changed:
            self.changed = False
            arrive = []
            now: Facts | None = frozenset()
            compared: int | None = None  # what A has been compared with
            for line in self.lines:
                if isinstance(line, Label):
                    now = (
                        self.at_label.get(line.name) if now is None else self._meet(line.name, now)
                    )
                    compared = None
                arrive.append(now)
                if isinstance(line, Code) and now is not None:
                    now, compared = self._pass(line, now, compared)
        return arrive

    def _meet(self, label: str, facts: Facts) -> Facts:
        """Return what is known at a label, to which one more way leads."""
        known = self.at_label.get(label)
        if known is None or not known <= facts:
            known = facts if known is None else known & facts
            self.at_label[label], self.changed = known, True
        return known

    def _pass(
        self, line: Code, now: Facts, compared: int | None
    ) -> tuple[Facts | None, int | None]:
        """Return what is known behind an operation."""
        if line.op in JUMPS or line.op == "case":
            self._meet(str(line.operand), now | _learnt(line, compared, True))
            return (
                None if line.op == "jmp" else now | _learnt(line, compared, False),
                compared,
            )
        number = line.operand if line.op in ("cmpk", "cmpkw") else None
        return (
            None if line.op in ENDS else _after(line, now, self.whole),
            number if isinstance(number, int) else None,
        )


def _learnt(line: Code, compared: int | None, taken: bool) -> Facts:
    """Return what a jump tells of A, when it is taken or when not."""
    value: int | None = None
    if line.op == ("jz" if taken else "jnz"):
        value = 0
    elif line.op == ("jeq" if taken else "jne"):
        value = compared
    elif line.op == "case" and taken:
        value = line.extra
    return frozenset() if value is None else _constant_facts(constant(value))


def _constant_facts(load: Code) -> Facts:
    wide = load.op in ("ldkn", "ldkw")
    return frozenset([load] if wide else [load, NARROW])


def _after(line: Code, facts: Facts, whole: Whole) -> Facts:
    """Return what is known behind an operation."""
    op, operand = line.op, line.operand
    if op in KEEPING:
        return facts
    if op in ("st8", "st16"):
        return _stored(line, facts, whole.volatile)
    if op in ("stx8", "stx16", "sti8", "sti16"):
        return frozenset(fact for fact in facts if fact.op not in ("ld8", "ld16"))
    if op == "low":
        bytes_of = {Code("ld8", fact.operand) for fact in facts if fact.op == "ld16"}
        return frozenset([*bytes_of, NARROW])
    narrow = op in MAKE_NARROW or (op == "shr" and NARROW in facts)
    found = {NARROW} if narrow or (op == "call" and operand in whole.narrow) else set()
    if op in ("ld0", "ld1", "ldk", "ldkn", "ldkw"):
        return _constant_facts(line)
    if op in ("ld8", "ld16"):
        assert isinstance(operand, Place)
        if operand.symbol not in whole.volatile:
            found.add(line)
    return frozenset(found)


def _stored(line: Code, facts: Facts, volatile: set[str]) -> Facts:
    place = line.operand
    assert isinstance(place, Place)
    width = 2 if line.op == "st16" else 1
    found = {fact for fact in facts if not _overlaps(fact, place, width)}
    if place.symbol not in volatile:
        if width == 2:
            found.add(Code("ld16", place))
        if NARROW in facts:
            found.add(Code("ld8", place))
    return frozenset(found)


def _overlaps(fact: Code, place: Place, width: int) -> bool:
    other = fact.operand
    if not isinstance(other, Place) or fact.op not in ("ld8", "ld16"):
        return False
    own = 2 if fact.op == "ld16" else 1
    return (
        other.symbol == place.symbol
        and other.offset < place.offset + width
        and place.offset < other.offset + own
    )


# --- backwards: what is wanted --------------------------------------------------

A = Place("A")


def _drop_unwanted(lines: Lines, whole: Whole, own: Collection[str], result: bool) -> Lines:
    """Drop what changes nothing but A or a local variable, and nobody wants that."""
    private = _private(lines, set(own))
    wanted_at: dict[str, frozenset[Place]] = {}
    while True:
        changed = False
        kept: Lines = []
        now: frozenset[Place] = frozenset()
        for line in reversed(lines):
            if isinstance(line, Label):
                if wanted_at.get(line.name) != now:
                    wanted_at[line.name], changed = now, True
                kept.append(line)
                continue
            if line.op in ENDS:
                now = frozenset()
            if line.op in JUMPS or line.op == "case":
                now |= wanted_at.get(str(line.operand), frozenset())
            if _useless(line, now, private, whole.volatile):
                continue
            kept.append(line)
            now = _before(line, now, private, whole.takes_a, result)
        if not changed:
            return kept[::-1]


def _private(lines: Lines, own: set[str]) -> set[str]:
    """Return the local variables that are only loaded and stored as a whole."""
    taken = {
        line.operand.symbol
        for line in lines
        if isinstance(line, Code) and isinstance(line.operand, Place)
        if line.op in ("ldk", "ldkw", "ldx8", "ldx16", "stx8", "stx16")
    }
    return own - taken


def _useless(line: Code, wanted: frozenset[Place], private: set[str], volatile: set[str]) -> bool:
    place = line.operand
    if line.op in ("st8", "st16"):
        assert isinstance(place, Place)
        if place.symbol not in private:
            return False
        return wanted.isdisjoint(_bytes_of(line))
    reads_volatile = isinstance(place, Place) and place.symbol in volatile
    return line.op in ONLY_A and A not in wanted and not reads_volatile


def _bytes_of(line: Code) -> set[Place]:
    assert isinstance(line.operand, Place)
    first = Place(line.operand.symbol, line.operand.offset)
    return {first, first.plus(1)} if line.op.endswith("16") else {first}


def _before(
    line: Code,
    wanted: frozenset[Place],
    private: set[str],
    takes_a: Collection[str],
    result: bool,
) -> frozenset[Place]:
    """Return what is wanted before an operation that stays."""
    found = set(wanted)
    if line.op in ONLY_A or line.op in ("native8", "native16", "call"):
        found.discard(A)
    place = line.operand
    if isinstance(place, Place) and place.symbol in private:
        if line.op in ("st8", "st16"):
            found -= _bytes_of(line)
        else:
            found |= _bytes_of(line)
    if line.op == "call":
        if line.operand in takes_a:
            found.add(A)
    elif line.op == "ret":
        if result:
            found.add(A)
    elif line.op not in WITHOUT_A:
        found.add(A)
    return frozenset(found)
