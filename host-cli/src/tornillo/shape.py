# SPDX-License-Identifier: Apache-2.0
"""What is left of the stock after each operation, and the passes in between, in steps.

For drawings only: the chip computes its own passes, by the same rule.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from tornillo.image import Operation, PartImage
from tornillo.protocol import CylinderRecord, FaceRecord


class Section(NamedTuple):
    """A length of one radius, `z_front` > `z_back`."""

    z_front: int
    z_back: int
    radius: int


class Pass(NamedTuple):
    """One stroke of the tool, from where it starts to cut to where it ends."""

    operation: int
    finishing: bool
    start: tuple[int, int]
    end: tuple[int, int]


class Shape:
    """The turned part as sections from the free end to the chuck."""

    def __init__(self, image: PartImage) -> None:
        """Start with the raw stock of `image`."""
        header = image.header
        self.sections = [Section(header.stock_front, -header.stock_length, header.stock_radius)]

    def cut(self, operation: Operation) -> None:
        """Take away what `operation` cuts."""
        if isinstance(operation, CylinderRecord):
            self._cut(operation.z_start, operation.z_end, operation.x)
        else:
            self._cut(self.sections[0].z_front, operation.z, operation.x_inner)

    def _cut(self, front: int, back: int, radius: int) -> None:
        """No more than `radius` is left between `front` and `back`."""
        pieces: list[Section] = []
        for section in self.sections:
            edges = sorted({section.z_front, section.z_back, front, back}, reverse=True)
            inside = [z for z in edges if section.z_back <= z <= section.z_front]
            for z_front, z_back in pairwise(inside):
                is_cut = back <= z_back and z_front <= front
                left = min(section.radius, radius) if is_cut else section.radius
                pieces.append(Section(z_front, z_back, left))
        self.sections = [piece for piece in _joined(pieces) if piece.radius > 0]

    def largest(self, front: int, back: int) -> int:
        """The largest radius between `front` and `back`."""
        return max(
            (
                piece.radius
                for piece in self.sections
                if piece.z_back < front > back < piece.z_front
            ),
            default=0,
        )

    def in_material(self, front: int, radius: int) -> int:
        """Where a stroke at `radius` towards the chuck, begun at `front`, meets material."""
        higher = (piece.z_front for piece in self.sections if piece.radius > radius)
        return min(front, next(higher, front))


def _joined(pieces: list[Section]) -> Iterator[Section]:
    """Neighbours of the same radius as one."""
    held: Section | None = None
    for piece in pieces:
        if held is not None and held.radius == piece.radius:
            held = Section(held.z_front, piece.z_back, held.radius)
            continue
        if held is not None:
            yield held
        held = piece
    if held is not None:
        yield held


def finished(image: PartImage) -> list[Section]:
    """The part after all operations."""
    shape = Shape(image)
    for operation in image.operations:
        shape.cut(operation)
    return shape.sections


def passes(image: PartImage) -> list[Pass]:
    """Every pass of the part in the order of cutting."""
    shape = Shape(image)
    found: list[Pass] = []
    for position, operation in enumerate(image.operations, start=1):
        if isinstance(operation, CylinderRecord):
            found += _cylinder_passes(image, shape, position, operation)
        else:
            found += _face_passes(image, shape, position, operation)
        shape.cut(operation)
    return found


def levels(outside: int, size: int, depth: int, allowance: int) -> Iterator[tuple[bool, int]]:
    """(finishing, position) of each pass from `outside` to `size`, spread evenly."""
    total = outside - size - allowance
    count = -(-total // depth) if total > 0 else 0
    for number in range(1, count + 1):
        yield False, outside - total * number // count
    if allowance and outside > size:
        yield True, size


def _cylinder_passes(
    image: PartImage, shape: Shape, position: int, operation: CylinderRecord
) -> Iterator[Pass]:
    """Strokes along Z."""
    header = image.header
    outside = shape.largest(operation.z_start, operation.z_end)
    for finishing, x in levels(outside, operation.x, header.depth_of_cut, header.finish_allowance):
        start = shape.in_material(operation.z_start, x)
        yield Pass(position, finishing, (start, x), (operation.z_end, x))


def _face_passes(
    image: PartImage, shape: Shape, position: int, operation: FaceRecord
) -> Iterator[Pass]:
    """Strokes along X; a face has no finishing pass."""
    front = shape.sections[0].z_front if shape.sections else operation.z
    for finishing, z in levels(front, operation.z, image.header.depth_of_cut, 0):
        outside = shape.largest(front, z)
        yield Pass(position, finishing, (z, outside), (z, operation.x_inner))
