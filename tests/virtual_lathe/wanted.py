# SPDX-License-Identifier: Apache-2.0
"""A wanted part: its operations, its tools, and the surface that they shall leave.

Everything is in steps. What can be cut is rounded to the nearest step; what the drawing says stays
exact beside it (``Nominal``, the chains of ``Turned``), so that an error includes the rounding. At
a shoulder a step of Z belongs to the smaller radius.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from .contour import Contour, Cut
from .shape import Line, Point, Segment
from .tool import BROAD, RIGHT_HAND, Tool


@dataclass(frozen=True)
class Nominal:
    """What the drawing says, in steps: radius of a cylinder, and its length or a face's z.

    ``start`` is the z at which a cylinder begins, if that is not a whole step.
    """

    radius: float
    length: float
    start: float | None = None


@dataclass(frozen=True)
class Face:
    """Flat end at ``z``, cut from outside down to radius ``inner`` (steps)."""

    z: int
    inner: int
    nominal: Nominal | None = None
    tool: str = ""

    @property
    def drawn(self) -> Nominal:
        """What the drawing says; whole steps when there is no drawing."""
        return self.nominal or Nominal(self.inner, self.z)

    def cuts(self, front: float, exact: bool) -> Iterator[Segment]:
        """Yield what it cuts down to: everything in front of it."""
        z, inner = (self.drawn.length, self.drawn.radius) if exact else (self.z, self.inner)
        yield Line(Point(front, inner), Point(z, inner))


@dataclass(frozen=True)
class Cylinder:
    """Radius ``radius`` from ``start`` down to ``end`` (steps)."""

    start: int
    end: int
    radius: int
    nominal: Nominal | None = None
    tool: str = ""

    @property
    def drawn(self) -> Nominal:
        """What the drawing says; whole steps when there is no drawing."""
        return self.nominal or Nominal(self.radius, self.start - self.end)

    def cuts(self, _front: float, exact: bool) -> Iterator[Segment]:
        """Yield what it cuts down to."""
        start, end, radius = float(self.start), float(self.end), float(self.radius)
        if exact:
            start = start if self.drawn.start is None else self.drawn.start
            end, radius = start - self.drawn.length, self.drawn.radius
        yield Line(Point(start, radius), Point(end, radius))


@dataclass(frozen=True)
class Turned:
    """A cone, an arc or a profile: a chain towards the chuck, in exact steps.

    One that is roughed in facing direction clears everything in front of it too.
    """

    kind: str
    chain: tuple[Segment, ...]
    tool: str = ""
    facing: bool = False

    def cuts(self, front: float, exact: bool) -> Iterator[Segment]:
        """Yield what it cuts down to."""
        chain = self.chain if exact else tuple(segment.on_grid() for segment in self.chain)
        yield from chain
        if self.facing:
            start = chain[0].start
            yield Line(Point(front, start.x), start)


@dataclass(frozen=True)
class Groove:
    """A groove from ``start`` down to ``end`` with its bottom at a radius, in exact steps."""

    start: float
    end: float
    radius: float
    tool: str = ""

    def cuts(self, _front: float, exact: bool) -> Iterator[Segment]:
        """Yield what it cuts down to."""
        bottom = Line(Point(self.start, self.radius), Point(self.end, self.radius))
        yield bottom if exact else bottom.on_grid()


@dataclass(frozen=True)
class PartOff:
    """The end of the part at ``z``: a slit of the tool's ``width`` behind it, in exact steps."""

    z: float
    radius: float
    width: float
    tool: str = ""

    def cuts(self, _front: float, exact: bool) -> Iterator[Segment]:
        """Yield what it cuts down to."""
        bottom = Line(Point(self.z, self.radius), Point(self.z - self.width, self.radius))
        yield bottom if exact else bottom.on_grid()


@dataclass(frozen=True)
class Pause:
    """The machine waits: a message, or a hole to be drilled by hand."""

    message: str = ""
    tool: str = ""

    def cuts(self, _front: float, _exact: bool) -> Iterator[Segment]:
        """Yield nothing."""
        yield from ()


Operation = Face | Cylinder | Turned | Groove | PartOff | Pause


@dataclass(frozen=True)
class WantedPart:
    """A part in steps. ``front`` is the raw front face, ``length`` reaches to the chuck.

    ``operations`` are in the order in which they are cut.
    """

    stock_radius: int
    length: int
    front: int
    operations: tuple[Operation, ...]
    tools: dict[str, Tool] = field(default_factory=dict)

    def contour(self, exact: bool = False) -> Contour:
        """Return the wanted surface.

        Corners lie on the nearest whole steps, or ``exact`` where the drawing has them.
        """
        cuts = (
            Cut(segment, number)
            for number, operation in enumerate(self.operations)
            for segment in operation.cuts(self.front, exact)
        )
        return Contour(cuts, self.stock_radius, -self.length, self.front)

    def surface(self) -> dict[int, float]:
        """Return the wanted radius for every step of Z from the chuck to the raw front."""
        radii = self.contour().sample(1)
        return {z - self.length: radius for z, radius in enumerate(radii)}

    def tool_of(self, operation: Operation) -> Tool:
        """Return the tool that cuts an operation.

        A part that names no tool and has nothing but faces and cylinders is cut by a point with
        a broad body, any other one by a right-hand tool.

        Raises:
            ValueError: the part has no such tool.
        """
        if not self.tools:
            plain = all(isinstance(o, Face | Cylinder | Pause) for o in self.operations)
            return BROAD if plain else RIGHT_HAND
        if operation.tool and operation.tool not in self.tools:
            raise ValueError(f"the part has no tool {operation.tool!r}")
        return self.tools[operation.tool] if operation.tool else next(iter(self.tools.values()))

    def tool_order(self) -> list[Tool]:
        """Return the tools in the order in which they are put in, each change once."""
        order: list[Tool] = []
        for operation in self.operations:
            if isinstance(operation, Pause):
                continue
            tool = self.tool_of(operation)
            if not order or order[-1] != tool:
                order.append(tool)
        return order

    def parted_at(self) -> float | None:
        """Return the z at which the finished part falls off; None if it does not."""
        ends = [o.z for o in self.operations if isinstance(o, PartOff) and o.radius <= 0]
        return max(ends) if ends else None


def nearest_step(exact: float) -> int:
    """Return the nearest whole step, halves away from axis and chuck."""
    return math.floor(exact + 0.5)
