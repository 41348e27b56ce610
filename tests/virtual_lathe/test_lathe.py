# SPDX-License-Identifier: Apache-2.0
"""How the lathe passes on what its slides have done."""

import pytest

from virtual_lathe.lathe import _settled
from virtual_lathe.machine import Move

Z_STEP, X_STEP, NEXT = Move(5000, 10, 18), Move(5012, 12, 18), Move(9000, 12, 16)


@pytest.mark.parametrize(
    ("cycle", "count"), [(4999, 0), (5000, 0), (5011, 0), (5012, 2), (8999, 2), (9000, 3)]
)
def test_both_halves_of_a_diagonal_step_are_cut_together(cycle: int, count: int) -> None:
    moves = [Z_STEP, X_STEP, NEXT]
    assert _settled(moves, cycle) == (moves[:count], moves[count:])


def test_nothing_moved_is_nothing_settled() -> None:
    assert _settled([], 1) == ([], [])
