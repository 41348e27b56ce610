# SPDX-License-Identifier: Apache-2.0
"""Cuts of power at every instruction that writes EEPROM or flash, and what is left then.

Each such instruction gives three cuts: right before it, so that it is not executed, and a quarter
and three quarters through the time that the memory takes. Simulations repeat exactly, so the
moments are found once, and each cut is made in a branch of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeVar

from virtual_lathe.chip import CYCLES_PER_SECOND, FLASH_BYTES, Stop

from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import branch

State = TypeVar("State")
Action = Callable[[Bench], object]

#: bsf EECON1, WR, the one instruction that begins a write.
BEGIN_WRITE = b"\xa6\x82"
PROGRAM_BEGIN = 0x0800  # behind the boot loader
EECON1, EEPGD = 0xFA6, 0x80
EEPROM_S, FLASH_S = 4e-3, 2e-3
PARTS_OF_A_WRITE = (0.25, 0.75)
RESTART_S = 0.12


class PowerCut(Exception):
    """Ends what the host library is doing."""


def sites(bench: Bench) -> list[int]:
    """Return the addresses of all instructions of the program that begin a write."""
    flash = bench.chip.save().flash
    found = [at for at in range(PROGRAM_BEGIN, FLASH_BYTES, 2) if flash[at : at + 2] == BEGIN_WRITE]
    assert len(found) == 2, "one for the EEPROM and one for the flash"
    return found


def moments(bench: Bench, action: Action) -> list[int]:
    """Return the cycles of all cuts during an action; it is not done here."""
    return branch(partial(_moments, bench, action))


def _moments(bench: Bench, action: Action) -> list[int]:
    chip = bench.chip
    run_to, found = chip.run_to, []

    def watched(cycle: int) -> Stop:
        while (reason := run_to(cycle)) is Stop.ADDRESS:
            lasts = FLASH_S if chip.peek(EECON1) & EEPGD else EEPROM_S
            inside = (lasts * CYCLES_PER_SECOND * part for part in PARTS_OF_A_WRITE)
            found.extend([chip.cycle, *(chip.cycle + round(later) for later in inside)])
        return reason

    for site in sites(bench):
        chip.set_break(site)
    vars(chip)["run_to"] = watched
    action(bench)
    bench.run(2 * EEPROM_S)
    return found


def left_by(
    bench: Bench, action: Action, look: Callable[[Bench], State], cycle: int
) -> State | None:
    """Return what a cut at a cycle of an action leaves; None when the chip does not answer."""
    return branch(partial(_left_by, bench, action, look, cycle))


def _left_by(
    bench: Bench, action: Action, look: Callable[[Bench], State], cycle: int
) -> State | None:
    def cut() -> None:
        bench.power_cycle(seed=cycle % 251)
        raise PowerCut

    bench.lathe.at(cycle / CYCLES_PER_SECOND, cut)
    try:
        action(bench)
        bench.run(2 * EEPROM_S)
    except PowerCut:
        bench.run(RESTART_S)
        try:
            return look(bench)
        except Exception:
            return None
    raise AssertionError("the power was not cut")


def every_cut(
    bench: Bench, action: Action, look: Callable[[Bench], State], every: int = 1
) -> tuple[State, list[State | None], State]:
    """Return what there was before an action, what each cut leaves, and what there is after it.

    Of long actions only every so-manieth cut is made, and the last one.
    """
    before = branch(partial(look, bench))
    after = branch(lambda: (action(bench), look(bench))[1])
    found = moments(bench, action)
    cuts = [*found[:-1:every], found[-1]]
    return before, [left_by(bench, action, look, cycle) for cycle in cuts], after


def failures(before: State, left: Sequence[State | None], after: State) -> int:
    """Return how many cuts left neither the old nor the new."""
    assert before != after
    return sum(found not in (before, after) for found in left)


# -- what is saved ---------------------------------------------------------------------------------

NEW_PART = little_pin.image(depth_of_cut=17)


def save_settings(bench: Bench) -> None:
    """Change a setting."""
    bench.set(zero_x=-3333)


def commit_part(bench: Bench) -> None:
    """Replace the part by another one of the same name."""
    bench.host.upload(NEW_PART)


def settings(bench: Bench) -> list[tuple[int, int]]:
    """Return every setting, and the alarm if there is one."""
    found = [(int(entry.id), data.value) for entry, data in bench.host.settings()]
    return [*found, (-1, bench.alarm[0])]


def parts(bench: Bench) -> list[tuple[bool, bytes]]:
    """Return every stored part, selected or not."""
    return [(part.selected, bench.host.read(part.slot)) for part in bench.host.parts()]
