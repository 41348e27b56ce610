# SPDX-License-Identifier: Apache-2.0
"""Whether firmware and host belong together, and what to do if not.

The first four bytes of the answer to HELLO never change: protocol version, then the three
numbers of the firmware's version.
"""

from typing import NamedTuple

from tornillo.errors import NoAnswerError, VersionError
from tornillo.holders import holders
from tornillo.language import _
from tornillo.protocol import PROTOCOL_VERSION

HEAD = 4  # bytes


class Told(NamedTuple):
    """What every firmware tells in HELLO."""

    protocol: int
    firmware: str


def told(hello: bytes) -> Told | None:
    """Take the first bytes of HELLO apart; None when they are not there."""
    if len(hello) < HEAD:
        return None
    return Told(hello[0], ".".join(map(str, hello[1:HEAD])))


def own_version() -> str:
    """The version of this package."""
    from tornillo import __version__

    return __version__


def check(hello: bytes) -> None:
    """Look at the data of HELLO.

    Raises VersionError when the firmware speaks another version of the protocol.
    """
    spoken = hello[0] if hello else None
    if spoken == PROTOCOL_VERSION:
        return
    own = own_version()
    found = told(hello)
    if spoken is None or found is None:
        raise silent_hello()
    firmware = found.firmware
    older = spoken < PROTOCOL_VERSION
    message = _(
        "the firmware {firmware} speaks protocol {spoken}, {what} than protocol "
        "{protocol_version} of tornillo {own}"
    ).format(
        firmware=firmware,
        spoken=spoken,
        what=_("older") if older else _("newer"),
        protocol_version=PROTOCOL_VERSION,
        own=own,
    )
    if older:
        raise VersionError(
            message,
            _("{own}, or install the tornillo that came with {firmware}").format(
                own=_update_firmware(own), firmware=firmware
            ),
        )
    raise VersionError(
        message,
        _(
            "update tornillo: install host-cli from the release that the firmware "
            "{firmware} came with"
        ).format(firmware=firmware),
    )


def silent_hello() -> VersionError:
    """The answer to HELLO has no version in it."""
    own = own_version()
    return VersionError(
        _(
            "the firmware does not tell its version; tornillo {own} speaks protocol "
            "{protocol_version}"
        ).format(own=own, protocol_version=PROTOCOL_VERSION),
        _update_firmware(own),
    )


def refused_hello(code: str) -> VersionError:
    """The firmware knows HELLO no more or not yet."""
    own = own_version()
    return VersionError(
        _(
            "the firmware answers HELLO with {code}: its version is unknown, tornillo "
            "{own} speaks protocol {protocol_version}"
        ).format(code=code, own=own, protocol_version=PROTOCOL_VERSION),
        _update_firmware(own),
    )


def no_hello(port: str, error: NoAnswerError) -> NoAnswerError:
    """Nobody has answered HELLO at `port`."""
    own = own_version()
    speaks = _("tornillo {own} speaks protocol {protocol_version}").format(
        own=own, protocol_version=PROTOCOL_VERSION
    )
    others = ", ".join(map(str, holders(port)))
    warning = (
        _("{others} has the port open too: close it if it is not the lathe; ").format(others=others)
        if others
        else ""
    )
    if error.heard:
        return NoAnswerError(
            _(
                "what answers at {port} sends {heard} bytes and no frame of a lathe; {speaks}"
            ).format(port=port, heard=error.heard, speaks=speaks),
            _(
                "{warning}choose the lathe's port with --port; if it is the lathe's, the "
                "firmware is older than the protocol: {own}"
            ).format(warning=warning, own=_update_firmware(own)),
            error.heard,
        )
    return NoAnswerError(
        _("nothing answers at {port}; {speaks}").format(port=port, speaks=speaks),
        _(
            "{warning}check that the port is the lathe's and that the lathe is "
            "switched on, plug the cable out and in again; if it stays silent, its "
            "firmware is too old or damaged: {own}"
        ).format(warning=warning, own=_update_firmware(own)),
        error.heard,
    )


def unknown_command_note(firmware: str) -> str:
    """What to add when a firmware of the same protocol lacks a command."""
    return _(" (firmware {firmware}, tornillo {own_version})").format(
        firmware=firmware, own_version=own_version()
    )


def _update_firmware(own: str) -> str:
    """What to do about an old firmware."""
    return _(
        "update the firmware to that of tornillo {own} with `tornillo flash`, or with a "
        "programmer (docs/flashing.md)"
    ).format(own=own)
