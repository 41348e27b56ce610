# SPDX-License-Identifier: Apache-2.0
"""A virtual lathe as a user has it: a process with a serial port and buttons."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import TracebackType

START_S = 30.0
STOP_S = 60.0
POLL_S = 0.05


class LatheError(Exception):
    """The virtual lathe did not start, or ended with an error; the message has its last words."""


class LatheProcess:
    """`python -m virtual_lathe` with its port at `port`.

    Use it in a `with` block: it runs from its beginning to its end. `options` are those of the
    command line; what the lathe prints goes to `log`.
    """

    def __init__(self, port: Path, log: Path, *options: str) -> None:
        """Remember how to start it."""
        self.port = port
        self._log = log
        self._command = [
            sys.executable,
            "-m",
            "virtual_lathe",
            "--port-link",
            os.fspath(port),
            *options,
        ]
        self._process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> "LatheProcess":
        """Start it and wait for its port.

        Raises LatheError when there is none after 30 s.
        """
        self.port.parent.mkdir(parents=True, exist_ok=True)
        self.port.unlink(missing_ok=True)
        with self._log.open("wb") as log:
            self._process = subprocess.Popen(
                self._command, stdin=subprocess.PIPE, stdout=log, stderr=subprocess.STDOUT
            )
        give_up = time.monotonic() + START_S
        while not self.port.exists():
            if self._process.poll() is not None or time.monotonic() > give_up:
                self._process.kill()
                raise LatheError(f"the virtual lathe did not start: {self._last_words()}")
            time.sleep(POLL_S)
        return self

    def press(self, button: str) -> None:
        """Press `run`, `hold`, `stop` or `estop`, release the latter with `release`."""
        self._type(f"press {button}")

    def _type(self, line: str) -> None:
        """Type a line into the lathe's terminal."""
        if self._process is None or self._process.stdin is None:
            raise LatheError("the virtual lathe is not running")
        self._process.stdin.write(f"{line}\n".encode())
        self._process.stdin.flush()

    def switch_off(self) -> None:
        """End it as Ctrl-C does, so that it writes its report.

        Raises LatheError when it ends with an error or not within a minute.
        """
        process = self._process
        if process is None:
            return
        self._process = None
        process.send_signal(signal.SIGINT)
        try:
            code = process.wait(STOP_S)
        except subprocess.TimeoutExpired as error:
            process.kill()
            raise LatheError(f"the virtual lathe did not end: {self._last_words()}") from error
        if code != 0:
            raise LatheError(f"the virtual lathe ended with {code}: {self._last_words()}")

    def _last_words(self) -> str:
        """The end of what it printed."""
        return "\n".join(self._log.read_text(errors="replace").splitlines()[-10:])

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End it."""
        self.switch_off()
