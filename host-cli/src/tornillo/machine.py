# SPDX-License-Identifier: Apache-2.0
"""What a part must fit: screws, travel, part zero and rates of one machine.

The lathe tells it itself (HELLO); without a lathe it comes from a machine file.
"""

import tomllib
from dataclasses import dataclass
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path

from tornillo.errors import MachineError
from tornillo.language import _
from tornillo.protocol import HelloData

DEFAULT_MACHINE = "otmt-co"


@dataclass(frozen=True)
class Machine:
    """Sizes of one machine.

    `step_x_nm`, `step_z_nm`: one step in nanometres. `travel_x`, `travel_z`: steps from the
    limit switch. `zero_x`, `zero_z`: machine position of part zero in steps, 0 or less.
    `max_rate`: fastest feed in step/s. `spindle_min_rpm`, `spindle_max_rpm`: None when the
    machine does not tell.
    """

    name: str
    step_x_nm: int
    step_z_nm: int
    travel_x: int
    travel_z: int
    zero_x: int
    zero_z: int
    max_rate: int
    spindle_min_rpm: int | None = None
    spindle_max_rpm: int | None = None

    @classmethod
    def from_hello(
        cls, hello: HelloData, slowest: int | None = None, fastest: int | None = None
    ) -> "Machine":
        """The machine as the chip describes it; `slowest`, `fastest`: spindle, rev/min."""
        return cls(
            name=_("the connected lathe"),
            step_x_nm=hello.step_x_nm,
            step_z_nm=hello.step_z_nm,
            travel_x=hello.travel_x,
            travel_z=hello.travel_z,
            zero_x=hello.zero_x,
            zero_z=hello.zero_z,
            max_rate=hello.max_rate,
            spindle_min_rpm=slowest,
            spindle_max_rpm=fastest,
        )

    @classmethod
    def load(cls, name: str = DEFAULT_MACHINE) -> "Machine":
        """The machine file `name`: one that comes with tornillo, or a path ending in .toml.

        Raises MachineError when it does not exist or lacks something.
        """
        known = _shipped()
        path: Traversable = Path(name) if name.endswith(".toml") else known / f"{name}.toml"
        try:
            values = tomllib.loads(path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
            names = ", ".join(sorted(entry.name.removesuffix(".toml") for entry in known.iterdir()))
            raise MachineError(
                _("machine {name}: {error}").format(name=name, error=error),
                _("use one of {names}, or the path of a machine file").format(names=names),
            ) from error
        return cls(
            name=name,
            step_x_nm=_whole(values, name, "step", "x_nm"),
            step_z_nm=_whole(values, name, "step", "z_nm"),
            travel_x=_whole(values, name, "travel", "x_steps"),
            travel_z=_whole(values, name, "travel", "z_steps"),
            zero_x=_whole(values, name, "part_zero", "x_steps"),
            zero_z=_whole(values, name, "part_zero", "z_steps"),
            max_rate=_whole(values, name, "rate", "feed_max_steps_s"),
            spindle_min_rpm=_whole(values, name, "spindle", "min_rpm"),
            spindle_max_rpm=_whole(values, name, "spindle", "max_rpm"),
        )


def _shipped() -> Traversable:
    """The folder of machine files: in the package, or beside it in a source checkout."""
    packaged = files("tornillo") / "machines"
    return packaged if packaged.is_dir() else Path(__file__).resolve().parents[2] / "machines"


def _whole(values: dict[str, object], name: str, table: str, key: str) -> int:
    """A whole number of a machine file."""
    section = values.get(table)
    value = section.get(key) if isinstance(section, dict) else None
    if isinstance(value, bool) or not isinstance(value, int):
        raise MachineError(
            _("machine {name}: [{table}] {key} must be a whole number").format(
                name=name, table=table, key=key
            ),
            _("copy machines/otmt-co.toml and change its numbers"),
        )
    return value
