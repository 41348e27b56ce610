# SPDX-License-Identifier: Apache-2.0
"""Firmware coverage over the whole test run, and readable failures from the shared modules."""

import sys
from pathlib import Path

import pytest

# The build's tools are scripts beside each other, not a package.
sys.path.append(str(Path(__file__).parents[1] / "firmware" / "toolchain"))

pytest.register_assert_rewrite("simulated.bench", "simulated.little_pin", "simulated.processes")


def pytest_sessionstart() -> None:
    """Begin a new record of what the simulated chips execute."""
    from executed.record import RECORDER

    RECORDER.begin()


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Write the coverage of the firmware and print it in one line."""
    from executed import report
    from executed.record import RECORDER

    found = RECORDER.end()
    if found.executed:
        terminalreporter.section("firmware coverage (build/coverage/firmware.txt)")
        terminalreporter.write_line(report.write(found))
