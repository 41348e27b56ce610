# SPDX-License-Identifier: Apache-2.0
"""A part goes on after a cut of power, a stop or an alarm: from the pass completed last."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pytest
from simulated import little_pin
from simulated.bench import PINS, START_S, Bench
from simulated.processes import branch, on_a_new_chip
from tornillo.image import Record
from tornillo.protocol import Alarm, ErrorCode, State
from virtual_lathe.chip import Drive, Reset

#: Below the finished face, so that every pass of both operations has something to cut.
DEEP = little_pin.image(depth_of_cut=5)
LONG_PRESS_S = 1.6
CUTS = 20
Place = tuple[int, int]


def cutting_lathe(image: bytes = DEEP) -> Bench:
    """Return a lathe that has just begun to cut the little pin in many passes."""
    bench = little_pin.homed_lathe_with_pin(backlash_x=7, backlash_z=12)
    bench.expect_broken("coil pattern legal", "at most one full step at a time", "no step lost")
    bench.host.upload(image)
    bench.host.run()
    return bench


def place(bench: Bench) -> Place:
    """Operation and pass that are being cut."""
    status = bench.status()
    return status.operation, status.pass_number


def places_until_idle(bench: Bench, meanwhile: Callable[[], None] = lambda: None) -> list[Place]:
    """Let the run end; return every operation and pass on the way."""
    found: list[Place] = []
    while bench.state in (State.RUNNING, State.PAUSE):
        here = place(bench)
        if not found or found[-1] != here:
            found.append(here)
        if bench.is_in(State.PAUSE):
            meanwhile()
        bench.run(0.01)
    assert bench.alarm == (Alarm.NONE, 0)
    return [one for one in found if one != (0, 0)]


def seconds_until_idle(bench: Bench) -> float:
    """Let the run end; return how long that took."""
    begun = bench.lathe.seconds
    bench.wait_for(State.IDLE)
    return bench.lathe.seconds - begun


def assert_cut_exactly(bench: Bench) -> None:
    """Check the finished part, and that the tool never ran into it."""
    report = bench.lathe.report()
    assert {entry["error_steps"] for entry in report["dimensions"]} == {0}
    assert (report["gouge_max_steps"], report["crashes"]) == (0, [])
    assert bench.status().finished


def completed(bench: Bench) -> Place | None:
    """Operation and pass that the chip knows to be completed."""
    begun = bench.host.progress()
    return None if begun is None else (begun.operation, begun.pass_number)


@pytest.mark.parametrize("part", range(4))
@on_a_new_chip
def test_a_part_cut_off_anywhere_is_resumed_from_the_pass_completed_last_and_comes_out_exact(
    part: int,
) -> None:
    bench = cutting_lathe()
    all_places = branch(partial(places_until_idle, bench))
    step = branch(partial(seconds_until_idle, bench)) / CUTS

    def cut_off(after: float) -> Place | None:
        bench.run(after)
        here = place(bench)
        bench.power_cycle(seed=round(after * 1e6))
        assert bench.refusal(partial(bench.host.run, resume=True)) in (
            ErrorCode.NOT_HOMED,
            ErrorCode.NOTHING_TO_RESUME,
        )
        last = completed(bench)
        bench.home()
        if last is None:
            assert here in (*all_places[:2], (0, 0))
            bench.host.run()
        else:
            # A record is written within 40 ms of the pass's end.
            index = all_places.index(last)
            assert here in (*all_places[index : index + 3], (0, 0))
            bench.host.run(resume=True)
        first, *rest = places_until_idle(bench)
        if last is not None:
            index = all_places.index(last)
            ended = all_places[index + 1 :][:1] != [] and all_places[index + 1][0] != last[0]
            assert first == all_places[index + ended]
            assert rest == all_places[all_places.index(first) + 1 :]
        assert_cut_exactly(bench)
        assert completed(bench) is None
        return last

    known = [branch(partial(cut_off, step * (number + 0.5))) for number in range(part, CUTS, 4)]
    assert len(set(known)) > 2


@on_a_new_chip
def test_the_pass_completed_last_is_cut_once_more_and_those_before_are_not() -> None:
    bench = cutting_lathe()
    bench.wait(lambda: place(bench) == (2, 4), 20.0)
    bench.run(0.1)
    bench.power_cycle()
    assert completed(bench) == (2, 3)
    bench.home()
    bench.lathe.machine.take_moves()
    bench.host.run(resume=True)
    bench.wait(lambda: place(bench)[0] == 2, 1.0)
    assert place(bench) == (2, 3)
    # The tool goes there above the stock, and down where the passes before have cut.
    deepest = little_pin.ZERO_X + little_pin.RADIUS
    bench.wait(lambda: bench.position[0] < deepest, 5.0)
    assert bench.position[1] >= little_pin.ZERO_Z - 1
    bench.wait_for(State.IDLE)
    assert_cut_exactly(bench)


@pytest.mark.parametrize("kind", [Reset.BROWN_OUT, Reset.WATCHDOG, Reset.MCLR])
@on_a_new_chip
def test_progress_is_known_after_every_kind_of_reset(kind: Reset) -> None:
    bench = cutting_lathe()
    bench.wait(lambda: place(bench) == (2, 2), 20.0)
    bench.run(0.1)
    bench.unplug()
    bench.chip.reset(kind)
    bench.run(START_S)
    assert completed(bench) == (2, 1)


@pytest.mark.parametrize("how", ["stop", "limit"])
@on_a_new_chip
def test_a_part_can_be_resumed_after_a_stop_or_an_alarm_too(how: str) -> None:
    bench = cutting_lathe()
    bench.wait(lambda: place(bench) == (2, 3), 20.0)
    bench.run(0.1)
    if how == "stop":
        bench.host.stop()
    else:
        bench.chip.set_variable("guard_tripped", 0x01)
        bench.abort_stream()
        bench.wait_for(State.ALARM, 0.1)
        assert bench.alarm[0] is Alarm.LIMIT
        bench.host.reset()
        bench.home()
    assert completed(bench) == (2, 2)
    bench.host.run(resume=True)
    places = places_until_idle(bench)
    assert places[0] == (2, 2)
    assert_cut_exactly(bench)


# -- the button ------------------------------------------------------------------------------------


def hold_run_down(bench: Bench, seconds: float) -> None:
    """Press RUN for some time."""
    bench.chip.drive(PINS["run"], Drive.LOW)
    bench.run(seconds)
    bench.chip.drive(PINS["run"], Drive.OPEN)
    bench.run(0.06)


@pytest.mark.parametrize(("seconds", "first"), [(LONG_PRESS_S, (2, 2)), (0.1, (1, 1))])
@on_a_new_chip
def test_a_long_press_on_run_resumes_the_part_and_a_short_one_begins_it_anew(
    seconds: float, first: Place
) -> None:
    bench = cutting_lathe()
    bench.wait(lambda: place(bench) == (2, 3), 20.0)
    bench.run(0.1)
    bench.power_cycle()
    bench.run(START_S)
    bench.press("run")
    bench.wait(lambda: bench.homed, 60.0)
    hold_run_down(bench, seconds)
    assert bench.is_in(State.RUNNING)
    bench.wait(lambda: place(bench)[0] != 0, 1.0)
    assert place(bench) == first
    bench.wait_for(State.IDLE)
    assert_cut_exactly(bench)


@on_a_new_chip
def test_a_long_press_with_nothing_to_resume_does_nothing() -> None:
    bench = little_pin.homed_lathe_with_pin()
    hold_run_down(bench, LONG_PRESS_S)
    bench.run(0.1)
    assert bench.is_in(State.IDLE)
    assert not bench.moving


# -- what cannot be resumed ------------------------------------------------------------------------


@on_a_new_chip
def test_nothing_is_resumed_when_nothing_was_begun_or_all_was_finished() -> None:
    bench = little_pin.homed_lathe_with_pin()
    bench.expect_broken("at most one full step at a time", "no step lost")
    for _ in range(2):
        assert bench.host.progress() is None
        resume = partial(bench.host.run, resume=True)
        assert bench.refusal(resume) is ErrorCode.NOTHING_TO_RESUME
        bench.host.run()
        bench.wait_for(State.IDLE)
        bench.power_cycle()
        bench.home()


@on_a_new_chip
def test_a_part_begun_anew_or_replaced_or_deleted_cannot_be_resumed() -> None:
    bench = cutting_lathe()
    bench.wait(lambda: place(bench) == (2, 2), 20.0)
    bench.run(0.1)
    bench.host.stop()
    begun = bench.host.progress()
    assert begun is not None

    def begin_anew() -> None:
        bench.host.run()
        bench.run(0.05)
        bench.power_cycle()

    def replace() -> None:
        bench.host.upload(little_pin.image())

    def delete() -> None:
        bench.host.delete(begun.slot)

    def known_after(action: Callable[[], None]) -> Place | None:
        action()
        return completed(bench)

    for action in (begin_anew, replace, delete):
        assert branch(partial(known_after, action)) is None

    # The same image again is the same part.
    bench.host.upload(DEEP)
    assert completed(bench) == (2, 1)


@on_a_new_chip
def test_another_part_than_the_one_begun_is_not_resumed() -> None:
    bench = cutting_lathe()
    bench.wait(lambda: place(bench) == (2, 2), 20.0)
    bench.run(0.1)
    bench.host.stop()
    other = bench.host.upload(little_pin.image("other"))
    resume = partial(bench.host.run, other, resume=True)
    assert bench.refusal(resume) is ErrorCode.NOTHING_TO_RESUME
    assert completed(bench) == (2, 1)


# -- pauses and tools ------------------------------------------------------------------------------

TOOL_B = little_pin.TOOL._replace(kind=1, name=b"second".ljust(12, b"\0"))
BETWEEN: dict[str, Record] = {"pause": little_pin.pause("drill it"), "tool": TOOL_B}


class PartInTwo:
    """A lathe that cuts a face, then waits for a drill or another tool, then a cylinder."""

    def __init__(self, between: str) -> None:
        """Cut up to the pause."""
        cut = little_pin.CUT._replace(depth_of_cut=5)
        operations = (little_pin.FACE, BETWEEN[between], cut, little_pin.CYLINDER)
        self.bench = cutting_lathe(little_pin.image(operations=operations, depth_of_cut=5))
        self.pauses = 0
        self.cylinder = 3 if between == "pause" else 2
        self.bench.wait_for(State.PAUSE)

    def go_on(self) -> None:
        """Press RUN in the pause."""
        self.pauses += 1
        self.bench.press("run")

    def cut_off_and_resume(self) -> list[Place]:
        """Cut the power, home, resume; return every place until the end."""
        self.bench.run(0.1)
        self.bench.power_cycle()
        self.bench.home()
        self.pauses = 0
        self.bench.host.run(resume=True)
        places = places_until_idle(self.bench, self.go_on)
        assert_cut_exactly(self.bench)
        return places


@pytest.mark.parametrize("between", BETWEEN)
@on_a_new_chip
def test_a_part_cut_off_while_it_waits_asks_again_and_cuts_nothing_before(between: str) -> None:
    part = PartInTwo(between)
    places = part.cut_off_and_resume()
    assert part.pauses == 1
    assert places[1:] == [(part.cylinder, number) for number in range(1, len(places))]
    # The pause itself: the first tool is not asked to cut once more.
    assert places[0] == ((2, 0) if between == "pause" else (1, 2))


@pytest.mark.parametrize("between", BETWEEN)
@on_a_new_chip
def test_a_part_cut_off_behind_a_pause_or_a_tool_does_not_go_back_before_it(between: str) -> None:
    part = PartInTwo(between)
    part.go_on()
    part.bench.wait(lambda: place(part.bench) == (part.cylinder, 1), 5.0)
    places = part.cut_off_and_resume()
    assert part.pauses == 0
    assert places == [(part.cylinder, number) for number in range(1, len(places) + 1)]


# -- wear ------------------------------------------------------------------------------------------


@on_a_new_chip
def test_a_part_writes_at_most_five_bytes_for_each_pass_and_each_byte_once_in_nine() -> None:
    bench = cutting_lathe()
    passes = len(branch(partial(places_until_idle, bench)))
    bench.wait_for(State.IDLE)
    for _ in range(3):  # the ring is full now
        bench.host.run()
        bench.wait_for(State.IDLE)
    before = bench.chip.nonvolatile_counts["eeprom_writes"]
    bench.host.run()
    bench.wait_for(State.IDLE)
    writes = bench.chip.nonvolatile_counts["eeprom_writes"] - before
    records = passes + 2  # each pass, the way home, the end
    assert 2 * passes < writes <= 5 * records
