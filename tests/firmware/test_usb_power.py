# SPDX-License-Identifier: Apache-2.0
"""A board may feed itself or live on the cable: its firmware says what its builder chose.

What is compiled for each is looked at; the build for a board on the cable runs on the simulated
chip. Such a board is switched on by the cable, and VBUS is always there while it runs.
"""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import branch, on_a_new_chip
from tornillo.protocol import State
from virtual_lathe.chip import NonVolatile

from firmware.usb_bench import UsbBench

ROOT = Path(__file__).resolve().parents[2]
CACHE = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "tornillo"
SDCC = CACHE / "sdcc-4.2.0"
FLAGS = [
    *["-mpic16", "-p18f4550", "--no-warn-non-free", "--nostdlib", "--nostdinc", "-S"],
    *[f"-I{SDCC}/include/pic16", f"-I{SDCC}/include"],
    *[f"-I{ROOT}/build/firmware", f"-I{ROOT}/firmware"],
]
ATTRIBUTES_AT, CURRENT_AT = 7, 8
BUS_POWERED = ROOT / "build" / "bus-powered" / "tornillo.hex"
GET_STATUS, GET_DESCRIPTOR, SET_CONFIGURATION, CONFIGURATION_DESCRIPTOR = 0, 6, 9, 0x0200
RUN_TIMEOUT_S = 20.0


def configuration(folder: Path, *options: str) -> list[int]:
    """The configuration descriptor as the compiler writes it."""
    target = folder / "descriptors.asm"
    source = ROOT / "firmware" / "usb" / "descriptors.c"
    command = [str(SDCC / "bin" / "sdcc"), *FLAGS, *options, str(source), "-o", str(target)]
    subprocess.run(command, check=True, capture_output=True)
    text = target.read_text(encoding="latin-1")
    lines = text.split("_configuration_descriptor:", 1)[1].splitlines()
    table = []
    for line in lines[1:]:
        if not line.strip().startswith("DB"):
            break
        table += [int(byte, 16) for byte in re.findall(r"0x([0-9a-f]{2})", line)]
    return table


@pytest.mark.parametrize(
    ("options", "attributes", "current"),
    [
        ([], 0xC0, 50),
        (["-DUSB_SELF_POWERED=0", "-DUSB_BUS_CURRENT_MA=500"], 0x80, 250),
        (["-DUSB_SELF_POWERED=1", "-DUSB_BUS_CURRENT_MA=0"], 0xC0, 0),
    ],
    ids=["as built", "fed by the cable", "takes nothing from the cable"],
)
def test_the_configuration_says_where_the_power_comes_from(
    tmp_path: Path, options: list[str], attributes: int, current: int
) -> None:
    table = configuration(tmp_path, *options)
    assert (table[ATTRIBUTES_AT], table[CURRENT_AT]) == (attributes, current)


@pytest.mark.parametrize("wrong", ["USB_BUS_CURRENT_MA=502", "USB_BUS_CURRENT_MA=99"])
def test_a_current_that_usb_does_not_know_is_a_compile_error(tmp_path: Path, wrong: str) -> None:
    with pytest.raises(subprocess.CalledProcessError):
        configuration(tmp_path, f"-D{wrong}")


# -- on the simulated chip -------------------------------------------------------------------------


def powers(bench: UsbBench) -> tuple[bytes, int, int]:
    """GET_STATUS of the device, attributes and current of its configuration."""
    read = bench.host.control(0x80, GET_DESCRIPTOR, CONFIGURATION_DESCRIPTOR, length=9)
    status = bench.host.control(0x80, GET_STATUS, length=2)
    return status, read[ATTRIBUTES_AT], read[CURRENT_AT]


@pytest.mark.parametrize("on_the_cable", [False, True], ids=["self-powered", "bus-powered"])
@on_a_new_chip
def test_the_device_tells_its_power_in_every_state(on_the_cable: bool) -> None:
    bench = UsbBench(firmware=BUS_POWERED) if on_the_cable else UsbBench()
    bench.enumerate()
    told = (b"\0\0", 0x80, 250) if on_the_cable else (b"\1\0", 0xC0, 50)
    assert powers(bench) == told
    bench.host.control(0x00, SET_CONFIGURATION, 0)  # back to the address
    assert powers(bench) == told
    bench.host.control(0x00, SET_CONFIGURATION, 1)
    bench.host.suspend(True)
    bench.host.wait(0.01)
    bench.host.suspend(False)
    bench.host.wait(0.002)
    assert powers(bench) == told
    bench.host.reset_bus()
    assert powers(bench.enumerate()) == told


def switched_off_in_a_run() -> NonVolatile:
    """Home a lathe on the cable, store a part, and pull the cable, its power, in a run."""
    bench = little_pin.homed_lathe_with_pin(firmware=BUS_POWERED)
    bench.host.run()
    bench.wait(lambda: bench.moving, 1.0)
    bench.run(0.3)
    return bench.chip.save()


@on_a_new_chip
def test_a_lathe_on_the_cable_works_again_after_each_plugging_in() -> None:
    memory = branch(switched_off_in_a_run)
    bench = Bench(memory, firmware=BUS_POWERED, **little_pin.OPTIONS)
    bench.lathe.wanted = little_pin.wanted()
    stored = {part.name: bench.host.read(part.slot) for part in bench.host.parts()}
    assert stored == {"little-pin": little_pin.image()}
    assert bench.is_in(State.IDLE)
    assert not bench.homed
    bench.home()
    bench.host.run()
    bench.wait(lambda: bench.state is not State.RUNNING, RUN_TIMEOUT_S)
    little_pin.assert_cut_exactly(bench)
