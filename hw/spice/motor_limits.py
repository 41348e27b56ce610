# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Works out how fast the motors may start (pull-in) and run (pull-out).

The motor of the thesis came from scrap: 5 V, 200 steps, five wires, 0.294 N m
measured with two windings on, screw holes 33.2 mm from the shaft (so a 57 mm
frame). Its winding data are not known. Assumed: 5 ohm, 1 A and 3 mH a winding,
rotor and coupling 100 g cm2, friction of slide and screw 0.02 N m.

The model is the usual one of a hybrid motor with two phases: each phase is
driven by plus or minus the supply less the driver's loss, as two half windings
on one core are; its back-EMF and torque follow one sine of the rotor's angle.
A ballast resistor in the common wire counts twice, as both phases use it.

In the thesis' own circuit (5 V, TIP120) this gives less than the 1 ms a step
it reports, so the figures are on the careful side.
"""

from __future__ import annotations

import importlib
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

np: Any = importlib.import_module("numpy")

STEPS_PER_TURN = 200
STEP_ANGLE = 2 * np.pi / STEPS_PER_TURN
PARTS_OF_A_STEP = 100


@dataclass(frozen=True)
class Motor:
    """Motor, load and driver, in SI units."""

    supply: float = 5.0
    resistance: float = 5.0
    inductance: float = 3e-3
    holding_torque: float = 0.294
    rated_current: float = 1.0
    inertia: float = 1e-5
    friction: float = 0.02
    viscous: float = 1e-4
    driver_loss: float = 0.03

    @property
    def torque_constant(self) -> float:
        """N m for each ampere of one phase."""
        return self.holding_torque / (2**0.5 * self.rated_current)


def follows(motor: Motor, rates: Any, *, ramp_steps: int) -> Any:
    """Tell for each rate (steps/s) whether the rotor keeps up.

    With ramp_steps the rate rises from 200 steps/s to the final one in that
    many steps; 0 starts at the final rate at once. 100 more steps are run at
    the rate; keeping up means never being 2 steps behind.
    """
    signs = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]], dtype=float)
    teeth, constant = STEPS_PER_TURN // 4, motor.torque_constant
    drive = motor.supply - motor.driver_loss
    angle = np.zeros_like(rates)
    speed = np.zeros_like(rates)
    current = np.full((2, rates.size), drive / motor.resistance)
    good = np.ones(rates.size, dtype=bool)
    for step in range(ramp_steps + 100):
        share = min(1.0, step / ramp_steps) if ramp_steps else 1.0
        rate = 200.0 + (rates - 200.0) * share
        dt = 1.0 / (rate * PARTS_OF_A_STEP)
        sign = signs[(step + 1) % 4]
        for _ in range(PARTS_OF_A_STEP):
            electric = teeth * angle + np.pi / 4
            shape = np.array([-np.sin(electric), np.cos(electric)])
            push = sign[:, None] * drive - constant * speed * shape
            current += dt / motor.inductance * (push - motor.resistance * current)
            torque = constant * (current * shape).sum(axis=0)
            rubbing = motor.friction * np.tanh(speed / 0.5) + motor.viscous * speed
            speed = speed + dt / motor.inertia * (torque - rubbing)
            angle = angle + dt * speed
        good &= np.abs(angle - (step + 1) * STEP_ANGLE) < 2.0 * STEP_ANGLE
    return good


def highest(motor: Motor, *, ramp_steps: int, top: int = 2600) -> int:
    """Return the highest rate, in steps of 25, up to which every rate works."""
    rates = np.arange(200.0, top, 25.0)
    good = follows(motor, rates, ramp_steps=ramp_steps)
    return int(rates[good.size - 1 if good.all() else max(0, int(np.argmin(good)) - 1)])


def limits() -> dict[str, Any]:
    """Return the figures for motor_limits.json; the board's own build comes first."""
    motor = Motor()
    fitted = replace(motor, supply=12.0, resistance=5.0 + 2 * 3.3)
    drivers = {
        "12 V, ballast 3.3 ohm, MOSFET": fitted,
        "the same, 10 mH a winding": replace(fitted, inductance=1e-2),
        "the same, friction 0.06 N m": replace(fitted, friction=0.06),
        "5 V, MOSFET": motor,
        "5 V, TIP120 as in the thesis": replace(motor, driver_loss=0.8),
    }
    speeds = {
        name: {"pull_in": highest(each, ramp_steps=0), "pull_out": highest(each, ramp_steps=400)}
        for name, each in drivers.items()
    }
    chosen = next(iter(speeds.values()))
    return {
        "pull_in_steps_per_s": chosen["pull_in"],
        "pull_out_steps_per_s": chosen["pull_out"],
        "assumed": {
            "inductance_h": motor.inductance,
            "resistance_ohm": motor.resistance,
            "holding_torque_nm": motor.holding_torque,
            "inertia_kg_m2": motor.inertia,
            "friction_nm": motor.friction,
        },
        "by_driver": speeds,
    }


def text() -> str:
    """Return the contents of motor_limits.json."""
    return json.dumps(limits(), indent=2) + "\n"


def committed() -> Path:
    """Return the path of the file the virtual lathe reads."""
    return Path(__file__).resolve().parent / "motor_limits.json"
