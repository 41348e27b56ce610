# SPDX-License-Identifier: Apache-2.0
"""Runs a function in a process of its own, because a process holds one chip only.

A power cycle is a new process with the non-volatile memory of the old one.
"""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any, TypeVar

Result = TypeVar("Result")


def _call(
    sender: Connection, function: Callable[..., object], arguments: tuple[object, ...]
) -> None:
    try:
        sender.send((True, function(*arguments)))
    except BaseException as error:
        sender.send((False, f"{type(error).__name__}: {error}"))
        raise


def in_new_process(function: Callable[..., Result], *arguments: object) -> Result:
    """Return ``function(*arguments)``, called in a new process.

    Function, arguments and result must be picklable (a function of a module, not a lambda).

    Raises:
        RuntimeError: the function raised an exception there, or the process died; the message
            says what happened, the trace is on standard error.
    """
    context = multiprocessing.get_context("spawn")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_call, args=(sender, function, arguments))
    process.start()
    sender.close()
    good: bool
    value: Any
    try:
        good, value = receiver.recv()
    except EOFError:
        process.join()
        raise RuntimeError(f"the process died with exit code {process.exitcode}") from None
    process.join()
    if not good:
        raise RuntimeError(value)
    returned: Result = value
    return returned
