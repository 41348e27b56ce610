# SPDX-License-Identifier: Apache-2.0
"""Lengths and feeds of a part file in steps of a machine, and back.

Diameters become radius steps of X. Feeds are per minute along the path, counted in steps of Z.
All conversions round to the nearest step.
"""

from dataclasses import dataclass

from tornillo.language import _
from tornillo.machine import Machine
from tornillo.protocol import FEED_UNIT

NM_PER_UNIT = {"mm": 1_000_000, "inch": 25_400_000}
DECIMALS = {"mm": 2, "inch": 3}
SECONDS_PER_MINUTE = 60


@dataclass(frozen=True)
class Scale:
    """The units of a part file on one machine."""

    units: str
    machine: Machine

    def radius_steps(self, diameter: float) -> int:
        """X steps from the axis for a diameter."""
        return self.x_steps(diameter / 2)

    def x_steps(self, length: float) -> int:
        """A length across in steps."""
        return round(length * NM_PER_UNIT[self.units] / self.machine.step_x_nm)

    def z_steps(self, length: float) -> int:
        """A length along in steps."""
        return round(length * NM_PER_UNIT[self.units] / self.machine.step_z_nm)

    def feed(self, per_minute: float) -> int:
        """A feed in 1/8 step/s."""
        steps_per_second = per_minute * NM_PER_UNIT[self.units] / self.machine.step_z_nm
        return round(steps_per_second * FEED_UNIT / SECONDS_PER_MINUTE)

    def diameter(self, radius_steps: int) -> float:
        """The diameter of a radius in steps."""
        return 2 * radius_steps * self.machine.step_x_nm / NM_PER_UNIT[self.units]

    def length(self, z_steps: int) -> float:
        """A length along from steps."""
        return z_steps * self.machine.step_z_nm / NM_PER_UNIT[self.units]

    def per_minute(self, feed: int) -> float:
        """A feed in units per minute from 1/8 step/s."""
        per_second = feed * self.machine.step_z_nm / NM_PER_UNIT[self.units] / FEED_UNIT
        return per_second * SECONDS_PER_MINUTE

    def show(self, value: float) -> str:
        """A length with its unit, about as precise as a step."""
        return f"{value:.{DECIMALS[self.units]}f} {self.units}"

    def show_diameter(self, radius_steps: int) -> str:
        """A radius in steps as a diameter with its unit."""
        return _("diameter {radius_steps}").format(
            radius_steps=self.show(self.diameter(radius_steps))
        )

    def show_z(self, z_steps: int) -> str:
        """A position along in words."""
        return f"z = {self.show(self.length(z_steps))}"

    def show_feed(self, feed: int) -> str:
        """A feed with its unit."""
        return f"{self.per_minute(feed):.3g} {self.units}/min"
