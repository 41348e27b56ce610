# SPDX-License-Identifier: Apache-2.0
"""The command `tornillo`: a thin layer over the library.

Exit codes: 0 fine, 1 the input or the machine said no (message on stderr), 2 wrong usage.
"""

import os
import sys
from importlib import import_module
from typing import Any, NoReturn

import click

from tornillo import __version__
from tornillo.help_texts import translate
from tornillo.language import _, chosen, use
from tornillo.verbs import SECTIONS, VERBS


class LateGroup(click.Group):
    """A group whose verbs are imported when they are used, listed by section.

    A TornilloError is shown with its remedy; the exit code is 1 then.
    """

    def list_commands(self, _context: click.Context) -> list[str]:
        """The names of all verbs."""
        return list(VERBS)

    def get_command(self, _context: click.Context, name: str) -> click.Command | None:
        """Import a verb; None when there is no such verb."""
        if name not in VERBS:
            return None
        module = import_module(f"tornillo.commands.{VERBS[name].module}")
        return translate(next(verb for verb in module.VERBS if verb.name == name))

    def make_context(self, *arguments: Any, **options: Any) -> click.Context:
        """Begin a command line, in the user's language."""
        use(chosen())
        translate(self)
        return super().make_context(*arguments, **options)

    def resolve_command(
        self, context: click.Context, arguments: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the verb; wrong usage for one that does not exist, naming the nearest."""
        if arguments[0] not in VERBS and not arguments[0].startswith("-"):
            from difflib import get_close_matches

            close = get_close_matches(arguments[0], VERBS, n=1)
            remedy = (
                _('did you mean "{close}"?').format(close=close[0])
                if close
                else _("see `tornillo --help`")
            )
            context.fail(
                _('there is no verb "{arguments}"; {remedy}').format(
                    arguments=arguments[0], remedy=remedy
                )
            )
        return super().resolve_command(context, arguments)

    def format_commands(self, _context: click.Context, formatter: click.HelpFormatter) -> None:
        """List the verbs by section."""
        for section, verbs in SECTIONS.items():
            with formatter.section(_(section)):
                formatter.write_dl([(name, _(verb.summary)) for name, verb in verbs.items()])

    def shell_complete(self, context: click.Context, incomplete: str) -> list[Any]:
        """Complete a verb without importing any; options as usual."""
        from click.shell_completion import CompletionItem

        verbs = [
            CompletionItem(name, help=_(verb.summary))
            for name, verb in VERBS.items()
            if name.startswith(incomplete)
        ]
        return verbs + click.Command.shell_complete(self, context, incomplete)

    def invoke(self, context: click.Context) -> object:
        """Run the chosen verb."""
        try:
            return super().invoke(context)
        except KeyboardInterrupt:
            _fail("interrupted", _("`tornillo status` says what the lathe is doing"))
        except Exception as error:
            from tornillo.errors import TornilloError

            if isinstance(error, OSError) and error.filename is not None:
                _fail(f"{error.filename}: {error.strerror}", _("check name, place and rights"))
            if not isinstance(error, TornilloError):
                raise
            _fail(str(error), error.remedy)


def _fail(message: str, remedy: str) -> NoReturn:
    """Say what happened and what to do, and end with 1."""
    click.secho(_("Error: {message}").format(message=message), fg="red", err=True)
    click.echo(_("Try: {remedy}").format(remedy=remedy), err=True)
    sys.exit(1)


@click.group(cls=LateGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="tornillo")
@click.option(
    "--port",
    envvar="TORNILLO_PORT",
    metavar="NAME",
    help="Port of the lathe, like /dev/ttyACM0 or COM3, or its serial number; found by its USB id "
    "when left out.",
)
@click.pass_context
def main(context: click.Context, port: str | None) -> None:
    """Check, draw and upload parts for the Tornillo lathe, and run them.

    \b
    Examples: tornillo new my-part.toml
              tornillo check my-part.toml
              tornillo run --help
    """
    context.obj = port
    if os.environ.get("NO_COLOR"):
        context.color = False
