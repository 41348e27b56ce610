# SPDX-License-Identifier: Apache-2.0
"""A real Linux kernel is the host of the simulated device, and the command line works through it.

One guest boots, attaches the device over USB/IP, gets a serial port from its own cdc-acm driver
and makes a part through it; each test looks at one side of that run. Called by ``make
test-kernel`` and not by ``make test``.
"""

from __future__ import annotations

import json
import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from end_to_end.workshop import ZERO_X, ZERO_Z, Workshop, pin_file
from tornillo.protocol import USB_PRODUCT_ID, USB_VENDOR_ID

from kernel.guest import HOST_ADDRESS, Done, Guest

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "usb-descriptors.txt"
CACHE = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "tornillo" / "linux"
USB_ID = f"{USB_VENDOR_ID:04x}:{USB_PRODUCT_ID:04x}"
#: In a variable, "1" writes the page of descriptors anew in place of comparing it.
REFRESH = "TORNILLO_REFRESH_DESCRIPTORS"
WARNING = 4
#: vhci-hcd says this of every full-speed device, at each reset of its port: it knows two speeds.
OF_THE_DRIVER = "vhci_hcd: vhci_device speed not set"
MARK = "the device is attached from here on"
WAIT = "for i in $(seq 100); do [ {test} /dev/ttyACM0 ] && break; sleep 0.1; done"


@dataclass(frozen=True)
class Evidence:
    """What is left of the run: steps of the guest, report of the virtual lathe, lines typed."""

    steps: dict[str, Done]
    workshop: Workshop
    seconds: float


def guest_steps(part: Path, port: str) -> dict[str, str]:
    """Every step of the guest by name; ``port`` is the number to attach to."""
    lathe = str(Path(sys.executable).with_name("tornillo"))
    usbip = f"usbip --tcp-port {port}"
    numbers = (("zero_x", ZERO_X), ("zero_z", ZERO_Z), ("homing_repeats", 1))
    return {
        "release": "uname -sr",
        "mark": f"echo '{MARK}' >/dev/kmsg",
        "list": f"{usbip} list -r {HOST_ADDRESS}",
        "attach": f"{usbip} attach -r {HOST_ADDRESS} -b 1-1",
        "appears": f"{WAIT.format(test='-c')}; ls /dev/ttyACM0",
        "lsusb": f"lsusb -v -d {USB_ID}",
        **{f"set {name}": f"{lathe} settings set {name} {value}" for name, value in numbers},
        "upload": f"{lathe} upload {part}",
        "parts": f"{lathe} parts --json",
        "home": f"{lathe} home",
        "run": f"{lathe} run pin --follow",
        "status": f"{lathe} status --json",
        "again": f"for i in 1 2 3; do {lathe} --port /dev/ttyACM0 status --json || exit 1; done",
        "second attach": f"{usbip} attach -r {HOST_ADDRESS} -b 1-1",
        "detach": "usbip detach -p 00",
        "vanishes": f"{WAIT.format(test='! -e')}; ls /dev/ttyACM0",
        "reattach": f"{usbip} attach -r {HOST_ADDRESS} -b 1-1",
        "appears again": f"{WAIT.format(test='-c')}; {lathe} status --json",
        "messages": "dmesg --raw",
    }


@pytest.fixture(scope="module")
def evidence(tmp_path_factory: pytest.TempPathFactory) -> Evidence:
    """Boot the guest once, do everything, switch off."""
    folder = tmp_path_factory.mktemp("kernel")
    part = pin_file(folder / "pin.toml")
    environment = {
        "PATH": "/usr/sbin:/usr/bin:/sbin:/bin",
        "PYTHONPATH": os.environ.get("PYTHONPATH", ""),
        "PYTHONDONTWRITEBYTECODE": "1",
        "COLUMNS": "200",
        "NO_COLOR": "1",
        "TERM": "dumb",
    }
    options = ("--part", str(part), "--backlash-x", "23", "--backlash-z", "31")
    with Workshop(folder, *options, "--usbip", "127.0.0.1:0") as workshop:
        port = workshop.announced.split(":")[-1].split()[0]
        guest = Guest(CACHE, folder)
        steps = guest.run(guest_steps(part, port), environment)
    print(f"{steps['release'].output.strip()}, {guest.seconds:.0f} s")
    return Evidence(steps, workshop, guest.seconds)


def must(evidence: Evidence, name: str) -> str:
    """Return what a step printed; it must have succeeded."""
    done = evidence.steps[name]
    assert done.code == 0, f"{name}: {done.output}"
    return done.output


def messages(evidence: Evidence) -> list[tuple[int, str]]:
    """The kernel's messages since the device was attached, with their levels."""
    found = re.findall(r"^<(\d+)>\[ *[\d.]+\] (.*)$", must(evidence, "messages"), re.MULTILINE)
    texts = [(int(level) & 7, text) for level, text in found]
    first = next(i for i, (_, text) in enumerate(texts) if text == MARK)
    return texts[first + 1 :]


def test_the_kernel_lists_and_attaches_the_device(evidence: Evidence) -> None:
    assert USB_ID in must(evidence, "list")
    must(evidence, "attach")


def test_the_kernels_own_driver_makes_a_serial_port_of_it(evidence: Evidence) -> None:
    assert must(evidence, "appears") == "/dev/ttyACM0\n"
    lines = [text for _, text in messages(evidence)]
    assert any(re.search(r"cdc_acm .*: ttyACM0: USB ACM device", line) for line in lines), lines


def test_dmesg_shows_the_enumeration_without_a_warning(evidence: Evidence) -> None:
    found = messages(evidence)
    text = "\n".join(line for _, line in found)
    for part in (
        "new full-speed USB device",
        f"idVendor={USB_VENDOR_ID:04x}, idProduct={USB_PRODUCT_ID:04x}",
        "Product: Tornillo lathe",
        "Manufacturer: Tornillo",
        "SerialNumber: 00000000",
    ):
        assert part in text
    warnings = [line for level, line in found if level <= WARNING and line != OF_THE_DRIVER]
    assert warnings == []


def readable(listing: str) -> str:
    """The listing without what depends on the machine: place on the bus, names from its lists."""
    listing = re.sub(r"^Bus \d+ Device \d+: (ID \S+).*$", r"\1", listing, flags=re.MULTILINE)
    listing = re.sub(
        r"^( +id(?:Vendor|Product) +0x[0-9a-f]{4}).*$", r"\1", listing, flags=re.MULTILINE
    )
    return "".join(f"{line.rstrip()}\n" for line in listing.strip().splitlines())


def test_lsusb_inside_shows_what_the_documentation_shows(evidence: Evidence) -> None:
    shown = readable(must(evidence, "lsusb"))
    if os.environ.get(REFRESH) == "1":
        PAGE.write_text(shown, encoding="utf-8")
    assert shown == PAGE.read_text(encoding="utf-8")


def test_a_part_is_uploaded_and_cut_through_the_kernels_driver(evidence: Evidence) -> None:
    assert "pin" in must(evidence, "upload")
    (stored,) = json.loads(must(evidence, "parts"))
    assert stored["name"] == "pin"
    must(evidence, "home")
    assert must(evidence, "run").endswith("finished\n")
    status = json.loads(must(evidence, "status"))
    assert (status["state"], status["permille"]) == ("IDLE", 1000)
    assert (status["dead_x"], status["dead_z"]) == (23, 31)
    evidence.workshop.assert_part_is_right()


def test_the_port_can_be_opened_and_closed_again_and_again(evidence: Evidence) -> None:
    assert must(evidence, "again").count('"state": "IDLE"') == 3


def test_the_device_is_one_hosts_at_a_time(evidence: Evidence) -> None:
    assert evidence.steps["second attach"].code != 0


def test_the_port_goes_with_the_device_and_comes_back_with_it(evidence: Evidence) -> None:
    must(evidence, "detach")
    assert evidence.steps["vanishes"].code != 0
    must(evidence, "reattach")
    assert json.loads(must(evidence, "appears again"))["state"] == "IDLE"


def test_the_engine_and_the_bus_saw_no_mistake(evidence: Evidence) -> None:
    assert evidence.workshop.report["usb_errors"] == []
