# SPDX-License-Identifier: Apache-2.0
"""The command line of the virtual lathe.

It prints the port on the first line of standard output, then a line of state every few seconds,
and writes the report when it ends. Lines typed on standard input press buttons while it runs:
``press run``, ``press hold``, ``press stop``, ``press estop``, ``press release``, ``plug``,
``unplug``, ``state``, ``quit``. ``tool NAME`` puts another tool of the part into the holder, ``tool
next`` the one that the part needs next. With ``--panel`` display and keys are there too: on a
terminal its keys press those of the panel, otherwise lines like ``key down`` or ``key x-out 1.5``.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import select
import signal
import sys
import time
from functools import partial
from pathlib import Path
from types import FrameType

from .chip import CYCLES_PER_SECOND, EEPROM_BYTES, FLASH_BYTES, NonVolatile
from .lathe import BUTTONS, DEFAULT_FIRMWARE, Options, VirtualLathe
from .machine import AxisName
from .motor import PULL_IN
from .panel import KEYS, PRESS_S
from .panel_picture import KINDS
from .panel_terminal import KeyHand, Screen, actions
from .terminal import Terminal
from .usb_host import UsbError
from .usbip import BUS_ID, Exporter

ACTIONS = (*BUTTONS, "estop", "release", "plug", "unplug")
SLICE_S = 0.005
STATE_EVERY_S = 5.0
MEMORY_BYTES = FLASH_BYTES + EEPROM_BYTES


def _timed(text: str) -> tuple[str, float]:
    name, _, seconds = text.partition("@")
    if name not in (*ACTIONS, *KEYS) or not seconds:
        raise argparse.ArgumentTypeError(
            f"{text!r}: write BUTTON@SECONDS with one of {', '.join((*ACTIONS, *KEYS))}"
        )
    return name, float(seconds)


def _listen_address(text: str) -> tuple[str, int]:
    name, _, port = text.rpartition(":")
    if not name or not port.isdecimal() or int(port) > 0xFFFF:
        raise argparse.ArgumentTypeError(f"{text!r}: write ADDRESS:PORT, like 127.0.0.1:3240")
    return name, int(port)


def _picture(text: str) -> Path:
    if Path(text).suffix.lower() not in KINDS:
        raise argparse.ArgumentTypeError(f"{text!r}: a picture is a {' or a '.join(KINDS)}")
    return Path(text)


def _nose_radius(text: str) -> float:
    if not 0 <= float(text) < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r}: a nose radius is 0 or more")
    return float(text)


def build_parser() -> argparse.ArgumentParser:
    """Return the parser with all options of the command."""
    parser = argparse.ArgumentParser(prog="virtual_lathe", description=__doc__)
    add = parser.add_argument
    add("--firmware", type=Path, default=DEFAULT_FIRMWARE, help=".hex or .cod for the 18F4550")
    add("--part", type=Path, help="part file to compare the workpiece with")
    add("--stock-diameter", type=float, metavar="MM", help="default: of the part, else 25.4")
    add("--stock-length", type=float, metavar="MM", help="part zero to chuck; else 50.8")
    add("--stock-allowance", type=float, metavar="MM", help="raw metal beyond z = 0")
    add("--nose-radius", type=_nose_radius, metavar="MM", help="default: of the part's tools")
    add("--tool", default="", metavar="NAME", help="in the holder at first; default: as needed")
    for axis in "xz":
        add(f"--backlash-{axis}", type=int, default=0, metavar="STEPS")
        add(f"--switch-travel-{axis}", type=int, default=0, metavar="STEPS")
    add("--start-x", type=int, default=-400, metavar="STEPS", help="slide X at power-on")
    add("--start-z", type=int, default=-900, metavar="STEPS", help="slide Z at power-on")
    add("--part-zero-x", type=int, default=-3575, metavar="STEPS", help="spindle axis")
    add("--part-zero-z", type=int, default=-8000, metavar="STEPS", help="front of the part")
    add("--motor-limit", type=float, default=PULL_IN, metavar="STEPS/S")
    add("--cut-rate-limit", type=float, default=900.0, metavar="STEPS/S")
    add("--switch-bounce", type=int, default=0, metavar="US")
    add("--switch-noise", type=int, default=0, metavar="HZ")
    add("--probe", action="store_true", help="wire the contact sensor between tool and work (RA1)")
    add("--panel", action="store_true", help="fit display and keys; draws them, takes keys")
    add(
        "--panel-picture",
        type=_picture,
        metavar="FILE",
        help="draw the display dot by dot at the end, .png or .svg; fits the panel",
    )
    add("--seed", type=int, default=1)
    add("--press", type=_timed, action="append", default=[], metavar="BUTTON@T")
    add("--unplug", type=float, action="append", default=[], metavar="T", help="same: unplug@T")
    add("--plug", type=float, action="append", default=[], metavar="T")
    add("--no-usb", action="store_true", help="the cable is never put in")
    add("--port-link", type=Path, metavar="PATH")
    add(
        "--usbip",
        type=_listen_address,
        metavar="ADDRESS:PORT",
        help="export the device over USB/IP in place of a port; attach it with "
        f"`usbip attach -r ADDRESS -b {BUS_ID}`",
    )
    add("--vcd", type=Path, metavar="FILE", help="trace of all pins for GTKWave")
    add("--report", type=Path, metavar="FILE")
    add("--eeprom-file", type=Path, metavar="FILE", help="keeps flash and EEPROM between runs")
    add("--seconds", type=float, help="stop after this simulated time")
    add("--real-time", action="store_true", help="not faster than the clock on the wall")
    return parser


def options_from(arguments: argparse.Namespace) -> Options:
    """Turn parsed arguments into the options of the lathe."""
    return Options(
        firmware=arguments.firmware,
        part=arguments.part,
        stock_diameter_mm=arguments.stock_diameter,
        stock_length_mm=arguments.stock_length,
        stock_allowance_mm=arguments.stock_allowance,
        nose_radius_mm=arguments.nose_radius,
        tool=arguments.tool,
        backlash_x=arguments.backlash_x,
        backlash_z=arguments.backlash_z,
        switch_travel_x=arguments.switch_travel_x,
        switch_travel_z=arguments.switch_travel_z,
        start_x=arguments.start_x,
        start_z=arguments.start_z,
        part_zero_x=arguments.part_zero_x,
        part_zero_z=arguments.part_zero_z,
        pull_in=arguments.motor_limit,
        cut_rate_limit=arguments.cut_rate_limit,
        probe=arguments.probe,
        panel=arguments.panel or arguments.panel_picture is not None,
        bounce_us=arguments.switch_bounce,
        noise_hz=arguments.switch_noise,
        seed=arguments.seed,
        usb=not arguments.no_usb,
    )


def load_memory(path: Path | None) -> NonVolatile | None:
    """Read flash and EEPROM of an earlier run; None when there is none."""
    if path is None or not path.exists():
        return None
    content = path.read_bytes()
    if len(content) != MEMORY_BYTES:
        raise SystemExit(f"{path} does not hold {MEMORY_BYTES} bytes of flash and EEPROM")
    return NonVolatile(content[:FLASH_BYTES], content[FLASH_BYTES:])


class Session:
    """One run of the command."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        """Switch the lathe on and make the terminal."""
        self.arguments = arguments
        self.lathe = VirtualLathe(options_from(arguments), load_memory(arguments.eeprom_file))
        if arguments.vcd:
            self.lathe.chip.open_vcd(arguments.vcd)
        self.terminal = Terminal(self.lathe.host, arguments.port_link)
        self.exporter = (
            Exporter(self.lathe.host, arguments.usbip, self.lathe.run_to)
            if arguments.usbip
            else None
        )
        self.hand = KeyHand(self.lathe)
        self.screen: Screen | None = None
        self.stopped = False
        self.enumerate_wanted = False
        self._stdin_open = not sys.stdin.closed
        self._typed = b""
        self._schedule()

    def _schedule(self) -> None:
        for name, seconds in self.arguments.press:
            if name in KEYS and not self.lathe.options.panel:
                raise ValueError(f"--press {name}: no panel is fitted, --panel does it")
            self.lathe.at(seconds, partial(self.act, name))
        for seconds in self.arguments.unplug:
            self.lathe.at(seconds, lambda: self.act("unplug"))
        for seconds in self.arguments.plug:
            self.lathe.at(seconds, lambda: self.act("plug"))
        if self.lathe.options.usb and not self.arguments.plug:
            self.act("plug")

    def act(self, name: str) -> None:
        """Press a button or a key, or move the cable."""
        if name in KEYS:
            self.hand.press(name)
            return
        self.lathe.press(name)
        if name in ("plug", "unplug"):
            self.enumerate_wanted = name == "plug"

    def stop(self, _signal: int, _frame: FrameType | None) -> None:
        """End the run at the next opportunity."""
        self.stopped = True

    def state_line(self) -> str:
        """Return one line about where things stand."""
        x = self.lathe.machine.axis(AxisName.X)
        z = self.lathe.machine.axis(AxisName.Z)
        usb = "open" if self.lathe.host.port_open else "closed"
        return (
            f"t={self.lathe.seconds:.1f}s X={x.slide:g} Z={z.slide:g} "
            f"steps={x.steps}+{z.steps} lost={x.lost_steps}+{z.lost_steps} "
            f"cut={self.lathe.workpiece.steps_cutting} port={usb} "
            f"led={self.lathe.chip.level('RC0')} tool={self.lathe.workpiece.tool.name}"
        )

    def run(self) -> None:
        """Run until the time is up or somebody ends it."""
        print(self._port_line(), flush=True)
        if self.arguments.panel:
            self.screen = Screen(self.lathe)
        by_hand = self.screen is not None and self.screen.single_keys
        wall_start, next_state = time.monotonic(), time.monotonic() + STATE_EVERY_S
        limit = self.arguments.seconds
        while not self.stopped and (limit is None or self.lathe.seconds < limit):
            self._let_time_pass()
            self._listen()
            if self.screen is not None:
                self.screen.draw(self.state_line())
            if time.monotonic() >= next_state and not by_hand:
                next_state += STATE_EVERY_S
                self.say(self.state_line())
            if self.arguments.real_time or by_hand:
                ahead = self.lathe.seconds - (time.monotonic() - wall_start)
                if ahead > 0:
                    time.sleep(ahead)

    def say(self, text: str) -> None:
        """Print a line, above the panel if there is one."""
        if self.screen is not None:
            self.screen.say(text)
        else:
            print(text, flush=True)

    def _port_line(self) -> str:
        if self.exporter is not None and self.arguments.usbip is not None:
            return f"usbip: {self.arguments.usbip[0]}:{self.exporter.port} {BUS_ID}"
        return f"port: {self.arguments.port_link or self.terminal.name}"

    def _let_time_pass(self) -> None:
        if self.exporter is not None:
            chip = self.lathe.chip
            self.exporter.run(chip.cycle + round(SLICE_S * CYCLES_PER_SECOND))
            return
        self._connect()
        self.lathe.run(SLICE_S)
        self.terminal.exchange()

    def _connect(self) -> None:
        host = self.lathe.host
        if host.port_open and not host.connected:
            host.port_open = False
            self.enumerate_wanted = True
        if not self.enumerate_wanted or not host.connected:
            return
        try:
            host.enumerate()
            host.open_port()
            self.enumerate_wanted = False
        except UsbError as error:
            self.say(f"usb: {error}")

    def _listen(self) -> None:
        if not self._stdin_open or not select.select([sys.stdin], [], [], 0)[0]:
            return
        chunk = os.read(sys.stdin.fileno(), 256)
        self._stdin_open = bool(chunk)
        if self.screen is not None and self.screen.single_keys:
            for name in actions(chunk):
                if name in KEYS:
                    self.hand.touch(name)
                else:
                    self._obey(name.split())
            return
        self._typed += chunk
        while b"\n" in self._typed:
            line, self._typed = self._typed.split(b"\n", 1)
            self._obey(line.decode(errors="replace").split())

    def _obey(self, words: list[str]) -> None:
        if words == ["quit"]:
            self.stopped = True
        elif words == ["state"]:
            self.say(self.state_line())
        elif words[:1] == ["key"] and 2 <= len(words) <= 3:
            self._press_key(words[1], words[2] if len(words) == 3 else "")
        elif words and words[-1] in ACTIONS:
            self.act(words[-1])
        elif len(words) == 2 and words[0] == "tool":
            self._change_tool(words[1])
        elif words:
            self.say(f"not understood: {' '.join(words)}")

    def _press_key(self, key: str, seconds: str) -> None:
        if not self.lathe.options.panel:
            self.say("no panel is fitted: --panel does it")
            return
        try:
            self.hand.press(key, float(seconds) if seconds else PRESS_S)
        except ValueError as error:
            self.say(str(error))

    def _change_tool(self, name: str) -> None:
        try:
            self.say(f"tool: {self.lathe.change_tool('' if name == 'next' else name)}")
        except ValueError as error:
            self.say(str(error))

    def finish(self) -> None:
        """Write report and picture and what must survive."""
        if self.screen is not None:
            self.screen.close()
        if self.arguments.panel_picture:
            self.lathe.panel.picture(self.arguments.panel_picture)
        self.lathe.chip.close_vcd()
        self.terminal.close()
        if self.exporter is not None:
            self.exporter.close()
        if self.arguments.report:
            text = json.dumps(self.lathe.report(), indent=1)
            self.arguments.report.write_text(text + "\n", encoding="utf-8")
        if self.arguments.eeprom_file:
            memory = self.lathe.chip.save()
            self.arguments.eeprom_file.write_bytes(memory.flash + memory.eeprom)


def main(argv: list[str] | None = None) -> int:
    """Run the command; returns the exit code."""
    arguments = build_parser().parse_args(argv)
    try:
        session = Session(arguments)
    except (RuntimeError, OSError, ValueError, KeyError) as error:
        print(f"virtual_lathe: {error}", file=sys.stderr)
        return 1
    signal.signal(signal.SIGINT, session.stop)
    signal.signal(signal.SIGTERM, session.stop)
    try:
        session.run()
    finally:
        session.finish()
    return 0
