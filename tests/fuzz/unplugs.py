# SPDX-License-Identifier: Apache-2.0
"""The cable pulled and put in again at random moments of upload, status and run.

The part store stays intact, the next connection works, and cutting goes on: the steps are those of
a run without a cable, and none comes at another time than there by more than the bound of the
jitter, whenever in the chip's millisecond the run began.
"""

from __future__ import annotations

import random
from functools import partial

from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import branch
from simulated.standing import COILS
from tornillo.errors import TornilloError
from tornillo.protocol import State
from virtual_lathe.usb_host import UsbError

from fuzz.target import Broken

#: 1.0 us, the bound of the jitter: an interrupt waits for the end of the instruction before it.
JITTER_CYCLES = 12
#: Before a run some time goes by, so that it begins anywhere in the chip's millisecond.
BEAT_S = 1e-3
UPLOAD_S = 0.08
OUT_MAX_S = 0.08
RUN_TIMEOUT_S = 20.0
BEGIN_S = 1.0

Change = tuple[int, int]


def coil_changes(bench: Bench) -> list[Change]:
    """Every change of the coils since the log began, as (cycle, levels of the coil pins)."""
    mask = sum(1 << (ord(name[1]) - ord("A")) * 8 + int(name[2]) for name in COILS)
    return [(cycle, levels & mask) for cycle, levels in bench.chip.pin_changes()]


class Unplugs:
    """A lathe with a part stored, whose cable is pulled again and again.

    Args:
        seed: the same seed pulls it at the same moments.
    """

    def __init__(self, seed: int) -> None:
        """Switch on, home and store a part."""
        self._chance = random.Random(seed)
        self._bench = little_pin.homed_lathe_with_pin(backlash_x=7, backlash_z=12)
        self._image = little_pin.image()
        self.moments = 0
        self.runs = 0
        self.worst_cycles = 0

    # -- upload ---------------------------------------------------------------------------------

    def upload(self, moments: int) -> None:
        """Pull the cable in ``moments`` uploads, each begun anew.

        Raises:
            Broken: the store is not intact, or the next connection does not work.
        """
        for _ in range(moments):
            after, out = self._chance.random() * UPLOAD_S, self._chance.random() * OUT_MAX_S
            branch(partial(self._interrupted_upload, after, out))
            self.moments += 1

    def _interrupted_upload(self, after: float, out: float) -> None:
        bench = self._bench
        other = little_pin.image("other-pin")
        bench.lathe.at(bench.lathe.seconds + after, bench.lathe.unplug)
        try:
            bench.host.upload(other)
            stored = True
            bench.run(max(0.0, after))
        except (TornilloError, UsbError):
            stored = False
        bench.run(out)
        bench.lathe.unplug()
        lathe = bench.connect()
        images = {part.name: lathe.read(part.slot) for part in lathe.parts()}
        if images.pop("little-pin", b"") != self._image:
            raise Broken(f"the stored part is gone after {after:.6f} s of upload")
        if images.pop("other-pin", other if not stored else b"") != other or images:
            raise Broken(f"a part that is none is stored after {after:.6f} s of upload")
        lathe.read(lathe.upload(other))

    # -- status ---------------------------------------------------------------------------------

    def status(self, moments: int) -> None:
        """Pull the cable while the status is asked for, ``moments`` times.

        Raises:
            Broken: the next connection does not work.
        """
        bench = self._bench
        for _ in range(moments):
            at = bench.lathe.seconds + self._chance.random() * 2e-3
            bench.lathe.at(at, bench.lathe.unplug)
            try:
                while True:
                    bench.host.status()
            except (TornilloError, UsbError):
                bench.run(self._chance.random() * OUT_MAX_S)
            if bench.connect().status().state is not State.IDLE:
                raise Broken("the machine is not idle any more")
            self.moments += 1

    # -- run ------------------------------------------------------------------------------------

    def run(self, moments: int) -> None:
        """Pull the cable in runs, until it was pulled ``moments`` times in all.

        Raises:
            Broken: a step came at another time than in a run without a cable.
        """
        done = 0
        undisturbed, _ = branch(partial(self._cut, None))
        while done < moments:
            seed = self._chance.getrandbits(32)
            changes, pulled = branch(partial(self._cut, seed))
            worst = compare(changes, undisturbed, seed)
            self.worst_cycles = max(self.worst_cycles, worst)
            self.runs += 1
            done += pulled
        self.moments += done

    def _cut(self, seed: int | None) -> tuple[list[Change], int]:
        """Cut the part; without a seed with the cable out from the beginning."""
        bench = self._bench
        lathe = bench.lathe
        chance = random.Random(seed)
        if seed is not None:
            bench.run(chance.random() * BEAT_S)
        bench.host.run()
        pulled = 0
        bench.chip.log_pins(*COILS)
        bench.wait(lambda: bench.moving, BEGIN_S)
        if seed is None:
            lathe.unplug()
        end = lathe.seconds + RUN_TIMEOUT_S
        while bench.state is State.RUNNING and lathe.seconds < end:
            if seed is None:
                bench.run(0.05)
                continue
            lathe.at(lathe.seconds + chance.random() * 0.1, lathe.unplug)
            self._talk()
            pulled += 1
            bench.run(chance.random() * OUT_MAX_S)
            bench.connect()
        little_pin.assert_cut_exactly(bench)
        return coil_changes(bench), pulled

    def _talk(self) -> None:
        """Ask as fast as it goes until the cable is out."""
        try:
            while True:
                self._bench.host.status()
                self._bench.host.parts()
        except (TornilloError, UsbError):
            return


def compare(changes: list[Change], undisturbed: list[Change], seed: int) -> int:
    """The largest difference to the undisturbed run, in cycles since the first step.

    Raises:
        Broken: other steps, or a difference beyond the bound.
    """
    if [levels for _, levels in changes] != [levels for _, levels in undisturbed]:
        raise Broken(f"other steps than without a cable, run {seed}")
    shift = changes[0][0] - undisturbed[0][0]
    worst = max(
        abs(cycle - other - shift)
        for (cycle, _), (other, _) in zip(changes, undisturbed, strict=True)
    )
    if worst > JITTER_CYCLES:
        raise Broken(f"a step came {worst} cycles off, run {seed}")
    return worst
