# SPDX-License-Identifier: Apache-2.0
"""The command line cuts parts on a virtual lathe at the other end of a pseudo-terminal."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import serial
from tornillo.frames import Frame, crc16, encode
from tornillo.protocol import REQUESTS, Command

from end_to_end.workshop import Workshop, pin_file


def test_upload_home_run_and_measure(tmp_path: Path) -> None:
    part = pin_file(tmp_path / "pin.toml")
    options = ("--part", str(part), "--backlash-x", "23", "--backlash-z", "31")
    with Workshop(tmp_path, *options) as workshop:
        workshop.set_up()
        uploaded = workshop.must("upload", part)
        assert "pin" in uploaded
        (stored,) = workshop.json("parts")
        assert (stored["name"], stored["selected"]) == ("pin", True)
        workshop.must("home")
        status = workshop.json("status")
        assert (status["dead_x"], status["dead_z"]) == (23, 31)
        assert workshop.must("run", "pin", "--follow").endswith("finished\n")
        status = workshop.json("status")
        assert (status["state"], status["permille"]) == ("IDLE", 1000)
    workshop.assert_part_is_right()


def test_hold_resume_and_stop(tmp_path: Path) -> None:
    part = pin_file(tmp_path / "pin.toml")
    with Workshop(tmp_path, "--part", str(part), "--backlash-x", "5") as workshop:
        workshop.set_up()
        workshop.must("upload", part)
        workshop.must("home")
        workshop.must("run")
        workshop.must("hold")
        held = workshop.json("status")
        assert held["state"] == "HOLD"
        still = workshop.json("status")
        assert (still["x"], still["z"]) == (held["x"], held["z"])
        workshop.must("resume")
        workshop.must("stop")
        assert workshop.json("status")["state"] == "IDLE"
        refused = workshop.tornillo("resume")
        assert refused.returncode == 1
        workshop.must("run", "--follow")
    workshop.assert_part_is_right()


@pytest.mark.parametrize(
    ("end", "diameter", "reason"),
    [
        pytest.param(-5.95, 3.0, "chuck", id="too near to the chuck"),
        pytest.param(-1.5, 4.5, "stock", id="larger than the stock"),
    ],
)
def test_a_part_outside_the_stock_is_refused_with_reason_and_remedy(
    tmp_path: Path, end: float, diameter: float, reason: str
) -> None:
    assert_refused(tmp_path, pin_file(tmp_path / "pin.toml", end, diameter), reason)


def test_a_part_outside_the_travel_is_refused_with_reason_and_remedy(tmp_path: Path) -> None:
    def shorten(workshop: Workshop) -> None:
        workshop.must("settings", "set", "travel_z", "200")

    assert_refused(tmp_path, pin_file(tmp_path / "pin.toml"), "slide ends", shorten)


def assert_refused(
    folder: Path,
    part: Path,
    reason: str,
    change: Callable[[Workshop], None] = lambda _: None,
) -> None:
    """Check that the command line does not upload a part, and says why."""
    with Workshop(folder) as workshop:
        workshop.set_up()
        change(workshop)
        refused = workshop.tornillo("upload", part)
        assert refused.returncode == 1
        assert f"{part}:" in refused.stderr
        assert reason in refused.stderr
        assert len(refused.stderr.strip().splitlines()) >= 2
        assert workshop.json("parts") == []


def test_the_cable_pulled_in_mid_upload_leaves_the_stored_part(tmp_path: Path) -> None:
    part = pin_file(tmp_path / "pin.toml")
    with Workshop(tmp_path, "--part", str(part)) as workshop:
        workshop.set_up()
        workshop.must("upload", part)
        before = workshop.json("parts")
        begin_an_upload(workshop.port)
        workshop.type("unplug")
        gone = workshop.tornillo("status")
        assert gone.returncode == 1
        assert "cable" in gone.stderr
        workshop.type("plug")
        assert workshop.json("parts") == before
        workshop.must("upload", part)
        workshop.must("home")
        workshop.must("run", "--follow")
    workshop.assert_part_is_right()


def begin_an_upload(port: Path) -> None:
    """Send the first two frames of an upload and half of the third."""
    piece = bytes(range(32))
    frames = [
        Frame(1, Command.UPLOAD_BEGIN, REQUESTS[Command.UPLOAD_BEGIN].pack(84, crc16(piece))),
        Frame(2, Command.UPLOAD_DATA, REQUESTS[Command.UPLOAD_DATA].pack(0) + piece),
        Frame(3, Command.UPLOAD_DATA, REQUESTS[Command.UPLOAD_DATA].pack(32) + piece),
    ]
    with serial.Serial(str(port), timeout=10) as opened:
        for frame in frames[:2]:
            opened.write(b"\0" + encode(frame))
            opened.read_until(b"\0")
        opened.write(encode(frames[2])[:20])


def test_the_part_is_cut_by_the_buttons_with_usb_never_attached(tmp_path: Path) -> None:
    part = pin_file(tmp_path / "pin.toml")
    memory = ("--eeprom-file", str(tmp_path / "memory"))
    with Workshop(tmp_path, *memory) as workshop:
        workshop.set_up()
        workshop.must("upload", part)
    by_hand = ("--no-usb", "--press", "run@0.1", "--press", "run@4", "--seconds", "16")
    lathe = Workshop(tmp_path, *memory, "--part", str(part), "--backlash-x", "9", *by_hand)
    lathe.wait()
    lathe.assert_part_is_right()
    assert lathe.report["usb_counts"]["transactions"] == 0
