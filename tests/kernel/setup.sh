#!/usr/bin/env bash
# Prepares what `make test-kernel` needs besides the project itself: Debian's
# qemu, usbip and lsusb, and in the cache a Debian kernel with the few modules
# a guest needs. Does nothing, in well under a second, when all is there.
# SPDX-License-Identifier: Apache-2.0
#
# usage: setup.sh CACHE
#   CACHE   directory outside the checkout; the kernel is kept in CACHE/linux
set -euo pipefail

target=$1/linux
packages=(qemu-system-x86 usbip usbutils busybox-static cpio kmod)
modules=(virtio_pci virtio_net 9p 9pnet_virtio cdc-acm vhci-hcd)

say() { printf 'test-kernel: %s\n' "$*"; }
die() { printf 'test-kernel: %s\n' "$*" >&2; exit 1; }

missing=()
for package in "${packages[@]}"; do
    case $(dpkg-query -W -f '${Status}' "$package" 2>/dev/null) in
    *" installed") ;;
    *) missing+=("$package") ;;
    esac
done

updated=
update() {
    [ -n "$updated" ] || "${root[@]}" apt-get -qq update
    updated=yes
}

root=()
if [ "$(id -u)" != 0 ] && command -v sudo >/dev/null; then
    root=(sudo)
fi
if [ ${#missing[@]} -gt 0 ]; then
    install=(apt-get install -y --no-install-recommends "${missing[@]}")
    if [ "$(id -u)" != 0 ] && [ ${#root[@]} -eq 0 ]; then
        die "these packages are missing and this user may not install them.
Run as root, then try again:
    apt-get update && ${install[*]}"
    fi
    say "installing ${#missing[@]} Debian packages: ${missing[*]}"
    update
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive "${install[@]}" -qq >/dev/null
fi

[ ! -f "$target/stamp" ] || exit 0

# --- the kernel -----------------------------------------------------------------
# The package that linux-image-amd64 stands for, unpacked, not installed.
update
package=$(apt-cache depends linux-image-amd64 |
    sed -n 's/^ *Depends: \(linux-image-.*\)/\1/p' | head -n 1)
[ -n "$package" ] || die "apt knows no linux-image-amd64; Debian is needed"
say "fetching the kernel $package"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(cd "$work" && apt-get -qq download "$package" 2>/dev/null) ||
    die "$package could not be downloaded"
dpkg-deb -x "$work"/"$package"_*.deb "$work/root"
release=${package#linux-image-}
/sbin/depmod -b "$work/root" "$release"

# Each module with what it depends on, in the order of loading.
rm -rf "$target"
mkdir -p "$target/modules"
for module in "${modules[@]}"; do
    /sbin/modprobe -d "$work/root" -S "$release" --show-depends "$module"
done | sed -n 's/^insmod \([^ ]*\).*/\1/p' | awk '!seen[$0]++' |
    while read -r file; do
        cp "$file" "$target/modules/"
        basename "$file" >>"$target/modules/order"
    done
cp "$work/root/boot/vmlinuz-$release" "$target/vmlinuz"
echo "$package" >"$target/stamp"
