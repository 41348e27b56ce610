# SPDX-License-Identifier: Apache-2.0
"""The contents of protocol.toml as typed Python objects, for the three writers."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

SIZES = {"u8": 1, "i16": 2, "u16": 2, "u32": 4, "i32": 4}
STRUCT_CODES = {"u8": "B", "i16": "h", "u16": "H", "u32": "I", "i32": "i"}
FLAGS = ("status_flag", "input", "homed_axis", "warning", "run_flag")
ENUMS = ("axis", "status_flag", "state", "input", "reset_cause", "error", "alarm", "refusal")
RECORD_HEAD = 4  # type u8, kind u8, size u16
RECORD_HEAD_CODE = "BBH"
NOTICE = "Generated from protocol.toml by generate_protocol.py: do not edit."


@dataclass(frozen=True)
class Field:
    """One field of a message or record; `size` is the largest number of bytes."""

    name: str
    type: str
    meaning: str
    offset: int
    size: int

    @property
    def is_open(self) -> bool:
        """Whether the field may be shorter than `size`."""
        return self.type.startswith("bytes")

    @property
    def is_text(self) -> bool:
        """Whether the field is ASCII text."""
        return self.type.startswith("char")

    @property
    def struct_code(self) -> str:
        """The field as a letter of Python's struct module; empty for an open field."""
        if self.is_open:
            return ""
        return f"{self.size}s" if self.is_text else STRUCT_CODES[self.type]


@dataclass(frozen=True)
class Layout:
    """Fields one after the other."""

    fields: tuple[Field, ...]

    @property
    def size(self) -> int:
        """Bytes, with an open field at its longest."""
        return sum(field.size for field in self.fields)

    @property
    def is_open(self) -> bool:
        """Whether the last field may be shorter."""
        return bool(self.fields) and self.fields[-1].is_open


@dataclass(frozen=True)
class Command:
    """One command: its code, request payload and response data after the error byte."""

    name: str
    code: int
    meaning: str
    request: Layout
    response: Layout
    errors: tuple[str, ...]


@dataclass(frozen=True)
class Model:
    """Everything in protocol.toml."""

    raw: dict[str, Any]
    commands: tuple[Command, ...]
    image_header: Layout
    operations: dict[str, Layout]


def layout(rows: list[dict[str, str]], first: int = 0) -> Layout:
    """Place `rows` one after the other from offset `first`."""
    fields = []
    offset = first
    for row in rows:
        kind = row["type"]
        size = (
            SIZES[kind] if kind in SIZES else int(kind.removeprefix("char").removeprefix("bytes"))
        )
        fields.append(Field(row["name"], kind, row["meaning"], offset, size))
        offset += size
    return Layout(tuple(fields))


def load(path: Path) -> Model:
    """Read protocol.toml.

    Raises ValueError when a name is not known or a message does not fit a frame.
    """
    raw = tomllib.loads(path.read_text(encoding="utf-8"))
    commands = []
    for name, entry in raw["command"].items():
        unknown = [error for error in entry["errors"] if error not in raw["error"]]
        if unknown:
            raise ValueError(f"command {name}: no such error: {unknown[0]}")
        command = Command(
            name,
            entry["code"],
            entry["meaning"],
            layout(entry["request"]),
            layout(entry["response"], first=1),
            tuple(entry["errors"]),
        )
        if max(command.request.size, command.response.size + 1) > raw["frame"]["payload_max"]:
            raise ValueError(f"command {name}: longer than a frame")
        commands.append(command)
    operations = {
        name: layout(entry["fields"], first=RECORD_HEAD) for name, entry in raw["operation"].items()
    }
    return Model(raw, tuple(commands), layout(raw["image"]["header"]), operations)


def rule_order(model: Model) -> str:
    """In which order the rules of a part image are applied, as a sentence."""
    image = model.raw["image"]
    whole, each, end = (
        ", ".join(name.upper() for name in image[key])
        for key in ("part_rules", "operation_rules", "end_rules")
    )
    return (
        f"First for the whole part (operation 0): {whole}. Then for each operation in turn: "
        f"{each}. After the last one (operation 0): {end}."
    )
