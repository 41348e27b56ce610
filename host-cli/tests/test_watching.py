# SPDX-License-Identifier: Apache-2.0
"""Watching the status from a thread of its own."""

import threading
from itertools import pairwise

import pytest
from scripted_chip import IDLE, ScriptedChip, ScriptedPort

from tornillo import Lathe, SettingId, Status, Watch
from tornillo.errors import LinkError, NoAnswerError, TornilloError
from tornillo.protocol import Command, State

LONG_S = 10.0  # nothing here takes so long
CUTTING = IDLE._replace(state=State.RUNNING, permille=100)
FINISHED = IDLE._replace(permille=1000)


class Seen:
    """A callback that remembers, and lets others wait for so many statuses."""

    def __init__(self, wanted: int = 3) -> None:
        """Count up to `wanted`."""
        self.statuses: list[Status] = []
        self.threads: set[str] = set()
        self.enough = threading.Event()
        self._wanted = wanted

    def __call__(self, status: Status) -> None:
        """Remember a status."""
        self.statuses.append(status)
        self.threads.add(threading.current_thread().name)
        if len(self.statuses) >= self._wanted:
            self.enough.set()


def watchers() -> list[str]:
    """The threads that watch now."""
    return [thread.name for thread in threading.enumerate() if thread.name == "tornillo-watch"]


def test_the_callback_is_called_from_a_thread_of_its_own_until_the_block_ends(
    lathe: Lathe,
) -> None:
    seen = Seen()
    with lathe.watch(seen, every=0.001) as watch:
        assert seen.enough.wait(LONG_S)
        assert watch.active
        assert watchers() == ["tornillo-watch"]
    count = len(seen.statuses)
    assert seen.threads == {"tornillo-watch"}
    assert not watch.active
    assert watchers() == []
    lathe.status()
    assert len(seen.statuses) == count


def test_commands_of_the_main_thread_go_on_working(lathe: Lathe, port: ScriptedPort) -> None:
    seen = Seen(20)
    with lathe.watch(seen, every=0):
        for value in range(900, 1000):
            lathe.set_setting(SettingId.RAPID_RATE_X, value)
            assert lathe.setting(SettingId.RAPID_RATE_X).value == value
        assert seen.enough.wait(LONG_S)
    assert lathe._link.repeats == 0
    numbers = [frame.seq for frame in port.requests]
    assert all((after - before) % 256 == 1 for before, after in pairwise(numbers))


def test_the_callback_and_another_thread_ask_at_the_same_time(
    lathe: Lathe, chip: ScriptedChip
) -> None:
    values: list[int] = []
    with lathe.watch(lambda _: values.append(lathe.setting(SettingId.TRAVEL_X).value), every=0):
        for travel in range(3000, 3100):
            lathe.set_setting(SettingId.TRAVEL_X, travel)
            assert lathe.setting(SettingId.TRAVEL_X).value == travel
    assert set(values) <= {3575, *range(3000, 3100)}
    assert chip.values[SettingId.TRAVEL_X] == 3099


def test_the_callback_may_use_the_lathe(lathe: Lathe, chip: ScriptedChip) -> None:
    chip.coming = [CUTTING, CUTTING]

    def hold(status: Status) -> bool:
        if status.state is State.RUNNING:
            lathe.hold()
        return not status.moving

    assert lathe.watch(hold, every=0).wait().state is State.HOLD


def test_a_true_value_ends_it_and_wait_returns_the_last_status(
    lathe: Lathe, chip: ScriptedChip
) -> None:
    chip.coming = [CUTTING, CUTTING, FINISHED]
    watch = lathe.watch(lambda status: status.finished, every=0)
    assert watch.wait().finished
    assert watch.wait().finished
    assert (watch.active, watch.error, chip.coming) == (False, None, [])


def test_waiting_may_be_limited(lathe: Lathe) -> None:
    seen = Seen(1)
    with lathe.watch(seen, every=0.001) as watch:
        for seconds in (0, 0.01):
            with pytest.raises(TornilloError, match=f"goes on after {seconds} s"):
                watch.wait(seconds)
        assert watch.active
        assert seen.enough.wait(LONG_S)
    assert watch.wait(0).state is State.IDLE


def test_two_watches_get_along(lathe: Lathe) -> None:
    first, second = Seen(), Seen()
    with lathe.watch(first, every=0.001), lathe.watch(second, every=0.001):
        assert first.enough.wait(LONG_S)
        assert second.enough.wait(LONG_S)


def test_a_pulled_cable_ends_it_and_is_told(lathe: Lathe, port: ScriptedPort) -> None:
    seen = Seen()
    watch = lathe.watch(seen, every=0.001)
    assert seen.enough.wait(LONG_S)
    port.unplugged = True
    with pytest.raises(LinkError, match="connection was lost"):
        watch.wait()
    assert isinstance(watch.error, LinkError)
    watch.stop()


def test_the_end_of_the_block_tells_what_had_ended_the_watch(
    lathe: Lathe, port: ScriptedPort
) -> None:
    port.unplugged = True
    with pytest.raises(LinkError, match="connection was lost"), lathe.watch(Seen()) as watch:
        watch._thread.join(LONG_S)


def test_a_lathe_that_falls_silent_ends_it(lathe: Lathe, port: ScriptedPort) -> None:
    port.lose_answers = 1000
    with pytest.raises(NoAnswerError, match="no answer to STATUS"):
        lathe.watch(Seen()).wait()


def test_what_the_callback_raises_comes_out_where_somebody_waits(lathe: Lathe) -> None:
    def fail(_status: Status) -> None:
        raise ValueError("no such lamp")

    watch = lathe.watch(fail)
    with pytest.raises(ValueError, match="no such lamp"):
        watch.wait()
    with pytest.raises(ZeroDivisionError), lathe.watch(fail):
        raise ZeroDivisionError


def test_the_callback_may_stop_its_own_watch(lathe: Lathe) -> None:
    started: list[Watch] = []
    ready = threading.Event()

    def stop(_status: Status) -> None:
        ready.wait(LONG_S)
        started[0].stop()

    started.append(lathe.watch(stop, every=0))
    ready.set()
    assert started[0].wait().state is State.IDLE
    assert not started[0].active


def test_closing_the_lathe_ends_its_watches(lathe: Lathe, port: ScriptedPort) -> None:
    seen = Seen()
    watch = lathe.watch(seen, every=LONG_S)
    lathe.close()
    assert (watch.active, watch.error, port.closed) == (False, None, True)
    assert watchers() == []


def test_a_watch_stopped_before_its_first_status_has_none(lathe: Lathe, chip: ScriptedChip) -> None:
    begun, stopped = threading.Event(), threading.Event()

    def wait() -> None:
        begun.set()
        stopped.wait(LONG_S)

    chip.at_status = wait
    seen = Seen()
    watch = lathe.watch(seen)
    assert begun.wait(LONG_S)
    watch._stopping.set()
    stopped.set()
    watch.stop()
    assert seen.statuses == []
    assert watch.wait().state is State.IDLE
    never = Watch.__new__(Watch)
    never._ended = threading.Event()
    never._ended.set()
    never._error = never._last = None
    with pytest.raises(TornilloError, match="stopped before a status came"):
        never.wait()


def test_ended_watches_are_forgotten(lathe: Lathe, chip: ScriptedChip) -> None:
    for _ in range(5):
        lathe.watch(lambda _status: True).wait()
    assert len(lathe._watches) == 1
    assert chip.executed.count(Command.STATUS) == 5
