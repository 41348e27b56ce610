# SPDX-License-Identifier: Apache-2.0
"""The verb completion, and what completes names that only the lathe knows."""

import click
from click.shell_completion import CompletionItem, get_completion_class

from tornillo.language import _

SHELLS = ("bash", "zsh", "fish")
VARIABLE = "_TORNILLO_COMPLETE"


@click.command()
@click.argument("shell", type=click.Choice(SHELLS))
def completion(shell: str) -> None:
    """Print the lines that complete verbs, options, files and names in SHELL.

    \b
    Examples: tornillo completion bash >> ~/.bashrc
              tornillo completion zsh >> ~/.zshrc
              tornillo completion fish > ~/.config/fish/completions/tornillo.fish
    """
    root = click.get_current_context().find_root().command
    found = get_completion_class(shell)
    assert found is not None
    click.echo(found(root, {}, "tornillo", VARIABLE).source())


def complete_parts(
    context: click.Context, _parameter: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """The names of the stored parts; none when the lathe cannot be asked now."""
    from tornillo.errors import TornilloError
    from tornillo.lathe import Lathe

    try:
        with Lathe.open(context.find_root().params.get("port")) as lathe:
            names = [part.name for part in lathe.parts()]
    except TornilloError:
        return []
    return [CompletionItem(name) for name in names if name.startswith(incomplete)]


def complete_settings(
    _context: click.Context, _parameter: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """The names of the settings, with their meaning."""
    from tornillo.protocol import SETTINGS

    return [
        CompletionItem(entry.id.name.lower(), help=_(entry.meaning))
        for entry in SETTINGS
        if entry.id.name.lower().startswith(incomplete.lower())
    ]


VERBS = (completion,)
