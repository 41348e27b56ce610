# SPDX-License-Identifier: Apache-2.0
"""The verb plan."""

import click

from tornillo.commands.connection import connected, json_option, machine_option, print_json
from tornillo.commands.progress import busy
from tornillo.drives import Drives
from tornillo.language import _
from tornillo.lathe import Lathe
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol import SettingId


@click.command()
@click.argument("file", type=click.Path(dir_okay=False))
@click.option("--moves", is_flag=True, help="List every move, not only the passes.")
@click.option("--lathe", is_flag=True, help="Ask the connected lathe how its axes are driven.")
@json_option
@machine_option
def plan(file: str, moves: bool, lathe: bool, as_json: bool, machine: str) -> None:
    """List the passes that FILE takes, and how long.

    The chip plans by the same rules, so this is what will be cut. The time is right within three
    percent when the axes are driven as on the lathe; dead steps only count with --lathe.

    \b
    Examples: tornillo plan examples/test-bar.toml
              tornillo plan examples/test-bar.toml --moves --json
    """
    from tornillo.plan_report import PlanReport
    from tornillo.plan_text import PlanText

    part = Part.load(file)
    if lathe:
        with connected() as found:
            known, drives = found.machine(), drives_of(found)
    else:
        known = Machine.load(machine)
        drives = Drives.usual(known)
    with busy(_("planning")):
        part.check(known)
        report = PlanReport(part, known, drives)
    if as_json:
        print_json(report.json(moves))
        return
    for line in PlanText(report).lines(moves):
        click.echo(line)


def drives_of(lathe: Lathe) -> Drives:
    """How the axes of a connected lathe are driven."""

    def value(setting: SettingId) -> int:
        return lathe.setting(setting).value

    return Drives(
        rapid_x=value(SettingId.RAPID_RATE_X),
        rapid_z=value(SettingId.RAPID_RATE_Z),
        start_x=value(SettingId.START_RATE_X),
        start_z=value(SettingId.START_RATE_Z),
        acceleration=value(SettingId.ACCELERATION),
        dead_x=max(0, value(SettingId.DEAD_X)),
        dead_z=max(0, value(SettingId.DEAD_Z)),
    )


VERBS = (plan,)
