# SPDX-License-Identifier: Apache-2.0
"""Write the host's protocol.py (numbers, layouts), protocol_texts.py (sentences), version.py."""

import textwrap

from protocol_model import NOTICE, RECORD_HEAD_CODE, Layout, Model

WIDTH = 100
CLASSES = {
    "axis": ("Axis", "IntEnum", "The two slides."),
    "state": ("State", "IntEnum", "What the machine is doing."),
    "status_flag": ("StatusFlag", "IntFlag", "Bits of the flags in STATUS."),
    "homed_axis": ("HomedAxis", "IntFlag", "Axes in HOME and STATUS."),
    "warning": ("MachineWarning", "IntFlag", "Bits of the warnings in STATUS."),
    "run_flag": ("RunFlag", "IntFlag", "Bits of the flags in RUN."),
    "alarm": ("Alarm", "IntEnum", "Why the machine stopped."),
    "input": ("StatusInput", "IntFlag", "Bits of the inputs in STATUS."),
    "reset_cause": ("ResetCause", "IntEnum", "Why the chip last started."),
    "error": ("ErrorCode", "IntEnum", "First payload byte of every response."),
    "refusal": ("Refusal", "IntEnum", "Why a part is refused."),
}


def camel(name: str) -> str:
    """`part_info` -> `PartInfo`."""
    return "".join(word.capitalize() for word in name.split("_"))


def head(purpose: str, imports: list[str]) -> list[str]:
    """The first lines of a generated module."""
    return [
        "# SPDX-License-Identifier: Apache-2.0",
        f'"""{purpose}',
        "",
        NOTICE,
        '"""',
        "",
        *imports,
    ]


def quoted(text: str, indent: int) -> str:
    """A string literal, split over lines where it does not fit."""
    literal = f'"{text}"'
    if indent + len(literal) + 1 <= WIDTH:
        return literal
    pad = " " * (indent + 4)
    words = textwrap.wrap(text, WIDTH - indent - 7, drop_whitespace=False)
    return "(\n" + "\n".join(f'{pad}"{line}"' for line in words) + "\n" + " " * indent + ")"


def version_module(model: Model) -> str:
    """The module that tells the version without anything else to import."""
    lines = head("The version of this package and of the firmware that belongs to it.", [])
    return "\n".join([*lines, f'__version__ = "{model.raw["firmware"]["version"]}"', ""])


def constants(model: Model) -> list[str]:
    """Versions, frame and limits."""
    raw = model.raw
    frame = raw["frame"]
    lines = [
        f"PROTOCOL_VERSION = {raw['protocol']['version']}",
        f'FIRMWARE_VERSION = "{raw["firmware"]["version"]}"',
        f"USB_VENDOR_ID = 0x{raw['usb']['vendor_id']:04X}",
        f"USB_PRODUCT_ID = 0x{raw['usb']['product_id']:04X}",
        f"USB_LOADER_PRODUCT_ID = 0x{raw['usb']['loader_product_id']:04X}",
        f"FRAME_PAYLOAD_MAX = {frame['payload_max']}",
        f"FRAME_TIMEOUT_MS = {frame['timeout_ms']}",
        f"FRAME_TRIES = {frame['tries']}",
        f"FRAME_RESPONSE_BIT = 0x{frame['response_bit']:02X}",
        f"CRC16_POLYNOMIAL = 0x{raw['crc']['polynomial']:04X}",
        f"CRC16_INITIAL = 0x{raw['crc']['initial']:04X}",
        f"CRC16_CHECK = 0x{raw['crc']['check']:04X}",
    ]
    for name, entry in raw["limits"].items():
        lines += [f"#: {entry['meaning']}", f"{name.upper()} = {entry['value']}"]
    return lines


def enum(name: str, base: str, purpose: str, members: dict[str, str]) -> list[str]:
    """One enumeration."""
    lines = ["", "", f"class {name}({base}):", f'    """{purpose}"""', ""]
    return lines + [f"    {member.upper()} = {value}" for member, value in members.items()]


def enums(model: Model) -> list[str]:
    """Every enumeration."""
    codes = {command.name: f"0x{command.code:02X}" for command in model.commands}
    lines = enum("Command", "IntEnum", "Code byte of a request.", codes)
    for table, (name, base, purpose) in CLASSES.items():
        members = {
            member: f"0x{entry['value']:02X}" if base == "IntFlag" else str(entry["value"])
            for member, entry in model.raw[table].items()
        }
        lines += enum(name, base, purpose, members)
    types = {name: str(entry["type"]) for name, entry in model.raw["operation"].items()}
    lines += enum("OperationType", "IntEnum", "First byte of an operation record.", types)
    ids = {name: str(entry["id"]) for name, entry in model.raw["setting"].items()}
    return lines + enum("SettingId", "IntEnum", "Settings by their number.", ids)


def struct(part: Layout, before: str = "") -> str:
    """The struct format of the closed fields."""
    return '"<' + before + "".join(field.struct_code for field in part.fields) + '"'


def record(name: str, purpose: str, part: Layout, head: tuple[str, ...] = ()) -> list[str]:
    """A NamedTuple for a layout, after the numbers of `head`."""
    first, _, rest = purpose.partition(". ")
    lines = ["", "", f"class {name}(NamedTuple):"]
    if rest:
        wrapped = textwrap.wrap(rest, WIDTH - 4)
        lines += [f'    """{first}.', "", *(f"    {line}" for line in wrapped), '    """', ""]
    else:
        lines += [f'    """{purpose}"""', ""]
    lines += [f"    {field}: int" for field in head]
    for field in part.fields:
        lines += [f"    {field.name}: {'bytes' if field.is_text or field.is_open else 'int'}"]
    return lines


def layouts(model: Model) -> list[str]:
    """Struct objects and named tuples of requests, responses and the part image."""
    lines = [
        "",
        "",
        "#: Request payloads; UPLOAD_DATA is followed by its bytes.",
        "REQUESTS = {",
        *[f"    Command.{c.name.upper()}: Struct({struct(c.request)})," for c in model.commands],
        "}",
        "#: Response data after the error byte; PART_READ answers bytes alone.",
        "RESPONSES = {",
        *[f"    Command.{c.name.upper()}: Struct({struct(c.response)})," for c in model.commands],
        "}",
        "#: Header of a part image.",
        f"IMAGE_HEADER = Struct({struct(model.image_header)})",
        f"IMAGE_FORMAT = {model.raw['image']['format']}",
        "#: Records: type, kind, size of the whole, then the closed fields of the type.",
        "OPERATION_RECORDS = {",
    ]
    for name, part in model.operations.items():
        lines.append(f"    OperationType.{name.upper()}: Struct({struct(part, RECORD_HEAD_CODE)}),")
    lines.append("}")
    for command in model.commands:
        if command.response.fields and not command.response.is_open:
            purpose = f"Response data of {command.name.upper()}."
            lines += record(f"{camel(command.name)}Data", purpose, command.response)
    lines += record("ImageHeader", "Header of a part image.", model.image_header)
    for name, part in model.operations.items():
        purpose = model.raw["operation"][name]["meaning"]
        lines += record(f"{camel(name)}Record", purpose, part, head=("kind",))
    return lines


def settings(model: Model) -> list[str]:
    """The table of settings, one line each."""
    lines = [
        "",
        "",
        "class Setting(NamedTuple):",
        '    """One setting with its default, range and unit."""',
        "",
        "    id: SettingId",
        "    default: int",
        "    minimum: int",
        "    maximum: int",
        "    unit: str",
        "    meaning: str",
        "",
        "",
        "SETTINGS = (",
    ]
    for name, row in model.raw["setting"].items():
        numbers = ", ".join(str(row[key]) for key in ("default", "min", "max"))
        words = f'"{row["unit"]}", "{row["meaning"]}"'
        line = f"    Setting(SettingId.{name.upper()}, {numbers}, {words}),"
        if len(line) > WIDTH:
            raise ValueError(f"setting {name}: shorten its meaning")
        lines.append(line)
    return [*lines, ")"]


def numbers_module(model: Model) -> str:
    """The whole of protocol.py."""
    imports = [
        "from enum import IntEnum, IntFlag",
        "from struct import Struct",
        "from typing import NamedTuple",
        "",
    ]
    purpose = "Numbers shared with the chip: frames, commands, codes, part image, settings."
    lines = head(purpose, imports)
    lines += constants(model) + enums(model) + layouts(model) + settings(model)
    return "\n".join(lines) + "\n"


def texts(model: Model, table: str, constant: str) -> list[str]:
    """Cause and remedy of each member of one table."""
    name = CLASSES[table][0]
    lines = ["", f"{constant} = {{"]
    for member, entry in model.raw[table].items():
        lines.append(f"    {name}.{member.upper()}: Explanation(")
        lines += [f"        {quoted(entry[key], 8)}," for key in ("cause", "remedy")]
        lines.append("    ),")
    return [*lines, "}"]


def texts_module(model: Model) -> str:
    """The whole of protocol_texts.py."""
    imports = [
        "from typing import NamedTuple",
        "",
        "from tornillo.protocol import Alarm, ErrorCode, MachineWarning, Refusal",
        "",
        "",
        "class Explanation(NamedTuple):",
        '    """Why the chip says no, and what a person does next."""',
        "",
        "    cause: str",
        "    remedy: str",
        "",
    ]
    lines = head("What the codes of the chip mean to a person.", imports)
    lines += texts(model, "error", "ERROR_TEXTS")
    lines += texts(model, "alarm", "ALARM_TEXTS")
    lines += texts(model, "warning", "WARNING_TEXTS")
    lines += texts(model, "refusal", "REFUSAL_TEXTS")
    return "\n".join(lines) + "\n"
