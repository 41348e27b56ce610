# SPDX-License-Identifier: Apache-2.0
"""The words of generated tables that are no message of the program, in Spanish.

A table is written in English by the tool that knows its contents; the Spanish page gets the same
table with these words. One that is missing here stops the generator. `{}` stands for a figure.
"""

import re

WORDS = {
    # Pins, from firmware/board.h.
    "pin": "pin",
    "name in the firmware": "nombre en el firmware",
    "reads or means": "se lee o significa",
    "1 = winding on": "1 = devanado con corriente",
    "1 = pressed, or the wire is broken": "1 = pulsado, o el cable está roto",
    "0 = no USB supply; open = present": "0 = sin alimentación USB; abierto = la hay",
    "1 = lit": "1 = encendido",
    "reserved": "reservado",
    "1 = on": "1 = encendido",
    "0 = pressed": "0 = pulsado",
    "0 = motor power present": "0 = los motores tienen alimentación",
    "0 = contact; pulled up outside": "0 = contacto; resistencia a 5 V fuera del chip",
    "analogue: keys of the panel": "analógica: teclas del panel",
    "display of the panel": "pantalla del panel",
    # Keys of part files, from docs/part_keys.py.
    "table": "tabla",
    "keys that are needed": "claves necesarias",
    "keys that may be left out": "claves que se pueden omitir",
    "or": "o",
    "text": "texto",
    "number": "número",
    "number above 0": "número mayor que 0",
    "{} to {}": "{} a {}",
    "whole number, {} to {}": "número entero, {} a {}",
    "[front, back]": "[frente, fondo]",
    "list of {} points or more": "lista de {} puntos o más",
    "none": "ninguno",
    "else": "si no,",
    "name of a tool": "nombre de una herramienta",
    "the first": "la primera",
    "as in `[cut]`": "como en `[cut]`",
    "every `[[operation]]` that cuts": "cada `[[operation]]` que corta",
    "a point of a profile": "un punto de un perfil",
    # Measured by tests/bench/calibration_page.py.
    "switch travel set": "recorrido ajustado",
    "part zero taken with the tool last moving": "cero pieza tomado tras mover la herramienta",
    "cylinders, cut going inwards": "cilindros, cortados hacia adentro",
    "cone, cut going outwards": "cono, cortado hacia afuera",
    "{} of {} steps": "{} de {} pasos",
    "outwards, as from withdrawing until it is free": "hacia afuera, como al retirarla hasta que "
    "queda libre",
    "inwards, as from touching the bar": "hacia adentro, como al tocar la barra",
    "{} mm ({} inch)": "{} mm ({} pulgadas)",
    "S0, part in inches: A, B": "S0, pieza en pulgadas: A, B",
    "S0, part in millimetres: A, B": "S0, pieza en milímetros: A, B",
    "not told": "no se dice",
    "Every diameter of the part, drawn and cut, mm:": "Cada diámetro de la pieza, dibujado y "
    "cortado, en mm:",
    "diameter": "diámetro",
    "drawn": "dibujado",
    "{}, outwards": "{}, afuera",
    "{}, inwards": "{}, adentro",
    "cylinder {}": "cilindro {}",
    "cone {} start": "cono {}, principio",
    "cone {} end": "cono {}, final",
}
FIGURE = re.compile(r"(?<![A-Za-z\d.])[+-]?\d+(?:\.\d+)?")


def say(words: str) -> str:
    """`words` in Spanish; ends the program when there is none."""
    if words not in WORDS:
        raise SystemExit(f"docs/spanish.py: no Spanish for {words!r}")
    return WORDS[words]


def said_with_figures(text: str) -> str:
    """A text in Spanish, its figures as they are."""
    if not re.search("[A-Za-z]", text):
        return text
    return say(FIGURE.sub("{}", text)).format(*FIGURE.findall(text))


def translated(tables: str) -> str:
    """Tables of figures, and the lines between them, in Spanish."""
    return "".join(_line(line) + "\n" for line in tables.splitlines())


def _line(line: str) -> str:
    if not line.startswith("|"):
        return said_with_figures(line)
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    if line.startswith("|---"):
        return line
    return "| " + " | ".join(said_with_figures(cell) for cell in cells) + " |"
