# SPDX-License-Identifier: Apache-2.0
"""The assembly that SDCC generates, as objects: programs, functions and lines.

Every virtual register r0xNN is renamed to `function@r0xNN`, because SDCC saves
and restores those a function uses: to the function they are private.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

REGISTER = re.compile(r"^r0x[0-9a-f]+$", re.IGNORECASE)
LOCAL_LABEL = re.compile(r"\b_\d+_DS_")
SYMBOL = re.compile(r"\b[A-Za-z_]\w*\b")
LONG = {"MOVFF", "CALL", "GOTO", "LFSR"}
SKIPS = {
    "BTFSC",
    "BTFSS",
    "CPFSEQ",
    "CPFSGT",
    "CPFSLT",
    "TSTFSZ",
    "DECFSZ",
    "INCFSZ",
    "DCFSNZ",
    "INFSNZ",
}


# The names by which C code would reach what is tracked under other names.
UNTRACKED = {
    f"_{name}{suffix}"
    for name in (
        "FSR0",
        "FSR1",
        "FSR2",
        "PROD",
        "POSTDEC1",
        "POSTINC1",
        "PREINC1",
        "PLUSW1",
        "INDF1",
    )
    for suffix in ("", "L", "H")
} | {"_POSTDEC2", "_POSTINC2", "_PREINC2", "_PLUSW2", "_INDF2"}
UNTRACKED |= {"_INDF0", "_POSTINC0", "_POSTDEC0", "_PREINC0"}
UNTRACKED |= {"_STATUS", "_WREG", "_PLUSW0", "_PCL", "_PC"}


class RefusalError(Exception):
    """The assembly holds something that this pass does not know to be safe."""


@dataclass
class Line:
    """One label (op is empty) or one instruction of a function.

    A pinned line is an entry of a jump table: its size may not change.
    """

    op: str
    args: list[str] = field(default_factory=list)
    label: str = ""
    pinned: bool = False

    def size(self) -> int:
        """Return the bytes of flash the line takes."""
        if not self.op:
            return 0
        return 4 if self.op in LONG else 2

    def is_(self, op: str, *args: str) -> bool:
        """Tell whether this is exactly the instruction named."""
        return self.op == op and self.args == list(args)

    def text(self) -> str:
        """Return the line as the assembler reads it."""
        if not self.op:
            return f"{self.label}:"
        return f"\t{self.op}\t{', '.join(self.args)}".rstrip().replace("@", "")


@dataclass
class Function:
    """A function: its name, the source file it came from and its lines."""

    name: str
    file: str
    body: list[Line]

    def size(self) -> int:
        """Return the bytes of flash the function takes."""
        return sum(line.size() for line in self.body)

    def calls(self) -> list[str]:
        """Return the targets of all calls, in order, repeated as often as called."""
        return [line.args[0] for line in self.body if line.op in ("CALL", "RCALL")]

    def registers(self) -> set[str]:
        """Return the virtual registers that the lines name."""
        return {arg for line in self.body for arg in line.args if "@" in arg}


@dataclass
class Program:
    """All functions of all files, and the text around them."""

    functions: dict[str, Function] = field(default_factory=dict)
    equates: dict[str, str] = field(default_factory=dict)
    globals: list[str] = field(default_factory=list)
    externs: set[str] = field(default_factory=set)
    data: list[str] = field(default_factory=list)
    tables: list[str] = field(default_factory=list)
    fixed: list[str] = field(default_factory=list)
    configuration: list[str] = field(default_factory=list)


def places(lines: list[Line]) -> tuple[dict[str, int], list[int]]:
    """Bytes from the first line to each label, and to each line."""
    place: dict[str, int] = {}
    at: list[int] = []
    address = 0
    for line in lines:
        at.append(address)
        if not line.op:
            place[line.label] = address
        address += line.size()
    return place, at


def split_arguments(text: str) -> list[str]:
    """Split an operand list at its commas (none stand inside parentheses)."""
    return [part.strip() for part in text.split(",")] if text.strip() else []


class _Reader:
    """Reads one file into a program; the state is the kind of section it is in."""

    def __init__(self, program: Program, path: Path, number: int, renamed: dict[str, str]) -> None:
        self.program = program
        self.path = path
        self.number = number
        self.renamed = renamed
        self.section = "none"
        self.body: list[Line] = []

    def refuse(self, why: str, line: str) -> RefusalError:
        return RefusalError(f"{self.path}: {why}: {line.strip()}")

    def read(self) -> None:
        """Take every line of the file."""
        for raw in self.path.read_text().splitlines():
            line = raw.split(";")[0].rstrip()
            if not line:
                continue
            words = line.split()
            if words[0].lower() == "end":
                break
            self._line(self._rename(line), words)

    def _rename(self, line: str) -> str:
        line = LOCAL_LABEL.sub(lambda m: f"{m.group(0)}{self.number}", line)
        return SYMBOL.sub(lambda m: self.renamed.get(m.group(0), m.group(0)), line)

    def _line(self, line: str, words: list[str]) -> None:
        program = self.program
        first = words[0].lower()
        rest = line.split(None, 1)[1] if len(words) > 1 else ""
        if first in ("list", "radix"):
            return
        if first == "global":
            program.globals.append(rest)
        elif first == "extern":
            program.externs.add(rest)
        elif first == "config":
            program.configuration.append(line)
        elif len(words) > 1 and words[1].lower() == "equ":
            name = line.split(maxsplit=1)[0]
            if program.equates.setdefault(name, words[2]) != words[2]:
                raise self.refuse("two values of one name", line)
        elif first == "code" or (
            len(words) > 1
            and words[1].lower() in ("code", "udata", "udata_ovr", "udata_acs", "idata")
        ):
            self._section(line, words)
        else:
            self._content(line, words)

    def _section(self, line: str, words: list[str]) -> None:
        kind = words[0].lower() if len(words) == 1 else words[1].lower()
        self.section = kind
        if words[0] == ".registers":
            self.section = "registers"
        elif kind == "idata":
            raise self.refuse("initialised data", line)
        elif kind == "code" and len(words) > 2:
            self.section = "fixed"
            self.program.fixed.append(line)
        elif kind == "code" and len(words) == 1:
            self.section = "tables"
        elif kind != "code":
            self.program.data.append(line)

    def _content(self, line: str, words: list[str]) -> None:
        if self.section == "registers":
            return
        if self.section == "fixed":
            self.program.fixed.append(line)
        elif self.section in ("tables",) or words[0].upper() == "DB":
            self.program.tables.append(line)
        elif self.section == "code":
            self._code(line)
        elif self.section.startswith("udata"):
            self.program.data.append(line)
        else:
            raise self.refuse("line outside every section", line)

    def _code(self, line: str) -> None:
        if line.endswith(":") and not line[0].isspace():
            label = line[:-1]
            if not LOCAL_LABEL.match(label):
                if label in self.program.functions:
                    raise self.refuse("function defined twice", line)
                self.body = []
                self.program.functions[label] = Function(label, self.path.stem, self.body)
            self.owner = label if not LOCAL_LABEL.match(label) else self.owner
            self.body.append(Line("", label=label))
            return
        parts = line.strip().split(None, 1)
        args = split_arguments(parts[1]) if len(parts) > 1 else []
        for position, arg in enumerate(args):
            if REGISTER.match(arg):
                args[position] = f"{self.owner}@{arg}"
            elif "r0x" in arg:
                raise self.refuse("address of a register", line)
            elif arg in UNTRACKED:
                raise self.refuse("core register by the name of a variable", line)
        self.body.append(Line(parts[0].upper(), args))

    owner: str = ""


def _definitions(path: Path) -> tuple[set[str], set[str]]:
    """Return the names a file defines and, of these, the ones it makes global."""
    defined: set[str] = set()
    public: set[str] = set()
    for raw in path.read_text().splitlines():
        line = raw.split(";")[0].rstrip()
        words = line.split()
        if len(words) == 2 and words[0].lower() == "global":
            public.add(words[1])
        elif line[:1] == "_" and (line.endswith(":") or (len(words) > 1 and words[1] == "res")):
            defined.add(words[0].rstrip(":"))
    return {name for name in defined if not LOCAL_LABEL.match(name)}, public


def _pin_tables(function: Function) -> None:
    """Mark the entries of each jump table (GOTOs after a write to PCL)."""
    body = function.body
    for index, line in enumerate(body):
        if line.is_("MOVWF", "PCL"):
            following = index + 2
            if following > len(body) or body[index + 1].op:
                raise RefusalError(f"{function.name}: computed jump without a table")
            while following < len(body) and body[following].op == "GOTO":
                body[following].pinned = True
                following += 1
            if following == index + 2:
                raise RefusalError(f"{function.name}: computed jump without a table of GOTO")
        elif line.op and line.args and "PCL" in line.args:
            raise RefusalError(f"{function.name}: unknown use of PCL: {line.text()}")


def read_program(paths: list[Path]) -> Program:
    """Read generated assembly files.

    Private names that several files define get the file's name appended.
    Raises RefusalError for anything that SDCC is not known to generate.
    """
    program = Program()
    defined = {path: _definitions(path) for path in paths}
    for number, path in enumerate(paths):
        names, public = defined[path]
        others = {name for other in paths if other != path for name in defined[other][0]}
        renamed = {name: f"{name}__{path.stem}" for name in (names - public) & others}
        _Reader(program, path, number, renamed).read()
    for function in program.functions.values():
        _pin_tables(function)
    return program


def write_program(
    program: Program, order: list[str], slots: list[str], interrupt_slots: list[str]
) -> str:
    """Return the program as one assembly file, its functions in the order given.

    `slots` overlay the registers of the library's routines; `interrupt_slots`
    are apart, because an interrupt may come in the middle of such a routine.
    """
    defined = set(program.globals) | set(program.functions)
    lines = ["\tlist\tp=18f4550", "\tradix\tdec"]
    lines += program.configuration
    lines += [f"\tglobal\t{name}" for name in program.globals]
    lines += [f"\textern\t{name}" for name in sorted(program.externs - defined)]
    lines += [f"{name}\tequ\t{value}" for name, value in program.equates.items()]
    lines += [".registers\tudata_ovr\t0x0000", *(f"{slot}\tres\t1" for slot in slots)]
    if interrupt_slots:
        lines += ["registers_interrupt\tudata_acs"]
        lines += [f"{slot}\tres\t1" for slot in interrupt_slots]
    lines += program.data
    lines += program.fixed
    if program.tables:
        lines += ["code_tables\tcode", *program.tables]
    lines.append("code_program\tcode")
    for name in order:
        lines += [line.text() for line in program.functions[name].body]
    return "\n".join([*lines, "\tend", ""])
