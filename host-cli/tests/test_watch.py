# SPDX-License-Identifier: Apache-2.0
"""Status called back from a thread, beside requests of other threads."""

import threading

import pytest
from scripted_chip import IDLE, ScriptedChip, ScriptedPort

from tornillo import Lathe, LinkError, SettingId, Status, StatusWatch
from tornillo.protocol import State

LONG_S = 30.0


def test_every_status_is_called_back_until_the_watch_is_stopped(
    lathe: Lathe, chip: ScriptedChip
) -> None:
    chip.coming = [IDLE._replace(x=x) for x in range(5)]
    seen: list[int] = []
    fifth = threading.Event()

    def callback(status: Status) -> None:
        seen.append(status.x)
        if len(seen) == 5:
            fifth.set()

    with lathe.watch(callback, every_s=0) as watch:
        assert fifth.wait(LONG_S)
    assert seen[:5] == [0, 1, 2, 3, 4]
    assert watch.wait(0)
    assert watch.error is None


def test_requests_of_other_threads_and_of_the_callback_go_on_meanwhile(
    lathe: Lathe, chip: ScriptedChip
) -> None:
    values: list[int] = []
    with lathe.watch(lambda _: values.append(lathe.setting(SettingId.TRAVEL_X).value), every_s=0):
        for travel in range(3000, 3100):
            lathe.set_setting(SettingId.TRAVEL_X, travel)
            assert lathe.setting(SettingId.TRAVEL_X).value == travel
    assert set(values) <= {3575, *range(3000, 3100)}
    assert chip.values[SettingId.TRAVEL_X] == 3099


def test_a_callback_may_stop_the_watch(lathe: Lathe) -> None:
    watches: list[StatusWatch] = []
    ready = threading.Event()

    def callback(status: Status) -> None:
        ready.wait(LONG_S)
        assert status.state is State.IDLE
        watches[0].stop()

    watches.append(lathe.watch(callback, every_s=0))
    ready.set()
    assert watches[0].wait(LONG_S)
    watches[0].stop()


def test_a_lost_connection_ends_the_watch_and_is_told(lathe: Lathe, port: ScriptedPort) -> None:
    def pull(_status: Status) -> None:
        port.unplugged = True

    with lathe.watch(pull, every_s=0) as watch:
        assert watch.wait(LONG_S)
    assert isinstance(watch.error, LinkError)


def test_what_a_callback_raises_is_not_swallowed(lathe: Lathe) -> None:
    def fail(_status: Status) -> None:
        raise ValueError("in the callback")

    watch = lathe.watch(fail)
    assert watch.wait(LONG_S)
    with pytest.raises(ValueError, match="in the callback"):
        watch.stop()
