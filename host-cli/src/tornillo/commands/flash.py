# SPDX-License-Identifier: Apache-2.0
"""The verb flash: gives the chip another firmware over USB, through its boot loader."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager

import click

from tornillo.chips import find_chip
from tornillo.commands.connection import json_option, print_json, tell
from tornillo.errors import TornilloError
from tornillo.firmware_file import FIRST, Firmware
from tornillo.flashing import Stage, Update
from tornillo.language import _
from tornillo.protocol import PROTOCOL_VERSION
from tornillo.updating import Progress


@click.command()
@click.argument("file", type=click.Path(dir_okay=False))
@click.option("--check", "check_only", is_flag=True, help="Only check FILE and say what it is.")
@json_option
def flash(file: str, check_only: bool, as_json: bool) -> None:
    """Write the firmware in FILE into the chip over USB, compare it, and start it.

    FILE is the Intel hex file that `make firmware` leaves. It is checked whole before anything is
    changed. The lathe must be at rest; parts and settings stay. Interrupted by Ctrl-C, a pulled
    cable or a power cut, the chip waits in its boot loader, and the same command goes on.

    \b
    Examples: tornillo flash build/firmware/tornillo.hex
              tornillo flash build/firmware/tornillo.hex --check
              tornillo flash build/firmware/tornillo.hex --json
    """
    firmware = Firmware.load(file)
    if check_only:
        _describe(firmware, as_json)
        return
    chip = find_chip(click.get_current_context().find_object(str))
    update = Update(firmware, chip, tell)
    with _explaining(update), _bar(firmware) as progress:
        update.run(progress)
    assert update.after is not None
    if as_json:
        print_json(_facts(firmware) | {"before": update.before, "port": update.port})
    else:
        click.echo(
            _("firmware was {before}, is {after}: {size} bytes written and compared").format(
                before=update.before or _("not whole"),
                after=update.after.firmware,
                size=firmware.size,
            )
        )
    if update.after.protocol != PROTOCOL_VERSION:
        tell(
            _(
                "Note: it speaks protocol {theirs}, this tornillo {ours}: install the tornillo of "
                "the same release"
            ).format(theirs=update.after.protocol, ours=PROTOCOL_VERSION)
        )


def _facts(firmware: Firmware) -> dict[str, object]:
    """What a file is, for scripts."""
    header = firmware.header
    return {
        "file": firmware.name,
        "firmware": header.version,
        "protocol": header.protocol,
        "board": header.board,
        "bytes": firmware.size,
        "crc": f"{header.crc:04x}",
        "boot_loader": firmware.has_loader,
        "configuration": firmware.has_configuration,
    }


def _describe(firmware: Firmware, as_json: bool) -> None:
    """Say what a file is."""
    if as_json:
        print_json(_facts(firmware))
        return
    header = firmware.header
    click.echo(
        _(
            "{name}: Tornillo firmware {version}, protocol {protocol}, for board {board}: {size} "
            "bytes from 0x{first:04X} to 0x{last:04X}, whole"
        ).format(
            name=firmware.name,
            version=header.version,
            protocol=header.protocol,
            board=header.board,
            size=firmware.size,
            first=FIRST,
            last=header.end - 1,
        )
    )
    if firmware.has_loader and firmware.has_configuration:
        click.echo(_("with boot loader and configuration: a programmer can burn it too"))
    else:
        click.echo(_("without boot loader or configuration: for `tornillo flash` alone"))


@contextmanager
def _bar(firmware: Firmware) -> Iterator[Progress]:
    """A bar that only moves forward; what is written a second time does not move it."""
    label = _("Writing firmware {version}").format(version=firmware.header.version)
    with click.progressbar(length=2 * len(firmware.image), label=label, file=sys.stderr) as bar:
        furthest = 0

        def advance(done: int, _total: int) -> None:
            nonlocal furthest
            if done > furthest:
                bar.update(done - furthest)
                furthest = done

        yield advance


@contextmanager
def _explaining(update: Update) -> Iterator[None]:
    """Whatever ends the update, tell what became of the chip."""
    again = _("type `tornillo flash {file}` again; it goes on").format(file=update.firmware.name)
    try:
        yield
    except TornilloError:
        if update.stage is Stage.IN_LOADER:
            tell(_("The chip waits in its boot loader until an update has come to its end."))
        raise
    except KeyboardInterrupt:
        if update.stage is Stage.UNTOUCHED:
            raise TornilloError(
                _("interrupted before anything was changed"), _("the lathe is as it was")
            ) from None
        if update.stage is Stage.WRITTEN:
            raise TornilloError(
                _("interrupted; the new firmware is written, compared and started"),
                _("see `tornillo doctor`"),
            ) from None
        raise TornilloError(
            _("interrupted; the chip stays in its boot loader and cannot cut"), again
        ) from None


VERBS = (flash,)
