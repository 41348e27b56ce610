# SPDX-License-Identifier: Apache-2.0
"""The files derived from protocol.toml: complete, equal on both sides, checked for staleness."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tornillo import protocol
from tornillo.protocol_texts import ALARM_TEXTS, ERROR_TEXTS, REFUSAL_TEXTS, WARNING_TEXTS

ROOT = Path(__file__).resolve().parents[2]
LINK = ROOT / "firmware" / "link"
HEADER = (LINK / "protocol.h").read_text(encoding="utf-8")
DEFINES = dict(re.findall(r"^#define (\w+) +(\S+)$", HEADER, re.MULTILINE))


def generate(root: Path, *arguments: str) -> "subprocess.CompletedProcess[str]":
    """Run the generator of the checkout in `root`."""
    script = root / "firmware" / "link" / "generate_protocol.py"
    return subprocess.run(
        [sys.executable, str(script), *arguments], capture_output=True, text=True, check=False
    )


def number(text: str) -> int:
    """A number of the header."""
    return int(text.strip("()").removesuffix("L"), 0)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A copy of the source and of everything derived from it."""
    for name in ("firmware/link", "host-cli/src/tornillo", "docs"):
        (tmp_path / name).mkdir(parents=True)
    for path in LINK.glob("*protocol*"):
        shutil.copy(path, tmp_path / "firmware" / "link")
    for name in ("protocol.py", "protocol_texts.py", "version.py"):
        folder = Path("host-cli/src/tornillo")
        shutil.copy(ROOT / folder / name, tmp_path / folder)
    shutil.copy(ROOT / "docs" / "protocol.md", tmp_path / "docs")
    return tmp_path


def test_the_committed_files_are_up_to_date() -> None:
    result = generate(ROOT, "--check")
    assert (result.returncode, result.stdout) == (0, "")


@pytest.mark.parametrize(
    "name",
    [
        "firmware/link/protocol.h",
        "host-cli/src/tornillo/protocol.py",
        "host-cli/src/tornillo/protocol_texts.py",
        "host-cli/src/tornillo/version.py",
        "docs/protocol.md",
    ],
)
def test_a_stale_file_is_found_and_written_anew(checkout: Path, name: str) -> None:
    source = checkout / "firmware" / "link" / "protocol.toml"
    text = source.read_text(encoding="utf-8")
    text = text.replace("part_slots = { value = 12", "part_slots = { value = 9")
    text = text.replace("the lathe is moving", "the lathe moves")
    text = text.replace('version = "0.1.0"', 'version = "0.1.1"')
    source.write_text(text, encoding="utf-8")
    stale = generate(checkout, "--check")
    assert stale.returncode == 1
    assert f"{name} is stale: run python3 firmware/link/generate_protocol.py" in stale.stdout
    assert generate(checkout).returncode == 0
    assert generate(checkout, "--check").returncode == 0


def test_the_generator_refuses_other_arguments() -> None:
    assert generate(ROOT, "--what").returncode == 2


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (("errors = []", 'errors = ["nonsense"]'), "no such error: nonsense"),
        (('type = "char8"', 'type = "char80"'), "longer than a frame"),
    ],
)
def test_the_generator_refuses_a_source_that_cannot_work(
    checkout: Path, damage: tuple[str, str], message: str
) -> None:
    source = checkout / "firmware" / "link" / "protocol.toml"
    source.write_text(source.read_text(encoding="utf-8").replace(*damage), encoding="utf-8")
    result = generate(checkout)
    assert result.returncode != 0
    assert message in result.stderr


@pytest.mark.parametrize(
    ("members", "prefix"),
    [
        (protocol.Command, "COMMAND"),
        (protocol.Axis, "AXIS"),
        (protocol.State, "STATE"),
        (protocol.StatusFlag, "STATUS_FLAG"),
        (protocol.HomedAxis, "HOMED_AXIS"),
        (protocol.MachineWarning, "WARNING"),
        (protocol.RunFlag, "RUN_FLAG"),
        (protocol.Alarm, "ALARM"),
        (protocol.ResetCause, "RESET_CAUSE"),
        (protocol.ErrorCode, "ERROR"),
        (protocol.Refusal, "REFUSAL"),
        (protocol.OperationType, "OPERATION"),
        (protocol.SettingId, "SETTING"),
    ],
)
def test_chip_and_host_have_the_same_codes(members: "type[protocol.Command]", prefix: str) -> None:
    for member in members:
        assert number(DEFINES[f"{prefix}_{member.name}"]) == member.value


def test_chip_and_host_have_the_same_settings() -> None:
    rows = re.findall(r"^    X\((\d+), (\w+), (\S+), (\S+), ([^ ]+)\)", HEADER, re.MULTILINE)
    chip = [(int(row[0]), row[1], *(number(value) for value in row[2:])) for row in rows]
    host = [(s.id, s.id.name, s.default, s.minimum, s.maximum) for s in protocol.SETTINGS]
    assert chip == host
    assert all(row[3] <= row[2] <= row[4] for row in host)


def test_chip_and_host_have_the_same_message_sizes() -> None:
    for command in protocol.Command:
        size = DEFINES.get(f"{command.name}_RESPONSE_SIZE")
        if size is not None:
            assert number(size) == protocol.RESPONSES[command].size + 1
    assert number(DEFINES["PART_IMAGE_HEADER_SIZE"]) == protocol.IMAGE_HEADER.size == 32
    for kind, record in protocol.OPERATION_RECORDS.items():
        size = DEFINES.get(f"OPERATION_{kind.name}_SIZE")
        assert size is None or number(size) == record.size


def test_every_code_is_explained() -> None:
    assert set(ERROR_TEXTS) == set(protocol.ErrorCode)
    assert set(ALARM_TEXTS) == set(protocol.Alarm)
    assert set(WARNING_TEXTS) == set(protocol.MachineWarning)
    assert set(REFUSAL_TEXTS) == set(protocol.Refusal)
