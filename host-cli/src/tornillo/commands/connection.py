# SPDX-License-Identifier: Apache-2.0
"""What several verbs share: the connected lathe, JSON output, the machine for checking."""

import json
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager

import click

from tornillo.lathe import Lathe
from tornillo.machine import DEFAULT_MACHINE

machine_option = click.option(
    "--machine",
    default=DEFAULT_MACHINE,
    show_default=True,
    metavar="NAME",
    help="Machine to check against: a name that comes with tornillo, or a path to a TOML file.",
)
json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON for scripts.")


@contextmanager
def connected() -> Iterator[Lathe]:
    """The lathe at the port of the command line; Ctrl-C brings it to a controlled stand."""
    from tornillo.commands.interrupting import interrupted

    port = click.get_current_context().find_object(str)
    with Lathe.open(port, notify=tell) as lathe:
        try:
            yield lathe
        except KeyboardInterrupt:
            raise interrupted(lathe) from None


def tell(line: str) -> None:
    """Say why it takes longer."""
    click.echo(line, err=True)


def print_json(value: object) -> None:
    """Print `value` as JSON."""
    click.echo(json.dumps(value, indent=2))


def print_table(rows: Iterable[Mapping[str, object]]) -> None:
    """Print `rows`, which share their keys, as a table."""
    from rich.console import Console
    from rich.table import Table

    listed = list(rows)
    table = Table(*listed[0].keys(), box=None, header_style="bold", pad_edge=False)
    for row in listed:
        table.add_row(*(str(value) for value in row.values()))
    Console().print(table, highlight=False)
