# SPDX-License-Identifier: Apache-2.0
"""For every rule of a part image ten images or more that break it: (bytes, operation)."""

from typing import Any

from images import (
    BAR,
    CONCAVE,
    CONVEX,
    CUT,
    FACE,
    GOOD,
    GROOVE,
    PARTING,
    PAUSE,
    TOOL,
    arc,
    contour,
    cut,
    header,
    image,
    line,
    patched,
)

from tornillo.protocol import IMAGE_HEADER, ContourRecord, Refusal

Case = tuple[bytes, int]
DATA = GOOD.pack()
TOOL_AT = IMAGE_HEADER.size
CUT_AT = TOOL_AT + 30
FACE_AT = CUT_AT + 16
BAR_AT = FACE_AT + 13


def named(name: bytes) -> Case:
    """GOOD with another name."""
    return header(name=name.ljust(16, b"\0")), 0


def sized(at: int, size: int, operation: int) -> Case:
    """GOOD with another size in the record at `at`."""
    return resized(DATA, at, size)[0], operation


def resized(image_data: bytes, at: int, size: int) -> Case:
    """An image with another size in the record at `at`."""
    data = bytearray(image_data)
    data[at + 2 : at + 4] = size.to_bytes(2, "little")
    return bytes(data), 1


def plunge(**changes: int) -> Case:
    """The groove alone, changed."""
    return cut(GROOVE._replace(**changes), tool=PARTING), 1


def with_tool(**changes: Any) -> Case:
    """GOOD with another tool."""
    return image(TOOL._replace(**changes), CUT, FACE, BAR), 1


def with_cut(**changes: int) -> Case:
    """GOOD with other cutting data."""
    return image(TOOL, CUT._replace(**changes), FACE, BAR), 1


def segments(data: bytes, kind: int = 4) -> Case:
    """One contour with these bytes as its segments."""
    return cut(ContourRecord(kind, 0, 600, data)), 1


def one(*wanted: ContourRecord) -> Case:
    """Contours alone, the last one wrong."""
    return cut(*wanted), len(wanted)


#: Radius 500 about (-500, 0): a quarter of a ball from the free end.
QUARTER = arc(CONVEX, -500, 500, -500, 0)
LOW = contour(100, 300, line(-200, 0))
CASES: dict[Refusal, list[Case]] = {
    Refusal.LENGTH: [
        (b"", 0),
        (DATA[:1], 0),
        (DATA[:31], 0),
        (DATA + bytes(2500), 0),
        (bytes(2497), 0),
        (DATA[: TOOL_AT + 1], 1),
        (DATA[: TOOL_AT + 29], 1),
        (DATA[:-1], 2),
        (DATA + bytes(3), 3),
        (DATA + bytes(4), 3),
        sized(TOOL_AT, 3, 1),
        sized(CUT_AT, 0, 1),
        sized(BAR_AT, 14, 2),
        sized(FACE_AT, 60000, 1),
    ],
    Refusal.FORMAT: [
        *((header(format=value), 0) for value in (0, 1, 3, 255)),
        *((header(flags=value), 0) for value in (2, 3, 0x80)),
        *((header(reserved=value), 0) for value in (1, 255)),
        with_tool(kind=16),
        with_tool(kind=255),
        with_tool(width=8001),
        with_tool(width=65535),
        with_cut(kind=10),
        with_cut(kind=255),
        (cut(PAUSE._replace(kind=2)), 1),
        *(one(BAR._replace(kind=kind, z=100)) for kind in (5, 15, 0x10, 0x41, 0x85, 0xFF)),
        plunge(kind=2),
        plunge(kind=255),
    ],
    Refusal.NAME: [
        named(name)
        for name in (
            b"",
            b"Pin",
            b"pin ",
            b"a\0b",
            b"\0pin",
            b"pin_1",
            b"p.n",
            b"\xff",
            b"a/b",
            b"{",
            b"0123456789abcde`",
            b"pin\0\0\0\0\0\0\0\0\0\0\0\0x",
        )
    ],
    Refusal.STEP_SIZE: [
        (header(**{key: value}), 0)
        for key in ("step_x_nm", "step_z_nm")
        for value in (0, 1, 7111, 7113, 65535)
    ],
    Refusal.STOCK: [
        *((header(stock_radius=value), 0) for value in (0, 32001, 40000, 65535)),
        *((header(stock_length=value), 0) for value in (0, 32001, 65535)),
        *((header(stock_front=value), 0) for value in (8001, 27001, 32000, 65535)),
    ],
    Refusal.OPERATION_COUNT: [
        *((header(operation_count=value), 0) for value in (0, 65, 66, 128, 255)),
        *((header(operation_count=value), 0) for value in (1, 3, 4, 64)),
        (image(TOOL, CUT, *[BAR._replace(z=100)] * 65), 0),
        (image(TOOL, CUT, operation_count=1), 0),
        (image(TOOL, operation_count=1), 0),
        (DATA[:TOOL_AT], 0),
    ],
    Refusal.RETRACT: [
        (header(retract=value), 0)
        for value in (0, 8001, 8002, 32000, 32767, 32768, 40000, 60000, 65534, 65535)
    ],
    Refusal.OUTSIDE_TRAVEL: [
        (header(stock_radius=3536), 0),
        (header(stock_radius=32000), 0),
        (header(retract=2576), 0),
        (header(stock_front=7921), 0),
        (header(stock_front=8000), 0),
        (header(retract=3999, stock_front=3), 0),
        with_tool(offset_x=2536),
        with_tool(offset_x=32767),
        with_tool(offset_z=7821),
        with_tool(offset_z=32767),
        with_tool(offset_x=-28426),
        with_tool(offset_z=-24001),
        (cut(contour(100, 20, line(-9, 0)), tool=TOOL._replace(offset_x=-21)), 1),
        (cut(contour(100, 600, line(-9, -590)), tool=TOOL._replace(back=65535, offset_x=-11)), 1),
        (cut(BAR._replace(z=100), tool=TOOL._replace(offset_z=-6173)), 1),
        (cut(GROOVE, tool=PARTING._replace(offset_x=-301)), 1),
        (cut(GROOVE, tool=PARTING._replace(offset_z=-7273)), 1),
    ],
    Refusal.OPERATION_TYPE: [
        *((patched(TOOL_AT, value), 1) for value in (0, 6, 7, 99, 255)),
        *((patched(CUT_AT, value), 1) for value in (0, 6)),
        *((patched(FACE_AT, value), 1) for value in (0, 255)),
        *((patched(BAR_AT, value), 2) for value in (0, 6, 128)),
    ],
    Refusal.ORDER: [
        (image(CUT, TOOL, FACE), 1),
        (image(CUT, CUT, FACE), 1),
        (image(TOOL, TOOL, FACE), 1),
        (image(FACE, TOOL, CUT), 1),
        (image(TOOL, FACE, CUT), 1),
        (image(BAR), 1),
        (image(PAUSE), 1),
        (image(TOOL, PAUSE), 1),
        (image(PARTING, GROOVE), 1),
        (image(GROOVE), 1),
        (image(TOOL, BAR), 1),
    ],
    Refusal.OPERATION_SIZE: [
        sized(TOOL_AT, 29, 1),
        sized(TOOL_AT, 31, 1),
        sized(CUT_AT, 15, 1),
        sized(CUT_AT, 17, 1),
        sized(FACE_AT, 7, 1),
        (cut(PAUSE._replace(message=bytes(33))), 1),
        resized(cut(GROOVE, tool=PARTING), FACE_AT, 9),
        resized(cut(GROOVE, tool=PARTING) + bytes(4), FACE_AT, 14),
        segments(b""),
        segments(b"\0\0\0\0"),
        segments(b"\0\0\0\xf0\xff\0"),
        segments(b"\3\0\0\xf0\xff"),
        segments(b"\xff\0\0\xf0\xff"),
        segments(b"\1\0\0\xf0\xff\0\0\0\0\0"),
        segments(b"\2\0\0\xf0\xff"),
    ],
    Refusal.TOOL: [
        *(
            (cut(record, tool=PARTING), 1)
            for record in (FACE, BAR, LOW, contour(0, 0, line(-9, 1)))
        ),
        *((cut(FACE, tool=TOOL._replace(width=width)), 1) for width in (1, 2, 1000, 8000)),
        (cut(GROOVE), 1),
        (cut(GROOVE._replace(kind=1)), 1),
        (cut(FACE, BAR, GROOVE), 3),
        (image(TOOL, CUT, FACE, PARTING, BAR), 2),
    ],
    Refusal.DEPTH_OF_CUT: [
        with_cut(depth_of_cut=value)
        for value in (0, 1001, 1002, 2000, 3000, 10000, 32000, 32768, 65534, 65535)
    ],
    Refusal.ALLOWANCE: [
        *(with_cut(finish_allowance=value) for value in (101, 102, 200, 1000, 32768, 65535)),
        *(with_cut(depth_of_cut=n, finish_allowance=n + 1) for n in (1, 2, 500, 1000)),
    ],
    Refusal.FEED: [
        *(with_cut(feed=value) for value in (0, 1, 31, 8001, 32768, 65535)),
        *(with_cut(finish_feed=value) for value in (0, 1, 31, 8001, 32768, 65535)),
    ],
    Refusal.SPINDLE: [
        with_cut(spindle=value) for value in (1, 2, 50, 99, 3801, 3802, 5000, 10000, 32768, 65535)
    ],
    Refusal.OUTSIDE_STOCK: [
        one(contour(0, -58, line(0, 1000), kind=0x80)),
        one(contour(100, 1001, line(-9, 0))),
        one(contour(141, 600, line(-200, 0))),
        one(contour(-4961, 600, line(-1, 0))),
        one(contour(100, 600, line(-5061, 0))),
        one(contour(100, 600, line(-99, 401))),
        (cut(contour(100, 600, line(-99, -658)), tool=TOOL._replace(back=65535)), 1),
        one(contour(100, 990, arc(CONVEX, -800, 0, -400, -3000))),
        (
            cut(
                contour(100, 100, arc(CONCAVE, -800, 0, -400, 300)),
                tool=TOOL._replace(back=65535),
            ),
            1,
        ),
        plunge(x=-1),
        plunge(z_high=-59),
        plunge(z_low=-4961),
        plunge(z_high=-5000, z_low=-5000),
    ],
    Refusal.DIRECTION: [
        *(one(contour(0, 600, line(dz, dx))) for dz, dx in ((1, 0), (1, 1), (9, -9), (500, 0))),
        one(contour(0, 600, line(-10, 0), line(1, 5))),
        one(contour(0, 600, arc(CONVEX, 5, 5, 5, -30))),
        *(
            one(contour(0, 600, line(dz, dx), kind=0x84))
            for dz, dx in ((-5, -1), (0, -1), (-9, -300))
        ),
        one(contour(0, 600, line(-5, 5), line(-5, -5), kind=0x84)),
    ],
    Refusal.EMPTY_CUT: [
        one(contour(100, 600, line(0, 0))),
        one(contour(100, 600, line(-9, 0), line(0, 0))),
        one(contour(100, 600, arc(CONVEX, 0, 0, -5, -5))),
        one(contour(100, 600, line(0, 0), kind=0x84)),
        one(contour(100, 0, line(0, 1000), kind=0x80)),
        one(contour(120, 0, line(0, 1000), kind=0x80)),
        one(contour(140, 0, line(-40, 1000), kind=0x80)),
        one(contour(100, 600, line(0, 100))),
        one(contour(100, 1000, line(-100, 0))),
        one(FACE, contour(0, 1000, line(-100, 0))),
        plunge(z_low=-699),
        plunge(z_high=-801),
        plunge(x=1000),

    ],
    Refusal.ARC: [
        one(contour(100, 500, arc(CONVEX, -10, 3, -1, 0))),
        one(contour(100, 500, arc(CONVEX, -10, 3, 0, 0))),
        one(contour(100, 500, arc(CONVEX, -10, 0, -5, 1))),
        one(contour(100, 500, arc(CONCAVE, -10, 0, -5, -1))),
        one(contour(100, 500, arc(CONVEX, -500, 500, -450, 0))),
        one(contour(100, 0, arc(CONVEX, -500, 495, -500, 0))),
        one(contour(100, 0, arc(CONVEX, -500, 510, -500, 0))),
        one(contour(100, 500, arc(CONVEX, -500, 400, -500, 100))),
        one(contour(100, 500, arc(CONCAVE, -500, 100, -100, 50))),
        one(contour(100, 500, arc(CONVEX, -100, 0, -32767, -32767))),
        one(contour(100, 500, arc(CONVEX, -4, -3, 0, -9000))),
    ],
    Refusal.BACK_EDGE: [
        *(
            one(contour(100, 600, line(-run, -fall)))
            for run, fall in ((1, 2), (100, 101), (10, 500), (0, 1), (0, 600))
        ),
        one(contour(100, 600, line(-10, 0), line(-100, -101))),
        one(contour(100, 300, arc(CONVEX, -900, 0, -450, -400))),
        one(contour(100, 300, arc(CONCAVE, -900, 0, -450, 440))),
        (cut(contour(100, 600, line(-100, -1)), tool=TOOL._replace(back=0)), 1),
        (cut(contour(100, 600, line(-100, -59)), tool=TOOL._replace(back=150)), 1),
        (cut(contour(100, 500, line(0, -5)), tool=TOOL._replace(back=65534)), 1),
    ],
    Refusal.FRONT_EDGE: [
        (cut(shape, tool=TOOL._replace(front=front)), 1)
        for shape, front in (
            (contour(100, 600, line(-100, 101)), 256),
            (contour(100, 600, line(-1, 2)), 256),
            (contour(100, 600, line(0, 1), line(-5, 0)), 65534),
            (contour(100, 600, line(-100, 1)), 0),
            (contour(100, 600, line(-100, 59)), 150),
            (FACE, 65534),
            (FACE, 0),
            (contour(100, 0, QUARTER), 65534),
            (contour(100, 300, arc(CONVEX, -900, 0, -450, -400)), 256),
            (contour(100, 600, arc(CONCAVE, -300, 300, 0, 300)), 65534),
            (contour(100, 600, line(-10, 0), line(-10, 11)), 256),
        )
    ],
    Refusal.BLOCKED: [
        one(BAR),
        one(contour(99, 999, line(-9, 0))),
        one(contour(-10, 0, line(-9, 900))),
        one(LOW, contour(-101, 300, line(-9, 0))),
        one(LOW, contour(-100, 299, line(-9, 0))),
        one(LOW, contour(-50, 200, line(-900, 0))),
        one(contour(0, 300, line(0, 700), kind=0x80), contour(0, 200, line(-90, 0))),
        one(contour(100, 300, line(-100, 200)), contour(0, 499, line(-90, 0))),
        one(contour(100, 300, line(-100, 200)), contour(-1, 500, line(-90, 0))),
        one(contour(100, 500, line(-100, -99), line(-100, 99)), contour(0, 401, line(-9, 0))),
        (image(PARTING, CUT, GROOVE, TOOL, BAR._replace(z=-801)), 2),
    ],
}
