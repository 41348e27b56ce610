# SPDX-License-Identifier: Apache-2.0
"""Makes the pages, which link to sources as files of the repository, fit for the web site."""

import re
from pathlib import Path
from typing import Any

DOCS = Path(__file__).resolve().parent
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(([^)#:]+)(#[^)]*)?\)")


def on_page_markdown(markdown: str, *, page: Any, **_others: Any) -> str:
    """Turn links to files outside of docs/, which the site does not have, into their names."""
    folder = (DOCS / page.file.src_uri).parent

    def kept_or_named(link: re.Match[str]) -> str:
        target = (folder / link[2]).resolve()
        inside = target.is_relative_to(DOCS) and target.suffix != ".py" and target.is_file()
        if inside or not target.exists():
            return link[0]
        named = target.relative_to(DOCS.parent).as_posix()
        return link[1] if named in link[1].strip("`/") else f"{link[1]} (`{named}`)"

    return LINK.sub(kept_or_named, markdown)
