# SPDX-License-Identifier: Apache-2.0
"""The decoder against a trace written by hand."""

from __future__ import annotations

from pathlib import Path

import pytest

from virtual_lathe.decode_vcd import Bench, Screw, cut_profile, steps

FORWARD = (5, 9, 10, 6)
PINS = [f"{port}{bit}" for port in ("RB", "RD") for bit in range(4)]


def _trace(path: Path, patterns: list[tuple[str, int]]) -> Path:
    lines = ["$timescale 1 ns $end"]
    lines += [f"$var wire 1 {chr(33 + i)} {pin} $end" for i, pin in enumerate(PINS)]
    lines += ["$enddefinitions $end", "#0"]
    for i, (port, pattern) in enumerate(patterns):
        lines.append(f"#{1000 * (i + 1)}")
        lines += [f"{pattern >> bit & 1}{chr(33 + PINS.index(f'{port}{bit}'))}" for bit in range(4)]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
    return path


def _turns(port: str, start: int, count: int) -> list[tuple[str, int]]:
    sign = 1 if count > 0 else -1
    return [(port, FORWARD[(start + sign * (i + 1)) % 4]) for i in range(abs(count))]


def test_steps_have_time_axis_and_direction(tmp_path: Path) -> None:
    trace = _trace(tmp_path / "t.vcd", [("RD", 5), ("RD", 9), ("RB", 9), ("RD", 5), ("RB", 5)])
    assert list(steps(trace)) == [(2000, "X", 1), (4000, "X", -1), (5000, "Z", -1)]


def test_a_skipped_step_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="skips"):
        list(steps(_trace(tmp_path / "t.vcd", [("RD", 5), ("RD", 10)])))


def test_a_trace_without_the_coils_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "t.vcd"
    path.write_text("$var wire 1 ! RB0 $end\n$enddefinitions $end\n", encoding="ascii")
    with pytest.raises(ValueError, match="RB1"):
        list(steps(path))


def test_the_profile_comes_from_the_coils_alone(tmp_path: Path) -> None:
    patterns = [("RD", 5), ("RB", 5)]
    patterns += _turns("RD", 0, -8) + _turns("RB", 0, -12)
    bench = Bench(Screw(26, 3, 3), Screw(2, 2, 2), 0, 0, 30, 40)
    surface = cut_profile(_trace(tmp_path / "t.vcd", patterns), bench)
    # 8 - 3 dead steps: radius 21; 12 - 2 dead steps from z = 2: down to z = -8
    assert surface == [30] * 32 + [21] * 9
