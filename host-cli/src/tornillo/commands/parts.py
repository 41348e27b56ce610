# SPDX-License-Identifier: Apache-2.0
"""Verbs about parts: check, upload, parts, select, delete."""

import dataclasses
import sys

import click

from tornillo.commands.connection import (
    connected,
    json_option,
    machine_option,
    print_json,
    print_table,
)
from tornillo.errors import ChipError, PartError, TornilloError
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol_texts import REFUSAL_TEXTS

file_argument = click.argument("file", type=click.Path(dir_okay=False))
part_argument = click.argument("part")


@click.command()
@file_argument
@machine_option
def check(file: str, machine: str) -> None:
    """Say whether FILE can be made, and what is wrong with it.

    \b
    Example: tornillo check examples/test-bar.toml
    """
    part = Part.load(file)
    known = Machine.load(machine)
    problems = list(part.problems(known))
    for problem in problems[:-1]:
        click.secho(f"Error: {problem}", fg="red", err=True)
        click.echo(f"Try: {problem.remedy}", err=True)
    if problems:
        raise problems[-1]
    size = len(part.image(known))
    count = len(part.operations)
    noun = "operation" if count == 1 else "operations"
    click.echo(f"{part.name}: {count} {noun}, {size} bytes, fits {known.name}")


@click.command()
@file_argument
def upload(file: str) -> None:
    """Check FILE, store it in the lathe and verify what was stored.

    \b
    Example: tornillo upload examples/test-bar.toml
    """
    part = Part.load(file)
    with connected() as lathe:
        image = part.image(lathe.machine())
        label = f"Uploading {part.name}"
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
    click.echo(f"{part.name} is stored in slot {slot}, {len(image)} bytes, verified")


def _with_the_line(part: Part, error: ChipError) -> TornilloError:
    """The chip's refusal of a part, with the line of the operation it names."""
    if error.reason is None or error.operation > len(part.operations):
        return error
    what = f"{part.describe(error.operation)}: " if error.operation else ""
    place = ("operation", error.operation - 1) if error.operation else ("part",)
    cause = REFUSAL_TEXTS[error.reason].cause
    refusal: PartError = part.source.error(
        place, f"{what}the chip refuses the part: {cause}", error.remedy
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
        print_json([dataclasses.asdict(part) for part in stored])
    elif not stored:
        click.echo(f"no parts stored, {slots} slots free")
    else:
        print_table(
            {
                "slot": part.slot,
                "part": part.name,
                "operations": part.operations,
                "bytes": part.length,
                "": "selected" if part.selected else "",
            }
            for part in stored
        )


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
    click.echo(f"{found.name} is selected: the RUN button cuts it")


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
    click.echo(f"{found.name} is deleted, slot {found.slot} is free")


VERBS = (check, upload, list_parts, select, delete)
