# SPDX-License-Identifier: Apache-2.0
"""The help of commands in the user's language, paragraph by paragraph.

Help stands where click wants it, in docstrings and options; here it is taken apart into the
messages of the catalogue and put together again. Examples are typed the same in every language.
"""

from collections.abc import Iterator
from inspect import cleandoc

import click

from tornillo.language import _, later

VERBATIM = "\b"
LABELS = (later("Examples:"), later("Example:"))

#: Help as it was written, by command: its text, and those of its options.
_written: dict[click.Command, tuple[str, list[str | None]]] = {}


def translate(command: click.Command) -> click.Command:
    """Put the help of `command` and its subcommands into the user's language."""
    text, options = _written.setdefault(
        command, (cleandoc(command.help or ""), [_help(parameter) for parameter in command.params])
    )
    command.help = "\n\n".join(_said(paragraph) for paragraph in text.split("\n\n"))
    for parameter, written in zip(command.params, options, strict=True):
        if isinstance(parameter, click.Option) and written:
            parameter.help = _(written)
    if type(command) is click.Group:
        for inner in command.commands.values():
            translate(inner)
    return command


def messages(command: click.Command) -> Iterator[str]:
    """Every message that `translate` asks the catalogue for."""
    text, options = _written.get(
        command, (cleandoc(command.help or ""), [_help(parameter) for parameter in command.params])
    )
    for paragraph in text.split("\n\n"):
        if not paragraph.startswith(VERBATIM):
            yield " ".join(paragraph.split())
    yield from (written for written in options if written)
    if type(command) is click.Group:
        for inner in command.commands.values():
            yield from messages(inner)


def _help(parameter: click.Parameter) -> str | None:
    """The help of an option; arguments have none."""
    return parameter.help if isinstance(parameter, click.Option) else None


def _said(paragraph: str) -> str:
    """A paragraph in the user's language; of examples only their label."""
    if not paragraph.startswith(VERBATIM):
        return _(" ".join(paragraph.split()))
    for label in LABELS:
        paragraph = paragraph.replace(label, _(label), 1)
    return paragraph
