# SPDX-License-Identifier: Apache-2.0
"""Keys that a test presses, one at each look."""

from collections.abc import Callable
from types import TracebackType


class PressedKeys:
    """Has what `tornillo.keys.Keys` asks for; `then` is called at each look with its number."""

    def __init__(self, *keys: str | None, then: Callable[[int], None] = lambda _look: None) -> None:
        """Give `keys` in turn, None for no key in time; then q for ever."""
        self._keys = list(keys)
        self._then = then
        self.looks = 0

    def __enter__(self) -> "PressedKeys":
        """Return the keys."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Nothing to put back."""

    def read(self, _timeout_s: float) -> str | None:
        """The next key."""
        self.looks += 1
        self._then(self.looks)
        return self._keys.pop(0) if self._keys else "q"
