# SPDX-License-Identifier: Apache-2.0
"""Bars on the terminal for what takes longer; nothing where messages go to a file."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager


def on_terminal() -> bool:
    """Whether messages go to a terminal."""
    return sys.stderr.isatty()


def on_terminals() -> bool:
    """Whether a person can press keys and see what comes of it."""
    return sys.stdin.isatty() and sys.stdout.isatty()


@contextmanager
def busy(text: str) -> Iterator[None]:
    """A moving bar with the time that has passed, for work whose length nobody knows."""
    if not on_terminal():
        yield
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        progress.add_task(text, total=None)
        yield
