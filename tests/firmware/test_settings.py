# SPDX-License-Identifier: Apache-2.0
"""Settings: defaults, ranges, and what a cut of power or a worn EEPROM leaves of them."""

from __future__ import annotations

from functools import partial

from simulated.bench import Bench
from simulated.processes import branch, on_a_new_chip
from tornillo.frames import crc16
from tornillo.link import Link
from tornillo.machine_file import file_text, load_file, read_file
from tornillo.protocol import SETTINGS, Alarm, Axis, Command, ErrorCode, SettingId, State
from tornillo.settings import store_all
from virtual_lathe.chip import NonVolatile

FIRST, SECOND = 0x00, 0x50
FORMAT = 2
#: An EEPROM write takes 4 ms.
CUT_EVERY_S = 1.7e-3
RECORD_BYTES = 2 + 2 * len(SETTINGS) + 2


def values(bench: Bench) -> dict[SettingId, int]:
    """Every setting as the chip tells it."""
    return {setting.id: data.value for setting, data in bench.host.settings()}


def defaults(**changed: int) -> dict[SettingId, int]:
    """Every setting as a new chip has it, but for the ones given by name."""
    normal = {setting.id: setting.default for setting in SETTINGS}
    return normal | {SettingId[name.upper()]: value for name, value in changed.items()}


def damage(bench: Bench, *addresses: int) -> None:
    """Flip a bit in each of some EEPROM bytes."""
    memory = bench.chip.save()
    eeprom = bytearray(memory.eeprom)
    for address in addresses:
        eeprom[address] ^= 0x10
    bench.chip.restore(NonVolatile(memory.flash, bytes(eeprom)))


def number_the_record(bench: Bench, sequence: int) -> None:
    """Give the first record another sequence number, with the CRC that belongs to it."""
    memory = bench.chip.save()
    record = bytes([sequence]) + memory.eeprom[FIRST + 2 : FIRST + RECORD_BYTES - 2]
    record += crc16(record).to_bytes(2, "little")
    eeprom = bytes([FORMAT]) + record + memory.eeprom[RECORD_BYTES:]
    bench.chip.restore(NonVolatile(memory.flash, eeprom))


@on_a_new_chip
def test_a_blank_chip_has_the_defaults_and_no_alarm() -> None:
    bench = Bench()
    assert values(bench) == defaults()
    assert bench.is_in(State.IDLE)
    assert bench.chip.nonvolatile_counts["eeprom_writes"] == 0


@on_a_new_chip
def test_the_chip_tells_the_ranges_of_the_protocol() -> None:
    bench = Bench()
    told = {s.id: (data.minimum, data.maximum) for s, data in bench.host.settings()}
    assert told == {setting.id: (setting.minimum, setting.maximum) for setting in SETTINGS}


@on_a_new_chip
def test_every_setting_takes_its_ends_and_nothing_beyond_them() -> None:
    bench = Bench()
    for setting in SETTINGS:
        for value in (setting.minimum, setting.maximum):
            bench.host.set_setting(setting.id, value)
            assert bench.host.setting(setting.id).value == value
        beyond = (setting.minimum - 1, setting.maximum + 1, 0x7FFFFFFF, -0x80000000, 0x10000)
        for value in beyond:
            change = partial(bench.host.set_setting, setting.id, value)
            assert bench.refusal(change) is ErrorCode.OUT_OF_RANGE
            assert bench.host.setting(setting.id).value == setting.maximum
        bench.host.set_setting(setting.id, setting.default)


@on_a_new_chip
def test_settings_that_do_not_exist_are_refused() -> None:
    bench = Bench()
    bench.lathe.plug()
    link = Link(bench.lathe.port)
    link.request(Command.HELLO)
    for number in (len(SETTINGS), 255):
        get = partial(link.request, Command.SETTING_GET, bytes([number]))
        change = partial(link.request, Command.SETTING_SET, bytes([number, 0, 0, 0, 0]))
        assert bench.refusal(get) is ErrorCode.OUT_OF_RANGE
        assert bench.refusal(change) is ErrorCode.OUT_OF_RANGE


@on_a_new_chip
def test_settings_stay_over_power_cycles_and_many_changes() -> None:
    bench = Bench()
    for round_number in range(4):
        bench.set(home_rate=500 + round_number, zero_z=-7000 - round_number)
        bench.power_cycle(round_number)
        assert values(bench) == defaults(home_rate=500 + round_number, zero_z=-7000 - round_number)


@on_a_new_chip
def test_a_saved_machine_file_brings_every_setting_back() -> None:
    bench = Bench()
    changed = {setting.id: setting.minimum for setting in SETTINGS}
    changes = store_all(bench.host, changed, lambda _change: None)
    assert len(changes) == sum(setting.minimum != setting.default for setting in SETTINGS)
    assert values(bench) == changed
    text = file_text(values(bench), "changed", "test")
    store_all(bench.host, load_file("otmt-co"), lambda _change: None)
    assert values(bench) == defaults()
    store_all(bench.host, read_file(text, "changed"), lambda _change: None)
    bench.power_cycle()
    assert values(bench) == changed


@on_a_new_chip
def test_the_newer_record_counts_also_when_the_sequence_wraps() -> None:
    bench = Bench()
    bench.set(home_rate=500)
    number_the_record(bench, 254)
    bench.power_cycle()
    for rate in (501, 502, 503, 504):
        bench.set(home_rate=rate)
        bench.power_cycle()
        assert values(bench) == defaults(home_rate=rate)


@on_a_new_chip
def test_a_damaged_record_leaves_the_one_before_it() -> None:
    bench = Bench()
    bench.set(home_rate=600)
    bench.set(home_rate=700)
    eeprom = bench.chip.save().eeprom
    newest = FIRST if (eeprom[FIRST + 1] - eeprom[SECOND + 1]) & 0xFF == 1 else SECOND

    def start_with_damage(offset: int) -> None:
        damage(bench, newest + offset)
        bench.power_cycle()
        assert values(bench) == defaults(home_rate=600)
        assert bench.is_in(State.IDLE)

    for offset in (0, 1, 2, 13, RECORD_BYTES - 2, RECORD_BYTES - 1):
        branch(partial(start_with_damage, offset))


@on_a_new_chip
def test_two_damaged_records_give_defaults_and_an_alarm_until_acknowledged() -> None:
    bench = Bench()
    bench.set(home_rate=600)
    bench.set(home_rate=700)
    damage(bench, FIRST + 5, SECOND + 5)
    bench.power_cycle()
    assert values(bench) == defaults()
    assert bench.alarm == (Alarm.SETTINGS_LOST, 0)
    assert bench.refusal(bench.host.home) is ErrorCode.ALARM
    bench.power_cycle()
    bench.run(0.1)
    assert bench.alarm == (Alarm.SETTINGS_LOST, 0)
    bench.host.reset()
    bench.power_cycle()
    assert values(bench) == defaults()
    assert bench.is_in(State.IDLE)


@on_a_new_chip
def test_a_cut_of_power_during_a_save_leaves_the_old_settings_or_the_new() -> None:
    bench = Bench()
    bench.set(home_rate=600)
    bench.set(zero_x=-1111)
    bench.set(zero_z=-2222)
    before = defaults(home_rate=600, zero_x=-1111, zero_z=-2222)
    after = before | {SettingId.ZERO_X: -3333}

    def length_of_the_save() -> float:
        begun = bench.chip.seconds
        bench.set(zero_x=-3333)
        return bench.chip.seconds - begun

    def cut(seconds: float) -> dict[SettingId, int]:
        bench.lathe.at(bench.chip.seconds + seconds, stop)
        try:
            bench.set(zero_x=-3333)
            bench.run(seconds)
        except Stopped:
            bench.power_cycle(round(seconds * 1e6))
        bench.run(0.1)
        assert bench.is_in(State.IDLE)
        return values(bench)

    steps = range(1, round(branch(length_of_the_save) / CUT_EVERY_S) + 4)
    found = [branch(partial(cut, step * CUT_EVERY_S)) for step in steps]
    switch = found.index(after)
    assert found == [before] * switch + [after] * (len(found) - switch)
    assert switch > 5


class Stopped(Exception):
    """Ends what the host library is doing."""


def stop() -> None:
    """Leave the library in mid-request."""
    raise Stopped


@on_a_new_chip
def test_zero_tells_where_the_tool_stands_and_is_stored() -> None:
    bench = Bench()
    assert bench.refusal(lambda: bench.host.zero(Axis.X, 0)) is ErrorCode.NOT_HOMED
    bench.home()
    bench.host.zero(Axis.X, 1000)
    bench.host.zero(Axis.Z, 2000)
    bench.power_cycle()
    found = values(bench)
    assert (found[SettingId.ZERO_X], found[SettingId.ZERO_Z]) == (-1020, -2020)


@on_a_new_chip
def test_a_zero_outside_its_range_is_refused() -> None:
    bench = Bench()
    bench.home()
    before = values(bench)
    for axis, steps in ((Axis.X, -1000), (Axis.Z, 32001), (Axis.Z, -32001), (Axis.X, 40000)):
        change = partial(bench.host.zero, axis, steps)
        assert bench.refusal(change) is ErrorCode.OUT_OF_RANGE
    assert values(bench) == before
