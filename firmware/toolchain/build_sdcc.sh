#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Builds SDCC with its PIC16 port from Debian's source package, into a cache
# outside the checkout, and prints nothing but what it is doing.
#
# Debian's sdcc binary has the port switched off; its source package has it.
# Only the compiler, the preprocessor, the compiler's run-time library and the
# C start-up object are kept (6 MB). About three minutes on two cores.
#
# usage: build_sdcc.sh PREFIX
#   PREFIX   directory to create; it appears only when everything in it works,
#            so an interrupted build leaves nothing half done behind.
set -euo pipefail

prefix=$1
version=4.2.0
tarball="sdcc_${version}+dfsg.orig.tar.xz"
sha256=ebe7bfb0894380cd92798b57fb9de96e6c0b913a02b6854d0a01cd70328c1578
chip=18f4550

say() { printf 'sdcc: %s\n' "$*"; }
die() { printf 'sdcc: %s\n' "$*" >&2; exit 1; }

mkdir -p "$(dirname "$prefix")"
# One builder at a time: a second `make` waits for the first and then finds
# the work done.
exec 9>"$prefix.lock"
flock 9
[ -x "$prefix/bin/sdcc" ] && { say "found in $prefix"; exit 0; }
work=$(mktemp -d "$prefix.build.XXXXXX")
trap 'rm -rf "$work"' EXIT

# --- download ---------------------------------------------------------------
# A private apt configuration: the machine's own source list stays untouched,
# no root needed. Mirror and suite are the ones the machine already uses.
download() {
    local apt=$work/apt mirror
    rm -rf "$apt"
    mkdir -p "$apt/lists/partial" "$apt/parts"
    mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' \
        'Codename: bookworm' | head -n 1)
    [ -n "$mirror" ] || mirror=$(apt-get indextargets --format '$(SITE)' \
        'Created-By: Packages' | grep -m 1 debian) || true
    [ -n "$mirror" ] || die "no Debian mirror in the machine's apt sources;
add one (see 'man sources.list'), run apt-get update, then try again"
    printf 'Types: deb-src\nURIs: %s\nSuites: bookworm\nComponents: main\n%s\n' \
        "$mirror" 'Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg' \
        >"$apt/parts/source.sources"
    local options=(-o "Dir::Etc::sourcelist=/dev/null"
        -o "Dir::Etc::sourceparts=$apt/parts" -o "Dir::State::lists=$apt/lists"
        -o "Dir::Cache=$apt" -o "APT::Sandbox::User=$(id -un)")
    apt-get -qq "${options[@]}" update
    (cd "$work" && apt-get -qq "${options[@]}" source --download-only \
        "sdcc=$version+dfsg-1")
}
say "downloading the source package $version (11 MB)"
if ! download; then
    say "download failed, trying once more in 10 s"
    sleep 10
    download || die "the download failed twice; check the network and run
the same command again, nothing else is lost"
fi
(cd "$work" && echo "$sha256  $tarball" | sha256sum --check --quiet) ||
    die "$tarball does not have the expected checksum; refusing to build it"

# --- compiler ---------------------------------------------------------------
say "unpacking"
mkdir "$work/source"
tar -xJf "$work/$tarball" -C "$work/source" --strip-components=1
mkdir "$work/build"
cd "$work/build"
disabled=()
for port in mcs51 z80 z180 r2k r2ka r3ka sm83 tlcs90 ez80_z80 z80n ds390 \
    ds400 hc08 s08 stm8 pdk13 pdk14 pdk15 mos6502 mos65c02 pic14; do
    disabled+=("--disable-$port-port")
done
say "configuring (20 s)"
"$work/source/configure" --prefix="$prefix" "${disabled[@]}" --disable-ucsim \
    --disable-sdcdb --disable-non-free --disable-packihx \
    >"$work/configure.log" 2>&1 || {
    tail -n 20 "$work/configure.log" >&2
    die "configure failed"
}
say "compiling with $(nproc) processes (2 to 3 minutes)"
# The build stops in device/lib/pic16, whose device files Debian leaves out;
# the compiler is finished by then, so success is judged by what exists.
make -j"$(nproc)" >"$work/make.log" 2>&1 &
maker=$!
while kill -0 "$maker" 2>/dev/null; do
    sleep 10
    if kill -0 "$maker" 2>/dev/null; then
        say "  $(grep -c -E '^(g\+\+|gcc|.*-c )' "$work/make.log" || true) files compiled"
    fi
done
wait "$maker" || true
[ -x bin/sdcc ] && [ -x bin/sdcpp ] || {
    tail -n 20 "$work/make.log" >&2
    die "the compiler did not build"
}

# --- run-time library and start-up object -----------------------------------
say "compiling the run-time library"
device=$work/source/device
stage=$work/stage
mkdir -p "$stage/bin" "$stage/lib" "$stage/include" "$work/objects"
cp bin/sdcc bin/sdcpp "$stage/bin/"
cp -r "$device/include/pic16" "$stage/include/pic16"
cp "$device/include/"*.h "$stage/include/"
export PATH="$stage/bin:$PATH"
flags=(-mpic16 "-p$chip" --no-warn-non-free --nostdlib --nostdinc
    "-I$device/include/pic16" "-I$device/include")
for source in "$device"/lib/pic16/libsdcc/*/*.c; do
    sdcc "${flags[@]}" -c "$source" -o "$work/objects/$(basename "$source" .c).o" \
        >>"$work/library.log" 2>&1 || die "$(tail -n 5 "$work/library.log")"
done
for source in "$device"/lib/pic16/libsdcc/*/*.S; do
    name=$(basename "$source" .S)
    cpp -P "$source" "$work/objects/$name.asm" 2>>"$work/library.log"
    (cd "$work/objects" && gpasm "-p$chip" -c "$name.asm") \
        >>"$work/library.log" 2>&1 || die "$(tail -n 5 "$work/library.log")"
done
(cd "$work/objects" && gplib -q -c "$stage/lib/libsdcc.lib" ./*.o)
sdcc "${flags[@]}" -c "$device/lib/pic16/startup/crt0i.c" \
    -o "$stage/lib/crt0i.o" >>"$work/library.log" 2>&1
strip "$stage/bin/"*

# --- prove it, then put it in place ------------------------------------------
printf 'unsigned long f(unsigned long a, unsigned long b) { return a * b; }\n' \
    >"$work/probe.c"
sdcc "${flags[@]}" -c "$work/probe.c" -o "$work/probe.o" ||
    die "the new compiler cannot compile a one-line program"
rm -rf "$prefix"
mv "$stage" "$prefix"
say "ready in $prefix"
