# SPDX-License-Identifier: Apache-2.0
"""The wanted shape, read from the part file without any code of the host program or firmware.

Lengths become steps by exact arithmetic. What can be cut is rounded to the nearest step; what the
drawing says stays exact beside it (``Nominal``), so that an error includes the rounding. The
surface is a radius for every step of Z; at a shoulder the step belongs to the smaller radius.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

NM = {"mm": 1_000_000, "inch": 25_400_000}


@dataclass(frozen=True)
class Nominal:
    """What the drawing says, in steps: radius of a cylinder, and its length or a face's z."""

    radius: float
    length: float


@dataclass(frozen=True)
class Face:
    """Flat end at ``z``, cut from outside down to radius ``inner`` (steps)."""

    z: int
    inner: int
    nominal: Nominal | None = None

    @property
    def drawn(self) -> Nominal:
        """What the drawing says; whole steps when there is no drawing."""
        return self.nominal or Nominal(self.inner, self.z)


@dataclass(frozen=True)
class Cylinder:
    """Radius ``radius`` from ``start`` down to ``end`` (steps)."""

    start: int
    end: int
    radius: int
    nominal: Nominal | None = None

    @property
    def drawn(self) -> Nominal:
        """What the drawing says; whole steps when there is no drawing."""
        return self.nominal or Nominal(self.radius, self.start - self.end)


@dataclass(frozen=True)
class WantedPart:
    """A part in steps. ``front`` is the raw front face, ``length`` reaches to the chuck."""

    stock_radius: int
    length: int
    front: int
    operations: tuple[Face | Cylinder, ...]

    def surface(self) -> dict[int, int]:
        """Return the wanted radius for every step of Z from the chuck to the raw front."""
        wanted = dict.fromkeys(range(-self.length, self.front + 1), self.stock_radius)
        for operation in self.operations:
            for z in wanted:
                if isinstance(operation, Face):
                    if z >= operation.z:
                        wanted[z] = min(wanted[z], operation.inner)
                elif operation.end <= z <= operation.start:
                    wanted[z] = min(wanted[z], operation.radius)
        return wanted


def _exact(value: Any, unit_nm: int, step_nm: int, half: bool = False) -> Fraction:
    return Fraction(value) * unit_nm / step_nm / (2 if half else 1)


def _steps(value: Any, unit_nm: int, step_nm: int, half: bool = False) -> int:
    exact = _exact(value, unit_nm, step_nm, half)
    return (2 * exact.numerator + exact.denominator) // (2 * exact.denominator)


def read_part(path: Path | str, step_x_nm: int = 7112, step_z_nm: int = 7112) -> WantedPart:
    """Read a part file.

    Raises:
        ValueError: the file holds an operation this model does not know.
        KeyError: something needed is missing.
    """
    with Path(path).open("rb") as file:
        table = tomllib.load(file, parse_float=Decimal)
    unit = NM[table["part"]["units"]]
    stock = table["stock"]
    operations: list[Face | Cylinder] = []
    for entry in table.get("operation", []):
        if entry["type"] == "face":
            inner = _steps(entry.get("diameter", 0), unit, step_x_nm, half=True)
            nominal = Nominal(0.0, float(_exact(entry["z"], unit, step_z_nm)))
            operations.append(Face(_steps(entry["z"], unit, step_z_nm), inner, nominal))
        elif entry["type"] == "cylinder":
            start, end = (_steps(z, unit, step_z_nm) for z in entry["z"])
            radius = _steps(entry["diameter"], unit, step_x_nm, half=True)
            nominal = Nominal(
                float(_exact(entry["diameter"], unit, step_x_nm, half=True)),
                float(_exact(entry["z"][0] - entry["z"][1], unit, step_z_nm)),
            )
            operations.append(Cylinder(start, end, radius, nominal))
        else:
            raise ValueError(f"operation {entry['type']!r} is not modelled here")
    return WantedPart(
        _steps(stock["diameter"], unit, step_x_nm, half=True),
        _steps(stock["length"], unit, step_z_nm),
        _steps(stock.get("allowance", 0), unit, step_z_nm),
        tuple(operations),
    )
