# SPDX-License-Identifier: Apache-2.0
"""Tell the status of the lathe again and again, from a thread of its own."""

import math
import threading
import time
from collections.abc import Callable
from types import TracebackType

from tornillo.errors import TornilloError
from tornillo.language import _
from tornillo.status import Status

#: How often a waiting main thread looks up, in seconds; Ctrl-C needs it on Windows.
LOOK_UP_S = 0.1

#: Is told each status; a true value ends the watching.
StatusCallback = Callable[[Status], object]


class Watch:
    """A thread that asks for the status and passes it on, until it is ended.

    It ends when the callback returns something true or raises, when the link fails, by `stop`,
    and at the end of the `with` block. All methods may be called from any thread, the callback
    too.
    """

    def __init__(
        self, status: Callable[[], Status], callback: StatusCallback, every: float
    ) -> None:
        """Begin at once; then wait `every` seconds from each answer to the next question."""
        self._status = status
        self._callback = callback
        self._every = every
        self._stopping = threading.Event()
        self._ended = threading.Event()
        self._error: BaseException | None = None
        self._last: Status | None = None
        self._thread = threading.Thread(target=self._run, name="tornillo-watch", daemon=True)
        self._thread.start()

    @property
    def active(self) -> bool:
        """Whether more statuses will come."""
        return not (self._stopping.is_set() or self._ended.is_set())

    @property
    def error(self) -> BaseException | None:
        """What ended the watching, if it was an error: of the link or of the callback."""
        return self._error

    def stop(self) -> None:
        """End the watching and return when the callback will not be called any more.

        Takes as long as the request or the callback under way. Called from the callback itself
        it returns at once. Doing it twice does no harm.
        """
        self._stopping.set()
        if threading.current_thread() is not self._thread:
            self._thread.join()

    def wait(self, timeout_s: float | None = None) -> Status:
        """Wait until the watching has ended and return the last status; Ctrl-C gets through.

        Raises what the callback raised, LinkError or ChipError when the lathe did not answer,
        TornilloError when it was stopped before the first status came, or still goes on after
        `timeout_s` seconds.
        """
        end = math.inf if timeout_s is None else time.monotonic() + timeout_s
        while not self._ended.wait(max(0.0, min(LOOK_UP_S, end - time.monotonic()))):
            if time.monotonic() >= end:
                raise TornilloError(
                    _("the watch goes on after {timeout_s:g} s").format(timeout_s=timeout_s),
                    _("wait longer, or `stop` it"),
                )
        if self._error is not None:
            raise self._error
        if self._last is None:
            raise TornilloError(_("stopped before a status came"), _("wait before `stop`"))
        return self._last

    def __enter__(self) -> "Watch":
        """Return the watch itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the watching; raises what had ended it, unless the block failed by itself."""
        self.stop()
        if kind is None and self._error is not None:
            raise self._error

    def _run(self) -> None:
        """The thread."""
        try:
            while not self._stopping.is_set():
                self._last = self._status()
                if self._stopping.is_set() or self._callback(self._last):
                    break
                self._stopping.wait(self._every)
        except BaseException as error:
            self._error = error
        finally:
            self._ended.set()
