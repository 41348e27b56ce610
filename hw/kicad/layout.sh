#!/bin/bash
# SPDX-License-Identifier: CERN-OHL-P-2.0
#
# Draws the schematic and lays out the board again, with the routes kept in
# layout/tornillo.ses. After parts have moved the routes no longer fit: then
# give build/hw/tornillo.dsn to a router (freerouting was used), put its result
# in place of layout/tornillo.ses and run this again.
set -euo pipefail
cd "$(dirname "$0")"
out=../../build/hw
mkdir -p "$out"
/usr/bin/python3 draw.py
kicad-cli sch export netlist --format kicadxml -o "$out/netlist.xml" tornillo.kicad_sch
/usr/bin/python3 build_board.py place "$out/netlist.xml" tornillo.kicad_pcb "$out/tornillo.dsn"
/usr/bin/python3 build_board.py finish tornillo.kicad_pcb layout/tornillo.ses
