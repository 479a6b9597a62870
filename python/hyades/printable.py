"""Texts that others have written, as a person may see them: the rules of core/base/printable.h."""

from __future__ import annotations

import re

# Characters that are not seen, steer terminals, or turn the direction of text.
_DECEIVING = [
    (0x0000, 0x001F), (0x007F, 0x009F), (0x00AD, 0x00AD), (0x061C, 0x061C), (0x180E, 0x180E),
    (0x200B, 0x200B), (0x200E, 0x200F), (0x2028, 0x202E), (0x2060, 0x2064), (0x2066, 0x2069),
    (0xFEFF, 0xFEFF), (0xFFF9, 0xFFFB), (0xE0000, 0xE007F), (0xD800, 0xDFFF),
]  # fmt: skip
_HIDDEN = re.compile("[" + "".join(f"{chr(first)}-{chr(last)}" for first, last in _DECEIVING) + "]")


def is_printable(text: str) -> bool:
    """Whether a person who sees `text` in a line sees what it says."""
    return _HIDDEN.search(text) is None


def printable_lines(text: str) -> str:
    """`text` with '?' in place of each character that is not printable; ends of lines (\\n) stay."""
    return "\n".join(_HIDDEN.sub("?", line) for line in text.split("\n"))
