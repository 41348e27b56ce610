# SPDX-License-Identifier: Apache-2.0
"""The serial port of the CDC-ACM device for programs in this process."""

from __future__ import annotations

from .chip import CYCLES_PER_SECOND
from .usb_host import UsbError, UsbHost, UsbTimeout

WRITE_TIMEOUT_S = 5.0
POLL_S = 2e-4


class SerialPort:
    """The CDC port in this process; reading and writing lets simulated time pass.

    The methods are those of ``serial.Serial`` that a program with its own framing needs, so that
    code written for pyserial works on it. Times are simulated seconds.
    """

    def __init__(self, host: UsbHost, timeout: float | None = 1.0) -> None:
        """Use the host's open port; ``timeout`` in simulated seconds, None for ever."""
        self._host = host
        self.timeout = timeout
        self._received = bytearray()

    def _check(self) -> None:
        if not self._host.port_open or not self._host.connected:
            raise UsbError("the device is gone")

    def write(self, data: bytes) -> int:
        """Send all of ``data``; waits as long as the device says NAK.

        Raises:
            UsbError: the cable is out.
            UsbTimeout: the device has not taken the bytes in 5 seconds.
        """
        rest = bytes(data)
        deadline = self._host.chip.cycle + round(WRITE_TIMEOUT_S * CYCLES_PER_SECOND)
        while rest or self._host.unsent:
            self._check()
            rest = rest[self._host.send(rest) :]
            if self._host.chip.cycle > deadline:
                raise UsbTimeout("the device does not take what is sent")
            self._host.wait(POLL_S)
        return len(data)

    def read(self, size: int = 1) -> bytes:
        """Return up to ``size`` bytes, fewer when ``timeout`` has passed."""
        start = self._host.chip.cycle
        while len(self._received) < size:
            self._received += self._host.receive()
            waited = (self._host.chip.cycle - start) / CYCLES_PER_SECOND
            if len(self._received) >= size or (self.timeout is not None and waited >= self.timeout):
                break
            self._check()
            self._host.wait(POLL_S)
        taken = bytes(self._received[:size])
        del self._received[:size]
        return taken

    @property
    def in_waiting(self) -> int:
        """Bytes that can be read at once."""
        self._received += self._host.receive()
        return len(self._received)

    def flush(self) -> None:
        """Nothing is left to send after :meth:`write`."""

    def reset_input_buffer(self) -> None:
        """Forget what has been received."""
        self._received.clear()
        self._host.receive()

    def close(self) -> None:
        """Close the port if the device is still there."""
        if self._host.port_open and self._host.connected:
            self._host.close_port()
