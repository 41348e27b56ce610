# SPDX-License-Identifier: Apache-2.0
"""The rules of a part image, as the chip applies them and in its order.

`check` judges a part in steps, `verdict` the bytes of an image. The chip repeats all of it on
its own; these rules only tell a person earlier and with better words.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

from tornillo.image import (
    ImageError,
    Operation,
    PartImage,
    operation_type,
    unpack_header,
    unpack_operation,
)
from tornillo.machine import Machine
from tornillo.protocol import (
    FEED_MIN,
    FEED_UNIT,
    IMAGE_FORMAT,
    IMAGE_HEADER,
    OPERATION_RECORDS,
    OPERATIONS_MAX,
    PART_IMAGE_MAX,
    POSITION_MAX,
    CylinderRecord,
    ImageHeader,
    Refusal,
)
from tornillo.units import Scale

NAME = re.compile(rb"[a-z0-9-]{1,16}\0*")
FIELD_MAX = 0xFFFF


class Violation(NamedTuple):
    """A broken rule.

    `operation` is 0 for the part as a whole, `key` the key of the part file it is about,
    `detail` the numbers in words.
    """

    refusal: Refusal
    operation: int
    key: str
    detail: str


def check(image: PartImage, scale: Scale) -> Iterator[Violation]:
    """Every rule that `image` breaks on the machine of `scale`, the chip's answer first."""
    broken = list(_whole_part(image.header, scale))
    yield from broken
    if any(violation.refusal is Refusal.STOCK for violation in broken):
        return
    for position, operation in enumerate(image.operations, start=1):
        yield from _operation(image, position, operation, scale)


def verdict(data: bytes, machine: Machine) -> Violation | None:
    """The first rule that the image `data` breaks on `machine`, as the chip would answer."""
    scale = Scale("mm", machine)
    try:
        if len(data) > PART_IMAGE_MAX:
            raise ImageError(Refusal.LENGTH, 0)
        header = unpack_header(data)
        for violation in _whole_part(header, scale):
            return violation
        operations: list[Operation] = []
        at = IMAGE_HEADER.size
        for position in range(1, header.operation_count + 1):
            operations.append(unpack_operation(data, at, position))
            at += OPERATION_RECORDS[operation_type(operations[-1])].size
            image = PartImage(header, tuple(operations))
            for violation in _operation(image, position, operations[-1], scale):
                return violation
        PartImage.unpack(data)
    except ImageError as error:
        return Violation(error.refusal, error.operation, "", "")
    return None


def _whole_part(header: ImageHeader, scale: Scale) -> Iterator[Violation]:
    """The rules of the header, in the chip's order."""

    def broken(refusal: Refusal, key: str, detail: str) -> Violation:
        return Violation(refusal, 0, key, detail)

    machine = scale.machine
    if header.format != IMAGE_FORMAT or header.flags or header.reserved or header.reserved_end:
        yield broken(Refusal.FORMAT, "", f"format {header.format}")
    if not NAME.fullmatch(header.name):
        yield broken(Refusal.NAME, "part.name", repr(header.name.decode("latin-1")))
    if (header.step_x_nm, header.step_z_nm) != (machine.step_x_nm, machine.step_z_nm):
        yield broken(Refusal.STEP_SIZE, "", f"{header.step_x_nm} and {header.step_z_nm} nm")
    yield from (broken(Refusal.STOCK, *found) for found in _stock(header, scale))
    if not 1 <= header.operation_count <= OPERATIONS_MAX:
        yield broken(Refusal.OPERATION_COUNT, "operation", f"{header.operation_count} operations")
    if not 1 <= header.depth_of_cut <= min(header.stock_radius, FIELD_MAX):
        detail = f"{header.depth_of_cut} steps, the stock has {header.stock_radius}"
        yield broken(Refusal.DEPTH_OF_CUT, "cut.depth_of_cut", detail)
    if not 0 <= header.finish_allowance <= header.depth_of_cut:
        detail = f"{header.finish_allowance} steps, the depth of cut is {header.depth_of_cut}"
        yield broken(Refusal.ALLOWANCE, "cut.finish_allowance", detail)
    yield from (broken(Refusal.FEED, *found) for found in _feeds(header, scale))
    if not 1 <= header.retract <= FIELD_MAX:
        yield broken(Refusal.RETRACT, "cut.retract", f"{header.retract} steps")
    yield from (broken(Refusal.OUTSIDE_TRAVEL, *found) for found in _stock_travel(header, scale))


def _stock(header: ImageHeader, scale: Scale) -> Iterator[tuple[str, str]]:
    """Stock sizes outside their range."""
    if not 1 <= header.stock_radius <= POSITION_MAX:
        yield "stock.diameter", scale.show_diameter(header.stock_radius)
    if not 1 <= header.stock_length <= POSITION_MAX:
        yield "stock.length", f"length {scale.show(scale.length(header.stock_length))}"
    if not 0 <= header.stock_front <= POSITION_MAX:
        yield "stock.allowance", f"allowance {scale.show(scale.length(header.stock_front))}"


def _feeds(header: ImageHeader, scale: Scale) -> Iterator[tuple[str, str]]:
    """Feeds outside the machine's range."""
    fastest = scale.machine.max_rate * FEED_UNIT
    for key, feed in (("cut.feed", header.feed), ("cut.finish_feed", header.finish_feed)):
        if not FEED_MIN <= feed <= fastest:
            feed_range = f"{scale.show_feed(FEED_MIN)} to {scale.show_feed(fastest)}"
            yield key, f"{scale.show_feed(feed)}, the machine feeds {feed_range}"


def _stock_travel(header: ImageHeader, scale: Scale) -> Iterator[tuple[str, str]]:
    """Where the tool cannot get clear of the stock."""
    machine = scale.machine
    room_x, room_z = -machine.zero_x, -machine.zero_z
    need_x = header.stock_radius + header.retract
    need_z = header.stock_front + header.retract
    if need_x > room_x:
        yield (
            "stock.diameter",
            f"clear of the stock means {scale.show_diameter(need_x)}, "
            f"the slide ends at {scale.show_diameter(room_x)}",
        )
    if need_z > room_z:
        yield (
            "stock.allowance",
            f"clear of the stock means {scale.show_z(need_z)}, "
            f"the slide ends at {scale.show_z(room_z)}",
        )


def _operation(
    image: PartImage, position: int, operation: Operation, scale: Scale
) -> Iterator[Violation]:
    """The rules of one operation, in the chip's order."""
    earlier = image.operations[: position - 1]
    rules = (
        (Refusal.OUTSIDE_STOCK, _outside_stock(image.header, operation, scale)),
        (Refusal.OUTSIDE_TRAVEL, _outside_travel(operation, scale)),
        (Refusal.EMPTY_CUT, _empty_cut(image.header, operation, scale)),
        (Refusal.BLOCKED, _blocked(image.header, operation, earlier, scale)),
    )
    for refusal, found in rules:
        for key, detail in found:
            yield Violation(refusal, position, key, detail)


def _reach(operation: Operation) -> tuple[int, int, str]:
    """Smallest radius, z nearest to the chuck, and the key of the latter."""
    if isinstance(operation, CylinderRecord):
        return operation.x, operation.z_end, "z"
    return operation.x_inner, operation.z, "z"


def _outside_stock(
    header: ImageHeader, operation: Operation, scale: Scale
) -> Iterator[tuple[str, str]]:
    """Ends that are not in the stock, or too near to the chuck."""
    x, z, key = _reach(operation)
    if not 0 <= x <= header.stock_radius:
        detail = (
            f"{scale.show_diameter(x)}, the stock has {scale.show_diameter(header.stock_radius)}"
        )
        yield "diameter", detail
    if isinstance(operation, CylinderRecord) and operation.z_start > header.stock_front:
        yield (
            key,
            f"starts at {scale.show_z(operation.z_start)}, "
            f"the stock begins at {scale.show_z(header.stock_front)}",
        )
    nearest = header.retract - header.stock_length
    if z < nearest:
        yield (
            key,
            f"ends at {scale.show_z(z)}, one retract in front of the chuck is "
            f"{scale.show_z(nearest)}",
        )


def _empty_cut(
    header: ImageHeader, operation: Operation, scale: Scale
) -> Iterator[tuple[str, str]]:
    """Operations with nothing to cut."""
    if isinstance(operation, CylinderRecord):
        if operation.z_start <= operation.z_end:
            yield "z", f"from {scale.show_z(operation.z_start)} to {scale.show_z(operation.z_end)}"
        x = operation.x
    else:
        if operation.z >= header.stock_front:
            front = scale.show_z(header.stock_front)
            yield "z", f"{scale.show_z(operation.z)}, the stock begins at {front}"
        x = operation.x_inner
    if x == header.stock_radius:
        yield "diameter", f"{scale.show_diameter(x)} is that of the stock"


def _outside_travel(operation: Operation, scale: Scale) -> Iterator[tuple[str, str]]:
    """Ends the slides cannot reach."""
    machine = scale.machine
    x, z, key = _reach(operation)
    least_x = -machine.travel_x - machine.zero_x
    least_z = -machine.travel_z - machine.zero_z
    if x < least_x:
        detail = f"{scale.show_diameter(x)}, the slide ends at {scale.show_diameter(least_x)}"
        yield "diameter", detail
    if z < least_z:
        yield key, f"ends at {scale.show_z(z)}, the slide ends at {scale.show_z(least_z)}"


def _blocked(
    header: ImageHeader, operation: Operation, earlier: tuple[Operation, ...], scale: Scale
) -> Iterator[tuple[str, str]]:
    """Cylinders that start behind material that is higher than they are.

    Everything in front of an operation's end is at most as large as the operation, because it
    was itself not blocked. So one earlier operation that ends at or behind this start and is
    not larger is enough, and needed.
    """
    if not isinstance(operation, CylinderRecord) or operation.z_start >= header.stock_front:
        return
    reaches = (_reach(other) for other in earlier)
    if not any(z <= operation.z_start and x <= operation.x for x, z, _ in reaches):
        yield (
            "z",
            f"starts at {scale.show_z(operation.z_start)}, and in front of it something larger "
            f"than {scale.show_diameter(operation.x)} stands",
        )
