# SPDX-License-Identifier: Apache-2.0
"""Host and chip judge the same part images: what each of them answers.

By hand, for more of them than a test has time for:

    python -m simulated.agreement --parts 10000 --damaged 10000 --nasty 10000
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from random_parts import damaged, random_part
from tornillo import Part
from tornillo.errors import ChipError
from tornillo.machine import Machine
from tornillo.protocol import ErrorCode, Refusal
from tornillo.rules import verdict

from simulated.bench import Bench
from simulated.nasty_images import nasty_image

#: What is wrong with an image, and at which operation; None: nothing.
Answer = tuple[Refusal, int] | None


class Judged(NamedTuple):
    """One image and the two answers to it."""

    name: str
    image: bytes
    host: Answer
    chip: Answer

    @property
    def agreed(self) -> bool:
        """Whether host and chip say the same."""
        return self.host == self.chip


def chips_answer(bench: Bench, image: bytes) -> Answer:
    """Send an image past all checks of the host; delete it again when the chip has taken it."""
    try:
        slot = bench.host.upload(image)
    except ChipError as error:
        if error.code is ErrorCode.OUT_OF_RANGE:
            return Refusal.LENGTH, 0  # announced length, before the first piece
        if error.code is not ErrorCode.INVALID_PART or error.reason is None:
            raise
        return error.reason, error.operation
    bench.host.delete(slot)
    return None


def hosts_answer(image: bytes, machine: Machine) -> Answer:
    """Return what the rules on the host say."""
    judged = verdict(image, machine)
    return (judged.refusal, judged.operation) if judged else None


def parts(seeds: Iterable[int], machine: Machine) -> Iterator[tuple[str, bytes]]:
    """Yield random parts that can be made."""
    for seed in seeds:
        part = Part.parse(random_part(seed), f"random-{seed}.toml")
        yield f"part {seed}", part.image(machine)


def damaged_parts(seeds: Iterable[int], machine: Machine) -> Iterator[tuple[str, bytes]]:
    """Yield the same parts with something broken, three times each."""
    for seed in seeds:
        part = Part.parse(random_part(seed // 3), f"random-{seed // 3}.toml")
        yield f"damaged {seed}", damaged(part.image(machine), seed)


def nasty_parts(seeds: Iterable[int], machine: Machine) -> Iterator[tuple[str, bytes]]:
    """Yield images whose numbers stand at the edges of the rules and of 16 bits."""
    for seed in seeds:
        yield f"nasty {seed}", nasty_image(seed, machine)


def judge(bench: Bench, images: Iterable[tuple[str, bytes]], machine: Machine) -> Iterator[Judged]:
    """Yield what both say of every image."""
    for name, image in images:
        yield Judged(name, image, hosts_answer(image, machine), chips_answer(bench, image))


def main() -> int:
    """Compare as many as wanted, print the counts; 1 when host and chip differ."""
    parser = argparse.ArgumentParser(description="Compare the rules of host and chip.")
    parser.add_argument("--parts", type=int, default=300, help="random parts that can be made")
    parser.add_argument("--damaged", type=int, default=300, help="parts with something broken")
    parser.add_argument("--nasty", type=int, default=300, help="images at the edges of the rules")
    parser.add_argument("--seed", type=int, default=0, help="first seed of each kind")
    parser.add_argument("--wrong", type=Path, help="directory for images they differ about")
    given = parser.parse_args()
    bench = Bench()
    machine = bench.host.machine()
    images = {
        "parts": parts(range(given.seed, given.seed + given.parts), machine),
        "damaged": damaged_parts(range(given.seed, given.seed + given.damaged), machine),
        "nasty": nasty_parts(range(given.seed, given.seed + given.nasty), machine),
    }
    differ = 0
    for kind, every in images.items():
        answers: Counter[str] = Counter()
        for judged in judge(bench, every, machine):
            answers[judged.host[0].name if judged.host else "accepted"] += 1
            if not judged.agreed:
                differ += 1
                print(f"{judged.name}: host {judged.host}, chip {judged.chip}", flush=True)
                if given.wrong:
                    given.wrong.mkdir(parents=True, exist_ok=True)
                    (given.wrong / judged.name.replace(" ", "-")).write_bytes(judged.image)
        print(kind, sum(answers.values()), dict(answers.most_common()), flush=True)
    print(f"host and chip differ about {differ} images")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
