# SPDX-License-Identifier: Apache-2.0
"""Write a part, check it, draw it and have the lathe cut it.

`Part` is a part file, `Machine` what it must fit, `Lathe` the connected machine.
"""

from tornillo.errors import (
    AlarmError,
    ChipError,
    LinkError,
    MachineError,
    NoAnswerError,
    PartError,
    PortError,
    TornilloError,
    VersionError,
)
from tornillo.lathe import Lathe
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol import Axis, SettingId
from tornillo.status import Status
from tornillo.stored import StoredPart
from tornillo.watching import Watch

__version__ = "0.1.0"

__all__ = [
    "AlarmError",
    "Axis",
    "ChipError",
    "Lathe",
    "LinkError",
    "Machine",
    "MachineError",
    "NoAnswerError",
    "Part",
    "PartError",
    "PortError",
    "SettingId",
    "Status",
    "StoredPart",
    "TornilloError",
    "VersionError",
    "Watch",
    "__version__",
]
