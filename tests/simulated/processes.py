# SPDX-License-Identifier: Apache-2.0
"""Each simulated test in a process of its own, and branches of a running simulation.

gpsim holds one chip per process and cannot be reset to a blank one, so a test that needs a chip
runs in a fork of pytest:

    @on_a_new_chip
    def test_something() -> None: ...

A fork copies the whole simulation. :func:`branch` uses that to try what happens next without
disturbing what is here: one chip is started, homed, loaded with a part, and then any number of
branches go on from there.

:func:`at_the_end` registers what every process checks before it ends well (persistent
expectations), :func:`in_any_case` what it does however it ends (recording).
"""

from __future__ import annotations

import functools
import multiprocessing
import traceback
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import TypeVar

import pytest

Result = TypeVar("Result")

#: Wall seconds after which a process is taken for stuck; no test comes near it.
STUCK_S = 280.0

_at_the_end: list[Callable[[], None]] = []
_in_any_case: list[Callable[[], None]] = []


class BranchFailed(AssertionError):
    """Something failed in another process; the message holds the trace from there."""


def at_the_end(check: Callable[[], None]) -> None:
    """Have `check` called in this process and its branches when the test there is through."""
    _at_the_end.append(check)


def in_any_case(action: Callable[[], None]) -> None:
    """Have `action` called when this process or a branch of it ends, well or not."""
    _in_any_case.append(action)


def on_a_new_chip(test: Callable[..., None]) -> Callable[..., None]:
    """Decorate a test so that it runs in a process of its own and reports from there."""

    @functools.wraps(test)
    def run(**arguments: object) -> None:
        failure = ""
        try:
            branch(functools.partial(test, **arguments))
        except BranchFailed as failed:
            failure = str(failed)
        if failure:
            pytest.fail(failure, pytrace=False)

    return run


def branch(action: Callable[[], Result], stuck_after: float = STUCK_S) -> Result:
    """Return ``action()``, called in a copy of this process; here nothing changes.

    The result must be picklable. ``stuck_after`` is in seconds of the wall's clock.

    Raises:
        BranchFailed: an exception came from there, or the process died or got stuck.
    """
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    child = context.Process(target=_call, args=(action, sender))
    child.start()
    sender.close()
    try:
        if not receiver.poll(stuck_after):
            child.kill()
            raise BranchFailed(f"no result after {stuck_after:g} s: the simulation is stuck")
        good, result = receiver.recv()
    except EOFError:
        child.join()
        raise BranchFailed(f"the process died with exit code {child.exitcode}") from None
    child.join()
    if not good:
        raise BranchFailed(result)
    returned: Result = result
    return returned


def _call(action: Callable[[], object], sender: Connection) -> None:
    try:
        result = action()
        for check in _at_the_end:
            check()
    except BaseException:
        sender.send((False, traceback.format_exc()))
    else:
        sender.send((True, result))
    finally:
        for last in _in_any_case:
            last()
        sender.close()
