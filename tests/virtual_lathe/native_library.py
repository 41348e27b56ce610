# SPDX-License-Identifier: Apache-2.0
"""Loads the shared library of the virtual lathe and declares its functions.

The manual of every function is the C header ``native/virtual_lathe.h``; the table here repeats
its signatures for ctypes and nothing else.
"""

from __future__ import annotations

import ctypes
import os
from ctypes import (
    POINTER,
    Structure,
    c_char_p,
    c_double,
    c_int,
    c_int32,
    c_int64,
    c_uint,
    c_uint8,
    c_uint32,
    c_uint64,
)
from functools import cache
from pathlib import Path
from typing import Any

LIBRARY_VARIABLE = "VIRTUAL_LATHE_LIBRARY"
DEFAULT_LIBRARY = (
    Path(__file__).resolve().parents[2] / "build" / "virtual_lathe" / "libvirtual_lathe.so"
)


class InterruptCostC(Structure):
    """struct vl_interrupt_cost"""

    _fields_ = [(name, c_uint64) for name in ("entries", "total", "best", "worst", "worst_at")]


class RamWriteC(Structure):
    """struct vl_ram_write"""

    _fields_ = [("cycle", c_uint64), ("address", c_uint32), ("value", c_uint32), ("pc", c_uint32)]


class PinChangeC(Structure):
    """struct vl_pin_change"""

    _fields_ = [("cycle", c_uint64), ("levels", c_uint64)]


class NonvolatileCountsC(Structure):
    """struct vl_nonvolatile_counts"""

    _fields_ = [
        (name, c_uint32)
        for name in ("eeprom_writes", "flash_erases", "flash_writes", "broken_unlocks")
    ]


class UsbCountsC(Structure):
    """struct vl_usb_counts"""

    _fields_ = [
        (name, c_uint64)
        for name in (
            "frames",
            "transactions",
            "naks",
            "stalls",
            "timeouts",
            "bytes_in",
            "bytes_out",
            "wrong_toggles",
        )
    ]


class AxisSetupC(Structure):
    """struct vl_axis_setup"""

    _fields_ = [
        *(
            (name, c_int32)
            for name in (
                "slide",
                "backlash",
                "slack",
                "switch_travel",
                "switch_broken",
                "stop_plus",
                "stop_minus",
            )
        ),
        *((name, c_double) for name in ("pull_in", "pull_out", "acceleration")),
    ]


class AxisStateC(Structure):
    """struct vl_axis_state"""

    _fields_ = [
        *((name, c_int64) for name in ("slide", "slack", "rotor", "commanded")),
        *(
            (name, c_uint64)
            for name in ("steps", "lost_steps", "illegal_patterns", "jumps", "end_stops")
        ),
        ("fastest", c_double),
        ("pressed", c_int32),
    ]


class MoveC(Structure):
    """struct vl_move"""

    _fields_ = [("cycle", c_uint64), ("x", c_int64), ("z", c_int64)]


class FaultC(Structure):
    """struct vl_fault"""

    _fields_ = [("cycle", c_uint64), ("axis", c_int32), ("kind", c_int32), ("value", c_int64)]


class LcdStateC(Structure):
    """struct vl_lcd_state"""

    _fields_ = [
        ("ddram", c_uint8 * 80),
        ("cgram", c_uint8 * 64),
        *((name, c_uint8) for name in ("on", "two_lines", "cursor", "blink", "in_cgram")),
        *((name, c_int32) for name in ("address", "shift")),
        ("writes", c_uint64),
    ]


class LcdByteC(Structure):
    """struct vl_lcd_byte"""

    _fields_ = [("cycle", c_uint64), ("data", c_uint8), ("value", c_uint8)]


class ToolC(Structure):
    """struct vl_tool"""

    _fields_ = [(name, c_double) for name in ("nose", "width", "chuck_edge", "free_edge")]


class PathC(Structure):
    """struct vl_path"""

    _fields_ = [(name, c_double) for name in ("x_from", "z_from", "x_to", "z_to")]


class CutC(Structure):
    """struct vl_cut"""

    _fields_ = [("columns", c_int32), ("fallen", c_int32), ("reach", c_double)]


_BYTES = POINTER(c_uint8)
_DOUBLES = POINTER(c_double)
_SIGNATURES: dict[str, tuple[Any, list[Any]]] = {
    "vl_load": (c_int, [c_char_p]),
    "vl_write_protection": (None, [c_uint]),
    "vl_run": (c_int, [c_uint64]),
    "vl_cycle": (c_uint64, []),
    "vl_program_counter": (c_uint, []),
    "vl_peek": (c_uint, [c_uint]),
    "vl_poke": (None, [c_uint, c_uint]),
    "vl_read": (c_uint, [c_uint]),
    "vl_write": (None, [c_uint, c_uint]),
    "vl_set_break": (None, [c_uint, c_int]),
    "vl_reset_chip": (c_int, [c_int]),
    "vl_fill_ram": (None, [c_uint]),
    "vl_resets": (c_int, [POINTER(c_uint64), POINTER(c_int), c_int]),
    "vl_flash_read": (None, [c_uint, _BYTES, c_uint]),
    "vl_flash_write": (None, [c_uint, _BYTES, c_uint]),
    "vl_eeprom_read": (None, [_BYTES]),
    "vl_eeprom_write": (None, [_BYTES]),
    "vl_interrupts": (None, [c_int, POINTER(InterruptCostC)]),
    "vl_stack_depth_max": (c_uint, []),
    "vl_executed": (None, [_BYTES]),
    "vl_clear_statistics": (None, []),
    "vl_watch_writes": (c_int, [c_uint, c_uint]),
    "vl_ram_writes": (c_int, [POINTER(RamWriteC), c_int]),
    "vl_written": (None, [_BYTES]),
    "vl_pin_drive": (c_int, [c_int, c_int]),
    "vl_pin_drive_volts": (c_int, [c_int, c_double, c_double]),
    "vl_pin_level": (c_int, [c_int]),
    "vl_pin_levels": (c_uint64, []),
    "vl_pin_log": (None, [c_uint64]),
    "vl_pin_changes": (c_int, [POINTER(PinChangeC), c_int]),
    "vl_vcd_open": (c_int, [c_char_p]),
    "vl_vcd_close": (None, []),
    "vl_nonvolatile_counts": (None, [POINTER(NonvolatileCountsC)]),
    "vl_usb_attach": (None, []),
    "vl_usb_plug": (None, [c_int]),
    "vl_usb_connected": (c_int, []),
    "vl_usb_reset": (None, [c_int]),
    "vl_usb_suspend": (None, [c_int]),
    "vl_usb_submit": (None, [c_int, c_uint, c_uint, c_uint, c_char_p, c_uint, c_int]),
    "vl_usb_result": (c_int, [_BYTES, POINTER(c_uint), POINTER(c_uint)]),
    "vl_usb_open": (None, [c_uint, c_uint, c_uint, c_uint]),
    "vl_usb_close": (None, []),
    "vl_usb_write": (c_uint, [c_char_p, c_uint]),
    "vl_usb_read": (c_uint, [_BYTES, c_uint]),
    "vl_usb_unsent": (c_uint, []),
    "vl_usb_port_failed": (c_int, []),
    "vl_usb_lose_handshakes": (None, [c_uint]),
    "vl_usb_counts": (None, [POINTER(UsbCountsC)]),
    "vl_usb_mistake": (c_int, [c_uint, c_char_p, c_uint]),
    "vl_usb_report_mistake": (None, [c_char_p]),
    "vl_machine_attach": (None, []),
    "vl_axis_setup": (c_int, [c_int, POINTER(AxisSetupC)]),
    "vl_axis_read": (c_int, [c_int, POINTER(AxisStateC)]),
    "vl_switch_broken": (c_int, [c_int, c_int, c_int]),
    "vl_motor_power": (None, [c_int]),
    "vl_probe_attach": (None, [c_int, c_double, c_double]),
    "vl_probe_look": (None, []),
    "vl_probe_short": (None, [c_int]),
    "vl_switch_quality": (None, [c_uint, c_uint, c_uint]),
    "vl_moves": (c_int, [POINTER(MoveC), c_int]),
    "vl_faults": (c_int, [POINTER(FaultC), c_int]),
    "vl_lcd_attach": (None, [c_double]),
    "vl_lcd_read": (None, [POINTER(LcdStateC)]),
    "vl_lcd_bytes": (c_int, [POINTER(LcdByteC), c_int]),
    "vl_lcd_mistake": (c_int, [c_uint, c_char_p, c_uint]),
    "vl_keys_attach": (None, []),
    "vl_keys_hold": (None, [c_uint]),
    "vl_adc_mistake": (c_int, [c_uint, c_char_p, c_uint]),
    "vl_metal_new": (c_int, [c_double, c_int, c_int]),
    "vl_metal_tool": (None, [c_int, POINTER(ToolC)]),
    "vl_metal_move": (None, [c_int, POINTER(PathC), c_int, POINTER(CutC)]),
    "vl_metal_radii": (c_int, [c_int, _DOUBLES, c_int]),
    "vl_metal_radius": (c_double, [c_int, c_int]),
    "vl_metal_fallen": (c_int, [c_int, _DOUBLES, c_int]),
    "vl_tool_outline": (c_double, [POINTER(ToolC), c_double]),
    "vl_above": (c_double, [_DOUBLES, c_int, c_int, c_int, c_double]),
    "vl_reach": (None, [POINTER(ToolC), _DOUBLES, _DOUBLES, c_int, c_int]),
}


@cache
def library() -> ctypes.CDLL:
    """Return the shared library, loaded once per process.

    The path is taken from the environment variable ``VIRTUAL_LATHE_LIBRARY`` or is
    ``build/virtual_lathe/libvirtual_lathe.so`` in the checkout.

    Raises:
        FileNotFoundError: the library has not been built.
    """
    path = Path(os.environ.get(LIBRARY_VARIABLE, str(DEFAULT_LIBRARY)))
    if not path.exists():
        raise FileNotFoundError(f"{path} is missing: build it with `make virtual-lathe-library`")
    loaded = ctypes.CDLL(str(path))
    for name, (result, arguments) in _SIGNATURES.items():
        function = getattr(loaded, name)
        function.restype = result
        function.argtypes = arguments
    return loaded
