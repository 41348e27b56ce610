# SPDX-License-Identifier: Apache-2.0
"""What a part must fit: screws, travel, part zero and rates of one machine.

The lathe tells it itself (HELLO); without a lathe it comes from a machine file.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from tornillo.errors import MachineError
from tornillo.language import _
from tornillo.machine_file import load_file
from tornillo.protocol import HelloData, SettingId

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
        return cls.from_settings(load_file(name), name)

    @classmethod
    def from_settings(cls, values: Mapping[SettingId, int], name: str) -> "Machine":
        """The machine with these settings; raises MachineError when it lacks one."""

        def value(setting: SettingId) -> int:
            if setting not in values:
                raise MachineError(
                    _("machine {name}: [settings] {setting} is missing").format(
                        name=name, setting=setting.name.lower()
                    ),
                    _("write a whole file with `tornillo settings save FILE`"),
                )
            return values[setting]

        return cls(
            name=name,
            step_x_nm=value(SettingId.STEP_X_NM),
            step_z_nm=value(SettingId.STEP_Z_NM),
            travel_x=value(SettingId.TRAVEL_X),
            travel_z=value(SettingId.TRAVEL_Z),
            zero_x=value(SettingId.ZERO_X),
            zero_z=value(SettingId.ZERO_Z),
            max_rate=min(value(SettingId.RAPID_RATE_X), value(SettingId.RAPID_RATE_Z)),
            spindle_min_rpm=value(SettingId.SPINDLE_MIN),
            spindle_max_rpm=value(SettingId.SPINDLE_MAX),
        )
