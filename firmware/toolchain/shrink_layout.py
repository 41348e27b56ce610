# SPDX-License-Identifier: Apache-2.0
"""Orders the functions and uses the short calls and jumps wherever they reach.

All functions follow each other in one section, so every distance is known; an
instruction only ever gets shorter, so what reaches once reaches ever after.
"""

from collections import Counter

from shrink_model import Line, Program, RefusalError

REACH = {"CALL": 1024, "RCALL": 1024, "GOTO": 1024, "BRA": 1024}
REACH_BRANCH = 128
SHORT = {"CALL": "RCALL", "GOTO": "BRA"}


def order(program: Program) -> list[str]:
    """Return the functions in an order that puts callers near what they call."""
    weight: Counter[tuple[str, str]] = Counter()
    for name, function in program.functions.items():
        for line in function.body:
            target = line.args[0] if line.op in ("CALL", "GOTO") else ""
            if target in program.functions and target != name:
                weight[min(name, target), max(name, target)] += 1
    chain = {name: [name] for name in program.functions}
    for (one, two), _ in sorted(weight.items(), key=lambda item: (-item[1], item[0])):
        if chain[one] is not chain[two]:
            merged = _joined(chain[one], chain[two], one, two)
            for name in merged:
                chain[name] = merged
    result: list[str] = []
    for name in program.functions:
        if name not in result:
            result += chain[name]
    return result


def _joined(first: list[str], second: list[str], one: str, two: str) -> list[str]:
    """Join two chains such that `one` and `two` come as near as can be."""
    left = first if first.index(one) * 2 >= len(first) else first[::-1]
    right = second if second.index(two) * 2 <= len(second) else second[::-1]
    return left + right


def shorten(program: Program, names: list[str]) -> int:
    """Shorten calls and jumps that reach; return bytes saved."""
    saved = 0
    changed = True
    while changed:
        changed = False
        lines = [line for name in names for line in program.functions[name].body]
        place, at = _places(lines)
        for line, here in zip(lines, at, strict=True):
            if (
                line.op in SHORT
                and not line.pinned
                and line.args[0] in place
                and (_reaches(place[line.args[0]] - here - 2, REACH[line.op]))
            ):
                line.op = SHORT[line.op]
                saved += 2
                changed = True
    return saved


def check_reach(program: Program, names: list[str]) -> None:
    """Raise RefusalError if a short jump or call does not reach its target."""
    lines = [line for name in names for line in program.functions[name].body]
    place, at = _places(lines)
    for line, here in zip(lines, at, strict=True):
        limit = (
            REACH_BRANCH
            if line.op[:1] == "B" and line.args[:1] and (line.args[0] in place) and line.op != "BRA"
            else REACH.get(line.op, 0)
        )
        if limit and line.op not in SHORT and not _reaches(place[line.args[0]] - here - 2, limit):
            raise RefusalError(f"out of reach: {line.text().strip()}")


def _places(lines: list[Line]) -> tuple[dict[str, int], list[int]]:
    place: dict[str, int] = {}
    at: list[int] = []
    address = 0
    for line in lines:
        at.append(address)
        if not line.op:
            place[line.label] = address
        address += line.size()
    return place, at


def _reaches(distance: int, limit: int) -> bool:
    return -2 * limit <= distance <= 2 * (limit - 1)
