# SPDX-License-Identifier: Apache-2.0
"""Cutting data of a part file: [cut] and what an operation says otherwise."""

from dataclasses import dataclass

from tornillo.protocol import SPRING_MAX
from tornillo.toml_source import Table

SPINDLE_MAX = 65535
#: Keys that an operation may give for itself.
OVERRIDES = (
    "depth_of_cut",
    "finish_allowance",
    "feed",
    "finish_feed",
    "spindle",
    "spring_passes",
    "peck",
)


@dataclass(frozen=True)
class Cut:
    """Cutting data in file units, feeds per minute, `spindle` in rev/min, 0 for no advice.

    `finish_follows`: nobody gave a finish_feed, so it is the feed.
    """

    depth_of_cut: float
    finish_allowance: float
    feed: float
    finish_feed: float
    retract: float
    spindle: int = 0
    spring_passes: int = 0
    peck: float = 0.0
    finish_follows: bool = False


def read_cut(table: Table) -> Cut:
    """The table [cut]; raises PartError."""
    depth = table.positive("depth_of_cut")
    feed = table.positive("feed")
    cut = Cut(
        depth_of_cut=depth,
        finish_allowance=table.positive("finish_allowance", 0.0),
        feed=feed,
        finish_feed=table.positive("finish_feed", feed),
        retract=table.positive("retract"),
        spindle=table.whole("spindle", 0, SPINDLE_MAX, 0),
        spring_passes=table.whole("spring_passes", 0, SPRING_MAX, 0),
        peck=table.positive("peck", 0.0),
        finish_follows=not table.has("finish_feed"),
    )
    table.finish()
    return cut


def read_overrides(table: Table, cut: Cut) -> Cut:
    """What an operation says otherwise than `cut`; raises PartError."""
    feed = table.positive("feed", cut.feed)
    return Cut(
        depth_of_cut=table.positive("depth_of_cut", cut.depth_of_cut),
        finish_allowance=_at_least_0(table, "finish_allowance", cut.finish_allowance),
        feed=feed,
        finish_feed=table.positive("finish_feed", feed if cut.finish_follows else cut.finish_feed),
        retract=cut.retract,
        spindle=table.whole("spindle", 0, SPINDLE_MAX, cut.spindle),
        spring_passes=table.whole("spring_passes", 0, SPRING_MAX, cut.spring_passes),
        peck=_at_least_0(table, "peck", cut.peck),
        finish_follows=cut.finish_follows and not table.has("finish_feed"),
    )


def _at_least_0(table: Table, key: str, default: float) -> float:
    """A length that an operation can also take back to 0."""
    value = table.number(key, default)
    return value if value == 0 else table.positive(key, default)
