# SPDX-License-Identifier: Apache-2.0
"""Whether firmware and host belong together, and what to do if not.

The first four bytes of the answer to HELLO never change: protocol version, then the three
numbers of the firmware's version.
"""

from tornillo.errors import NoAnswerError, VersionError
from tornillo.holders import holders
from tornillo.protocol import PROTOCOL_VERSION

HEAD = 4  # bytes


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
    if spoken is None or len(hello) < HEAD:
        raise VersionError(
            f"the firmware does not tell its version; tornillo {own} speaks protocol "
            f"{PROTOCOL_VERSION}",
            _update_firmware(own),
        )
    firmware = ".".join(map(str, hello[1:HEAD]))
    older = spoken < PROTOCOL_VERSION
    message = (
        f"the firmware {firmware} speaks protocol {spoken}, "
        f"{'older' if older else 'newer'} than protocol {PROTOCOL_VERSION} of tornillo {own}"
    )
    if older:
        raise VersionError(
            message, f"{_update_firmware(own)}, or install the tornillo that came with {firmware}"
        )
    raise VersionError(
        message,
        f"update tornillo: install host-cli from the release that the firmware {firmware} "
        "came with",
    )


def refused_hello(code: str) -> VersionError:
    """The firmware knows HELLO no more or not yet."""
    own = own_version()
    return VersionError(
        f"the firmware answers HELLO with {code}: its version is unknown, tornillo {own} speaks "
        f"protocol {PROTOCOL_VERSION}",
        _update_firmware(own),
    )


def no_hello(port: str, error: NoAnswerError) -> NoAnswerError:
    """Nobody has answered HELLO at `port`."""
    own = own_version()
    speaks = f"tornillo {own} speaks protocol {PROTOCOL_VERSION}"
    others = ", ".join(map(str, holders(port)))
    warning = f"{others} has the port open too: close it if it is not the lathe; " if others else ""
    if error.heard:
        return NoAnswerError(
            f"what answers at {port} sends {error.heard} bytes and no frame of a lathe; {speaks}",
            f"{warning}choose the lathe's port with --port; if it is the lathe's, the firmware is "
            f"older than the protocol: {_update_firmware(own)}",
            error.heard,
        )
    return NoAnswerError(
        f"nothing answers at {port}; {speaks}",
        f"{warning}check that the port is the lathe's and that the lathe is switched on, plug the "
        "cable out and in again; if it stays silent, its firmware is too old or damaged: "
        f"{_update_firmware(own)}",
        error.heard,
    )


def unknown_command_note(firmware: str) -> str:
    """What to add when a firmware of the same protocol lacks a command."""
    return f" (firmware {firmware}, tornillo {own_version()})"


def _update_firmware(own: str) -> str:
    """What to do about an old firmware."""
    return f"update the firmware to that of tornillo {own} (`make firmware`, then a programmer)"
