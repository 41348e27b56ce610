# SPDX-License-Identifier: Apache-2.0
"""The bar as columns of metal, and what a tool could make of a surface; see native/metal.cc."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from .native_library import CutC, PathC, library
from .shape import Point
from .tool import Tool

PER_STEP = 16


@dataclass(frozen=True)
class Removal:
    """What a move has cut.

    ``reach`` is how far above the tip the highest metal was (steps); ``severed`` the column in
    front of which the bar fell off, if it did.
    """

    reach: float
    severed: int | None


class Metal:
    """A bar of a radius (steps) between two whole z, with a column every 1/16 step."""

    def __init__(self, radius: float, first_z: int, last_z: int, tool: Tool) -> None:
        """Put the bar into the chuck and the tool into the holder."""
        self._native = library()
        self._bar = self._native.vl_metal_new(radius, first_z, last_z)
        self._path, self._cut = PathC(), CutC()
        self.count = (last_z - first_z) * PER_STEP + 1
        self.set_tool(tool)

    def connect_probe(self, zero_x: float, zero_z: float) -> None:
        """Put the contact sensor between the bar and the tool.

        ``zero_x`` and ``zero_z`` are the slides' places (full steps) with the tip at (0, 0).
        """
        self._native.vl_probe_attach(self._bar, zero_x, zero_z)

    def look_for_contact(self) -> None:
        """Set the contact sensor anew after the metal has changed."""
        self._native.vl_probe_look()

    def set_tool(self, tool: Tool) -> None:
        """Cut with this tool from now on."""
        self._native.vl_metal_tool(self._bar, ctypes.byref(tool.native()))

    def move(self, start: Point, end: Point, trial: bool = False) -> Removal | None:
        """Move the tip on a line; None if nothing was in its way. A trial removes nothing."""
        path, cut = self._path, self._cut
        path.x_from, path.z_from, path.x_to, path.z_to = start.x, start.z, end.x, end.z
        self._native.vl_metal_move(self._bar, path, int(trial), cut)
        if cut.columns == 0:
            return None
        return Removal(cut.reach, cut.fallen if cut.fallen >= 0 else None)

    def radius(self, column: int) -> float:
        """Return the radius of a column in steps."""
        return float(self._native.vl_metal_radius(self._bar, column))

    def radii(self) -> list[float]:
        """Return the radii of all columns, from the chuck to the front."""
        room = (ctypes.c_double * self.count)()
        self._native.vl_metal_radii(self._bar, room, self.count)
        return list(room)

    def fallen(self) -> list[float]:
        """Return the radii of the piece that fell off last."""
        room = (ctypes.c_double * self.count)()
        return list(room[: self._native.vl_metal_fallen(self._bar, room, self.count)])


def reachable(tool: Tool, wanted: Sequence[float], per_step: int) -> list[float]:
    """Return the lowest surface the tool can cut without going below the wanted one."""
    count = len(wanted)
    given, reached = (ctypes.c_double * count)(*wanted), (ctypes.c_double * count)()
    library().vl_reach(ctypes.byref(tool.native()), given, reached, count, per_step)
    return list(reached)


def heights_above(
    surface: Sequence[float], per_step: int, places: Iterable[tuple[int, float]]
) -> Iterator[float]:
    """Yield how far each place (column, radius) stands above a surface, in steps.

    The distance is that to the nearest point of the surface; where it is infinite there is none.
    """
    count = len(surface)
    given = (ctypes.c_double * count)(*surface)
    for column, radius in places:
        yield float(library().vl_above(given, count, per_step, column, radius))
