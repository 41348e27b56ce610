# SPDX-License-Identifier: Apache-2.0
"""Write a part, check it, draw it and have the lathe cut it.

`Part` is a part file, `Machine` what it must fit, `Lathe` the connected machine.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from tornillo.version import __version__

if TYPE_CHECKING:
    from tornillo.errors import (
        AlarmError,
        ChipError,
        FirmwareError,
        InLoaderError,
        LinkError,
        LoaderError,
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

__all__ = [
    "AlarmError",
    "Axis",
    "ChipError",
    "FirmwareError",
    "InLoaderError",
    "Lathe",
    "LinkError",
    "LoaderError",
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

#: Where the names live that are not errors.
_HOMES = {
    "Axis": "protocol",
    "Lathe": "lathe",
    "Machine": "machine",
    "Part": "part",
    "SettingId": "protocol",
    "Status": "status",
    "StoredPart": "stored",
    "Watch": "watching",
}


def __getattr__(name: str) -> object:
    """Import a name when it is first used, so that the command line starts fast."""
    if name not in __all__:
        raise AttributeError(f"module 'tornillo' has no attribute {name!r}")
    return getattr(import_module(f"tornillo.{_HOMES.get(name, 'errors')}"), name)
