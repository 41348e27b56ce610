# SPDX-License-Identifier: Apache-2.0
"""How fast the link is: a part of 30 operations, and frames without a pause."""

from __future__ import annotations

from measure import BenchError, Figures
from simulated import little_pin
from simulated.bench import Bench
from simulated.processes import branch
from tornillo.frames import Frame, encode
from tornillo.protocol import FRAME_PAYLOAD_MAX

OPERATIONS = 30
FRAMES = 500
#: A command that there is not: it costs the chip a frame and nothing else.
NO_COMMAND = 0x7F
POLL_S = 5e-5
TIMEOUT_S = 30.0


def link_figures() -> Figures:
    """Simulated seconds of an upload, read back and compared, and bytes a second to the chip."""
    return branch(_measure)


def _measure() -> Figures:
    bench = little_pin.lathe_with_pin()
    steps = (little_pin.cylinder(-2 * i, -2 * i - 2, 20 + i) for i in range(OPERATIONS - 1))
    image = little_pin.image("thirty", (little_pin.face(0, 0), *steps))
    start = bench.lathe.seconds
    slot = bench.host.upload(image)
    if bench.host.read(slot) != image:
        raise BenchError("the part of 30 operations was not stored as it was sent")
    return {
        "upload_30_ops_s": round(bench.lathe.seconds - start, 3),
        "upload_30_ops_bytes": len(image),
        "link_bytes_per_s": round(_bytes_per_second(bench)),
    }


def _bytes_per_second(bench: Bench) -> float:
    """The longest frames one after the other, each answered, in bytes to the chip."""
    payload = bytes(i % 255 + 1 for i in range(FRAME_PAYLOAD_MAX))
    stream = b"".join(encode(Frame(i % 256, NO_COMMAND, payload)) for i in range(FRAMES))
    size, answers = len(stream), 0
    usb, start = bench.lathe.host, bench.lathe.seconds
    while answers < FRAMES:
        stream = stream[usb.send(stream) :]
        bench.run(POLL_S)
        answers += usb.receive().count(0)
        if bench.lathe.seconds - start > TIMEOUT_S:
            raise BenchError(f"{answers} of {FRAMES} frames were answered")
    return size / (bench.lathe.seconds - start)
