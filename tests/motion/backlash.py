# SPDX-License-Identifier: Apache-2.0
"""A screw with play: where the tool is when the screw has turned so far."""

from __future__ import annotations

from collections.abc import Sequence

from .reference import Point


def carried(turns: Sequence[int], dead: int, slack: int) -> list[int]:
    """Places of a slide, beginning with 0, while its screw makes the given steps.

    ``slack`` is screw less slide at the beginning: 0 when the screw pushes towards plus, -dead
    when it pulls towards minus.
    """
    place = 0
    places = [place]
    for turn in turns:
        slack += turn
        if slack > 0:
            place, slack = place + slack, 0
        elif slack < -dead:
            place, slack = place + slack + dead, -dead
        places.append(place)
    return places


def tool_points(moves: Sequence[Point], dead: Point, slack: Point) -> list[Point]:
    """Places of the tool, beginning with (0, 0), for steps of both screws."""
    return list(
        zip(
            carried([move[0] for move in moves], dead[0], slack[0]),
            carried([move[1] for move in moves], dead[1], slack[1]),
            strict=True,
        )
    )
