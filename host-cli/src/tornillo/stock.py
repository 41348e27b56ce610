# SPDX-License-Identifier: Apache-2.0
"""The raw material of a part."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Stock:
    """Raw material in file units.

    `length` is free in front of the chuck, counted from the finished face; `allowance` is raw
    material in front of that face.
    """

    diameter: float
    length: float
    allowance: float
