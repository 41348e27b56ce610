# SPDX-License-Identifier: Apache-2.0
"""Whether a contour can be roughed in facing direction at all; roughing_time.py: whether to."""

from tornillo.image import SegmentKind
from tornillo.material import Chain


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
