# SPDX-License-Identifier: Apache-2.0
"""Write a part, check it, draw it and have the lathe cut it.

`Part` is a part file, `Machine` what it must fit, `Lathe` the connected machine.
"""

from tornillo.errors import (
    AlarmError,
    ChipError,
    LinkError,
    MachineError,
    PartError,
    PortError,
    TornilloError,
)
from tornillo.lathe import Lathe
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol import Axis, SettingId
from tornillo.status import Status
from tornillo.stored import StoredPart
from tornillo.watch import StatusWatch

__version__ = "0.1.0"

__all__ = [
    "AlarmError",
    "Axis",
    "ChipError",
    "Lathe",
    "LinkError",
    "Machine",
    "MachineError",
    "Part",
    "PartError",
    "PortError",
    "SettingId",
    "Status",
    "StatusWatch",
    "StoredPart",
    "TornilloError",
    "__version__",
]
