# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Reads and writes the S-expressions of KiCad files.

A list is a Python list, a quoted string is a str, anything else (names,
numbers) is an Atom, so that what was read can be written back unchanged.
"""

from __future__ import annotations

import re
from typing import Any

_TOKEN = re.compile(r'\s*(?:(\()|(\))|"((?:[^"\\]|\\.)*)"|([^\s()"]+))')


class Atom(str):
    """A bare word or number, written without quotes."""

    __slots__ = ()


def parse(text: str) -> list[Any]:
    """Return the first list in text; raises ValueError where it is cut off."""
    stack: list[list[Any]] = []
    position = 0
    while True:
        found = _TOKEN.match(text, position)
        if found is None:
            raise ValueError(f"S-expression ends early, at character {position}")
        position = found.end()
        opened, closed, quoted, bare = found.groups()
        if opened:
            stack.append([])
        elif closed:
            done = stack.pop()
            if not stack:
                return done
            stack[-1].append(done)
        elif quoted is not None:
            stack[-1].append(re.sub(r"\\(.)", _unescape, quoted))
        else:
            stack[-1].append(Atom(bare))


def _unescape(found: re.Match[str]) -> str:
    return "\n" if found.group(1) == "n" else found.group(1)


def atom(value: float | int | str) -> Atom:
    """Return a number as KiCad writes it: at most four decimals, no tail."""
    if isinstance(value, float):
        text = f"{value:.4f}".rstrip("0").rstrip(".")
        return Atom("0" if text == "-0" else text)
    return Atom(value)


def dump(node: Any, depth: int = 0) -> str:
    """Return the text of a node: lists that hold lists take several lines."""
    if isinstance(node, Atom):
        return str(node)
    if isinstance(node, str):
        escaped = node.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{escaped}"'
    if isinstance(node, (int, float)):
        return str(atom(float(node)))
    if not any(isinstance(item, list) for item in node):
        return "(" + " ".join(dump(item) for item in node) + ")"
    indent = "\t" * (depth + 1)
    head = [dump(item) for item in node if not isinstance(item, list)]
    body = [indent + dump(item, depth + 1) for item in node if isinstance(item, list)]
    return "(" + " ".join(head) + "\n" + "\n".join(body) + "\n" + "\t" * depth + ")"


def children(node: list[Any], name: str) -> list[list[Any]]:
    """Return the sub-lists of node that start with name."""
    return [item for item in node if isinstance(item, list) and item and item[0] == name]


def child(node: list[Any], name: str) -> list[Any]:
    """Return the first sub-list called name; raises KeyError without one."""
    found = children(node, name)
    if not found:
        raise KeyError(f"no ({name} ...) in ({node[0]} ...)")
    return found[0]
