# SPDX-License-Identifier: Apache-2.0
"""Orders the functions and uses the short calls and jumps wherever they reach.

All functions follow each other in one section, so every distance is known; an
instruction only ever gets shorter, so what reaches once reaches ever after.
"""

from collections import Counter

from shrink_model import Program, RefusalError, places

REACH = {"CALL": 1024, "RCALL": 1024, "GOTO": 1024, "BRA": 1024}
REACH_BRANCH = 128
SHORT = {"CALL": "RCALL", "GOTO": "BRA"}


def order(program: Program) -> list[str]:
    """Return the functions in an order in which as many calls as possible are short.

    Starts from chains of functions that call each other most, then moves single
    functions next to their callers or callees as long as that helps.
    """
    calls = _calls(program)
    sizes = {name: function.size() for name, function in program.functions.items()}
    names = _chained(program, calls)
    best = _long_calls(names, calls, sizes)
    neighbours: dict[str, set[str]] = {name: set() for name in names}
    for caller, _, called in calls:
        neighbours[caller].add(called)
        neighbours[called].add(caller)
    improved = True
    while improved:
        improved = False
        for name in list(program.functions):
            for beside in sorted(neighbours[name] - {name}):
                for side in (0, 1):
                    rest = [other for other in names if other != name]
                    place = rest.index(beside) + side
                    tried = [*rest[:place], name, *rest[place:]]
                    cost = _long_calls(tried, calls, sizes)
                    if cost < best:
                        names, best, improved = tried, cost, True
    return names


def _calls(program: Program) -> list[tuple[str, int, str]]:
    """Return caller, offset in the caller and called function of each call."""
    found = []
    for name, function in program.functions.items():
        offset = 0
        for line in function.body:
            if line.op in SHORT and line.args[0] in program.functions:
                found.append((name, offset, line.args[0]))
            offset += line.size()
    return found


def _long_calls(names: list[str], calls: list[tuple[str, int, str]], sizes: dict[str, int]) -> int:
    """Return how many calls do not reach in an order, with the sizes given."""
    place: dict[str, int] = {}
    address = 0
    for name in names:
        place[name] = address
        address += sizes[name]
    return sum(
        not -2046 <= place[called] - place[caller] - offset <= 2048
        for caller, offset, called in calls
    )


def _chained(program: Program, calls: list[tuple[str, int, str]]) -> list[str]:
    """Return the functions in chains, joined in the order of the number of calls."""
    weight = Counter((caller, called) for caller, _, called in calls if caller != called)
    chain = {name: [name] for name in program.functions}
    for (caller, called), _ in sorted(weight.items(), key=lambda item: (-item[1], item[0])):
        if chain[caller] is not chain[called]:
            merged = chain[caller] + chain[called]
            for name in merged:
                chain[name] = merged
    result: list[str] = []
    for name in program.functions:
        if name not in result:
            result += chain[name]
    return result


def shorten(program: Program, names: list[str]) -> int:
    """Shorten calls and jumps that reach; return bytes saved."""
    saved = 0
    changed = True
    while changed:
        changed = False
        lines = [line for name in names for line in program.functions[name].body]
        place, at = places(lines)
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
    place, at = places(lines)
    for line, here in zip(lines, at, strict=True):
        limit = (
            REACH_BRANCH
            if line.op[:1] == "B" and line.args[:1] and (line.args[0] in place) and line.op != "BRA"
            else REACH.get(line.op, 0)
        )
        if limit and line.op not in SHORT and not _reaches(place[line.args[0]] - here - 2, limit):
            raise RefusalError(f"out of reach: {line.text().strip()}")


def _reaches(distance: int, limit: int) -> bool:
    return -2 * limit <= distance <= 2 * (limit - 1)
