# SPDX-License-Identifier: Apache-2.0
"""Draws the glass of the display dot by dot, as PNG or SVG: bezel, lit glass, and every dot.

Dots that are off are drawn a shade darker than the glass, as they are seen on a real one.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from pathlib import Path

from .panel_font import HEIGHT, WIDTH, Rows

#: In pixels: a dot and its pitch, the gap between two characters, the glass around them, the bezel.
DOT, PITCH, GAP, MARGIN, BEZEL = 5, 6, 6, 20, 14
COLOURS = BLACK, GLASS, UNLIT, DARK = "#202020", "#a8c81e", "#a0be1c", "#1d2b08"

KINDS = (".png", ".svg")
Square = tuple[int, int, str]


def size(cells: list[list[Rows]]) -> tuple[int, int]:
    """Width and height of the picture in pixels."""
    columns, lines = len(cells[0]), len(cells)
    border = 2 * (MARGIN + BEZEL)
    return (
        border + columns * (WIDTH * PITCH + GAP) - GAP,
        border + lines * (HEIGHT * PITCH + GAP) - GAP,
    )


def squares(cells: list[list[Rows]]) -> Iterator[Square]:
    """Left upper corner and colour of every dot."""
    for line, row_of_cells in enumerate(cells):
        top = BEZEL + MARGIN + line * (HEIGHT * PITCH + GAP)
        for column, rows in enumerate(row_of_cells):
            left = BEZEL + MARGIN + column * (WIDTH * PITCH + GAP)
            for y, row in enumerate(rows):
                for x in range(WIDTH):
                    lit = row >> (WIDTH - 1 - x) & 1
                    yield left + x * PITCH, top + y * PITCH, DARK if lit else UNLIT


def draw_glass(cells: list[list[Rows]], path: Path) -> None:
    """Write the picture.

    Raises:
        ValueError: the name ends neither in ``.png`` nor in ``.svg``.
    """
    kind = path.suffix.lower()
    if kind not in KINDS:
        raise ValueError(f"{path.name}: a picture of the panel is a .png or a .svg")
    if kind == ".svg":
        path.write_text(_svg(cells), encoding="utf-8")
    else:
        _png(cells, path)


def _svg(cells: list[list[Rows]]) -> str:
    wide, high = size(cells)
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {high}" width="{wide}">',
        f'<rect width="{wide}" height="{high}" rx="6" fill="{BLACK}"/>',
        f'<rect x="{BEZEL}" y="{BEZEL}" width="{wide - 2 * BEZEL}" height="{high - 2 * BEZEL}" '
        f'fill="{GLASS}"/>',
    ]
    for colour in (UNLIT, DARK):
        dots = [f"M{x} {y}h{DOT}v{DOT}h-{DOT}z" for x, y, c in squares(cells) if c == colour]
        lines.append(f'<path fill="{colour}" d="{"".join(dots)}"/>')
    return "\n".join([*lines, "</svg>\n"])


def _chunk(kind: bytes, content: bytes) -> bytes:
    body = kind + content
    return struct.pack(">I", len(content)) + body + struct.pack(">I", zlib.crc32(body))


def _png(cells: list[list[Rows]], path: Path) -> None:
    """One byte to a pixel, the number of its colour in a palette."""
    wide, high = size(cells)
    pixels = [bytearray(wide) for _ in range(high)]

    def fill(x: int, y: int, width: int, height: int, colour: str) -> None:
        for row in pixels[y : y + height]:
            row[x : x + width] = bytes([COLOURS.index(colour)]) * width

    fill(BEZEL, BEZEL, wide - 2 * BEZEL, high - 2 * BEZEL, GLASS)
    for x, y, colour in squares(cells):
        fill(x, y, DOT, DOT, colour)
    header = struct.pack(">IIBBBBB", wide, high, 8, 3, 0, 0, 0)
    palette = b"".join(bytes.fromhex(colour[1:]) for colour in COLOURS)
    unfiltered = b"".join(b"\0" + row for row in pixels)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + _chunk(b"IHDR", header)
        + _chunk(b"PLTE", palette)
        + _chunk(b"IDAT", zlib.compress(unfiltered))
        + _chunk(b"IEND", b"")
    )
