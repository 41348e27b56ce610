# SPDX-License-Identifier: Apache-2.0
"""Reads a trace of the pins and works out what was cut, knowing nothing else of the simulation.

Only the wires RB0..RB3 (Z) and RD0..RD3 (X) are looked at. The paper's table, two phases on,
forward 5, 9, 10, 6, turns them into screw steps. Backlash, the slides' first place and the raw bar
give the path of the tool and from it the profile. Nothing here is shared with the other models.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

FORWARD = (5, 9, 10, 6)
CODES = {"X": "RD", "Z": "RB"}


def changes(path: Path) -> Iterator[tuple[int, str, int]]:
    """Yield (nanoseconds, pin, level) for the coil pins, in the order of the file.

    Raises:
        ValueError: a coil pin is missing in the trace.
    """
    names: dict[str, str] = {}
    wanted = {f"{port}{bit}" for port in CODES.values() for bit in range(4)}
    now = 0
    with path.open(encoding="ascii") as file:
        for line in file:
            if line.startswith("$var"):
                _, _, _, code, name, *_ = line.split()
                if name in wanted:
                    names[code] = name
            elif line.startswith("$enddefinitions"):
                missing = wanted - set(names.values())
                if missing:
                    raise ValueError(f"not in the trace: {', '.join(sorted(missing))}")
            elif line.startswith("#"):
                now = int(line[1:])
            elif line[0] in "01" and line[1:].strip() in names:
                yield now, names[line[1:].strip()], int(line[0])


def steps(path: Path) -> Iterator[tuple[int, str, int]]:
    """Yield (nanoseconds, axis, +1 or -1) for every step of the motors.

    Raises:
        ValueError: the coils skip a step.
    """
    level = {f"{port}{bit}": 0 for port in CODES.values() for bit in range(4)}
    phase: dict[str, int] = {}
    moment = 0
    touched: set[str] = set()

    def settle() -> Iterator[tuple[int, str, int]]:
        for axis in sorted(touched):
            pattern = sum(level[f"{CODES[axis]}{bit}"] << bit for bit in range(4))
            if pattern not in FORWARD:
                continue
            new = FORWARD.index(pattern)
            turn = (new - phase.get(axis, new)) % 4
            phase[axis] = new
            if turn == 2:
                raise ValueError(f"{axis} skips a step at {moment} ns")
            if turn:
                yield moment, axis, 1 if turn == 1 else -1

    for now, pin, value in changes(path):
        if now != moment:
            yield from settle()
            touched.clear()
            moment = now
        level[pin] = value
        touched.add("Z" if pin.startswith("RB") else "X")
    yield from settle()


@dataclass
class Screw:
    """A screw with play: ``slack`` 0..``backlash`` is taken up, ``place`` is the slide's."""

    place: int
    backlash: int
    slack: int = 0

    def turn(self, direction: int) -> bool:
        """Turn by one step; True when the slide moves."""
        if 0 <= self.slack + direction <= self.backlash:
            self.slack += direction
            return False
        self.place += direction
        return True


@dataclass
class Bench:
    """What the decoder must be told: screws in machine steps, raw bar and zero in steps."""

    x: Screw
    z: Screw
    zero_x: int
    zero_z: int
    radius: int
    length: int
    allowance: int = 0


def cut_profile(path: Path, bench: Bench) -> list[int]:
    """Return the radius in steps for each step of Z from the chuck to the raw front face."""
    surface = [bench.radius] * (bench.length + bench.allowance + 1)
    for _, axis, direction in steps(path):
        screw = bench.x if axis == "X" else bench.z
        if not screw.turn(direction):
            continue
        z = bench.z.place - bench.zero_z
        radius = max(bench.x.place - bench.zero_x, 0)
        at = z + bench.length
        if not 0 <= at < len(surface) or surface[at] <= radius:
            continue
        surface[at] = radius
        if radius == 0:
            surface[at:] = [0] * (len(surface) - at)
    return surface


def main(argv: list[str] | None = None) -> int:
    """Compare a trace with the profile of a report; 0 when they agree at every step of Z."""
    parser = argparse.ArgumentParser(prog="virtual_lathe.decode_vcd", description=__doc__)
    parser.add_argument("trace", type=Path)
    parser.add_argument("report", type=Path)
    arguments = parser.parse_args(argv)
    report = json.loads(arguments.report.read_text(encoding="utf-8"))
    setup = report["setup"]
    bench = Bench(
        Screw(setup["start_x"], setup["dead_steps_x"], setup["slack_x"]),
        Screw(setup["start_z"], setup["dead_steps_z"], setup["slack_z"]),
        setup["part_zero_x"],
        setup["part_zero_z"],
        setup["stock_radius_steps"],
        setup["stock_length_steps"],
        setup["stock_allowance_steps"],
    )
    decoded = cut_profile(arguments.trace, bench)
    expected = expand(report["profile"], setup["step_x_nm"], setup["step_z_nm"])
    wrong = [i for i, radius in enumerate(decoded) if radius != expected[i]]
    print(f"{len(decoded)} steps of Z compared, {len(wrong)} differ")
    return 1 if wrong or len(decoded) != len(expected) else 0


def expand(profile: list[list[float]], step_x_nm: int, step_z_nm: int) -> list[int]:
    """Return the radius in steps at each step of Z of a report's profile."""
    points = [
        (round(z * 1e6 / step_z_nm), round(diameter * 1e6 / step_x_nm / 2))
        for z, diameter in profile
    ]
    radii = [points[0][1]]
    for (z_from, _), (z_to, radius_to) in pairwise(points):
        radii += [radii[-1]] * (z_to - z_from - 1) + [radius_to]
    return radii


if __name__ == "__main__":
    sys.exit(main())
