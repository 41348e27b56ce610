# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Takes symbols out of KiCad's libraries and the project's own.

Symbols that extend another one are flattened, as KiCad embeds them in a
schematic. Coordinates here are millimetres, y upwards, as in the library.
"""

from __future__ import annotations

import copy
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from design.sexpr import child, children, parse

KICAD_SYMBOLS = Path(os.environ.get("KICAD9_SYMBOL_DIR", "/usr/share/kicad/symbols"))
PROJECT_SYMBOLS = Path(__file__).resolve().parent.parent / "tornillo.kicad_sym"


@dataclass(frozen=True)
class Pin:
    """One pin: where its wire starts, and the unit it belongs to (0 = all)."""

    number: str
    x: float
    y: float
    unit: int


@dataclass(frozen=True)
class Symbol:
    """A flattened symbol: what to embed, its pins and the box of its body."""

    lib_id: str
    node: list[Any]
    pins: tuple[Pin, ...]
    boxes: dict[int, tuple[float, float, float, float]]


_cache: dict[str, Symbol] = {}


def load(lib_id: str) -> Symbol:
    """Return the symbol called library:name; raises KeyError when missing."""
    if lib_id not in _cache:
        node = _flat(*lib_id.split(":", 1))
        node[1] = lib_id
        _cache[lib_id] = Symbol(lib_id, node, tuple(_pins(node)), _boxes(node))
    return _cache[lib_id]


def _raw(library: str, name: str) -> list[Any]:
    path = PROJECT_SYMBOLS if library == "tornillo" else KICAD_SYMBOLS / f"{library}.kicad_sym"
    text = path.read_text(encoding="utf-8")
    start = text.find(f'\n\t(symbol "{name}"\n')
    if start < 0:
        raise KeyError(f"{path.name} has no symbol {name}")
    return parse(text[start:])


def _flat(library: str, name: str) -> list[Any]:
    node = _raw(library, name)
    base = children(node, "extends")
    if not base:
        return node
    parent_name = base[0][1]
    parent = copy.deepcopy(_flat(library, parent_name))
    own = {item[1]: item for item in children(node, "property")}
    merged: list[Any] = [parent[0], name]
    for item in parent[2:]:
        if isinstance(item, list) and item[0] == "property" and item[1] in own:
            merged.append(own.pop(item[1]))
        elif isinstance(item, list) and item[0] == "symbol":
            merged.append(["symbol", item[1].replace(parent_name, name, 1), *item[2:]])
            merged[-1][0] = item[0]
        else:
            merged.append(item)
    first_unit = next(
        i for i, item in enumerate(merged) if isinstance(item, list) and item[0] == "symbol"
    )
    merged[first_unit:first_unit] = list(own.values())
    return merged


def _units(node: list[Any]) -> list[tuple[int, list[Any]]]:
    return [
        (int(unit[1].rsplit("_", 2)[1]), unit)
        for unit in children(node, "symbol")
        if int(unit[1].rsplit("_", 2)[2]) < 2
    ]


def _pins(node: list[Any]) -> list[Pin]:
    return [
        Pin(child(pin, "number")[1], float(child(pin, "at")[1]), float(child(pin, "at")[2]), unit)
        for unit, body in _units(node)
        for pin in children(body, "pin")
    ]


def _boxes(node: list[Any]) -> dict[int, tuple[float, float, float, float]]:
    boxes: dict[int, tuple[float, float, float, float]] = {}
    for unit, body in _units(node):
        points = [
            point
            for item in body[2:]
            if isinstance(item, list) and item[0] in ("rectangle", "polyline", "circle", "arc")
            for point in _points(item)
        ]
        if points:
            xs, ys = [p[0] for p in points], [p[1] for p in points]
            boxes[unit] = (min(xs), min(ys), max(xs), max(ys))
    return boxes


def _points(item: list[Any]) -> list[tuple[float, float]]:
    found = []
    for name in ("start", "mid", "end"):
        found += [(float(p[1]), float(p[2])) for p in children(item, name)]
    for points in children(item, "pts"):
        found += [(float(p[1]), float(p[2])) for p in children(points, "xy")]
    for centre in children(item, "center"):
        x, y, r = float(centre[1]), float(centre[2]), float(child(item, "radius")[1])
        found += [(x - r, y - r), (x + r, y + r)]
    return found
