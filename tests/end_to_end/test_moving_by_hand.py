# SPDX-License-Identifier: Apache-2.0
"""The command line moves the slides and touches the work of a virtual lathe."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

from end_to_end.workshop import ZERO_X, ZERO_Z, Workshop, pin_file


def test_a_part_is_right_after_its_zero_was_touched(tmp_path: Path) -> None:
    part = pin_file(tmp_path / "pin.toml")
    options = ("--part", str(part), "--backlash-x", "23", "--backlash-z", "31", "--probe")
    with Workshop(tmp_path, *options) as workshop:
        workshop.must("settings", "set", "homing_repeats", "1")
        workshop.must("settings", "set", "probe_fitted", "1")
        workshop.must("home")
        # Part zero is somewhere else: only the slides' ways are known.
        workshop.must("jog", "z", "-2mm")
        touched = workshop.json("touch", "x", "--within", "1mm", "--diameter", "4")
        assert (touched["axis"], touched["spread"]) == ("X", 0)
        assert workshop.must("settings", "get", "zero_x").strip() == str(ZERO_X)
        workshop.must("jog", "z", "2mm")
        workshop.must("jog", "x", "-98", "--steps", "--rate", "400")
        workshop.must("touch", "z", "--within", "1mm", "--at", "0.2")
        assert workshop.must("settings", "get", "zero_z").strip() == str(ZERO_Z)
        outside = workshop.tornillo("goto", "--diameter", "99")
        assert outside.returncode == 1
        workshop.must("goto", "--diameter", "4.2", "--z", "0.5")
        workshop.must("upload", part)
        assert workshop.must("run", "pin", "--follow").endswith("finished\n")
    workshop.assert_part_is_right()


def test_ctrl_c_stops_a_jog_and_the_position_stays_known(tmp_path: Path) -> None:
    with Workshop(tmp_path, "--stock-diameter", "0.1") as workshop:
        workshop.set_up()
        workshop.must("home")
        tornillo = Path(sys.executable).parent / "tornillo"
        jog = subprocess.Popen(
            [tornillo, "--port", workshop.port, "jog", "z", "-60mm"],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        assert jog.stderr is not None
        assert jog.stderr.readline() == "moving; Ctrl-C stops\n"
        time.sleep(0.5)
        jog.send_signal(signal.SIGINT)
        _, said = jog.communicate(timeout=60)
        assert jog.returncode == 1
        assert "stopped by Ctrl-C" in said
        status = workshop.json("status")
        assert (status["state"], status["homed"]) == ("IDLE", True)
        assert -8000 < status["z"] < -20
    assert workshop.report["slide_z"] == status["z"]
    assert workshop.report["lost_steps"] == 0
