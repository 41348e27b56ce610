# SPDX-License-Identifier: Apache-2.0
"""Control transfers that are right, nearly right or random, abandoned at any point.

Between them lost handshakes, packets for the wrong endpoint or with the wrong toggle, bus resets,
sleep and pulled cables. A case is a line of text (see ``corpus/README.md``), so what broke the
firmware once goes into the corpus as it is printed.
"""

from __future__ import annotations

import random
import struct
from dataclasses import dataclass
from pathlib import Path

from virtual_lathe.usb_host import Token

from fuzz.target import Broken, Target

CORPUS = Path(__file__).with_name("corpus") / "transfers.txt"
UADDR = 0xF6E
ALIVE_EVERY = 1000
CHECK_EVERY = 50
KNOWN = [
    (0x80, 0), (0x81, 0), (0x82, 0), (0x00, 1), (0x02, 1), (0x02, 3), (0x00, 5), (0x80, 6),
    (0x80, 8), (0x00, 9), (0x81, 10), (0x01, 11), (0x21, 0x20), (0xA1, 0x21), (0x21, 0x22),
    (0x21, 0x23),
]  # fmt: skip
VALUES = [0, 1, 3, 0x100, 0x200, 0x300, 0x302, 0x303]
INDICES = [0, 1, 0x81, 0x02, 0x82, 0x0409]
LENGTHS = [0, 1, 2, 7, 8, 16, 18, 67, 255]


def corpus() -> list[str]:
    """The cases kept in the tree."""
    lines = CORPUS.read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


@dataclass
class Counts:
    """Transfers made, by what they were."""

    transfers: int = 0
    accidents: int = 0


class TransferFuzzer:
    """Makes transfers on a target; the same seed makes the same ones."""

    def __init__(self, target: Target, seed: int) -> None:
        """Begin with a configured device."""
        self._target = target
        self._host = target.bench.host
        self._chance = random.Random(seed)
        self._corpus = corpus()
        self.counts = Counts()
        self.recent: list[str] = []

    def run(self, transfers: int) -> None:
        """Make so many transfers.

        Raises:
            Broken: with the cases since the last check, the newest last.
        """
        try:
            for _ in range(transfers):
                case = self.case()
                self.recent.append(case)
                self.play(case)
                if self.counts.transfers % CHECK_EVERY == 0:
                    self._target.check()
                    self.recent.clear()
                if self.counts.transfers % ALIVE_EVERY == 0:
                    self._target.check_alive()
        except Broken as broken:
            cases = "\n".join(self.recent)
            raise Broken(f"{broken}\nafter transfer {self.counts.transfers}:\n{cases}") from broken

    def check_alive(self) -> None:
        """See :meth:`Target.check_alive`."""
        self._target.check_alive()

    # -- making cases ------------------------------------------------------------------------------

    def case(self) -> str:
        """The next case."""
        chance = self._chance
        if chance.random() < 0.1:
            return self._mutated(chance.choice(self._corpus))
        steps = [f"setup {self._setup().hex()}"]
        steps += [self._step() for _ in range(chance.randrange(6))]
        if chance.random() < 0.02:
            steps.append(self._accident())
        return "; ".join(steps)

    def _mutated(self, case: str) -> str:
        """A case of the corpus with steps left out, doubled or added."""
        chance = self._chance
        steps = case.split("; ")
        for _ in range(chance.randrange(3)):
            at = chance.randrange(len(steps))
            what = chance.random()
            if what < 0.3:
                steps.insert(at, self._step())
            elif what < 0.6:
                steps.insert(at, steps[at])
            elif len(steps) > 1:
                del steps[at]
        return "; ".join(steps)

    def _setup(self) -> bytes:
        chance = self._chance
        kind = chance.choice(KNOWN)
        if chance.random() < 0.25:
            kind = (chance.randrange(256), chance.randrange(256))
        anything = chance.randrange(65536)
        value = chance.choice([*VALUES, anything])
        index = chance.choice([*INDICES, anything])
        length = chance.choice([*LENGTHS, anything])
        return struct.pack("<BBHHH", *kind, value, index, length)

    def _step(self) -> str:
        chance = self._chance
        toggle = chance.randrange(2)
        small = chance.randbytes(chance.choice([0, 1, 7, 8, 15, 16]))
        large = chance.randbytes(chance.randrange(65))
        weights = {
            "in 0": 45,
            f"out 0 {toggle} {small.hex()}": 25,
            f"out 2 {toggle} {large.hex()}": 10,
            f"in {chance.choice([1, 2])}": 8,
            f"in {chance.randrange(16)}": 2,
            "lose": 5,
            f"wait {chance.randrange(300)}": 5,
        }
        return chance.choices(list(weights), list(weights.values()))[0]

    def _accident(self) -> str:
        chance = self._chance
        what = chance.random()
        if what < 0.5:
            return f"reset {chance.randrange(300)}"
        if what < 0.8:
            return f"sleep {chance.choice([1000, 2900, 3100, 6000])}"
        return f"unplug {chance.randrange(20000)}"

    # -- playing them ------------------------------------------------------------------------------

    def play(self, case: str) -> None:
        """Do what a case says."""
        self.counts.transfers += 1
        self._host.address = self._target.bench.chip.peek(UADDR)
        for step in case.split("; "):
            self._play_step(*step.split(" "))
        self._host.lose_handshakes(0)

    def _play_step(self, verb: str, *words: str) -> None:
        host = self._host
        if verb == "setup":
            host.setup(bytes.fromhex(words[0]))
        elif verb == "in":
            host.transaction(Token.IN, int(words[0]))
        elif verb == "out":
            data = bytes.fromhex("".join(words[2:]))
            host.transaction(Token.OUT, int(words[0]), int(words[1]), data)
        elif verb == "lose":
            host.lose_handshakes(1)
        elif verb == "wait":
            host.wait(int(words[0]) / 1e6)
        else:
            self.counts.accidents += 1
            self._play_accident(verb, int(words[0]) / 1e6)

    def _play_accident(self, verb: str, seconds: float) -> None:
        host = self._host
        if verb == "reset":
            host.wait(seconds)
            host.reset_bus()
        elif verb == "sleep":
            host.suspend(True)
            host.wait(seconds)
            host.suspend(False)
        elif verb == "unplug":
            host.unplug()
            host.wait(seconds)
            host.plug()
            host.wait(0.06)
        else:
            raise ValueError(f"unknown step {verb!r}")
        host.wait(0.001)
