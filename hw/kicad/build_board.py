#!/usr/bin/python3
# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Lays out the board from the schematic's netlist.

    build_board.py place NETLIST.xml BOARD.kicad_pcb ROUTES.dsn
    build_board.py finish BOARD.kicad_pcb ROUTES.ses

place puts parts, outline, keep-out and hand-laid copper on the board and
writes what a router needs; finish takes the router's result, pours copper and
writes the silkscreen. Needs KiCad's own Python (import pcbnew). Identifiers
come from a seeded generator, so equal input gives an equal board.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from layout import copper, netclasses, placement, silkscreen

pcbnew: Any = importlib.import_module("pcbnew")

HERE = Path(__file__).resolve().parent
FOOTPRINTS = Path(os.environ.get("KICAD9_FOOTPRINT_DIR", "/usr/share/kicad/footprints"))
ORIGIN = (50.0, 30.0)
Nets = dict[str, list[tuple[str, str]]]


def at(x: float, y: float) -> Any:
    """Return a board position, in KiCad's units, of a place on the board in mm."""
    return pcbnew.VECTOR2I_MM(ORIGIN[0] + x, ORIGIN[1] + y)


def read_netlist(path: Path) -> tuple[list[ElementTree.Element], Nets]:
    """Return the components and nets of an XML netlist."""
    tree = ElementTree.parse(path)
    nets = {}
    for net in tree.iterfind(".//net"):
        name = net.get("name", "")
        if name.startswith(("unconnected-(", "Net-(")):
            name = name.replace("/", "{slash}")
        nets[name] = [(node.get("ref", ""), node.get("pin", "")) for node in net.iter("node")]
    return list(tree.iterfind(".//comp")), nets


def place(netlist: Path, target: Path, dsn: Path) -> None:
    """Write the board without the router's tracks, and the router's task."""
    pcbnew.KIID.SeedGenerator(20)
    components, nets = read_netlist(netlist)
    write_classes(nets)
    board = pcbnew.NewBoard(str(target))
    board.GetDesignSettings().SetCopperLayerCount(2)
    _title(board)
    _footprints(board, components, nets)
    _outline(board)
    _keepout(board)
    _hand_copper(board, nets)
    pcbnew.SaveBoard(str(target), board)
    if not pcbnew.ExportSpecctraDSN(board, str(dsn)):
        raise SystemExit("the router's task could not be written")


def _title(board: Any) -> None:
    block = pcbnew.TITLE_BLOCK()
    block.SetTitle("Tornillo control board")
    block.SetRevision(silkscreen.REVISION)
    block.SetDate(silkscreen.DATE)
    block.SetCompany("Tornillo")
    block.SetComment(0, "Licence: CERN-OHL-P-2.0")
    board.SetTitleBlock(block)


def _footprints(board: Any, components: list[ElementTree.Element], nets: Nets) -> None:
    places = placement.places()
    items = {}
    for name in nets:
        items[name] = pcbnew.NETINFO_ITEM(board, name)
        board.Add(items[name])
    net_of = {pin: name for name, pins in nets.items() for pin in pins}
    for component in components:
        ref = component.get("ref", "")
        library, name = component.findtext("footprint", "").split(":")
        footprint = pcbnew.FootprintLoad(str(FOOTPRINTS / f"{library}.pretty"), name)
        footprint.SetFPID(pcbnew.LIB_ID(library, name))
        footprint.SetReference(ref)
        footprint.SetValue(component.findtext("value", ""))
        sheet = component.find("sheetpath")
        path = sheet.get("tstamps", "/") if sheet is not None else "/"
        stamp = component.findtext("tstamps", "").split()[0]
        footprint.SetPath(pcbnew.KIID_PATH(path + stamp))
        footprint.SetSheetname(sheet.get("names", "") if sheet is not None else "")
        x, y, angle = places[ref]
        footprint.SetPosition(at(x, y))
        footprint.SetOrientationDegrees(angle)
        for pad in footprint.Pads():
            net = net_of.get((ref, pad.GetNumber()))
            if net:
                pad.SetNet(items[net])
        if ref.startswith("H"):
            footprint.Reference().SetVisible(False)
            footprint.SetAttributes(footprint.GetAttributes() | pcbnew.FP_EXCLUDE_FROM_BOM)
        board.Add(footprint)


def _outline(board: Any) -> None:
    corners = [
        (0, 0),
        (placement.WIDTH, 0),
        (placement.WIDTH, placement.HEIGHT),
        (0, placement.HEIGHT),
    ]
    radius = 3.0
    for index, (x, y) in enumerate(corners):
        nx, ny = corners[(index + 1) % 4]
        dx, dy = (nx > x) - (nx < x), (ny > y) - (ny < y)
        line = pcbnew.PCB_SHAPE(board, pcbnew.SHAPE_T_SEGMENT)
        line.SetStart(at(x + radius * dx, y + radius * dy))
        line.SetEnd(at(nx - radius * dx, ny - radius * dy))
        arc = pcbnew.PCB_SHAPE(board, pcbnew.SHAPE_T_ARC)
        inward = (x + radius if x == 0 else x - radius, y + radius if y == 0 else y - radius)
        arc.SetCenter(at(*inward))
        start = (x, inward[1]) if dx else (inward[0], y)
        arc.SetStart(at(*start))
        arc.SetArcAngleAndEnd(pcbnew.EDA_ANGLE(90.0, pcbnew.DEGREES_T))
        for shape in (line, arc):
            shape.SetLayer(pcbnew.Edge_Cuts)
            shape.SetWidth(pcbnew.FromMM(0.1))
            board.Add(shape)


def _area(board: Any, box: tuple[float, float, float, float]) -> Any:
    zone = pcbnew.ZONE(board)
    left, top, right, bottom = box
    for x, y in ((left, top), (right, top), (right, bottom), (left, bottom)):
        zone.AppendCorner(at(x, y), -1)
    return zone


def _keepout(board: Any) -> None:
    left, right = placement.GAP
    zone = _area(board, (left, 0.0, right, placement.HEIGHT))
    zone.SetIsRuleArea(True)
    zone.SetDoNotAllowTracks(True)
    zone.SetDoNotAllowVias(True)
    zone.SetDoNotAllowCopperPour(True)
    zone.SetDoNotAllowPads(False)
    zone.SetDoNotAllowFootprints(False)
    zone.SetLayerSet(pcbnew.LSET.AllCuMask(2))
    zone.SetZoneName("isolation gap")
    board.Add(zone)


def _hand_copper(board: Any, nets: Nets) -> None:
    full = {name.rsplit("/", 1)[-1]: name for name in nets}
    for name, layer, width, points in copper.TRACKS:
        spots = [_spot(board, point) for point in points]
        for start, end in pairwise(spots):
            track = pcbnew.PCB_TRACK(board)
            track.SetStart(start)
            track.SetEnd(end)
            track.SetLayer(board.GetLayerID(layer))
            track.SetWidth(pcbnew.FromMM(width))
            track.SetNet(board.FindNet(full[name]))
            track.SetLocked(True)
            board.Add(track)


def _spot(board: Any, point: copper.Point) -> Any:
    if isinstance(point, tuple):
        return at(*point)
    ref, number = point.split(".")
    return board.FindFootprintByReference(ref).FindPadByNumber(number).GetPosition()


def write_classes(nets: Nets) -> None:
    """Write net classes and each net's class into the project file."""
    path = HERE / "tornillo.kicad_pro"
    project = json.loads(path.read_text(encoding="utf-8"))
    base = {
        "bus_width": 12,
        "diff_pair_gap": 0.25,
        "diff_pair_via_gap": 0.25,
        "diff_pair_width": 0.3,
        "line_style": 0,
        "microvia_diameter": 0.3,
        "microvia_drill": 0.1,
        "pcb_color": "rgba(0, 0, 0, 0.000)",
        "schematic_color": "rgba(0, 0, 0, 0.000)",
        "wire_width": 6,
    }
    machine_parts = frozenset(ref for ref, (x, _, _) in placement.places().items() if x > 90)
    project["net_settings"] = {
        "classes": [
            {
                **base,
                "name": name,
                "track_width": width,
                "clearance": clearance,
                "via_diameter": via,
                "via_drill": drill,
                "priority": 2147483647 if name == "Default" else index,
            }
            for index, (name, (width, clearance, via, drill)) in enumerate(
                netclasses.CLASSES.items()
            )
        ],
        "meta": {"version": 4},
        "net_colors": None,
        "netclass_assignments": None,
        "netclass_patterns": [
            {
                "netclass": netclasses.class_of(name, netclasses.machine_side(pins, machine_parts)),
                "pattern": name.replace("{slash}", "/"),
            }
            for name, pins in sorted(nets.items())
        ],
    }
    project["board"] = {"design_settings": {"rules": {"min_resolved_spokes": 1}}}
    path.write_text(json.dumps(project, indent=2, sort_keys=True) + "\n", encoding="utf-8")


def finish(target: Path, routes: Path) -> None:
    """Add the router's tracks, the copper areas and the silkscreen."""
    pcbnew.KIID.SeedGenerator(21)
    board = pcbnew.LoadBoard(str(target))
    if not pcbnew.ImportSpecctraSES(board, str(routes)):
        raise SystemExit(f"{routes} could not be read")
    _pours(board)
    words = silkscreen.write(pcbnew, board, at)
    pcbnew.ZONE_FILLER(board).Fill(board.Zones())
    _stitch(board, words)
    pcbnew.ZONE_FILLER(board).Fill(board.Zones())
    pcbnew.SaveBoard(str(target), board)


def _pours(board: Any) -> None:
    left, right = placement.GAP
    edge = 0.6
    areas = [
        ("GND", (edge, edge, left - 0.05, placement.HEIGHT - edge), 0),
        ("MGND", (right + 0.05, edge, placement.WIDTH - edge, placement.HEIGHT - edge), 0),
        ("VMOT", (168.0, 20.5, 184.5, 97.5), 1),
    ]
    for net, box, priority in areas:
        for layer in (pcbnew.F_Cu, pcbnew.B_Cu):
            if net == "VMOT" and layer == pcbnew.F_Cu:
                continue
            zone = _area(board, box)
            zone.SetLayer(layer)
            zone.SetNet(board.FindNet(net))
            zone.SetAssignedPriority(priority)
            zone.SetLocalClearance(pcbnew.FromMM(0.4))
            zone.SetMinThickness(pcbnew.FromMM(0.3))
            zone.SetThermalReliefGap(pcbnew.FromMM(0.4))
            zone.SetThermalReliefSpokeWidth(pcbnew.FromMM(0.5 if net == "GND" else 0.8))
            zone.SetIslandRemovalMode(pcbnew.ISLAND_REMOVAL_MODE_ALWAYS)
            zone.SetZoneName(f"{net} {board.GetLayerName(layer)}")
            board.Add(zone)


def _stitch(board: Any, words: list[silkscreen.Box]) -> None:
    """Join the two sides of each ground with vias, not under words, where both have copper."""
    pitch, ring, slant = 7.0, 0.75, 0.55
    around = [(dx * ring, dy * ring) for dx, dy in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))]
    around += [(dx * slant, dy * slant) for dx in (-1, 1) for dy in (-1, 1)]
    spots = [
        (pitch * (column + 0.5), pitch * (row + 0.5))
        for column in range(int(placement.WIDTH / pitch))
        for row in range(int(placement.HEIGHT / pitch))
    ]
    for net in ("GND", "MGND"):
        zones = [zone for zone in board.Zones() if zone.GetNetname() == net]
        for x, y in spots:
            copper = all(
                zone.HitTestFilledArea(zone.GetFirstLayer(), at(x + dx, y + dy), 0)
                for zone in zones
                for dx, dy in around
            )
            if copper and not _under_word(ORIGIN[0] + x, ORIGIN[1] + y, words):
                via = pcbnew.PCB_VIA(board)
                via.SetPosition(at(x, y))
                via.SetWidth(pcbnew.FromMM(0.8))
                via.SetDrill(pcbnew.FromMM(0.4))
                via.SetNet(board.FindNet(net))
                board.Add(via)


def _under_word(x: float, y: float, words: list[silkscreen.Box]) -> bool:
    margin = 0.5
    return any(
        left - margin < x < right + margin and top - margin < y < bottom + margin
        for left, top, right, bottom in words
    )


if __name__ == "__main__":
    if sys.argv[1:2] == ["place"] and len(sys.argv) == 5:
        place(*(Path(argument) for argument in sys.argv[2:]))
    elif sys.argv[1:2] == ["finish"] and len(sys.argv) == 4:
        finish(*(Path(argument) for argument in sys.argv[2:]))
    else:
        sys.exit(__doc__)
