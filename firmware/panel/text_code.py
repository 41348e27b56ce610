# SPDX-License-Identifier: Apache-2.0
"""A Huffman code for the texts: frequent letters take three bits, rare ones nine.

The code is canonical, so that the chip needs only how many letters have each length, and the
letters in the order of their codes (text.asm tells how it reads them).
"""

from __future__ import annotations

import heapq
from collections import Counter

END = "\0"
#: Texts that share an address: the chip reads through at most this many less one to find one.
GROUP = 8


def prepared(text: str) -> str:
    """The text as it is stored: the first letter small, which the chip undoes, and an end."""
    return text[:1].lower() + text[1:] + END


def lengths(texts: list[str]) -> dict[str, int]:
    """Bits of each letter."""
    counts = Counter(letter for text in texts for letter in prepared(text))
    heap = [(count, letter, {letter: 0}) for letter, count in sorted(counts.items())]
    heapq.heapify(heap)
    while len(heap) > 1:
        one, _, first = heapq.heappop(heap)
        two, name, second = heapq.heappop(heap)
        merged = {letter: bits + 1 for letter, bits in (first | second).items()}
        heapq.heappush(heap, (one + two, name, merged))
    return heap[0][2]


class TextCode:
    """The code, and the texts in it."""

    def __init__(self, texts: list[str]) -> None:
        """Find the best code for these texts."""
        bits = lengths(texts)
        self.letters = sorted(bits, key=lambda letter: (bits[letter], letter))
        longest = max(bits.values())
        self.counts = [list(bits.values()).count(n) for n in range(1, longest + 1)]
        self.codes: dict[str, str] = {}
        code = 0
        length = 0
        for letter in self.letters:
            code <<= bits[letter] - length
            length = bits[letter]
            self.codes[letter] = f"{code:0{length}b}"
            code += 1
        self.groups: list[int] = []
        self.data = bytearray()
        for at in range(0, len(texts), GROUP):
            self.groups.append(len(self.data))
            self._store("".join(prepared(text) for text in texts[at : at + GROUP]))

    def _store(self, letters: str) -> None:
        stream = "".join(self.codes[letter] for letter in letters)
        stream += "0" * (-len(stream) % 8)
        self.data += bytes(int(stream[at : at + 8], 2) for at in range(0, len(stream), 8))
