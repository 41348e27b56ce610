# SPDX-License-Identifier: Apache-2.0
"""What Ctrl-C means: the lathe comes to a controlled stand, and the person is told how.

A run is held, so nothing is lost; anything else that moves is stopped.
"""

import signal
import threading

from tornillo.commands.following import place
from tornillo.errors import ChipError, LinkError, TornilloError
from tornillo.language import _
from tornillo.lathe import Lathe
from tornillo.protocol import ErrorCode, State

STANDING = (State.IDLE, State.ALARM)
HELD = (State.HOLD, State.PAUSE)


def interrupted(lathe: Lathe) -> TornilloError:
    """Bring the lathe to a stand after Ctrl-C; returns what is to be told."""
    # Who presses it twice shall not break off what brings the lathe to a stand.
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        return _brought_to_a_stand(lathe)
    except LinkError as error:
        return TornilloError(
            _("interrupted, but the lathe did not hear of it: {error}").format(error=error),
            _("press HOLD at the lathe if it moves; then look at cable and port"),
        )
    finally:
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGINT, signal.default_int_handler)


def _brought_to_a_stand(lathe: Lathe) -> TornilloError:
    """Do what the state asks for."""
    state = lathe.status().state
    if state is State.HOMING:
        lathe.stop()
        return TornilloError(
            _("homing was stopped"),
            _("acknowledge with `tornillo reset`, then `tornillo home` again"),
        )
    if state is State.RUNNING:
        return _held(lathe)
    if state in HELD:
        return TornilloError(
            _("interrupted; the run stands still and nothing is lost"),
            _("go on with `tornillo resume --follow`, or give up with `tornillo stop`"),
        )
    if state in STANDING:
        return _nothing_moved()
    lathe.stop()
    return TornilloError(_("stopped by Ctrl-C"), _("see where the tool is with `tornillo status`"))


def _held(lathe: Lathe) -> TornilloError:
    """Hold the run and say where it stands."""
    try:
        lathe.hold()
    except ChipError as error:
        if error.code is not ErrorCode.NOT_RUNNING:
            raise
        return _nothing_moved()
    status = lathe.status()
    return TornilloError(
        _("held by Ctrl-C at {status}; nothing is lost").format(status=place(status)),
        _("go on with `tornillo resume --follow`, or give up with `tornillo stop`"),
    )


def _nothing_moved() -> TornilloError:
    """There was nothing to hold."""
    return TornilloError(_("interrupted; the lathe was not cutting"), _("see `tornillo status`"))
