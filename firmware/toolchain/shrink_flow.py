# SPDX-License-Identifier: Apache-2.0
"""What each instruction reads and writes, where it goes, and what is still needed.

Tracked are the virtual registers, WREG ("W"), the five flags, and the core
registers that return results (PRODL, PRODH, FSR0L). All else is memory: never removed, never moved.
"""

from dataclasses import dataclass

from shrink_model import SKIPS, Function, Line, Program, RefusalError

FLAGS = {"C", "DC", "Z", "OV", "N"}
RESULT = ("PRODL", "PRODH", "FSR0L")  # where the higher bytes of a result are returned
THROUGH_FSR0 = {"INDF0", "POSTINC0", "POSTDEC0", "PREINC0", "PLUSW0"}
FLAG_OF_BIT = {"0": "C", "1": "DC", "2": "Z", "3": "OV", "4": "N"}
SUM = FLAGS
LOGIC = {"Z", "N"}

# op: (reads the file register, flags read, flags written)
BINARY = {
    "ADDWF": (set(), SUM),
    "ADDWFC": ({"C"}, SUM),
    "ANDWF": (set(), LOGIC),
    "IORWF": (set(), LOGIC),
    "XORWF": (set(), LOGIC),
    "SUBWF": (set(), SUM),
    "SUBFWB": ({"C"}, SUM),
    "SUBWFB": ({"C"}, SUM),
}
UNARY = {
    "COMF": (set(), LOGIC),
    "DECF": (set(), SUM),
    "INCF": (set(), SUM),
    "MOVF": (set(), LOGIC),
    "RLCF": ({"C"}, {"C", "Z", "N"}),
    "RRCF": ({"C"}, {"C", "Z", "N"}),
    "RLNCF": (set(), LOGIC),
    "RRNCF": (set(), LOGIC),
    "SWAPF": (set(), set()),
    "DECFSZ": (set(), set()),
    "INCFSZ": (set(), set()),
    "DCFSNZ": (set(), set()),
    "INFSNZ": (set(), set()),
}
STORE = {"MOVWF": ({"W"}, set()), "CLRF": (set(), {"Z"}), "SETF": (set(), set())}
TEST = {"CPFSEQ": {"W"}, "CPFSGT": {"W"}, "CPFSLT": {"W"}, "TSTFSZ": set(), "MULWF": {"W"}}
LITERAL = {"ADDLW": SUM, "SUBLW": SUM, "ANDLW": LOGIC, "IORLW": LOGIC, "XORLW": LOGIC}
BRANCH = {
    "BZ": "Z",
    "BNZ": "Z",
    "BC": "C",
    "BNC": "C",
    "BN": "N",
    "BNN": "N",
    "BOV": "OV",
    "BNOV": "OV",
}
INERT = {
    "BANKSEL",
    "NOP",
    "CLRWDT",
    "LFSR",
    "MOVLB",
    "GOTO",
    "BRA",
    "CALL",
    "RCALL",
    "RETURN",
    "RETFIE",
    "RESET",
    "SLEEP",
    "TBLRD*",
    "TBLRD*+",
    "TBLRD*-",
    "TBLRD+*",
    "TBLWT*",
    "TBLWT*+",
    "TBLWT*-",
    "TBLWT+*",
}
JUMPS = {"GOTO", "BRA"}


@dataclass
class Effect:
    """The tracked things an instruction reads and surely writes.

    `pure` says that it does nothing besides writing those.
    """

    reads: set[str]
    writes: set[str]
    pure: bool


def _named(operand: str) -> set[str]:
    """Return the tracked things that a file-register operand stands for."""
    if "@" in operand or operand in RESULT:
        return {operand}
    if operand == "WREG":
        return {"W"}
    return set()


def _reading(operand: str) -> set[str]:
    if operand == "STATUS":
        return set(FLAGS)
    return _named(operand) | _through(operand)


def _through(operand: str) -> set[str]:
    """Return what reaching an operand reads (the index of PLUSWn, the pointer)."""
    found = {"W"} if operand.startswith("PLUSW") else set()
    return found | ({"FSR0L"} if operand in THROUGH_FSR0 else set())


def _fixed_effects() -> dict[str, Effect]:
    """Return the effects of the instructions for which the operands do not matter."""
    fixed = {op: Effect(set(), set(), False) for op in INERT | {""}}
    fixed |= {op: Effect({flag}, set(), False) for op, flag in BRANCH.items()}
    fixed |= {op: Effect({"W"}, {"W"} | flags, True) for op, flags in LITERAL.items()}
    fixed["MOVLW"] = Effect(set(), {"W"}, True)
    fixed["RETLW"] = Effect(set(), {"W"}, False)
    fixed["MULLW"] = Effect({"W"}, {"PRODL", "PRODH"}, False)
    fixed["DAW"] = Effect({"W", "C", "DC"}, {"W", "C"}, True)
    return fixed


FIXED = _fixed_effects()


def effect(line: Line) -> Effect:
    """Return the effect of one instruction; RefusalError for an unknown one."""
    op, args = line.op, line.args
    if op in FIXED:
        return FIXED[op]
    if op == "MOVFF":
        written = set(FLAGS) if args[1] == "STATUS" else _named(args[1])
        pure = bool(_named(args[0])) and bool(_named(args[1]))
        return Effect(_reading(args[0]) | _through(args[1]), written, pure)
    if op in STORE:
        reads, flags = STORE[op]
        return Effect(reads | _through(args[0]), _named(args[0]) | flags, bool(_named(args[0])))
    if op in TEST:
        written = {"PRODL", "PRODH"} if op == "MULWF" else set()
        return Effect(TEST[op] | _reading(args[0]), written, False)
    return _file_effect(line)


def _file_effect(line: Line) -> Effect:
    """Return the effect of an instruction with a destination bit or a bit number."""
    op, args = line.op, line.args
    source = _reading(args[0])  # includes what a write through FSR0 reads
    if (op in BINARY or op in UNARY) and len(args) > 1:
        reads, flags = BINARY[op] if op in BINARY else UNARY[op]
        to_w = args[1].upper() in ("W", "0")
        target = {"W"} if to_w else _named(args[0])
        pure = bool(_named(args[0])) and op not in SKIPS
        return Effect(source | reads | ({"W"} if op in BINARY else set()), target | flags, pure)
    if op == "NEGF":
        return Effect(source, _named(args[0]) | SUM, bool(_named(args[0])))
    if op in ("BTFSC", "BTFSS"):
        if args[0] == "STATUS":
            return Effect({FLAG_OF_BIT[args[1]]}, set(), False)
        return Effect(source, set(), False)
    if op in ("BCF", "BSF", "BTG"):
        return Effect(source, _named(args[0]), bool(_named(args[0])))
    raise RefusalError(f"unknown instruction: {line.text().strip()}")


def successors(function: Function) -> list[list[int]]:
    """Return for each line the lines that may come next (none after a return)."""
    body = function.body
    where = {line.label: index for index, line in enumerate(body) if not line.op}
    following = _next_instructions(body)
    result: list[list[int]] = []
    for index, line in enumerate(body):
        after = index + 1
        if line.op in ("RETURN", "RETFIE", "RETLW", "RESET"):
            result.append([])
        elif line.is_("MOVWF", "PCL"):
            table = [i for i in range(index + 2, len(body)) if body[i].pinned]
            result.append(_consecutive(table, index + 2))
        elif line.op in JUMPS:
            result.append([_target(function, where, line)])
        elif line.op in BRANCH:
            result.append([after, _target(function, where, line)])
        elif line.op in SKIPS:
            result.append([after, _past(following, index)])
        else:
            result.append([after])
    if any(target >= len(body) for targets in result for target in targets):
        raise RefusalError(f"{function.name}: runs past its end")
    return result


def _next_instructions(body: list[Line]) -> list[int]:
    """Return for each line the index of the first instruction after it."""
    result = [len(body)] * len(body)
    nearest = len(body)
    for index in range(len(body) - 1, -1, -1):
        result[index] = nearest
        if body[index].op:
            nearest = index
    return result


def _past(following: list[int], index: int) -> int:
    skipped = following[index]
    return following[skipped] if skipped < len(following) else skipped


def _consecutive(indices: list[int], start: int) -> list[int]:
    run: list[int] = []
    for index in indices:
        if index != start + len(run):
            break
        run.append(index)
    return run


def _target(function: Function, where: dict[str, int], line: Line) -> int:
    target = where.get(line.args[0])
    if target is None:
        raise RefusalError(f"{function.name}: jump out of the function: {line.text().strip()}")
    return target


def result_name(function: str, part: str) -> str:
    """Return the register that stands for PRODL, PRODH or FSR0L in a function's result."""
    return f"{function}@ret{part}"


class Liveness:
    """Which tracked things are needed after each line, over the whole program.

    A call of a function of the program needs what that function needs on entry
    (WREG and static arguments: SDCC never passes flags into a function, and what
    else is read before it is written is garbage by design); a return needs what
    any caller needs afterwards. `roots` are entered from elsewhere and return to
    code that is not seen (main never returns, so is none). A call of any other
    function needs WREG, PROD and FSR0L only if `takes_w` says so.
    """

    def __init__(self, program: Program, roots: set[str], takes_w: set[str]) -> None:
        """Solve for the program as it stands; later changes are not followed."""
        self.program = program
        self.takes_w = takes_w
        self.number: dict[str, int] = {}
        self.names: list[str] = []
        self.common = self.mask({"W", *RESULT} | FLAGS)
        self.results = {
            name: self.mask({result_name(name, part) for part in RESULT})
            for name in program.functions
        }
        self.entry = dict.fromkeys(program.functions, 0)
        result = self.mask({"W", *RESULT})
        self.exit = {name: result if name in roots else 0 for name in program.functions}
        for name, function in program.functions.items():
            if any(line.op == "RETFIE" for line in function.body):
                self.exit[name] = self.common
        self.after = {name: [0] * len(f.body) for name, f in program.functions.items()}
        self.graph = {name: successors(f) for name, f in program.functions.items()}
        self.effects = {
            name: [self._masks(line) for line in f.body] for name, f in program.functions.items()
        }
        self._solve()

    def mask(self, things: set[str]) -> int:
        """Return a set of tracked things as bits."""
        result = 0
        for thing in things:
            if thing not in self.number:
                self.number[thing] = len(self.names)
                self.names.append(thing)
            result |= 1 << self.number[thing]
        return result

    def things(self, mask: int) -> list[str]:
        """Return the tracked things whose bits are set."""
        result = []
        while mask:
            low = mask & -mask
            result.append(self.names[low.bit_length() - 1])
            mask ^= low
        return result

    def needed(self, function: str, index: int, thing: str) -> bool:
        """Tell whether a thing is needed after a line."""
        return bool(self.after[function][index] & self.mask({thing}))

    def _masks(self, line: Line) -> tuple[int, int, str]:
        what = effect(line)
        call = line.args[0] if line.op in ("CALL", "RCALL") else ""
        return self.mask(what.reads), self.mask(what.writes), call

    def _solve(self) -> None:
        changed = True
        while changed:
            changed = False
            for name in self.program.functions:
                changed |= self._function(name)

    def _function(self, name: str) -> bool:
        """Propagate through one function until stable; tell if callers must know."""
        after, graph, effects = self.after[name], self.graph[name], self.effects[name]
        before = [0] * len(after)
        told = False
        changed = True
        while changed:
            changed = False
            for index in range(len(after) - 1, -1, -1):
                live = self.exit[name] if not graph[index] else 0
                for target in graph[index]:
                    live |= before[target]
                reads, writes, call = effects[index]
                after[index] = live
                if call:
                    told |= self._call(call, live)
                    needs = self._before_call(call, live)
                else:
                    needs = (live & ~writes) | reads
                if needs != before[index]:
                    before[index] = needs
                    changed = True
        wanted = before[0] & self.mask({"W"} | self.arguments(name))
        if wanted != self.entry[name]:
            self.entry[name] = wanted
            told = True
        return told

    def arguments(self, name: str) -> set[str]:
        """Return the static arguments of a function; only these come in by register."""
        return {r for r in self.program.functions[name].registers() if r.startswith(f"{name}@arg")}

    def _call(self, target: str, live: int) -> bool:
        """Tell the callee what is needed after this call of it."""
        if target not in self.exit:
            return False
        wanted = self.exit[target] | (live & (self.common | self.results[target]))
        if wanted == self.exit[target]:
            return False
        self.exit[target] = wanted
        return True

    def _before_call(self, target: str, live: int) -> int:
        if target in self.entry:
            return (live & ~self.common & ~self.results[target]) | self.entry[target]
        needs = live & ~self.common
        return needs | (self.mask({"W", *RESULT}) if target in self.takes_w else 0)

    def returns(self, function: str, thing: str) -> bool:
        """Tell whether any caller needs a thing after the function has returned."""
        return bool(self.exit[function] & self.mask({thing}))
