# SPDX-License-Identifier: Apache-2.0
"""Random parts that the default machine can make, and images with something broken.

Both come from a seed alone, so that host and chip can be compared on thousands of them and a
failure can be repeated by its number.
"""

import itertools
import math
import random
from collections.abc import Callable

from tornillo.errors import PartError
from tornillo.image import RECORD_HEAD_SIZE
from tornillo.machine import Machine
from tornillo.part import Part
from tornillo.protocol import IMAGE_HEADER, PART_IMAGE_MAX

MM_PER_INCH = 25.4
ATTEMPTS = 400
Place = tuple[float, float]


class Draft:
    """A part that may or may not be possible."""

    def __init__(self, rng: random.Random) -> None:
        """Choose stock, tools and cutting data; sizes in mm."""
        self.rng = rng
        self.inch = rng.random() < 0.3
        self.diameter = rng.uniform(6, 30)
        self.length = rng.uniform(12, 55)
        self.allowance = rng.choice([0.0, 0.0, rng.uniform(0.1, 2.0)])
        self.nose = rng.choice([0.0, 0.0, 0.1, 0.2, 0.4, 0.8])
        self.back = rng.choice([10.0, 30.0, 45.0, 60.0, 90.0])
        self.width = rng.uniform(0.5, 3.0)
        self.lines: list[str] = []

    def n(self, value: float, digits: int = 3) -> str:
        """A length in the units of the file."""
        return f"{value / (MM_PER_INCH if self.inch else 1):.{digits + self.inch}f}"

    def at(self, place: Place, more: str = "") -> str:
        """A point."""
        return f"{{ z = {self.n(place[0])}, diameter = {self.n(2 * place[1])}{more} }}"

    def text(self) -> str:
        """The whole file."""
        rng, n = self.rng, self.n
        self.head()
        if self.allowance or rng.random() < 0.1:
            self.operation("face", f"z = {n(0.0)}")
        shapes = [self.chain, self.profile, self.neck]
        rng.choice([*shapes, *shapes, self.stairs, self.crowd])()
        if rng.random() < 0.3:
            self.groove()
        if rng.random() < 0.15:
            self.operation("pause", 'message = "measure it"')
        if rng.random() < 0.1:
            self.operation("drill", f"diameter = {n(3)}\ndepth = {n(8)}")
        if rng.random() < 0.2:
            z, x = -self.length * rng.uniform(0.6, 0.9), rng.choice([0.0, rng.uniform(0, 3)])
            self.operation("part-off", f'z = {n(z)}\ndiameter = {n(x)}\ntool = "parting"')
        return "\n".join(self.lines) + "\n"

    def head(self) -> None:
        """Everything before the operations."""
        rng, n = self.rng, self.n
        depth = rng.uniform(0.15, 2.0)
        order = rng.choice(['order = "auto"\n', "", "", ""])
        self.lines.append(
            f'[part]\nname = "random-{rng.randrange(1000)}"\nunits = '
            f'"{"inch" if self.inch else "mm"}"\n{order}\n'
            f"[stock]\ndiameter = {n(self.diameter)}\nlength = {n(self.length)}\n"
            f"allowance = {n(self.allowance)}\n\n[cut]\ndepth_of_cut = {n(depth)}\n"
            f"finish_allowance = {n(rng.choice([0.0, 0.1, depth / 2]))}\n"
            f"feed = {n(rng.uniform(20, 400), 1)}\nfinish_feed = {n(rng.uniform(10, 200), 1)}\n"
            f"retract = {n(rng.uniform(0.1, 1.0))}\n"
            f"spindle = {rng.choice([0, 0, 400, 2000])}\n"
            f"spring_passes = {rng.choice([0, 0, 0, 1, 2])}\n"
            f"peck = {n(rng.choice([0.0, 0.0, 0.5]))}\n"
        )
        self.lines.append(
            f'[[tool]]\nname = "turning"\nnose_radius = {n(self.nose)}\n'
            f"back_clearance = {self.back:.1f}\nfront_clearance = {rng.choice([3, 0, 5])}\n"
        )
        self.lines.append(
            f'[[tool]]\nname = "parting"\nwidth = {n(self.width)}\n'
            f"offset = {{ z = {n(rng.choice([0.0, 0.7]))}, diameter = {n(0.0)} }}\n"
        )

    def operation(self, kind: str, body: str) -> None:
        """One more operation, now and then with its own cutting data."""
        rng = self.rng
        extra = ""
        if kind not in ("pause", "drill"):
            if rng.random() < 0.15:
                extra += f"feed = {self.n(rng.uniform(20, 400), 1)}\n"
            if rng.random() < 0.1:
                extra += f"finish_allowance = {self.n(rng.choice([0.0, 0.05]))}\n"
            if rng.random() < 0.2 and kind not in ("groove", "part-off"):
                extra += f'roughing = "{rng.choice(["along", "facing", "shortest"])}"\n'
        self.lines.append(f'[[operation]]\ntype = "{kind}"\n{body}\n{extra}')

    def rising(self, count: int) -> list[Place]:
        """Places from the free end to the chuck, their radii growing."""
        rng = self.rng
        radius = self.diameter / 2
        deep = self.length * rng.uniform(0.3, 0.9)
        zs = sorted((rng.uniform(0, deep) for _ in range(count)), reverse=False)
        xs = sorted(rng.uniform(0.1, 1.0) * radius for _ in range(count + 1))
        first = rng.choice([0.0, xs[0], xs[0]])
        return [(0.0, first), *zip((-z for z in zs), xs[1:], strict=True)]

    def chain(self) -> None:
        """Cylinders, cones and arcs one after the other."""
        rng, n = self.rng, self.n
        places = self.rising(rng.randint(1, 5))
        at = places[0]
        for place in places[1:]:
            kind = rng.choice(["cylinder", "cone", "arc"])
            if kind == "cylinder":
                radius = max(at[1], 0.5)
                self.operation(kind, f"z = [{n(at[0])}, {n(place[0])}]\ndiameter = {n(2 * radius)}")
                at = (place[0], radius)
                continue
            body = f"start = {self.at(at)}\nend = {self.at(place)}"
            if kind == "arc":
                body += f"\nradius = {n(self.radius(at, place))}"
            self.operation(kind, body)
            at = place

    def radius(self, start: Place, end: Place) -> float:
        """The radius of an arc between two places that is likely to be possible."""
        rng = self.rng
        run, chord = max(0.05, abs(start[0] - end[0])), math.dist(start, end)
        return rng.choice([-1, 1]) * chord**2 / (2 * run) * rng.uniform(1.001, 3.0)

    def profile(self) -> None:
        """A chain of lines and arcs that only rises, with corners."""
        self.points(self.rising(self.rng.randint(2, 12)))

    def neck(self) -> None:
        """A chain that also falls."""
        rng = self.rng
        places = self.rising(rng.randint(3, 9))
        steep = math.tan(math.radians(min(self.back, 70.0)))
        bent = [places[0]]
        for z, x in places[1:]:
            low = bent[-1][1] - (bent[-1][0] - z) * steep * rng.uniform(0.1, 0.95)
            fallen = max(low, 0.5) if rng.random() < 0.4 else x
            bent.append((z, min(fallen, self.diameter / 2)))
        self.points(bent)

    def stairs(self) -> None:
        """Many cylinders, the last ones thickest."""
        n = self.n
        places = self.rising(self.rng.randint(20, 58))
        for (front, _), (back, radius) in itertools.pairwise(places):
            self.operation("cylinder", f"z = [{n(front)}, {n(back)}]\ndiameter = {n(2 * radius)}")

    def crowd(self) -> None:
        """A profile of many lines, for long images."""
        self.points(self.rising(self.rng.randint(50, 250)), plain=True)

    def points(self, places: list[Place], plain: bool = False) -> None:
        """Write a profile through places, `plain` without arcs and corners."""
        rng, n = self.rng, self.n
        rows = []
        for number, place in enumerate(places):
            more = ""
            if number and not plain and rng.random() < 0.3:
                more += f", radius = {n(self.radius(places[number - 1], place))}"
            if not plain and 0 < number < len(places) - 1 and rng.random() < 0.3:
                more += f", {rng.choice(['corner', 'chamfer'])} = {n(rng.uniform(0.1, 1.0))}"
            rows.append(f"  {self.at(place, more)},")
        self.operation("profile", "points = [\n" + "\n".join(rows) + "\n]")

    def groove(self) -> None:
        """A groove somewhere."""
        rng, n = self.rng, self.n
        front = -rng.uniform(0.5, self.length * 0.6)
        wide = self.width * rng.uniform(1.0, 3.0)
        bottom = self.diameter * rng.uniform(0.1, 0.9)
        self.operation(
            "groove",
            f'z = [{n(front)}, {n(front - wide)}]\ndiameter = {n(bottom)}\ntool = "parting"',
        )


def random_part(seed: int) -> str:
    """The text of a part file that `Machine.load()` accepts."""
    machine = Machine.load()
    rng = random.Random(seed)
    for _ in range(ATTEMPTS):
        text = Draft(rng).text()
        try:
            Part.parse(text, f"random-{seed}.toml").check(machine)
        except PartError:
            continue
        return text
    raise AssertionError(f"seed {seed} leads to no part")


def _flip(rng: random.Random, image: bytearray) -> None:
    """Turn one bit."""
    image[rng.randrange(len(image))] ^= 1 << rng.randrange(8)


def _byte(rng: random.Random, image: bytearray) -> None:
    """Another byte, often an extreme one."""
    image[rng.randrange(len(image))] = rng.choice([0, 1, 0x7F, 0x80, 0xFF, rng.randrange(256)])


def _word(rng: random.Random, image: bytearray) -> None:
    """Another 16-bit number, often an extreme or a small one."""
    at = rng.randrange(len(image) - 1)
    value = rng.choice([0, 0x7FFF, 0x8000, 0xFFFF, rng.randrange(100), rng.randrange(65536)])
    image[at : at + 2] = value.to_bytes(2, "little")


def _nudge(rng: random.Random, image: bytearray) -> None:
    """A number one or a few more or less: rules are broken at their edge."""
    at = rng.randrange(IMAGE_HEADER.size, len(image) - 1)
    value = int.from_bytes(image[at : at + 2], "little") + rng.choice([-300, -2, -1, 1, 2, 300])
    image[at : at + 2] = (value & 0xFFFF).to_bytes(2, "little")


def _cut_short(rng: random.Random, image: bytearray) -> None:
    """Lose the end."""
    del image[rng.randrange(len(image)) :]


def _lengthen(rng: random.Random, image: bytearray) -> None:
    """Gain bytes at the end."""
    image += rng.randbytes(rng.choice([1, 3, 4, 12, PART_IMAGE_MAX]))


def _records(image: bytearray) -> list[tuple[int, int]]:
    """Offset and size of the records that can be told apart."""
    found = []
    at = IMAGE_HEADER.size
    while at + RECORD_HEAD_SIZE <= len(image):
        size = int.from_bytes(image[at + 2 : at + 4], "little")
        if not RECORD_HEAD_SIZE <= size <= len(image) - at:
            break
        found.append((at, size))
        at += size
    return found


def _swap(rng: random.Random, image: bytearray) -> None:
    """Two neighbouring records the other way round, or one of them twice or not at all."""
    records = _records(image)
    if not records:
        _flip(rng, image)
        return
    at, size = rng.choice(records)
    what = rng.randrange(3)
    record = bytes(image[at : at + size])
    if what == 0:
        del image[at : at + size]
    elif what == 1:
        image[at:at] = record
    else:
        del image[at : at + size]
        image += record


DAMAGES: tuple[Callable[[random.Random, bytearray], None], ...] = (
    _flip,
    _byte,
    _word,
    _nudge,
    _nudge,
    _cut_short,
    _lengthen,
    _swap,
)


def damaged(image: bytes, seed: int) -> bytes:
    """`image` with one to three things broken; now and then it is still a good part."""
    rng = random.Random(seed)
    broken = bytearray(image)
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        if len(broken) > IMAGE_HEADER.size + RECORD_HEAD_SIZE:
            rng.choice(DAMAGES)(rng, broken)
    return bytes(broken)
