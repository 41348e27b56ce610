# SPDX-License-Identifier: Apache-2.0
"""Serial ports between the host library and the chip that something happens to."""

from __future__ import annotations

from collections.abc import Callable

from tornillo.link import Transport


class TroubledPort:
    """A port that passes bytes on until something is to happen.

    Args:
        port: the real one.
        cut_after: bytes to pass before ``cut()`` is called and the port is gone; None = never.
        flip: number of a bit, counted over everything sent, that arrives inverted.
        drop: numbers of responses that get lost, from 0.
    """

    def __init__(
        self,
        port: Transport,
        cut_after: int | None = None,
        cut: Callable[[], None] = lambda: None,
        flip: int | None = None,
        drop: frozenset[int] = frozenset(),
    ) -> None:
        """Sit between the library and `port`."""
        self.timeout: float | None = None
        self.sent = 0
        self._port = port
        self._cut_after = cut_after
        self._cut = cut
        self._flip = flip
        self._drop = drop
        self._responses = 0

    def write(self, data: bytes, /) -> int:
        """Send bytes, or as many as there are left before the cut.

        Raises:
            OSError: the cable has been cut.
        """
        end = self.sent + len(data)
        if self._cut_after is not None and end >= self._cut_after:
            self._port.write(data[: self._cut_after - self.sent])
            self.sent = self._cut_after
            self._cut()
            raise OSError("the cable is out")
        if self._flip is not None and self.sent <= self._flip // 8 < end:
            changed = bytearray(data)
            changed[self._flip // 8 - self.sent] ^= 1 << self._flip % 8
            data = bytes(changed)
        self.sent = end
        self._port.write(data)
        return len(data)

    def read(self, size: int = 1, /) -> bytes:
        """Read bytes; those of a lost response do not come."""
        self._port.timeout = self.timeout
        data = self._port.read(size)
        lost = self._responses in self._drop
        self._responses += data.count(0)
        return b"" if lost else data
