# SPDX-License-Identifier: Apache-2.0
"""The lathe as a Python object.

    with Lathe.open() as lathe:
        part = Part.load("test-bar.toml")
        lathe.home()
        slot = lathe.upload(part.image(lathe.machine()))
        lathe.run(slot)
        print(lathe.watch(lambda status: status.finished).wait())

Every method may raise ChipError (the chip says no) or LinkError (it does not answer; told
after tornillo.link.REQUEST_S = 1.5 seconds). All methods may be called from several threads,
also while a watch runs. docs/library.md shows how it is used.
"""

import struct
from types import TracebackType
from typing import Any

from tornillo import loader, versions
from tornillo.errors import ChipError, InLoaderError, LinkError, NoAnswerError, TornilloError
from tornillo.language import _
from tornillo.link import Link, Transport
from tornillo.machine import Machine
from tornillo.opening import Notify, open_port
from tornillo.ports import find_port
from tornillo.protocol import (
    FRAME_TIMEOUT_MS,
    OVERRIDE_MAX,
    OVERRIDE_MIN,
    REQUESTS,
    RESPONSES,
    SERIAL_LENGTH,
    SETTINGS,
    SLOT_NONE,
    Axis,
    Command,
    ErrorCode,
    HelloData,
    HomedAxis,
    ProgressData,
    RunFlag,
    Setting,
    SettingGetData,
    SettingId,
    StatusData,
)
from tornillo.status import Status
from tornillo.store import PartStore
from tornillo.stored import StoredPart
from tornillo.watching import StatusCallback, Watch

#: Longer than a request that was lost and is repeated takes.
JOG_PATIENCE_MS = 2 * FRAME_TIMEOUT_MS
#: How often a watch asks, in seconds.
WATCH_EVERY_S = 0.2


class Lathe(PartStore):
    """A connected lathe. Leaving the `with` block closes the port; a running part goes on.

    `hello` is what the chip told about itself when it was last asked.
    """

    def __init__(self, transport: Transport, timeout_s: float = FRAME_TIMEOUT_MS / 1000) -> None:
        """Talk over `transport`, an open serial port or anything with its read and write.

        `timeout_s`: seconds to wait for an answer before the request is repeated. Raises
        NoAnswerError when nothing answers, VersionError when the firmware speaks another
        version of the protocol.
        """
        self._link = Link(transport, timeout_s)
        self._watches: list[Watch] = []
        self.hello = self._greet()

    @classmethod
    def open(cls, port: str | None = None, notify: Notify | None = None) -> "Lathe":
        """Open the lathe at `port`, or the one that is plugged in.

        `port`: the name of a port (/dev/ttyACM0, COM3) or the serial number of a lathe. `notify`
        is told in words when it takes longer, up to 5 s, because the port is held for a moment.

        Raises PortError when there is no such port, several lathes to choose from, or it cannot
        be opened; InLoaderError when the chip waits in its boot loader; NoAnswerError and
        VersionError as `Lathe()`. All say what to do.
        """
        name = find_port(port or None)
        serial = open_port(name, notify)
        try:
            return cls(serial)
        except NoAnswerError as error:
            waits = loader.answers(serial)
            serial.close()
            if waits:
                raise InLoaderError(name) from error
            raise versions.no_hello(name, error) from error
        except LinkError:
            serial.close()
            raise

    def close(self) -> None:
        """End all watches and close the port; what is being cut goes on."""
        for watch in self._watches:
            watch.stop()
        self._link.close()

    def __enter__(self) -> "Lathe":
        """Return the lathe itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the port."""
        self.close()

    @property
    def firmware(self) -> str:
        """The firmware's version, like 0.1.0."""
        hello = self.hello
        return f"{hello.firmware_major}.{hello.firmware_minor}.{hello.firmware_patch}"

    @property
    def serial_number(self) -> str:
        """The chip's serial number."""
        return self.hello.serial.rstrip(b"\0 ").decode("ascii", "replace")

    def machine(self) -> Machine:
        """The machine as the chip describes it now."""
        self.hello = self._greet()
        slowest = self.setting(SettingId.SPINDLE_MIN).value
        fastest = self.setting(SettingId.SPINDLE_MAX).value
        return Machine.from_hello(self.hello, slowest, fastest)

    def status(self) -> Status:
        """Where the tool is and what the machine does."""
        return Status.from_data(StatusData(*self._numbers(Command.STATUS)))

    def watch(self, callback: StatusCallback, every: float = WATCH_EVERY_S) -> Watch:
        """Call `callback(status)` now and then `every` seconds, from a thread of its own.

        Other methods go on working meanwhile, in any thread. It ends when the callback returns
        something true or raises, when the link fails, by `stop()`, at the end of the `with` block
        or with the lathe. `wait()` waits for that and raises the error, if it was one:

            lathe.watch(lambda status: not status.moving).wait()
        """
        watch = Watch(self.status, callback, every)
        self._watches = [*(old for old in self._watches if old.active), watch]
        return watch

    def home(self, axes: HomedAxis = HomedAxis.X | HomedAxis.Z) -> None:
        """Start to look for the limit switches, X first; `status()` tells the end."""
        self._request(Command.HOME, axes)

    def run(self, slot: int | None = None, step: bool = False, resume: bool = False) -> None:
        """Start to cut the part in `slot`, or the selected one; `status()` tells the rest.

        `step`: pause after each operation. `resume`: go on with the part of `progress()`, from
        the pass that was completed last; that pass is cut once more.

        Raises ChipError (NOTHING_TO_RESUME) when no part, or another one, was begun and not
        finished.
        """
        if resume:
            begun = self.progress()
            if begun is None or slot not in (None, begun.slot):
                raise ChipError(Command.RUN, ErrorCode.NOTHING_TO_RESUME)
        flags = RunFlag.STEP * step | RunFlag.RESUME * resume
        self._request(Command.RUN, SLOT_NONE if slot is None else slot, flags)

    def progress(self) -> ProgressData | None:
        """The part that was begun and not finished, and its pass completed last.

        The chip knows it without power too. None: there is nothing to resume.
        """
        found = ProgressData(*self._numbers(Command.PROGRESS))
        return None if found.slot == SLOT_NONE else found

    def hold(self) -> None:
        """Stop the run so that it can go on."""
        self._request(Command.HOLD)

    def resume(self) -> None:
        """Go on after a hold or a pause."""
        self._request(Command.RESUME)

    def stop(self) -> None:
        """End the run or the homing."""
        self._request(Command.STOP)

    def reset(self) -> None:
        """Acknowledge an alarm."""
        self._request(Command.RESET)

    def override(self, percent: int) -> None:
        """Cut at `percent` of the programmed feed, 10..200, from now to the end of this run.

        Rapids keep their speed. Raises TornilloError when `percent` lies outside the range,
        ChipError (NOT_RUNNING) when no part is being cut.
        """
        if not OVERRIDE_MIN <= percent <= OVERRIDE_MAX:
            raise TornilloError(
                _("a feed of {percent} % is not possible").format(percent=percent),
                _("choose {override_min} to {override_max} percent of the programmed feed").format(
                    override_min=OVERRIDE_MIN, override_max=OVERRIDE_MAX
                ),
            )
        self._request(Command.OVERRIDE, percent)

    def jog(
        self, axis: Axis, steps: int, rate: int = 0, patience_ms: int = JOG_PATIENCE_MS
    ) -> None:
        """Start to move `axis` by `steps`, at `rate` step/s or, for 0, at its rapid speed.

        Works also when not homed: then without soft limits, at most at the setting home_rate, and
        only away from a limit switch that is pressed (ChipError WRONG_WAY). When homed, a place
        outside the travel is refused. The slide brakes and stops when the chip hears nothing for
        `patience_ms`, 0 for ever: ask for the status, or use `touching.still()`. `hold()` brakes
        it at once.
        """
        place = self._beside(axis, self.status().position(axis) + steps)
        self._move(Command.JOG, place, rate, patience_ms)

    def goto(self, x: int | None = None, z: int | None = None, rate: int = 0) -> None:
        """Start to move to machine steps `x`, `z` (None: where it is) at `rate` step/s, 0 rapid.

        X goes first when it moves away from the spindle's axis, else Z. ChipError NOT_HOMED when
        the position is not known, OUT_OF_RANGE for a place outside the travel.
        """
        now = self.status()
        place = (now.x if x is None else x, now.z if z is None else z)
        self._move(Command.GOTO, place, rate)

    def touch(self, axis: Axis, end: int) -> None:
        """Start to move `axis` slowly towards machine step `end` until the contact sensor closes.

        One search; `tornillo.touching.touch()` repeats it and judges what it finds.
        """
        self._move(Command.TOUCH, self._beside(axis, end))

    def _beside(self, axis: Axis, position: int) -> tuple[int, int]:
        """The place at `position` of one axis, and of the other one where it is."""
        now = self.status()
        return (position, now.z) if axis is Axis.X else (now.x, position)

    def _move(self, command: Command, place: tuple[int, int], *rate: int) -> None:
        """Send a place; raises ChipError for one that the chip cannot count to."""
        if not all(-0x8000 <= value <= 0x7FFF for value in place):
            raise ChipError(command, ErrorCode.OUT_OF_RANGE)
        self._request(command, *place, *rate)

    def zero(self, axis: Axis, steps: int) -> None:
        """Say that the tool now stands at part coordinate `steps` (X: radius) of `axis`."""
        self._request(Command.ZERO, axis, steps)

    def outdated_parts(self) -> list[StoredPart]:
        """Stored parts made for other step sizes than the settings have: they cannot be cut."""
        steps = tuple(
            self.setting(setting).value for setting in (SettingId.STEP_X_NM, SettingId.STEP_Z_NM)
        )
        headers = ((part, self.image(part.slot).header) for part in self.parts())
        return [part for part, made in headers if (made.step_x_nm, made.step_z_nm) != steps]

    def setting(self, setting: SettingId) -> SettingGetData:
        """Value and range of a setting."""
        return SettingGetData(*self._numbers(Command.SETTING_GET, setting))

    def settings(self) -> list[tuple[Setting, SettingGetData]]:
        """Every setting that host and chip know, with its value and range."""
        return [(entry, self.setting(entry.id)) for entry in SETTINGS]

    def set_setting(self, setting: SettingId, value: int) -> None:
        """Change a setting and store it."""
        self._request(Command.SETTING_SET, setting, value)

    def set_serial_number(self, serial: str) -> None:
        """Give the chip another serial number: 8 characters from ! to ~ without a comma.

        `serial_number` is the new one at once; USB shows it from the next connection on. Raises
        TornilloError for other characters, ChipError (BUSY) while the lathe moves.
        """
        fits = all("!" <= character <= "~" and character != "," for character in serial)
        if len(serial) != SERIAL_LENGTH or not fits:
            raise TornilloError(
                _('"{serial}" cannot be a serial number').format(serial=serial),
                _(
                    "choose {serial_length} letters, digits or signs, without spaces and "
                    "commas, like TN-00042"
                ).format(serial_length=SERIAL_LENGTH),
            )
        self._request(Command.SERIAL_SET, serial.encode("ascii"))
        self.hello = self._greet()
        if self.serial_number != serial:
            raise LinkError(
                _("the chip has kept {serial_number} as its serial number, not {serial}").format(
                    serial_number=self.serial_number, serial=serial
                ),
                _("try again; if it stays, the chip's memory is worn out"),
            )

    def _greet(self) -> HelloData:
        """Start the sequence anew and check the protocol version."""
        try:
            data = self._link.request(Command.HELLO)
        except ChipError as error:
            raise versions.refused_hello(error.code.name) from error
        versions.check(data)
        return HelloData(*self._unpack(Command.HELLO, data))

    def _request(self, command: Command, *values: int | bytes, data: bytes = b"") -> bytes:
        """Send a request made of `values` and `data`."""
        try:
            payload = REQUESTS[command].pack(*values) + data
        except struct.error as error:
            raise ChipError(command, ErrorCode.OUT_OF_RANGE) from error
        try:
            return self._link.request(command, payload)
        except ChipError as error:
            if error.code is not ErrorCode.UNKNOWN_COMMAND:
                raise
            note = versions.unknown_command_note(self.firmware)
            raise ChipError(command, error.code, note=note) from error

    def _numbers(self, command: Command, *values: int) -> tuple[Any, ...]:
        """Send a request and take its response apart."""
        return self._unpack(command, self._request(command, *values))

    def _unpack(self, command: Command, data: bytes) -> tuple[Any, ...]:
        """Take response data apart; raises LinkError for a wrong length."""
        try:
            return RESPONSES[command].unpack(data)
        except struct.error as error:
            raise LinkError(
                _("the answer to {command} has {data} bytes, not {size}").format(
                    command=command.name, data=len(data), size=RESPONSES[command].size
                ),
                _("use the tornillo version that belongs to this firmware"),
            ) from error
