# SPDX-License-Identifier: Apache-2.0
"""The type of the fixture that runs the command line."""

from collections.abc import Callable

from click.testing import Result

Tornillo = Callable[..., Result]
