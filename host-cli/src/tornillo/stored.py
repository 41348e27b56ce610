# SPDX-License-Identifier: Apache-2.0
"""What the chip tells about a stored part."""

from dataclasses import dataclass

from tornillo.protocol import PartInfoData


@dataclass(frozen=True)
class StoredPart:
    """One slot of the part store.

    `generation` grows with every stored part; `length` in bytes; `crc` of the image.
    """

    slot: int
    name: str
    selected: bool
    generation: int
    length: int
    crc: int
    operations: int

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
