# SPDX-License-Identifier: Apache-2.0
"""A Debian kernel in an emulated machine that sees this machine's files, read-only.

The guest boots from a small initial file system, mounts this machine's root directory and runs
steps there, each a line of shell. So everything that is installed here runs there, with the
guest's kernel under it: its drivers, its devices, its network. The host's loopback is
``HOST_ADDRESS`` in the guest.
"""

from __future__ import annotations

import shlex
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

HOST_ADDRESS = "10.0.2.2"
MEMORY_MB = 384
#: Wall seconds after which the guest is taken for stuck; it needs about one minute.
STUCK_S = 600
_BEGIN, _END = "=== ", "--- "

_INIT = """#!/bin/busybox sh
PATH=/bin
/bin/busybox mkdir -p /proc /sys /dev /host
/bin/busybox --install /bin
mount -t proc none /proc
mount -t sysfs none /sys
mount -t devtmpfs none /dev
while read -r module; do
    insmod "/modules/$module" || echo "cannot load $module"
done </modules/order
ip link set lo up
ip address add 10.0.2.15/24 dev eth0
ip link set eth0 up
mount -t 9p -o ro,trans=virtio,version=9p2000.L,cache=loose,msize=262144 root /host
for place in proc sys dev; do
    mount -o bind "/$place" "/host/$place"
done
mount -t tmpfs none /host/run
chroot /host /bin/sh "$steps" >/dev/ttyS1 2>&1
sync
poweroff -f
"""


@dataclass(frozen=True)
class Done:
    """What came of a step: exit code, both outputs mixed."""

    code: int
    output: str


class GuestError(RuntimeError):
    """The guest did not boot or did not come to its end."""


class Guest:
    """A machine that boots, runs steps and is switched off.

    Args:
        linux: directory with kernel and modules, as ``setup.sh`` makes it.
        folder: for the files of the run; its console stays in ``console.txt``.
    """

    def __init__(self, linux: Path, folder: Path) -> None:
        """Build the initial file system."""
        self._linux = linux
        self._folder = folder
        self.console = folder / "console.txt"
        self.seconds = 0.0
        root = folder / "initial"
        (root / "bin").mkdir(parents=True)
        (root / "bin" / "busybox").write_bytes(Path("/bin/busybox").read_bytes())
        (root / "bin" / "busybox").chmod(0o755)
        (root / "init").write_text(_INIT, encoding="utf-8")
        (root / "init").chmod(0o755)
        (root / "modules").symlink_to(linux / "modules")
        archive = subprocess.run(
            "find -L . -print | cpio --quiet -L -o -H newc | gzip -1",
            shell=True,
            cwd=root,
            check=True,
            capture_output=True,
        )
        (folder / "initial.gz").write_bytes(archive.stdout)

    def run(self, steps: dict[str, str], environment: dict[str, str]) -> dict[str, Done]:
        """Boot, run the steps in their order, switch off; return what came of each.

        A step that fails does not keep the next ones from running.

        Raises:
            GuestError: a step has no end; the message holds the last lines of the console.
        """
        lines = [f"export {name}={shlex.quote(value)}" for name, value in environment.items()]
        for name, command in steps.items():
            lines += [f"echo '{_BEGIN}{name}'", command, f'echo "{_END}$?"']
        script = self._folder / "steps.sh"
        script.write_text("\n".join(lines) + "\n", encoding="utf-8")
        answers = self._folder / "answers.txt"
        started = time.monotonic()
        subprocess.run(
            [
                *["qemu-system-x86_64", "-accel", "tcg", "-m", str(MEMORY_MB)],
                *["-display", "none", "-monitor", "none", "-no-reboot"],
                *["-kernel", str(self._linux / "vmlinuz")],
                *["-initrd", str(self._folder / "initial.gz")],
                *["-append", f"console=ttyS0 loglevel=6 panic=1 steps={script}"],
                *["-serial", f"file:{self.console}", "-serial", f"file:{answers}"],
                *["-netdev", "user,id=n", "-device", "virtio-net-pci,netdev=n,romfile="],
                "-virtfs",
                "local,path=/,mount_tag=root,security_model=none,readonly=on,multidevs=remap",
            ],
            check=True,
            timeout=STUCK_S,
            stdin=subprocess.DEVNULL,
        )
        self.seconds = time.monotonic() - started
        done = _parse(answers.read_text(encoding="utf-8", errors="replace"))
        if list(done) != list(steps):
            console = self.console.read_text(encoding="utf-8", errors="replace")
            raise GuestError("the guest stopped early:\n" + "\n".join(console.splitlines()[-30:]))
        return done


def _parse(text: str) -> dict[str, Done]:
    """The steps that ended, by name."""
    done: dict[str, Done] = {}
    name = ""
    lines: list[str] = []
    for line in text.replace("\r", "").splitlines():
        if line.startswith(_BEGIN):
            name, lines = line.removeprefix(_BEGIN), []
        elif line.startswith(_END) and name:
            done[name] = Done(int(line.removeprefix(_END)), "\n".join(lines) + "\n")
            name = ""
        else:
            lines.append(line)
    return done
