# SPDX-License-Identifier: Apache-2.0
"""The reference of the command line, written from the commands themselves."""

from collections.abc import Iterator

import click
from tornillo import language
from tornillo.cli import main
from tornillo.verbs import SECTIONS

HEADS = {
    "en": """\
# The command line

<!-- written by docs/generate_reference.py from the commands; do not edit -->

`tornillo VERB --help` shows the same. `--port NAME` before the verb, or `TORNILLO_PORT`, chooses
the lathe when there are several. `TORNILLO_LANG=es` speaks Spanish, `NO_COLOR=1` has no colours.

| exit code | meaning |
|---|---|
| 0 | fine |
| 1 | the input or the machine said no; the message is on standard error, with what to try |
| 2 | wrong usage |

Ctrl-C in any verb brings the lathe to a controlled stand: a run is held, homing and moves are
stopped; `flash` leaves the chip in its boot loader and goes on the next time. The message says
which.
""",
    "es": """\
# La línea de comandos

<!-- written by docs/generate_reference.py from the commands; do not edit -->

Lo mismo muestra `tornillo VERBO --help`. `--port NOMBRE` delante del verbo, o `TORNILLO_PORT`,
elige el torno cuando hay varios. `TORNILLO_LANG=es` habla español, `NO_COLOR=1` quita los colores.

| código de salida | significado |
|---|---|
| 0 | bien |
| 1 | la entrada o la máquina dijeron que no; la salida de errores dice por qué y qué intentar |
| 2 | uso equivocado |

Ctrl-C detiene el torno de manera controlada en cualquier verbo: una marcha queda retenida, la
búsqueda de referencia y los movimientos se detienen; `flash` deja el chip en su cargador de
arranque y continúa la próxima vez. El mensaje dice qué pasó.
""",
}
DEFAULT = {"en": "Default", "es": "Por omisión"}
COLUMNS = {"en": "| option | meaning |", "es": "| opción | significado |"}


def page(code: str) -> str:
    """The whole page in the language with this code."""
    language.use(code)
    blocks = [HEADS[code]]
    for section, verbs in SECTIONS.items():
        blocks.append(f"## {language._(section)}\n")
        for name in verbs:
            command = main.get_command(click.Context(main), name)
            assert command is not None
            blocks += _command(name, command, code)
    language.use("en")
    return "\n".join(blocks)


def _command(words: str, command: click.Command, code: str) -> Iterator[str]:
    """One command and its subcommands."""
    context = click.Context(command, info_name=f"tornillo {words}")
    usage = command.get_usage(context).split(": ", 1)[1]
    yield f"### `{words}`\n"
    yield f"```\n{' '.join(usage.split())}\n```\n"
    yield from _text(command.help or "")
    rows = [_option(option, code) for option in command.params if isinstance(option, click.Option)]
    if rows:
        yield "\n".join([COLUMNS[code], "|---|---|", *rows, ""])
    if isinstance(command, click.Group):
        for name, inner in command.commands.items():
            yield from _command(f"{words} {name}", inner, code)


def _text(text: str) -> Iterator[str]:
    """The help in paragraphs; examples as typed."""
    for paragraph in text.split("\n\n"):
        stripped = paragraph.strip()
        if stripped.startswith("\b"):
            lines = [line.strip() for line in stripped.removeprefix("\b").strip().splitlines()]
            lines[0] = lines[0].split(":", 1)[1].strip()
            yield "```\n" + "\n".join(lines) + "\n```\n"
        else:
            yield " ".join(stripped.split()) + "\n"


def _option(option: click.Option, code: str) -> str:
    """One row of the table."""
    names = ", ".join(f"`{name}`" for name in option.opts)
    if not option.is_flag:
        metavar = option.make_metavar(click.Context(main))
        names += f" `{metavar}`".replace("|", "\\|")
    default = ""
    if option.show_default and option.default is not None:
        default = f" {DEFAULT[code]}: {option.default}."
    return f"| {names} | {option.help or ''}{default} |"
