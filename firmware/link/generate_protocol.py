#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Write every file that is derived from protocol.toml.

    python3 firmware/link/generate_protocol.py           write the files
    python3 firmware/link/generate_protocol.py --check   exit 1 when one is stale

Written are `protocol.h` for the firmware, `protocol.py`, `protocol_texts.py` and `version.py`
for the host, and the tables between the markers of `docs/protocol.md`. Only the standard library is
needed, so that the firmware builds without a virtual environment.
"""

import sys
from pathlib import Path

from protocol_c import header
from protocol_model import load
from protocol_pages import fill
from protocol_python import numbers_module, texts_module, version_module

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
HOST = ROOT / "host-cli" / "src" / "tornillo"
PAGE = ROOT / "docs" / "protocol.md"


def derived() -> dict[Path, str]:
    """Path and wanted contents of every derived file."""
    model = load(HERE / "protocol.toml")
    return {
        HERE / "protocol.h": header(model),
        HOST / "protocol.py": numbers_module(model),
        HOST / "protocol_texts.py": texts_module(model),
        HOST / "version.py": version_module(model),
        PAGE: fill(model, PAGE.read_text(encoding="utf-8")),
    }


def main(arguments: list[str]) -> int:
    """Write or check; return the exit code."""
    if arguments not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    stale = [
        (path, text)
        for path, text in derived().items()
        if not path.exists() or path.read_text(encoding="utf-8") != text
    ]
    for path, text in stale:
        name = path.relative_to(ROOT)
        if arguments:
            print(f"{name} is stale: run python3 firmware/link/generate_protocol.py")
        else:
            path.write_text(text, encoding="utf-8")
            print(f"{name} written")
    return 1 if arguments and stale else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
