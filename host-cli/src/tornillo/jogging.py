# SPDX-License-Identifier: Apache-2.0
"""Moving the slides by keys: what each key means, and the dead-man behind it.

A terminal repeats a key that is held down and never tells that it was released. So a move goes
on as long as the repeats come; RELEASED_S after the last one it is held. When the link is lost
the chip brakes by itself, because it hears no more questions. Both together with the way to
brake stay below STOPPED_WITHIN_S.
"""

import time
from collections.abc import Callable
from typing import Protocol

from tornillo.language import _
from tornillo.protocol import Axis
from tornillo.status import Status
from tornillo.units import NM_PER_UNIT, SECONDS_PER_MINUTE, Scale

#: From the last sign of a held key to the request to hold, in seconds. Terminals repeat keys
#: every 25 to 40 ms, macOS every 90.
RELEASED_S = 0.1
#: For so long the chip goes on without hearing of us, in milliseconds: three looks of the screen.
SILENCE_MS = 100
#: From the release of the key, or the loss of the link, to the stand, in seconds.
STOPPED_WITHIN_S = 0.2
#: What drawing the screen, one question and one answer may add, in seconds.
LATE_S = 0.025
MS_LEAST, MS_MOST = 1, 255
SPEEDS_MS = (1, 2, 3, 5, 8, 10, 15, 20, 30, 50, 80, 100, 150, 200, 255)
#: Step sizes that a key chooses, in units; 0 is one step of the motor.
SIZES = {"mm": (0.0, 0.01, 0.1, 1.0, 10.0), "inch": (0.0, 0.001, 0.01, 0.1, 0.5)}
#: Arrow keys: axis and direction. Left is towards the chuck, up away from the spindle axis.
ARROWS = {
    "left": (Axis.Z, -1),
    "right": (Axis.Z, 1),
    "up": (Axis.X, 1),
    "down": (Axis.X, -1),
}
#: Where nothing is known of the place: farther than any slide; releasing the key ends the way.
FAR_STEPS = 32000


class Mover(Protocol):
    """What moves; `tornillo.Lathe` does."""

    def jog(self, axis: Axis, steps: int, rate: int = 0, patience_ms: int = 0) -> None:
        """Move `axis` by `steps` at `rate` step/s, as long as the chip hears of us."""

    def hold(self) -> None:
        """Brake and stand."""

    def status(self) -> Status:
        """Where the tool is; also the sign of life that the chip waits for."""


def fastest(start: int, acceleration: int) -> int:
    """The rate, step/s, from which the axes brake in what the dead-man leaves of 200 ms."""
    braking_s = STOPPED_WITHIN_S - RELEASED_S - LATE_S
    return int(start + acceleration * braking_s)


class JogPad:
    """Keys to moves. `rapid` and `most` are rates in step/s: the rapid one, and the most allowed.

    `message` is what the person should know about the last key.
    """

    def __init__(
        self,
        mover: Mover,
        scale: Scale,
        rapid: int,
        most: int,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        """Begin with single steps at 10 ms each; `now` tells the time in seconds."""
        self.mover = mover
        self._now = now
        self._last = 0.0
        self.scale = scale
        self._rapid, self._most = min(rapid, most), most
        self.ms_per_step = 10
        self.rapid = False
        self.continuous = False
        self.size = 0
        self.entry = ""
        self.message = ""
        self._held: tuple[Axis, int] | None = None
        self._actions: dict[str, Callable[[], str]] = {
            "+": lambda: self._speed(-1),
            "-": lambda: self._speed(1),
            "r": self._toggle_rapid,
            "c": self._toggle_continuous,
            "s": self._next_size,
            "enter": self._enter_ms,
            "m": self._enter_per_minute,
            " ": self._stop,
        }

    @property
    def rate(self) -> int:
        """The rate of the next move, step/s."""
        wanted = self._rapid if self.rapid else 1000 // self.ms_per_step
        return max(1, min(wanted, self._most))

    @property
    def per_minute(self) -> float:
        """The same as units per minute, of Z."""
        return self.scale.length(self.rate) * SECONDS_PER_MINUTE

    def steps(self, axis: Axis) -> int:
        """The chosen step size in steps of `axis`, at least one."""
        size = SIZES[self.scale.units][self.size]
        to_steps = self.scale.x_steps if axis is Axis.X else self.scale.z_steps
        return max(1, to_steps(size))

    def press(self, key: str, status: Status) -> None:
        """Do what a key means; any key but a held arrow ends a continuous move."""
        if key in ARROWS:
            self._arrow(*ARROWS[key], status)
            return
        if self._held is not None and key != " ":
            self._stop()
        if key.isdigit():
            self.entry = (self.entry + key)[-5:]
            self.message = ""
        elif key in self._actions:
            self.message = self._actions[key]()

    @property
    def patience_s(self) -> float:
        """How long to wait for the next key before `idle` must be called, at most."""
        if self._held is None:
            return RELEASED_S
        return max(0.0, self._last + RELEASED_S - self._now())

    def idle(self) -> None:
        """No key came: a held one may have been released."""
        if self._held is not None and self.patience_s == 0:
            self._stop()

    def _arrow(self, axis: Axis, sign: int, status: Status) -> None:
        """Move, or go on moving."""
        self.message = ""
        if self.continuous:
            self._last = self._now()
            if self._held == (axis, sign):
                return
            if self._held is not None:
                self._stop()
                return
            self._held = (axis, sign)
            steps = self._way(axis, sign, status)
        elif status.moving:
            return  # a repeat of the key while its step is being made
        else:
            steps = sign * self.steps(axis)
        if steps:
            self.mover.jog(axis, steps, self.rate, SILENCE_MS)

    def _way(self, axis: Axis, sign: int, status: Status) -> int:
        """Steps to the end of the travel, where it is known."""
        if not status.homed:
            return sign * FAR_STEPS
        machine = self.scale.machine
        here = status.x if axis is Axis.X else status.z
        least = -machine.travel_x if axis is Axis.X else -machine.travel_z
        return -here if sign > 0 else least - here

    def _stop(self) -> str:
        """Brake now."""
        self._held = None
        self.mover.hold()
        return _("stopped")

    def _speed(self, by: int) -> str:
        """The next faster or slower speed."""
        self.rapid = False
        nearest = min(SPEEDS_MS, key=lambda ms: abs(ms - self.ms_per_step))
        at = SPEEDS_MS.index(nearest) + by
        self.ms_per_step = SPEEDS_MS[min(max(at, 0), len(SPEEDS_MS) - 1)]
        return ""

    def _toggle_rapid(self) -> str:
        """Rapid on or off."""
        self.rapid = not self.rapid
        return ""

    def _toggle_continuous(self) -> str:
        """Steps by size, or as long as a key is held."""
        self.continuous = not self.continuous
        return ""

    def _next_size(self) -> str:
        """The next step size."""
        self.size = (self.size + 1) % len(SIZES[self.scale.units])
        return ""

    def _enter_ms(self) -> str:
        """Take the typed number as milliseconds a step."""
        typed, self.entry = self.entry, ""
        if not typed or not MS_LEAST <= int(typed) <= MS_MOST:
            return _("type {least} to {most} milliseconds a step, then Enter").format(
                least=MS_LEAST, most=MS_MOST
            )
        self.ms_per_step, self.rapid = int(typed), False
        return ""

    def _enter_per_minute(self) -> str:
        """Take the typed number as units a minute."""
        typed, self.entry = self.entry, ""
        step = self.scale.machine.step_z_nm / NM_PER_UNIT[self.scale.units]
        wanted = int(typed or 0)
        milliseconds = round(SECONDS_PER_MINUTE * 1000 * step / wanted) if wanted else 0
        if not MS_LEAST <= milliseconds <= MS_MOST:
            slow, fast = (60_000 * step / ms for ms in (MS_MOST, MS_LEAST))
            return _("type {slow:.3g} to {fast:.3g} {units}/min, then m").format(
                slow=slow, fast=fast, units=self.scale.units
            )
        self.ms_per_step, self.rapid = milliseconds, False
        return ""
