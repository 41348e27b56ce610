# SPDX-License-Identifier: Apache-2.0
"""Everything that can be refused, as exceptions that say what to do next.

`TornilloError` is the root; `str()` gives the message, `remedy` what a person tries next.
"""

from tornillo.language import _
from tornillo.protocol import Command, ErrorCode, Refusal
from tornillo.protocol_texts import ERROR_TEXTS, REFUSAL_TEXTS


class TornilloError(Exception):
    """The input or the machine said no."""

    def __init__(self, message: str, remedy: str) -> None:
        """Keep what happened and what to do about it."""
        super().__init__(message)
        self.remedy = remedy


class PartError(TornilloError):
    """A part file is refused; the message starts with `file:line:`."""


class DrawingError(TornilloError):
    """A drawing cannot be made a part; `marks` are its places with what is there."""

    def __init__(
        self, message: str, remedy: str, marks: tuple[tuple[tuple[float, float], str], ...] = ()
    ) -> None:
        """Keep what happened, what to do about it, and the places in units of the drawing."""
        super().__init__(message, remedy)
        self.marks = marks


class FirmwareError(TornilloError):
    """A firmware file is refused; the message starts with `file:line:`."""


class MachineError(TornilloError):
    """A machine file is refused."""


class PortError(TornilloError):
    """No port, several ports, or the port cannot be opened."""


class LinkError(TornilloError):
    """The chip does not answer, or not as the protocol says."""


class NoAnswerError(LinkError):
    """No answer came in the time of a request; `heard` bytes of something else did."""

    def __init__(self, message: str, remedy: str, heard: int) -> None:
        """Keep how many bytes came that were no answer."""
        super().__init__(message, remedy)
        self.heard = heard


class VersionError(LinkError):
    """The firmware and this tornillo do not belong together; the message names both."""


class LoaderError(LinkError):
    """The chip's boot loader does not answer, or says no."""


class InLoaderError(LinkError):
    """The chip waits in its boot loader, where it cannot cut; `tornillo flash` helps."""

    def __init__(self, port: str) -> None:
        """Say where, and the two ways out."""
        super().__init__(
            _("the lathe at {port} waits in its boot loader and runs no firmware").format(
                port=port
            ),
            _(
                "give it its firmware with `tornillo flash FILE.hex`, which also goes on with an "
                "update that was interrupted; or switch the lathe off and on"
            ),
        )


class AlarmError(TornilloError):
    """The machine stopped with an alarm."""


class ChipError(TornilloError):
    """The chip answered a request with an error code.

    For `ErrorCode.INVALID_PART`, `reason` and `operation` (from 1, 0 the whole part) say why.
    `note` is added to the message.
    """

    def __init__(
        self,
        command: Command,
        code: ErrorCode,
        reason: Refusal | None = None,
        operation: int = 0,
        note: str = "",
    ) -> None:
        """Say in words what the codes mean."""
        message, remedy = map(_, ERROR_TEXTS[code])
        if reason is not None:
            place = (
                _("operation {operation}").format(operation=operation)
                if operation
                else _("the part as a whole")
            )
            explained = REFUSAL_TEXTS[reason]
            message = f"{message}: {place}: {_(explained.cause)}"
            remedy = _(explained.remedy)
        super().__init__(
            _("{command} was refused: {message}{note}").format(
                command=command.name, message=message, note=note
            ),
            remedy,
        )
        self.command = command
        self.code = code
        self.reason = reason
        self.operation = operation
