# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Words on the board: names, connector pinouts, revision, licence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

REVISION = "A"
DATE = "2026-11-20"


def write(pcbnew: Any, board: Any, at: Callable[[float, float], Any]) -> None:
    """Write all texts; at turns mm on the board into board units."""
    return None
