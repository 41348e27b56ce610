# SPDX-License-Identifier: Apache-2.0
"""The verb doctor: looks at everything between the computer and the buttons, one by one."""

import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass

import click

from tornillo import __version__
from tornillo.commands.connection import connected, json_option, print_json
from tornillo.commands.progress import on_terminals
from tornillo.errors import InLoaderError, LinkError, TornilloError, VersionError
from tornillo.keys import Keys, keyboard
from tornillo.language import _
from tornillo.lathe import Lathe
from tornillo.protocol import Setting, SettingGetData, SettingId, State, StatusFlag
from tornillo.readout import INPUTS
from tornillo.status import Status

POLL_S = 0.05
#: How long the doctor waits for one button, in seconds.
PATIENCE_S = 30.0
#: An answer may take so long on average, in milliseconds; USB needs one or two.
SLOW_MS = 50.0
QUESTIONS = 20


@dataclass(frozen=True)
class Finding:
    """What was looked at, whether it is as it should be, and what to do if not."""

    what: str
    good: bool
    text: str
    remedy: str = ""


@click.command()
@click.option("--no-buttons", is_flag=True, help="Do not ask for switches and buttons.")
@json_option
def doctor(no_buttons: bool, as_json: bool) -> None:
    """Check port, rights, firmware, link and settings, then switches and buttons one by one.

    Nothing moves: the buttons are tried under the alarm of the emergency stop. Exit code 1 when
    something is not as it should be.

    \b
    Examples: tornillo doctor
              tornillo doctor --no-buttons --json
    """
    by_hand = not (no_buttons or as_json) and on_terminals()
    findings = []
    for finding in _examine(by_hand):
        findings.append(finding)
        if not as_json:
            _tell(finding)
    if as_json:
        print_json([vars(finding) for finding in findings])
    if not all(finding.good for finding in findings):
        sys.exit(1)


def _tell(finding: Finding) -> None:
    """One line, and one more when there is something to do."""
    mark = click.style(_("ok"), fg="green") if finding.good else click.style(_("NO"), fg="red")
    click.echo(f"{mark:<2}  {finding.what}: {finding.text}")
    if finding.remedy:
        click.echo(_("    Try: {remedy}").format(remedy=finding.remedy))


def _examine(by_hand: bool) -> Iterator[Finding]:
    """Everything in its order; what cannot be reached is left out."""
    try:
        with connected() as lathe:
            number = lathe.serial_number
            yield Finding(_("port"), True, _("open, serial number {number}").format(number=number))
            yield _firmware(lathe)
            yield _link(lathe)
            yield from _settings(lathe)
            yield from _state(lathe.status())
            if by_hand:
                with keyboard() as keys:
                    yield from _inputs(lathe, keys)
    except (VersionError, InLoaderError) as error:
        yield Finding(_("firmware"), False, str(error), error.remedy)
    except LinkError as error:
        yield Finding(_("link"), False, str(error), error.remedy)
    except TornilloError as error:
        yield Finding(_("port"), False, str(error), error.remedy)


def _firmware(lathe: Lathe) -> Finding:
    """Whether both sides are of one release."""
    same = lathe.firmware == __version__
    text = _("{firmware}, tornillo {own}").format(firmware=lathe.firmware, own=__version__)
    remedy = _("use firmware and tornillo of one release: features may be missing")
    return Finding(_("firmware"), same, text, "" if same else remedy)


def _link(lathe: Lathe) -> Finding:
    """How fast and how cleanly it answers."""
    start = time.monotonic()
    for _number in range(QUESTIONS):
        status = lathe.status()
    each_ms = (time.monotonic() - start) / QUESTIONS * 1000
    good = each_ms < SLOW_MS and status.bad_frames == 0
    text = _("an answer takes {each:.1f} ms; {bad} damaged frames since it was switched on").format(
        each=each_ms, bad=status.bad_frames
    )
    remedy = _("use another USB cable or port, away from motor cables")
    return Finding(_("link"), good, text, "" if good else remedy)


def _settings(lathe: Lathe) -> Iterator[Finding]:
    """Values that have been changed, and those that make no sense together."""
    found = lathe.settings()
    changed = [entry.id.name.lower() for entry, data in found if data.value != entry.default]
    text = _("all as delivered")
    if changed:
        text = _("changed: {names}").format(names=", ".join(changed))
    yield Finding(_("settings"), True, text)
    for problem in _contradictions({entry.id: data for entry, data in found}, found):
        yield Finding(_("settings"), False, problem, _("see docs/settings.md"))


def _contradictions(
    data: dict[SettingId, SettingGetData], found: list[tuple[Setting, SettingGetData]]
) -> Iterator[str]:
    """What cannot be meant."""
    for entry, got in found:
        if not got.minimum <= got.value <= got.maximum:
            yield _("{name} is {value}, outside {least} to {most}").format(
                name=entry.id.name.lower(), value=got.value, least=got.minimum, most=got.maximum
            )
    value = {setting: got.value for setting, got in data.items()}
    for axis in ("X", "Z"):
        travel, zero = value[SettingId[f"TRAVEL_{axis}"]], value[SettingId[f"ZERO_{axis}"]]
        if -zero > travel:
            yield _("part zero of {axis} lies behind the end of its travel").format(axis=axis)
        start = value[SettingId[f"START_RATE_{axis}"]]
        if start > value[SettingId[f"RAPID_RATE_{axis}"]]:
            yield _("{axis} starts faster than its rapid speed").format(axis=axis)
    if not value[SettingId.ESTOP_FITTED]:
        yield _("the emergency stop is not sensed (estop_fitted is 0)")


def _state(status: Status) -> Iterator[Finding]:
    """Whether the lathe stands still without an alarm."""
    what = _("state")
    if status.state is State.ALARM:
        error = status.alarm_error()
        yield Finding(what, False, str(error), error.remedy)
    elif status.state is not State.IDLE:
        text = _("it is moving or held")
        yield Finding(what, False, text, _("let it finish, or `tornillo stop`"))
    else:
        homed = _("homed") if status.homed else _("not homed yet")
        yield Finding(what, True, _("waiting, {homed}").format(homed=homed))


# -- switches and buttons, with the person's hands -------------------------------------


def _inputs(lathe: Lathe, keys: Keys) -> Iterator[Finding]:
    """Ask for each to be pressed and released.

    The emergency stop comes first: under its alarm no button moves anything. RUN is only tried
    while an alarm stands; STOP, which acknowledges it, is the last.
    """
    if lathe.status().state is not State.IDLE:
        return
    click.echo(_("Now the inputs, while nothing moves; s skips one, q ends."))
    for flag, name in INPUTS:
        if flag is StatusFlag.ESTOP and not lathe.setting(SettingId.ESTOP_FITTED).value:
            continue
        if flag is StatusFlag.BUTTON_RUN and lathe.status().state is not State.ALARM:
            click.echo(_("RUN is not tried: without an alarm it would start the lathe"))
            continue
        finding, go_on = _one_input(lathe, keys, flag, _(name))
        if finding is not None:
            yield finding
        if not go_on:
            break
    if lathe.status().state is State.ALARM:
        click.echo(_("An alarm stands now: `tornillo reset`, then `tornillo home`"))


def _one_input(
    lathe: Lathe, keys: Keys, flag: StatusFlag, name: str
) -> tuple[Finding | None, bool]:
    """Wait until one input was seen pressed and released; False when the person wants to end."""
    if flag in lathe.status().flags:
        text = _("reads as pressed before anybody touched it")
        remedy = _("check its wires: a normally closed contact that is open reads so")
        return Finding(name, False, text, remedy), True
    click.echo(_("Press {name} and release it").format(name=name), err=True)
    for wanted in (True, False):
        pressed = _wait(lathe, keys, flag, wanted)
        if pressed in ("s", "q"):
            return None, pressed == "s"
        if pressed == "late":
            text = _("was not seen") if wanted else _("stays pressed")
            remedy = _("check the switch and its wires, see the page about wiring")
            return Finding(name, False, text, remedy), True
    return Finding(name, True, _("pressed and released")), True


def _wait(lathe: Lathe, keys: Keys, flag: StatusFlag, wanted: bool) -> str:
    """Watch until an input is as `wanted`; "" then, the key s or q, or "late"."""
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        if (flag in lathe.status().flags) is wanted:
            return ""
        key = keys.read(POLL_S)
        if key is not None and key in "sq":
            return key
    return "late"


VERBS = (doctor,)
