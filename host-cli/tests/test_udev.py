# SPDX-License-Identifier: Apache-2.0
"""The udev rule and the verb that installs it."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from tornillo.cli import main
from tornillo.protocol import USB_PRODUCT_ID, USB_VENDOR_ID
from tornillo.udev import RULE, RULE_NAME


def test_the_rule_is_for_our_device_alone_and_keeps_modem_daemons_off() -> None:
    shown = CliRunner().invoke(main, ["udev", "--show"])
    assert (shown.exit_code, shown.stdout) == (0, RULE)
    device, port = [line for line in RULE.splitlines() if not line.startswith("#")]
    for line, field in ((device, "ATTR"), (port, "ATTRS")):
        assert f'{field}{{idVendor}}=="{USB_VENDOR_ID:04x}"' in line
        assert f'{field}{{idProduct}}=="{USB_PRODUCT_ID:04x}"' in line
    assert 'ENV{ID_MM_DEVICE_IGNORE}="1"' in device
    assert 'ENV{ID_MM_PORT_IGNORE}="1"' in port
    assert 'TAG+="uaccess"' in port


def test_the_rule_is_written_where_it_is_wanted(tmp_path: Path) -> None:
    done = CliRunner().invoke(main, ["udev", "--folder", str(tmp_path)])
    assert done.exit_code == 0
    assert (tmp_path / RULE_NAME).read_text(encoding="ascii") == RULE


def test_a_computer_without_udev_is_told_that_it_needs_no_rule(tmp_path: Path) -> None:
    done = CliRunner().invoke(main, ["udev", "--folder", str(tmp_path / "none")])
    assert done.exit_code == 1
    assert "has no udev" in done.stderr


def test_who_is_not_root_is_told_what_to_type(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise PermissionError

    monkeypatch.setattr(Path, "write_text", refuse)
    done = CliRunner().invoke(main, ["udev", "--folder", str(tmp_path)])
    assert done.exit_code == 1
    assert "sudo" in done.stderr
