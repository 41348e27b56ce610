# SPDX-License-Identifier: Apache-2.0
"""The reference parts that are short enough, cut in full; `make bench` cuts the others."""

from __future__ import annotations

import pytest
from simulated.cutting import EXAMPLES, cut_file
from simulated.processes import on_a_new_chip


@pytest.mark.parametrize("name", ["ball-concave", "cone", "ring", "three-marks"])
@on_a_new_chip
def test_a_reference_part_is_cut_to_the_step(name: str) -> None:
    cut_file(EXAMPLES / f"{name}.toml").assert_good()
