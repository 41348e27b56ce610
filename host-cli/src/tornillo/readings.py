# SPDX-License-Identifier: Apache-2.0
"""Measured lengths from a file or a person, in micrometres."""

import math
from pathlib import Path

from tornillo.calibration import Ways
from tornillo.errors import TornilloError
from tornillo.language import _

UM_PER_UNIT = {"um": 1.0, "mm": 1000.0, "inch": 25_400.0}


def length_um(text: str, units: str) -> float:
    """A typed number in micrometres; a decimal comma is understood.

    Raises ValueError when it is no ordinary number.
    """
    value = float(text.strip().replace(",", "."))
    if not math.isfinite(value):
        raise ValueError(text)
    return value * UM_PER_UNIT[units]


def read_ways(path: Path, units: str) -> list[Ways]:
    """Pairs of lengths from a text file: two numbers a line, `#` begins a comment.

    Raises TornilloError with the line when there is something else.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise TornilloError(
            _("cannot read {path}: {error}").format(path=path, error=error),
            _("write a text file with two numbers a line"),
        ) from error
    found = []
    for number, line in enumerate(lines, start=1):
        words = line.partition("#")[0].replace(";", " ").split()
        if not words:
            continue
        try:
            first, second = (length_um(word, units) for word in words)
        except ValueError as error:
            raise TornilloError(
                _("{path}:{number}: {line!r} are no two lengths").format(
                    path=path, number=number, line=line.strip()
                ),
                _("write mark 1 to 2 and mark 2 to 3, like 7.468 6.757"),
            ) from error
        found.append(Ways(first, second))
    return found
