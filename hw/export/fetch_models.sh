#!/bin/bash
# SPDX-License-Identifier: CERN-OHL-P-2.0
#
# Takes the 3D models the board names out of Debian's kicad-packages3d and
# keeps them in the cache: 3 MB in place of the package's 5 GB. Prints the
# folder. Fails where the package cannot be fetched; pictures and STEP then
# show the bare board.
#
#   fetch_models.sh BOARD.kicad_pcb
set -euo pipefail
board=$(realpath "$1")
cache="${XDG_CACHE_HOME:-$HOME/.cache}/tornillo/3dmodels"
mkdir -p "$cache"

mapfile -t wanted < <(grep -o '"${KICAD9_3DMODEL_DIR}/[^"]*"' "$board" |
    sed 's/^"${KICAD9_3DMODEL_DIR}\///; s/"$//' | sort -u)
wanted_list=$(printf '%s\n' "${wanted[@]}" | sha256sum)
if [[ "$(cat "$cache/list" 2>/dev/null)" != "$wanted_list" ]]; then
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    chmod 755 "$work"
    (cd "$work" && apt-get -q download kicad-packages3d/bookworm-backports >/dev/null)
    printf './usr/share/kicad/3dmodels/%s\n' "${wanted[@]}" >"$work/names"
    dpkg-deb --fsys-tarfile "$work"/*.deb |
        tar x -C "$cache" --strip-components=5 --files-from="$work/names" 2>"$work/missing" || true
    printf '%s\n' "$wanted_list" >"$cache/list"
fi
printf '%s\n' "$cache"
