# SPDX-License-Identifier: Apache-2.0
"""A person at the panel: presses keys and buttons, reads the display, has no computer."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tornillo import Part
from tornillo.protocol import SettingId, State

from simulated.bench import Bench

#: The display is written anew in 70 ms, each of its lines worked out every 32 ms.
SHOWN_S = 0.2
#: An answer stands for 1.5 s.
ANSWER_S = 1.6
STARTED_S = 0.7
#: Settings have been stored, and the display has followed.
STORED_S = 0.5


class AtThePanel:
    """A lathe with a panel, just switched on, cable out."""

    def __init__(
        self, *parts: Path | bytes, settings: dict[str, int] | None = None, **options: Any
    ) -> None:
        """Store settings and parts (files or images) in it with a computer, then take that away."""
        self.bench = Bench(panel=True, **options)
        for name, value in {"panel": 1, **(settings or {})}.items():
            self.bench.host.set_setting(SettingId[name.upper()], value)
        for part in parts:
            machine = self.bench.host.machine()
            self.bench.host.upload(
                part if isinstance(part, bytes) else Part.load(part).image(machine)
            )
        self.bench.power_cycle()
        self.bench.run(STARTED_S)

    @property
    def lines(self) -> tuple[str, str]:
        """What the display shows, without the blanks at the ends."""
        first, second = self.bench.lathe.panel.lines()
        return first.rstrip(), second.rstrip()

    def press(self, *keys: str) -> None:
        """Press keys one after the other."""
        for key in keys:
            self.bench.lathe.panel.press(key)

    def hold(self, key: str, seconds: float) -> None:
        """Keep a key down for some time."""
        self.bench.lathe.panel.hold(key)
        self.bench.run(seconds)
        self.bench.lathe.panel.release()

    def read(self) -> tuple[str, str]:
        """Look at the display when it has had time to follow."""
        self.bench.run(SHOWN_S)
        return self.lines

    def shows(self, first: str, second: str = "") -> None:
        """Check both lines of the display."""
        assert self.read() == (first, second)

    def waits(self, state: State, timeout: float = 60.0) -> None:
        """Let time pass until the machine is in a state."""
        self.bench.wait_for(state, timeout)

    def check(self) -> None:
        """Check that display and keys were used by the book."""
        assert self.bench.lathe.panel.mistakes == []
