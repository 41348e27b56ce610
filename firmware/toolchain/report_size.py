#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Write size.json, print bytes per room, fail when a budget is exceeded.

usage: report_size.py BUILD_DIRECTORY      (with tornillo.hex and tornillo.map)
"""

import json
import re
import sys
from collections import Counter
from pathlib import Path

from stack_depth import ByteCode, worst_case

FLASH_BYTES, RAM_BYTES = 32_768, 2_048
BUDGETS = {
    "flash_bytes": 0x7600,  # where the part store begins; why: docs/firmware-tour.md
    "ram_bytes": RAM_BYTES * 94 // 100,
    "hw_stack_worst_levels": 20,
}
STACK_ADDRESS = 0x700  # "#pragma stack" in main.c
#: What is left of the compiled C after every file has been counted: tables, vectors, registers.
COMPILED = "tables and registers"
MAIN = "start and main loop"
BYTE_CODE = "bytecode"  # interpreter, tables, equal pieces
#: The boot block is the loader's as a whole: no program can use what is left of it.
LOADER, BOOT_BLOCK_BYTES = "loader", 0x800
C_FILES = {
    file.stem: file.parent.name if file.parent.name != "firmware" else MAIN
    for file in Path("firmware").rglob("*.c")
}
SHRUNK = re.compile(r"^(\w+)\s+\d+\s+(\d+)$")
SECTION = re.compile(
    r"^\s*(\S+)\s+(code|romdata|udata|idata)\s+0x([0-9a-f]+)\s+(program|data)\s+0x([0-9a-f]+)"
)
SYMBOL = re.compile(r"^\s*(\w+)\s+0x([0-9a-f]+)\s+(program|data)\s+\w+\s+(\S+)")


def read_hex(path: Path) -> bytes:
    """Return the program memory of an Intel hex file, 0xFF where nothing is written."""
    flash = bytearray(b"\xff" * FLASH_BYTES)
    base = 0
    for line in path.read_text().split():
        record = bytes.fromhex(line[1:])
        count, address, kind = record[0], record[1] << 8 | record[2], record[3]
        if kind == 4:
            base = (record[4] << 8 | record[5]) << 16
        elif kind == 0 and base + address < FLASH_BYTES:
            flash[base + address : base + address + count] = record[4 : 4 + count]
    return bytes(flash)


def rooms(directory: Path) -> tuple[Counter[str], Counter[str], int]:
    """Return flash and RAM bytes by room, and the bytes set aside for the software stack.

    Compiled C is one section, byte code another.
    """
    map_text = (directory / "tornillo.map").read_text()
    sources = {}
    for line in map_text.splitlines():
        if match := SYMBOL.match(line):
            sources[(match[3], int(match[2], 16))] = match[4]
    flash: Counter[str] = Counter()
    ram: Counter[str] = Counter()
    stack = 0
    for line in map_text.splitlines():
        match = SECTION.match(line)
        if not match:
            continue
        name, address, size = match[1], int(match[3], 16), int(match[5], 16)
        owner = room(name, sources.get((match[4], address), ""))
        if match[4] == "program" and address < FLASH_BYTES:
            flash[owner] += size
        elif match[4] == "data" and address == STACK_ADDRESS:
            stack += size
        elif match[4] == "data" and address < RAM_BYTES:
            ram[owner] += size
    if flash[LOADER] > BOOT_BLOCK_BYTES:
        sys.exit(f"the boot loader does not fit: {flash[LOADER]} > {BOOT_BLOCK_BYTES}")
    flash[LOADER] = BOOT_BLOCK_BYTES
    for owner, file, count in by_file(directory):
        flash[C_FILES[file]] += count
        flash[owner] -= count
    return flash, ram, stack


def by_file(directory: Path) -> list[tuple[str, str, int]]:
    """Return what each file of C has become: bytes of one of the two common sections."""
    found = []
    for line in (directory / "shrink.txt").read_text().splitlines():
        if (match := SHRUNK.match(line)) and match[1] != "all":
            found.append((COMPILED, match[1], int(match[2])))
    sizes = json.loads((directory / "byte_code.json").read_text())["flash"]
    return found + [(BYTE_CODE, file, count) for file, count in sizes.items() if file]


def byte_code(directory: Path) -> ByteCode:
    """Return what is known of the byte code."""
    report = json.loads((directory / "byte_code.json").read_text())
    lines = (directory / "tornillo.map").read_text().splitlines()
    found = [match for line in lines if (match := SYMBOL.match(line))]
    return ByteCode(report, {m[1]: int(m[2], 16) for m in found if m[3] == "program"})


def room(section: str, source: str) -> str:
    """Return the room of the firmware that a section belongs to."""
    variable = re.match(r"(?:udata_(\w+)_\d+|(\w+)_\d+_data)$", section)
    if variable and (variable[1] or variable[2]) in C_FILES:
        return C_FILES[variable[1] or variable[2]]
    if section.startswith("byte_"):
        return BYTE_CODE
    if "registers" in section or source.endswith("compiled.asm"):
        return COMPILED
    path = Path(source)
    if path.parts[:1] == ("firmware",):
        return path.parts[1] if len(path.parts) > 2 else MAIN
    return "library"


def main() -> None:
    """Report on the build in the directory given."""
    directory = Path(sys.argv[1])
    flash, ram, stack_room = rooms(directory)
    stack = worst_case(read_hex(directory / "tornillo.hex"), byte_code(directory))
    sizes = {
        "flash_bytes": sum(flash.values()),
        "ram_static_bytes": sum(ram.values()),
        "sw_stack_worst_bytes": stack.bytes,
        "hw_stack_worst_levels": stack.levels,
    }
    report = sizes | {"budgets": BUDGETS, "flash_by_room": flash, "ram_by_room": ram}
    (directory / "size.json").write_text(json.dumps(report, indent=2) + "\n")
    for name in sorted(flash | ram, key=lambda key: -flash[key]):
        print(f"  {name:24}{flash[name]:7} bytes of flash{ram[name]:6} bytes of RAM")
    print("  " + ", ".join(f"{key} {value}" for key, value in sizes.items()))
    measured = sizes | {"ram_bytes": sizes["ram_static_bytes"] + stack.bytes}
    over = [
        f"{key} {measured[key]} > {limit}"
        for key, limit in BUDGETS.items()
        if measured[key] > limit
    ]
    if stack.bytes > stack_room:
        over.append(f"software stack {stack.bytes} > {stack_room} set aside")
    if over:
        (directory / "size.json").unlink()
        sys.exit("over budget: " + "; ".join(over))


if __name__ == "__main__":
    main()
