# SPDX-License-Identifier: Apache-2.0
"""Names of variables and functions, read from the map file of gplink."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

_LINE = re.compile(r"^\s*(\S+)\s+0x([0-9a-fA-F]{6})\s+(program|data)\s+(\S+)\s+(.*)$")


@dataclass(frozen=True)
class Symbols:
    """Addresses by name: ``data`` for RAM (0..0xFFF), ``program`` for flash (bytes)."""

    data: dict[str, int]
    program: dict[str, int]

    @classmethod
    def read(cls, path: Path) -> Symbols:
        """Parse the map file at ``path``; an absent file gives an empty table.

        A C name ``speed`` is listed as ``_speed``; both spellings are found.
        """
        data: dict[str, int] = {}
        program: dict[str, int] = {}
        if path.exists():
            for line in path.read_text(encoding="latin-1").splitlines():
                match = _LINE.match(line)
                if match:
                    table = data if match.group(3) == "data" else program
                    table[match.group(1)] = int(match.group(2), 16)
        return cls(data, program)

    def ram(self, name: str) -> int:
        """Return the data address of ``name``.

        Raises:
            KeyError: no such variable.
        """
        return self._find(self.data, name)

    def code(self, name: str) -> int:
        """Return the byte address in flash of the function ``name``.

        Raises:
            KeyError: no such function.
        """
        return self._find(self.program, name)

    @staticmethod
    def _find(table: dict[str, int], name: str) -> int:
        if name in table:
            return table[name]
        if f"_{name}" in table:
            return table[f"_{name}"]
        raise KeyError(f"{name} is not in the map file")
