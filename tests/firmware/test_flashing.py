# SPDX-License-Identifier: Apache-2.0
"""The host's update and the chip's boot loader together, in simulated time."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
import tornillo.flashing
import tornillo.link
import tornillo.loader
from simulated.bench import Bench
from simulated.processes import on_a_new_chip
from tornillo.chips import Chip, Kind
from tornillo.errors import LinkError, LoaderError, PortError, TornilloError
from tornillo.firmware_file import BLOCK, Firmware
from tornillo.flashing import Stage, Update
from tornillo.updating import Progress
from virtual_lathe.chip import NonVolatile
from virtual_lathe.serial_port import SerialPort
from virtual_lathe.usb_host import UsbError

from firmware.loader_bench import BEGIN
from firmware.usb_bench import FIRMWARE


class Port(SerialPort):
    """Stays open on the bus, where a port is opened once for every time the device comes up."""

    def close(self) -> None:
        """Forget what has come."""
        self.reset_input_buffer()


class Desk:
    """A lathe and a computer that updates it; all waiting is simulated.

    ``seen`` names the devices that have come up at the port.
    """

    def __init__(self) -> None:
        """Switch the lathe on and put the cable in."""
        self.bench = Bench()
        self.bench.connect()
        host = self.bench.lathe.host
        clock = SimpleNamespace(monotonic=lambda: self.bench.chip.seconds, sleep=host.wait)
        for module in (tornillo.flashing, tornillo.link, tornillo.loader):
            vars(module)["time"] = clock
        vars(tornillo.flashing)["open_port"] = self._open
        vars(tornillo.flashing)["ports_of"] = lambda *_: ("virtual",)
        vars(tornillo.flashing)["beside"] = lambda *_: frozenset()
        self._restarts = len(self.bench.chip.resets)
        self.seen: list[str] = []

    def _open(self, _port: str, _notify: object = None) -> SerialPort:
        """Open the port of whatever is at the other end of the cable."""
        host, restarts = self.bench.lathe.host, len(self.bench.chip.resets)
        try:
            if restarts != self._restarts or not host.connected:
                host.enumerate()
                self.seen.append(host.description.strings[2])
                self._restarts = restarts
                host.open_port()
        except UsbError as error:
            raise PortError(str(error), "plug it in") from error
        return Port(host)

    def update(self, progress: Progress | None = None, kind: Kind = Kind.UNKNOWN) -> Update:
        """Update to the firmware that was built; raises what the update raises."""
        update = Update(Firmware.load(str(FIRMWARE)), Chip("virtual", kind, "", ""))
        update.run(progress)
        return update


@on_a_new_chip
def test_the_running_firmware_is_replaced_and_nothing_else_changes() -> None:
    desk = Desk()
    before = desk.bench.chip.save()
    desk.bench.expect_broken("no step lost")
    update = desk.update()
    assert update.stage is Stage.WRITTEN
    assert desk.seen == ["Tornillo loader", "Tornillo lathe"]
    assert update.before == update.firmware.header.version
    assert desk.bench.chip.save() == before
    assert not desk.bench.lathe.host.mistakes


@pytest.mark.parametrize("block", [0, 50, -1])
@on_a_new_chip
def test_after_a_cable_pulled_at_any_block_the_same_command_goes_on(block: int) -> None:
    desk = Desk()
    blocks = len(Firmware.load(str(FIRMWARE)).image) // BLOCK
    pull_at = (block % blocks + 1) * BLOCK
    lathe = desk.bench.lathe

    def pull(done: int, _total: int) -> None:
        if done == pull_at and lathe.host.connected:
            lathe.unplug()

    with pytest.raises((LinkError, LoaderError, PortError)) as told:
        desk.update(pull)
    assert isinstance(told.value, TornilloError)
    assert told.value.remedy
    lathe.plug()
    desk.update()
    assert desk.seen[-1] == "Tornillo lathe"


@on_a_new_chip
def test_a_chip_with_a_damaged_program_waits_in_the_loader_and_is_mended() -> None:
    desk = Desk()
    chip = desk.bench.chip
    memory = chip.save()
    flash = bytearray(memory.flash)
    flash[BEGIN + 5000] ^= 4
    desk.bench.unplug()
    chip.restore(NonVolatile(bytes(flash), memory.eeprom))
    desk.bench.power_cycle()
    desk.bench.lathe.host.plug()
    update = desk.update(kind=Kind.LOADER)
    assert desk.seen == ["Tornillo loader", "Tornillo lathe"]
    assert update.before is None
    assert chip.save().flash == memory.flash


@on_a_new_chip
def test_a_lathe_that_homes_refuses_to_be_updated() -> None:
    desk = Desk()
    desk.bench.host.home()
    with pytest.raises(TornilloError, match="at work"):
        desk.update()
    desk.bench.wait(lambda: desk.bench.moving, 0.5)


def test_the_file_that_is_built_is_a_firmware_with_loader_and_configuration() -> None:
    firmware = Firmware.load(str(FIRMWARE))
    assert firmware.has_loader
    assert firmware.has_configuration
    assert Path(firmware.name).name == "tornillo.hex"
