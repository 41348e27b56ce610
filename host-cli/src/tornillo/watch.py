# SPDX-License-Identifier: Apache-2.0
"""Status of the lathe, again and again, in a thread of its own."""

import threading
from collections.abc import Callable
from types import TracebackType

from tornillo.errors import TornilloError
from tornillo.status import Status


class StatusWatch:
    """Calls back with every new status until it is stopped or the lathe does not answer.

    The callback runs in the watch's thread, one call at a time; it may use the lathe, and may stop
    the watch. `error` says afterwards why the watch ended by itself; an exception of the callback
    ends it too and is raised by `stop`.
    """

    def __init__(
        self, ask: Callable[[], Status], callback: Callable[[Status], object], every_s: float
    ) -> None:
        """Begin to ask every `every_s` seconds."""
        self.error: TornilloError | None = None
        self._ask = ask
        self._callback = callback
        self._every_s = every_s
        self._raised: Exception | None = None
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name="tornillo status", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        """Ask, call back, wait."""
        while not self._stopped.is_set():
            try:
                status = self._ask()
            except TornilloError as error:
                self.error = error
                return
            try:
                self._callback(status)
            except Exception as error:
                self._raised = error
                return
            self._stopped.wait(self._every_s)

    def wait(self, timeout_s: float | None = None) -> bool:
        """Wait until the watch has ended; False when `timeout_s` seconds have passed before."""
        self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def stop(self) -> None:
        """End the watch and wait for a callback that runs; raises what the callback raised."""
        self._stopped.set()
        if threading.current_thread() is not self._thread:
            self._thread.join()
            if self._raised is not None:
                raise self._raised

    def __enter__(self) -> "StatusWatch":
        """Return the watch itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop."""
        self.stop()
