# SPDX-License-Identifier: Apache-2.0
"""The verb new: asks for a part operation by operation and draws it after each answer."""

import re
import sys
from collections.abc import Callable
from pathlib import Path

import click

from tornillo.commands.connection import machine_option
from tornillo.errors import TornilloError
from tornillo.interview import GROOVING_TOOL, PLUNGING, Draft, Value, marks
from tornillo.language import _, later
from tornillo.machine import Machine
from tornillo.protocol import NAME_LENGTH
from tornillo.terminal_picture import Picture, shows_braille

#: Answers that Enter gives, by unit: depth of cut, finish allowance, feeds, retract.
USUAL = {
    "mm": {
        "depth_of_cut": 0.5,
        "finish_allowance": 0.1,
        "feed": 120.0,
        "finish_feed": 60.0,
        "retract": 0.5,
    },
    "inch": {
        "depth_of_cut": 0.02,
        "finish_allowance": 0.004,
        "feed": 5.0,
        "finish_feed": 2.5,
        "retract": 0.02,
    },
}
CUT_QUESTIONS = {
    "depth_of_cut": later("Depth of cut, radial"),
    "finish_allowance": later("Allowance for the finishing pass, radial"),
    "feed": later("Feed for roughing, per minute"),
    "finish_feed": later("Feed for the finishing pass, per minute"),
    "retract": later("Distance from the work in rapid moves"),
}
DONE = "done"
OPERATIONS = (
    "face",
    "cylinder",
    "cone",
    "arc",
    "profile",
    "groove",
    "part-off",
    "drill",
    "pause",
    "undo",
    DONE,
)
HEIGHT, WIDTH = 14, 76
Operation = dict[str, Value]


@click.command()
@click.argument("file", type=click.Path(dir_okay=False))
@click.option("--force", is_flag=True, help="Overwrite FILE when it exists.")
@machine_option
def new(file: str, force: bool, machine: str) -> None:
    """Make the part FILE by answering questions, operation by operation.

    The part is drawn after each answer, and checked after each operation. Lengths towards the
    chuck are negative; z = 0 is the finished front face.

    \b
    Example: tornillo new my-part.toml
    """
    path = Path(file)
    if path.exists() and not force:
        raise TornilloError(
            _("{path} exists already").format(path=path),
            _("choose another name, or add --force"),
        )
    interview = Interview(Machine.load(machine))
    interview.begin(path.stem)
    interview.ask_operations()
    path.write_text(interview.draft.text(), encoding="utf-8")
    click.echo(_("{path} written; next: tornillo plan {path}").format(path=path))


class Interview:
    """The conversation; `draft` holds what was answered."""

    def __init__(self, machine: Machine) -> None:
        """For a part that `machine` shall make."""
        self.machine = machine
        self.draft = Draft()
        self._asked: dict[str, Callable[[Operation], None]] = {
            "face": self._face,
            "cylinder": self._cylinder,
            "cone": self._cone,
            "arc": self._arc,
            "profile": self._profile,
            "groove": self._groove,
            "part-off": self._part_off,
            "drill": self._drill,
            "pause": self._pause,
        }

    # -- what holds for the whole part ------------------------------------------------

    def begin(self, proposed: str) -> None:
        """Ask for name, units, stock and cutting data, again when no part can be made of them."""
        self._begin(proposed)
        while (problem := self.draft.problem(self.machine)) is not None:
            self._tell(problem)
            self.draft = Draft()
            self._begin(proposed)

    def _tell(self, problem: TornilloError) -> None:
        """Why something cannot be made, and what to do."""
        message = re.sub(r"^the new part:\d+: ", "", str(problem))
        click.secho(_("This cannot be made: {message}").format(message=message), fg="red")
        click.echo(_("Try: {remedy}").format(remedy=problem.remedy))

    def _begin(self, proposed: str) -> None:
        """Ask once."""
        name = re.sub("[^a-z0-9]+", "-", proposed.lower()).strip("-")[:NAME_LENGTH] or "part"
        draft = self.draft
        draft.title["name"] = click.prompt(_("Name of the part"), default=name, value_proc=_name)
        units = click.prompt(_("Units"), type=click.Choice(["mm", "inch"]), default="mm")
        draft.title["units"] = units
        draft.stock["diameter"] = _above_zero(_("Diameter of the raw bar"))
        draft.stock["length"] = _above_zero(_("Free length in front of the chuck"))
        draft.stock["allowance"] = 0.0
        for key, value in USUAL[units].items():
            draft.cut[key] = value
        self.draw()
        draft.stock["allowance"] = _length(_("Raw material in front of the finished face"), 0.0)
        self.draw()
        for key, question in CUT_QUESTIONS.items():
            default = USUAL[units][key]
            draft.cut[key] = _length(_(question), default)
        nose = _length(_("Nose radius of the tool"), 0.0)
        draft.tools.append(
            {"name": "turning", "nose_radius": nose, "back_clearance": _degrees()},
        )

    def draw(self, told: Operation | None = None) -> None:
        """Show the part; `told` is an operation that is being asked for."""
        picture = Picture(self.draft.drawn(), WIDTH, HEIGHT)
        for place in marks(told or {}):
            picture.show(place, "mark")
        braille = shows_braille(sys.stdout.encoding)
        if not sys.stdout.isatty():
            click.echo("\n".join(line.rstrip() for line in picture.lines(braille)))
            return
        from rich.console import Console

        Console().print(picture.text(braille), highlight=False)

    # -- operations -------------------------------------------------------------------

    def ask_operations(self) -> None:
        """Ask for operations until the person is done."""
        while True:
            number = len(self.draft.operations) + 1
            raw_face = number == 1 and self.draft.stock["allowance"] != 0
            kind = click.prompt(
                _("Operation {number}").format(number=number),
                type=click.Choice(OPERATIONS),
                default="face" if raw_face else None,
            )
            if kind == DONE and self.draft.operations:
                return
            if kind == DONE:
                click.echo(_("A part needs an operation."))
            elif kind == "undo":
                self.draft.operations[-1:] = []
                self.draw()
            else:
                self._ask(kind)

    def _ask(self, kind: str) -> None:
        """Ask for one operation; it is taken back when it cannot be made."""
        operation: Operation = {"type": kind}
        self._asked[kind](operation)
        if kind in PLUNGING:
            self._grooving_tool(operation)
        self.draft.operations.append(operation)
        problem = self.draft.problem(self.machine)
        if problem is not None:
            self.draft.operations.pop()
            self._tell(problem)
        self.draw()

    def _face(self, operation: Operation) -> None:
        """Where, and how far in."""
        self._z(operation, _("z of the finished face"), 0.0)
        self._diameter(operation, _("Diameter where the cut ends, 0 = the centre"), 0.0)

    def _cylinder(self, operation: Operation) -> None:
        """From where to where, and how thick."""
        self._ends(operation)
        self._diameter(operation, _("Finished diameter"))

    def _cone(self, operation: Operation) -> None:
        """Two places."""
        operation["start"] = self._place(operation, _("Start, at the free end"))
        operation["end"] = self._place(operation, _("End, towards the chuck"))

    def _arc(self, operation: Operation) -> None:
        """Two places and a radius."""
        self._cone(operation)
        operation["radius"] = _number(_("Radius: above 0 bulges outwards, below 0 inwards"))

    def _profile(self, operation: Operation) -> None:
        """A chain of places."""
        points: list[dict[str, float]] = []
        operation["points"] = points
        while True:
            label = _("Point {number}").format(number=len(points) + 1)
            point = self._place(operation, label)
            if points:
                point |= _way_and_corner()
            points.append(point)
            self.draw(operation)
            if len(points) > 1 and not click.confirm(_("Another point?"), default=True):
                return

    def _groove(self, operation: Operation) -> None:
        """Two walls and a bottom."""
        self._ends(operation)
        self._diameter(operation, _("Diameter of the bottom"))

    def _part_off(self, operation: Operation) -> None:
        """The back face."""
        self._z(operation, _("z of the back face"))
        self._diameter(operation, _("Diameter where the cut ends, 0 = the centre"), 0.0)

    def _drill(self, operation: Operation) -> None:
        """What the operator shall drill."""
        operation["diameter"] = _above_zero(_("Diameter of the drill"))
        operation["depth"] = _above_zero(_("Depth of the hole"))

    def _pause(self, operation: Operation) -> None:
        """What the operator shall do."""
        operation["message"] = click.prompt(_("What the operator shall do, 32 characters at most"))

    def _grooving_tool(self, operation: Operation) -> None:
        """Use the tool that plunges; ask for its width the first time."""
        if all(tool["name"] != GROOVING_TOOL for tool in self.draft.tools):
            width = _above_zero(_("Width of the grooving tool"))
            self.draft.tools.append({"name": GROOVING_TOOL, "width": width})
        operation["tool"] = GROOVING_TOOL

    # -- single answers ---------------------------------------------------------------

    def _z(self, operation: Operation, question: str, default: float | None = None) -> None:
        """Ask for one z and draw it."""
        operation["z"] = _number(question, default)
        self.draw(operation)

    def _ends(self, operation: Operation) -> None:
        """Ask for the two ends along and draw each."""
        start = _number(_("z of its start, at the free end"), 0.0)
        self.draw({**operation, "z": start})
        operation["z"] = (start, _number(_("z of its end, towards the chuck")))
        self.draw(operation)

    def _diameter(self, operation: Operation, question: str, default: float | None = None) -> None:
        """Ask for a diameter; the picture of the whole operation follows."""
        operation["diameter"] = _length(question, default)

    def _place(self, operation: Operation, label: str) -> dict[str, float]:
        """Ask for a place and draw each half."""
        z = _number(f"{label}: z")
        self.draw({**operation, "here": {"z": z}})
        diameter = _length(_("{place}: diameter").format(place=label))
        self.draw({**operation, "here": {"z": z, "diameter": diameter}})
        return {"z": z, "diameter": diameter}


def _name(text: str) -> str:
    """A name that the lathe can show."""
    if not re.fullmatch(f"[a-z0-9-]{{1,{NAME_LENGTH}}}", text):
        raise click.BadParameter(
            _("use 1 to {most} of the characters a-z, 0-9 and -").format(most=NAME_LENGTH)
        )
    return text


def _number(question: str, default: float | None = None) -> float:
    """Any number."""
    return float(click.prompt(question, type=click.FloatRange(-1e4, 1e4), default=default))


def _length(question: str, default: float | None = None) -> float:
    """A number of 0 or more."""
    return float(click.prompt(question, type=click.FloatRange(0, 1e4), default=default))


def _above_zero(question: str) -> float:
    """A number above 0."""
    return float(click.prompt(question, type=click.FloatRange(0, 1e4, min_open=True)))


def _way_and_corner() -> dict[str, float]:
    """How a profile comes to a point, and what becomes of the corner there."""
    told: dict[str, float] = {}
    way = click.prompt(
        _("How the profile comes to it"), type=click.Choice(["line", "arc"]), default="line"
    )
    if way == "arc":
        told["radius"] = _number(_("Radius: above 0 bulges outwards, below 0 inwards"))
    corners = click.Choice(["sharp", "rounded", "chamfered"])
    corner = click.prompt(_("Its corner"), type=corners, default="sharp")
    if corner != "sharp":
        size = _above_zero(_("Radius or width of the corner"))
        told["corner" if corner == "rounded" else "chamfer"] = size
    return told


def _degrees() -> float:
    """How steeply the tool can fall."""
    question = _("Steepest fall towards the chuck that the tool can follow, degrees")
    return float(click.prompt(question, type=click.FloatRange(0, 90), default=30.0))


VERBS = (new,)
