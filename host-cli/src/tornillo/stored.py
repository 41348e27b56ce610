# SPDX-License-Identifier: Apache-2.0
"""What the chip tells about a stored part."""

from dataclasses import dataclass

from tornillo.protocol import PART_UNIT, PartInfoData

UNIT_HEADER = 64  # bytes in the first unit of a part


def units_of(length: int) -> int:
    """Units of the store that an image of `length` bytes takes."""
    return -(-(length + UNIT_HEADER) // PART_UNIT)


@dataclass(frozen=True)
class StoredPart:
    """One part in the store; `slot` is its first unit.

    `generation` grows with every stored part; `length` in bytes; `crc` of the image.
    """

    slot: int
    name: str
    selected: bool
    generation: int
    length: int
    crc: int
    operations: int

    @property
    def units(self) -> int:
        """Units of the store that the part takes."""
        return units_of(self.length)

    @classmethod
    def from_info(cls, slot: int, info: PartInfoData) -> "StoredPart":
        """Name the numbers of PART_INFO."""
        return cls(
            slot=slot,
            name=info.name.rstrip(b"\0").decode("ascii", "replace"),
            selected=bool(info.selected),
            generation=info.generation,
            length=info.length,
            crc=info.crc,
            operations=info.operations,
        )
