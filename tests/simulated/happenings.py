# SPDX-License-Identifier: Apache-2.0
"""Lets each row of firmware/lathe/states.toml happen to a lathe."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from tornillo.errors import ChipError
from tornillo.image import pack_segments
from tornillo.protocol import LOADER_MAGIC, Command, ErrorCode, HomedAxis, SettingId, State
from virtual_lathe.chip import NonVolatile, Reset
from virtual_lathe.machine import AxisName

from simulated.bench import START_S
from simulated.situations import IDLE_MS, OTHER, PATIENCE_MS, ROUNDING, Walker

#: Values of every command that has some.
VALUES: dict[Command, tuple[int, ...]] = {
    Command.HOME: (HomedAxis.X | HomedAxis.Z,),
    Command.RUN: (0xFF, 0),
    Command.ZERO: (0, 77),
    Command.OVERRIDE: (50,),
    Command.UPLOAD_BEGIN: (len(OTHER), 0),
    Command.PART_INFO: (0,),
    Command.PART_READ: (0, 0),
    Command.SETTING_GET: (SettingId.HOME_RATE,),
    Command.SETTING_SET: (SettingId.HOME_RATE, 500),
    Command.LOADER: (LOADER_MAGIC,),
}
#: What a move by hand takes beside its place: rate and patience, rate, nothing.
AFTER_THE_PLACE = {Command.JOG: (0, PATIENCE_MS), Command.GOTO: (0,), Command.TOUCH: ()}
SERIAL = b"WALKED-1"
RECORDS = (0x00, 0x70)
ESTOP = 0x04  # of inputs_state
#: A while in which the idle time does not pass.
WHILE_S = 0.1
#: States that end by themselves.
UNDER_WAY = (State.HOMING, State.RUNNING, State.MOVING, State.TOUCHING)
#: A way by hand, steps.
NEAR_BY = 100
CENTRE_OFF = 2  # steps
#: Machine code of RETURN, and the longest that the queue lasts at the speeds of the walk.
RETURN = b"\x12\x00"
QUEUE_S, SLOW_QUEUE_S = 0.5, 2.8
HEARD_S = 0.2
#: A bit more than the patience of a JOG, and than DEADMAN_MS of firmware/config.h.
SILENCE_S = 0.6


def _command(command: Command, walker: Walker) -> None:
    """Send a command with its values."""
    if command is Command.UPLOAD_COMMIT:
        answer_of(partial(_command, Command.UPLOAD_DATA), walker)
    if command in (Command.PART_SELECT, Command.PART_DELETE):
        walker.send(command, walker.other)
    elif command in (Command.JOG, Command.GOTO, Command.TOUCH):
        x, z = walker.bench.position
        walker.send(command, x - NEAR_BY, z, *AFTER_THE_PLACE[command])
    elif command is Command.SERIAL_SET:
        walker.send(command, SERIAL)
    elif command is Command.UPLOAD_DATA:
        walker.link.request(command, walker.last_piece)
    else:
        walker.send(command, *VALUES.get(command, ()))


def _button(name: str, walker: Walker) -> None:
    walker.bench.press(name)
    if name == "run":
        walker.bench.run(0.05)  # it acts when it is let go, and the part is checked first


def _limit(axis: AxisName, walker: Walker) -> None:
    """Break the wire of a switch, which reads as closed."""
    walker.bench.lathe.machine.break_switch_wire(axis)
    walker.bench.run(0.02)


def _estop(button: str, walker: Walker) -> None:
    walker.bench.expect_broken("no step lost", "coil pattern legal")
    if button == "estop" or walker.bench.chip.variable("inputs_state") & ESTOP:
        walker.bench.lathe.press(button)
    walker.bench.run(0.02)


def _cable(walker: Walker) -> None:
    walker.bench.unplug()


def _heard(walker: Walker, seconds: float) -> None:
    """Let time pass while the host asks for the status now and then."""
    end = walker.bench.chip.seconds + seconds
    while walker.bench.chip.seconds < end:
        walker.send(Command.STATUS)
        walker.bench.run(min(WHILE_S, end - walker.bench.chip.seconds))


def _silence(walker: Walker) -> None:
    walker.bench.run(SILENCE_S)


def _probe(walker: Walker) -> None:
    """Connect tool and work."""
    walker.bench.lathe.machine.short_probe()
    walker.bench.run(0.02)


def _done(walker: Walker) -> None:
    """Wait for the end, past what the part asks for."""
    bench = walker.bench
    if bench.state not in UNDER_WAY:
        bench.run(WHILE_S)
        return
    _asked(walker)
    if bench.is_in(State.PAUSE):
        walker.send(Command.RESUME)
        _asked(walker)


def _asked(walker: Walker) -> None:
    """Wait until the part asks for something."""
    bench = walker.bench
    if bench.state in UNDER_WAY:
        begun = bench.state
        while bench.is_in(begun):
            _heard(walker, WHILE_S)
    else:
        bench.run(WHILE_S)


def _part_asks(walker: Walker) -> None:
    if walker.bench.is_in(State.RUNNING):
        _asked(walker)
    else:
        walker.bench.run(WHILE_S)


def _blocked(walker: Walker) -> None:
    """The motors get no power; homing goes on until its way is used up."""
    bench = walker.bench
    bench.expect_broken("no step lost", "coil pattern legal")
    bench.lathe.machine.set_motor_power(False)
    if bench.is_in(State.HOMING):
        bench.wait(lambda: not bench.is_in(State.HOMING), 20.0)
    bench.run(WHILE_S)


def _dry(walker: Walker) -> None:
    """Keep the main loop from planning for longer than the queue lasts."""
    chip = walker.bench.chip
    memory = chip.save()
    at = chip.symbols.code("make")
    absent = memory.flash[:at] + RETURN + memory.flash[at + len(RETURN) :]
    chip.restore(NonVolatile(absent, memory.eeprom))
    end = chip.seconds + (SLOW_QUEUE_S if walker.bench.is_in(State.TOUCHING) else QUEUE_S)
    while chip.seconds < end:
        walker.bench.run(HEARD_S)
        walker.bench.status()  # jogs and touches go on only while a host is heard
    chip.restore(memory)
    walker.bench.run(0.01)


def _bad_arc(walker: Walker) -> None:
    """Move the centre of the rounding in flash by some steps, for a while."""
    bench = walker.bench
    memory = bench.chip.save()
    centre = pack_segments((ROUNDING,))[-6:]
    wrong = pack_segments((ROUNDING._replace(cz=ROUNDING.cz + CENTRE_OFF * 256),))[-6:]
    assert memory.flash.count(centre) == 1
    bench.chip.restore(NonVolatile(memory.flash.replace(centre, wrong), memory.eeprom))
    if bench.is_in(State.RUNNING):
        bench.wait(lambda: not bench.is_in(State.RUNNING), 20.0)
    bench.run(0.02)
    bench.chip.restore(NonVolatile(memory.flash, bench.chip.save().eeprom))


def _idle_time(walker: Walker) -> None:
    _heard(walker, (IDLE_MS + 50) / 1000)


def _restart(walker: Walker) -> None:
    bench = walker.bench
    bench.expect_broken("coil pattern legal", "at most one full step at a time", "no step lost")
    bench.unplug()
    bench.chip.reset(Reset.BROWN_OUT)
    bench.run(START_S)


def _restart_damaged(walker: Walker) -> None:
    memory = walker.bench.chip.save()
    eeprom = bytearray(memory.eeprom)
    for record in RECORDS:
        eeprom[record + 5] ^= 0x10
    walker.bench.chip.restore(NonVolatile(memory.flash, bytes(eeprom)))
    _restart(walker)


HAPPENINGS: dict[str, Callable[[Walker], None]] = {
    **{command.name.lower(): partial(_command, command) for command in Command},
    **{f"button_{name}": partial(_button, name) for name in ("run", "hold", "stop")},
    "limit_x": partial(_limit, AxisName.X),
    "limit_z": partial(_limit, AxisName.Z),
    "estop_pressed": partial(_estop, "estop"),
    "estop_released": partial(_estop, "release"),
    "probe": _probe,
    "cable": _cable,
    "silence": _silence,
    "done": _done,
    "asked": _part_asks,
    "blocked": _blocked,
    "dry": _dry,
    "bad_arc": _bad_arc,
    "idle_time": _idle_time,
    "restart": _restart,
    "restart_damaged": _restart_damaged,
}


def answer_of(happening: Callable[[Walker], None], walker: Walker) -> ErrorCode:
    """Let something happen; the error it was refused with, else OK."""
    try:
        happening(walker)
    except ChipError as error:
        return error.code
    return ErrorCode.OK
