# SPDX-License-Identifier: Apache-2.0
"""Join pieces, drawn in any order and direction, to the one chain that is the outline."""

import math
from collections.abc import Iterator, Sequence

from tornillo.dxf.curves import Point, Segment
from tornillo.dxf.paper import Mark, Paper, number
from tornillo.errors import DrawingError
from tornillo.language import _

SAME = 1e-6
SHOWN = 3
SNAP_ROOM = 1.05
NEAR = 20.0


class Ends:
    """Which ends of which segments meet: every end belongs to a node."""

    def __init__(self, segments: list[Segment], same: float) -> None:
        """Ends closer than `same` meet."""
        self.segments = segments
        self.places: list[Point] = []
        self.node_of: dict[tuple[int, int], int] = {}
        self.members: list[list[tuple[int, int]]] = []
        grid: dict[tuple[int, int], list[int]] = {}
        for index, segment in enumerate(segments):
            for side, place in enumerate((segment.start, segment.end)):
                node = self._node_at(grid, place, same)
                self.node_of[index, side] = node
                self.members[node].append((index, side))

    def _node_at(self, grid: dict[tuple[int, int], list[int]], place: Point, same: float) -> int:
        """The node at `place`, a new one when there is none."""
        column, row = math.floor(place[0] / same), math.floor(place[1] / same)
        for x in (column - 1, column, column + 1):
            for y in (row - 1, row, row + 1):
                for node in grid.get((x, y), ()):
                    if math.dist(self.places[node], place) <= same:
                        return node
        self.places.append(place)
        self.members.append([])
        grid.setdefault((column, row), []).append(len(self.places) - 1)
        return len(self.places) - 1

    def loose(self) -> list[int]:
        """The nodes where only one segment ends."""
        return [node for node, members in enumerate(self.members) if len(members) == 1]

    def merge(self, keep: int, drop: int) -> None:
        """Bring two nodes together, halfway."""
        (x0, y0), (x1, y1) = self.places[keep], self.places[drop]
        self.places[keep] = (x0 + x1) / 2, (y0 + y1) / 2
        for member in self.members[drop]:
            self.node_of[member] = keep
        self.members[keep] += self.members[drop]
        self.members[drop] = []

    def nodes(self, index: int) -> tuple[int, int]:
        """The nodes of start and end of a segment."""
        return self.node_of[index, 0], self.node_of[index, 1]


def without_copies(segments: Sequence[Segment], snap: float) -> list[Segment]:
    """The segments that do not lie on another one, and are longer than nothing."""
    kept: list[Segment] = []
    for segment in sorted(segments, key=lambda piece: -piece.length):
        if segment.length <= SAME * snap:
            continue
        covered = segment.length > 2 * snap and any(
            all(other.distance(place) <= snap for place in segment.samples()) for other in kept
        )
        if not covered:
            kept.append(segment)
    return kept


def join(segments: Sequence[Segment], paper: Paper) -> list[Segment]:
    """The chain through all `segments`; a closed figure ends where it starts.

    Raises DrawingError where it branches or breaks.
    """
    ends = Ends(without_copies(segments, paper.snap), SAME * max(1.0, paper.snap))
    _snap_loose_ends(ends, paper)
    for node, members in enumerate(ends.members):
        if len(members) > 2:
            raise _branch(ends, node, paper)
    chains = list(_chains(ends))
    if len(chains) > 1:
        raise _broken(chains, paper)
    return chains[0]


def _snap_loose_ends(ends: Ends, paper: Paper) -> None:
    """Bring loose ends together that are not farther apart than the snap, nearest first."""
    loose = sorted(ends.loose(), key=lambda node: ends.places[node])
    pairs = []
    for index, first in enumerate(loose):
        for second in loose[index + 1 :]:
            if ends.places[second][0] - ends.places[first][0] > paper.snap:
                break
            gap = math.dist(ends.places[first], ends.places[second])
            if gap <= paper.snap:
                pairs.append((gap, first, second))
    for _gap, first, second in sorted(pairs):
        alone = len(ends.members[first]) == len(ends.members[second]) == 1
        if alone and ends.members[first][0][0] != ends.members[second][0][0]:
            ends.merge(first, second)


def _chains(ends: Ends) -> Iterator[list[Segment]]:
    """Every chain; open ones first."""
    used: set[int] = set()
    for node in (*ends.loose(), *range(len(ends.members))):
        for index, side in ends.members[node]:
            if index not in used:
                yield list(_walk(ends, index, side, used))


def _walk(ends: Ends, index: int, side: int, used: set[int]) -> Iterator[Segment]:
    """The segments from one end on, in order and direction, moved to their nodes."""
    while index not in used:
        used.add(index)
        start, end = ends.node_of[index, side], ends.node_of[index, 1 - side]
        segment = ends.segments[index]
        forward = segment.reversed() if side else segment
        yield forward.moved(ends.places[start], ends.places[end])
        following = [member for member in ends.members[end] if member[0] not in used]
        if not following:
            return
        index, side = following[0]


def _branch(ends: Ends, node: int, paper: Paper) -> DrawingError:
    """The refusal of a place where more than two pieces meet."""
    names = [str(ends.segments[index].origin) for index, _side in ends.members[node]]
    place = ends.places[node]
    return DrawingError(
        _("{file}: the outline branches at {place}: {names} pieces meet there: {names2}").format(
            file=paper.file, place=paper.show(place), names=len(names), names2=_listed(names)
        ),
        _("leave only the outline: take its layer with --layer, or delete inner lines"),
        (paper.mark(place, _("{names} pieces meet").format(names=len(names))),),
    )


def _broken(chains: list[list[Segment]], paper: Paper) -> DrawingError:
    """The refusal of an outline in several parts, with the nearest ends."""
    gaps = sorted(_gaps(chains), key=lambda gap: gap[0])
    if not gaps:
        return _separate(chains, paper)
    lines, marks = [], []
    for distance, (first, one), (second, other) in gaps[:SHOWN]:
        lines.append(
            _("{distance} are missing between {first} ({origin}) and {second} ({origin2})").format(
                distance=paper.length(distance),
                first=paper.show(first),
                origin=one.origin,
                second=paper.show(second),
                origin2=other.origin,
            )
        )
        marks += [
            paper.mark(first, _("gap of {distance}").format(distance=paper.length(distance))),
            paper.mark(second, ""),
        ]
    smallest = gaps[0][0]
    remedy = _("draw what is missing, or choose the outline's layer with --layer")
    if smallest <= NEAR * paper.snap:
        wanted = number(SNAP_ROOM * gaps[0][0] * paper.factor, 6)
        remedy = _("join the ends in the drawing, or bridge them with --snap {wanted}").format(
            wanted=wanted
        )
    count = len(chains)
    return DrawingError(
        _("{file}: the outline breaks into {count} parts: {lines}").format(
            file=paper.file, count=count, lines="; ".join(lines)
        ),
        remedy,
        tuple(marks),
    )


def _gaps(
    chains: list[list[Segment]],
) -> Iterator[tuple[float, tuple[Point, Segment], tuple[Point, Segment]]]:
    """For every open chain its nearest open end of another one."""
    ends = [
        ((chain[0].start, chain[0]), (chain[-1].end, chain[-1]))
        for chain in chains
        if chain[0].start != chain[-1].end
    ]
    for index, mine in enumerate(ends):
        others = [end for pair in ends[index + 1 :] for end in pair]
        if others:
            yield min(
                ((math.dist(one[0], other[0]), one, other) for one in mine for other in others),
                key=lambda gap: gap[0],
            )


def _separate(chains: list[list[Segment]], paper: Paper) -> DrawingError:
    """The refusal of a closed figure beside the outline."""
    shortest = min(chains, key=lambda chain: sum(piece.length for piece in chain))
    first = shortest[0]
    marks: tuple[Mark, ...] = (paper.mark(first.point(0.5), _("a separate figure")),)
    return DrawingError(
        _("{file}: {chains} separate figures are drawn; one of them is {origin} at {start}").format(
            file=paper.file, chains=len(chains), origin=first.origin, start=paper.show(first.start)
        ),
        _("choose the outline's layer with --layer, or delete the other figures"),
        marks,
    )


def _listed(names: list[str]) -> str:
    """Names for a sentence, not too many."""
    shown = (
        names
        if len(names) <= SHOWN + 1
        else [*names[:SHOWN], _("{names} more").format(names=len(names) - SHOWN)]
    )
    return ", ".join(shown)
