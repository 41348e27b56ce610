# SPDX-License-Identifier: Apache-2.0
"""Write the tables of docs/protocol.md, between their markers."""

import re
from collections.abc import Sequence

from protocol_model import RECORD_HEAD, Field, Layout, Model, rule_order

MARKER = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)


def table(head: tuple[str, ...], rows: Sequence[tuple[str, ...]]) -> str:
    """A Markdown table."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def field_rows(fields: tuple[Field, ...]) -> list[tuple[str, ...]]:
    """Offset, type, name and meaning of each field."""
    return [(str(f.offset), f.type, f"`{f.name}`", f.meaning) for f in fields]


def layout_text(title: str, part: Layout, before: Sequence[tuple[str, ...]]) -> str:
    """A titled table of fields, or the title alone when there are none."""
    if not part.fields:
        return f"{title}: {'no data' if before else 'empty'}.\n\n"
    rows = [*before, *field_rows(part.fields)]
    return f"{title}:\n\n{table(('at', 'type', 'name', 'meaning'), rows)}\n"


def commands(model: Model) -> str:
    """A section for each command."""
    parts = []
    for command in model.commands:
        answers = ", ".join(name.upper() for name in command.errors) or "none of its own"
        parts.append(f"### 0x{command.code:02X} {command.name.upper()}\n\n{command.meaning}\n\n")
        parts.append(layout_text("Request payload", command.request, []))
        error = [("0", "u8", "`error`", "0 = OK")]
        parts.append(layout_text("Response payload after OK", command.response, error))
        parts.append(f"Errors: {answers}.\n\n")
    return "\n" + "".join(parts)


def explained(model: Model, name: str, *columns: str) -> str:
    """A table of codes with the named columns."""
    rows = [
        (str(entry["value"]), f"`{key.upper()}`", *(str(entry[column]) for column in columns))
        for key, entry in model.raw[name].items()
    ]
    return table(("code", "name", *columns), rows)


def flags(model: Model, name: str, *columns: str) -> str:
    """A table of bits with the named columns."""
    rows = [
        (f"0x{entry['value']:02X}", f"`{key.upper()}`", *(entry[column] for column in columns))
        for key, entry in model.raw[name].items()
    ]
    return table(("bit", "name", *columns), rows)


def limits(model: Model) -> str:
    """The limits by name."""
    rows = [
        (f"`{key.upper()}`", str(entry["value"]), entry["meaning"])
        for key, entry in model.raw["limits"].items()
    ]
    return table(("name", "value", "meaning"), rows)


def settings(model: Model) -> str:
    """The settings with their ranges."""
    rows = [
        (
            str(row["id"]),
            f"`{name}`",
            str(row["default"]),
            f"{row['min']} to {row['max']}",
            row["unit"],
            row["meaning"],
        )
        for name, row in model.raw["setting"].items()
    ]
    return table(("id", "name", "default", "range", "unit", "meaning"), rows)


def image(model: Model) -> str:
    """The header of a part image."""
    rows = field_rows(model.image_header.fields)
    return table(("at", "type", "name", "meaning"), rows)


def operations(model: Model) -> str:
    """The operation records."""
    parts = []
    for name, part in model.operations.items():
        entry = model.raw["operation"][name]
        size = part.size + RECORD_HEAD
        parts.append(f"\n**{name}**, type {entry['type']}, {size} bytes. {entry['meaning']}\n\n")
        parts.append(table(("at", "type", "name", "meaning"), field_rows(part.fields)))
    return "".join(parts) + "\n"


def fill(model: Model, page: str, others: dict[str, str] | None = None) -> str:
    """`page` with every marked table written anew; `others` are tables made elsewhere.

    Raises KeyError when a marker names no table.
    """
    tables = (others or {}) | {
        "limits": limits(model),
        "commands": commands(model),
        "errors": explained(model, "error", "cause", "remedy"),
        "states": explained(model, "state", "meaning"),
        "flags": flags(model, "status_flag", "meaning"),
        "homed_axes": flags(model, "homed_axis", "meaning"),
        "warnings": flags(model, "warning", "cause", "remedy"),
        "run_flags": flags(model, "run_flag", "meaning"),
        "alarms": explained(model, "alarm", "cause", "remedy"),
        "inputs": flags(model, "input", "meaning"),
        "resets": explained(model, "reset_cause", "meaning"),
        "refusals": f"{rule_order(model)}\n\n{explained(model, 'refusal', 'rule', 'remedy')}",
        "image": image(model),
        "operations": operations(model),
        "settings": settings(model),
    }
    return MARKER.sub(lambda found: found[1] + tables[found[2]] + found[3], page)
