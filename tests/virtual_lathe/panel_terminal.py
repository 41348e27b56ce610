# SPDX-License-Identifier: Apache-2.0
"""The panel in a terminal: a frame with the two lines, and keys that press those of the panel.

On a terminal single keys are taken and the frame is drawn over itself; otherwise, in a pipe, typed
lines are taken and the frame is printed whenever what it shows has changed.
"""

from __future__ import annotations

import re
import shutil
import sys
import termios
import tty
from typing import Any, TextIO

from .lathe import VirtualLathe
from .panel import COLUMNS, KEYS, PRESS_S, REST_S

#: A key of a terminal is taken as held this long; a held one repeats some 30 times a second.
TOUCH_S = 0.15
LONGEST_S = 600.0
#: What a terminal sends for a key, and what the key does.
KEYS_OF_TERMINAL = {
    **{b"\x1b[A": "up", b"\x1b[B": "down", b"\x1b[D": "left", b"\x1b[C": "right"},
    **{b"\x1bOA": "up", b"\x1bOB": "down", b"\x1bOD": "left", b"\x1bOC": "right"},
    **{b"\r": "ok", b"\n": "ok", b"\x7f": "back", b"\x08": "back", b"\x1b": "back"},
    **{b"o": "x-out", b"i": "x-in", b"r": "run", b"h": "hold", b"s": "stop"},
    **{b"e": "estop", b"l": "release", b"p": "plug", b"u": "unplug", b"t": "tool next"},
    b"q": "quit",
}
_SENT = re.compile(rb"\x1b[\[O].|.", re.DOTALL)
HELP = (
    "keys    arrows  Enter OK  Backspace BACK  o X OUT  i X IN",
    "buttons r RUN  h HOLD  s STOP  e emergency stop  l release it",
    "else    p plug in  u unplug  t next tool  q quit",
)
LINES_HELP = (
    f"key {'|'.join(KEYS)} [SECONDS]",
    "press run|hold|stop|estop|release, plug, unplug, tool next, quit",
)
UNDERLINED, REVERSED, PLAIN = "\x1b[4m", "\x1b[7m", "\x1b[0m"


def actions(sent: bytes) -> list[str]:
    """What the keys do whose bytes a terminal has sent; unknown keys do nothing."""
    return [name for key in _SENT.findall(sent) if (name := KEYS_OF_TERMINAL.get(key))]


class KeyHand:
    """A finger on the keys while time goes on by itself."""

    def __init__(self, lathe: VirtualLathe) -> None:
        """Put no finger anywhere."""
        self._lathe = lathe
        self._free_at = 0.0
        self._until = 0.0

    def press(self, key: str, seconds: float = PRESS_S) -> None:
        """Press a key for some seconds, when all that were asked for before are done.

        Raises:
            ValueError: no such key, or no time that a hand would hold it.
        """
        if key not in KEYS:
            raise ValueError(f"no key {key!r}: {', '.join(KEYS)}")
        if not 0 < seconds <= LONGEST_S:
            raise ValueError(f"a key is held for 0 to {LONGEST_S:g} seconds, not {seconds:g}")
        start = max(self._lathe.seconds, self._free_at)
        self._lathe.at(start, lambda: self._lathe.panel.hold(key))
        self._lathe.at(start + seconds, self._lathe.panel.release)
        self._free_at = start + seconds + REST_S

    def touch(self, key: str) -> None:
        """Press a key now; again before it is released, and it stays pressed."""
        self._lathe.panel.hold(key)
        self._until = self._lathe.seconds + TOUCH_S
        self._lathe.at(self._until, self._let_go)

    def _let_go(self) -> None:
        if self._lathe.seconds > self._until - 1e-6:
            self._lathe.panel.release()


def frame(lathe: VirtualLathe, marks: bool) -> list[str]:
    """The glass in a frame; with marks the cursor is underlined, a blinking character reversed."""
    glass = lathe.panel.glass()
    rows = [list(line) for line in lathe.panel.lines()]
    if marks and glass.on and glass.place and (glass.cursor or glass.blink):
        line, column = glass.place
        mark = REVERSED if glass.blink else UNDERLINED
        rows[line][column] = f"{mark}{rows[line][column]}{PLAIN}"
    edge = "─" * COLUMNS
    return [f"╭{edge}╮", *(f"│{''.join(row)}│" for row in rows), f"╰{edge}╯"]


class Screen:
    """Draws the panel on a stream; takes single keys if both ends are a terminal."""

    def __init__(
        self, lathe: VirtualLathe, source: TextIO = sys.stdin, target: TextIO = sys.stdout
    ) -> None:
        """Prepare the terminal; :meth:`close` restores it."""
        self._lathe = lathe
        self._target = target
        self.single_keys = not source.closed and source.isatty() and target.isatty()
        self._drawn: list[str] = []
        self._source = source
        self._before: list[Any] = []
        if self.single_keys:
            self._before = termios.tcgetattr(source)
            tty.setcbreak(source)
        else:
            self.say("\n".join(LINES_HELP))

    def close(self) -> None:
        """Leave the last frame where it is and give the terminal back."""
        if self.single_keys:
            termios.tcsetattr(self._source, termios.TCSADRAIN, self._before)

    def draw(self, state: str) -> None:
        """Show what has changed; on a terminal with help and a line of state below."""
        shown = frame(self._lathe, marks=self.single_keys)
        if self.single_keys:
            # A line that the terminal wraps would not be drawn over.
            width = shutil.get_terminal_size().columns - 1
            shown += [line[:width] for line in (*HELP, state)]
        if shown == self._drawn:
            return
        self._wipe()
        print("\n".join(shown), file=self._target, flush=True)
        self._drawn = shown

    def say(self, text: str) -> None:
        """Print something else, above the frame."""
        self._wipe()
        self._drawn = []
        print(text, file=self._target, flush=True)

    def _wipe(self) -> None:
        if self.single_keys and self._drawn:
            print(f"\x1b[{len(self._drawn)}A\x1b[J", end="", file=self._target)
