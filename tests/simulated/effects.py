# SPDX-License-Identifier: Apache-2.0
"""What each action of firmware/lathe/states.toml does to a lathe, measured."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tornillo.protocol import Axis, ResetCause, StatusInput
from virtual_lathe.chip import Reset

from simulated.bench import Bench
from simulated.power_cuts import PROGRAM_BEGIN
from simulated.situations import FAR_X, OTHER, Walker

#: Longer than any rest in a run, shorter than any of the moves.
LOOK_S = 0.06
#: Longer than the way into the boot loader.
LOADER_S = 0.2
#: 50 % in the chip's unit.
HALF_OVERRIDE = 128
#: Place of the selected part in EEPROM.
SELECTED = 0xE0
#: Records of progress in the EEPROM.
PROGRESS = range(0xA0, 0xE0)


@dataclass(frozen=True)
class Seen:
    """A lathe from outside.

    ``coils``: patterns of both motors. ``turned``: coil changes so far. ``stored``: bytes and
    blocks written so far. ``selected``: slot. ``powered``: both motors hold. ``outward``: place of
    the screw of X.
    """

    coils: int
    turned: int
    stored: int
    kept: int
    position: tuple[int, int]
    selected: int
    powered: bool
    outward: float

    @classmethod
    def now(cls, bench: Bench) -> Seen:
        """Look without disturbing anything."""
        x, z = bench.axis(Axis.X), bench.axis(Axis.Z)
        counts = bench.chip.nonvolatile_counts
        memory = bench.chip.save()
        kept = (memory.flash, memory.eeprom[: PROGRESS.start], memory.eeprom[PROGRESS.stop :])
        coils = (bench.chip.port("D") & 15) << 4 | bench.chip.port("B") & 15
        return cls(
            coils,
            x.steps + z.steps,
            sum(counts[name] for name in ("eeprom_writes", "flash_erases", "flash_writes")),
            hash(kept),
            bench.position,
            memory.eeprom[SELECTED],
            coils >> 4 != 0 and coils & 15 != 0,
            x.commanded,
        )


def moves(bench: Bench, seconds: float = LOOK_S) -> bool:
    """Whether a motor turns in the time to come."""
    before = Seen.now(bench).turned
    bench.run(seconds)
    return Seen.now(bench).turned > before


def counts_right(bench: Bench) -> bool:
    """Whether the tool is where the chip says."""
    return bench.position == (bench.axis(Axis.X).slide, bench.axis(Axis.Z).slide)


def unchanged(walker: Walker, before: Seen, moved: bool) -> None:
    """Moving or standing as before, and nothing stored but how far a part came."""
    bench = walker.bench
    now = Seen.now(bench)
    assert now.kept == before.kept
    assert now.selected == before.selected
    if moved:
        assert moves(bench)
    else:
        assert (now.coils, now.turned, now.position) == (
            before.coils,
            before.turned,
            before.position,
        )
        assert not moves(bench)


def _stored(walker: Walker, before: Seen, moved: bool) -> None:
    now = Seen.now(walker.bench)
    assert now.stored > before.stored
    assert (now.turned, moved) == (before.turned, False)
    assert not moves(walker.bench)


def _receives(walker: Walker, before: Seen, moved: bool) -> None:
    assert (Seen.now(walker.bench).turned, moved) == (before.turned, False)
    assert walker.bench.chip.variable("parts_upload_length", 2) == len(OTHER)


def _seeks(walker: Walker, before: Seen, _moved: bool) -> None:
    bench = walker.bench
    bench.run(LOOK_S)
    assert not bench.homed
    assert bench.chip.variable("homing_axis") == Axis.X
    assert Seen.now(bench).turned > before.turned


def _turns(walker: Walker, before: Seen, moved: bool) -> None:
    bench = walker.bench
    assert moved
    assert moves(bench)
    assert bench.axis(Axis.X).commanded < before.outward


def _found(walker: Walker, _before: Seen, _moved: bool) -> None:
    assert counts_right(walker.bench)
    assert not moves(walker.bench)


def _cuts(walker: Walker, _before: Seen, _moved: bool) -> None:
    assert moves(walker.bench)
    assert walker.bench.chip.variable("machine_slot") != 0xFF


def _brakes(walker: Walker, _before: Seen, _moved: bool) -> None:
    bench = walker.bench
    bench.run(LOOK_S)
    assert not moves(bench)
    assert counts_right(bench)
    assert Seen.now(bench).powered


def _goes_on(walker: Walker, _before: Seen, _moved: bool) -> None:
    assert moves(walker.bench)


def _feed(walker: Walker, before: Seen, moved: bool) -> None:
    unchanged(walker, before, moved)
    assert walker.bench.chip.variable("ramp_scale", 2) == HALF_OVERRIDE


def _finished(walker: Walker, _before: Seen, _moved: bool) -> None:
    bench = walker.bench
    assert bench.status().finished
    assert counts_right(bench)
    assert not moves(bench)


def _waits(walker: Walker, _before: Seen, _moved: bool) -> None:
    bench = walker.bench
    assert not moves(bench)
    assert counts_right(bench)
    assert not bench.status().finished


def _ended(walker: Walker, _before: Seen, _moved: bool) -> None:
    bench = walker.bench
    assert not moves(bench)
    assert counts_right(bench)
    assert not bench.status().finished


def _arrived(walker: Walker, _before: Seen, _moved: bool) -> None:
    bench = walker.bench
    assert bench.position[0] == FAR_X
    assert counts_right(bench)
    assert not moves(bench)
    assert StatusInput.TOUCHED not in bench.status().inputs


def _found_contact(walker: Walker, before: Seen, _moved: bool) -> None:
    bench = walker.bench
    assert before.position[0] - 3 <= bench.position[0] <= before.position[0]
    assert counts_right(bench)
    assert not moves(bench)
    assert StatusInput.TOUCHED in bench.status().inputs


def _selected(walker: Walker, before: Seen, _moved: bool) -> None:
    assert Seen.now(walker.bench).selected != before.selected


def _frozen(walker: Walker, _before: Seen, moved: bool) -> None:
    assert not moves(walker.bench)
    assert Seen.now(walker.bench).powered or not moved


def _powerless(walker: Walker, _before: Seen, _moved: bool) -> None:
    assert Seen.now(walker.bench).coils == 0
    assert not moves(walker.bench)


def _rests(walker: Walker, before: Seen, _moved: bool) -> None:
    assert before.powered
    _powerless(walker, before, False)


def _acknowledged(walker: Walker, before: Seen, moved: bool) -> None:
    unchanged(walker, before, moved)


def _restarted(walker: Walker, before: Seen, _moved: bool) -> None:
    bench = walker.bench
    _powerless(walker, before, False)
    assert bench.status().reset_cause == ResetCause.BROWN_OUT
    assert bench.chip.variable("machine_slot") == 0xFF


def _leaves(walker: Walker, before: Seen, moved: bool) -> None:
    bench = walker.bench
    bench.expect_broken("no step lost")
    unchanged(walker, before, moved)
    bench.unplug()
    bench.run(LOADER_S)
    assert bench.chip.resets[-1][1] is Reset.SOFTWARE
    assert bench.chip.pc < PROGRAM_BEGIN
    assert not Seen.now(bench).coils


EFFECTS: dict[str, Callable[[Walker, Seen, bool], None]] = {
    "-": unchanged,
    "": unchanged,
    "tell": unchanged,
    "store": _stored,
    "receive": _receives,
    "seek": _seeks,
    "turn": _turns,
    "found": _found,
    "cut": _cuts,
    "brake": _brakes,
    "go_on": _goes_on,
    "feed": _feed,
    "finish": _finished,
    "wait": _waits,
    "end": _ended,
    "select": _selected,
    "move": _goes_on,
    "search": _goes_on,
    "arrive": _arrived,
    "contact": _found_contact,
    "freeze": _frozen,
    "power_off": _powerless,
    "rest": _rests,
    "acknowledge": _acknowledged,
    "restart": _restarted,
    "leave": _leaves,
}
