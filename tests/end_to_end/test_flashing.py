# SPDX-License-Identifier: Apache-2.0
"""`tornillo flash` changes the firmware of the simulated chip at the end of a pseudo-terminal."""

from __future__ import annotations

from pathlib import Path

from end_to_end.workshop import Workshop, pin_file

FIRMWARE = Path(__file__).parents[2] / "build" / "firmware" / "tornillo.hex"


def test_another_firmware_and_the_lathe_keeps_part_and_settings_and_cuts(tmp_path: Path) -> None:
    part = pin_file(tmp_path / "pin.toml")
    with Workshop(tmp_path, "--part", str(part), "--backlash-x", "9") as workshop:
        workshop.set_up()
        workshop.must("upload", part)
        told = workshop.json("flash", FIRMWARE)
        assert told["before"] == told["firmware"]
        (stored,) = workshop.json("parts")
        assert (stored["name"], stored["selected"]) == ("pin", True)
        assert "-330" in workshop.must("settings", "get", "zero_x")
        workshop.must("home")
        assert workshop.must("run", "pin", "--follow").endswith("finished\n")
    workshop.assert_part_is_right()


def test_a_firmware_that_is_damaged_is_refused_and_the_old_one_stays(tmp_path: Path) -> None:
    lines = FIRMWARE.read_text(encoding="ascii").splitlines(keepends=True)
    truncated = tmp_path / "truncated.hex"
    truncated.write_text("".join(lines[: len(lines) // 2]), encoding="ascii")
    with Workshop(tmp_path) as workshop:
        refused = workshop.tornillo("flash", truncated)
        assert refused.returncode == 1
        assert "truncated.hex" in refused.stderr
        assert workshop.json("status")["state"] == "IDLE"
        assert workshop.json("flash", FIRMWARE, "--check")
