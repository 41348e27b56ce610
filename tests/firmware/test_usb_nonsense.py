# SPDX-License-Identifier: Apache-2.0
"""Nonsense from the host, repeatable by its seed, must leave the device sane.

Requests right, nearly right and random; abandoned at any point; with lost handshakes, packets for
the wrong endpoint or with the wrong toggle, bus resets, sleep and pulled cables in between.
"""

from __future__ import annotations

import random
import struct

import pytest
from simulated.processes import on_a_new_chip
from tornillo.protocol import Command, ErrorCode
from virtual_lathe.usb_host import Token

from firmware.usb_bench import UsbBench

TRANSFERS = 300
KNOWN = [
    (0x80, 0), (0x81, 0), (0x82, 0), (0x00, 1), (0x02, 1), (0x02, 3), (0x80, 6), (0x80, 8),
    (0x00, 9), (0x81, 10), (0x01, 11), (0x21, 0x20), (0xA1, 0x21), (0x21, 0x22), (0x21, 0x23),
]  # fmt: skip
SET_ADDRESS = (0x00, 5)  # would only make the host lose the device


def random_setup(chance: random.Random) -> bytes:
    """A SETUP packet: mostly a request that exists, with likely or random fields."""
    kind = SET_ADDRESS
    while kind == SET_ADDRESS:
        if chance.random() < 0.7:
            kind = chance.choice(KNOWN)
        else:
            kind = (chance.randrange(256), chance.randrange(256))
    anything = chance.randrange(65536)
    value = chance.choice([0, 1, 3, 0x100, 0x200, 0x300, 0x302, 0x303, anything])
    index = chance.choice([0, 1, 0x81, 0x02, 0x82, 0x0409, anything])
    length = chance.choice([0, 1, 2, 7, 8, 16, 18, 67, 255, anything])
    return struct.pack("<BBHHH", *kind, value, index, length)


def random_transaction(bench: UsbBench, chance: random.Random) -> None:
    """Something after the SETUP that may or may not belong to it."""
    bench.host.wait(chance.random() * 2e-4)
    bench.host.lose_handshakes(int(chance.random() < 0.1))
    toggle = chance.randrange(2)
    what = chance.random()
    if what < 0.5:
        bench.host.transaction(Token.IN, 0)
    elif what < 0.8:
        bench.host.transaction(Token.OUT, 0, toggle, chance.randbytes(chance.choice([0, 7, 16])))
    elif what < 0.9:
        bench.host.transaction(Token.OUT, 2, toggle, chance.randbytes(chance.randrange(65)))
    else:
        bench.host.transaction(Token.IN, chance.choice([1, 2]))
    bench.host.lose_handshakes(0)


def random_accident(bench: UsbBench, chance: random.Random) -> None:
    """Now and then: bus reset, sleep, or the cable out and in again."""
    what = chance.random()
    if what < 0.01:
        bench.host.reset_bus()
        bench.host.wait(0.01)
    elif what < 0.02:
        bench.host.suspend(True)
        bench.host.wait(0.006)
        bench.host.suspend(False)
        bench.host.wait(0.002)
    elif what < 0.025:
        bench.host.unplug()
        bench.host.wait(chance.random() * 0.02)
        bench.host.plug()
        bench.host.wait(0.1)


@pytest.mark.parametrize("seed", [1, 2, 3])
@on_a_new_chip
def test_nonsense_on_the_bus_does_no_harm(seed: int) -> None:
    bench = UsbBench().enumerate()
    chance = random.Random(seed)
    for _ in range(TRANSFERS):
        bench.host.setup(random_setup(chance))
        for _ in range(chance.randrange(6)):
            random_transaction(bench, chance)
        random_accident(bench, chance)
        bench.assert_no_mistakes()
    bench.open()
    bench.send_raw(b"\0")
    bench.receive_raw(timeout=0.05)
    assert bench.ask(1, Command.HELLO)[0] == ErrorCode.OK
