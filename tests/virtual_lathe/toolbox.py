# SPDX-License-Identifier: Apache-2.0
"""The tools that lie beside the lathe, and the order in which a part needs them."""

from __future__ import annotations

from dataclasses import replace

from .tool import BROAD, RIGHT_HAND, Tool
from .wanted import WantedPart


class Toolbox:
    """The tools of a part, or the one that a part without any is cut with."""

    def __init__(self, wanted: WantedPart | None, nose: float | None = None) -> None:
        """Lay the tools out; ``nose`` in steps is the radius of all turning tools."""
        tools = dict(wanted.tools) if wanted else {}
        order = wanted.tool_order() if wanted else []
        if not tools:
            only = RIGHT_HAND if nose else (order or [BROAD])[0]
            tools = {only.name: only}
        if nose is not None:
            tools = {n: t if t.width else replace(t, nose=nose) for n, t in tools.items()}
        self.tools = tools
        names = [tool.name for tool in order if tool.name in tools]
        self._order = names or [next(iter(tools))]
        self._place = 0

    @property
    def first(self) -> Tool:
        """The tool that the part needs first."""
        return self.tools[self._order[0]]

    def named(self, name: str) -> Tool:
        """Return a tool.

        Raises:
            ValueError: there is none of that name.
        """
        if name not in self.tools:
            raise ValueError(f"no tool {name!r}: {', '.join(self.tools)}")
        return self.tools[name]

    def after(self) -> Tool:
        """Return the tool that the part needs next; each call goes on by one.

        Raises:
            ValueError: it needs no other tool.
        """
        if self._place + 1 >= len(self._order):
            raise ValueError("the part needs no other tool")
        self._place += 1
        return self.tools[self._order[self._place]]
