#!/usr/bin/env bash
# Prepares a Debian machine for Tornillo: packages, SDCC with its PIC16 port,
# the Python environment. Does nothing, in well under a second, when all is
# there. Interrupting it and running it again is safe.
# SPDX-License-Identifier: Apache-2.0
#
# usage: setup.sh CACHE VENV STAMP
#   CACHE   directory outside the checkout; the compiler is kept here
#   VENV    Python environment to make, in the checkout
#   STAMP   file that remembers what has been done
set -euo pipefail

cache=$1 venv=$2 stamp=$3
here=$(dirname "$0")
requirements=host-cli/requirements-dev.txt
sdcc=$cache/sdcc-4.2.0

packages=(gcc g++ make pkg-config python3 python3-venv git ca-certificates
    gputils gpsim gpsim-dev libglib2.0-dev cppcheck clang-format shellcheck
    bison flex texinfo libboost-graph-dev zlib1g-dev dpkg-dev xz-utils)

say() { printf 'setup: %s\n' "$*"; }
die() { printf 'setup: %s\n' "$*" >&2; exit 1; }

wanted=$(cat "$0" "$here/build_sdcc.sh" "$requirements" host-cli/pyproject.toml |
    sha256sum | cut -d ' ' -f 1)
if [ "$(cat "$stamp" 2>/dev/null)" = "$wanted" ] && [ -x "$sdcc/bin/sdcc" ] &&
    [ -x "$venv/bin/python" ]; then
    exit 0
fi

# --- Debian packages ----------------------------------------------------------
missing=()
for package in "${packages[@]}"; do
    case $(dpkg-query -W -f '${Status}' "$package" 2>/dev/null) in
    *" installed") ;;
    *) missing+=("$package") ;;
    esac
done
if [ ${#missing[@]} -gt 0 ]; then
    install="apt-get install -y --no-install-recommends ${missing[*]}"
    if [ "$(id -u)" = 0 ]; then
        root=()
    elif command -v sudo >/dev/null; then
        root=(sudo)
    else
        die "these packages are missing and this user may not install them.
Run as root, then try again:
    apt-get update && $install"
    fi
    say "installing ${#missing[@]} Debian packages: ${missing[*]}"
    "${root[@]}" apt-get -qq update
    # shellcheck disable=SC2086  # a list of package names
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive $install -qq >/dev/null
fi

# --- SDCC -----------------------------------------------------------------------
# A compiler on the PATH is used when it has the port and its library.
use_system_sdcc() {
    local probe library
    command -v sdcc >/dev/null || return 1
    probe=$(mktemp -d)
    echo 'void main(void) {}' >"$probe/probe.c"
    if ! sdcc -mpic16 -p18f4550 --no-warn-non-free -S "$probe/probe.c" \
        -o "$probe/probe.asm" >/dev/null 2>&1; then
        rm -rf "$probe"
        return 1
    fi
    rm -rf "$probe"
    library=$(find / -xdev -path '*/pic16/libsdcc.lib' -print -quit 2>/dev/null)
    [ -n "$library" ] || return 1
    say "using the sdcc that is installed: $(command -v sdcc)"
    mkdir -p "$sdcc/bin" "$sdcc/lib"
    ln -sf "$(command -v sdcc)" "$sdcc/bin/sdcc"
    ln -sf "$library" "$sdcc/lib/libsdcc.lib"
    ln -sfn "$(dirname "$(dirname "$(dirname "$library")")")/include" \
        "$sdcc/include"
}
if [ ! -x "$sdcc/bin/sdcc" ] && ! use_system_sdcc; then
    "$here/build_sdcc.sh" "$sdcc"
fi

# --- Python ---------------------------------------------------------------------
if ! "$venv/bin/python" -c 'import sys; assert sys.version_info >= (3, 11)' \
    2>/dev/null; then
    say "making the Python environment $venv"
    rm -rf "$venv"
    python3 -c 'import sys; assert sys.version_info >= (3, 11)' 2>/dev/null ||
        die "Python 3.11 or newer is needed; found $(python3 --version)"
    python3 -m venv "$venv"
fi
say "installing the pinned Python packages"
install_python() {
    "$venv/bin/python" -m pip install --quiet --disable-pip-version-check "$@"
}
install_python -r "$requirements" || {
    say "download failed, trying once more"
    install_python -r "$requirements"
}
install_python --no-deps --no-build-isolation -e ./host-cli
"$venv/bin/python" - <<'PYTHON'
# Makes the packages in tests/ importable.
import pathlib
import sysconfig

site = pathlib.Path(sysconfig.get_path("purelib"))
(site / "tornillo-tests.pth").write_text(f"{pathlib.Path('tests').resolve()}\n")
PYTHON
mkdir -p "$(dirname "$stamp")"
echo "$wanted" >"$stamp"
say "done"
