# SPDX-License-Identifier: Apache-2.0
"""What the motors can do: the speeds that the board's simulation has found.

``hw/spice`` simulates winding, driver and rotor and keeps its result in
``hw/spice/motor_limits.json``; the virtual lathe takes its defaults from there, so that a part
that is cut here does not ask more of a motor than the board gives it.
"""

from __future__ import annotations

import json
from pathlib import Path

LIMITS_FILE = Path(__file__).resolve().parents[2] / "hw" / "spice" / "motor_limits.json"
_limits = json.loads(LIMITS_FILE.read_text(encoding="utf-8"))

#: Fastest rate a motor starts, stops and turns back at, full steps/s.
PULL_IN: float = float(_limits["pull_in_steps_per_s"])
#: Fastest rate it follows when it is brought there gently, full steps/s.
PULL_OUT: float = float(_limits["pull_out_steps_per_s"])
