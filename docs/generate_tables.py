#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Write the tables of the pages that come from protocol.toml and states.toml.

    python3 docs/generate_tables.py           write the pages
    python3 docs/generate_tables.py --check   exit 1 when one is stale

A table stands between `<!-- table: NAME -->` and `<!-- end -->`. The page about the
link has its own generator, because it is part of the protocol.
"""

import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent
LINK = DOCS.parent / "firmware" / "link"
PAGES = ("alarms.md", "part-file.md", "settings.md", "states.md")


def main(arguments: list[str]) -> int:
    """Write or check; return the exit code."""
    if arguments not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    sys.path.insert(0, str(LINK))
    import state_table
    from protocol_model import load
    from protocol_pages import fill
    from state_pages import state_tables

    model = load(LINK / "protocol.toml")
    states = state_tables(state_table.load())
    stale = False
    for name in PAGES:
        page = DOCS / name
        old = page.read_text(encoding="utf-8")
        new = fill(model, old, states)
        if new == old:
            continue
        stale = True
        if arguments:
            print(f"docs/{name} is stale: run make docs")
        else:
            page.write_text(new, encoding="utf-8")
            print(f"docs/{name} written")
    return 1 if arguments and stale else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
