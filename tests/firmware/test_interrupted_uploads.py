# SPDX-License-Identifier: Apache-2.0
"""Uploads that something happens to: a pulled cable, a cut of power, damaged and lost frames."""

from __future__ import annotations

from functools import partial

import pytest
from simulated import little_pin
from simulated.bench import Bench
from simulated.ports import TroubledPort
from simulated.processes import branch, on_a_new_chip
from tornillo import Lathe
from tornillo.errors import LinkError
from tornillo.frames import Frame, encode
from tornillo.protocol import Command, State

OLD = little_pin.image()
NEW = little_pin.image(depth_of_cut=17)
#: Short answers, so that a lost one does not take a quarter of a second.
TIMEOUT_S = 0.05
#: Between two cuts of power: an erase or a write of flash takes 2 ms.
STEP_S = 0.7e-3


def stored(bench: Bench) -> bytes:
    """Return the image of the one part there is."""
    (part,) = bench.host.parts()
    assert part.selected
    return bench.host.read(part.slot)


def assert_runnable(bench: Bench) -> None:
    """Check that the chip starts to cut the selected part."""
    bench.host.run()
    assert bench.is_in(State.RUNNING)
    bench.wait(lambda: bench.moving, 0.2)  # it looks ahead before the first step
    bench.host.stop()


def length_of_the_stream(bench: Bench) -> int:
    """Return how many bytes an undisturbed upload sends, HELLO excluded."""
    port = TroubledPort(bench.lathe.port)
    host = Lathe(port)
    greeting = port.sent
    host.upload(NEW)
    return port.sent - greeting


def pull_the_cable(bench: Bench, after: int) -> None:
    """Pull it after so many bytes of an upload; see that nothing has happened."""
    greeting = TroubledPort(bench.lathe.port)
    Lathe(greeting)
    port = TroubledPort(bench.lathe.port, greeting.sent + after, bench.unplug)
    host = Lathe(port)
    with pytest.raises(LinkError):
        host.upload(NEW)
    bench.connect()
    assert stored(bench) == OLD
    assert_runnable(bench)
    bench.host.upload(NEW)
    assert stored(bench) == NEW


@pytest.mark.parametrize("quarter", range(4))
@on_a_new_chip
def test_pulling_the_cable_after_any_byte_leaves_the_stored_part_and_the_next_upload_works(
    quarter: int,
) -> None:
    bench = little_pin.homed_lathe_with_pin()
    length = branch(partial(length_of_the_stream, bench))
    assert length > len(NEW)
    for after in range(quarter + 1, length, 4):
        branch(partial(pull_the_cable, bench, after))


@on_a_new_chip
def test_pulling_the_cable_after_the_last_byte_stores_the_new_part() -> None:
    bench = little_pin.homed_lathe_with_pin()
    length = branch(partial(length_of_the_stream, bench))
    greeting = TroubledPort(bench.lathe.port)
    Lathe(greeting)
    port = TroubledPort(bench.lathe.port, greeting.sent + length, bench.unplug)
    with pytest.raises(LinkError):
        Lathe(port).upload(NEW)
    bench.run(0.05)
    bench.connect()
    assert stored(bench) == NEW
    bench.host.run()
    bench.wait_for(State.IDLE)
    little_pin.assert_cut_exactly(bench)


class PowerCut(Exception):
    """Ends what the host library is doing."""


def cut_the_power(bench: Bench, after: float) -> tuple[bytes, bool]:
    """Cut it so many seconds into an upload; return what is stored then, and what was hit."""
    writing = False

    def cut() -> None:
        nonlocal writing
        writing = bool(bench.chip.peek(0xFA6) & 2)
        bench.power_cycle(seed=round(after * 1e6))
        raise PowerCut

    bench.lathe.at(bench.chip.seconds + after, cut)
    try:
        bench.host.upload(NEW)
        bench.run(after)
    except PowerCut:
        pass
    else:
        raise AssertionError("the power was not cut")
    bench.run(0.05)
    found = stored(bench)
    if round(after / STEP_S) % 8 == 0:
        bench.home()
        assert_runnable(bench)
    other = OLD if found == NEW else NEW
    bench.host.upload(other)
    assert stored(bench) == other
    return found, writing


@on_a_new_chip
def test_a_cut_of_power_at_any_time_of_a_replacement_leaves_the_old_part_or_the_new() -> None:
    bench = little_pin.lathe_with_pin()
    begun = bench.chip.seconds
    length = branch(lambda: (bench.host.upload(NEW), bench.chip.seconds - begun)[1])
    found = [
        branch(partial(cut_the_power, bench, step * STEP_S))
        for step in range(1, round(length / STEP_S) + 4)
    ]
    images = [image for image, _ in found]
    switch = images.index(NEW)
    assert images == [OLD] * switch + [NEW] * (len(images) - switch)
    # Two erased blocks, three pieces, two headers and the selection: 2 and 4 ms each.
    assert sum(writing for _, writing in found) >= 20


@on_a_new_chip
def test_a_flipped_bit_on_the_wire_is_refused_and_the_frame_repeated() -> None:
    bench = little_pin.lathe_with_pin()
    greeting = TroubledPort(bench.lathe.port)
    Lathe(greeting)
    length = length_of_the_stream(bench)
    images = (OLD, NEW)
    bad_frames = bench.status().bad_frames
    for number in range(0, length, 2):
        bit = 8 * (greeting.sent + number) + number // 2 % 8
        host = Lathe(TroubledPort(bench.lathe.port, flip=bit), TIMEOUT_S)
        slot = host.upload(images[number // 2 % 2])
        assert host.read(slot) == images[number // 2 % 2]
    assert bench.connect().status().bad_frames - bad_frames > length // 4


@on_a_new_chip
def test_a_request_whose_answer_is_lost_is_not_executed_again() -> None:
    bench = little_pin.lathe_with_pin()
    before = bench.chip.nonvolatile_counts
    bench.host.upload(NEW)
    middle = bench.chip.nonvolatile_counts
    # Answers 1, 3, 5 ... from the one to HELLO on: each request is answered twice.
    port = TroubledPort(bench.lathe.port, drop=frozenset(range(1, 20, 2)))
    assert stored_by(Lathe(port, TIMEOUT_S)) == OLD
    after = bench.chip.nonvolatile_counts
    for kind in ("flash_erases", "flash_writes"):
        assert after[kind] - middle[kind] == middle[kind] - before[kind]


def stored_by(host: Lathe) -> bytes:
    """Upload the old part over a troubled port and read it back."""
    return host.read(host.upload(OLD))


@pytest.mark.parametrize("end", ["cable", "port"])
@on_a_new_chip
def test_a_request_cut_off_before_its_last_byte_is_never_carried_out(end: str) -> None:
    bench = little_pin.homed_lathe_with_pin()
    bench.lathe.port.write(encode(Frame(200, Command.RUN, b"\xff"))[:-1])
    bench.run(0.01)
    if end == "cable":
        bench.unplug()
    else:
        bench.lathe.host.close_port()
        bench.run(0.01)
    bench.connect()
    bench.run(0.05)
    assert bench.is_in(State.IDLE)
    bench.host.run()
    assert bench.is_in(State.RUNNING)
