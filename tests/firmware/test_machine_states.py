# SPDX-License-Identifier: Apache-2.0
"""The table of states and events in firmware/lathe/machine.h, cell by cell."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import branch, on_a_new_chip
from tornillo.link import Link
from tornillo.protocol import Alarm, Axis, Command, ErrorCode, State
from virtual_lathe.chip import Drive
from virtual_lathe.machine import AxisName

Outcome = tuple[ErrorCode, State, Alarm]
OK, BUSY, NOT_HOMED, IN_ALARM, NOT_RUNNING = (
    ErrorCode.OK,
    ErrorCode.BUSY,
    ErrorCode.NOT_HOMED,
    ErrorCode.ALARM,
    ErrorCode.NOT_RUNNING,
)
IDLE, HOMING, RUNNING, HOLD, ALARM, PAUSE, MOVING, TOUCHING = State
NONE = Alarm.NONE
#: Slower than the start rate: brakes from one step to the next.
SLOW = 200

# event -> what it does in the state; "button" events have no error code, so OK.
TABLE: dict[str, dict[str, Outcome]] = {
    "idle": {
        "button run": (OK, RUNNING, NONE),
        "button hold": (OK, IDLE, NONE),
        "button stop": (OK, IDLE, NONE),
        "home": (OK, HOMING, NONE),
        "run": (OK, RUNNING, NONE),
        "hold": (NOT_RUNNING, IDLE, NONE),
        "resume": (NOT_RUNNING, IDLE, NONE),
        "stop": (OK, IDLE, NONE),
        "reset": (OK, IDLE, NONE),
        "jog": (OK, MOVING, NONE),
        "goto": (OK, MOVING, NONE),
        "touch": (OK, TOUCHING, NONE),
        "estop": (OK, ALARM, Alarm.ESTOP),
        "limit": (OK, ALARM, Alarm.LIMIT),
    },
    "not homed": {
        "button run": (OK, HOMING, NONE),
        "button hold": (OK, IDLE, NONE),
        "button stop": (OK, IDLE, NONE),
        "home": (OK, HOMING, NONE),
        "run": (NOT_HOMED, IDLE, NONE),
        "hold": (NOT_RUNNING, IDLE, NONE),
        "resume": (NOT_RUNNING, IDLE, NONE),
        "stop": (OK, IDLE, NONE),
        "reset": (OK, IDLE, NONE),
        "jog": (OK, MOVING, NONE),
        "goto": (NOT_HOMED, IDLE, NONE),
        "touch": (NOT_HOMED, IDLE, NONE),
        "estop": (OK, ALARM, Alarm.ESTOP),
        "limit": (OK, IDLE, NONE),
    },
    "homing": {
        "button run": (OK, HOMING, NONE),
        "button hold": (OK, HOMING, NONE),
        "button stop": (OK, ALARM, Alarm.STOPPED_HOMING),
        "home": (BUSY, HOMING, NONE),
        "run": (BUSY, HOMING, NONE),
        "hold": (NOT_RUNNING, HOMING, NONE),
        "resume": (NOT_RUNNING, HOMING, NONE),
        "stop": (OK, ALARM, Alarm.STOPPED_HOMING),
        "reset": (OK, HOMING, NONE),
        "jog": (BUSY, HOMING, NONE),
        "goto": (BUSY, HOMING, NONE),
        "touch": (BUSY, HOMING, NONE),
        "estop": (OK, ALARM, Alarm.ESTOP),
    },
    "running": {
        "button run": (OK, RUNNING, NONE),
        "button hold": (OK, HOLD, NONE),
        "button stop": (OK, IDLE, NONE),
        "home": (BUSY, RUNNING, NONE),
        "run": (BUSY, RUNNING, NONE),
        "hold": (OK, HOLD, NONE),
        "resume": (OK, RUNNING, NONE),
        "stop": (OK, IDLE, NONE),
        "reset": (OK, RUNNING, NONE),
        "jog": (BUSY, RUNNING, NONE),
        "goto": (BUSY, RUNNING, NONE),
        "touch": (BUSY, RUNNING, NONE),
        "estop": (OK, ALARM, Alarm.ESTOP),
        "limit": (OK, ALARM, Alarm.LIMIT),
    },
    "hold": {
        "button run": (OK, RUNNING, NONE),
        "button hold": (OK, HOLD, NONE),
        "button stop": (OK, IDLE, NONE),
        "home": (BUSY, HOLD, NONE),
        "run": (BUSY, HOLD, NONE),
        "hold": (OK, HOLD, NONE),
        "resume": (OK, RUNNING, NONE),
        "stop": (OK, IDLE, NONE),
        "reset": (OK, HOLD, NONE),
        "jog": (BUSY, HOLD, NONE),
        "goto": (BUSY, HOLD, NONE),
        "touch": (BUSY, HOLD, NONE),
        "estop": (OK, ALARM, Alarm.ESTOP),
        "limit": (OK, ALARM, Alarm.LIMIT),
    },
    "pause": {
        "button run": (OK, RUNNING, NONE),
        "button hold": (OK, PAUSE, NONE),
        "button stop": (OK, IDLE, NONE),
        "home": (BUSY, PAUSE, NONE),
        "run": (BUSY, PAUSE, NONE),
        "hold": (NOT_RUNNING, PAUSE, NONE),
        "resume": (OK, RUNNING, NONE),
        "stop": (OK, IDLE, NONE),
        "reset": (OK, PAUSE, NONE),
        "jog": (BUSY, PAUSE, NONE),
        "goto": (BUSY, PAUSE, NONE),
        "touch": (BUSY, PAUSE, NONE),
        "estop": (OK, ALARM, Alarm.ESTOP),
        "limit": (OK, ALARM, Alarm.LIMIT),
    },
    "moving": {
        "button run": (OK, MOVING, NONE),
        "button hold": (OK, IDLE, NONE),
        "button stop": (OK, IDLE, NONE),
        "home": (BUSY, MOVING, NONE),
        "run": (BUSY, MOVING, NONE),
        "hold": (OK, IDLE, NONE),
        "resume": (NOT_RUNNING, MOVING, NONE),
        "stop": (OK, IDLE, NONE),
        "reset": (OK, MOVING, NONE),
        "jog": (BUSY, MOVING, NONE),
        "goto": (BUSY, MOVING, NONE),
        "touch": (BUSY, MOVING, NONE),
        "estop": (OK, ALARM, Alarm.ESTOP),
        "limit": (OK, ALARM, Alarm.LIMIT),
    },
    "touching": {
        "button run": (OK, TOUCHING, NONE),
        "button hold": (OK, TOUCHING, NONE),
        "button stop": (OK, IDLE, NONE),
        "home": (BUSY, TOUCHING, NONE),
        "run": (BUSY, TOUCHING, NONE),
        "hold": (NOT_RUNNING, TOUCHING, NONE),
        "resume": (NOT_RUNNING, TOUCHING, NONE),
        "stop": (OK, IDLE, NONE),
        "reset": (OK, TOUCHING, NONE),
        "jog": (BUSY, TOUCHING, NONE),
        "goto": (BUSY, TOUCHING, NONE),
        "touch": (BUSY, TOUCHING, NONE),
        "estop": (OK, ALARM, Alarm.ESTOP),
        "limit": (OK, ALARM, Alarm.LIMIT),
    },
    "alarm": {
        "button run": (OK, ALARM, Alarm.LIMIT),
        "button hold": (OK, ALARM, Alarm.LIMIT),
        "button stop": (OK, IDLE, NONE),
        "home": (IN_ALARM, ALARM, Alarm.LIMIT),
        "run": (IN_ALARM, ALARM, Alarm.LIMIT),
        "hold": (NOT_RUNNING, ALARM, Alarm.LIMIT),
        "resume": (NOT_RUNNING, ALARM, Alarm.LIMIT),
        "stop": (OK, ALARM, Alarm.LIMIT),
        "reset": (OK, IDLE, NONE),
        "jog": (IN_ALARM, ALARM, Alarm.LIMIT),
        "goto": (IN_ALARM, ALARM, Alarm.LIMIT),
        "touch": (IN_ALARM, ALARM, Alarm.LIMIT),
        "estop": (OK, ALARM, Alarm.ESTOP),
        "limit": (OK, ALARM, Alarm.LIMIT),
    },
}


def lathe_in(state: str) -> Bench:
    """Bring a lathe into a row of the table."""
    bench = little_pin.lathe_with_pin(start_x=-250 if state == "homing" else -30, probe=True)
    bench.set(probe_fitted=1)
    if state == "not homed":
        return bench
    if state == "homing":
        bench.host.home()
        bench.run(0.05)
        return bench
    bench.home()
    if state == "moving":
        bench.host.jog(Axis.X, -60, SLOW)
    if state == "touching":
        bench.host.touch(Axis.X, -80)
    if state == "pause":
        bench.host.upload(little_pin.image("pausing", (little_pin.pause(), *little_pin.OPERATIONS)))
        bench.host.run()
        bench.wait_for(PAUSE)
    if state in ("running", "hold"):
        bench.host.run()
        bench.run(0.2)
    if state == "hold":
        bench.host.hold()
    if state == "alarm":
        trip_limit(bench)
    return bench


def trip_limit(bench: Bench) -> None:
    """Break the wire of the X switch, which reads as pressed."""
    bench.lathe.machine.break_switch_wire(AxisName.X)
    bench.run(0.02)


def happen(bench: Bench, event: str) -> ErrorCode:
    """Let an event happen and return the answer to it."""
    kind, _, button = event.partition(" ")
    if kind == "button":
        bench.press(button)
    elif kind == "estop":
        bench.chip.drive("RD7", Drive.OPEN)
        bench.run(0.02)
    elif kind == "limit":
        trip_limit(bench)
    else:
        commands: dict[str, Callable[[], None]] = {
            "home": bench.host.home,
            "run": bench.host.run,
            "hold": bench.host.hold,
            "resume": bench.host.resume,
            "stop": bench.host.stop,
            "reset": bench.host.reset,
            "jog": lambda: bench.host.jog(Axis.X, -60, SLOW),
            "goto": lambda: bench.host.goto(x=-80, rate=SLOW),
            "touch": lambda: bench.host.touch(Axis.X, -80),
        }
        return bench.refusal(commands[kind])
    return OK


@pytest.mark.parametrize("state", TABLE)
@on_a_new_chip
def test_every_event_does_what_the_table_says(state: str) -> None:
    bench = lathe_in(state)

    def outcome(event: str) -> Outcome:
        answer = happen(bench, event)
        bench.run(0.01)
        assert bench.homed == (bench.alarm[0] is NONE and bench.state is not HOMING and homed)
        return answer, bench.state, bench.alarm[0]

    homed = bench.homed
    found = {event: branch(partial(outcome, event)) for event in TABLE[state]}
    assert found == TABLE[state]


@on_a_new_chip
def test_homing_ends_idle_and_homed_and_a_finished_part_ends_idle() -> None:
    bench = little_pin.homed_lathe_with_pin()
    assert (bench.state, bench.homed) == (IDLE, True)
    bench.host.run()
    bench.wait_for(IDLE)
    assert bench.status().finished
    assert bench.homed


@on_a_new_chip
def test_running_without_a_part_is_refused() -> None:
    bench = Bench()
    bench.home()
    assert bench.refusal(bench.host.run) is ErrorCode.NO_PART
    assert bench.refusal(lambda: bench.host.run(3)) is ErrorCode.NO_PART
    assert bench.refusal(lambda: bench.host.run(200)) is ErrorCode.NO_PART
    assert bench.state is IDLE


@on_a_new_chip
def test_a_part_that_has_changed_in_flash_is_not_cut() -> None:
    bench = little_pin.homed_lathe_with_pin()
    memory = bench.chip.save()
    flash = bytearray(memory.flash)
    flash[flash.index(little_pin.image()) + 30] ^= 4
    bench.chip.restore(type(memory)(bytes(flash), memory.eeprom))
    assert bench.refusal(bench.host.run) is ErrorCode.CRC_MISMATCH
    assert bench.state is IDLE


@on_a_new_chip
def test_a_part_that_no_longer_fits_the_settings_is_not_cut() -> None:
    bench = little_pin.homed_lathe_with_pin()
    bench.set(zero_x=-(little_pin.RADIUS + 4))
    assert bench.refusal(bench.host.run) is ErrorCode.INVALID_PART
    assert bench.state is IDLE


@on_a_new_chip
def test_nothing_is_stored_while_the_machine_moves() -> None:
    bench = little_pin.homed_lathe_with_pin()
    host = bench.host
    host.run()
    bench.run(0.1)
    before = bench.chip.nonvolatile_counts
    link = Link(bench.lathe.port)
    image = little_pin.image("other")
    attempts: list[Callable[[], object]] = [
        lambda: host.upload(image),
        lambda: link.request(Command.UPLOAD_COMMIT),
        lambda: host.delete(0),
        lambda: host.select(0),
        lambda: bench.set(rapid_rate_x=500),
        lambda: host.zero(Axis.X, 0),
    ]
    assert [bench.refusal(attempt) for attempt in attempts] == [BUSY] * len(attempts)
    host.hold()
    assert [bench.refusal(attempt) for attempt in attempts] == [BUSY] * len(attempts)
    assert bench.chip.nonvolatile_counts == before
