# SPDX-License-Identifier: Apache-2.0
"""A new user's first day, typed into a terminal: set-up aside, everything that happens on it.

A part from questions, a look at the lathe, a wrong part, the first cut, Ctrl-C, a pulled cable, an
alarm, and each time the way back that the screen told. The transcript is left in
build/first-day.txt, for whoever wants to read what the user saw.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType

import pexpect
import pytest

from end_to_end.workshop import Workshop, pin_file

TRANSCRIPT = Path(__file__).resolve().parents[2] / "build" / "first-day.txt"
PROMPT = "user@bench:~$ "
#: Colours, cursor movements and other control sequences of a terminal.
CONTROL = re.compile(r"\x1b\[[0-9;?]*[a-zA-Z]|\x1b[=>]|\r")
STUCK_S = 60
PIN = {
    "Name of the part": "pin",
    "Units": "mm",
    "Diameter of the raw bar": "4",
    "Free length in front of the chuck": "6",
    "Raw material in front": "0.2",
    "Depth of cut": "0.3",
    "Allowance for the finishing pass": "0.05",
    "Feed for roughing": "300",
    "Feed for the finishing pass": "200",
    "Distance from the work": "0.1",
    "Nose radius": "",
    "Steepest fall": "",
    "Operation 1": "face",
    "z of the finished face": "",
    "Diameter where the cut ends": "",
    "Operation 2": "cylinder",
    "z of its start": "",
    "z of its end": "-1.5",
    "Finished diameter": "3",
    "Operation 3": "done",
}


class User:
    """Somebody at a terminal; `shell` is what they type into."""

    def __init__(self, folder: Path, port: Path) -> None:
        """Sit down in `folder`, with the lathe at `port`."""
        self.log = (folder / "log").open("w", encoding="utf-8")
        path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
        self.shell: pexpect.spawn[str] = pexpect.spawn(
            "/bin/sh",
            cwd=folder,
            encoding="utf-8",
            timeout=STUCK_S,
            dimensions=(40, 110),
            env={
                "PATH": path,
                "PS1": PROMPT,
                "TERM": "xterm-256color",
                "LANG": "C.UTF-8",
                "TORNILLO_PORT": str(port),
            },
        )
        self.shell.logfile_read = self.log
        self.shell.expect_exact(PROMPT)

    def __enter__(self) -> User:
        """Return the user."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leave; the transcript stays."""
        self.shell.close(force=True)
        self.log.close()
        text = CONTROL.sub("", Path(self.log.name).read_text(encoding="utf-8"))
        TRANSCRIPT.parent.mkdir(exist_ok=True)
        TRANSCRIPT.write_text(text, encoding="utf-8")

    def begin(self, line: str) -> None:
        """Type a command that will go on for a while."""
        self.shell.sendline(line)

    def sees(self, text: str) -> None:
        """Wait until a text stands on the screen."""
        self.shell.expect_exact(text)

    def ends(self, code: int) -> str:
        """Wait for the prompt; returns what was shown since, after checking the exit code."""
        self.shell.expect_exact(PROMPT)
        shown = CONTROL.sub("", self.shell.before or "")
        self.shell.sendline("echo code=$?")
        self.shell.expect(r"code=(\d+)\r")
        found = self.shell.match
        assert isinstance(found, re.Match)
        assert int(found[1]) == code, shown
        self.shell.expect_exact(PROMPT)
        return shown

    def types(self, line: str, code: int = 0) -> str:
        """Type a command, wait for its end and return what it showed."""
        self.begin(line)
        return self.ends(code)


@pytest.fixture
def workshop(tmp_path: Path) -> Iterator[Workshop]:
    """A lathe with worn screws and a bar of 4 mm, set up by somebody else."""
    wanted = pin_file(tmp_path / "drawing.toml")
    options = ("--part", str(wanted), "--backlash-x", "9", "--backlash-z", "12")
    with Workshop(tmp_path, *options) as workshop:
        workshop.set_up()
        yield workshop


def test_the_first_day_of_a_new_user(tmp_path: Path, workshop: Workshop) -> None:
    with User(tmp_path, workshop.port) as user:
        looks_around(user)
        makes_a_part(user)
        makes_a_wrong_part(user, tmp_path)
        cuts_it(user)
        moves_by_keys(user)
        presses_ctrl_c(user)
        watches_it(user)
        loses_the_cable(user, workshop)
        has_an_alarm(user, workshop)
    workshop.switch_off()
    report = workshop.report
    assert all(abs(entry["error_steps"]) < 1 for entry in report["dimensions"])
    # The emergency stop may cost steps: that is why it asks for homing.
    assert (len(report["dimensions"]), report["crashes"], report["gouge_max_steps"]) == (3, [], 0)


def looks_around(user: User) -> None:
    """What is there, and is it well?"""
    assert "tornillo new my-part.toml" in user.types("tornillo --help")
    examined = user.types("tornillo doctor --no-buttons")
    assert examined.count("ok  ") >= 5
    assert "NO" not in examined
    assert "unknown: not homed" in user.types("tornillo status")
    told = user.types("tornillo hom", code=2)
    assert 'there is no verb "hom"; did you mean "home"?' in told


def makes_a_part(user: User) -> None:
    """Questions and pictures, then the file is checked and planned."""
    user.begin("tornillo new pin.toml")
    for question, answer in PIN.items():
        user.sees(question)
        user.sees(": ")
        user.begin(answer)
    assert "pin.toml written; next: tornillo plan pin.toml" in user.ends(0)
    assert "pin: 2 operations" in user.types("tornillo check pin.toml")
    assert "operation 2 (cylinder)" in user.types("tornillo plan pin.toml")
    assert "pin.svg written" in user.types("tornillo draw pin.toml -o pin.svg")


def makes_a_wrong_part(user: User, folder: Path) -> None:
    """A cylinder that is larger than the bar, and a mistyped key."""
    text = (folder / "pin.toml").read_text(encoding="utf-8")
    wrong = folder / "wrong.toml"
    wrong.write_text(text.replace("diameter = 3.0", "diameter = 5.0"), encoding="utf-8")
    told = user.types("tornillo upload wrong.toml", code=1)
    line = text[: text.index("diameter = 3.0")].count("\n") + 1
    assert f"Error: wrong.toml:{line}: operation 2 (cylinder)" in told
    assert "Try: " in told
    wrong.write_text(text.replace("retract", "retreat"), encoding="utf-8")
    assert 'did you mean "retract"?' in user.types("tornillo check wrong.toml", code=1)
    assert "no parts stored" in user.types("tornillo parts")


def cuts_it(user: User) -> None:
    """Refused first, because the lathe is not homed; the screen tells what to do."""
    assert "pin is stored in slot 0" in user.types("tornillo upload pin.toml")
    told = user.types("tornillo run pin", code=1)
    assert "run `tornillo home` first" in told
    assert "homed; dead steps: X 9, Z 12" in user.types("tornillo home")
    cut = user.types("tornillo run pin --follow")
    assert "operation 2 of 2, pass" in cut
    assert "100.0 %" in cut
    assert cut.rstrip().endswith("finished")


def presses_ctrl_c(user: User) -> None:
    """It holds, says so, and goes on where it stood."""
    user.begin("tornillo run pin --follow")
    user.sees("operation 2 of 2")
    user.shell.sendintr()
    told = user.ends(1)
    assert "held by Ctrl-C at operation 2 of 2" in told
    assert "nothing is lost" in told
    assert "Try: go on with `tornillo resume --follow`" in told
    assert user.types("tornillo resume --follow").rstrip().endswith("finished")


def moves_by_keys(user: User) -> None:
    """A step towards the chuck and one away from the axis, and back to the shell."""

    def place() -> tuple[int, int]:
        shown = re.search(r"machine +X (-?\d+), Z (-?\d+) steps", user.types("tornillo status"))
        assert shown is not None
        return int(shown[1]), int(shown[2])

    x, z = place()
    user.begin("tornillo jog")
    user.sees("moves by")
    # This lathe runs faster than a real one, and so does its dead-man: be quick.
    user.shell.send("1\r")
    user.sees("1 ms a step")
    for arrow, seen in (("[D", rf"Z .*{z - 1} steps"), ("[B", rf"diameter\).*{x - 1} steps")):
        user.shell.send(f"\x1b{arrow}")
        user.shell.expect(seen.replace(".*", r"[^\n]*"))
    user.shell.send("q")
    user.ends(0)
    assert place() == (x - 1, z - 1)


def watches_it(user: User) -> None:
    """The live view, and its keys."""
    user.types("tornillo run pin")
    user.begin("tornillo watch")
    user.sees("time left")
    user.shell.send("h")
    user.sees("held; r goes on")
    user.shell.send("-")
    user.sees("feed now 90 %")
    user.shell.send("r")
    user.sees("going on")
    user.sees("waiting")
    user.shell.send("q")
    user.ends(0)


def loses_the_cable(user: User, workshop: Workshop) -> None:
    """The part goes on without the computer, which finds it again."""
    user.begin("tornillo run pin --follow")
    user.sees("operation 1 of 2")
    workshop.type("unplug")
    told = user.ends(1)
    assert "Error: no answer to STATUS" in told
    assert "goes on without the computer" in told
    workshop.type("plug")
    user.begin("tornillo watch")
    user.sees("waiting")
    user.shell.send("q")
    user.ends(0)
    assert "idle" in user.types("tornillo status")


def has_an_alarm(user: User, workshop: Workshop) -> None:
    """The emergency stop in mid-cut: what happened, what is refused now, the way back."""
    user.begin("tornillo run pin --follow")
    user.sees("operation 2 of 2")
    workshop.type("press estop")
    told = user.ends(1)
    assert "Error: alarm ESTOP: the emergency stop was pressed" in told
    assert "release the emergency stop, reset, then home again" in told
    assert "an alarm has not been acknowledged" in user.types("tornillo run pin", code=1)
    user.types("tornillo reset", code=1)
    workshop.type("press release")
    assert "no alarm; home next: `tornillo home`" in user.types("tornillo reset")
    user.types("tornillo home")
    assert user.types("tornillo run pin --follow").rstrip().endswith("finished")
