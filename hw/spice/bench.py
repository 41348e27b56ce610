# SPDX-License-Identifier: CERN-OHL-P-2.0
"""Runs one spice bench with other parameters and reads what it printed."""

from __future__ import annotations

import re
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
PRINTED = re.compile(r"^(\w+) = +(\S+)$", re.MULTILINE)


@dataclass(frozen=True)
class Result:
    """What a bench measured, in SI units, and what it complained of."""

    values: dict[str, float]
    complaint: str


def parameters(text: str) -> dict[str, str]:
    """Return the values of a bench's first .param line."""
    line = re.search(r"^\.param (.*)$", text, re.MULTILINE)
    if line is None:
        raise ValueError("the bench has no .param line")
    return dict(re.findall(r"(\w+)=([-\w.]+)", line.group(1)))


def simulate(
    name: str,
    changed: dict[str, float] | None = None,
    *,
    waves: tuple[str, ...] = (),
    start: float = 0.0,
) -> tuple[Result, list[list[float]]]:
    """Run hw/spice/NAME.cir with changed parameters.

    waves are vectors to return, sampled at the bench's own time steps: the
    first column is the time in s, from start on. Raises RuntimeError when ngspice prints no
    result.
    """
    text = (HERE / f"{name}.cir").read_text(encoding="utf-8")
    values = parameters(text)
    changed = changed or {}
    unknown = set(changed) - set(values)
    if unknown:
        raise ValueError(f"{name} has no parameter {', '.join(sorted(unknown))}")
    values.update({key: f"{value:g}" for key, value in changed.items()})
    line = ".param " + " ".join(f"{key}={value}" for key, value in values.items())
    text = re.sub(r"^\.param \w+=.*$", line, text, count=1, flags=re.MULTILINE)
    text = re.sub(r"@(\w+)@", lambda found: values[found.group(1)], text)
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "waves.txt"
        if waves:
            text = text.replace(
                "\nrun\n", f"\nset wr_singlescale\nrun\nwrdata {table} {' '.join(waves)}\n", 1
            )
        source = Path(folder) / f"{name}.cir"
        source.write_text(
            text.replace(".include models.lib", f".include {HERE}/models.lib"), encoding="utf-8"
        )
        done = subprocess.run(
            ["ngspice", "-b", str(source)], capture_output=True, text=True, check=False
        )
        printed = {key: float(value) for key, value in PRINTED.findall(done.stdout)}
        if not printed:
            raise RuntimeError(f"{name}: ngspice printed no result\n{done.stderr[-800:]}")
        rows = (
            [
                [float(word) for word in row.split()]
                for row in table.read_text(encoding="utf-8").splitlines()
            ]
            if waves
            else []
        )
    failed = re.search(r"^FAIL: (.*)$", done.stdout, re.MULTILINE)
    complaint = failed.group(1) if failed else ("" if done.returncode == 0 else "ngspice failed")
    return Result(printed, complaint), [row for row in rows if row[0] >= start]
