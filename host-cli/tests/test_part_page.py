# SPDX-License-Identifier: Apache-2.0
"""docs/part-file.md tells every key there is, and its example can be made."""

import re
from pathlib import Path

import pytest

from tornillo.cutting import OVERRIDES
from tornillo.machine import Machine
from tornillo.operations import READERS, ROUGHING
from tornillo.part import ORDERS, PATHS, Part
from tornillo.tools import HANDS

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "part-file.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.parametrize("text", EXAMPLES)
def test_the_examples_of_the_page_can_be_made(text: str, machine: Machine) -> None:
    Part.parse(text).check(machine)


def test_the_page_tells_every_type_key_and_choice() -> None:
    assert EXAMPLES
    for kind in READERS:
        assert f'### `type = "{kind}"`' in PAGE
    for key in (*OVERRIDES, "retract", "nose_radius", "orientation", "corner", "chamfer", "via"):
        assert f"`{key}`" in PAGE
    for choice in (*ROUGHING, *ORDERS, *PATHS, *HANDS):
        assert f'"{choice}"' in PAGE
