# SPDX-License-Identifier: Apache-2.0
"""Which way of roughing takes fewer passes: along Z, or in facing direction."""

from typing import NamedTuple

from tornillo.image import SegmentKind
from tornillo.material import Chain, Material


class Passes(NamedTuple):
    """What decides about the number of passes, in steps."""

    depth_x: int
    depth_z: int
    allowance: int
    below: int


def never_falls(chain: Chain) -> bool:
    """Whether the radius never gets smaller towards the chuck."""
    return all(
        sub.xe >= sub.xs
        and (sub.kind is SegmentKind.LINE or _front_or_back(sub.zs, sub.ze, sub.zc))
        for sub in chain.subs
    )


def _front_or_back(zs: int, ze: int, zc: int) -> bool:
    """Whether an arc lies on one side of its centre."""
    return not zs > zc > ze


def fewer_facing(chain: Chain, material: Material, passes: Passes) -> bool:
    """Whether roughing in facing direction takes fewer passes."""
    if passes.depth_x < 1 or passes.depth_z < 1:
        return False
    top = material.highest(chain.z, chain.z_end, passes.below)
    allowance = min(passes.allowance, max(0, top - chain.lowest))
    along = _count(top - chain.lowest - allowance, passes.depth_x)
    front = material.free_end(chain.x, material.stock_front)
    facing = _count(front - chain.z_end, passes.depth_z)
    return 0 < facing < along


def _count(height: int, depth: int) -> int:
    """Passes of at most `depth` for `height`."""
    return -(-height // depth) if height > 0 else 0
