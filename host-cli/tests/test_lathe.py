# SPDX-License-Identifier: Apache-2.0
"""The library: what each method sends, and what it makes of the answers."""

from pathlib import Path

import pytest
from conftest import EXAMPLES
from scripted_chip import IDLE, ScriptedChip, ScriptedPort

from tornillo import Axis, Part, SettingId, Status
from tornillo.errors import ChipError, LinkError, TornilloError
from tornillo.frames import crc16
from tornillo.lathe import Lathe
from tornillo.machine import Machine
from tornillo.protocol import (
    SETTINGS,
    Alarm,
    Command,
    ErrorCode,
    Refusal,
    ResetCause,
    State,
    StatusFlag,
)


@pytest.fixture
def image(lathe: Lathe, test_bar: Path) -> bytes:
    """The image of the test bar."""
    return Part.load(test_bar).image(lathe.machine())


def test_an_upload_is_stored_byte_for_byte_and_reports_its_progress(
    lathe: Lathe, chip: ScriptedChip, image: bytes
) -> None:
    progress: list[tuple[int, int]] = []
    slot = lathe.upload(image, lambda sent, total: progress.append((sent, total)))
    assert chip.slots == {slot: image}
    assert progress == [(32, 91), (64, 91), (91, 91)]
    assert lathe.read(slot) == image


def test_an_upload_survives_a_line_that_loses_every_third_answer(
    lathe: Lathe, port: ScriptedPort, chip: ScriptedChip, image: bytes
) -> None:
    sent = 0

    def lose(*_progress: int) -> None:
        nonlocal sent
        sent += 1
        port.lose_answers = sent % 3

    slot = lathe.upload(image, lose)
    assert chip.slots[slot] == image
    assert chip.executed.count(Command.UPLOAD_DATA) == 3


def test_an_upload_that_the_chip_stored_differently_is_refused(
    lathe: Lathe, chip: ScriptedChip, image: bytes
) -> None:
    chip.wrong_crc = True
    with pytest.raises(LinkError, match="stored another part than was sent"):
        lathe.upload(image)


def test_an_image_damaged_on_purpose_is_refused_by_the_chip_with_its_reason(
    lathe: Lathe, chip: ScriptedChip, image: bytes
) -> None:
    damaged = bytearray(image)
    damaged[32 + 30 + 16] = 99
    with pytest.raises(ChipError) as caught:
        lathe.upload(bytes(damaged))
    assert caught.value.reason is Refusal.OPERATION_TYPE
    assert caught.value.operation == 1
    assert chip.slots == {}


def test_stored_parts_are_listed_found_selected_and_deleted(lathe: Lathe, image: bytes) -> None:
    first = lathe.upload(image)
    second = lathe.upload(image)
    lathe.select(second)
    parts = lathe.parts()
    assert [(part.slot, part.name, part.selected) for part in parts] == [
        (first, "test-bar", False),
        (second, "test-bar", True),
    ]
    assert (parts[0].length, parts[0].crc, parts[0].operations) == (91, crc16(image), 1)
    assert lathe.find("test-bar").slot == second
    assert lathe.find("0").slot == first
    lathe.delete(second)
    assert (parts[0].units, second) == (1, first + 1)
    assert lathe.part(second) is None
    with pytest.raises(TornilloError, match="no part called 'other'"):
        lathe.find("other")


def test_a_long_part_takes_several_units_side_by_side(lathe: Lathe, machine: Machine) -> None:
    rows = "".join(
        f"{{ z = {-0.1 * n}, diameter = {5 + 0.1 * n + 0.2 * (n % 2)} }}," for n in range(150)
    )
    text = Path(EXAMPLES / "test-bar.toml").read_text(encoding="utf-8").replace('"inch"', '"mm"')
    head = text[: text.index("[stock]")]
    long = (
        f"{head}[stock]\ndiameter = 25\nlength = 30\n[cut]\ndepth_of_cut = 1\nfeed = 99\n"
        f'retract = 1\n[[operation]]\ntype = "profile"\npoints = [{rows}]\n'
    )
    image = Part.parse(long).image(machine)
    first, second = lathe.upload(image), lathe.upload(image)
    assert [part.units for part in lathe.parts()] == [4, 4]
    assert (first, second) == (0, 4)
    assert lathe.image(second).pack() == image


def test_a_part_of_an_unknown_format_cannot_be_downloaded(lathe: Lathe, chip: ScriptedChip) -> None:
    chip.slots[4] = bytes(32) + b"\x63\0\x04\0"
    with pytest.raises(LinkError, match="the part in slot 4 cannot be understood"):
        lathe.image(4)


def test_the_machine_tells_its_spindle_speeds(lathe: Lathe) -> None:
    machine = lathe.machine()
    assert (machine.spindle_min_rpm, machine.spindle_max_rpm) == (100, 3800)


def test_reading_an_empty_slot_is_refused(lathe: Lathe) -> None:
    with pytest.raises(ChipError, match="no part in that slot"):
        lathe.read(3)


def test_reading_stops_when_the_chip_sends_nothing(
    lathe: Lathe, chip: ScriptedChip, image: bytes
) -> None:
    slot = lathe.upload(image)
    chip.refusals[Command.PART_READ] = b"\0"
    with pytest.raises(ChipError, match="PART_READ"):
        lathe.read(slot)


def test_status_has_names_instead_of_numbers(lathe: Lathe, chip: ScriptedChip) -> None:
    flags = StatusFlag.HOMED | StatusFlag.MOTION
    chip.status = IDLE._replace(
        state=State.RUNNING, flags=flags, slot=4, permille=500, reset_cause=ResetCause.WATCHDOG
    )
    status = lathe.status()
    assert (status.state, status.slot, status.homed) == (State.RUNNING, 4, True)
    assert status.flags == flags
    assert status.reset_cause is ResetCause.WATCHDOG
    assert (status.x, status.z, status.dead_x, status.dead_z) == (-1789, -8000, 23, 31)
    assert status.moving
    assert not status.finished


def test_a_finished_run_stands_still_at_thousand_permille() -> None:
    finished = Status.from_data(IDLE._replace(permille=1000))
    assert finished.finished
    assert not finished.moving
    assert not Status.from_data(IDLE).finished


@pytest.mark.parametrize("alarm", [alarm for alarm in Alarm if alarm is not Alarm.NONE])
def test_every_alarm_is_told_with_cause_and_remedy(alarm: Alarm) -> None:
    error = Status.from_data(IDLE._replace(alarm=alarm, alarm_detail=1)).alarm_error()
    assert alarm.name in str(error)
    assert error.remedy


def test_an_alarm_of_one_axis_names_it() -> None:
    data = IDLE._replace(alarm=Alarm.HOME_NOT_FOUND, alarm_detail=1)
    assert "alarm HOME_NOT_FOUND of Z: " in str(Status.from_data(data).alarm_error())


@pytest.mark.parametrize("change", [{"state": 77}, {"alarm": 77}, {"reset_cause": 0}])
def test_a_status_that_this_version_does_not_know_is_refused(
    lathe: Lathe, chip: ScriptedChip, change: dict[str, int]
) -> None:
    chip.status = IDLE._replace(**change)
    with pytest.raises(LinkError, match="unknown to this tornillo"):
        lathe.status()


def test_part_zero_is_set_from_where_the_tool_stands(lathe: Lathe, chip: ScriptedChip) -> None:
    lathe.zero(Axis.X, 1786)
    lathe.zero(Axis.Z, -10)
    assert chip.zeroed == [(0, 1786), (1, -10)]
    machine = lathe.machine()
    assert (machine.zero_x, machine.zero_z) == (-1789 - 1786, -7990)


def test_settings_are_read_and_changed(lathe: Lathe) -> None:
    lathe.set_setting(SettingId.RAPID_RATE_X, 900)
    assert lathe.setting(SettingId.RAPID_RATE_X).value == 900
    found = {entry.id: data for entry, data in lathe.settings()}
    assert len(found) == len(SettingId)
    entry = SETTINGS[SettingId.ZERO_Z]
    assert found[entry.id] == (entry.default, entry.minimum, entry.maximum)


def test_a_number_that_does_not_fit_its_field_is_refused_before_it_is_sent(
    lathe: Lathe, port: ScriptedPort
) -> None:
    sent = len(port.requests)
    with pytest.raises(ChipError) as caught:
        lathe.zero(Axis.X, 2**40)
    assert caught.value.code is ErrorCode.OUT_OF_RANGE
    assert len(port.requests) == sent


def test_the_verbs_of_motion_change_the_state(
    lathe: Lathe, chip: ScriptedChip, image: bytes
) -> None:
    lathe.home()
    assert lathe.status().state is State.HOMING
    lathe.stop()
    lathe.run(lathe.upload(image), step=True)
    assert chip.step
    assert lathe.status().state is State.RUNNING
    lathe.hold()
    assert lathe.status().state is State.HOLD
    lathe.resume()
    lathe.override(130)
    lathe.stop()
    assert lathe.status().state is State.IDLE
    lathe.reset()


def test_an_override_lasts_until_the_next_run(
    lathe: Lathe, chip: ScriptedChip, image: bytes
) -> None:
    slot = lathe.upload(image)
    lathe.run(slot)
    lathe.override(130)
    assert chip.feed_percent == 130
    lathe.stop()
    lathe.run(slot)
    assert chip.feed_percent == 100


@pytest.mark.parametrize("percent", [9, 201])
def test_an_override_outside_its_range_is_not_sent(
    lathe: Lathe, chip: ScriptedChip, percent: int
) -> None:
    with pytest.raises(TornilloError, match=f"a feed of {percent} % is not possible"):
        lathe.override(percent)
    assert Command.OVERRIDE not in chip.executed


@pytest.mark.parametrize("number", ["LATHE-07", "~!x_(8)#"])
def test_a_serial_number_is_changed_and_told_at_once(
    lathe: Lathe, chip: ScriptedChip, number: str
) -> None:
    lathe.set_serial_number(number)
    assert lathe.serial_number == number
    assert chip.serial == number.encode()


@pytest.mark.parametrize(
    "number", ["", "1234567", "123456789", "1234 678", "1234,678", "M\xfcller78"]
)
def test_a_serial_number_that_hosts_refuse_is_not_sent(
    lathe: Lathe, chip: ScriptedChip, number: str
) -> None:
    with pytest.raises(TornilloError, match="cannot be a serial number"):
        lathe.set_serial_number(number)
    assert Command.SERIAL_SET not in chip.executed


def test_a_serial_number_that_the_chip_does_not_keep_is_told(
    lathe: Lathe, chip: ScriptedChip
) -> None:
    chip.refusals[Command.SERIAL_SET] = b"\0"
    with pytest.raises(LinkError, match="has kept T0000001 as its serial number, not LATHE-07"):
        lathe.set_serial_number("LATHE-07")


def test_a_transport_without_close_can_be_used(port: ScriptedPort) -> None:
    class Wire:
        timeout: float | None = None

        def read(self, size: int = 1, /) -> bytes:
            return port.read(size)

        def write(self, data: bytes, /) -> int | None:
            return port.write(data)

    with Lathe(Wire()) as lathe:
        assert lathe.status().homed
