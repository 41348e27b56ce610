#!/bin/bash
# SPDX-License-Identifier: CERN-OHL-P-2.0
#
# Installs what the board needs: KiCad 9 from Debian's backports, ngspice and
# the tools that turn PDF and SVG into pictures. Does nothing where they are
# there already. Needs Debian 12 and root (or sudo).
set -euo pipefail

KICAD=bookworm-backports

present() {
    kicad-cli version 2>/dev/null | grep -q '^9\.' &&
        command -v ngspice rsvg-convert >/dev/null &&
        [[ -d /usr/share/kicad/footprints && -d /usr/share/kicad/symbols ]] &&
        /usr/bin/python3 -c 'import pcbnew, numpy, matplotlib' 2>/dev/null
}

refuse() {
    printf 'The board cannot be built here: %s\n' "$1" >&2
    printf '%s\n' \
        'It needs KiCad 9 (kicad-cli, pcbnew), its symbols and footprints, ngspice,' \
        'librsvg2-bin and python3-matplotlib. On Debian 12 "make hw-install" takes' \
        'KiCad from bookworm-backports; elsewhere install KiCad 9 by hand.' >&2
    exit 1
}

present && exit 0

as_root=()
if [[ $EUID -ne 0 ]]; then
    command -v sudo >/dev/null || refuse 'installing needs root, and there is no sudo.'
    as_root=(sudo)
fi
command -v apt-get >/dev/null || refuse 'there is no apt-get.'
grep -q 'VERSION_CODENAME=bookworm' /etc/os-release || refuse 'this is not Debian 12.'

sources=/etc/apt/sources.list.d/bookworm-backports.sources
if [[ "$(apt-cache policy)" != *"n=$KICAD"* ]]; then
    echo 'Adding Debian backports to the package sources.'
    "${as_root[@]}" tee "$sources" >/dev/null <<EOF
Types: deb
URIs: http://deb.debian.org/debian
Suites: $KICAD
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
EOF
fi
echo 'Installing KiCad 9 and ngspice (about 120 MB).'
"${as_root[@]}" apt-get -q update >/dev/null || refuse 'the package lists cannot be read.'
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q install -y \
    --no-install-recommends "kicad/$KICAD" "kicad-symbols/$KICAD" "kicad-footprints/$KICAD" \
    ngspice poppler-utils librsvg2-bin python3-numpy python3-matplotlib >/dev/null ||
    refuse "Debian's backports no longer have KiCad, or cannot be reached."
present || refuse 'KiCad was installed but does not answer as version 9.'
