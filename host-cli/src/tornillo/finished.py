# SPDX-License-Identifier: Apache-2.0
"""The finished part around an operation: what the nose of its tool must not touch.

A contour ends where another one begins, in front of a shoulder, or in the air. For a round nose
that makes a difference: it has to stop before it cuts into what is next.
"""

import math
from collections.abc import Iterable
from typing import NamedTuple

from tornillo.contour import Element, Line, Point, distance
from tornillo.operations import Contour, Operation, Plunge

#: File units: how near two ends are when they are the same.
TOUCHING = 1e-5
BESIDE = 1e-4
FAR = 1e3


class Around(NamedTuple):
    """What is in front of a contour and behind it, None for nothing that matters.

    `lowest`: the radius below which the approach would cut into what is in front. `level`: the
    tool may come level from the front, up to where the contour starts.
    """

    before: Element | None
    after: Element | None
    lowest: float
    level: bool


class FinishedPart:
    """All operations of a part together, in file units."""

    def __init__(self, operations: Iterable[Operation], stock_radius: float, front: float) -> None:
        """`front`: z of the raw front face; in front of z = 0 nothing of the part is left."""
        self._operations = tuple(operations)
        self._stock_radius = stock_radius
        self._front = min(front, BESIDE / 2)

    def height(self, z: float, but: Operation) -> float:
        """The radius that the operations other than `but` leave at `z`."""
        low = self._stock_radius if z <= self._front else 0.0
        for operation in self._operations:
            if operation is but:
                continue
            shape = operation.shape
            if isinstance(shape, Plunge):
                if shape.back <= z <= shape.front:
                    low = min(low, shape.diameter / 2)
            elif isinstance(shape, Contour):
                low = min(low, *self._heights(operation.type, shape, z), low)
        return low

    @staticmethod
    def _heights(kind: str, shape: Contour, z: float) -> list[float]:
        """The radii of a contour at `z`; a face clears all in front of it."""
        first = shape.elements[0].start
        if kind == "face" and z > first.z:
            return [first.x]
        heights = (element.height(z) for element in shape.elements)
        return [height for height in heights if height is not None]

    def around(self, operation: Operation) -> Around:
        """What is in front of the contour of `operation` and behind it."""
        assert isinstance(operation.shape, Contour)
        elements = operation.shape.elements
        start, end = elements[0].start, elements[-1].end
        front = self.height(start.z + BESIDE, operation)
        before = self._before(operation, start, front, elements[0])
        boss = before is None and TOUCHING < front < start.x - TOUCHING
        return Around(
            before,
            self._after(operation, end),
            front if boss else -math.inf,
            before is None or _level(before),
        )

    def free_front(self, operation: Operation) -> bool:
        """Whether all that is in front of a contour, and larger than its start, may go."""
        assert isinstance(operation.shape, Contour)
        start = operation.shape.elements[0].start
        if self.height(start.z + BESIDE, operation) > start.x + TOUCHING:
            return False
        for other in self._operations:
            if other is operation or other.type == "face" or not isinstance(other.shape, Contour):
                continue
            for element in other.shape.elements:
                for place in (element.start, element.end):
                    if place.z > start.z + TOUCHING and place.x > start.x + TOUCHING:
                        return False
        return True

    def _joined(self, but: Operation, place: Point, ends: bool) -> Element | None:
        """The piece of another contour that ends (or begins) in `place`."""
        for operation in self._operations:
            if operation is but or not isinstance(operation.shape, Contour):
                continue
            element = operation.shape.elements[-1 if ends else 0]
            if distance(element.end if ends else element.start, place) < TOUCHING:
                return element
        return None

    def _before(
        self, operation: Operation, start: Point, front: float, first: Element
    ) -> Element | None:
        """What the finished part has in front of a contour."""
        if start.x < TOUCHING:
            return None
        joined = self._joined(operation, start, ends=True)
        if joined is not None:
            return joined
        falls = first.direction(first.start).x < 0
        if front >= start.x - TOUCHING or falls:
            return Line(Point(start.z + FAR, start.x), start)
        return None

    def _after(self, operation: Operation, end: Point) -> Element | None:
        """What the finished part has behind a contour."""
        joined = self._joined(operation, end, ends=False)
        if joined is not None:
            return joined
        behind = self.height(end.z - BESIDE, operation)
        if behind > end.x + TOUCHING:
            return Line(end, Point(end.z, end.x + FAR))
        if behind > end.x - TOUCHING:
            return Line(end, Point(end.z - FAR, end.x))
        return None


def _level(element: Element) -> bool:
    """Whether a piece runs level."""
    return isinstance(element, Line) and abs(element.start.x - element.end.x) < TOUCHING
