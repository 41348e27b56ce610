# SPDX-License-Identifier: Apache-2.0
"""A board may feed itself or live on the cable: the descriptors say what its builder chose."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CACHE = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "tornillo"
SDCC = CACHE / "sdcc-4.2.0"
FLAGS = [
    *["-mpic16", "-p18f4550", "--no-warn-non-free", "--nostdlib", "--nostdinc", "-S"],
    *[f"-I{SDCC}/include/pic16", f"-I{SDCC}/include"],
    *[f"-I{ROOT}/build/firmware", f"-I{ROOT}/firmware"],
]
ATTRIBUTES_AT, CURRENT_AT = 7, 8


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
