# SPDX-License-Identifier: Apache-2.0
"""Every move of a part, to the step, as the chip makes them.

plan = plan_part(image, machine)
plan.passes, plan.stops, plan.moves

Whole numbers only, and the same ones as on the chip: what `tornillo plan` and `tornillo draw`
show is what will be cut. docs/passes.md explains it with pictures.
"""

from collections.abc import Callable, Iterable, Iterator

from tornillo.image import PartImage, Record
from tornillo.language import _
from tornillo.machine import Machine
from tornillo.material import (
    FAR,
    Chain,
    Material,
    Stretch,
    contour_chain,
    interval,
    plunge_chain,
)
from tornillo.moves import Halt, Pass, Place, Plan, Role, Stop
from tornillo.protocol import ContourRecord, CutRecord, PauseRecord, PlungeRecord, ToolRecord
from tornillo.toolpath import Toolpath

#: Where the axes stand after homing and wait in a pause: steps from the switch.
PARK_STEPS = 20


def plan_part(image: PartImage, machine: Machine) -> Plan:
    """The plan of a valid `image` on `machine`; the tool starts at its parking place.

    Raises ValueError when the image has no tool, no cutting data, or segments of unknown kind.
    """
    parked = -PARK_STEPS - machine.zero_z, -PARK_STEPS - machine.zero_x
    return Plan(image, tuple(Planner(image, parked).steps()))


def spread(outside: int, size: int, depth: int) -> list[int]:
    """Levels from `outside` (not included) to `size` (included), evenly, none above `depth`."""
    if outside <= size:
        return []
    count = -(-(outside - size) // depth)
    step, more = divmod(outside - size, count)
    return [outside - step * k - min(k, more) for k in range(1, count + 1)]


def smallest(low: int, high: int, enough: Callable[[int], bool]) -> int:
    """The smallest number of `low` to `high` that is `enough`; `high` when none below it is."""
    while low < high:
        middle = (low + high) >> 1
        if enough(middle):
            high = middle
        else:
            low = middle + 1
    return low


class Planner:
    """Plans one record after the other; knows what earlier operations have left."""

    def __init__(self, image: PartImage, parked: Place) -> None:
        """Start with raw stock and the tool at the place where it parks, (z, x) in steps."""
        header = image.header
        self.image = image
        self.retract = header.retract
        self.material = Material(header.stock_radius, header.stock_front)
        self.park_z, self.park_x = parked
        self.path = Toolpath(self.park_z, self.park_x, header.stock_radius + header.retract)
        self.operation = 0
        self._tool: ToolRecord | None = None
        self._cut: CutRecord | None = None
        self._numbers = 0

    @property
    def tool(self) -> ToolRecord:
        """The tool in use; raises ValueError when there is none."""
        if self._tool is None:
            raise ValueError(_("the part has no tool"))
        return self._tool

    @property
    def cut(self) -> CutRecord:
        """The cutting data in use; raises ValueError when there are none."""
        if self._cut is None:
            raise ValueError(_("the part has no cutting data"))
        return self._cut

    def steps(self) -> Iterator[Pass | Stop]:
        """Every pass and stop of the part."""
        for record in self.image.records:
            yield from self.record(record)
        yield self._park(Halt.END, "")

    def record(self, record: Record) -> Iterator[Pass | Stop]:
        """What one record brings about."""
        if isinstance(record, ToolRecord):
            yield from self._change_tool(record)
            return
        if isinstance(record, CutRecord):
            self._cut = record
            return
        self.operation += 1
        self._numbers = 0
        self.path.begin_operation()
        if isinstance(record, PauseRecord):
            halt = Halt.DRILL if record.kind else Halt.PAUSE
            yield self._park(halt, record.message.decode("ascii", "replace"))
        elif isinstance(record, PlungeRecord):
            yield from self._plunge(record, self._chain(record))
        else:
            yield from self._contour(record, self._chain(record))
        self._cut_away(record)

    def suppose(self, records: Iterable[Record]) -> None:
        """Go on as after `records`, without their moves."""
        for record in records:
            if isinstance(record, ToolRecord):
                self._tool = record
            elif isinstance(record, CutRecord):
                self._cut = record
            else:
                self.operation += 1
                self._cut_away(record)

    def _chain(self, record: ContourRecord | PlungeRecord) -> Chain:
        """The contour of an operation."""
        if isinstance(record, PlungeRecord):
            return plunge_chain(record, self.tool.width)
        return contour_chain(record)

    def _cut_away(self, record: Record) -> None:
        """From now on what an operation cuts is gone."""
        if isinstance(record, ContourRecord | PlungeRecord):
            self.material.cut(self._chain(record))

    def _change_tool(self, record: ToolRecord) -> Iterator[Stop]:
        """Park for another tool; positions are then those of the new one."""
        if self._tool is not None:
            yield self._park(Halt.TOOL, record.name.rstrip(b"\0").decode("ascii", "replace"))
        offset_z, offset_x = (self._tool.offset_z, self._tool.offset_x) if self._tool else (0, 0)
        self.path.stand(
            self.path.z + offset_z - record.offset_z, self.path.x + offset_x - record.offset_x
        )
        self._tool = record

    def _park(self, halt: Halt, text: str) -> Stop:
        """X, then Z go to the parking place; X never into a stock that is thicker."""
        offset_z, offset_x = (self._tool.offset_z, self._tool.offset_x) if self._tool else (0, 0)
        self.path.rapid_x(max(self.park_x - offset_x, self.path.clear))
        self.path.rapid(self.park_z - offset_z, self.path.x)
        return Stop(self.operation, halt, text, self.path.take())

    def _pass(self, role: Role, depth: int) -> Pass:
        """The moves made since the last pass as one pass."""
        self._numbers += 1
        return Pass(self.operation, self._numbers, role, depth, self.path.take())

    def _allowance(self, chain: Chain) -> int:
        """What is left for finishing; a face has none."""
        vertical = chain.simple and chain.z == chain.z_end
        return 0 if vertical else self.cut.finish_allowance

    def _contour(self, record: ContourRecord, chain: Chain) -> Iterator[Pass]:
        """Roughing along Z or in facing direction, then along the contour; nothing in air."""
        allowance = self._allowance(chain)
        if chain.facing:
            front = self.material.stock_front
            top = self.material.highest(front, chain.z_end, self.tool.below)
            begin = self.material.free_end(chain.x, front)
            if begin <= chain.z_end:
                return
            yield from self._rough_facing(chain, top, begin, allowance)
        else:
            top = self.material.highest(chain.z, chain.z_end, self.tool.below)
            if top <= chain.lowest:
                return
            allowance = min(allowance, top - chain.lowest)
            yield from self._rough_along(chain, top, allowance)
        if not (chain.simple and allowance == 0):
            yield from self._along_contour(record, chain, top, allowance)

    def _rough_along(self, chain: Chain, top: int, allowance: int) -> Iterator[Pass]:
        """Passes parallel to Z, one pocket after the other.

        On the way to a stretch the tool stays above the levels that it has passed since the last
        cut, in which earlier operations may have left nothing to cut.
        """
        levels = [top, *spread(top, chain.lowest + allowance, self.cut.depth_of_cut)]
        passed = chain.lowest
        for number, stretch in pockets(chain, [level - allowance for level in levels]):
            height, level = levels[number - 1], levels[number]
            passed = max(passed, height)
            radius = level - allowance
            begin = self.material.free_end(radius, stretch.start)
            if begin <= stretch.end:
                continue
            is_open = self.material.free_end(radius, begin + self.retract) <= begin
            self.path.rise(passed + self.retract)
            passed = level
            self.path.rapid_z(begin + self.retract if is_open else begin)
            if is_open:
                self.path.rapid_x(level)
            else:
                self.path.sink(height + self.retract)
                self.path.feed_x(level, self.cut.feed)
            self.path.feed_z(stretch.end, self.cut.feed)
            self.path.rapid_x(level + self.retract)
            yield self._pass(Role.ROUGHING, height - level)

    def _rough_facing(self, chain: Chain, top: int, begin: int, allowance: int) -> Iterator[Pass]:
        """Passes parallel to X, from z = `begin` towards the chuck.

        In front of the contour they reach in to its start: what the finishing passes do not
        come along must not be left standing.
        """
        before = begin
        for level in spread(begin, chain.z_end, self.cut.depth_of_cut):
            inner = facing_end(chain, level) + (allowance if level < chain.z else 0)
            depth, before = before - level, level
            if inner >= top:
                continue
            self.path.rise(top + self.retract)
            self.path.rapid_z(level)
            self.path.sink(top + self.retract)
            self.path.feed_x(inner, self.cut.feed)
            self.path.feed_z(level + self.retract, self.cut.feed)
            yield self._pass(Role.FACING, depth)

    def _along_contour(
        self, record: ContourRecord, chain: Chain, top: int, allowance: int
    ) -> Iterator[Pass]:
        """The contour in one go: with the allowance, exactly, and as often again as wanted."""
        begin = chain.z + self.retract
        is_open = self.material.free_end(chain.x, begin) <= chain.z
        passes = [(Role.FINISHING, 0, self.cut.finish_feed)]
        if allowance > 0 and not chain.simple:
            passes.insert(0, (Role.SMOOTHING, allowance, self.cut.feed))
        passes += [(Role.SPRING, 0, self.cut.finish_feed)] * self.cut.kind
        for role, offset, feed in passes:
            self.path.rise(top + self.retract)
            self.path.rapid_z(begin if is_open else chain.z)
            if is_open:
                self.path.rapid_x(chain.x + offset)
                self.path.feed_z(chain.z, feed)
            else:
                self.path.sink(top + self.retract)
                self.path.feed_x(chain.x + offset, feed)
            self.path.follow(record.segments, feed)
            self.path.rapid_x(top + self.retract)
            yield self._pass(role, offset)

    def _plunge(self, record: PlungeRecord, chain: Chain) -> Iterator[Pass]:
        """Straight in, side by side, each place with its pecks."""
        top = self.material.highest(chain.z, chain.z_end, self.tool.below)
        if top <= record.x:
            return
        peck = self.cut.peck
        for place in plunge_places(record.z_high, record.z_low, self.tool.width):
            self.path.rise(top + self.retract)
            self.path.rapid_z(place)
            self.path.sink(top + self.retract)
            depth = top
            while True:
                depth = max(record.x, depth - peck) if peck else record.x
                self.path.feed_x(depth, self.cut.feed)
                if depth == record.x:
                    break
                self.path.rapid_x(depth + self.retract)
            self.path.rapid_x(top + self.retract)
            yield self._pass(Role.PLUNGING, top - record.x)


def plunge_places(z_high: int, z_low: int, width: int) -> list[int]:
    """Where a tool of `width` plunges: from the front, each place a quarter over the last."""
    over = width - (width >> 2)
    gaps = -(-(z_high - z_low) // over)
    return [z_high - (z_high - z_low) * i // max(gaps, 1) for i in range(gaps + 1)]


def facing_end(chain: Chain, level: int) -> int:
    """The radius at which a facing pass at z = `level` meets the contour."""

    def behind(radius: int) -> bool:
        found = interval(chain, radius, FAR)
        return found is not None and found.end <= level

    return smallest(chain.x, chain.x_end, behind)


def pockets(chain: Chain, radii: list[int]) -> Iterator[tuple[int, Stretch]]:
    """The stretches to rough, each with the number of its level, pocket by pocket.

    `radii` are those down to which the levels cut, the first one that of the uncut material. A
    stretch comes after the one of the level above that it lies in; a pocket is cut to its ground
    before its neighbour is begun.
    """
    number, last, done = 0, Stretch(chain.z, chain.z_end, True), chain.z
    while True:
        if number + 1 < len(radii):
            inside = interval(chain, radii[number + 1], done)
            if inside is not None and inside.start > last.end:
                number, last, done = number + 1, inside, inside.start
                yield number, inside
                continue
        while number > 0:
            beside = interval(chain, radii[number], last.end)
            parent = interval(chain, radii[number - 1], last.start) if number > 1 else None
            if beside is not None and (parent is None or beside.start > parent.end):
                break
            number -= 1
            if parent is not None:
                last = parent
        else:
            return
        last, done = beside, beside.start
        yield number, beside
