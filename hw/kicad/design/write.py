# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Turns drawn sheets into .kicad_sch files, the root sheet among them."""

from __future__ import annotations

from typing import Any

from design.sexpr import Atom, atom, dump
from design.sheet import (
    ROOT_UUID,
    STEP,
    Part,
    Sheet,
    effects,
    embedded,
    name_uuid,
    split_wires,
    text_places,
)

PROJECT = "tornillo"
REVISION = "A"
DATE = "2026-11-20"
LICENCE = "CERN-OHL-P-2.0"


def mm(steps: float) -> Atom:
    """Return a length in steps as KiCad's millimetres."""
    return atom(float(steps * STEP))


def _head(uuid: str, paper: str, title: str, comment: str) -> list[Any]:
    return [
        Atom("kicad_sch"),
        [Atom("version"), Atom("20250114")],
        [Atom("generator"), "eeschema"],
        [Atom("generator_version"), "9.0"],
        [Atom("uuid"), uuid],
        [Atom("paper"), paper],
        [
            Atom("title_block"),
            [Atom("title"), title],
            [Atom("date"), DATE],
            [Atom("rev"), REVISION],
            [Atom("company"), "Tornillo"],
            [Atom("comment"), Atom("1"), comment],
            [Atom("comment"), Atom("2"), f"Licence: {LICENCE}"],
        ],
    ]


def sheet_text(sheet: Sheet) -> str:
    """Return the text of one sheet's file."""
    path = f"/{ROOT_UUID}/{sheet.uuid}"
    pieces, junctions = split_wires(sheet)
    used = {part.symbol.lib_id: part.symbol for part in sheet.parts}
    body = _head(name_uuid("file", sheet.name), sheet.paper, sheet.title, sheet.comment)
    body.append([Atom("lib_symbols"), *(embedded(used[key]) for key in sorted(used))])
    for corner, opposite in sheet.frames:
        body.append(_frame(sheet, corner, opposite))
    for words, at, size in sheet.texts:
        body.append(
            [
                Atom("text"),
                words,
                [Atom("exclude_from_sim"), Atom("no")],
                [Atom("at"), mm(at[0]), mm(at[1]), Atom("0")],
                effects(size, ("left", "bottom")),
                [Atom("uuid"), name_uuid(sheet.name, "text", words, at)],
            ]
        )
    for point in junctions:
        body.append(
            [
                Atom("junction"),
                [Atom("at"), mm(point[0]), mm(point[1])],
                [Atom("diameter"), Atom("0")],
                [Atom("color"), Atom("0"), Atom("0"), Atom("0"), Atom("0")],
                [Atom("uuid"), name_uuid(sheet.name, "junction", point)],
            ]
        )
    for point in sheet.no_connects:
        body.append(
            [
                Atom("no_connect"),
                [Atom("at"), mm(point[0]), mm(point[1])],
                [Atom("uuid"), name_uuid(sheet.name, "nc", point)],
            ]
        )
    for a, b in pieces:
        body.append(
            [
                Atom("wire"),
                [Atom("pts"), [Atom("xy"), mm(a[0]), mm(a[1])], [Atom("xy"), mm(b[0]), mm(b[1])]],
                [Atom("stroke"), [Atom("width"), Atom("0")], [Atom("type"), Atom("default")]],
                [Atom("uuid"), name_uuid(sheet.name, "wire", a, b)],
            ]
        )
    for kind, net, at, rot, shape in sheet.labels:
        body.append(_label(sheet, kind, net, at, rot, shape))
    for part in sheet.parts:
        body.append(_part(sheet, part, path))
    return dump(body) + "\n"


def _frame(sheet: Sheet, a: tuple[int, int], b: tuple[int, int]) -> list[Any]:
    return [
        Atom("rectangle"),
        [Atom("start"), mm(a[0]), mm(a[1])],
        [Atom("end"), mm(b[0]), mm(b[1])],
        [Atom("stroke"), [Atom("width"), Atom("0")], [Atom("type"), Atom("dash")]],
        [Atom("fill"), [Atom("type"), Atom("none")]],
        [Atom("uuid"), name_uuid(sheet.name, "frame", a, b)],
    ]


def _label(
    sheet: Sheet, kind: str, net: str, at: tuple[int, int], rot: int, shape: str
) -> list[Any]:
    node: list[Any] = [Atom(kind), net]
    if shape:
        node.append([Atom("shape"), Atom(shape)])
    side = "right" if rot in (180, 270) else "left"
    justify = (side,) if kind == "global_label" else (side, "bottom")
    node += [
        [Atom("at"), mm(at[0]), mm(at[1]), Atom(str(rot))],
        effects(1.27, justify),
        [Atom("uuid"), name_uuid(sheet.name, kind, net, at)],
    ]
    if kind == "global_label":
        node.append(
            [
                Atom("property"),
                "Intersheetrefs",
                "${INTERSHEET_REFS}",
                [Atom("at"), mm(at[0]), mm(at[1]), Atom("0")],
                effects(1.27, (side,), hide=True),
            ]
        )
    return node


def _part(sheet: Sheet, part: Part, path: str) -> list[Any]:
    node: list[Any] = [
        Atom("symbol"),
        [Atom("lib_id"), part.symbol.lib_id],
        [Atom("at"), mm(part.at[0]), mm(part.at[1]), Atom(str(part.rot))],
    ]
    if part.mirror:
        node.append([Atom("mirror"), Atom(part.mirror)])
    real = part.on_board
    node += [
        [Atom("unit"), Atom(str(part.unit))],
        [Atom("exclude_from_sim"), Atom("no")],
        [Atom("in_bom"), Atom("yes" if real and not part.ref.startswith(("H", "TP")) else "no")],
        [Atom("on_board"), Atom("yes")],
        [Atom("dnp"), Atom("no")],
        [Atom("uuid"), name_uuid("part", part.ref, part.unit)],
    ]
    shown = {name: (text, x, y, justify) for name, text, x, y, justify in text_places(part)}
    flips = part.mirror == "y" or (part.rot == 180 and part.mirror != "y")
    for name, text in [
        ("Reference", part.ref),
        ("Value", part.value),
        ("Footprint", part.footprint),
        ("Datasheet", ""),
        ("Description", ""),
        *part.fields.items(),
    ]:
        node.append(_property(part, name, text, shown.get(name), flips))
    node += [
        [Atom("pin"), pin.number, [Atom("uuid"), name_uuid("pin", part.ref, pin.number)]]
        for pin in part.symbol.pins
        if pin.unit in (0, part.unit)
    ]
    node.append(
        [
            Atom("instances"),
            [
                Atom("project"),
                PROJECT,
                [
                    Atom("path"),
                    path,
                    [Atom("reference"), part.ref],
                    [Atom("unit"), Atom(str(part.unit))],
                ],
            ],
        ]
    )
    return node


def _property(
    part: Part, name: str, text: str, shown: tuple[str, float, float, str] | None, flips: bool
) -> list[Any]:
    if shown is None:
        return [
            Atom("property"),
            name,
            text,
            [Atom("at"), mm(part.at[0]), mm(part.at[1]), Atom("0")],
            effects(1.27, hide=True),
        ]
    _, x, y, justify = shown
    if flips and justify in ("left", "right"):
        justify = "right" if justify == "left" else "left"
    angle = 90 if part.rot in (90, 270) else 0
    if part.rot == 90 and justify in ("left", "right"):
        justify = "right" if justify == "left" else "left"
    return [
        Atom("property"),
        name,
        text,
        [Atom("at"), mm(x), mm(y), Atom(str(angle))],
        effects(1.27, (justify,)),
    ]


def root_text(sheets: list[Sheet], notes: list[tuple[str, tuple[int, int], float]]) -> str:
    """Return the text of the root sheet: one box per sheet, and the notes."""
    body = _head(ROOT_UUID, "A4", "Tornillo control board", "Overview: one sheet per function")
    body.append([Atom("lib_symbols")])
    body += [_note(words, at, size) for words, at, size in notes]
    for index, sheet in enumerate(sheets):
        x, y = 20 + 68 * (index % 3), 50 + 36 * (index // 3)
        body.append(_sheet_box(sheet, x, y))
        body.append(_note(sheet.summary, (x + 2, y + 12)))
    body.append([Atom("sheet_instances"), [Atom("path"), "/", [Atom("page"), "1"]]])
    return dump(body) + "\n"


def _note(words: str, at: tuple[int, int], size: float = 1.4) -> list[Any]:
    return [
        Atom("text"),
        words,
        [Atom("exclude_from_sim"), Atom("no")],
        [Atom("at"), mm(at[0]), mm(at[1]), Atom("0")],
        effects(size, ("left", "bottom")),
        [Atom("uuid"), name_uuid("root", "text", at)],
    ]


def _sheet_box(sheet: Sheet, x: int, y: int) -> list[Any]:
    zero = [Atom("0"), Atom("0"), Atom("0")]
    return [
        Atom("sheet"),
        [Atom("at"), mm(x), mm(y)],
        [Atom("size"), mm(54), mm(20)],
        [Atom("exclude_from_sim"), Atom("no")],
        [Atom("in_bom"), Atom("yes")],
        [Atom("on_board"), Atom("yes")],
        [Atom("dnp"), Atom("no")],
        [Atom("stroke"), [Atom("width"), atom(0.15)], [Atom("type"), Atom("solid")]],
        [Atom("fill"), [Atom("color"), *zero, Atom("0.0000")]],
        [Atom("uuid"), sheet.uuid],
        [
            Atom("property"),
            "Sheetname",
            sheet.title,
            [Atom("at"), mm(x), mm(y - 0.6), Atom("0")],
            effects(1.5, ("left", "bottom")),
        ],
        [
            Atom("property"),
            "Sheetfile",
            f"{sheet.name}.kicad_sch",
            [Atom("at"), mm(x), mm(y + 20.6), Atom("0")],
            effects(1.0, ("left", "top")),
        ],
        [
            Atom("instances"),
            [
                Atom("project"),
                PROJECT,
                [Atom("path"), f"/{ROOT_UUID}", [Atom("page"), str(sheet.page)]],
            ],
        ],
    ]
