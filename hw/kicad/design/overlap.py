# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Finds texts of a sheet that lie on each other, on a wire or on a part.

Widths are estimates of KiCad's stroke font, in steps of 1.27 mm.
"""

from __future__ import annotations

from dataclasses import dataclass

from design.sheet import STEP, Box, Sheet, split_wires, text_places

CHARACTER = 0.95
HEIGHT = 1.15


@dataclass(frozen=True)
class Text:
    """A text, its box, and whether it may touch wires (labels sit on them)."""

    words: str
    box: Box
    on_wire: bool


def overlaps(sheet: Sheet) -> list[str]:
    """Return one line for each pair that lies on each other."""
    texts = _texts(sheet)
    found = []
    for index, text in enumerate(texts):
        found += [
            f"{sheet.name}: {text.words!r} lies on {other.words!r}"
            for other in texts[index + 1 :]
            if _meet(text.box, other.box)
        ]
        if not text.on_wire:
            found += [
                f"{sheet.name}: {text.words!r} lies on the wire {a} {b}"
                for a, b in split_wires(sheet)[0]
                if _meet(text.box, _flat(a, b))
            ]
            found += [
                f"{sheet.name}: {text.words!r} lies on {part.ref}"
                for part in sheet.parts
                if _meet(text.box, part.body())
            ]
    return found


def _flat(a: tuple[int, int], b: tuple[int, int]) -> Box:
    return min(a[0], b[0]), min(a[1], b[1]), max(a[0], b[0]), max(a[1], b[1])


def _meet(a: Box, b: Box) -> bool:
    gap = 0.05
    return a[0] + gap < b[2] and b[0] + gap < a[2] and a[1] + gap < b[3] and b[1] + gap < a[3]


def _box(words: str, x: float, y: float, justify: str, size: float = 1.27) -> Box:
    width, height = len(words) * CHARACTER * size / STEP, HEIGHT * size / STEP
    left = {"left": x, "right": x - width, "center": x - width / 2}[justify]
    return left, y - height / 2, left + width, y + height / 2


def _texts(sheet: Sheet) -> list[Text]:
    texts = []
    for part in sheet.parts:
        for name, words, x, y, justify in text_places(part):
            if part.ref.startswith("#FLG"):
                continue
            box = _box(words, x, y, justify)
            key = f"{part.ref}/{name}/{words}"
            texts.append(Text(key, box, False))
    for kind, net, (x, y), rot, _ in sheet.labels:
        width = len(net) * CHARACTER
        if kind == "global_label":
            width = len(net) * 1.0 + 2.0
        left = x if rot == 0 else x - width
        if rot in (90, 270):
            texts.append(Text(net, (x - 1.4, y - width, x - 0.2, y), True))
        elif kind == "label":
            texts.append(Text(net, (left, y - 1.4, left + width, y - 0.2), True))
        else:
            texts.append(Text(net, (left, y - 0.8, left + width, y + 0.8), True))
    for words, (x, y), size in sheet.texts:
        lines = words.split("\n")
        wide = max(len(line) for line in lines) * CHARACTER * size / STEP
        high = 1.6 * len(lines) * size / STEP
        texts.append(Text(words, (x, y - high, x + wide, y), False))
    return texts
