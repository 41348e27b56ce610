# SPDX-License-Identifier: Apache-2.0
"""Verbs about parts: check, upload, download, parts, select, delete."""

import dataclasses
import sys
from pathlib import Path

import click

from tornillo.commands.completion import complete_parts
from tornillo.commands.connection import (
    connected,
    json_option,
    machine_option,
    print_json,
    print_table,
)
from tornillo.commands.progress import busy
from tornillo.errors import ChipError, PartError, TornilloError
from tornillo.language import _, plural
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.part_writer import part_text
from tornillo.protocol import PART_IMAGE_MAX
from tornillo.protocol_texts import REFUSAL_TEXTS
from tornillo.stored import units_of
from tornillo.toml_lines import Place

file_argument = click.argument("file", type=click.Path(dir_okay=False))
part_argument = click.argument("part", shell_complete=complete_parts)


@click.command()
@file_argument
@json_option
@machine_option
def check(file: str, as_json: bool, machine: str) -> None:
    """Say whether FILE can be made, and what is wrong with it.

    \b
    Examples: tornillo check examples/test-bar.toml
              tornillo check examples/test-bar.toml --json
    """
    part = Part.load(file)
    known = Machine.load(machine)
    with busy(_("checking")):
        problems = list(part.problems(known))
    if as_json:
        _print_verdict(part, known, problems)
        return
    for problem in problems[:-1]:
        click.secho(_("Error: {problem}").format(problem=problem), fg="red", err=True)
        click.echo(_("Try: {remedy}").format(remedy=problem.remedy), err=True)
    if problems:
        raise problems[-1]
    size = len(part.image(known))
    count = len(part.operations)
    noun = plural("{count} operation", "{count} operations", count).format(count=count)
    click.echo(
        _("{part}: {noun}, {size} bytes, fits {known}").format(
            part=part.name, noun=noun, size=size, known=known.name
        )
    )
    for note in part.notes(known):
        click.echo(_("Note: {note}").format(note=note))


def _print_verdict(part: Part, known: Machine, problems: list[PartError]) -> None:
    """What `check` found, for scripts; exits with 1 when there are problems."""
    print_json(
        {
            "name": part.name,
            "machine": known.name,
            "operations": len(part.operations),
            "bytes": None if problems else len(part.image(known)),
            "problems": [
                {"message": str(problem), "remedy": problem.remedy} for problem in problems
            ],
            "notes": [] if problems else list(part.notes(known)),
        }
    )
    if problems:
        sys.exit(1)


@click.command()
@file_argument
@json_option
def upload(file: str, as_json: bool) -> None:
    """Check FILE, store it in the lathe and verify what was stored.

    Interrupted by Ctrl-C or a pulled cable, nothing is stored, and what was there stays.

    \b
    Examples: tornillo upload examples/test-bar.toml
              tornillo upload examples/test-bar.toml --json
    """
    part = Part.load(file)
    with connected() as lathe:
        with busy(_("checking")):
            image = part.image(lathe.machine())
        label = _("Uploading {part}").format(part=part.name)
        with click.progressbar(length=len(image), label=label, file=sys.stderr) as bar:
            done = 0

            def advance(sent: int, _total: int) -> None:
                nonlocal done
                bar.update(sent - done)
                done = sent

            try:
                slot = lathe.upload(image, advance)
            except ChipError as error:
                raise _with_the_line(part, error) from error
    if as_json:
        print_json({"name": part.name, "slot": slot, "bytes": len(image), "verified": True})
        return
    click.echo(
        _("{part} is stored in slot {slot}, {image} bytes, verified").format(
            part=part.name, slot=slot, image=len(image)
        )
    )


def _with_the_line(part: Part, error: ChipError) -> TornilloError:
    """The chip's refusal of a part, with the line of the operation it names."""
    if error.reason is None or error.operation > len(part.operations):
        return error
    place: Place = ("part",)
    what = ""
    if error.operation:
        place = ("operation", part.ordered[error.operation - 1].position)
        what = f"{part.describe(error.operation)}: "
    cause = _(REFUSAL_TEXTS[error.reason].cause)
    refusal: PartError = part.source.error(
        place,
        _("{what}the chip refuses the part: {cause}").format(what=what, cause=cause),
        error.remedy,
    )
    return refusal


@click.command("parts")
@json_option
def list_parts(as_json: bool) -> None:
    """List the parts stored in the lathe.

    \b
    Example: tornillo parts --json
    """
    with connected() as lathe:
        stored = lathe.parts()
        slots = lathe.hello.slots
    if as_json:
        print_json([{**dataclasses.asdict(part), "units": part.units} for part in stored])
    elif not stored:
        click.echo(
            _("no parts stored, all {slots} units of the store are free").format(slots=slots)
        )
    else:
        print_table(
            {
                _("slot"): part.slot,
                _("part"): part.name,
                _("operations"): part.operations,
                _("bytes"): part.length,
                _("units"): part.units,
                "": _("selected") if part.selected else "",
            }
            for part in stored
        )
        free = slots - sum(part.units for part in stored)
        most = units_of(PART_IMAGE_MAX)
        click.echo(
            _("{free} of {slots} units of the store are free; a part takes 1 to {most}").format(
                free=free, slots=slots, most=most
            )
        )


@click.command()
@part_argument
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, writable=True),
    metavar="FILE.toml",
    help="Part file to write; printed when left out.",
)
def download(part: str, output: str | None) -> None:
    """Read PART (name or slot) back from the lathe as a part file.

    It holds the path of the tool's tip and gives the same image when it is uploaded again.

    \b
    Example: tornillo download test-bar -o test-bar.toml
    """
    with connected() as lathe:
        found = lathe.find(part)
        text = part_text(lathe.image(found.slot), lathe.machine())
    if output is None:
        click.echo(text, nl=False)
        return
    try:
        Path(output).write_text(text, encoding="utf-8")
    except OSError as error:
        raise PartError(
            _("{output}: the file cannot be written: {strerror}").format(
                output=output, strerror=error.strerror
            ),
            _("choose another place"),
        ) from error
    click.echo(_("{found} is written to {output}").format(found=found.name, output=output))


@click.command()
@part_argument
def select(part: str) -> None:
    """Choose PART (name or slot) as the one that the RUN button cuts.

    \b
    Example: tornillo select test-bar
    """
    with connected() as lathe:
        found = lathe.find(part)
        lathe.select(found.slot)
    click.echo(_("{found} is selected: the RUN button cuts it").format(found=found.name))


@click.command()
@part_argument
def delete(part: str) -> None:
    """Delete PART (name or slot) from the lathe.

    \b
    Example: tornillo delete test-bar
    """
    with connected() as lathe:
        found = lathe.find(part)
        lathe.delete(found.slot)
    count = found.units
    freed = plural("{count} unit is free again", "{count} units are free again", count)
    click.echo(
        _("{found} is deleted, {text}").format(found=found.name, text=freed.format(count=count))
    )


VERBS = (check, upload, download, list_parts, select, delete)
